/// The laws of strain_energy.h, written once for every number: double, packs of cells, ceres::Jet.
/// What follows from a deformation gradient is the caller's (hyperelastic_law.h,
/// lattice/kernels/cell_hyperelastic.h), so are stretches beyond the limit of a gent law.
///
/// What kernels ask for is always inlined: they are compiled for several instruction sets, and no
/// compiled copy may be shared.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "meshes/rubber/strain_energy.h"

namespace fingertip::meshes::inline rubber {

/// The functions of a number that has those of <cmath>.
struct Elementary {
  template <typename Number>
  static Number log1p(const Number& x) {
    using std::log1p;
    return log1p(x);
  }
  /// e^x and e^x - 1.
  template <typename Number>
  static std::pair<Number, Number> exponential(const Number& x) {
    using std::exp, std::expm1;
    return {exp(x), expm1(x)};
  }
  /// (e^(a y) - 1)/a, of which `more` is the numerator; smooth at a = 0, with its derivatives.
  template <typename Number>
  static Number quotient(const Number& more, const Number& a, const Number& y) {
    const Number x = a * y;
    if (x > -1e-4 && x < 1e-4) return y * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x / 24.0)));
    return more / a;
  }
  template <typename Number>
  static Number reciprocal(const Number& x) {
    return Number(1.0) / x;
  }
};

/// W/G of a law of the invariants less its part in I2, which is `second` (I2 - 3), with dW/dI1,
/// dW/dI2 and d²W/dI1². `margin`: what is left of a gent law's stretch, 1 - (I1 - 3)/Jm, else 1;
/// where it is not positive the other members mean nothing.
template <typename Number>
struct InvariantSlopes {
  Number energy, first, second, curvature, margin;
};
/// At x = I1 - 3. `shape` as in StrainEnergy.
template <typename Math = Elementary, typename Number, typename Shape>
[[gnu::always_inline]] inline InvariantSlopes<Number> invariant_slopes(
    RubberLaw law, const std::array<Shape, 6>& shape, const Number& x) {
  const Number half = Number(0.5), none = Number(0.0), one = Number(1.0);
  switch (law) {
    case RubberLaw::yeoh: {
      const Number c2(shape[0]), c3(shape[1]);
      return {x * (half + x * (c2 + x * c3)), half + x * (Number(2.0) * c2 + Number(3.0) * c3 * x),
              none, Number(2.0) * c2 + Number(6.0) * c3 * x, one};
    }
    case RubberLaw::mooney_rivlin: {
      const Number first(0.5 * (1.0 - shape[0]));
      return {first * x, first, Number(0.5 * shape[0]), none, one};
    }
    case RubberLaw::gent: {
      const Number limit(shape[0]), inverse_limit = one / limit, margin = one - x * inverse_limit;
      const Number inverse = Math::reciprocal(margin);
      return {-half * limit * Math::log1p(-x * inverse_limit), half * inverse, none,
              half * inverse_limit * inverse * inverse, margin};
    }
    default: return {half * x, half, none, none, one};
  }
}

/// What laws of full invariants have in -ln J, over G, so that rest is free of stress.
[[gnu::always_inline]] inline double log_share(const StrainEnergy& energy) {
  return energy.law == RubberLaw::mooney_rivlin ? 1.0 + energy.shape[0] : 1.0;
}

/// Sums over the terms of an ogden law, over G: over all stretches 2 mu/alpha² (l^alpha - 1 - alpha
/// ln l), which has in -ln J what leaves rest free of stress, and for each its derivatives with ln
/// l, tau = 2 mu/alpha (l^alpha - 1) and 2 mu l^alpha; with n = alpha - 2, which fluctuations about
/// F cost, mu l^n, n mu l^n, n² mu l^n and |mu| l^n.
template <typename Number>
struct StretchSums {
  Number energy;
  Number tau[3], gamma[3], power[3], power_slope[3], power_curvature[3], power_bound[3];
};
/// `log_l`: the logarithms of the stretches.
template <typename Math = Elementary, typename Number, typename Shape>
[[gnu::always_inline]] inline StretchSums<Number> stretch_sums(const std::array<Shape, 6>& shape,
                                                               const Number (&log_l)[3]) {
  const Number none = Number(0.0);
  StretchSums<Number> s;
  s.energy = none;
  for (int k = 0; k < 3; ++k) {
    s.tau[k] = s.gamma[k] = none;
    s.power[k] = s.power_slope[k] = s.power_curvature[k] = s.power_bound[k] = none;
    const Number inverse = Math::exponential(Number(-2.0) * log_l[k]).first;
    for (std::size_t i = 0; i < 6; i += 2) {
      if (shape[i] == 0.0 && shape[i + 1] == 0.0) continue;
      const Shape mu = shape[i], alpha = shape[i + 1], n = alpha - 2.0;
      const auto [l, more] = Math::exponential(Number(alpha) * log_l[k]);
      const Number power = l * inverse;
      const Number tau = Math::quotient(more, Number(alpha), log_l[k]);
      s.energy += Number(2.0 * mu / alpha) * (tau - log_l[k]);
      s.tau[k] += Number(2.0 * mu) * tau;
      s.gamma[k] += Number(2.0 * mu) * l;
      s.power[k] += Number(mu) * power;
      s.power_slope[k] += Number(mu * n) * power;
      s.power_curvature[k] += Number(mu * n * n) * power;
      s.power_bound[k] += Number(mu < 0.0 ? -mu : mu) * power;
    }
  }
  return s;
}

