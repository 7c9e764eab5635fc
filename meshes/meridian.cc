#include "meshes/meridian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "meshes/files.h"
#include "meshes/peak.h"

namespace fingertip::meshes {
namespace {

using std::numbers::pi;
using Gauss = boost::math::quadrature::gauss<double, 15>;

/// Radii of an arc's ends may differ by this share of it: a file has few digits.
constexpr double round_arc = 1e-4;
/// Smallest and largest extent of a finger [m].
constexpr double smallest_finger = 0.5e-3, largest_finger = 0.5;
/// Straight pieces by which a curve is replaced to find where the meridian crosses itself.
constexpr int chords = 24, most_chords = 600;
/// Points per piece from which the thickness of the wall is measured.
constexpr int wall_points = 16;
/// Two places are of one wall when the way between them along the boundary is this many times
/// longer than through the rubber.
constexpr double wedge = 4.0;
/// A length over the finger's extent that is round-off.
constexpr double no_length = 1e-9;

std::string place(const Vector2& corner) {
  return "(r, z) = (" + to_text(1e3 * corner.x()) + ", " + to_text(1e3 * corner.y()) + ") mm";
}

[[noreturn]] void refuse(std::size_t corner, const Vector2& at, const std::string& rule,
                         const std::string& remedy) {
  throw InvalidInput({"geometry.profile",
                      "corner " + std::to_string(corner + 1) + " at " + place(at), rule, remedy});
}

[[noreturn]] void refuse(const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InvalidInput({"geometry.profile", value, rule, remedy});
}

/// Slopes at the corners of the C2 cubic through points with the knots `at`: natural at its ends,
/// but where one lies on the axis z has no slope there, since the other half is its mirror image.
std::vector<Vector2> spline_slopes(const std::vector<Vector2>& points,
                                   const std::vector<double>& at) {
  const auto n = Eigen::Index(points.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  const auto point = [&](Eigen::Index i) { return points[std::size_t(i)]; };
  const auto step = [&](Eigen::Index i) { return at[std::size_t(i + 1)] - at[std::size_t(i)]; };
  const auto secant = [&](Eigen::Index i) -> Vector2 {
    return (point(i + 1) - point(i)) / step(i);
  };
  system(0, 0) = system(n - 1, n - 1) = 2.0;
  system(0, 1) = system(n - 1, n - 2) = 1.0;
  right.row(0) = 3.0 * secant(0);
  right.row(n - 1) = 3.0 * secant(n - 2);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    system(i, i - 1) = step(i);
    system(i, i) = 2.0 * (step(i - 1) + step(i));
    system(i, i + 1) = step(i - 1);
    right.row(i) = 3.0 * (step(i) * secant(i - 1) + step(i - 1) * secant(i));
  }
  Eigen::MatrixX2d slopes(n, 2);
  slopes.col(0) = system.lu().solve(right.col(0));
  for (const Eigen::Index end : {Eigen::Index(0), n - 1})
    if (point(end).x() == 0.0) {
      system.row(end).setZero();
      system(end, end) = 1.0;
      right(end, 1) = 0.0;
    }
  slopes.col(1) = system.lu().solve(right.col(1));
  std::vector<Vector2> result;
  for (Eigen::Index i = 0; i < n; ++i) result.emplace_back(slopes.row(i));
  return result;
}

/// Counter-clockwise: with them reversed, `surface` and `curve` stay with the piece they name.
std::vector<ProfileCorner> counter_clockwise(std::vector<ProfileCorner> corners) {
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const ProfileCorner &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += a.r * b.z - a.z * b.r;
  }
  if (area >= 0.0) return corners;
  std::ranges::reverse(corners);
  const std::vector<ProfileCorner> places = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double r = corners[i].r, z = corners[i].z;
    corners[i] = places[(i + 1) % corners.size()];
    corners[i].r = r, corners[i].z = z;
  }
  return corners;
}

void check(const std::vector<ProfileCorner>& corners) {
  if (corners.size() < 3)
    refuse(std::to_string(corners.size()) + " corners", "a meridian has at least three",
           "one row per corner of the closed curve, in order");
  double extent = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const ProfileCorner& c = corners[i];
    const Vector2 at(c.r, c.z);
    if (!at.allFinite()) refuse(i, at, "r and z must be finite numbers", "mend the row");
    if (c.r < 0.0)
      refuse(i, at, "r, the distance from the axis, must not be negative",
             "draw the half of the section on the side r >= 0");
    extent = std::max({extent, 2.0 * c.r, std::abs(c.z - corners[0].z)});
  }
  if (extent < smallest_finger || extent > largest_finger)
    refuse(to_text(extent) + " m across", "a finger measures 0.5 mm to 0.5 m",
           "check the unit in the head of the columns, e.g. r [mm],z [mm]");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const ProfileCorner &c = corners[i], &next = corners[(i + 1) % corners.size()];
    const Vector2 at(c.r, c.z), to(next.r, next.z);
    if ((to - at).norm() < no_length * extent)
      refuse(i, at, "a corner must differ from the next one",
             "delete one of the two rows; the last corner joins the first by itself");
    if (c.surface == ProfileSurface::axis && (c.r != 0.0 || next.r != 0.0))
      refuse(i, at, "a piece of the axis runs from r = 0 to r = 0",
             "put both its corners on the axis, or name the piece contact, bond or free");
    if (c.surface == ProfileSurface::axis && c.curve != ProfileCurve::straight)
      refuse(i, at, "the axis is straight", "leave its curve empty");
    if (c.surface != ProfileSurface::axis && c.r == 0.0 && next.r == 0.0)
      refuse(i, at, "a piece along r = 0 has no area", "name it axis");
    if (c.curve != ProfileCurve::arc) continue;
    const Vector2 centre(c.centre_r, c.centre_z);
    const double a = (at - centre).norm(), b = (to - centre).norm();
    if (!(std::abs(a - b) <= round_arc * std::max(a, b)) || a == 0.0)
      refuse(i, at,
             "both ends of an arc are equally far from its centre; they are " + to_text(1e3 * a) +
                 " and " + to_text(1e3 * b) + " mm from it",
             "write arc R C with the centre's coordinates");
    if (std::abs(cross(at - centre, to - centre)) <= 1e-6 * a * b)
      refuse(i, at, "an arc must be shorter than half a circle", "split it by a corner");
  }
}

