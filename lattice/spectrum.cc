#include "lattice/spectrum.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "lattice/stiffness.h"

namespace fingertip::lattice {

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
    bound = std::max(bound, (2.0 * largest_eigenvalue(sum) + ligament[i]) / model.mass[i]);
  }
  return bound;
}

/// Element bound: K and M are sums over cells, so no Rayleigh quotient exceeds the largest one of
/// a single cell on its own corner masses. A ligament is shared evenly by the cells around its
/// particle.
double cell_bound(const LatticeModel& model, const SpringConstants& constants,
                  const std::vector<double>& ligament) {
  const double corner_mass = model.total_mass() / (8.0 * double(model.cells.size()));
  const Eigen::Matrix<double, 24, 24> bare = cell_stiffness(constants, model.spacing());
  std::map<std::array<double, 8>, double> known;
  double bound = 0.0;
  for (const std::size_t cell : model.cells) {
    std::array<double, 8> share;
    for (int c = 0; c < 8; ++c) {
      const std::size_t i = cell_corner(model.grid.size, cell, c);
      share[std::size_t(c)] = ligament[i] * corner_mass / model.mass[i];
    }
    auto [entry, is_new] = known.try_emplace(share, 0.0);
    if (is_new) {
      Eigen::Matrix<double, 24, 24> matrix = bare;
      for (int c = 0; c < 8; ++c) {
        matrix.diagonal().segment<3>(3 * c).array() += share[std::size_t(c)];
      }
      entry->second = largest_eigenvalue(matrix) / corner_mass;
    }
    bound = std::max(bound, entry->second);
  }
  return bound;
}

double lattice_bound(const LatticeModel& model, Quantity quantity, double ligament_factor) {
  const auto ligament = ligament_values(model, quantity, ligament_factor);
  const bool stiffness = quantity == Quantity::stiffness;
  if (model.kind == ModelKind::published) {
    return particle_bound(model, stiffness ? model.stiffness : model.damping, ligament);
  }
  const auto& k = stiffness ? model.stiffness : model.damping;
  return cell_bound(model,
                    {k[0], k[1], k[2], stiffness ? model.volume_stiffness : model.volume_damping},
                    ligament);
}

/// Largest eigenvalue of the rod's own block: ligaments on a rod whose particles stand still.
double rod_bound(const LatticeModel& model, Quantity quantity, const RodBody& rod) {
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Ligament& l : model.ligaments) {
    const Vector3 arm = l.rest - rod.centre;
    Eigen::Matrix<double, 3, 6> motion;
    motion.leftCols<3>().setIdentity();
    for (int k = 0; k < 3; ++k) motion.col(3 + k) = Vector3::Unit(k).cross(arm);
    stiffness += value(l, quantity) * motion.transpose() * motion;
  }
  Eigen::Matrix<double, 6, 6> inertia = Eigen::Matrix<double, 6, 6>::Zero();
  inertia.topLeftCorner<3, 3>() = rod.mass * Matrix3d::Identity();
  inertia.bottomRightCorner<3, 3>() = rod.inertia;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(
             stiffness, inertia, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
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

/// y = M^(-1/2) A M^(-1/2) q with A the lattice's stiffness or damping matrix, ligaments included.
class ScaledOperator {
 public:
  ScaledOperator(const LatticeModel& model, Quantity quantity)
      : matrix_(small_strain_matrix(model, quantity)),
        scale_(mass_vector(model).cwiseSqrt().cwiseInverse()) {
    const auto ligament = ligament_values(model, quantity, 1.0);
    diagonal_.resize(scale_.size());
    for (std::size_t p = 0; p < model.particles.size(); ++p) {
      diagonal_.segment<3>(3 * Eigen::Index(p)).setConstant(ligament[model.particles[p]]);
    }
  }
  Eigen::Index size() const { return scale_.size(); }
  Eigen::VectorXd operator()(const Eigen::VectorXd& q) const {
    const Eigen::VectorXd u = scale_.cwiseProduct(q);
    return scale_.cwiseProduct(matrix_ * u + diagonal_.cwiseProduct(u));
  }

 private:
  static Eigen::SparseMatrix<double> small_strain_matrix(const LatticeModel& model,
                                                         Quantity quantity) {
    if (quantity == Quantity::stiffness) return small_strain_stiffness(model);
    LatticeModel viscous = model;
    viscous.stiffness = model.damping;
    viscous.volume_stiffness = model.volume_damping;
    return small_strain_stiffness(viscous);
  }

  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd scale_, diagonal_;
};

/// Largest Ritz value after `steps` of the symmetric Lanczos recursion. The largest one converges
/// first, and lost orthogonality only duplicates it (Paige 1971), so none is restored.
double lanczos(const ScaledOperator& apply, int steps) {
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
    if (beside.back() == 0.0) break;
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
  include(model.volume_damping, model.volume_stiffness);
  for (const Ligament& l : model.ligaments) include(l.damping, l.stiffness);
}

bool uniformly_damped(const SpectralBounds& bounds) {
  return bounds.longest_retardation - bounds.shortest_retardation <=
         1e-12 * bounds.longest_retardation;
}

}  // namespace

SpectralBounds spectral_bounds(const LatticeModel& model, const RodBody* rod) {
  SpectralBounds bounds;
  find_retardation_times(model, bounds);
  bounds.stiffness = bound(model, Quantity::stiffness, rod);
  bounds.damping = uniformly_damped(bounds) ? bounds.longest_retardation * bounds.stiffness
                                            : bound(model, Quantity::damping, rod);
  return bounds;
}

SpectralBounds rod_bounds(const LatticeModel& model, const RodBody& rod) {
  SpectralBounds bounds;
  bounds.stiffness = rod_bound(model, Quantity::stiffness, rod);
  bounds.damping = rod_bound(model, Quantity::damping, rod);
  return bounds;
}

SpectralBounds spectral_estimate(const LatticeModel& model) {
  constexpr int steps = 60;
  SpectralBounds estimate;
  find_retardation_times(model, estimate);
  estimate.stiffness = lanczos({model, Quantity::stiffness}, steps);
  estimate.damping = uniformly_damped(estimate) ? estimate.longest_retardation * estimate.stiffness
                                                : lanczos({model, Quantity::damping}, steps);
  return estimate;
}

}  // namespace fingertip::lattice
