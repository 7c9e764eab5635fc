#include "lattice/dynamics/spectrum.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "lattice/forces/forces.h"

namespace fingertip::lattice::inline dynamics {

using Eigen::Matrix3d;
using meshes::Vector3;

namespace {

/// The two families of matrices a bound is wanted for; C is bounded like K with mu for k.
enum class Quantity { stiffness, damping };

double value(const Ligament& ligament, Quantity quantity) {
  return quantity == Quantity::stiffness ? ligament.stiffness : ligament.damping;
}

template <typename Matrix>
double largest_eigenvalue(const Matrix& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

std::vector<double> ligament_values(const LatticeModel& model, Quantity quantity, double factor) {
  std::vector<double> values(model.points(), 0.0);
  for (const Ligament& l : model.ligaments) values[l.particle] += factor * value(l, quantity);
  return values;
}

/// Gershgorin by particles: (d̂·(u_j - u_i))² <= 2 (d̂·u_i)² + 2 (d̂·u_j)², so K is at most the
/// block-diagonal matrix of 2 Σ k d̂d̂ᵀ per particle.
double particle_bound(const LatticeModel& model, const std::array<double, 3>& family_value,
                      const std::vector<double>& ligament) {
  double bound = 0.0;
  for (const std::size_t i : model.particles) {
    Matrix3d sum = Matrix3d::Zero();
    for (std::size_t s = 0; s < directions; ++s) {
      const Direction& d = half_stencil[s];
      const std::size_t step = std::size_t(neighbour_offset(model.grid.size, int(s)));
      const double weight = model.weight[s][i] + model.weight[s][i - step];
      if (weight == 0.0) continue;
      const Vector3 direction = Vector3(d.dx, d.dy, d.dz).normalized();
      sum += weight * family_value[d.family] * direction * direction.transpose();
    }
    model.sector.hold(model.place(i), sum);
    bound = std::max(bound, (2.0 * largest_eigenvalue(sum) + ligament[i]) / model.mass[i]);
  }
  return bound;
}

double lattice_bound(const LatticeModel& model, Quantity quantity, double ligament_factor) {
  return particle_bound(model, quantity == Quantity::stiffness ? model.stiffness : model.damping,
                        ligament_values(model, quantity, ligament_factor));
}

/// Stiffness of the rod on an isotropic spring of unit stiffness at `rest`, about its centre: what
/// a unit mass there has of inertia.
Matrix6 unit_spring_on_rod(const Vector3& rest, const RodBody& rod) {
  return rigid_inertia(1.0, rest - rod.centre);
}

/// Largest eigenvalue of the rod's own block: bond on a rod whose particles stand still.
double rod_bound(const LatticeModel& model, Quantity quantity, const RodBody& rod) {
  Matrix6 stiffness = Matrix6::Zero();
  for (const Ligament& l : model.ligaments) {
    stiffness += value(l, quantity) * unit_spring_on_rod(l.rest, rod);
  }
  if (quantity == Quantity::stiffness) {
    for (const EmbeddedPoint& tie : model.bond) {
      stiffness += tie.stiffness * unit_spring_on_rod(tie.rest, rod);
    }
  }
  return largest_ratio(model.sector.whole(stiffness),
                       rigid_inertia(rod.mass, Vector3::Zero(), rod.inertia));
}

/// Of K with the rod free: |u_p - u_r|² <= (1 + e)|u_p|² + (1 + 1/e)|u_r|² for every e > 0
/// separates particles from rod; e is taken such that the rod's part does not govern.
double bound(const LatticeModel& model, Quantity quantity, const RodBody* rod) {
  const double held = lattice_bound(model, quantity, 1.0);
  if (rod == nullptr || model.ligaments.empty()) return held;
  const double own = rod_bound(model, quantity, *rod);
  if (own == 0.0) return held;
  const double e = 2.0 * own < held ? own / (held - own) : 1.0;
  return std::max(lattice_bound(model, quantity, 1.0 + e), own * (1.0 + 1.0 / e));
}

/// y = M^(-1/2) A M^(-1/2) q with A the lattice's stiffness or damping matrix at a state, ligaments
/// included, from its forces.
class ScaledOperator {
 public:
  ScaledOperator(const LatticeModel& model, const State& at, Quantity quantity)
      : model_(&model),
        quantity_(quantity),
        team_(1),
        forces_(model, team_),
        base_(quantity == Quantity::stiffness ? at.displacement : at.velocity),
        state_(at),
        force_(model.points()),
        scale_(mobility(model)),
        ligament_(ligament_values(model, quantity, 1.0)) {}

  Eigen::Index size() const { return 3 * Eigen::Index(model_->particles.size()); }

  Eigen::VectorXd operator()(const Eigen::VectorXd& q) {
    // Of forces that are not linear in the displacement the part that is even drops out.
    const double amplitude = 1e-4 * model_->spacing() / largest_shift(q);
    return (forces(q, amplitude) - forces(q, -amplitude)) / (-2.0 * amplitude);
  }

 private:
  double largest_shift(const Eigen::VectorXd& q) const {
    double largest = 0.0;
    for (std::size_t p = 0; p < model_->particles.size(); ++p) {
      const auto n = Eigen::Index(p);
      largest = std::max(largest, scale_.row(n).maxCoeff() * q.segment<3>(3 * n).norm());
    }
    return largest;
  }

  /// M^(-1/2) times the forces where amplitude M^(-1/2) q is added to the displacement (velocity).
  Eigen::VectorXd forces(const Eigen::VectorXd& q, double amplitude) {
    VectorField& moved = quantity_ == Quantity::stiffness ? state_.displacement : state_.velocity;
    for (std::size_t p = 0; p < model_->particles.size(); ++p) {
      const std::size_t i = model_->particles[p];
      const auto n = Eigen::Index(p);
      const Vector3 scale = amplitude * scale_.row(n);
      moved.set(i, base_.at(i) + scale.cwiseProduct(q.segment<3>(3 * n)));
    }
    forces_.accumulate(state_, force_);
    Eigen::VectorXd result(size());
    for (std::size_t p = 0; p < model_->particles.size(); ++p) {
      const std::size_t i = model_->particles[p];
      const auto n = Eigen::Index(p);
      const Vector3 scale = scale_.row(n);
      result.segment<3>(3 * n) = scale.cwiseProduct(force_.at(i) - ligament_[i] * moved.at(i));
    }
    return result;
  }

  const LatticeModel* model_;
  Quantity quantity_;
  Team team_;
  InternalForces forces_;
  VectorField base_;
  State state_;
  VectorField force_;
  Eigen::MatrixX3d scale_;
  std::vector<double> ligament_;
};

/// Largest Ritz value after `steps` of the symmetric Lanczos recursion. The largest one converges
/// first, and lost orthogonality only duplicates it (Paige 1971), so none is restored.
double lanczos(ScaledOperator& apply, int steps) {
  Eigen::VectorXd previous = Eigen::VectorXd::Zero(apply.size()), current(apply.size());
  std::minstd_rand generator(1);  // a fixed start without symmetry: every mode takes part
  for (double& value : current) value = double(generator()) / double(generator.max()) - 0.5;
  current.normalize();
  std::vector<double> diagonal, beside;
  for (int step = 0; step < steps; ++step) {
    Eigen::VectorXd next = apply(current);
    if (step > 0) next -= beside.back() * previous;
    diagonal.push_back(current.dot(next));
    next -= diagonal.back() * current;
    beside.push_back(next.norm());
    if (beside.back() <= 1e-14 * std::abs(diagonal.back())) break;
    previous = current;
    current = next / beside.back();
  }
  const Eigen::Index count = Eigen::Index(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), count),
                                Eigen::Map<const Eigen::VectorXd>(beside.data(), count - 1),
                                Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

void find_retardation_times(const LatticeModel& model, SpectralBounds& bounds) {
  bounds.shortest_retardation = std::numeric_limits<double>::infinity();
  const auto include = [&](double mu, double k) {
    if (k == 0.0) return;
    bounds.shortest_retardation = std::min(bounds.shortest_retardation, mu / k);
    bounds.longest_retardation = std::max(bounds.longest_retardation, mu / k);
  };
  for (std::size_t f = 0; f < 3; ++f) include(model.damping[f], model.stiffness[f]);
  include(model.retardation_time, model.cell_lattice.empty() ? 0.0 : 1.0);
  for (const Ligament& l : model.ligaments) include(l.damping, l.stiffness);
}

bool uniformly_damped(const SpectralBounds& bounds) {
  return bounds.longest_retardation - bounds.shortest_retardation <=
         1e-12 * bounds.longest_retardation;
}

}  // namespace

Eigen::MatrixX3d mobility(const LatticeModel& model) {
  Eigen::MatrixX3d result(Eigen::Index(model.particles.size()), 3);
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    const std::uint32_t i = model.particles[p];
    const std::array<int, 3> at = model.place(i);
    for (std::size_t d = 0; d < 3; ++d)
      result(Eigen::Index(p), Eigen::Index(d)) =
          model.sector.holds(d, at[d]) ? 0.0 : std::sqrt(model.inverse_mass[i]);
  }
  return result;
}

SpectralBounds spectral_bounds(const LatticeModel& model, const RodBody* rod) {
  SpectralBounds bounds;
  find_retardation_times(model, bounds);
  const double stiffness = bound(model, Quantity::stiffness, rod);
  bounds.stiffness = model.relaxation.instantaneous_ratio() * stiffness;
  bounds.damping = uniformly_damped(bounds) ? bounds.longest_retardation * stiffness
                                            : bound(model, Quantity::damping, rod);
  return bounds;
}

SpectralBounds rod_bounds(const LatticeModel& model, const RodBody& rod) {
  SpectralBounds bounds;
  bounds.stiffness = rod_bound(model, Quantity::stiffness, rod);
  bounds.damping = rod_bound(model, Quantity::damping, rod);
  return bounds;
}

SpectralBounds spectral_estimate(const LatticeModel& model, const State& at, int steps) {
  SpectralBounds estimate;
  find_retardation_times(model, estimate);
  ScaledOperator stiffness(model, at, Quantity::stiffness);
  estimate.stiffness = lanczos(stiffness, steps);
  if (uniformly_damped(estimate) && model.kinematics == Kinematics::small) {
    estimate.damping = estimate.longest_retardation * estimate.stiffness;
  } else {
    ScaledOperator damping_operator(model, at, Quantity::damping);
    estimate.damping = lanczos(damping_operator, steps);
  }
  estimate.stiffness *= model.relaxation.instantaneous_ratio();
  return estimate;
}

SpectralBounds spectral_estimate(const LatticeModel& model) {
  return spectral_estimate(model, State(model), 60);
}

}  // namespace fingertip::lattice::inline dynamics
