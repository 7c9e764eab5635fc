#include "meshes/shape/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/shape/peak.h"

namespace fingertip::meshes::inline shape {
namespace {

using Triangle = std::array<Vector3, 3>;

/// A length over the extent that is round-off: vertices so near a plane lie in it.
constexpr double in_plane = 1e-9;
/// Facets of a smooth surface turn by less than this [rad]; their chords may be this high, over the
/// largest radius, for a surface to be its own mirror image as far as they tell.
constexpr double smooth_turn = 0.3, highest_chord = 5e-4;
/// The cap whose area tells the curvature at the pole, over the height of the pole above the bond.
constexpr double cap_height = 0.05;

/// To a millionth of a millimetre: files have seven digits.
std::string in_mm(double length) {
  return to_text(std::round(1e9 * length) / 1e6 + 0.0);
}

[[noreturn]] void refuse_bond(const std::string& value, const std::string& rule,
                              const std::string& remedy) {
  throw InvalidInput({"geometry.bond", value, rule, remedy});
}

double signed_height(const HalfSpace& space, const Vector3& w) {
  return w[space.axis] - space.limit;
}

bool within(const Region& region, const Triangle& corners, double grain) {
  return std::ranges::any_of(region, [&](const std::vector<HalfSpace>& all) {
    return std::ranges::all_of(all, [&](const HalfSpace& space) {
      return std::ranges::all_of(corners, [&](const Vector3& w) {
        const double height = signed_height(space, w);
        return (space.below ? height : -height) <= grain;
      });
    });
  });
}

std::vector<std::array<std::size_t, 3>> neighbours_of(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::size_t> triangle_at;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      triangle_at[{mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]}] = t;
  std::vector<std::array<std::size_t, 3>> neighbours(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      neighbours[t][c] = triangle_at.at({mesh.triangles[t][(c + 1) % 3], mesh.triangles[t][c]});
  return neighbours;
}

std::string digest_of(const TriangleMesh& mesh, const std::vector<int>& groups) {
  std::vector<double> numbers;
  for (const Vector3& vertex : mesh.vertices)
    numbers.insert(numbers.end(), vertex.data(), vertex.data() + 3);
  for (const auto& triangle : mesh.triangles)
    numbers.insert(numbers.end(), triangle.begin(), triangle.end());
  numbers.insert(numbers.end(), groups.begin(), groups.end());
  boost::uuids::name_generator_sha1 generator(boost::uuids::ns::oid());
  return to_string(generator(numbers.data(), numbers.size() * sizeof(double)));
}

/// Whether the axis between two heights meets what the tree holds, or runs in a hole: everywhere
/// beside it stands some of it.
bool surrounds_axis(const TriangleTree& tree, double low, double high) {
  constexpr int heights = 64, directions = 16;
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  for (int i = 0; i < heights; ++i) {
    const Vector3 place(0.0, 0.0, low + (i + 0.5) / heights * (high - low));
    if (tree.contains(place)) return true;
    int met = 0;
    for (int d = 0; d < directions && met == d; ++d) {
      const double angle = 2.0 * std::numbers::pi * d / directions;
      met += tree.first_on_ray(place, {std::cos(angle), std::sin(angle), 0.0}, none).has_value();
    }
    if (met == directions) return true;
  }
  return false;
}

/// Projected on the plane z = 0, of the part above a height: [m²], positive where it faces up.
double shadow_above(const Triangle& corners, double height) {
  std::vector<Vector3> polygon;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vector3 &a = corners[c], &b = corners[(c + 1) % 3];
    const double from = a.z() - height, to = b.z() - height;
    if (from >= 0.0) polygon.push_back(a);
    if (from * to < 0.0) polygon.push_back(a + from / (from - to) * (b - a));
  }
  double area = 0.0;
  for (std::size_t c = 2; c < polygon.size(); ++c)
    area += 0.5 * (polygon[c - 1] - polygon[0]).cross(polygon[c] - polygon[0]).z();
  return area;
}

/// The highest corner below `limit` of the held facets that face up (1) or down (-1).
double highest_held(const Solid& solid, double sign, double limit) {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < solid.mesh().triangles.size(); ++t) {
    const bool faces = sign * solid.mesh().area_vector(t).normalized().z() > in_plane;
    for (std::size_t c = 0; c < 3 && faces && solid.is_bond(t); ++c)
      if (const double z = solid.mesh().corner(t, c).z(); z < limit) highest = std::max(highest, z);
  }
  return highest;
}

/// Of one that is held at its side up to what may touch: the highest place with rubber above it
/// that is held, else (a membrane) the lowest on the axis.
double bottom_of_side_bond(const Solid& solid, const TriangleTree& tree) {
  if (const double covered = highest_held(solid, -1.0, solid.pole()); std::isfinite(covered))
    return covered;
  const Vector3 below(0.0, 0.0, 2.0 * solid.lowest() - solid.pole());
  const auto hit =
      tree.first_on_ray(below, Vector3::UnitZ(), std::numeric_limits<std::size_t>::max());
  return hit ? hit->position.z() : solid.lowest();
}

}  // namespace

