#include "meshes/press/contact_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::meshes::inline press {

namespace {

/// Nearer than a picometre to a mirror plane is on it.
constexpr double on_plane = 1e-12;

}  // namespace

void ContactPoint::set_force(const Vector3& force) {
  const Vector3 traction = force / area;
  normal_traction = traction.dot(normal);
  shear = traction - normal_traction * normal;
}

void add_sample(std::span<const ContactPoint> points, int sample, double indentation,
                std::vector<ContactPoint>& field) {
  for (const ContactPoint& point : points) {
    field.push_back(point);
    field.back().sample = sample;
    field.back().indentation = indentation;
  }
}

std::vector<ContactPoint> unfolded(std::span<const ContactPoint> points, int sectors) {
  std::vector<ContactPoint> all(points.begin(), points.end());
  const auto add_images = [&all](int axis) {
    const std::size_t count = all.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (std::abs(all[i].place[axis]) < on_plane) {
        all[i].area *= 2.0;
        for (Vector3* vector : all[i].vectors()) (*vector)[axis] = 0.0;
        continue;
      }
      ContactPoint image = all[i];
      for (Vector3* vector : image.vectors()) (*vector)[axis] = -(*vector)[axis];
      all.push_back(image);
    }
  };
  if (sectors > 1) add_images(1);
  if (sectors > 2) add_images(0);
  return all;
}

std::vector<ContactPoint> turned_around(const ContactPoint& ring, int count) {
  std::vector<ContactPoint> all(std::size_t(count), ring);
  const double radius = ring.place.head<2>().norm(),
               reach = radius > 0.0 ? std::max(std::numbers::pi * radius / count,
                                               0.25 * ring.area / (std::numbers::pi * radius))
                                    : 0.0;
  for (int i = 0; i < count; ++i) {
    ContactPoint& point = all[std::size_t(i)];
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * (i + 0.5) / count, Vector3::UnitZ());
    point.area = ring.area / count;
    point.reach = reach;
    for (Vector3* vector : point.vectors()) *vector = turn * *vector;
  }
  return all;
}

ContactSums sums_of(std::span<const ContactPoint> points, const Vector3& about) {
  ContactSums sums;
  for (const ContactPoint& point : points) {
    const Vector3 force = point.force();
    sums.force += force;
    sums.torque += (point.place - about).cross(force);
  }
  return sums;
}

double contact_radius(std::span<const ContactPoint> points) {
  double area = 0.0;
  for (const ContactPoint& point : points) area += point.area * std::abs(point.normal.z());
  return std::sqrt(area / std::numbers::pi);
}

Vector3 centre_of_pressure(std::span<const ContactPoint> points) {
  double force = 0.0;
  Vector3 sum = Vector3::Zero();
  for (const ContactPoint& point : points) {
    const double push = point.area * point.normal_traction;
    force += push;
    sum += push * point.place;
  }
  return sum / force;
}

double spin_torque(std::span<const ContactPoint> points) {
  return points.empty() ? 0.0 : -sums_of(points, centre_of_pressure(points)).torque.z();
}

}  // namespace fingertip::meshes::inline press
