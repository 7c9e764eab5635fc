#include "meshes/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <set>
#include <utility>

#include "meshes/files.h"
#include "meshes/peak.h"

namespace fingertip::meshes {
namespace {

using Triangle = std::array<Vector3, 3>;

/// A length over the extent that is round-off: vertices so near a plane lie in it.
constexpr double in_plane = 1e-9;
/// Two places are of one wall when the way between them along the surface is this many times
/// longer than through the rubber (as of a Meridian).
constexpr double far_along = 4.0;
/// A wall is measured once in each part of the surface, of this share of the largest radius; there
/// are about so many parts at most, and with more facets ways along the surface lead over parts.
constexpr double part_size = 0.125;
constexpr double most_parts = 2000.0;
constexpr std::size_t many_facets = 2000;
/// The cap whose area tells the curvature at the pole, over the height of the pole above the bond.
constexpr double cap_height = 0.05;

[[noreturn]] void refuse_bond(const std::string& value, const std::string& rule,
                              const std::string& remedy) {
  throw InvalidInput({"geometry.bond", value, rule, remedy});
}

double signed_height(const HalfSpace& space, const Vector3& w) {
  return w[space.axis] - space.limit;
}

/// Cuts triangles along planes, edges once for both their triangles.
class Cutter {
 public:
  explicit Cutter(TriangleMesh& mesh) : mesh_(mesh) {
    Eigen::AlignedBox3d box;
    for (const Vector3& vertex : mesh.vertices) box.extend(vertex);
    grain_ = in_plane * box.sizes().maxCoeff();
  }

  double grain() const { return grain_; }

  void cut(const HalfSpace& plane) {
    std::map<std::pair<int, int>, int> cuts;
    std::vector<std::array<int, 3>> pieces;
    std::vector<int> faces;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& triangle = mesh_.triangles[t];
      std::array<std::vector<int>, 2> sides;  // below and above
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = triangle[c], b = triangle[(c + 1) % 3];
        const int from = side(plane, a), to = side(plane, b);
        if (from <= 0) sides[0].push_back(a);
        if (from >= 0) sides[1].push_back(a);
        if (from * to >= 0) continue;
        const auto [place, is_new] = cuts.try_emplace(std::minmax(a, b), 0);
        if (is_new) place->second = meeting(plane, place->first);
        for (auto& polygon : sides) polygon.push_back(place->second);
      }
      // A triangle that only touches the plane, or lies in it, is not cut.
      if (sides[0].size() < 3 || sides[1].size() < 3 || sides[0] == sides[1])
        pieces.push_back(triangle);
      else
        for (const auto& polygon : sides)
          for (std::size_t c = 2; c < polygon.size(); ++c)
            pieces.push_back({polygon[0], polygon[c - 1], polygon[c]});
      if (!mesh_.faces.empty()) faces.resize(pieces.size(), mesh_.faces[t]);
    }
    mesh_.triangles = std::move(pieces);
    mesh_.faces = std::move(faces);
  }

 private:
  int side(const HalfSpace& plane, int vertex) const {
    const double height = signed_height(plane, mesh_.vertices[std::size_t(vertex)]);
    return std::abs(height) <= grain_ ? 0 : height > 0.0 ? 1 : -1;
  }
  int meeting(const HalfSpace& plane, const std::pair<int, int>& edge) {
    const Vector3 a = mesh_.vertices[std::size_t(edge.first)],
                  b = mesh_.vertices[std::size_t(edge.second)];
    const double from = signed_height(plane, a), to = signed_height(plane, b);
    Vector3 w = a + from / (from - to) * (b - a);
    w[plane.axis] = plane.limit;
    mesh_.vertices.push_back(w);
    return int(mesh_.vertices.size()) - 1;
  }

  TriangleMesh& mesh_;
  double grain_ = 0.0;
};

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

/// Hands over the middle of halves of halves, along the longest edges, until no edge exceeds
/// `longest`, and their area, of which the whole has `area`.
void for_each_patch(const Triangle& corners, double longest, double area, const auto& visit) {
  std::size_t split = 0;
  double length = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double own = (corners[(c + 1) % 3] - corners[c]).norm();
    if (own > length) length = own, split = c;
  }
  if (length <= longest) {
    visit(Vector3((corners[0] + corners[1] + corners[2]) / 3.0), area);
    return;
  }
  const Vector3 &a = corners[split], &b = corners[(split + 1) % 3], &c = corners[(split + 2) % 3];
  const Vector3 middle = 0.5 * (a + b);
  for_each_patch({a, middle, c}, longest, 0.5 * area, visit);
  for_each_patch({middle, b, c}, longest, 0.5 * area, visit);
}

Triangle corners_of(const TriangleMesh& mesh, std::size_t t) {
  return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}

