#include "meshes/volume_mesh/boundary_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "meshes/shape/meridian.h"
#include "meshes/shape/revolved_surface.h"
#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

/// Facets around a full turn, and of a piece of a meridian per radian that it turns, of a line per
/// largest radius: chords are within 0.03 % of the radius.
constexpr int facets_around = 128;
constexpr double facets_per_radian = 20.0, facets_per_radius = 8.0;
/// Facets that turn by less than 40 degrees go on from one to the other: those of a chamfer do not.
constexpr double smooth_cosine = 0.766;
/// A part this narrow, over the largest radius, belongs to a neighbour: elements of its width would
/// be countless. What is held moves as one, so that its own edges do not matter.
constexpr double narrow = 0.02, narrow_bond = 0.2;
/// Creases of this length together, over the largest radius, which seldom branch, are meant; others
/// are the roughness of a scan.
constexpr double short_crease = 0.2;
constexpr double max_branches = 0.1;
/// Steps to where parts meet: each leaves at most the squared cosine of the angle between them,
/// 0.97 of what is missing at a lip of 10 degrees.
constexpr int max_steps = 1000;

double turned(const Vector2& a, const Vector2& b, const Vector2& c) {
  return cross(b - a, c - b);
}

/// Numbers of the corners of triangles that fill a simple polygon, counter-clockwise as it is.
std::vector<std::array<std::size_t, 3>> filled(const std::vector<Vector2>& polygon) {
  std::vector<std::size_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<std::array<std::size_t, 3>> triangles;
  const auto is_ear = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Vector2 &p = polygon[a], &q = polygon[b], &r = polygon[c];
    if (!(turned(p, q, r) > 0.0)) return false;
    return std::ranges::none_of(left, [&](std::size_t other) {
      if (other == a || other == b || other == c) return false;
      const Vector2& w = polygon[other];
      return turned(p, q, w) >= 0.0 && turned(q, r, w) >= 0.0 && turned(r, p, w) >= 0.0;
    });
  };
  while (left.size() > 2) {
    // The fattest ear, so that no sliver is left at the end.
    std::size_t best = left.size();
    double widest = -1.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::size_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                        c = left[(i + 1) % left.size()];
      if (!is_ear(a, b, c)) continue;
      const double wide =
          turned(polygon[a], polygon[b], polygon[c]) / (polygon[c] - polygon[a]).squaredNorm();
      if (wide > widest) widest = wide, best = i;
    }
    if (best == left.size())
      throw NotConverged("the section of the finger could not be filled with triangles");
    triangles.push_back(
        {left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
    left.erase(left.begin() + std::ptrdiff_t(best));
  }
  return triangles;
}

class RevolvedParts final : public BoundaryParts {
 public:
  explicit RevolvedParts(const Geometry& geometry) : meridian_(geometry.corners()) {}

  int count() const override { return int(meridian_.pieces().size()) + 2; }

  PhysicalTag tag(int part) const override {
    if (part == plane_y()) return PhysicalTag::symmetry_y;
    if (part == plane_x()) return PhysicalTag::symmetry_x;
    switch (piece(part).surface()) {
      case ProfileSurface::contact: return PhysicalTag::outer;
      case ProfileSurface::bond: return PhysicalTag::bond;
      case ProfileSurface::free: return PhysicalTag::end;
      case ProfileSurface::axis: break;
    }
    return PhysicalTag::tip;  // no boundary
  }

  bool hides_edges(int) const override { return false; }
  Vector3 nearest(int part, const Vector3& w) const override {
    if (part == plane_y()) return {w.x(), 0.0, w.z()};
    if (part == plane_x()) return {0.0, w.y(), w.z()};
    const double r = w.head<2>().norm();
    const Vector2 found = piece(part).at(piece(part).nearest({r, w.z()}));
    const double scale = r > 0.0 ? found.x() / r : 0.0;
    return {scale * w.x(), scale * w.y(), found.y()};
  }

