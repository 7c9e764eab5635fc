#include "meshes/rubber/strain_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline rubber {
namespace {

using Three = std::array<double, 3>;

constexpr double coarsest_step = 0.01;  // of ln l, in the search for the end of stability

/// The logarithms of the stretches of a test.
Three logarithms(SheetTest test, double along) {
  switch (test) {
    case SheetTest::uniaxial: return {along, -0.5 * along, -0.5 * along};
    case SheetTest::equibiaxial: return {along, along, -2.0 * along};
    case SheetTest::planar: return {along, 0.0, -along};
  }
  return {};
}

/// Changes that keep the volume: dl1 and dl2 are free, dl3 = -dl1 - dl2.
bool stable(const StrainEnergy& energy, const Three& logs) {
  const PrincipalResponse r =
      principal_response(energy, {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2])});
  const auto& t = r.tangent;
  if (r.energy == std::numeric_limits<double>::infinity()) return true;  // locked, not soft
  const double along_1 = t[0][0] - 2.0 * t[0][2] + t[2][2],
               along_2 = t[1][1] - 2.0 * t[1][2] + t[2][2];
  // The determinant of both as the sum of the tangent's cofactors: along_1 along_2 minus the mixed
  // term's square would lose it where one direction is 1e16 times stiffer than the others.
  double determinant = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    determinant += t[j][j] * t[k][k] - t[j][k] * t[j][k];
    determinant += 2.0 * (t[i][j] * t[i][k] - t[j][k] * t[i][i]);
  }
  return along_1 > 0.0 && along_2 > 0.0 && determinant > 0.0;
}

/// As far as `end`; the last stable place is found by bisection.
std::optional<double> leaves(const StrainEnergy& energy, SheetTest test, double end) {
  const int steps = int(std::ceil(std::abs(end) / coarsest_step));
  for (int i = 0; i <= steps; ++i) {
    double outside = end * i / steps;
    if (stable(energy, logarithms(test, outside))) continue;
    double inside = end * std::max(i - 1, 0) / steps;
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (inside + outside);
      (stable(energy, logarithms(test, middle)) ? inside : outside) = middle;
    }
    return outside;
  }
  return std::nullopt;
}

PrincipalResponse of_ogden(const StrainEnergy& energy, const Three& stretch) {
  PrincipalResponse r;
  for (std::size_t term = 0; term < 3; ++term) {
    const double mu = energy.shape[2 * term], alpha = energy.shape[2 * term + 1];
    if (mu == 0.0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double exponent = alpha * std::log(stretch[k]), power = std::exp(exponent);
      r.energy += 2.0 * mu / (alpha * alpha) * std::expm1(exponent);
      r.kirchhoff[k] += 2.0 * mu / alpha * power;
      r.tangent[k][k] += 2.0 * mu * power;
    }
  }
  return r;
}

/// Where the coefficients stand.
std::string_view key_of(RubberLaw law) {
  switch (law) {
    case RubberLaw::yeoh: return "yeoh";
    case RubberLaw::mooney_rivlin: return "mooney_rivlin";
    case RubberLaw::ogden: return "ogden";
    case RubberLaw::gent: return "gent_jm";
    default: return "law";
  }
}

}  // namespace

PrincipalResponse principal_response(const StrainEnergy& energy, const Three& stretch) {
  if (energy.law == RubberLaw::ogden) return of_ogden(energy, stretch);
  Three square;
  std::ranges::transform(stretch, square.begin(), [](double l) { return l * l; });
  const double I1 = square[0] + square[1] + square[2];
  const InvariantSlopes d = invariant_slopes(energy, I1 - 3.0);
  PrincipalResponse r;
  r.energy = d.energy;
  for (std::size_t k = 0; k < 3; ++k) {
    // dI1 = 2 l² d(ln l), dI2 = 2 (I1 - l²) l² d(ln l)
    r.kirchhoff[k] = 2.0 * square[k] * (d.first + d.second * (I1 - square[k]));
    for (std::size_t m = 0; m < 3; ++m)
      r.tangent[k][m] = 4.0 * square[k] * square[m] * (d.curvature + (m == k ? 0.0 : d.second));
    r.tangent[k][k] += 2.0 * r.kirchhoff[k];
  }
  const double I2 = square[0] * square[1] + square[1] * square[2] + square[2] * square[0];
  r.energy += d.second * (I2 - 3.0);
  return r;
}

