#include "meshes/press/footprint_mean.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "meshes/press/local_field.h"

namespace fingertip::meshes::inline press {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using std::numbers::pi;

namespace {

constexpr double narrow = 3.0;         ///< spacings: one polynomial for a disc of this radius
constexpr int most_rings = 3;          ///< of parts of a wide disc
constexpr double corner = 1.5;         ///< of a sector, from its middle, over half its width
constexpr double kept_spacings = 5.0;  ///< around a disc: half of this circle has enough points
constexpr double extrapolated_error = 0.5;  ///< of what is felt beyond the outermost points
constexpr double edge_spacings = 3.5;       ///< from the edge on that may be off
constexpr double most_off = 0.5;            ///< there
constexpr double block_spacings = 4.0;      ///< in which the field is summed up

/// Along a disc's axes; shear turned with the normals, along the shortest way. `edge` as in
/// FlatPoint.
FlatPoint flat(const ContactPoint& point, double edge, const Vector3& middle,
               const Matrix3d& axes) {
  const Vector3 chord = axes.transpose() * (point.rest - middle);
  const double seen = chord.head<2>().norm();
  FlatPoint flat;
  if (seen > 0.0) flat.at = chord.norm() / seen * chord.head<2>();
  flat.warped = axes.transpose() * (point.place - middle);
  flat.warped.head<2>() -= flat.at;
  flat.normal = axes.transpose() * point.normal;
  flat.pressure = point.normal_traction;
  flat.area = point.area;
  flat.edge = edge;
  if (!point.shear.isZero(0.0)) {
    const Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(axes.col(2), -point.normal).toRotationMatrix();
    flat.shear = ((turn * axes).transpose() * point.shear).head<2>();
  }
  return flat;
}

/// The same of the whole contact, seen along the frame's third axis, without shear.
FlatPoint seen(const ContactPoint& point, double edge, const Matrix3d& frame) {
  FlatPoint flat;
  flat.at = (frame.transpose() * point.rest).head<2>();
  flat.warped = frame.transpose() * point.place;
  flat.warped.head<2>() -= flat.at;
  flat.normal = frame.transpose() * point.normal;
  flat.pressure = point.normal_traction;
  flat.area = point.area;
  flat.edge = edge;
  return flat;
}

}  // namespace

FootprintMeans::FootprintMeans(std::span<const ContactPoint> points, const Matrix3d& axes)
    : points_(points) {
  look_along(axes);
  mark_edge();
  list_rings();
  balance();
}

void FootprintMeans::look_along(const Matrix3d& axes) {
  Vector3 normal = Vector3::Zero();
  for (const ContactPoint& point : points_) normal -= point.area * point.normal;
  if (!(normal.norm() > 0.0)) return;
  normal.normalize();
  const Vector3 first = std::abs(axes.col(0).dot(normal)) < 0.9 ? axes.col(0) : axes.col(1),
                second = normal.cross(first).normalized();
  frame_ << second.cross(normal), second, normal;
}

/// How near each point is to the edge of the contact's hull.
void FootprintMeans::mark_edge() {
  Outline outline;
  double area = 0.0;
  for (const ContactPoint& point : points_) {
    outline.push_back({(frame_.transpose() * point.rest).head<2>(), point.area});
    area += point.area;
  }
  if (outline.empty()) return;
  spacing_ = std::sqrt(area / double(points_.size()));
  outline = hull_of(std::move(outline));
  for (const ContactPoint& point : points_) {
    const double depth = -beside(outline, (frame_.transpose() * point.rest).head<2>()).distance;
    edges_.push_back(std::clamp(1.0 - depth / (edge_spacings * spacing_), 0.0, 1.0));
  }
}

void FootprintMeans::list_rings() {
  const auto is_of_ring = [](const ContactPoint& point) { return point.reach > 0.0; };
  if (std::ranges::none_of(points_, is_of_ring)) return;
  const auto radius = [](const ContactPoint& point) { return point.rest.head<2>().norm(); };
  for (std::size_t i = 0; i < points_.size();) {
    const ContactPoint& first = points_[i];
    std::size_t end = i + 1;
    while (end < points_.size() && points_[end].reach == first.reach &&
           std::abs(radius(points_[end]) - radius(first)) < 1e-9 * radius(first))
      ++end;
    Ring ring{first, 0.0, edges_[i]};
    const Eigen::AngleAxisd back(-std::atan2(first.rest.y(), first.rest.x()), Vector3::UnitZ());
    for (Vector3* vector : ring.point.vectors()) *vector = back * *vector;
    ring.point.area *= double(end - i);
    rings_.push_back(ring);
    i = end;
  }
  std::ranges::sort(rings_, {}, [&](const Ring& ring) { return radius(ring.point); });
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    const Vector3 &before = rings_[i == 0 ? 0 : i - 1].point.rest,
                  &after = rings_[i + 1 == rings_.size() ? i : i + 1].point.rest;
    const bool is_between = i > 0 && i + 1 < rings_.size();
    rings_[i].width = (after - before).norm() / (is_between ? 2.0 : 1.0);
  }
}

