#include "meshes/rubber/hyperelastic_law.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/rubber/law_terms.h"

namespace fingertip::meshes::inline rubber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

void require_positive(double J) {
  if (!(J > 0.0))  // NaN as well
    throw std::domain_error("the material is turned inside out: det F = " + to_text(J));
}

/// J and H = F^(-T). The columns of J H are the cross products of those of F.
struct Inverse {
  explicit Inverse(const Matrix3d& F) {
    transposed << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    J = F.col(0).dot(transposed.col(0));
    require_positive(J);
    transposed /= J;
  }
  double J;
  Matrix3d transposed;
};

/// Of psi(I1, I2, J); subscripts are derivatives. With M = I1 F - F C (half of dI2/dF)
///
///   P = along F + second M - inverse H,
///   along = 2 psi_1, second = 2 psi_2, inverse = -J psi_J,
///   normal = J² psi_JJ + J psi_J, mixed = 2 J psi_1J, mixed_second = 2 J psi_2J,
///   curvature = 4 psi_11; psi_12 and psi_22 vanish for all laws here.
struct Terms {
  double energy = 0.0, along = 0.0, second = 0.0, inverse = 0.0, normal = 0.0, mixed = 0.0,
         mixed_second = 0.0, curvature = 0.0;
};

double second_invariant(const Matrix3d& F, double I1) {
  return 0.5 * (I1 * I1 - (F.transpose() * F).squaredNorm());
}

/// `excess` adds to I1, and I1/3 times it to I2: so a shear that fluctuates about F costs G at
/// rest.
Terms terms_of_invariants(const StrainEnergy& energy, double G, const Matrix3d& F, double J,
                          double excess) {
  const double square = F.squaredNorm(), I1 = square + excess,
               a = energy.isochoric() ? 1.0 / (std::cbrt(J) * std::cbrt(J)) : 1.0;
  const InvariantSlopes<double> d = invariant_slopes(energy.law, energy.shape, a * I1 - 3.0);
  if (!(d.margin > 0.0)) throw std::domain_error("the gent law is stretched beyond its limit Jm");
  const double I2 = energy.law == RubberLaw::mooney_rivlin
                        ? second_invariant(F, square) + square * excess / 3.0
                        : 0.0;
  const InvariantTerms<double> at = invariant_terms(energy, G, d, a, I1, I2);
  Terms t;
  t.energy = G * (d.energy + d.second * (a * a * I2 - 3.0));
  t.along = at.first + at.second * excess / 3.0;
  t.second = at.second;
  t.inverse = at.inverse;
  t.curvature = at.curvature;
  if (!energy.isochoric()) {
    t.energy -= at.inverse * std::log(J);
    return t;
  }
  t.normal =
      2.0 / 9.0 * at.first * I1 + 1.0 / 9.0 * at.curvature * I1 * I1 + 8.0 / 9.0 * at.second * I2;
  t.mixed_second = -4.0 / 3.0 * at.second;
  t.mixed = -2.0 / 3.0 * at.first - 1.0 / 3.0 * at.curvature * I1 + t.mixed_second * excess / 3.0;
  return t;
}

/// Of an ogden law along the principal axes: Kirchhoff stresses tau, how they change with the
/// logarithms of the stretches, and (tau_a - tau_b)/(l_a² - l_b²).
struct Spectral {
  Matrix3d axes;  ///< columns V: F V = U diag(stretch)
  Vector3d stretch;
  double energy = 0.0, slope = 0.0;  ///< slope: of the energy with `excess`
  Vector3d tau = Vector3d::Zero();
  Vector3d slope_change = Vector3d::Zero();  ///< of the slope with the logarithms
  Matrix3d change = Matrix3d::Zero(), secant = Matrix3d::Zero();
};

/// (l_a^n - l_b^n)/(l_a² - l_b²) over l_b^n/l_b², by the distance of the logarithms. Both fall with
/// it; their ratio is sharp as long as there is one.
double divided_difference(double n, double apart) {
  return apart == 0.0 ? 0.5 * n : std::expm1(n * apart) / std::expm1(2.0 * apart);
}