  PartedSurface surface(Sector sector) const override {
    const MeridianPolygon outline = chords();
    const int turns = sector == Sector::full   ? facets_around
                      : sector == Sector::half ? facets_around / 2
                                               : facets_around / 4;
    SweptPolygon bands = swept(outline, facets_around, turns);
    PartedSurface result{std::move(bands.mesh), std::move(bands.pieces)};
    if (sector == Sector::full) return result;
    const auto add = [&](int a, int b, int c, int part) {
      result.mesh.triangles.push_back({a, b, c});
      result.parts.push_back(part);
    };
    const int other = sector == Sector::half ? plane_y() : plane_x();
    const auto& rings = bands.rings;
    for (const auto& [a, b, c] : filled(outline.corners)) {
      add(rings[a].front(), rings[b].front(), rings[c].front(), plane_y());
      add(rings[a].back(), rings[c].back(), rings[b].back(), other);
    }
    return result;
  }

 private:
  const MeridianPiece& piece(int part) const { return meridian_.pieces()[std::size_t(part)]; }
  int plane_y() const { return count() - 2; }
  int plane_x() const { return count() - 1; }

  MeridianPolygon chords() const {
    return chords_of(meridian_, [&](const MeridianPiece& piece) {
      double sides = facets_per_radius * piece.length() / meridian_.largest_radius();
      if (piece.curve() != ProfileCurve::straight)
        sides = std::max(sides, facets_per_radian * turn_of(piece));
      return std::max(1, int(sides));
    });
  }

  /// The angle through which a piece turns [rad].
  static double turn_of(const MeridianPiece& own) {
    constexpr int samples = 16;
    double turn = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double cosine =
          own.normal(double(i) / samples).dot(own.normal(double(i + 1) / samples));
      turn += std::acos(std::clamp(cosine, -1.0, 1.0));
    }
    return turn;
  }

  Meridian meridian_;
};

