#include "calibration/surrogate/surrogate.h"

#include <algorithm>
#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::calibration::inline surrogate {
namespace {

using meshes::to_text;
using meshes::Violation;

/// A cubic on [0, h] by its end values and slopes.
struct Cubic {
  double h, f0, f1, s0, s1;

  double value(double x) const {
    const double t = x / h, u = 1.0 - t;
    return u * u * ((1.0 + 2.0 * t) * f0 + x * s0) + t * t * ((3.0 - 2.0 * t) * f1 - (h - x) * s1);
  }
  /// Bernstein's coefficients of the derivative, a quadratic.
  double middle() const { return 3.0 * (f1 - f0) / h - s0 - s1; }
  double slope(double x) const {
    const double t = x / h, u = 1.0 - t;
    return u * u * s0 + 2.0 * u * t * middle() + t * t * s1;
  }
  /// Least slope, at an end or where the quadratic turns.
  double min_slope() const {
    const double m = middle(), bend = s0 - 2.0 * m + s1;
    const double turn = bend > 0.0 ? (s0 - m) / bend * h : -1.0;
    const double ends = std::min(s0, s1);
    return turn > 0.0 && turn < h ? std::min(ends, slope(turn)) : ends;
  }
};

Cubic cubic(const SurrogateTable& t, std::size_t k) {
  return {t.knots[k + 1] - t.knots[k], t.force[k], t.force[k + 1], t.stiffness[k],
          t.stiffness[k + 1]};
}

}  // namespace

std::vector<Violation> SurrogateTable::violations() const {
  const std::size_t n = knots.size();
  const std::string remedy = "make the curve anew";
  if (n < 2 || force.size() != n || stiffness.size() != n || band.size() != n)
    return {{"surrogate", std::to_string(n) + " knots",
             "knots, force, stiffness and band must be lists of one length, at least 2", remedy}};
  std::vector<Violation> found;
  const auto require = [&](bool holds, const char* key, std::size_t k, double value,
                           const char* rule) {
    if (!holds && found.empty())
      found.push_back(
          {std::string(key) + "[" + std::to_string(k) + "]", to_text(value), rule, remedy});
  };
  // Beyond these sizes differences and slopes are no longer numbers.
  constexpr double largest = 1e60, least = 1.0 / largest;
  const auto plausible = [](double v) { return std::abs(v) <= largest; };
  const auto not_negative = [&](double v) { return plausible(v) && v >= 0.0; };
  require(knots[0] == 0.0, "knots", 0, knots[0], "the first knot is 0");
  require(force[0] == 0.0, "force", 0, force[0], "the force at 0 is 0");
  for (std::size_t k = 0; k < n; ++k) {
    require(plausible(knots[k]) && (k == 0 || knots[k] - knots[k - 1] >= least), "knots", k,
            knots[k], "knots must be finite and increase");
    require(plausible(force[k]), "force", k, force[k], "forces must be finite");
    require(not_negative(stiffness[k]), "stiffness", k, stiffness[k],
            "a stiffness must not be negative");
    require(not_negative(band[k]), "band", k, band[k], "a half width must not be negative");
  }
  require(force[n - 1] > 0.0, "force", n - 1, force[n - 1], "the last force must be positive");
  if (!found.empty()) return found;
  const double round_off = 1e-9 * force.back() / knots.back();
  for (std::size_t k = 0; k + 1 < n; ++k)
    require(
        cubic(*this, k).min_slope() >= -round_off && force[k + 1] >= force[k] - 1e-9 * force.back(),
        "force", k, force[k], "the force must not fall between its knots");
  return found;
}

Surrogate::Surrogate(SurrogateTable table) : table_(std::move(table)) {
  const std::vector<Violation> broken = table_.violations();
  if (!broken.empty()) throw meshes::InvalidInput(broken);
}

std::size_t Surrogate::interval(double indentation) const {
  const auto after =
      std::upper_bound(table_.knots.begin() + 1, table_.knots.end() - 1, indentation);
  return std::size_t(after - table_.knots.begin()) - 1;
}

double Surrogate::force(double indentation) const {
  if (indentation <= 0.0) return 0.0;
  if (!(indentation < depth()))  // not a number stays one
    return table_.force.back() + table_.stiffness.back() * (indentation - depth());
  const std::size_t k = interval(indentation);
  return cubic(table_, k).value(indentation - table_.knots[k]);
}

double Surrogate::stiffness(double indentation) const {
  if (indentation < 0.0) return 0.0;
  if (indentation >= depth()) return table_.stiffness.back();
  const std::size_t k = interval(indentation);
  return std::max(0.0, cubic(table_, k).slope(indentation - table_.knots[k]));
}

double Surrogate::band(double indentation) const {
  if (indentation < 0.0) return 0.0;
  if (!(indentation < depth()))
    return table_.band.back() * force(indentation) / table_.force.back();
  const std::size_t k = interval(indentation);
  const double share = (indentation - table_.knots[k]) / (table_.knots[k + 1] - table_.knots[k]);
  return table_.band[k] + share * (table_.band[k + 1] - table_.band[k]);
}

}  // namespace fingertip::calibration::inline surrogate
