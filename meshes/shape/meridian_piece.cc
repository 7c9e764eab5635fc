#include "meshes/shape/meridian_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace fingertip::meshes::inline shape {
namespace {

using std::numbers::pi;
using PieceGauss = boost::math::quadrature::gauss<double, 15>;

}  // namespace

MeridianPiece MeridianPiece::line(const Vector2& from, const Vector2& to, ProfileSurface surface) {
  MeridianPiece piece;
  piece.surface_ = surface;
  piece.from_ = from, piece.to_ = to;
  piece.control1_ = piece.control2_ = 0.5 * (from + to);
  piece.low_ = from.cwiseMin(to), piece.high_ = from.cwiseMax(to);
  return piece;
}

MeridianPiece MeridianPiece::arc(const Vector2& from, const Vector2& to, const Vector2& centre,
                                 ProfileSurface surface) {
  MeridianPiece piece = line(from, to, surface);
  piece.curve_ = ProfileCurve::arc;
  piece.control1_ = centre;
  const Vector2 a = from - centre, b = to - centre;
  piece.radius_ = 0.5 * (a.norm() + b.norm());
  piece.angle_ = std::atan2(a.y(), a.x());
  piece.sweep_ = std::atan2(cross(a, b), a.dot(b));
  piece.low_ = centre.array() - piece.radius_, piece.high_ = centre.array() + piece.radius_;
  return piece;
}

MeridianPiece MeridianPiece::cubic(const Vector2& from, const Vector2& control1,
                                   const Vector2& control2, const Vector2& to,
                                   ProfileSurface surface) {
  MeridianPiece piece = line(from, to, surface);
  piece.curve_ = ProfileCurve::spline;
  piece.control1_ = control1, piece.control2_ = control2;
  piece.low_ = piece.low_.cwiseMin(control1).cwiseMin(control2);
  piece.high_ = piece.high_.cwiseMax(control1).cwiseMax(control2);
  return piece;
}

Vector2 MeridianPiece::at(double t) const {
  if (t == 0.0) return from_;
  if (t == 1.0) return to_;
  const double s = 1.0 - t;
  switch (curve_) {
    case ProfileCurve::straight: return s * from_ + t * to_;
    case ProfileCurve::arc: {
      const double angle = angle_ + t * sweep_;
      return control1_ + radius_ * Vector2(std::cos(angle), std::sin(angle));
    }
    case ProfileCurve::spline:
      return s * s * s * from_ + 3.0 * s * t * (s * control1_ + t * control2_) + t * t * t * to_;
  }
  return from_;
}

Vector2 MeridianPiece::slope(double t) const {
  const double s = 1.0 - t;
  switch (curve_) {
    case ProfileCurve::straight: return to_ - from_;
    case ProfileCurve::arc: {
      const double angle = angle_ + t * sweep_;
      return radius_ * sweep_ * Vector2(-std::sin(angle), std::cos(angle));
    }
    case ProfileCurve::spline:
      return 3.0 * (s * s * (control1_ - from_) + 2.0 * s * t * (control2_ - control1_) +
                    t * t * (to_ - control2_));
  }
  return from_;
}

Vector2 MeridianPiece::normal(double t) const {
  const Vector2 along = slope(t).normalized();
  return {along.y(), -along.x()};
}

double MeridianPiece::nearest(const Vector2& point) const {
  const auto clamped = [](double t) { return std::clamp(t, 0.0, 1.0); };
  switch (curve_) {
    case ProfileCurve::straight: {
      const Vector2 along = to_ - from_;
      return clamped((point - from_).dot(along) / along.squaredNorm());
    }
    case ProfileCurve::arc: {
      const Vector2 middle = at(0.5) - control1_, d = point - control1_;
      const double turned = std::atan2(cross(middle, d), middle.dot(d));  // from the middle
      return clamped(0.5 + turned / sweep_);
    }
    case ProfileCurve::spline: break;
  }
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  constexpr int starts = 4;
  for (int i = 0; i <= starts; ++i) {
    double t = double(i) / starts;
    for (int newton = 0; newton < 8; ++newton) {
      // (x - p) x' = 0, with x'' left out where it would lead away from the minimum.
      const Vector2 d = at(t) - point, x = slope(t);
      const Vector2 bend = 6.0 * ((1.0 - t) * (control2_ - 2.0 * control1_ + from_) +
                                  t * (to_ - 2.0 * control2_ + control1_));
      const double curvature = x.squaredNorm() + d.dot(bend);
      t = clamped(t - d.dot(x) / (curvature > 0.0 ? curvature : x.squaredNorm()));
    }
    const double distance = (at(t) - point).norm();
    if (distance < least) least = distance, best = t;
  }
  return best;
}