/// m/2 h(J)² and its first two derivatives with ln J.
template <typename Number>
struct VolumetricTerms {
  Number energy, pressure, stiffness;
};
template <typename Number>
[[gnu::always_inline]] inline VolumetricTerms<Number> volumetric_terms(const StrainEnergy& energy,
                                                                       const Number& m,
                                                                       const Number& J,
                                                                       const Number& log_J) {
  const Number half = Number(0.5);
  if (energy.logarithmic()) return {half * m * log_J * log_J, m * log_J, m};
  const Number h = J - Number(1.0), pressure = m * h * J;
  return {half * m * h * h, pressure, m * J * (J + h)};
}

/// Of a law of I1 and I2, with 1/2 P = psi_1 F + psi_2 M + ..., M = I1 F - F C: 2 psi_1, 2 psi_2,
/// 4 psi_11, and -J psi_J but for the volumetric part. `a`: J^(-2/3) of a law free of the volume,
/// else 1; `d`: its slopes at I1, I2 times a and a².
template <typename Number>
struct InvariantTerms {
  Number first, second, curvature, inverse;
};
template <typename Number>
[[gnu::always_inline]] inline InvariantTerms<Number> invariant_terms(
    const StrainEnergy& energy, const Number& G, const InvariantSlopes<Number>& d, const Number& a,
    const Number& I1, const Number& I2) {
  const Number first = Number(2.0) * G * d.first * a, second = Number(2.0) * G * d.second * a * a;
  return {first, second, Number(4.0) * G * d.curvature * a * a,
          energy.isochoric() ? Number(1.0 / 3.0) * (first * I1 + Number(2.0) * second * I2)
                             : Number(log_share(energy)) * G};
}

/// W/G of an incompressible body and its derivatives with the logarithms of the stretches;
/// `kirchhoff` is known but for a pressure.
template <typename Number>
struct PrincipalResponse {
  Number energy;
  std::array<Number, 3> kirchhoff;
  std::array<std::array<Number, 3>, 3> tangent;
};
/// `stretch`: of volume 1. Infinite energy where a gent law is stretched beyond its limit.
template <typename Number>
PrincipalResponse<Number> principal_response(RubberLaw law, const std::array<Number, 6>& shape,
                                             const std::array<double, 3>& stretch) {
  PrincipalResponse<Number> r{};
  if (law == RubberLaw::ogden) {
    const StretchSums<Number> sums = stretch_sums(
        shape,
        {Number(std::log(stretch[0])), Number(std::log(stretch[1])), Number(std::log(stretch[2]))});
    r.energy = sums.energy;
    for (std::size_t k = 0; k < 3; ++k) {
      r.kirchhoff[k] = sums.tau[k];
      r.tangent[k][k] = sums.gamma[k];
    }
    return r;
  }
  const std::array<double, 3> square = {stretch[0] * stretch[0], stretch[1] * stretch[1],
                                        stretch[2] * stretch[2]};
  const double I1 = square[0] + square[1] + square[2],
               I2 = square[0] * square[1] + square[1] * square[2] + square[2] * square[0];
  const InvariantSlopes<Number> d = invariant_slopes(law, shape, Number(I1 - 3.0));
  r.energy = d.margin > 0.0 ? d.energy + d.second * (I2 - 3.0)
                            : Number(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < 3; ++k) {
    // dI1 = 2 l² d(ln l), dI2 = 2 (I1 - l²) l² d(ln l)
    r.kirchhoff[k] = 2.0 * square[k] * (d.first + d.second * (I1 - square[k]));
    for (std::size_t m = 0; m < 3; ++m)
      r.tangent[k][m] =
          4.0 * square[k] * square[m] * (m == k ? d.curvature : d.curvature + d.second);
    r.tangent[k][k] += 2.0 * r.kirchhoff[k];
  }
  return r;
}
inline PrincipalResponse<double> principal_response(const StrainEnergy& energy,
                                                    const std::array<double, 3>& stretch) {
  return principal_response(energy.law, energy.shape, stretch);
}

}  // namespace fingertip::meshes::inline rubber