std::vector<FootprintMeans::Ring> FootprintMeans::images(const Vector3& middle, double apart,
                                                         double within) const {
  std::vector<Ring> found;
  const double angle = std::atan2(middle.y(), middle.x()), away = middle.head<2>().norm();
  for (const Ring& ring : rings_) {
    const double own = ring.point.rest.x(),
                 nearest = std::hypot(own - away, ring.point.rest.z() - middle.z());
    if (nearest > within) continue;
    const double step = std::max(ring.width, apart);
    const int count = own > 0.0 ? std::max(6, int(std::lround(2.0 * pi * own / step))) : 1;
    // A chord of twice the square root of both radii times sin(angle/2).
    const double chord = std::sqrt(within * within - nearest * nearest),
                 half = 2.0 * std::sqrt(own * away),
                 widest = chord < half ? 2.0 * std::asin(chord / half) : pi;
    const int side = std::min(int(widest * count / (2.0 * pi)), count / 2);
    for (int i = std::max(-side, -(count - 1) / 2); i <= side; ++i) {
      const Eigen::AngleAxisd turn(angle + 2.0 * pi * i / count, Vector3::UnitZ());
      ContactPoint& image = found.emplace_back(ring).point;
      image.area /= count;
      for (Vector3* vector : image.vectors()) *vector = turn * *vector;
    }
  }
  return found;
}

/// Sums the field up, block by block, along the radius or in both directions.
void FootprintMeans::balance() {
  double wanted = 0.0;
  for (const ContactPoint& point : points_) wanted += point.area * point.normal_traction;
  if (!(wanted > 0.0)) return;
  double felt = 0.0, at_edge = 0.0;
  const auto add = [&](const std::vector<FlatPoint>& near, const Vector2d& middle, double side,
                       const auto& places) {
    if (near.empty()) return;
    const LocalField field(near, middle, std::numbers::sqrt2 / 2.0 * side);
    double sum = 0.0;
    places(field.is_inside() ? 4 : 10, [&](const Vector2d& place, double area) {
      sum += area * field.at(middle + place).pressure;
    });
    felt += sum;
    at_edge += field.edge() * sum;
  };
  if (!rings_.empty()) {
    double width = 0.0;
    for (const Ring& ring : rings_) width += ring.width / double(rings_.size());
    const double side = block_spacings * width, within = side + kept_spacings * width,
                 first = std::max(0.0, rings_.front().point.rest.x() - 2.0 * width),
                 last = rings_.back().point.rest.x() + 2.0 * width;
    for (double from = first; from < last; from += side) {
      const double middle = from + 0.5 * side;
      const auto nearest = std::ranges::min_element(
          rings_, {}, [&](const Ring& ring) { return std::abs(ring.point.rest.x() - middle); });
      const Vector3 place(middle, 0.0, nearest->point.rest.z());
      std::vector<FlatPoint> near;
      for (const Ring& image : images(place, 0.0, within))
        near.push_back(seen(image.point, image.edge, Matrix3d::Identity()));
      add(near, {middle, 0.0}, side, [&](int count, const auto& take) {
        const double step = side / count;
        for (int i = 0; i < count; ++i) {
          const double across = (i + 0.5) * step - 0.5 * side;
          take({across, 0.0}, 2.0 * pi * (middle + across) * step);
        }
      });
    }
  } else {
    const double side = block_spacings * spacing_, within = side + kept_spacings * spacing_;
    std::vector<FlatPoint> all;
    std::set<std::pair<int, int>> blocks;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector2d at = all.emplace_back(seen(points_[i], edges_[i], frame_)).at / side;
      for (const double x : {-0.5, 0.5})  // an edge may lie in the next block
        for (const double y : {-0.5, 0.5})
          blocks.emplace(int(std::floor(at.x() + x)), int(std::floor(at.y() + y)));
    }
    for (const auto& [i, j] : blocks) {
      const Vector2d middle((i + 0.5) * side, (j + 0.5) * side);
      std::vector<FlatPoint> near;
      for (const FlatPoint& point : all)
        if ((point.at - middle).squaredNorm() < within * within) near.push_back(point);
      add(near, middle, side, [&](int count, const auto& take) {
        const double step = side / count;
        for (int m = 0; m < count; ++m)
          for (int n = 0; n < count; ++n)
            take({(m + 0.5) * step - 0.5 * side, (n + 0.5) * step - 0.5 * side}, step * step);
      });
    }
  }
  if (at_edge > 0.0) lacking_ = std::clamp((wanted - felt) / at_edge, -most_off, most_off);
}