double MeridianPiece::farther_than(const Vector2& point) const {
  const Vector2 outside = (low_ - point).cwiseMax(point - high_).cwiseMax(0.0);
  return outside.norm();
}

double MeridianPiece::length() const {
  return PieceGauss::integrate([this](double t) { return slope(t).norm(); }, 0.0, 1.0);
}

double MeridianPiece::area(double from, double to) const {
  return 2.0 * pi *
         PieceGauss::integrate([this](double t) { return at(t).x() * slope(t).norm(); }, from, to);
}

std::vector<double> MeridianPiece::turning_points() const {
  std::vector<double> found;
  const auto add = [&](double t) {
    if (t > 1e-12 && t < 1.0 - 1e-12) found.push_back(t);
  };
  if (curve_ == ProfileCurve::arc) {
    for (int quarter = -8; quarter <= 8; ++quarter) add((0.5 * pi * quarter - angle_) / sweep_);
  } else if (curve_ == ProfileCurve::spline) {
    const Vector2 a = control1_ - from_, b = control2_ - control1_, c = to_ - control2_;
    for (const Eigen::Index axis : {0, 1}) {  // s² a + 2 s t b + t² c = 0
      const double q = a[axis] - 2.0 * b[axis] + c[axis], p = b[axis] - a[axis];
      const double root = p * p - q * a[axis];
      if (root < 0.0) continue;
      const double w = -(p + std::copysign(std::sqrt(root), p));
      if (q != 0.0) add(w / q);
      if (w != 0.0) add(a[axis] / w);
    }
  }
  std::ranges::sort(found);
  return found;
}

MonotonePart::MonotonePart(const MeridianPiece& piece, double from, double to)
    : piece_(piece), from_(from), to_(to) {
  const Vector2 a = piece.at(from), b = piece.at(to);
  r_ = {std::min(a.x(), b.x()), std::max(a.x(), b.x())};
  z_ = {std::min(a.y(), b.y()), std::max(a.y(), b.y())};
}

double MonotonePart::other_at(int axis, double value) const {
  const int other = 1 - axis;
  switch (piece_.curve()) {
    case ProfileCurve::straight: {
      const Vector2 along = piece_.to() - piece_.from();
      return piece_.from()[other] + (value - piece_.from()[axis]) / along[axis] * along[other];
    }
    case ProfileCurve::arc: {
      const Vector2& centre = piece_.centre();
      const double radius = (piece_.at(0.5) - centre).norm(), off = value - centre[axis];
      const double across = std::sqrt(std::max(0.0, (radius - off) * (radius + off)));
      const bool beyond = piece_.at(0.5 * (from_ + to_))[other] >= centre[other];
      return centre[other] + (beyond ? across : -across);
    }
    case ProfileCurve::spline: break;
  }
  const auto off = [&](double t) { return piece_.at(t)[axis] - value; };
  const double a = off(from_), b = off(to_);
  if (a == 0.0 || b == 0.0 || a * b > 0.0)
    return piece_.at(std::abs(a) <= std::abs(b) ? from_ : to_)[other];
  std::uintmax_t rounds = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      off, from_, to_, a, b, boost::math::tools::eps_tolerance<double>(52), rounds);
  return piece_.at(0.5 * (low + high))[other];
}

}  // namespace fingertip::meshes::inline shape
