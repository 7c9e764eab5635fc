/// The largest value of a function on an interval.
#pragma once

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <limits>

namespace fingertip::meshes::inline shape {

struct Peak {
  double at, value;
};

/// Found from `steps` equal steps and then between them (Brent).
Peak peak(double low, double high, int steps, auto&& value) {
  Peak best{low, value(low)};
  const double step = (high - low) / steps;
  for (int i = 1; i <= steps; ++i) {
    const double at = low + i * step, found = value(at);
    if (found > best.value) best = {at, found};
  }
  const auto [at, least] = boost::math::tools::brent_find_minima(
      [&](double t) { return -value(t); }, std::max(low, best.at - step),
      std::min(high, best.at + step), std::numeric_limits<double>::digits);
  return -least > best.value ? Peak{at, -least} : best;
}

}  // namespace fingertip::meshes::inline shape
