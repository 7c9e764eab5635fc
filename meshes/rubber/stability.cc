#include "meshes/rubber/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/base/files.h"
#include "meshes/rubber/law_terms.h"

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
  const PrincipalResponse<double> r =
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

std::vector<Violation> violations(const StrainEnergy& energy) {
  const auto& [law, volumetric, shape] = energy;
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
  if (const auto fails = first_instability(energy, 0.5, 2.0)) {
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

}  // namespace fingertip::meshes::inline rubber