FootprintMean FootprintMeans::over(const Vector3& middle, const Matrix3d& axes,
                                   double radius) const {
  // The nearest point, and how far apart they are there.
  double nearest = std::numeric_limits<double>::infinity(), spacing = 0.0;
  std::vector<double> squares;
  if (rings_.empty()) {
    squares.reserve(points_.size());
    for (const ContactPoint& point : points_) {
      squares.push_back((point.rest - middle).squaredNorm());
      if (squares.back() < nearest) nearest = squares.back(), spacing = point.area;
    }
  } else {
    const double away = middle.head<2>().norm();
    for (const Ring& ring : rings_) {
      const double square =
          std::pow(ring.point.rest.x() - away, 2) + std::pow(ring.point.rest.z() - middle.z(), 2);
      if (square < nearest) nearest = square, spacing = ring.width * ring.width;
    }
  }
  nearest = std::sqrt(nearest), spacing = std::sqrt(spacing);
  if (!(nearest <= radius + LocalField::farthest_edge * spacing)) return {};

  const int rings =
      std::clamp(int(std::ceil(0.5 * (radius / (narrow * spacing) + 1.0))), 1, most_rings);
  const double part = radius / (2 * rings - 1);
  double within = radius + kept_spacings * spacing;
  std::vector<FlatPoint> near;
  if (rings_.empty()) {
    const auto kept =
        std::ranges::count_if(squares, [&](double square) { return square <= within * within; });
    if (std::size_t(kept) < LocalField::points) {
      std::vector<double> sorted = squares;
      const std::size_t rank = std::min(LocalField::points, sorted.size()) - 1;
      std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(rank), sorted.end());
      within = std::max(within, std::sqrt(sorted[rank]));
    }
    for (std::size_t i = 0; i < squares.size(); ++i)
      if (squares[i] <= within * within) near.push_back(flat(points_[i], edges_[i], middle, axes));
  } else {
    for (const Ring& image : images(middle, 0.5 * part, within))
      near.push_back(flat(image.point, image.edge, middle, axes));
  }

  // Parts of a wide disc, of nearly equal areas; places in them of equal ones.
  FootprintMean mean;
  double squared_error = 0.0, extrapolated = 0.0, changed = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    const int sectors = std::max(1, 6 * ring);
    const double inner = ring == 0 ? 0.0 : std::pow(part * (2 * ring - 1), 2),
                 outer = std::pow(part * (2 * ring + 1), 2),
                 share = radius > 0.0 ? (outer - inner) / (radius * radius) / sectors : 1.0;
    for (int sector = 0; sector < sectors; ++sector) {
      const double width = 2.0 * pi / sectors;
      const auto place = [&](double square, double turn) -> Vector2d {
        const double angle = width * (sector + turn);
        return std::sqrt(square) * Vector2d(std::cos(angle), std::sin(angle));
      };
      // A sector's corners are that far from its middle.
      const LocalField field =
          ring == 0 ? LocalField(near, {0.0, 0.0}, part)
                    : LocalField(near, place(0.5 * (inner + outer), 0.5), corner * part);
      const int along = field.is_inside() ? 2 : 6, around = ring == 0 ? 2 * along + 3 : along;
      const double change = lacking_ * field.edge(),
                   each = (1.0 + change) * share / (along * around);
      double felt = 0.0;
      for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
          const Felt here = field.at(place(inner + (i + 0.5) / along * (outer - inner),
                                           (j + 0.5 + 0.5 * (i % 2)) / around));
          felt += each * here.pressure;
          mean.shear += each * here.shear;
          if (here.beyond) extrapolated += each * here.pressure;
        }
      mean.pressure += felt;
      changed += std::abs(change) * felt;
      squared_error += share * field.scatter() * field.scatter();
      mean.spacing = std::max(mean.spacing, field.spacing());
    }
  }
  if (!(mean.pressure > 0.0)) return {};
  mean.error = std::hypot(std::sqrt(squared_error), extrapolated_error * extrapolated, changed);
  return mean;
}

}  // namespace fingertip::meshes::inline press
