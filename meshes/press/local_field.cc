#include "meshes/press/local_field.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fingertip::meshes::inline press {

using Eigen::Vector2d;

namespace {

constexpr double least_share = 0.1;  ///< of the largest p² in the weights: small ones count
constexpr double ridge = 1e-7;       ///< what points in a line do not tell is small
constexpr double slack = 1.2;        ///< of p² beyond the range of the points'
constexpr double widest_gap = 1.25;  ///< spacings from every point, or area of a hull over theirs

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double area_of(const Outline& hull) {
  double twice = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i)
    twice += cross(hull[i].at, hull[(i + 1) % hull.size()].at);
  return 0.5 * twice;
}

/// Of a point's square distance from the middle.
double weight_of(double square, double reach) {
  const double part = 1.0 - square / (reach * reach);
  return part > 0.0 ? part * part : 0.0;
}

}  // namespace

Outline hull_of(Outline points) {
  std::ranges::sort(points, [](const Corner& a, const Corner& b) {
    return a.at.x() < b.at.x() || (a.at.x() == b.at.x() && a.at.y() < b.at.y());
  });
  Outline hull;
  const auto add = [&](const Corner& point, std::size_t fewest) {
    while (hull.size() > fewest &&
           !(cross(hull.back().at - hull[hull.size() - 2].at, point.at - hull.back().at) > 0.0))
      hull.pop_back();
    hull.push_back(point);
  };
  for (const Corner& point : points) add(point, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  if (hull.size() > 1) hull.pop_back();  // the first again
  return hull;
}

Beside beside(const Outline& hull, const Vector2d& place) {
  Beside nearest{std::numeric_limits<double>::infinity(), {}};
  bool inside = hull.size() > 2;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Corner &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const Vector2d side = b.at - a.at, way = place - a.at;
    inside = inside && cross(side, way) >= 0.0;
    const double square = side.squaredNorm(),
                 along = square > 0.0 ? std::clamp(way.dot(side) / square, 0.0, 1.0) : 0.0;
    const Corner foot{a.at + along * side, a.area + along * (b.area - a.area)};
    if (const double distance = (place - foot.at).norm(); distance < nearest.distance)
      nearest = {distance, foot};
  }
  if (inside) nearest.distance = -nearest.distance;
  return nearest;
}

LocalField::LocalField(const std::vector<FlatPoint>& near, const Vector2d& middle, double radius)
    : middle_(middle) {
  std::vector<double> squares;
  for (const FlatPoint& point : near) squares.push_back((point.at - middle).squaredNorm());
  std::vector<double> sorted = squares;
  const std::size_t rank = std::min(points, sorted.size()) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(rank), sorted.end());
  reach_ = std::max(1.15 * std::sqrt(sorted[rank]), 1.2 * radius);
  if (!(reach_ > 0.0)) reach_ = std::sqrt(near.front().area);  // one point, right there
  fit(near, squares);
  const double around = std::max({reach_, 1.5 * radius, radius + 1.5 * spacing_});
  double area = 0.0;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (squares[i] < around * around)
      close_.push_back({near[i].at, near[i].area}), area += near[i].area;
  hull_ = hull_of(close_);
  has_gaps_ = area_of(hull_) > widest_gap * area;
  is_inside_ = !has_gaps_ && -beside(hull_, middle).distance >= radius;
}

Felt LocalField::at(const Vector2d& place) const {
  if (has_gaps_ && std::ranges::none_of(close_, [&](const Corner& point) {
        return (point.at - place).norm() < widest_gap * spacing_;
      }))
    return {};
  const Vector6 basis = this->basis(place);
  double square = coefficients_.row(0).dot(basis);
  bool beyond = false;
  if (!is_inside_) {
    const Beside edge = beside(hull_, place);
    beyond = edge.distance > 0.0;
    if (beyond) {
      const double sharp =
          std::clamp(edge.foot.area / spacing_ - 0.5 * spacing_, 0.0, 0.5 * spacing_);
      const double there = limited(coefficients_.row(0).dot(this->basis(edge.foot.at)));
      square = std::min(square, slack * largest_);
      if (edge.distance > sharp &&
          !(square <= there * (1.0 - edge.distance / (farthest_edge * spacing_))))
        return {};
    }
  }
  if (!beyond) square = limited(square);
  if (!(square > 0.0)) return {};
  // Of the contact's area that of the undeformed surface.
  const double inner = 1.0 / reach_;
  const Vector2d y = inner * (place - middle_);
  const auto& warp = coefficients_.bottomRows<3>();
  const Vector3 along_x = Vector3::UnitX() +
                          inner * (warp.col(1) + 2.0 * y.x() * warp.col(3) + y.y() * warp.col(4)),
                along_y = Vector3::UnitY() +
                          inner * (warp.col(2) + y.x() * warp.col(4) + 2.0 * y.y() * warp.col(5));
  const double ratio = std::abs(along_x.cross(along_y).dot(normal_)), pressure = std::sqrt(square);
  Vector2d shear = Vector2d::Zero();
  if (steepest_ > 0.0) {
    shear = coefficients_.middleRows<2>(1) * basis / pressure;
    if (const double most = steepest_ * pressure; shear.norm() > most) shear *= most / shear.norm();
  }
  return {ratio * pressure, ratio * shear, beyond};
}

LocalField::Vector6 LocalField::basis(const Vector2d& place) const {
  const Vector2d y = (place - middle_) / reach_;
  return {1.0, y.x(), y.y(), y.x() * y.x(), y.x() * y.y(), y.y() * y.y()};
}

double LocalField::limited(double square) const {
  return std::clamp(square, smallest_ / (slack * slack), slack * largest_);
}

void LocalField::fit(const std::vector<FlatPoint>& near, const std::vector<double>& squares) {
  Matrix6 normal = Matrix6::Zero(), right = Matrix6::Zero();
  double area = 0.0;
  int count = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < near.size(); ++i)
    if (weight_of(squares[i], reach_) > 0.0) {
      const double square = near[i].pressure * near[i].pressure;
      smallest_ = std::min(smallest_, square);
      largest_ = std::max(largest_, square);
    }
  for (std::size_t i = 0; i < near.size(); ++i) {
    double share = weight_of(squares[i], reach_);
    if (!(share > 0.0)) continue;
    const FlatPoint& point = near[i];
    const Vector6 basis = this->basis(point.at);
    Vector6 values;
    const double square = point.pressure * point.pressure;
    if (largest_ > 0.0) share /= square / largest_ + least_share;
    values << square, point.pressure * point.shear, point.warped;
    normal.noalias() += share * basis * basis.transpose();
    right.noalias() += share * values * basis.transpose();
    normal_ += share * point.normal;
    edge_ += share * point.edge;
    area += point.area;
    ++count;
    if (point.pressure > 0.0) steepest_ = std::max(steepest_, point.shear.norm() / point.pressure);
  }
  spacing_ = std::sqrt(area / count);
  normal_.normalize();
  const double sum = normal(0, 0);
  edge_ /= sum;
  normal.diagonal().tail<5>().array() += ridge * sum;
  coefficients_ = normal.ldlt().solve(right.transpose()).transpose();
  double off = 0.0, total = 0.0;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (const double share = weight_of(squares[i], reach_); share > 0.0) {
      const double square = coefficients_.row(0).dot(basis(near[i].at));
      total += share;
      off += share * std::pow(near[i].pressure - std::sqrt(std::max(0.0, square)), 2);
    }
  scatter_ = std::sqrt(off / total);
}

}  // namespace fingertip::meshes::inline press