/// Of functions of free logarithms, as functions of those less their mean.
Vector3d free_of_volume(const Vector3d& v) {
  return v.array() - v.mean();
}
Matrix3d diagonal_free_of_volume(const Vector3d& diagonal) {
  Matrix3d m = diagonal.asDiagonal();
  m.colwise() -= diagonal / 3.0;
  m.rowwise() -= diagonal.transpose() / 3.0;
  m.array() += diagonal.sum() / 9.0;
  return m;
}

/// What a fluctuation costs: chi/2 excess, chi = sum of mu_i times the mean of l^(alpha_i - 2).
void add_excess(const StrainEnergy& energy, const StretchSums<double>& sums, const Vector3d& logs,
                double J, double excess, Spectral& s) {
  const double volume = energy.isochoric() ? std::pow(J, -2.0 / 3.0) : 1.0;
  const Vector3d first = Vector3d::Map(sums.power_slope) / 3.0,
                 second = Vector3d::Map(sums.power_curvature) / 3.0;
  const double chi = (sums.power[0] + sums.power[1] + sums.power[2]) / 3.0;
  for (std::size_t term = 0; term < 3; ++term) {
    const double mu = energy.shape[2 * term] / 3.0, n = energy.shape[2 * term + 1] - 2.0;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        s.secant(a, b) += 0.5 * excess * volume * n * mu * std::exp(n * logs[b]) *
                          divided_difference(n, logs[a] - logs[b]) / (s.stretch[b] * s.stretch[b]);
  }
  Vector3d change = first;
  Matrix3d curvature = second.asDiagonal();
  if (energy.isochoric()) {
    const Vector3d free = free_of_volume(first), one = Vector3d::Ones();
    change = free - 2.0 / 3.0 * chi * one;
    curvature = diagonal_free_of_volume(second) -
                2.0 / 3.0 * (one * free.transpose() + free * one.transpose()) +
                4.0 / 9.0 * chi * one * one.transpose();
  }
  s.slope = 0.5 * volume * chi;
  s.slope_change = 0.5 * volume * change;
  s.energy += excess * s.slope;
  s.tau += excess * s.slope_change;
  s.change += 0.5 * excess * volume * curvature;
}

/// W/G; for full stretches with -g ln J (StretchSums).
Spectral spectral_of(const StrainEnergy& energy, const Matrix3d& F, double J, double excess) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(F.transpose() * F);
  Spectral s;
  s.axes = solver.eigenvectors();
  s.stretch = solver.eigenvalues().cwiseSqrt();
  const double mean = energy.isochoric() ? std::log(J) / 3.0 : 0.0;
  const Vector3d logs = s.stretch.array().log() - mean;
  const StretchSums<double> sums = stretch_sums(energy.shape, {logs[0], logs[1], logs[2]});
  s.energy = sums.energy;
  s.tau = Vector3d::Map(sums.tau);
  const Vector3d gamma = Vector3d::Map(sums.gamma);
  for (std::size_t term = 0; term < 3; ++term) {
    const double mu = energy.shape[2 * term], alpha = energy.shape[2 * term + 1];
    if (mu == 0.0) continue;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        s.secant(a, b) += 2.0 * mu / alpha * std::exp(alpha * logs[b]) *
                          divided_difference(alpha, logs[a] - logs[b]) /
                          (s.stretch[b] * s.stretch[b]);
  }
  s.change = gamma.asDiagonal();
  if (energy.isochoric()) {
    s.tau = free_of_volume(s.tau);
    s.change = diagonal_free_of_volume(gamma);
  }
  add_excess(energy, sums, logs, J, excess, s);
  return s;
}

/// P = U diag(tau/l) Vᵀ.
Matrix3d stress_of(const Spectral& s, const Vector3d& tau, const Matrix3d& F) {
  const Vector3d along = tau.array() / s.stretch.array().square();
  return F * s.axes * along.asDiagonal() * s.axes.transpose();
}