class SolidParts final : public BoundaryParts {
 public:
  explicit SolidParts(std::shared_ptr<const Solid> solid) : solid_(std::move(solid)) {
    const TriangleMesh& mesh = solid_->mesh();
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t other = solid_->neighbours()[t][c];
        if (other < t)
          sides_.push_back({t,
                            other,
                            {mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]},
                            (mesh.corner(t, c) - mesh.corner(t, (c + 1) % 3)).norm()});
      }
    Classes classes(count);
    for (const Side& side : sides_)
      if (continues(side)) classes.unite(side.t, side.other);
    find_creases(classes);
    std::vector<std::size_t> united;
    while (unite_narrow(classes, united)) {
    }
    std::map<std::size_t, int> numbers;
    for (std::size_t t = 0; t < count; ++t) {
      const auto [known, is_new] = numbers.try_emplace(classes.of(t), int(numbers.size()));
      if (is_new) bonded_.push_back(solid_->is_bond(t));
      parts_.push_back(known->second);
    }
    hides_edges_.resize(bonded_.size());
    for (const std::size_t t : united)
      if (solid_->is_bond(t)) hides_edges_[std::size_t(parts_[t])] = true;
    tree_ = std::make_unique<TriangleTree>(mesh, parts_, this->count());
  }

  int count() const override { return int(bonded_.size()); }
  PhysicalTag tag(int part) const override {
    return bonded_[std::size_t(part)] ? PhysicalTag::bond : PhysicalTag::outer;
  }
  bool hides_edges(int part) const override { return hides_edges_[std::size_t(part)]; }
  Vector3 nearest(int part, const Vector3& w) const override {
    const auto hit = tree_->nearest(w, part);
    return hit ? hit->position : w;
  }
  PartedSurface surface(Sector) const override { return {solid_->mesh(), parts_, creases_}; }

 private:
  /// An edge and its two triangles.
  struct Side {
    std::size_t t, other;
    std::array<int, 2> ends;
    double length;
  };

  /// Triangles that belong together.
  class Classes {
   public:
    explicit Classes(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0); }
    std::size_t of(std::size_t t) {
      while (root_[t] != t) t = root_[t] = root_[root_[t]];
      return t;
    }
    void unite(std::size_t t, std::size_t other) { root_[of(t)] = of(other); }

   private:
    std::vector<std::size_t> root_;
  };

  bool same_surface(const Side& side) const {
    return solid_->is_bond(side.t) == solid_->is_bond(side.other);
  }
  bool continues(const Side& side) const {
    const Vector3 a = solid_->mesh().area_vector(side.t),
                  b = solid_->mesh().area_vector(side.other);
    // Also where one has no area.
    return same_surface(side) && a.dot(b) >= smooth_cosine * a.norm() * b.norm();
  }

  /// Where a class turns sharply into itself, as an edge that fades out lets it.
  void find_creases(Classes& classes) {
    std::vector<Side> sharp;
    std::map<int, int> meeting;  // creases at a vertex
    Classes chains(solid_->mesh().vertices.size());
    for (const Side& side : sides_) {
      if (continues(side) || classes.of(side.t) != classes.of(side.other)) continue;
      sharp.push_back(side);
      for (const int end : side.ends) ++meeting[end];
      chains.unite(std::size_t(side.ends[0]), std::size_t(side.ends[1]));
    }
    struct Chain {
      double length = 0.0;
      int vertices = 0, branches = 0;
    };
    std::map<std::size_t, Chain> all;
    for (const Side& side : sharp) all[chains.of(std::size_t(side.ends[0]))].length += side.length;
    for (const auto& [vertex, creases] : meeting) {
      Chain& chain = all[chains.of(std::size_t(vertex))];
      ++chain.vertices;
      if (creases > 2) ++chain.branches;
    }
    for (const Side& side : sharp) {
      const Chain& chain = all[chains.of(std::size_t(side.ends[0]))];
      if (chain.length > short_crease * solid_->largest_radius() &&
          chain.branches <= max_branches * chain.vertices)
        creases_.push_back(side.ends);
    }
  }

  /// Unites the narrowest class, if it is narrow, with the neighbour of the longest border; adds
  /// one of its triangles to those that were.
  bool unite_narrow(Classes& classes, std::vector<std::size_t>& united) const {
    struct Class {
      double area = 0.0, border = 0.0;
      std::map<std::size_t, double> neighbours;
    };
    std::map<std::size_t, Class> all;
    for (std::size_t t = 0; t < solid_->mesh().triangles.size(); ++t)
      all[classes.of(t)].area += solid_->mesh().area_vector(t).norm();
    for (const Side& side : sides_) {
      const std::size_t a = classes.of(side.t), b = classes.of(side.other);
      if (a == b) continue;
      for (const auto& [own, other] : {std::pair{a, b}, std::pair{b, a}}) {
        all[own].border += side.length;
        if (same_surface(side)) all[own].neighbours[other] += side.length;
      }
    }
    std::optional<std::pair<std::size_t, std::size_t>> found;
    double least = 1.0;
    for (const auto& [number, own] : all) {
      if (own.neighbours.empty()) continue;
      const double bound = solid_->is_bond(number) ? narrow_bond : narrow;
      const double width = 2.0 * own.area / own.border / (bound * solid_->largest_radius());
      if (width >= least) continue;
      least = width;
      found = {number, std::ranges::max_element(own.neighbours, {}, [](const auto& entry) {
                         return entry.second;
                       })->first};
    }
    if (!found) return false;
    classes.unite(found->first, found->second);
    united.push_back(found->first);
    return true;
  }

  std::shared_ptr<const Solid> solid_;
  std::vector<Side> sides_;
  std::vector<int> parts_;
  std::vector<std::array<int, 2>> creases_;
  std::vector<bool> bonded_, hides_edges_;
  std::unique_ptr<TriangleTree> tree_;
};

}  // namespace

int BoundaryParts::part_at(PhysicalTag wanted, const Vector3& w) const {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int part = 0; part < count(); ++part) {
    if (tag(part) != wanted) continue;
    const double distance = (nearest(part, w) - w).norm();
    if (distance < least) least = distance, best = part;
  }
  return best;
}

Vector3 BoundaryParts::on(const std::vector<int>& parts, const Vector3& w) const {
  Vector3 place = w;
  if (parts.size() == 1) return nearest(parts[0], place);
  for (int step = 0; step < max_steps; ++step) {
    const Vector3 before = place;
    for (const int part : parts) place = nearest(part, place);
    if ((place - before).norm() <= 1e-14 * place.norm()) break;
  }
  return place;
}

std::unique_ptr<const BoundaryParts> boundary_parts(const Geometry& geometry) {
  const std::vector<Violation> broken = geometry.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  if (geometry.solid) return std::make_unique<SolidParts>(geometry.solid);
  return std::make_unique<RevolvedParts>(geometry);
}

}  // namespace fingertip::meshes::inline volume_mesh
