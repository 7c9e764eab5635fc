#include "meshes/shape/meridian.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "meshes/base/files.h"
#include "meshes/shape/peak.h"

namespace fingertip::meshes::inline shape {
namespace {

using std::numbers::pi;
using Gauss = boost::math::quadrature::gauss<double, 15>;

/// Steps in which the highest place of a piece is sought, and around the axis.
constexpr int peak_steps = 24;
/// Points per piece from which the thickness of the wall is measured.
constexpr int wall_points = 16;
/// Two places are of one wall when the way between them along the boundary is this many times
/// longer than through the rubber.
constexpr double wedge = 4.0;

/// For a finger whose highest place is not the end of `contact` on the axis.
[[noreturn]] void refuse_top(const Meridian& meridian, bool on_axis, const Vector2& top,
                             const Vector2& highest_contact) {
  const double round_off = 1e-9 * (top.y() - meridian.lowest());
  const auto is_lowest_on_axis = [&](const Vector2& x) {
    return x.x() == 0.0 && x.y() <= meridian.lowest() + round_off;
  };
  const auto points_down = [&](const MeridianPiece& piece) {
    return piece.surface() == ProfileSurface::contact &&
           (is_lowest_on_axis(piece.from()) || is_lowest_on_axis(piece.to()));
  };
  if (std::ranges::any_of(meridian.pieces(), points_down))
    refuse_profile("tip at " + profile_place({0.0, meridian.lowest()}) +
                       ", bond up to z = " + to_text(1e3 * meridian.bond_top()) + " mm",
                   "the finger is upside down: its tip, the highest point of `contact`, must lie "
                   "on the axis above the bond",
                   "change the sign of every z, in arc R C that of C; or exchange the names "
                   "contact and bond where they are mixed up");
  if (!on_axis)
    refuse_profile("highest point of `contact` at " + profile_place(highest_contact),
                   "it must lie on the axis, r = 0, above the bond",
                   "start `contact` at the axis; a ring that touches first is not supported");
  refuse_profile("highest point at " + profile_place(top) +
                     ", `contact` ends at z = " + to_text(1e3 * meridian.pole()) + " mm",
                 "no piece may lie higher than `contact`",
                 "name what lies highest contact, or lower it");
}

}  // namespace

Meridian::Meridian(std::vector<ProfileCorner> corners)
    : pieces_(profile_pieces(std::move(corners))) {
  for (const MeridianPiece& piece : pieces_) {
    if (piece.surface() == ProfileSurface::axis) continue;
    double from = 0.0;
    std::vector<double> ends = piece.turning_points();
    ends.push_back(1.0);
    for (const double to : ends) {
      parts_.emplace_back(piece, from, to);
      from = to;
    }
  }
  measure();
}

void Meridian::measure() {
  constexpr double none = std::numeric_limits<double>::infinity();
  pole_ = bond_top_ = -none;
  lowest_ = none;
  bool on_axis = false;
  double covered_bond = -none, lowest_on_axis = none;
  Vector2 top(0.0, -none), highest_contact = top;
  double highest = -none;
  for (const MonotonePart& part : parts_) {
    lowest_ = std::min(lowest_, part.lowest());
    highest = std::max(highest, part.highest());
  }
  const double grain = 1e-9 * (highest - lowest_);
  for (const MeridianPiece& piece : pieces_) {
    std::vector<double> at = piece.turning_points();
    at.insert(at.end(), {0.0, 1.0});
    for (const double t : at) {
      const Vector2 x = piece.at(t);
      radius_ = std::max(radius_, x.x());
      if (piece.surface() == ProfileSurface::bond) {
        bond_top_ = std::max(bond_top_, x.y());
        const Vector2 above(x.x(), x.y() + grain);
        if (contains(above)) covered_bond = std::max(covered_bond, x.y());
      }
      if (piece.surface() != ProfileSurface::axis && x.x() == 0.0)
        lowest_on_axis = std::min(lowest_on_axis, x.y());
      if (piece.surface() == ProfileSurface::contact) {
        if (x.y() > pole_) on_axis = false;
        pole_ = std::max(pole_, x.y());
        if (x.y() == pole_ && x.x() == 0.0) on_axis = true;
        if (x.y() > highest_contact.y()) highest_contact = x;
      }
      if (x.y() > top.y()) top = x;
    }
  }
  for (const auto& [surface, height] :
       {std::pair(ProfileSurface::contact, pole_), std::pair(ProfileSurface::bond, bond_top_)})
    if (height == -none)
      refuse_profile("no " + std::string(name(surface)),
                     surface == ProfileSurface::bond ? "something must be held by the hand"
                                                     : "something must be able to touch",
                     "name at least one piece " + std::string(name(surface)));
  if (!on_axis || top.y() > pole_) refuse_top(*this, on_axis, top, highest_contact);
  // Glued at its side a finger is as thick as over what holds it below; a membrane that is glued at
  // its side alone, along the axis.
  if (covered_bond > -none)
    bond_top_ = covered_bond;
  else if (bond_top_ >= pole_)
    bond_top_ = lowest_on_axis;
}

double Meridian::bond_radius() const {
  double radius = 0.0;
  for (const MeridianPiece& piece : pieces_)
    if (piece.surface() == ProfileSurface::bond)
      radius = std::max({radius, piece.from().x(), piece.to().x()});
  return radius;
}

double Meridian::pole_radius() const {
  for (const MeridianPiece& piece : pieces_) {
    const bool ends = piece.to().x() == 0.0 && piece.to().y() == pole_;
    if (piece.surface() != ProfileSurface::contact || !ends) continue;
    if (piece.curve() == ProfileCurve::arc) return (piece.to() - piece.centre()).norm();
    if (piece.curve() == ProfileCurve::straight) break;
    const Vector2 along = piece.slope(1.0),
                  bend = 6.0 * (piece.to() - 2.0 * piece.control2() + piece.control1());
    const double curvature = std::abs(cross(along, bend)) / std::pow(along.norm(), 3);
    return curvature > 0.0 ? 1.0 / curvature : radius_;
  }
  return radius_;
}

double Meridian::wall() const {
  // The whole section as chords, each with its place along the boundary. The axis joins the right
  // half to its mirror image: a chain of pieces and its image are one loop.
  struct Chord {
    const MeridianPiece* piece;
    double middle;  ///< its parameter on the piece
    Vector2 from, to;
    double start, length;  ///< along its chain
    int chain;
  };
  std::size_t first = 0;  // a chain begins behind a piece of the axis
  while (first < pieces_.size() && pieces_[first].surface() != ProfileSurface::axis) ++first;
  const bool annular = first == pieces_.size();
  std::vector<Chord> section;
  std::vector<double> lengths{0.0};
  for (std::size_t k = 1; k <= pieces_.size(); ++k) {
    const MeridianPiece& piece = pieces_[(first + k) % pieces_.size()];
    if (piece.surface() == ProfileSurface::axis) {
      lengths.push_back(0.0);
      continue;
    }
    const int count = piece.curve() == ProfileCurve::straight
                          ? wall_points
                          : std::max(4, chord_count(piece, pieces_.size()));
    for (int i = 0; i < count; ++i) {
      const Vector2 a = piece.at(double(i) / count), b = piece.at(double(i + 1) / count);
      section.push_back({&piece, (i + 0.5) / count, a, b, lengths.back(), (b - a).norm(),
                         int(lengths.size()) - 1});
      lengths.back() += (b - a).norm();
    }
  }
  double wall = pole_ - bond_top_;
  for (const Chord& own : section) {
    if (own.piece->surface() != ProfileSurface::contact) continue;
    const Vector2 start = own.piece->at(own.middle), inward = -own.piece->normal(own.middle);
    // Where the ray first leaves the rubber; what lies just behind its start is its own chord.
    double depth = wall, along_boundary = 0.0;
    for (const Chord& chord : section)
      for (const double side : {1.0, -1.0}) {
        const Vector2 a(side * chord.from.x(), chord.from.y()),
            b(side * chord.to.x(), chord.to.y());
        const double turned = cross(inward, b - a);
        if (turned == 0.0 || (side > 0.0 && &chord == &own)) continue;
        const double at = cross(a - start, b - a) / turned;
        const double share = cross(a - start, inward) / turned;
        if (at <= 0.0 || at >= depth || share < 0.0 || share > 1.0) continue;
        const double loop = (annular ? 1.0 : 2.0) * lengths[std::size_t(chord.chain)];
        const double there = chord.start + share * chord.length;
        const double place = side > 0.0 ? there : loop - there;
        const double apart = std::abs(place - own.start - 0.5 * own.length);
        depth = at;
        along_boundary = chord.chain != own.chain || (annular && side < 0.0)
                             ? std::numeric_limits<double>::infinity()
                             : std::min(apart, loop - apart);
      }
    // Near a corner or a rounded end rubber runs out in a wedge, which is no wall.
    if (!(depth < wall && along_boundary > wedge * depth)) continue;
    const auto in_rubber = [&](double at) {
      const Vector2 place = start + at * inward;
      return contains(Vector2(std::abs(place.x()), place.y()));
    };
    double inside = 0.98 * depth, outside = 1.02 * depth;  // chords are not the curve
    if (in_rubber(inside) && !in_rubber(outside)) {
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (inside + outside);
        (in_rubber(middle) ? inside : outside) = middle;
      }
      depth = outside;
    }
    wall = std::min(wall, depth);
  }
  return wall;
}

