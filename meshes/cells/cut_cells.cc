#include "meshes/cells/cut_cells.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "meshes/base/files.h"
#include "meshes/cells/revolved_cells.h"
#include "meshes/cells/smoothed_gauss.h"
#include "meshes/cells/solid_cells.h"

// On a grid along the axis: revolved_cells.h. On a turned one, of the dome, a cell's integral is
// three nested ones. Along the innermost direction a line meets the boundary (spheres, cylinders,
// planes) where quadratic equations say, so that integral is exact. Along the other two the
// integrand is smooth except where the way the boundary passes through the cell changes: at the
// cell's own edges and faces, at silhouettes, and at the circles in which the quadrics meet. All
// these events are crossings of straight lines with the boundary, too, and Gauss points are laid
// between them. Dimension reduction: Saye, SIAM J. Sci. Comput. 37 (2015) A993.

namespace fingertip::meshes::inline cells {

namespace {

constexpr double same_event = 1e-10;  ///< events closer than this [cells] count as one
constexpr double parallel = 1e-12;    ///< squared sine below which directions count as parallel

/// The points at + t along.
struct Line {
  Vector3 at;
  Vector3 along;
};

/// Sphere |w| = radius or cylinder hypot(x, y) = radius.
struct Round {
  double radius;
  bool sphere;

  /// The quadratic form whose value is radius² on the surface.
  double form(const Vector3& u, const Vector3& v) const {
    return u.x() * v.x() + u.y() * v.y() + (sphere ? u.z() * v.z() : 0.0);
  }
};

/// Parameters at which a line of a cell meets the boundary: 4 rounds twice, 2 planes, and the ends.
using Crossings = boost::container::static_vector<double, 12>;

/// One cell and the pieces of the boundary that may pass through it.
class Cell {
 public:
  Cell(const Geometry& geometry, const CubicGrid& grid, int i, int j, int k);

  std::array<double, 8> moments();

 private:
  void choose_pieces(const CubicGrid& grid, const Vector3& centre);
  void choose_order(const CubicGrid& grid, const Vector3& centre);

  Crossings crossings(const Line& line) const;
  void add_events(const Line& line, std::vector<double>& events) const;
  void add_slice_events(const Vector3& at, const Vector3& outer, const Vector3& inner,
                        std::vector<double>& events) const;
  void add_tangent_slices(std::vector<double>& events) const;
  void find_slices();

  std::array<double, 2> line_moments(const Vector3& at) const;
  std::array<double, 4> slice_moments(const Vector3& at);

  const Geometry& geometry_;
  double spacing_;
  Vector3 corner_;
  std::array<int, 3> order_{0, 1, 2};  ///< grid direction of the outer, middle, inner integral
  Vector3 outer_, middle_, inner_;     ///< edges of the cell [m]
  boost::container::static_vector<Round, 4> rounds_;
  boost::container::static_vector<double, 2> heights_;  ///< planes z = const that bound a piece
  std::vector<double> slices_, strips_;  ///< events of the outer and of the middle integral
};

Cell::Cell(const Geometry& geometry, const CubicGrid& grid, int i, int j, int k)
    : geometry_(geometry), spacing_(grid.spacing), corner_(grid.position(i, j, k)) {
  const Vector3 centre = corner_ + 0.5 * spacing_ * grid.axes.rowwise().sum();
  choose_pieces(grid, centre);
  choose_order(grid, centre);
}

void Cell::choose_pieces(const CubicGrid& grid, const Vector3& centre) {
  const double safety = 1.0 + 1e-9;
  const double reach = 0.5 * std::numbers::sqrt3 * spacing_ * safety;
  const double height = 0.5 * spacing_ * grid.axes.row(2).cwiseAbs().sum() * safety;
  for (const double radius : {geometry_.rod_radius, geometry_.tip_radius}) {
    if (centre.z() > -height && std::abs(centre.norm() - radius) < reach) {
      rounds_.push_back({radius, true});
    }
    if (centre.z() < height && std::abs(centre.head<2>().norm() - radius) < reach) {
      rounds_.push_back({radius, false});
    }
  }
  for (const double z : {0.0, -geometry_.sleeve_length}) {
    if (std::abs(centre.z() - z) < height) heights_.push_back(z);
  }
}

/// Lines that meet the boundary squarely have the fewest events: the inner direction is the one
/// closest to the normal, the outer one the farthest from it.
void Cell::choose_order(const CubicGrid& grid, const Vector3& centre) {
  Vector3 normal = Vector3::UnitZ();
  if (!rounds_.empty()) {
    normal = {centre.x(), centre.y(), std::max(centre.z(), 0.0)};
  }
  const Vector3 along = (grid.axes.transpose() * normal).cwiseAbs();
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return along[a] < along[b]; });
  outer_ = spacing_ * grid.axes.col(order_[0]);
  middle_ = spacing_ * grid.axes.col(order_[1]);
  inner_ = spacing_ * grid.axes.col(order_[2]);
}

