#include "tests/verification/axisymmetric/meridian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::verification {
namespace {

/// Ends of elements on (0, length], from size `first` growing up to `largest`; appended to `ends`,
/// shifted by `start`. The last element is as large as the others allow.
void grow(double start, double length, double first, double largest, double growth,
          std::vector<double>& ends) {
  std::vector<double> sizes;
  double sum = 0.0;
  for (double size = first; sum < length; size = std::min(size * growth, largest)) {
    sizes.push_back(size);
    sum += size;
  }
  double at = start;
  for (const double size : sizes) ends.push_back(at += size * length / sum);
  ends.back() = start + length;
}

/// Every interval in 2 `parts` equal ones: corners and midpoints of quadratic elements.
std::vector<double> nodes_between(const std::vector<double>& ends, int parts) {
  std::vector<double> nodes{ends.front()};
  for (std::size_t k = 1; k < ends.size(); ++k)
    for (int i = 1; i <= 2 * parts; ++i)
      nodes.push_back(ends[k - 1] + (ends[k] - ends[k - 1]) * i / (2.0 * parts));
  return nodes;
}

/// Lengths along the outer meridian from the pole, in units of R.
std::vector<double> divide_meridian(const meshes::Geometry& geometry,
                                    const MeridianOptions& options, double largest) {
  const double quarter = std::numbers::pi / 2.0;
  const double angle = std::min(options.contact_angle, 0.9 * quarter);
  const double size = angle / options.contact_elements;
  std::vector<double> ends{0.0};
  for (int i = 1; i <= options.contact_elements; ++i) ends.push_back(size * i);
  grow(angle, quarter - angle, size, largest, options.growth, ends);
  if (geometry.sleeve_length > 0.0)
    grow(quarter, geometry.sleeve_length / geometry.tip_radius, largest, largest, options.growth,
         ends);
  return ends;
}

/// Distances from the rod, in units of R - r: fine at both surfaces.
std::vector<double> divide_thickness(const MeridianOptions& options) {
  std::vector<double> half;
  grow(0.0, 0.5, options.surface_share, options.largest_share, options.growth, half);
  std::vector<double> ends{0.0};
  ends.insert(ends.end(), half.begin(), half.end());
  for (auto it = half.rbegin() + 1; it != half.rend(); ++it) ends.push_back(1.0 - *it);
  ends.push_back(1.0);
  return ends;
}

}  // namespace

Meridian mesh_meridian(const meshes::Geometry& geometry, const MeridianOptions& options) {
  const double R = geometry.tip_radius, r = geometry.rod_radius, quarter = std::numbers::pi / 2.0;
  const double largest = options.largest_share * geometry.thickness() / R;
  const auto along = nodes_between(divide_meridian(geometry, options, largest), options.parts);
  const auto across = nodes_between(divide_thickness(options), options.parts);
  Meridian mesh;
  mesh.along = int(along.size());
  mesh.across = int(across.size());
  for (const double s : along) {
    const bool sleeve = s > quarter;
    for (const double t : across) {
      const double radius = r + t * (R - r);
      if (sleeve)
        mesh.nodes.emplace_back(radius, -(s - quarter) * R);
      else
        mesh.nodes.emplace_back(s == 0.0 ? 0.0 : radius * std::sin(s), radius * std::cos(s));
    }
    if (!sleeve) mesh.cap = int(mesh.nodes.size()) / mesh.across - 1;
  }
  for (int i = 0; i + 2 < mesh.along; i += 2)
    for (int j = 0; j + 2 < mesh.across; j += 2) {
      std::array<int, 9> element{};
      for (int k = 0; k < 9; ++k) element[std::size_t(k)] = (i + k / 3) * mesh.across + j + k % 3;
      mesh.elements.push_back(element);
    }
  return mesh;
}

}  // namespace fingertip::verification