std::vector<MeridianPiece> pieces_of(const std::vector<ProfileCorner>& corners) {
  const std::size_t n = corners.size();
  const auto next = [&](std::size_t i) { return (i + 1) % n; };
  const auto at = [&](std::size_t i) { return Vector2(corners[i].r, corners[i].z); };
  const auto joined = [&](std::size_t i, std::size_t j) {
    return corners[i].curve == ProfileCurve::spline && corners[j].curve == ProfileCurve::spline &&
           corners[i].surface == corners[j].surface;
  };
  // A spline must not be cut where the list begins.
  std::size_t first = 0;
  while (first < n && joined((first + n - 1) % n, first)) ++first;
  if (first == n)
    refuse("all " + std::to_string(n) + " pieces", "the axis, contact and bond must be told apart",
           "name the surfaces of the pieces");
  std::vector<MeridianPiece> pieces;
  for (std::size_t count = 0; count < n;) {
    const std::size_t i = (first + count) % n;
    const ProfileCorner& c = corners[i];
    if (c.curve == ProfileCurve::straight) {
      pieces.push_back(MeridianPiece::line(at(i), at(next(i)), c.surface));
    } else if (c.curve == ProfileCurve::arc) {
      pieces.push_back(MeridianPiece::arc(at(i), at(next(i)), {c.centre_r, c.centre_z}, c.surface));
    } else {
      std::vector<Vector2> points{at(i)};
      std::vector<double> knots{0.0};
      std::size_t last = i;
      for (;;) {
        points.push_back(at(next(last)));
        knots.push_back(knots.back() + (points.back() - points[points.size() - 2]).norm());
        if (!joined(last, next(last)) || points.size() > n) break;
        last = next(last);
      }
      const std::vector<Vector2> slopes = spline_slopes(points, knots);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const double third = (knots[k + 1] - knots[k]) / 3.0;
        pieces.push_back(MeridianPiece::cubic(points[k], points[k] + third * slopes[k],
                                              points[k + 1] - third * slopes[k + 1], points[k + 1],
                                              c.surface));
      }
      count += points.size() - 2;
    }
    ++count;
  }
  return pieces;
}

/// The dome of the paper as a profile.
std::vector<ProfileCorner> dome_corners(const Geometry& g) {
  using enum ProfileSurface;
  using enum ProfileCurve;
  const double R = g.tip_radius, r = g.rod_radius, end = -g.sleeve_length;
  std::vector<ProfileCorner> corners;
  if (end < 0.0) {
    corners = {{r, end, free, straight}, {R, end, contact, straight}, {R, 0.0, contact, arc},
               {0.0, R, axis, straight}, {0.0, r, bond, arc},         {r, 0.0, bond, straight}};
  } else {
    corners = {{r, 0.0, free, straight},
               {R, 0.0, contact, arc},
               {0.0, R, axis, straight},
               {0.0, r, bond, arc}};
  }
  return corners;
}

/// Where two straight segments cross or touch, apart from a common end.
bool meet(const std::array<Vector2, 2>& a, const std::array<Vector2, 2>& b) {
  const auto side = [](const std::array<Vector2, 2>& s, const Vector2& p) {
    return cross(s[1] - s[0], p - s[0]);
  };
  const double a0 = side(b, a[0]), a1 = side(b, a[1]), b0 = side(a, b[0]), b1 = side(a, b[1]);
  if (a0 * a1 > 0.0 || b0 * b1 > 0.0) return false;
  if (a0 == 0.0 && a1 == 0.0) {  // on one line
    const Vector2 along = a[1] - a[0];
    const double length = along.squaredNorm();
    const double s = (b[0] - a[0]).dot(along) / length, t = (b[1] - a[0]).dot(along) / length;
    return std::max(std::min(s, t), 0.0) <= std::min(std::max(s, t), 1.0);
  }
  return true;
}

}  // namespace