/// In the principal axes dP_aa/dF_bb = (dtau_a/dln l_b - tau_a d_ab)/(l_a l_b), dP_ab/dF_ab = S,
/// dP_ab/dF_ba = S l_b/l_a - tau_b/(l_a l_b) with S the secant.
Matrix9d tangent_of(const Spectral& s, const Matrix3d& F) {
  const Matrix3d U = F * s.axes * s.stretch.cwiseInverse().asDiagonal();
  Matrix9d local = Matrix9d::Zero(), turn;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double product = s.stretch[a] * s.stretch[b];
      local(4 * a, 4 * b) = (s.change(a, b) - (a == b ? s.tau[a] : 0.0)) / product;
      if (a == b) continue;
      const double S = s.secant(a, b);
      local(3 * a + b, 3 * a + b) = S;
      local(3 * a + b, 3 * b + a) = (S * s.stretch[b] * s.stretch[b] - s.tau[b]) / product;
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) turn(3 * i + J, 3 * a + b) = U(i, a) * s.axes(J, b);
  return turn * local * turn.transpose();
}

Matrix3d stress_of(const Terms& t, const Matrix3d& F, const Matrix3d& H) {
  Matrix3d P = t.along * F - t.inverse * H;
  if (t.second != 0.0) P += t.second * (F.squaredNorm() * F - F * (F.transpose() * F));
  return P;
}

/// dH_iJ/dF_kL = -H_kJ H_iL, dJ/dF = J H; d(F C) = dF C + F dFᵀ F + F Fᵀ dF.
Matrix9d tangent_of(const Terms& t, const Matrix3d& F, const Matrix3d& H) {
  Matrix9d tangent;
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J) {
      const double of_H = t.normal * H(i, J) + t.mixed * F(i, J),
                   of_F = t.mixed * H(i, J) + t.curvature * F(i, J);
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L)
          tangent(3 * i + J, 3 * k + L) =
              t.inverse * H(k, J) * H(i, L) + of_H * H(k, L) + of_F * F(k, L);
    }
  tangent.diagonal().array() += t.along;
  if (t.second == 0.0) return tangent;
  const double I1 = F.squaredNorm();
  const Matrix3d C = F.transpose() * F, B = F * F.transpose(), M = I1 * F - F * C;
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J)
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L)
          tangent(3 * i + J, 3 * k + L) +=
              t.second * (2.0 * F(i, J) * F(k, L) - F(i, L) * F(k, J) - (i == k ? C(L, J) : 0.0) -
                          (J == L ? B(i, k) : 0.0)) +
              t.mixed_second * (M(i, J) * H(k, L) + H(i, J) * M(k, L));
  tangent.diagonal().array() += t.second * I1;
  return tangent;
}

}  // namespace

double volumetric_modulus(const Rubber& rubber) {
  if (rubber.energy.isochoric()) return rubber.bulk_modulus();
  const double G = rubber.shear_modulus,
               left = rubber.lame_lambda() - rubber.energy.lambda_share() * G;
  return std::abs(left) < 1e-12 * G ? 0.0 : left;  // in other units than the user's
}

std::vector<Violation> large_strain_violations(const Rubber& rubber) {
  const StrainEnergy& energy = rubber.energy;
  if (energy.law == RubberLaw::linear) {
    return {{"rubber.law", "linear", "finite strain needs a law of large strain",
             "take neo-hookean or another law, or small strain"}};
  }
  if (volumetric_modulus(rubber) >= 0.0) return {};
  const std::string limit = energy.logarithmic() ? "0" : "infinity";
  if (energy.lambda_share() == 0.0) {
    return {{"rubber.youngs_modulus", to_text(rubber.youngs_modulus) + " Pa",
             "finite strain needs nu >= 0, that is E >= 2G: with a negative Lame constant lambda "
             "the energy falls without bound as J -> " +
                 limit,
             "raise youngs_modulus to 2 shear_modulus or more, or use small strain"}};
  }
  return {{"rubber.volumetric", std::string(name(energy.volumetric)),
           "with full invariants, the law " + std::string(name(energy.law)) +
               " takes more of lambda at rest than there is: the energy falls without bound as J "
               "-> " +
               limit,
           "take volumetric = \"quadratic\", or raise Poisson's ratio"}};
}