/// The parameters in (0, 1) at which `line` meets a piece of the boundary, unordered. Pieces are
/// not ended where the next begins: a parameter too many does no harm.
Crossings Cell::crossings(const Line& line) const {
  Crossings found;
  // False for the infinities and NaN of lines parallel to a piece.
  const auto add = [&](double t) {
    if (t > 0.0 && t < 1.0) found.push_back(t);
  };
  for (const Round& round : rounds_) {
    const double a = round.form(line.along, line.along);
    const double b = round.form(line.at, line.along);
    const double c = round.form(line.at, line.at) - round.radius * round.radius;
    const double discriminant = b * b - a * c;
    if (discriminant <= 0.0) continue;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    add(q / a);
    add(c / q);
  }
  for (const double z : heights_) add((z - line.at.z()) / line.along.z());
  return found;
}

/// Appends the crossings of `line` that lie in the cell.
void Cell::add_events(const Line& line, std::vector<double>& events) const {
  const double rim = 1e-9, square = spacing_ * spacing_;
  for (const double t : crossings(line)) {
    const Vector3 w = line.at + t * line.along - corner_;
    bool inside = true;
    for (const Vector3* edge : {&outer_, &middle_, &inner_}) {
      const double coordinate = w.dot(*edge) / square;
      inside = inside && coordinate > -rim && coordinate < 1.0 + rim;
    }
    if (inside) events.push_back(t);
  }
}

/// Appends every s at which what the lines t -> at + s outer + t inner meet changes.
void Cell::add_slice_events(const Vector3& at, const Vector3& outer, const Vector3& inner,
                            std::vector<double>& events) const {
  const double square = spacing_ * spacing_;
  add_events({at, outer}, events);
  add_events({at + inner, outer}, events);
  // Silhouettes, where the inner lines touch a round: form(at + s outer + t inner, inner) = 0.
  for (const Round& round : rounds_) {
    const double steepness = round.form(inner, inner);
    if (steepness < parallel * square) continue;
    add_events({at - round.form(at, inner) / steepness * inner,
                outer - round.form(outer, inner) / steepness * inner},
               events);
  }
  // The circles where pieces meet lie in the planes: z = const along at + s outer + t inner.
  for (const double z : heights_) {
    const double rise = inner.z();
    if (rise * rise < parallel * square) continue;
    add_events({at + (z - at.z()) / rise * inner, outer - outer.z() / rise * inner}, events);
  }
}

/// Appends the slices that touch a sphere or a circle in which pieces meet. A cylinder is touched
/// along a line, which leaves the cell through its faces or ends on such a circle.
void Cell::add_tangent_slices(std::vector<double>& events) const {
  const double square = spacing_ * spacing_;
  add_events({corner_.dot(outer_) / square * outer_, outer_}, events);
  const Vector3 flat(outer_.x(), outer_.y(), 0.0);
  if (flat.squaredNorm() < parallel * square) return;
  const Vector3 along = square / flat.squaredNorm() * flat;
  for (const double z : heights_) {
    const Vector3 centre(0.0, 0.0, z);
    add_events({centre - (centre - corner_).dot(outer_) / square * along, along}, events);
  }
}

/// Orders events, merges those that coincide, and adds the ends of [0, 1].
void complete(std::vector<double>& events) {
  events.push_back(0.0);
  std::sort(events.begin(), events.end());
  const auto same = [](double a, double b) { return b - a < same_event; };
  events.erase(std::unique(events.begin(), events.end(), same), events.end());
  if (1.0 - events.back() < same_event && events.size() > 1) events.pop_back();
  events.push_back(1.0);
}

/// Finds the values of the outer coordinate between which the slices change smoothly.
void Cell::find_slices() {
  slices_.clear();
  for (const double side : {0.0, 1.0}) {
    add_slice_events(corner_ + side * middle_, outer_, inner_, slices_);
    add_slice_events(corner_ + side * inner_, outer_, middle_, slices_);
  }
  add_tangent_slices(slices_);
  complete(slices_);
}

