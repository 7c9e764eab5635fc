/// A curve by straight lines between points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace fingertip::meshes::inline tables {

/// y at x of straight lines through (xs, ys), constant beyond their ends. `xs` increasing, as many
/// as `ys`, one or more.
inline double interpolated(std::span<const double> xs, std::span<const double> ys, double x) {
  const auto above = std::ranges::lower_bound(xs, x);
  if (above == xs.begin()) return ys.front();
  if (above == xs.end()) return ys.back();
  const std::size_t i = std::size_t(above - xs.begin());
  return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
}

}  // namespace fingertip::meshes::inline tables