HyperelasticLaw::HyperelasticLaw(const Rubber& rubber)
    : energy_(rubber.energy),
      shear_modulus_(rubber.shear_modulus),
      volumetric_modulus_(fingertip::meshes::volumetric_modulus(rubber)) {
  auto broken = rubber.violations();
  if (broken.empty()) broken = large_strain_violations(rubber);
  if (!broken.empty()) throw InvalidInput(std::move(broken));
}

VolumetricMeasure HyperelasticLaw::volumetric(double J) const {
  require_positive(J);
  if (!energy_.logarithmic()) return {J - 1.0, 1.0, 0.0};
  return {std::log(J), 1.0 / J, -1.0 / (J * J)};
}

namespace {

void add_volumetric(Terms& terms, const StrainEnergy& energy, double m, double J) {
  const VolumetricTerms<double> v = volumetric_terms(energy, m, J, std::log(J));
  terms.energy += v.energy;
  terms.inverse -= v.pressure;
  terms.normal += v.stiffness;
}

FluctuatingResponse respond(const StrainEnergy& energy, double G, const Matrix3d& F, double m,
                            bool whole, double excess) {
  const Inverse inverse(F);
  const Matrix3d& H = inverse.transposed;
  FluctuatingResponse response;
  if (energy.law == RubberLaw::ogden) {
    Terms terms;
    if (whole) add_volumetric(terms, energy, m, inverse.J);
    const Spectral s = spectral_of(energy, F, inverse.J, excess);
    response.energy = terms.energy + G * s.energy;
    response.stress = stress_of(terms, F, H) + G * stress_of(s, s.tau, F);
    response.tangent = tangent_of(terms, F, H) + G * tangent_of(s, F);
    response.slope = G * s.slope;
    response.mixed = G * stress_of(s, s.slope_change, F);
    return response;
  }
  Terms terms = terms_of_invariants(energy, G, F, inverse.J, excess);
  const double third = F.squaredNorm() / 3.0;
  response.slope = 0.5 * (terms.along + terms.second * (third - excess / 3.0));
  response.curvature = 0.25 * terms.curvature;
  response.mixed = (0.5 * terms.curvature + terms.second / 3.0) * F +
                   0.5 * (terms.mixed + terms.mixed_second * (third - excess / 3.0)) * H;
  if (whole) add_volumetric(terms, energy, m, inverse.J);
  response.energy = terms.energy;
  response.stress = stress_of(terms, F, H);
  response.tangent = tangent_of(terms, F, H);
  return response;
}

}  // namespace

PointResponse HyperelasticLaw::pointwise(const Matrix3d& F) const {
  return respond(energy_, shear_modulus_, F, volumetric_modulus_, false, 0.0);
}

PointResponse HyperelasticLaw::complete(const Matrix3d& F) const {
  return respond(energy_, shear_modulus_, F, volumetric_modulus_, true, 0.0);
}

FluctuatingResponse HyperelasticLaw::fluctuating(const Matrix3d& F, double excess) const {
  return respond(energy_, shear_modulus_, F, volumetric_modulus_, true, excess);
}

double HyperelasticLaw::energy(const Matrix3d& F, double excess) const {
  const double J = F.determinant();
  if (!(J > 0.0)) return std::numeric_limits<double>::infinity();
  try {
    const double h = volumetric(J).value,
                 shape = energy_.law == RubberLaw::ogden
                             ? shear_modulus_ * spectral_of(energy_, F, J, excess).energy
                             : terms_of_invariants(energy_, shear_modulus_, F, J, excess).energy;
    return shape + 0.5 * volumetric_modulus_ * h * h;
  } catch (const std::domain_error&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace fingertip::meshes::inline rubber