/// Straight pieces in place of a curve: fewer where the meridian has many.
int Meridian::chords_of(const MeridianPiece& piece) const {
  if (piece.curve() == ProfileCurve::straight) return 1;
  return std::clamp(most_chords / int(pieces_.size()), 2, chords);
}

Meridian::Meridian(const Geometry& geometry) {
  std::vector<ProfileCorner> corners = geometry.profile;
  if (corners.empty()) {
    const auto found = geometry.violations();
    if (!found.empty()) throw InvalidInput(found);
    corners = dome_corners(geometry);
  }
  check(corners);
  pieces_ = pieces_of(counter_clockwise(std::move(corners)));
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
  check_crossings();
  measure();
}

void Meridian::check_crossings() const {
  struct Chord {
    std::array<Vector2, 2> ends;
    std::size_t piece;
  };
  std::vector<Chord> all;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const int count = chords_of(pieces_[p]);
    for (int i = 0; i < count; ++i)
      all.push_back({{pieces_[p].at(double(i) / count), pieces_[p].at(double(i + 1) / count)}, p});
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& ends = all[i].ends;
    if (std::min(ends[0].x(), ends[1].x()) < 0.0)
      refuse("near " + place(ends[0]), "the curve must not cross the axis",
             "move its corners, or end it at r = 0");
    for (std::size_t j = i + 2; j < all.size(); ++j) {
      if (i == 0 && j + 1 == all.size()) continue;  // they share the first corner
      if (meet(ends, all[j].ends))
        refuse("piece " + std::to_string(all[i].piece + 1) + " near " + place(ends[0]) +
                   " and piece " + std::to_string(all[j].piece + 1) + " near " +
                   place(all[j].ends[0]),
               "a meridian must not cross or touch itself", "check the order of the corners");
    }
  }
}

void Meridian::measure() {
  constexpr double none = std::numeric_limits<double>::infinity();
  pole_ = bond_top_ = -none;
  lowest_ = none;
  bool on_axis = false;
  Vector2 top(0.0, -none);
  for (const MonotonePart& part : parts_) lowest_ = std::min(lowest_, part.lowest());
  for (const MeridianPiece& piece : pieces_) {
    std::vector<double> at = piece.turning_points();
    at.insert(at.end(), {0.0, 1.0});
    for (const double t : at) {
      const Vector2 x = piece.at(t);
      radius_ = std::max(radius_, x.x());
      if (piece.surface() == ProfileSurface::bond) bond_top_ = std::max(bond_top_, x.y());
      if (piece.surface() == ProfileSurface::contact) {
        if (x.y() > pole_) on_axis = false;
        pole_ = std::max(pole_, x.y());
        if (x.y() == pole_ && x.x() == 0.0) on_axis = true;
      }
      if (x.y() > top.y()) top = x;
    }
  }
  for (const auto& [surface, height] :
       {std::pair(ProfileSurface::contact, pole_), std::pair(ProfileSurface::bond, bond_top_)})
    if (height == -none)
      refuse("no " + std::string(name(surface)),
             surface == ProfileSurface::bond ? "something must be held by the hand"
                                             : "something must be able to touch",
             "name at least one piece " + std::string(name(surface)));
  if (!on_axis)
    refuse("top at " + place(top), "the highest point of contact must lie on the axis, r = 0",
           "start `contact` at the axis; a ring that touches first is not supported");
  if (top.y() > pole_)
    refuse("top at " + place(top), "no piece may lie higher than `contact`",
           "turn the finger so that it points along +z");
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
    const int count =
        piece.curve() == ProfileCurve::straight ? wall_points : std::max(4, chords_of(piece));
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
      return peak(0.0, 1.0, chords, [&](double t) { return height.at(place(t, angle)); });
    };
    const Peak around =
        height.revolved ? Peak{0.0, 0.0}
                        : peak(0.0, pi, chords, [&](double angle) { return along(angle).value; });
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

std::vector<std::vector<Vector2>> held_outlines(const Geometry& geometry, int points) {
  const double r = geometry.rod_radius;
  if (geometry.is_dome()) {
    std::vector<Vector2> rod{{0.0, -geometry.rod_length}, {r, -geometry.rod_length}};
    for (int i = 0; i < points; ++i) {
      const double latitude = 0.5 * pi * i / points;
      rod.emplace_back(r * std::cos(latitude), r * std::sin(latitude));
    }
    rod.emplace_back(0.0, r);
    return {rod};
  }
  const double low = geometry.lowest();
  std::vector<std::vector<Vector2>> outlines{
      {{0.0, low - 2.0 * r}, {r, low - 2.0 * r}, {r, low}, {0.0, low}}};
  if (geometry.solid) return outlines;  // its bond is no curve
  const Meridian meridian(geometry);
  for (const MeridianPiece& piece : meridian.pieces()) {
    if (piece.surface() != ProfileSurface::bond) continue;
    const int count = piece.curve() == ProfileCurve::straight ? 1 : points;
    std::vector<Vector2>& outline = outlines.emplace_back();
    for (int i = count; i >= 0; --i) outline.push_back(piece.at(double(i) / count));
  }
  return outlines;
}

}  // namespace fingertip::meshes