double Meridian::signed_distance(const Vector2& point) const {
  double distance = std::numeric_limits<double>::infinity();
  for (const MeridianPiece& piece : pieces_)
    if (piece.surface() != ProfileSurface::axis && piece.farther_than(point) < distance)
      distance = std::min(distance, (piece.at(piece.nearest(point)) - point).norm());
  return contains(point) ? -distance : distance;
}

double Meridian::signed_distance(const Vector3& w) const {
  return signed_distance(Vector2(std::hypot(w.x(), w.y()), w.z()));
}

NearestPoint Meridian::nearest(ProfileSurface surface, const Vector3& w) const {
  const Vector2 point(w.head<2>().norm(), w.z());
  const Vector3 across = point.x() > 0.0 ? Vector3(w.x() / point.x(), w.y() / point.x(), 0.0)
                                         : Vector3(Vector3::UnitX());
  const auto in_space = [&](const Vector2& x) -> Vector3 {
    return x.x() * across + x.y() * Vector3::UnitZ();
  };
  NearestPoint found{std::numeric_limits<double>::infinity(), {}, {}};
  for (const MeridianPiece& piece : pieces_) {
    if (piece.surface() != surface || piece.farther_than(point) >= found.distance) continue;
    const double t = piece.nearest(point), distance = (piece.at(t) - point).norm();
    if (distance < found.distance)
      found = {distance, in_space(piece.at(t)), in_space(piece.normal(t))};
  }
  return found;
}