Solid::Solid(const TriangleMesh& mesh, const Region& bond, const std::vector<std::string>& faces)
    : mesh_(closed_surface(mesh)) {
  check_crossings(mesh_);
  Eigen::AlignedBox3d box;
  for (const Vector3& vertex : mesh_.vertices) box.extend(vertex);
  const double grain = in_plane * box.sizes().maxCoeff();
  for (const auto& all : bond)
    for (const HalfSpace& space : all) cut_along(mesh_, space.axis, space.limit, grain);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const int face = mesh_.faces.empty() ? -1 : mesh_.faces[t];
    const bool is_held =
        within(bond, corners(t), grain) ||
        (face >= 0 && std::ranges::find(faces, mesh_.face_names[std::size_t(face)]) != faces.end());
    groups_.push_back(is_held ? bond_group : contact_group);
  }
  content_ = digest_of(mesh_, groups_);
  complete();
}

Solid::Solid(TriangleMesh mesh, const std::vector<bool>& bonded, const std::string& content)
    : mesh_(std::move(mesh)), content_(content) {
  for (const bool is_held : bonded) groups_.push_back(is_held ? bond_group : contact_group);
  if (digest_of(mesh_, groups_) != content)
    throw InvalidInput({"geometry.solid", content, "the surface must be the one with this digest",
                        "write both anew: start `fingertip reference` again"});
  complete();
}

void Solid::complete() {
  neighbours_ = neighbours_of(mesh_);
  tree_ = std::make_unique<TriangleTree>(mesh_, groups_, 2);
  measure();
  if (surrounds_axis(*tree_, lowest_, pole_)) return;
  Eigen::AlignedBox3d box;
  for (const Vector3& vertex : mesh_.vertices) box.extend(vertex);
  throw InvalidInput({"geometry.file", "x and y around " + place_of(box.center()),
                      "the axis x = y = 0 must pass through the finger",
                      "put it through what touches first, geometry.origin = \"touch\", or through "
                      "a place of the file, geometry.origin = [\"X mm\", \"Y mm\", \"Z mm\"]"});
}

bool Solid::is(ProfileSurface surface, std::size_t triangle) const {
  return surface == (is_bond(triangle) ? ProfileSurface::bond : ProfileSurface::contact);
}

bool Solid::mirrored(int axis) const {
  const std::size_t at = std::size_t(axis);
  std::call_once(image_compared_[at], [&] { mirrored_[at] = compare_with_image(axis); });
  return mirrored_[at];
}

bool Solid::compare_with_image(int axis) const {
  // How high a smooth surface stands above a facet: e theta / 8 of chords e that turn by theta.
  const auto chord_height = [&](std::size_t t) {
    const Vector3 own = mesh_.area_vector(t);
    double height = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3 other = mesh_.area_vector(neighbours_[t][c]);
      const double turn = std::atan2(own.cross(other).norm(), own.dot(other));
      const double edge = (mesh_.corner(t, (c + 1) % 3) - mesh_.corner(t, c)).norm();
      if (turn < smooth_turn && edge > 0.0)
        height = std::max(height, 2.0 * own.norm() / edge * turn / 8.0);
    }
    return std::min(height, highest_chord * radius_);
  };
  // Also of what it shares an edge with: rims of flat faces are chords, too.
  const auto height_around = [&](std::size_t t) {
    double height = chord_height(t);
    for (const std::size_t other : neighbours_[t]) height = std::max(height, chord_height(other));
    return height;
  };
  const auto has_image = [&](Vector3 w, std::size_t t) {
    w[axis] = -w[axis];
    const auto image = tree_->nearest(w, groups_[t]);
    const double close = mirrored_within * radius_;
    return image->distance <= close ||
           image->distance <= close + std::max(height_around(t), height_around(image->triangle));
  };
  std::array<std::vector<bool>, 2> known;  // corners of facets that may touch, and that are held
  for (auto& corners : known) corners.resize(mesh_.vertices.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!has_image(mesh_.centroid(t), t)) return false;
    auto& own = known[std::size_t(groups_[t])];
    for (const int corner : mesh_.triangles[t]) {
      if (own[std::size_t(corner)]) continue;
      if (!has_image(mesh_.vertices[std::size_t(corner)], t)) return false;
      own[std::size_t(corner)] = true;
    }
  }
  return true;
}

std::array<Vector3, 3> Solid::corners(std::size_t t) const {
  return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
}

