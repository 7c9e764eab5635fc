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
#include "meshes/volume_mesh/cut_surface.h"

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
constexpr double narrow = 0.02, narrow_bond = 0.4;
/// Creases of this length together, over the largest radius, which seldom branch, are meant; others
/// are the roughness of a scan.
constexpr double short_crease = 0.2;
constexpr double max_branches = 0.1;
/// Steps to where parts meet: each leaves at most the squared cosine of the angle between them,
/// 0.97 of what is missing at a lip of 10 degrees.
constexpr int max_steps = 1000;

class RevolvedParts final : public BoundaryParts {
 public:
  explicit RevolvedParts(const Geometry& geometry) : meridian_(geometry.corners()) {}

  int own_count() const override { return int(meridian_.pieces().size()); }

  PhysicalTag own_tag(int part) const override {
    switch (piece(part).surface()) {
      case ProfileSurface::contact: return PhysicalTag::outer;
      case ProfileSurface::bond: return PhysicalTag::bond;
      case ProfileSurface::free: return PhysicalTag::end;
      case ProfileSurface::axis: break;
    }
    return PhysicalTag::tip;  // no boundary
  }

  bool hides_edges(int) const override { return false; }
  Vector3 own_nearest(int part, const Vector3& w) const override {
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
    const auto first = [&](int corner) { return bands.rings[std::size_t(corner)].front(); };
    const auto last = [&](int corner) { return bands.rings[std::size_t(corner)].back(); };
    std::vector<std::array<int, 2>> sides;
    const int corners = int(outline.corners.size());
    for (int i = 0; i < corners; ++i) sides.push_back({i, (i + 1) % corners});
    for (const auto& [a, b, c] : filled(outline.corners, sides)) {
      add(first(a), first(b), first(c), plane_y());
      add(last(a), last(c), last(b), other);
    }
    return result;
  }

 private:
  const MeridianPiece& piece(int part) const { return meridian_.pieces()[std::size_t(part)]; }

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
    tree_ = std::make_unique<TriangleTree>(mesh, parts_, own_count());
  }

  int own_count() const override { return int(bonded_.size()); }
  PhysicalTag own_tag(int part) const override {
    return bonded_[std::size_t(part)] ? PhysicalTag::bond : PhysicalTag::outer;
  }
  bool hides_edges(int part) const override {
    return part < own_count() && hides_edges_[std::size_t(part)];
  }
  Vector3 own_nearest(int part, const Vector3& w) const override {
    return tree_->nearest(w, part)->position;
  }
  PartedSurface surface(Sector sector) const override {
    PartedSurface all{solid_->mesh(), parts_, creases_, hides_edges_};
    const double grain = Solid::mirrored_within * solid_->largest_radius();
    if (sector != Sector::full) all = positive_side(std::move(all), 1, grain, plane_y());
    if (sector == Sector::quarter) all = positive_side(std::move(all), 0, grain, plane_x());
    return all;
  }

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

PhysicalTag BoundaryParts::tag(int part) const {
  if (part == plane_y()) return PhysicalTag::symmetry_y;
  return part == plane_x() ? PhysicalTag::symmetry_x : own_tag(part);
}

Vector3 BoundaryParts::nearest(int part, const Vector3& w) const {
  if (part == plane_y()) return {w.x(), 0.0, w.z()};
  if (part == plane_x()) return {0.0, w.y(), w.z()};
  return own_nearest(part, w);
}

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
