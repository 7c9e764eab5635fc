/// A solid's surface in patches: its points of quadrature, and where the wall is thinnest.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline shape {
namespace {

/// Two places are of one wall when the way between them along the surface is this many times
/// longer than through the rubber (as of a Meridian).
constexpr double far_along = 4.0;
/// A wall is measured once in each part of the surface, of this share of the largest radius; there
/// are about so many parts at most, and with more facets ways along the surface lead over parts.
constexpr double part_size = 0.125;
constexpr double max_parts = 2000.0;
constexpr std::size_t many_facets = 2000;

/// Hands over the middle of halves of halves, along the longest edges, until no edge exceeds
/// `longest`, and their area, of which the whole has `area`.
void for_each_patch(const std::array<Vector3, 3>& corners, double longest, double area,
                    const auto& visit) {
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

/// Where the way from one point over the edge a, b to another one is shortest: straight with the
/// facets beside the edge unfolded.
Vector3 crossing(const Vector3& a, const Vector3& b, const Vector3& from, const Vector3& to) {
  const Vector3 edge = b - a;
  const double square = edge.squaredNorm();
  if (square == 0.0) return a;
  const auto along = [&](const Vector3& w) { return edge.dot(w - a) / square; };
  const auto off = [&](const Vector3& w) { return (w - a - along(w) * edge).norm(); };
  const double before = off(from), behind = off(to), sum = before + behind;
  const double t = sum > 0.0 ? (along(from) * behind + along(to) * before) / sum : along(from);
  return a + std::clamp(t, 0.0, 1.0) * edge;
}

/// Facets in one cube of space that face the same way, within 55 degrees.
class SurfaceParts {
 public:
  SurfaceParts(const TriangleMesh& mesh, const std::vector<std::array<std::size_t, 3>>& neighbours,
               double area, double radius)
      : size_(std::max(part_size * radius, std::sqrt(area / max_parts))) {
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

}  // namespace

std::vector<SurfacePoint> Solid::points(ProfileSurface surface, double spacing) const {
  // Half the spacing: the middle of a bent patch lies within the rubber.
  const double size = 0.5 * spacing;
  struct Sum {
    double area = 0.0;
    Vector3 moment = Vector3::Zero(), vector = Vector3::Zero();
  };
  // Of a mirrored solid those of the part at x, y >= 0, and their images.
  TriangleMesh mesh = mesh_;
  mesh.faces = groups_;
  std::vector<int> mirrors;
  for (const int axis : {0, 1})
    if (mirrored(axis)) mirrors.push_back(axis);
  for (const int axis : mirrors) cut_along(mesh, axis, 0.0, mirrored_within * radius_);
  std::map<SurfaceParts::Key, Sum> sums;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3 vector = mesh.area_vector(t), centre = mesh.centroid(t);
    const double whole = vector.norm();
    const bool held = mesh.faces[t] == bond_group;
    if (surface != (held ? ProfileSurface::bond : ProfileSurface::contact) || whole == 0.0 ||
        std::ranges::any_of(mirrors, [&](int axis) { return centre[axis] < 0.0; }))
      continue;
    const std::array<Vector3, 3> own{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    for_each_patch(own, spacing, whole, [&](const Vector3& middle, double area) {
      Sum& sum = sums[SurfaceParts::key_of(middle, vector, size)];
      sum.area += area;
      sum.moment += area * middle;
      sum.vector += area / whole * vector;
    });
  }
  std::vector<SurfacePoint> points;
  for (const auto& [key, sum] : sums)
    points.push_back({sum.moment / sum.area, sum.vector.normalized(), sum.area});
  for (const int axis : mirrors) {
    const std::size_t known = points.size();
    for (std::size_t i = 0; i < known; ++i) {
      points.push_back(points[i]);
      points.back().position[axis] *= -1.0;
      points.back().normal[axis] *= -1.0;
    }
  }
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
    for_each_patch(corners(t), parts.size(), 0.0, [&](const Vector3& start, double) {
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

}  // namespace fingertip::meshes::inline shape