void Solid::measure() {
  constexpr double none = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box;
  pole_ = bond_top_ = -none;
  const Vector3 origin = mesh_.vertices.front();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vector3 vector = mesh_.area_vector(t);
    volume_ += (mesh_.centroid(t) - origin).dot(vector) / 3.0;
    (is_bond(t) ? bond_area_ : contact_area_) += vector.norm();
    for (const Vector3& w : corners(t)) {
      box.extend(w);
      const double r = w.head<2>().norm();
      radius_ = std::max(radius_, r);
      if (is_bond(t)) bond_radius_ = std::max(bond_radius_, r);
      double& top = is_bond(t) ? bond_top_ : pole_;
      top = std::max(top, w.z());
    }
  }
  lowest_ = box.min().z();
  const std::string heights =
      "heights " + in_mm(box.min().z()) + " to " + in_mm(box.max().z()) + " mm";
  if (bond_area_ == 0.0)
    refuse_bond(
        heights, "something must be held by the hand",
        "give half spaces that hold some of the surface, e.g. geometry.bond = \"z < 1 mm\"" +
            or_faces(mesh_.face_names));
  if (contact_area_ == 0.0)
    refuse_bond(heights, "something must be able to touch",
                "give half spaces that leave some of the surface free");
  const bool held_at_side =
      bond_top_ == pole_ &&
      highest_held(*this, 1.0, std::numeric_limits<double>::infinity()) < pole_;
  if (bond_top_ >= pole_ && !held_at_side)
    refuse_bond(
        "bond up to z = " + in_mm(bond_top_) + " mm",
        "no bond may lie higher than what may touch, which ends at " + in_mm(pole_) + " mm",
        "say which direction of the file points to the obstacle, e.g. geometry.up = \"-z\" (one of "
        "+x, -x, +y, -y, +z, -z), or change the half spaces");
  if (held_at_side) bond_top_ = bottom_of_side_bond(*this, *tree_);
  const double height = cap_height * (pole_ - bond_top_);
  double shadow = 0.0;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (!is_bond(t)) shadow += shadow_above(corners(t), pole_ - height);
  // A sphere's cap casts pi (2 R h - h²).
  pole_radius_ = std::clamp(0.5 * (shadow / (std::numbers::pi * height) + height), height, radius_);
}

double Solid::area(ProfileSurface surface) const {
  if (surface == ProfileSurface::contact) return contact_area_;
  return surface == ProfileSurface::bond ? bond_area_ : 0.0;
}

double Solid::signed_distance(const Vector3& w) const {
  const double distance = tree_->nearest(w)->distance;
  return contains(w) ? -distance : distance;
}

NearestPoint Solid::nearest(ProfileSurface surface, const Vector3& w) const {
  NearestPoint point{std::numeric_limits<double>::infinity(), {}, {}};
  if (surface != ProfileSurface::contact && surface != ProfileSurface::bond) return point;
  const auto hit = tree_->nearest(w, surface == ProfileSurface::bond ? bond_group : contact_group);
  if (hit) point = {hit->distance, hit->position, mesh_.area_vector(hit->triangle).normalized()};
  return point;
}

double Solid::reach(double tilt) const {
  const Vector3 axis(std::sin(tilt), 0.0, std::cos(tilt));
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3 && !is_bond(t); ++c)
      farthest = std::max(farthest, axis.dot(mesh_.corner(t, c)));
  return farthest;
}

HighestPlace Solid::highest(ProfileSurface surface, const HeightOf& height) const {
  // A concave function is below its tangents: what a facet may reach beyond its corners is small
  // where these are high, so the best of them tell where to look within.
  constexpr std::size_t looked_into = 16;
  struct Candidate {
    double height;
    std::size_t triangle;
  };
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!is(surface, t)) continue;
    const Vector3 a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
    candidates.push_back(
        {std::max({height.at(a), height.at(b), height.at(c), height.at((a + b + c) / 3.0)}), t});
  }
  const auto last = candidates.begin() + std::ptrdiff_t(std::min(looked_into, candidates.size()));
  std::partial_sort(candidates.begin(), last, candidates.end(),
                    [](const Candidate& a, const Candidate& b) { return a.height > b.height; });
  HighestPlace best;
  for (auto candidate = candidates.begin(); candidate != last; ++candidate) {
    const Vector3 a = mesh_.corner(candidate->triangle, 0),
                  b = mesh_.corner(candidate->triangle, 1) - a,
                  c = mesh_.corner(candidate->triangle, 2) - a;
    const auto along = [&](double u) {
      return peak(0.0, 1.0 - u, 8, [&](double v) { return height.at(a + u * b + v * c); });
    };
    const double u = peak(0.0, 1.0, 8, [&](double at) { return along(at).value; }).at;
    const Peak found = along(u);
    if (found.value > best.height) best = {found.value, a + u * b + found.at * c};
  }
  return best;
}

}  // namespace fingertip::meshes::inline shape