/// Where the way from one point over the edge a, b to another one is shortest, nearly.
Vector3 crossing(const Vector3& a, const Vector3& b, const Vector3& from, const Vector3& to) {
  const auto at = [&](double t) -> Vector3 { return a + t * (b - a); };
  const auto way = [&](double t) { return (at(t) - from).norm() + (at(t) - to).norm(); };
  double low = 0.0, high = 1.0;
  for (int third = 0; third < 12; ++third) {
    const double left = (2.0 * low + high) / 3.0, right = (low + 2.0 * high) / 3.0;
    (way(left) < way(right) ? high : low) = way(left) < way(right) ? right : left;
  }
  return at(0.5 * (low + high));
}

/// Facets in one cube of space that face the same way, within 55 degrees.
class SurfaceParts {
 public:
  SurfaceParts(const TriangleMesh& mesh, const std::vector<std::array<std::size_t, 3>>& neighbours,
               double area, double radius)
      : size_(std::max(part_size * radius, std::sqrt(area / most_parts))) {
    std::vector<double> areas;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vector3 vector = mesh.area_vector(t);
      const double own = vector.norm();
      part_of_.push_back(part_at(mesh.centroid(t), vector));
      if (part_of_.back() >= areas.size()) {
        areas.resize(part_of_.back() + 1, 0.0);
        centres_.resize(areas.size(), Vector3::Zero());
      }
      areas[part_of_.back()] += own;
      centres_[part_of_.back()] += own * mesh.centroid(t);
    }
    for (std::size_t p = 0; p < areas.size(); ++p)
      if (areas[p] > 0.0) centres_[p] /= areas[p];
    next_.resize(areas.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::size_t other : neighbours[t])
        if (part_of_[t] != part_of_[other]) next_[part_of_[t]].insert(part_of_[other]);
  }

  double size() const { return size_; }

  /// The part of a place where the surface has this normal, numbered when it is asked for first.
  std::size_t part_at(const Vector3& w, const Vector3& normal) {
    return numbers_.try_emplace(key_of(w, normal, size_), numbers_.size()).first->second;
  }

  /// Length of the way along the surface, by the parts' middles, or a length beyond `enough` [m].
  double way(std::size_t from, std::size_t to, const Vector3& start, const Vector3& end,
             double enough) const {
    using Place = std::pair<double, std::size_t>;  // with the least that is still to come
    std::map<std::size_t, double> so_far{{part_of_[from], 0.0}};
    std::priority_queue<Place, std::vector<Place>, std::greater<>> open;
    open.emplace((start - end).norm(), part_of_[from]);
    while (!open.empty()) {
      const auto [least, part] = open.top();
      open.pop();
      if (least > enough || part == part_of_[to]) return least;
      const Vector3& here = part == part_of_[from] ? start : centres_[part];
      const double until = so_far.at(part);
      for (const std::size_t other : next_[part]) {
        const double further = until + (centres_[other] - here).norm();
        const auto [known, is_new] = so_far.try_emplace(other, further);
        if (!is_new && known->second <= further) continue;
        known->second = further;
        open.emplace(further + (centres_[other] - end).norm(), other);
      }
    }
    return std::numeric_limits<double>::infinity();  // a cavity's wall
  }

  using Key = std::array<int, 5>;
  static Key key_of(const Vector3& w, const Vector3& normal, double size) {
    // Planes at round heights stay whole.
    const Vector3 cube = (w / size - Vector3::Constant(0.38)).array().floor();
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return {int(cube.x()), int(cube.y()), int(cube.z()), int(axis), normal[axis] > 0.0};
  }

 private:
  double size_;
  std::map<Key, std::size_t> numbers_;
  std::vector<std::size_t> part_of_;
  std::vector<Vector3> centres_;
  std::vector<std::set<std::size_t>> next_;
};

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

}  // namespace

Solid::Solid(const TriangleMesh& mesh, const Region& bond, const std::vector<std::string>& faces)
    : mesh_(closed_surface(mesh)) {
  check_crossings(mesh_);
  Cutter cutter(mesh_);
  for (const auto& all : bond)
    for (const HalfSpace& space : all) cutter.cut(space);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const int face = mesh_.faces.empty() ? -1 : mesh_.faces[t];
    const bool is_held =
        within(bond, corners_of(mesh_, t), cutter.grain()) ||
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
  measure();
  tree_ = std::make_unique<TriangleTree>(mesh_, groups_, 2);
}

