#include "meshes/shape/profile_pieces.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::meshes::inline shape {
namespace {

/// Radii of an arc's ends may differ by this share of it: a file has few digits.
constexpr double round_arc = 1e-4;
/// Smallest and largest extent of a finger [m].
constexpr double smallest_finger = 0.5e-3, largest_finger = 0.5;
/// Straight pieces by which a curve is replaced to find where the meridian crosses itself.
constexpr int chords = 24, max_chords = 600;
/// A length over the finger's extent that is round-off.
constexpr double no_length = 1e-9;

[[noreturn]] void refuse(std::size_t corner, const Vector2& at, const std::string& rule,
                         const std::string& remedy) {
  refuse_profile("corner " + std::to_string(corner + 1) + " at " + profile_place(at), rule, remedy);
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
    refuse_profile(std::to_string(corners.size()) + " corners", "a meridian has at least three",
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
    refuse_profile(to_text(extent) + " m across", "a finger measures 0.5 mm to 0.5 m",
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
    refuse_profile("all " + std::to_string(n) + " pieces",
                   "the axis, contact and bond must be told apart",
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

/// Refuses what crosses the axis or another piece.
void check_crossings(const std::vector<MeridianPiece>& pieces) {
  struct Chord {
    std::array<Vector2, 2> ends;
    std::size_t piece;
  };
  std::vector<Chord> all;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const int count = chord_count(pieces[p], pieces.size());
    for (int i = 0; i < count; ++i)
      all.push_back({{pieces[p].at(double(i) / count), pieces[p].at(double(i + 1) / count)}, p});
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& ends = all[i].ends;
    if (std::min(ends[0].x(), ends[1].x()) < 0.0)
      refuse_profile("near " + profile_place(ends[0]), "the curve must not cross the axis",
                     "move its corners, or end it at r = 0");
    for (std::size_t j = i + 2; j < all.size(); ++j) {
      if (i == 0 && j + 1 == all.size()) continue;  // they share the first corner
      if (meet(ends, all[j].ends))
        refuse_profile(
            "piece " + std::to_string(all[i].piece + 1) + " near " + profile_place(ends[0]) +
                " and piece " + std::to_string(all[j].piece + 1) + " near " +
                profile_place(all[j].ends[0]),
            "a meridian must not cross or touch itself", "check the order of the corners");
    }
  }
}

}  // namespace

std::string profile_place(const Vector2& corner) {
  return "(r, z) = (" + to_text(1e3 * corner.x()) + ", " + to_text(1e3 * corner.y()) + ") mm";
}

void refuse_profile(const std::string& value, const std::string& rule, const std::string& remedy) {
  throw InvalidInput({"geometry.profile", value, rule, remedy});
}

int chord_count(const MeridianPiece& piece, std::size_t count) {
  if (piece.curve() == ProfileCurve::straight) return 1;
  return std::clamp(max_chords / int(count), 2, chords);
}

std::vector<MeridianPiece> profile_pieces(std::vector<ProfileCorner> corners) {
  check(corners);
  std::vector<MeridianPiece> pieces = pieces_of(counter_clockwise(std::move(corners)));
  check_crossings(pieces);
  return pieces;
}

}  // namespace fingertip::meshes::inline shape
