#include "lattice/statics/vibration_modes.h"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "lattice/statics/elastic_system.h"
#include "lattice/statics/factor_memory.h"

namespace fingertip::lattice::inline statics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Of an eigenvector's residual; the eigenvalue's error is its square.
constexpr double residual_tolerance = 1e-10;
constexpr int max_restarts = 1000;
constexpr int smallest_basis = 20;  // Lanczos vectors
/// Some squared frequency near the lowest elastic ones, over the mean square frequency of all
/// modes, trace K / trace M.
constexpr double low_square = 1e-4;

bool is_fixed(const LatticeBody& body, Index unknown) {
  return !body.fixed.empty() && body.fixed[std::size_t(unknown)] != 0;
}

void check(const LatticeBody& body, int count) {
  Index free = 0;
  for (Index i = 0; i < body.unknowns(); ++i) free += is_fixed(body, i) ? 0 : 1;
  std::vector<meshes::Violation> found;
  if (count < 1 || count >= free) {
    found.push_back({"modes", std::to_string(count),
                     "the number of modes must be at least 1 and below the lattice's " +
                         std::to_string(free) + " free unknowns",
                     "ask for fewer modes or choose a finer lattice"});
  }
  if (!std::all_of(body.mass.begin(), body.mass.end(),
                   [](double mass) { return std::isfinite(mass) && mass > 0.0; })) {
    found.push_back({"rubber.density", "", "every particle needs a positive mass to vibrate",
                     "give a positive density"});
  }
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// B = S (K - shift M)^-1 S with S = (unit M)^½, fixed unknowns left out by S = 0. From B v = nu v
/// with v = M^½ x follows K x = (shift + unit/nu) M x. The unit, a low squared frequency, keeps nu
/// near 1: Spectra's thresholds are not all relative. A free body, whose K is singular, is shifted
/// by as much. What has been found is projected out.
class InverseOperator {
 public:
  using Scalar = double;  // the names Spectra asks for

  InverseOperator(const LatticeBody& body, const std::function<bool()>& stop_requested);

  Index rows() const { return root_mass_.size(); }
  Index cols() const { return root_mass_.size(); }
  void perform_op(const double* in, double* out) const;

  double eigenvalue(double nu) const { return shift_ + unit_ / nu; }
  /// x of v.
  VectorXd shape(const VectorXd& v) const;
  void project_out(VectorXd v) { found_.push_back(std::move(v)); }

 private:
  void remove_found(VectorXd& v) const;

  const std::function<bool()>& stop_requested_;
  VectorXd root_mass_;               ///< S [N/m]^½
  double unit_ = 0.0, shift_ = 0.0;  ///< [1/s²]
  Eigen::CholmodSupernodalLLT<Tangent, Eigen::Lower> factor_;
  std::vector<VectorXd> found_;
};

InverseOperator::InverseOperator(const LatticeBody& body,
                                 const std::function<bool()>& stop_requested)
    : stop_requested_(stop_requested), root_mass_(body.unknowns()) {
  const ElasticSystem system(body);
  VectorXd force, mass(body.unknowns());
  Tangent matrix = system.empty_tangent();
  system.assemble(VectorXd::Zero(body.unknowns()), force, &matrix);
  for (Index i = 0; i < mass.size(); ++i) mass[i] = body.mass[std::size_t(i / 3)];
  unit_ = low_square * matrix.diagonal().sum() / mass.sum();
  if (body.bond.empty()) shift_ = -unit_;
  for (Index i = 0; i < mass.size(); ++i)
    root_mass_[i] = is_fixed(body, i) ? 0.0 : std::sqrt(unit_ * mass[i]);
  for (Index column = 0; column < matrix.cols(); ++column) {
    for (Tangent::InnerIterator entry(matrix, column); entry; ++entry) {
      const bool held = is_fixed(body, entry.row()) || is_fixed(body, column);
      if (entry.row() == column) {
        entry.valueRef() = held ? 1.0 : entry.value() - shift_ * mass[column];
      } else if (held) {
        entry.valueRef() = 0.0;
      }
    }
  }
  factor_.cholmod().print = 0;
  factor_.compute(matrix);
  require_memory(factor_.cholmod(), matrix.rows());
  if (factor_.info() != Eigen::Success) {
    throw meshes::NotConverged(
        "the lattice has no natural vibrations: its stiffness at rest is not positive");
  }
}

void InverseOperator::remove_found(VectorXd& v) const {
  for (const VectorXd& f : found_) v -= f.dot(v) * f;
}

void InverseOperator::perform_op(const double* in, double* out) const {
  if (stop_requested_ && stop_requested_())
    throw meshes::Interrupted("the search for natural vibrations was interrupted");
  VectorXd v = Eigen::Map<const VectorXd>(in, rows());
  remove_found(v);
  VectorXd image = root_mass_.cwiseProduct(factor_.solve(root_mass_.cwiseProduct(v)));
  remove_found(image);
  Eigen::Map<VectorXd>(out, rows()) = image;
}

VectorXd InverseOperator::shape(const VectorXd& v) const {
  return (root_mass_.array() > 0.0).select(std::sqrt(unit_) * v.cwiseQuotient(root_mass_), 0.0);
}

/// An eigenvector of the operator.
struct Found {
  double nu = 0.0;
  VectorXd v;
};

/// The `count` largest in the complement of what has been projected out. A start of its own for
/// every call: a Krylov space holds one vector of each eigenspace, the same for the same start.
std::vector<Found> largest(InverseOperator& inverse, int count, std::mt19937& generator) {
  const Index basis = std::min<Index>(inverse.rows(), std::max(2 * count + 1, smallest_basis));
  Spectra::SymEigsSolver<InverseOperator> solver(inverse, count, basis);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const VectorXd start = VectorXd::NullaryExpr(inverse.rows(), [&] { return uniform(generator); });
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestAlge, max_restarts, residual_tolerance);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw meshes::NotConverged("the natural vibrations of the lattice were not found in " +
                               std::to_string(max_restarts) + " restarts of Lanczos' method");
  const VectorXd nu = solver.eigenvalues();
  const Eigen::MatrixXd v = solver.eigenvectors();
  std::vector<Found> found;
  for (Index i = 0; i < nu.size(); ++i) found.push_back({nu[i], v.col(i)});
  return found;
}

}  // namespace

std::vector<VibrationMode> vibration_modes(const LatticeBody& body, int count,
                                           const std::function<bool()>& stop_requested) {
  check(body, count);
  InverseOperator inverse(body, stop_requested);
  std::mt19937 generator;
  const auto before = [](const Found& a, const Found& b) { return a.nu > b.nu; };
  std::vector<Found> kept = largest(inverse, count, generator);
  for (const Found& mode : kept) inverse.project_out(mode.v);
  // A mode whose twin has been found may have been passed over.
  for (;;) {
    Found next = largest(inverse, 1, generator).front();
    if (next.nu <= kept.back().nu) break;
    inverse.project_out(next.v);
    kept.insert(std::upper_bound(kept.begin(), kept.end(), next, before), std::move(next));
    kept.pop_back();
  }
  std::vector<VibrationMode> modes;
  for (const Found& mode : kept) {
    // Round-off may turn the zero of a rigid motion negative.
    const double square = std::max(inverse.eigenvalue(mode.nu), 0.0);
    modes.push_back({std::sqrt(square) / (2.0 * std::numbers::pi), inverse.shape(mode.v)});
  }
  return modes;
}

}  // namespace fingertip::lattice::inline statics