bool Solid::is(ProfileSurface surface, std::size_t triangle) const {
  return surface == (is_bond(triangle) ? ProfileSurface::bond : ProfileSurface::contact);
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
    for (const Vector3& w : corners_of(mesh_, t)) {
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
      "heights " + to_text(1e3 * box.min().z()) + " to " + to_text(1e3 * box.max().z()) + " mm";
  if (bond_area_ == 0.0)
    refuse_bond(
        heights, "something must be held by the hand",
        "give half spaces that hold some of the surface, e.g. geometry.bond = \"z < 1 mm\"" +
            or_faces(mesh_.face_names));
  if (contact_area_ == 0.0)
    refuse_bond(heights, "something must be able to touch",
                "give half spaces that leave some of the surface free");
  if (bond_top_ >= pole_)
    refuse_bond(
        "bond up to z = " + to_text(1e3 * bond_top_) + " mm",
        "no bond may lie higher than what may touch, which ends at " + to_text(1e3 * pole_) + " mm",
        "turn the finger so that it points along +z, or change the half spaces");
  if (box.min().head<2>().maxCoeff() > 0.0 || box.max().head<2>().minCoeff() < 0.0)
    throw InvalidInput({"geometry.file", "x and y around " + place_of(box.center()),
                        "the axis x = y = 0 must pass through the finger",
                        "put the origin of the coordinates on the finger's axis"});
  const double height = cap_height * (pole_ - bond_top_);
  double shadow = 0.0;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (!is_bond(t)) shadow += shadow_above(corners_of(mesh_, t), pole_ - height);
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

std::vector<SurfacePoint> Solid::points(ProfileSurface surface, double spacing) const {
  // Half the spacing: the middle of a bent patch lies within the rubber.
  const double size = 0.5 * spacing;
  struct Sum {
    double area = 0.0;
    Vector3 moment = Vector3::Zero(), vector = Vector3::Zero();
  };
  std::map<SurfaceParts::Key, Sum> sums;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vector3 vector = mesh_.area_vector(t);
    const double whole = vector.norm();
    if (!is(surface, t) || whole == 0.0) continue;
    for_each_patch(corners_of(mesh_, t), spacing, whole, [&](const Vector3& middle, double area) {
      Sum& sum = sums[SurfaceParts::key_of(middle, vector, size)];
      sum.area += area;
      sum.moment += area * middle;
      sum.vector += area / whole * vector;
    });
  }
  std::vector<SurfacePoint> points;
  for (const auto& [key, sum] : sums)
    points.push_back({sum.moment / sum.area, sum.vector.normalized(), sum.area});
  return points;
}

double Solid::wall() const {
  std::call_once(wall_known_, [this] { wall_ = thinnest(); });
  return wall_;
}

double Solid::thinnest() const {
  const double bound = pole_ - bond_top_;
  SurfaceParts parts(mesh_, neighbours_, contact_area_ + bond_area_, radius_);
  // Of each part the shortest way through the rubber.
  std::map<std::size_t, WallRay> shortest;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vector3 vector = mesh_.area_vector(t);
    if (is_bond(t) || vector.norm() == 0.0) continue;
    const Vector3 inward = -vector.normalized();
    for_each_patch(corners_of(mesh_, t), parts.size(), 0.0, [&](const Vector3& start, double) {
      const auto hit = tree_->first_on_ray(start, inward, t);
      if (!hit || hit->distance >= bound) return;
      const WallRay ray{hit->distance, t, hit->triangle, start, hit->position};
      const auto [known, is_new] = shortest.try_emplace(parts.part_at(start, vector), ray);
      if (!is_new && ray.depth < known->second.depth) known->second = ray;
    });
  }
  std::vector<WallRay> rays;
  for (const auto& [part, ray] : shortest) rays.push_back(ray);
  std::ranges::sort(rays, {}, &WallRay::depth);
  // Near an edge rubber runs out in a wedge, which is no wall.
  const bool coarsely = mesh_.triangles.size() > many_facets;
  for (const WallRay& ray : rays)
    if (coarsely && ray.depth > parts.size()
            ? parts.way(ray.from, ray.to, ray.start, ray.end, far_along * ray.depth) >
                  far_along * ray.depth
            : apart(ray))
      return ray.depth;
  return bound;
}

bool Solid::apart(const WallRay& ray) const {
  // A* from facet to facet, across each edge where the way is shortest. The largest estimate that
  // still counts as near is far_along times the depth.
  struct Place {
    double estimate, so_far;
    Vector3 at;
    std::size_t triangle;
    bool operator<(const Place& other) const { return estimate > other.estimate; }
  };
  std::map<std::size_t, double> least{{ray.from, 0.0}};
  std::priority_queue<Place> next;
  next.push({(ray.start - ray.end).norm(), 0.0, ray.start, ray.from});
  while (!next.empty()) {
    const Place place = next.top();
    next.pop();
    if (place.estimate > far_along * ray.depth) return true;
    if (place.triangle == ray.to) return false;
    if (place.so_far > least.at(place.triangle)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3 across = crossing(mesh_.corner(place.triangle, c),
                                      mesh_.corner(place.triangle, (c + 1) % 3), place.at, ray.end);
      const double so_far = place.so_far + (across - place.at).norm();
      const std::size_t other = neighbours_[place.triangle][c];
      const auto [known, is_new] = least.try_emplace(other, so_far);
      if (!is_new && known->second <= so_far) continue;
      known->second = so_far;
      next.push({so_far + (across - ray.end).norm(), so_far, across, other});
    }
  }
  return true;  // a cavity's wall
}

}  // namespace fingertip::meshes