InvariantSlopes invariant_slopes(const StrainEnergy& energy, double above) {
  const auto& s = energy.shape;
  switch (energy.law) {
    case RubberLaw::yeoh:
      return {above * (0.5 + above * (s[0] + above * s[1])),
              0.5 + above * (2.0 * s[0] + 3.0 * above * s[1]), 0.0,
              2.0 * s[0] + 6.0 * above * s[1]};
    case RubberLaw::mooney_rivlin:
      return {0.5 * (1.0 - s[0]) * above, 0.5 * (1.0 - s[0]), 0.5 * s[0], 0.0};
    case RubberLaw::gent: {
      const double left = 1.0 - above / s[0];
      if (!(left > 0.0)) return {std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0};
      return {-0.5 * s[0] * std::log1p(-above / s[0]), 0.5 / left, 0.0, 0.5 / (s[0] * left * left)};
    }
    default: return {0.5 * above, 0.5, 0.0, 0.0};
  }
}

double StrainEnergy::lambda_share() const {
  switch (law) {
    case RubberLaw::yeoh: return 8.0 * shape[0];
    case RubberLaw::mooney_rivlin: return 2.0 * shape[0];
    case RubberLaw::gent: return 2.0 / shape[0];
    default: return 0.0;
  }
}

std::vector<Violation> StrainEnergy::violations() const {
  std::vector<Violation> found;
  const auto refuse = [&](const char* key, double value, const char* rule, const char* remedy) {
    found.push_back({key, to_text(value), rule, remedy});
  };
  for (const double number : shape) {
    if (std::isfinite(number)) continue;
    refuse("rubber.law", number, "coefficients must be finite", "give the law's coefficients");
    return found;
  }
  if (law == RubberLaw::gent && !(shape[0] > 0.0)) {
    refuse("rubber.gent_jm", shape[0], "Jm, the largest I1 - 3, must be positive",
           "give the largest I1 - 3 the rubber can be stretched to");
  } else if (law == RubberLaw::ogden) {
    for (std::size_t term = 0; term < 3; ++term) {
      if (shape[2 * term] != 0.0 && shape[2 * term + 1] == 0.0)
        refuse("rubber.ogden", 0.0, "exponents must not be 0", "give another exponent");
    }
    const double sum = shape[0] + shape[2] + shape[4];
    if (std::abs(sum - 1.0) > 1e-9)
      refuse("rubber.ogden", sum, "mu_i/G must sum to 1", "let the mu_i sum to the shear modulus");
  }
  const bool always_stable = law == RubberLaw::linear || law == RubberLaw::neo_hookean;
  if (!found.empty() || always_stable) return found;
  if (const auto fails = first_instability(*this, 0.5, 2.0)) {
    found.push_back(
        {std::string("rubber.") + std::string(key_of(law)), std::string(name(law)),
         "the law must be stable (Drucker) between the stretches 0.5 and 2; it fails at " +
             to_text(fails->stretch) + " in " + std::string(name(fails->test)) +
             " tension or compression",
         "take other coefficients, fewer terms, or fit them with tests that reach there"});
  }
  return found;
}

std::optional<Instability> first_instability(const StrainEnergy& energy, double shortest,
                                             double longest) {
  std::optional<Instability> nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (const SheetTest test : {SheetTest::uniaxial, SheetTest::equibiaxial, SheetTest::planar}) {
    for (const double end : {std::log(shortest), std::log(longest)}) {
      const auto at = leaves(energy, test, end);
      if (!at || !(std::abs(*at) < distance)) continue;
      distance = std::abs(*at);
      nearest = {test, std::exp(*at)};
    }
  }
  return nearest;
}

std::string describe(const StrainEnergy& energy) {
  return std::string(name(energy.law)) + ", " + std::string(name(energy.volumetric));
}

}  // namespace fingertip::meshes::inline rubber