double Meridian::reach(double tilt) const {
  if (tilt == 0.0) return pole_;
  const double across = std::sin(tilt), up = std::cos(tilt);
  const auto height = [&](const Vector3& w) { return across * w.x() + up * w.z(); };
  return highest(ProfileSurface::contact, {height}).height;
}

HighestPlace Meridian::highest(ProfileSurface surface, const HeightOf& height) const {
  HighestPlace best;
  for (const MeridianPiece& piece : pieces_) {
    if (piece.surface() != surface) continue;
    const auto place = [&](double t, double angle) {
      const Vector2 at = piece.at(t);
      return Vector3(at.x() * std::cos(angle), at.x() * std::sin(angle), at.y());
    };
    const auto along = [&](double angle) {
      return peak(0.0, 1.0, peak_steps, [&](double t) { return height.at(place(t, angle)); });
    };
    const Peak around = height.revolved ? Peak{0.0, 0.0}
                                        : peak(0.0, pi, peak_steps,
                                               [&](double angle) { return along(angle).value; });
    const Peak found = along(around.at);
    if (found.value > best.height) best = {found.value, place(found.at, around.at)};
  }
  return best;
}

bool Meridian::contains(const Vector2& point) const {
  bool inside = false;
  for (const MonotonePart& part : parts_)
    if (part.lowest() <= point.y() && point.y() < part.highest() &&
        part.radius_at(point.y()) > point.x())
      inside = !inside;
  return inside;
}

bool Meridian::contains(const Vector3& w) const {
  return contains(Vector2(std::hypot(w.x(), w.y()), w.z()));
}

std::vector<double> Meridian::radii(double z) const {
  std::vector<double> result;
  for (const MonotonePart& part : parts_)
    if (part.lowest() <= z && z < part.highest()) result.push_back(part.radius_at(z));
  std::ranges::sort(result, std::greater());
  return result;
}

double Meridian::volume() const {
  double sum = 0.0;  // Green: the integral of r² dz
  for (const MeridianPiece& piece : pieces_)
    sum += Gauss::integrate(
        [&](double t) { return piece.at(t).x() * piece.at(t).x() * piece.slope(t).y(); }, 0.0, 1.0);
  return pi * sum;
}

double Meridian::area(ProfileSurface surface) const {
  double sum = 0.0;
  for (const MeridianPiece& piece : pieces_)
    if (piece.surface() == surface) sum += piece.area();
  return sum;
}

}  // namespace fingertip::meshes::inline shape
