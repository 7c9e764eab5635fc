#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fem_reference/solvers/conjugate_gradients.h"
#include "fem_reference/solvers/field_solver.h"
#include "fem_reference/solvers/two_level.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

/// For a solution; and a decade of one of Newton's systems, at least for `fewest_decades` (they
/// take 2 to 15): an indefinite matrix may go on for ever.
constexpr int max_iterations = 1000, max_inexact = 50;
constexpr double fewest_decades = 3.0;
/// The preconditioner is built anew when more than this share of the held unknowns has changed, and
/// when a solution takes so many times the iterations that its like took, and `usual` more.
constexpr double worth_rebuilding = 0.02, patience = 1.5;
constexpr int usual = 5;

class MultigridSolver : public FieldSolver {
 public:
  MultigridSolver(const Body<3>& body, const std::vector<long>& contact_unknowns, double tolerance,
                  double forcing)
      : body_(body),
        contact_unknowns_(contact_unknowns),
        tolerance_(tolerance),
        forcing_(forcing),
        displacement_(body.fine.vector()),
        load_(displacement_) {
    for (const long unknown : contact_unknowns)
      contact_local_.push_back(body.fine.owned.is_element(unsigned(unknown))
                                   ? long(body.fine.owned.index_within_set(unsigned(unknown)))
                                   : -1);
    constrained_.assign(body.fine.owned.n_elements(), 0);
    for (const auto i : body.fine.owned)
      if (body.fine.constraints.is_constrained(i))
        constrained_[body.fine.owned.index_within_set(i)] = 1;
  }

  void set_matrix(const LinearSystem& system) override {
    if (system_ != &system) {
      preconditioner_ = std::make_unique<TwoLevelPreconditioner>(body_, system);
      built_for_.clear();
    }
    system_ = &system;
  }

  void set_load(const Vector& load) override {
    load_ = load;
    enough_ = 0.0;
    noise_ = 100.0 * tolerance_;
  }

  void forget() override {
    built_for_.clear();
    displacement_ = 0.0;
  }

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    held_ = constrained_;
    Vector load = load_;
    for (std::size_t i = 0; i < held.size(); ++i) {
      const long local = contact_local_[i];
      if (local < 0) continue;
      if (held[i]) {
        held_[std::size_t(local)] = 1;
        displacement_.begin()[local] = values[Eigen::Index(i)];
      } else {
        load.begin()[local] += loads[Eigen::Index(i)];
      }
    }
    for (std::size_t i = 0; i < constrained_.size(); ++i)
      if (constrained_[i]) displacement_.begin()[i] = load.begin()[i] = 0.0;
    if (has_changed(held)) build(held);
    ConstrainedSolution solution;
    solution.cg_iterations = relax(load, held);
    Vector force = body_.fine.vector();
    multiply(system_->matrix, displacement_, force);
    force -= load_;
    solution.displacement = gather(displacement_);
    solution.reaction = gather(force);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) solution.reaction[Eigen::Index(i)] = loads[Eigen::Index(i)];
    return solution;
  }

  Vector field() override { return displacement_; }

  double noise() const override { return std::max(1e-10, noise_); }

 private:
  bool has_changed(const std::vector<char>& held) const {
    if (built_for_.size() != held.size()) return true;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < held.size(); ++i) changed += held[i] != built_for_[i];
    return double(changed) > worth_rebuilding * double(std::ranges::count(held, 1));
  }

  void build(const std::vector<char>& held) {
    preconditioner_->set_held(held_);
    built_for_ = held;
    iterations_per_decade_ = 0.0;
  }

  /// Solves for the unknowns that are not held; returns the iterations.
  int relax(const Vector& load, const std::vector<char>& held) {
    const ProjectedMatrix matrix(system_->matrix, held_);
    Vector residual = load;
    multiply(system_->matrix, displacement_, residual);
    const double scale = std::max(residual.l2_norm(), load.l2_norm());  // mostly the reactions
    residual.sadd(-1.0, 1.0, load);
    matrix.project(residual);
    const double first = residual.l2_norm();
    if (enough_ == 0.0 || forcing_ == 0.0) enough_ = std::max(tolerance_ * scale, forcing_ * first);
    if (scale > 0.0) noise_ = std::max(noise_, 10.0 * enough_ / scale);
    Vector u = displacement_;
    int iterations = 0;
    while (residual.l2_norm() > enough_) {
      const double decades = std::log10(residual.l2_norm() / enough_);
      const bool fresh = iterations_per_decade_ == 0.0;
      int most = usual + int(patience * iterations_per_decade_ * decades);
      if (fresh)
        most =
            forcing_ > 0.0 ? int(max_inexact * std::max(fewest_decades, decades)) : max_iterations;
      const CgOutcome outcome = conjugate_gradients(
          u, residual, enough_, most,
          [&](const Vector& v) {
            Vector force = v;
            matrix.vmult(force, v);
            return force;
          },
          [&](const Vector& v) {
            Vector better = v;
            preconditioner_->vmult(better, v);
            return better;
          });
      iterations += outcome.iterations;
      if (outcome.end == CgEnd::indefinite)
        throw meshes::NotConverged(
            "the stiffness matrix is not positive definite: a degenerate mesh, or a state that is "
            "not stable");
      if (fresh && outcome.end == CgEnd::too_many)
        throw meshes::NotConverged("conjugate gradients stopped at a residual of " +
                                   std::to_string(residual.l2_norm() / scale) +
                                   " of the reactions after " + std::to_string(iterations) +
                                   " iterations");
      if (fresh) iterations_per_decade_ = std::max(1, outcome.iterations) / decades;
      if (outcome.end == CgEnd::too_many) build(held);
    }
    displacement_ = u;
    return iterations;
  }

  Eigen::VectorXd gather(const Vector& v) const {
    const std::vector<double> all = body_.fine.gather(v, contact_unknowns_);
    return Eigen::Map<const Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
  }

  const Body<3>& body_;
  std::vector<long> contact_unknowns_;
  std::vector<long> contact_local_;  ///< index among the owned unknowns, -1 for other processes'
  std::vector<char> constrained_, held_, built_for_;
  double tolerance_, forcing_;
  double enough_ = 0.0, noise_ = 0.0;   ///< out of balance since the last load [N], as a fraction
  double iterations_per_decade_ = 0.0;  ///< with the preconditioner when it was new, 0: it is
  const LinearSystem* system_ = nullptr;
  std::unique_ptr<TwoLevelPreconditioner> preconditioner_;
  Vector displacement_, load_;
};

}  // namespace

std::unique_ptr<FieldSolver> make_multigrid_solver(const Body<3>& body,
                                                   const std::vector<long>& contact_unknowns,
                                                   double tolerance, double forcing) {
  return std::make_unique<MultigridSolver>(body, contact_unknowns, tolerance, forcing);
}

}  // namespace fingertip::fem_reference::inline solvers
