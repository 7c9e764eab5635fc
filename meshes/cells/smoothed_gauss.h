/// Gauss's rule for integrands with square roots at the ends of their interval.
#pragma once

#include <array>
#include <boost/math/quadrature/gauss.hpp>

namespace fingertip::meshes::inline cells {

/// A point and its weight of a quadrature on [0, 1].
struct QuadratureNode {
  double at;
  double weight;
};

/// With 7 nodes the error of cut cells is ten to a thousand times larger.
constexpr int smoothed_nodes = 10;

/// Ten nodes in s with x = s²(3 - 2s): square roots at either end, which stem from silhouettes,
/// become smooth in s. Exact for x⁰ and x¹.
inline const std::array<QuadratureNode, smoothed_nodes>& smoothed_gauss_rule() {
  static const auto rule = [] {
    using Gauss = boost::math::quadrature::gauss<double, smoothed_nodes>;
    std::array<QuadratureNode, smoothed_nodes> nodes;
    constexpr std::size_t half = smoothed_nodes / 2;
    for (std::size_t i = 0; i < half; ++i)
      for (const double side : {-1.0, 1.0}) {
        const double s = 0.5 * (1.0 + side * Gauss::abscissa()[i]);
        const double weight = 0.5 * Gauss::weights()[i] * 6.0 * s * (1.0 - s);
        nodes[side < 0.0 ? half - 1 - i : half + i] = {s * s * (3.0 - 2.0 * s), weight};
      }
    return nodes;
  }();
  return rule;
}

}  // namespace fingertip::meshes::inline cells
