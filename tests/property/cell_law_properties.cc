// Properties of the energy that a lattice cell stores in its mean displacement gradient.
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/lattice/statics/laws.h"
#include "tests/property/random_numbers.h"

using namespace fingertip;
using namespace fingertip::random;
using namespace laws;
using meshes::Rubber;
using Vector3 = Eigen::Vector3d;

namespace {

/// A deformation gradient far from rest with J > 0: a turn, stretches, another turn.
Matrix3d random_deformation() {
  const Vector3 stretch(std::exp(uniform(-1.0, 1.0)), std::exp(uniform(-1.0, 1.0)),
                        std::exp(uniform(-1.0, 1.0)));
  return random_rotation() * stretch.asDiagonal() * random_rotation();
}

double energy_at(const CellLaw& law, const Matrix3d& F) {
  return law.energy(F - Matrix3d::Identity());
}

bool laws_see_no_turns() {
  return rc::check("W(Q F) = W(F) = W(F Q) at finite strain; no spin is felt at small strain", [] {
    const Rubber rubber = random_rubber(0.0);
    const double share = uniform(0.0, 1.0), modulus = rubber.longitudinal_modulus();
    const Matrix3d F = random_deformation(), Q = random_rotation();
    for (const CellLaw& law : {network_law(rubber, share), volume_law(modulus, true)}) {
      const double scale = 1e-12 * modulus * (1.0 + F.squaredNorm() + std::pow(F.norm(), 6));
      RC_ASSERT(std::abs(energy_at(law, Q * F) - energy_at(law, F)) <= scale);
      RC_ASSERT(std::abs(energy_at(law, F * Q) - energy_at(law, F)) <= scale);
    }
    auto k = lattice::hookean_constants(rubber, 1.0, uniform(0.0, 0.7) * rubber.shear_modulus);
    k.k1 *= uniform(0.5, 2.0);  // cubic, not isotropic
    const Matrix3d H = random_matrix(1.0), spin = skew(random_vector(1.0));
    for (const CellLaw& law : {cubic_law(k, 1.0, 0.0, Q), volume_law(k.kappa, false)})
      RC_ASSERT(std::abs(law.energy(H + spin) - law.energy(H)) <= 1e-11 * modulus);
    const double turned = cubic_law(k, 1.0, share, Q).energy(Q * H * Q.transpose());
    RC_ASSERT(std::abs(turned - cubic_law(k, 1.0, share).energy(H)) <= 1e-11 * modulus);
  });
}

bool laws_are_consistent() {
  return rc::check("stress and tangent of a cell law are derivatives of its energy", [] {
    const Rubber rubber = random_rubber(0.0);
    const double share = uniform(0.0, 1.0), modulus = rubber.longitudinal_modulus();
    const auto k =
        lattice::hookean_constants(rubber, 1.0, uniform(0.0, 0.7) * rubber.shear_modulus);
    const CellLaw law = *rc::gen::element(
        network_law(rubber, share), volume_law(uniform(-1.0, 1.0) * modulus, true),
        volume_law(modulus, false), cubic_law(k, 1.0, share, random_rotation()));
    const Matrix3d H = random_deformation() - Matrix3d::Identity();
    const double h = 1e-5;
    const auto response = law.evaluate(H);
    const double scale = 1e-7 * (modulus + response.tangent.norm() + response.stress.norm());
    RC_ASSERT((response.tangent - response.tangent.transpose()).norm() <= 1e-12 * scale * 1e7);
    for (int n = 0; n < 9; ++n) {
      Matrix3d step = Matrix3d::Zero();
      step(n / 3, n % 3) = h;
      const auto ahead = law.evaluate(H + step), behind = law.evaluate(H - step);
      RC_ASSERT(std::abs((ahead.energy - behind.energy) / (2.0 * h) - response.stress[n]) <= scale);
      RC_ASSERT(((ahead.stress - behind.stress) / (2.0 * h) - response.tangent.col(n)).norm() <=
                scale);
    }
  });
}

bool collapse_costs_without_bound() {
  return rc::check("the network's energy grows without bound as a cell collapses", [] {
    const Rubber rubber = random_rubber(0.0);
    const CellLaw law = network_law(rubber, uniform(0.0, 1.0));
    const Matrix3d left = random_rotation(), right = random_rotation();
    const Vector3 flattened(uniform(0.0, 1.0), uniform(0.0, 1.0), 1.0);  // how fast each goes
    double before = -std::numeric_limits<double>::infinity();
    for (double t = 1.0; t < 20.0; t += 1.0) {
      const Vector3 stretch = (-t * flattened).array().exp();
      const double W = energy_at(law, left * stretch.asDiagonal() * right);
      // The fibres' terms are at least -3/2 G, lambda's not negative: W >= G (|ln J| - 3/2).
      RC_ASSERT(W >= rubber.shear_modulus * (t * flattened.sum() * (1.0 - 1e-6) - 1.5));
      RC_ASSERT(W > before);
      before = W;
    }
    const Matrix3d flat = left * Vector3(1.0, 1.0, 0.0).asDiagonal();
    const Matrix3d inside_out = left * Vector3(1.0, 0.7, -0.1).asDiagonal();
    RC_ASSERT(energy_at(law, inside_out) == std::numeric_limits<double>::infinity());
    RC_ASSERT(energy_at(law, flat) > 20.0 * rubber.shear_modulus);
    RC_ASSERT_THROWS_AS(law.evaluate(inside_out - Matrix3d::Identity()), std::domain_error);
  });
}

}  // namespace

int main() {
  bool good = laws_see_no_turns();
  good = laws_are_consistent() && good;
  good = collapse_costs_without_bound() && good;
  return good ? 0 : 1;
}