/// Integrals of 1 and t over the rubber on at + t inner, 0 <= t <= 1.
std::array<double, 2> Cell::line_moments(const Vector3& at) const {
  Crossings cuts = crossings({at, inner_});
  cuts.push_back(1.0);
  // By insertion: they are few, and GCC 12 warns of std::sort's on so short an array.
  for (auto next = cuts.begin(); next != cuts.end(); ++next)
    std::rotate(std::upper_bound(cuts.begin(), next, *next), next, next + 1);
  std::array<double, 2> sum{0.0, 0.0};
  double from = 0.0;
  for (const double to : cuts) {
    const double length = to - from, middle = 0.5 * (from + to);
    if (geometry_.contains(at + middle * inner_)) {
      sum[0] += length;
      sum[1] += length * middle;
    }
    from = to;
  }
  return sum;
}

/// Integrals of s^j t^k, [j + 2 k], over the rubber on at + s middle + t inner.
std::array<double, 4> Cell::slice_moments(const Vector3& at) {
  strips_.clear();
  add_slice_events(at, middle_, inner_, strips_);
  complete(strips_);
  std::array<double, 4> sum{};
  for (std::size_t e = 1; e < strips_.size(); ++e) {
    const double width = strips_[e] - strips_[e - 1];
    for (const QuadratureNode& node : smoothed_gauss_rule()) {
      const double s = strips_[e - 1] + width * node.at, weight = width * node.weight;
      const auto line = line_moments(at + s * middle_);
      for (std::size_t k = 0; k < 2; ++k) {
        sum[2 * k] += weight * line[k];
        sum[2 * k + 1] += weight * s * line[k];
      }
    }
  }
  return sum;
}

std::array<double, 8> Cell::moments() {
  find_slices();
  std::array<double, 8> sum{};
  for (std::size_t e = 1; e < slices_.size(); ++e) {
    const double width = slices_[e] - slices_[e - 1];
    for (const QuadratureNode& node : smoothed_gauss_rule()) {
      const double x = slices_[e - 1] + width * node.at, weight = width * node.weight;
      const auto slice = slice_moments(corner_ + x * outer_);
      for (std::size_t jk = 0; jk < 4; ++jk) {
        const std::size_t place = ((jk & 1) << order_[1]) + ((jk >> 1) << order_[2]);
        sum[place] += weight * slice[jk];
        sum[place + (std::size_t{1} << order_[0])] += weight * x * slice[jk];
      }
    }
  }
  return sum;
}

void check_cells(const Geometry& geometry, const CubicGrid& grid, double smallest_fraction) {
  auto found = geometry.violations();
  if (!geometry.profile.empty() && !along_axes(grid)) {
    found.push_back({"lattice.rotation", "", "a profile cannot be cut by a turned grid",
                     "leave the lattice unturned, or take geometry.shape = \"dome\""});
  }
  if (!(smallest_fraction >= 0.0 && smallest_fraction < 1.0)) {
    found.push_back({"smallest_fraction", to_text(smallest_fraction),
                     "the smallest share of rubber of a kept cell must lie in [0, 1)",
                     "choose a small number such as 1e-6"});
  }
  if (!found.empty()) throw InvalidInput(found);
}

}  // namespace

std::vector<CutCell> cut_cells(const Geometry& geometry, const CubicGrid& grid,
                               double smallest_fraction) {
  check_cells(geometry, grid, smallest_fraction);
  if (geometry.solid) return solid_cells(*geometry.solid, grid, smallest_fraction);
  const std::array<double, 8> cube{1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125};
  const double reach = 0.5 * std::numbers::sqrt3 * grid.spacing;
  const double round_off = 1e-12;
  const Vector3 to_centre = 0.5 * grid.spacing * grid.axes.rowwise().sum();
  const Meridian meridian(geometry.corners());
  const bool along = along_axes(grid);
  std::vector<CutCell> cells;
  for (int k = 0; k + 1 < grid.size[2]; ++k) {
    for (int j = 0; j + 1 < grid.size[1]; ++j) {
      for (int i = 0; i + 1 < grid.size[0]; ++i) {
        const double distance =
            meridian.signed_distance(Vector3(grid.position(i, j, k) + to_centre));
        if (distance > reach) continue;
        CutCell cell{{i, j, k}, cube};
        if (distance > -reach) {
          auto moments = along ? revolved_moments(meridian, grid, i, j, k)
                               : Cell(geometry, grid, i, j, k).moments();
          if (moments[0] <= smallest_fraction) continue;
          for (std::size_t m = 0; m < moments.size(); ++m)
            moments[m] = std::clamp(moments[m], 0.0, cube[m]);  // but for round-off
          if (moments[0] < 1.0 - round_off) cell.moments = moments;
        }
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

}  // namespace fingertip::meshes::inline cells
