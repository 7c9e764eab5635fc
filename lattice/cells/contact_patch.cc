#include "lattice/cells/contact_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::lattice {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

void add_mirror_images(std::vector<LoadedPoint>& points, const Vector2d& mirror) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    LoadedPoint image = points[i];
    image.place = image.place.cwiseProduct(mirror);
    points.push_back(image);
  }
}

double pressure_around(const Vector2d& place, const std::vector<LoadedPoint>& points,
                       double width) {
  double force = 0.0, area = 0.0;
  for (const LoadedPoint& p : points) {
    const double weight = 1.0 - (p.place - place).squaredNorm() / (width * width);
    if (weight <= 0.0) continue;
    force += weight * p.force;
    area += weight * p.area;
  }
  return force / area;
}

}  // namespace

double contact_radius(const std::vector<LoadedPoint>& points) {
  ForceMoments sums;
  for (const LoadedPoint& p : points) {
    sums.force += p.force;
    sums.first += p.force * p.place;
    sums.second += p.force * p.place * p.place.transpose();
    sums.area += p.force * p.area;
  }
  return contact_radius(sums);
}

double contact_radius(const ForceMoments& sums) {
  if (!(sums.force > 0.0)) return 0.0;
  const Vector2d centre = sums.first / sums.force;
  const double own = sums.area / sums.force / (4.0 * std::numbers::pi);  // of a disc
  const Matrix2d moments =
      sums.second / sums.force - centre * centre.transpose() + own * Matrix2d::Identity();
  return std::pow(25.0 * std::max(moments.determinant(), 0.0), 0.25);
}

ContactPatch contact_patch(std::vector<LoadedPoint> points, int sectors, double width) {
  const std::size_t own = points.size();
  if (sectors > 1) add_mirror_images(points, {1.0, -1.0});
  if (sectors > 2) add_mirror_images(points, {-1.0, 1.0});
  ContactPatch patch;
  patch.radius = contact_radius(points);
  for (std::size_t i = 0; i < own; ++i) {
    if (points[i].force <= 0.0) continue;
    patch.max_pressure =
        std::max(patch.max_pressure, pressure_around(points[i].place, points, width));
  }
  return patch;
}

}  // namespace fingertip::lattice
