/// Pictures of the finger at a few moments of a press, like Fig. 6 of the paper.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshes/press/fields.h"
#include "meshes/press/obstacle.h"
#include "meshes/shape/geometry.h"
#include "studies/report/chapters/continuum/continuum_figures.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using meshes::Vector3;

constexpr const char* force_colour = "#D55E00";
constexpr const char* torque_colour = "#0072B2";
constexpr const char* held_colour = "#CC79A7";

/// Parallel projection: the plane below, seen from somewhat above it and from the side.
class Camera {
 public:
  /// `up`: the plane's normal, toward the rod, at the start.
  explicit Camera(const Vector3& up) {
    const double elevation = 14.0 / degree_per_radian, azimuth = 25.0 / degree_per_radian;
    const Vector3 t1 = (Vector3::UnitX() - up * up.x()).normalized(), t2 = up.cross(t1);
    right_ = std::cos(azimuth) * t1 + std::sin(azimuth) * t2;
    const Vector3 ahead = up.cross(right_);
    toward_ = -std::cos(elevation) * ahead + std::sin(elevation) * up;
    above_ = std::sin(elevation) * ahead + std::cos(elevation) * up;
  }

  double x(const Vector3& place) const { return shown_units().length(place.dot(right_)); }
  double y(const Vector3& place) const { return shown_units().length(place.dot(above_)); }
  /// Whether a surface with this outer normal can be seen.
  bool faces(const Vector3& normal) const { return normal.dot(toward_) > 0.0; }
  /// Toward the viewer.
  const Vector3& toward() const { return toward_; }

 private:
  Vector3 right_, above_, toward_;
};

/// A snapshot as the files tell it.
struct Snapshot : SnapshotRow {
  Eigen::AngleAxisd turned;
  std::vector<Vector3> points;
  std::vector<bool> held;
};

std::vector<Snapshot> snapshots_of(const MovingPress& press) {
  std::vector<Snapshot> result;
  for (const SnapshotRow& row : press.snapshots) {
    const double angle = row.turn.norm();
    const Vector3 axis = angle > 0.0 ? Vector3(row.turn / angle) : Vector3::UnitZ();
    result.push_back({row, Eigen::AngleAxisd(angle, axis), {}, {}});
  }
  for (const SnapshotPointRow& point : press.snapshot_points) {
    result[point.snapshot].points.push_back(point.place);
    result[point.snapshot].held.push_back(point.held);
  }
  return result;
}

/// Where the outer surface faces, of a place at rest on it; roughly, of another shape than the
/// dome: from the axis below `centre`, away from it above.
Vector3 outer_normal(const Vector3& rest, double centre) {
  return Vector3(rest.x(), rest.y(), std::max(rest.z() - centre, 0.0)).normalized();
}

class Drawing {
 public:
  Drawing(const MovingPress& press, const Snapshot& first, double largest_force,
          double largest_torque)
      : camera_(first.normal),
        shape_(press.summary.geometry),
        largest_force_(largest_force),
        largest_torque_(largest_torque),
        springs_(press.boundary_springs) {
    Range height;
    for (const BoundaryRow& row : press.boundary) {
      rest_.push_back(row.rest);
      height.include(row.rest.z());
    }
    arrow_ = 1.2 * std::fmin(shape_.tip_radius, height.to - height.from);
    if (press.summary.obstacle) obstacle_ = obstacle_of(*press.summary.obstacle);
    if (!shape_.is_dome()) centre_ = height.to - shape_.tip_radius;
  }

  Panel panel(const Snapshot& snapshot) const {
    Panel panel{.title = snapshot.moment, .bare = true, .equal_scales = true, .key = ""};
    if (std::isfinite(snapshot.time)) panel.title += fmt::format(", {:.4g} s", snapshot.time);
    add_plane(panel, snapshot);
    if (shape_.is_dome()) add_rod(panel, snapshot);
    add_tip(panel, snapshot);
    add_arrow(panel, snapshot, snapshot.force, largest_force_, force_colour, "force");
    add_arrow(panel, snapshot, snapshot.torque, largest_torque_, torque_colour, "torque");
    return panel;
  }

 private:
  void join(Series& series, const Vector3& from, const Vector3& to) const {
    add_segment(series, camera_.x(from), camera_.y(from), camera_.x(to), camera_.y(to));
  }
  void add(Series& series, const Vector3& place) const {
    series.add(camera_.x(place), camera_.y(place));
  }

  void add_plane(Panel& panel, const Snapshot& snapshot) const {
    Series square{"", "plane", thin("#999999", 1.0)};
    const Vector3& n = snapshot.normal;
    const Vector3 t1 = (Vector3::UnitX() - n * n.x()).normalized();
    const Eigen::Matrix3d axes = (Eigen::Matrix3d() << t1, t1.cross(n), n).finished();
    const auto mesh = meshes::obstacle_mesh(obstacle_, 1.5 * shape_.tip_radius);
    const auto place = [&](std::size_t point) -> Vector3 {
      return snapshot.plane + axes * mesh.points[point];
    };
    if (!obstacle_.is_plane()) {  // as a net of lines
      square.key = name(obstacle_.shape);
      square.style = thin("#999999", 0.6);
      for (const auto& [a, b, c, d] : mesh.quadrangles) {
        join(square, place(a), place(b));
        join(square, place(b), place(c));
        join(square, place(c), place(d));
        join(square, place(d), place(a));
      }
      panel.series.push_back(std::move(square));
      return;
    }
    for (const std::size_t corner : {0U, 1U, 3U, 2U, 0U}) add(square, place(corner));
    Series area = square;
    area.filled = true;
    panel.series.push_back(std::move(area));
    panel.series.push_back(std::move(square));
  }

  /// A ring of the rod (as it lies in the finger's frame), its part on the viewer's side or all.
  void add_ring(Series& series, const Snapshot& snapshot, double height, bool front_only) const {
    constexpr int steps = 72;
    for (int k = 0; k < steps; ++k) {
      const auto at = [&](int step) {
        const double angle = 2.0 * std::numbers::pi * step / steps;
        return Vector3(shape_.rod_radius * std::cos(angle), shape_.rod_radius * std::sin(angle), 0);
      };
      const Vector3 from = at(k), to = at(k + 1), up(0.0, 0.0, height);
      if (front_only && !camera_.faces(snapshot.turned * (from + to))) continue;
      join(series, placed(snapshot, from + up), placed(snapshot, to + up));
    }
  }

  Vector3 placed(const Snapshot& snapshot, const Vector3& in_rod) const {
    return snapshot.endpoint + snapshot.turned * (in_rod + Vector3(0.0, 0.0, shape_.rod_length));
  }

  /// Outside of the sleeve the rod's outline is solid, inside it is dashed.
  void add_rod(Panel& panel, const Snapshot& snapshot) const {
    Series seen{"", "rod", {"#222222", "", 1.6}};
    Series hidden{"", "rod inside the tip", {"#222222", "(5,4)", 1.0}};
    const double top = -shape_.rod_length, rim = -shape_.sleeve_length;
    const Vector3 axis = snapshot.turned * Vector3::UnitZ();
    const Vector3 side = snapshot.turned.inverse() *
                         Vector3(shape_.rod_radius * axis.cross(camera_.toward()).normalized());
    add_ring(seen, snapshot, top, false);
    add_ring(seen, snapshot, rim, true);
    for (const double sign : {-1.0, 1.0}) {
      const auto at = [&](double z) { return placed(snapshot, sign * side + Vector3(0, 0, z)); };
      join(seen, at(top), at(rim));
      join(hidden, at(rim), at(0.0));
    }
    add_dome(hidden, snapshot);
    panel.series.push_back(std::move(hidden));
    panel.series.push_back(std::move(seen));
  }

  /// The outline of the rod's hemisphere: half of the circle that faces the viewer.
  void add_dome(Series& series, const Snapshot& snapshot) const {
    const Vector3 axis = snapshot.turned * Vector3::UnitZ();
    const Vector3 side = axis.cross(camera_.toward()).normalized();
    const Vector3 below = camera_.toward().cross(side).normalized();
    const double sign = below.dot(axis) > 0.0 ? 1.0 : -1.0;
    const Vector3 centre = placed(snapshot, Vector3::Zero());
    for (int k = 0; k <= 36; ++k) {
      const double angle = std::numbers::pi * k / 36.0;
      add(series,
          centre + shape_.rod_radius * (std::cos(angle) * side + sign * std::sin(angle) * below));
    }
  }

  /// Springs on the viewer's side, and what the obstacle holds, which lies at the back of the tip.
  void add_tip(Panel& panel, const Snapshot& snapshot) const {
    Series springs{"", "springs", thin("#3f7f6f", 0.6)};
    const auto visible = [&](std::size_t i) {
      return camera_.faces(snapshot.turned * outer_normal(rest_[i], centre_));
    };
    const std::size_t count = std::min(rest_.size(), snapshot.points.size());
    for (const auto& [i, j] : springs_) {
      if (i >= count || j >= count || !visible(i) || !visible(j)) continue;
      join(springs, snapshot.points[i], snapshot.points[j]);
    }
    Series held{"", "held by the obstacle", {held_colour, "", 1.0, 7, false, 0.3}};
    for (std::size_t i = 0; i < count; ++i)
      if (snapshot.held[i]) add(held, snapshot.points[i]);
    panel.series.push_back(std::move(springs));
    panel.series.push_back(std::move(held));
  }

  /// An arrow from the endpoint, the largest of the press as long as the tip's radius or, of a flat
  /// pad, as its height, and what it stands for. A vector that is round-off has none.
  void add_arrow(Panel& panel, const Snapshot& snapshot, const Vector3& vector, double largest,
                 const std::string& colour, const std::string& name) const {
    const bool force = name == "force";
    if (!(largest > 0.0 && vector.norm() > 1e-3 * largest)) return;
    const Vector3 end = snapshot.endpoint + arrow_ / largest * vector;
    Series shaft{"", name, {colour, "", 2.4}};
    add(shaft, snapshot.endpoint);
    add(shaft, end);
    panel.arrows.push_back({shaft.x[0], shaft.y[0], shaft.x[1], shaft.y[1], colour, !force});
    panel.series.push_back(std::move(shaft));
  }

  Camera camera_;
  GeometryEntry shape_;
  meshes::Obstacle obstacle_;
  double largest_force_, largest_torque_;
  std::vector<Vector3> rest_;
  double arrow_ = 0.0;   ///< length of the longest [m]
  double centre_ = 0.0;  ///< of the outer surface, on the axis [m]
  std::vector<BoundarySpringRow> springs_;
};

/// The values at the endpoint, below the picture.
std::string wrench_text(const Snapshot& snapshot, double largest_torque) {
  const ShownUnits& units = shown_units();
  const double torque = largest_torque > 0.0 ? snapshot.torque.norm() : 0.0;
  return fmt::format("{} {}, force {}, torque {}",
                     units.length.text(std::abs(snapshot.indentation)),
                     snapshot.indentation < 0.0 ? "away" : "deep",
                     units.force.text(snapshot.force.norm()), units.torque.text(torque));
}

/// The same part of space for all panels.
void frame(Figure& figure) {
  Range x, y;
  for (const Panel& panel : figure.panels)
    for (const Series& series : panel.series) {
      for (const double value : series.x) x.include(value);
      for (const double value : series.y) y.include(value);
    }
  const double padding = 0.05 * (y.to - y.from);
  for (Panel& panel : figure.panels) {
    panel.x_range = Range{x.from - padding, x.to + padding};
    panel.y_range = Range{y.from - 3.0 * padding, y.to + padding};
    panel.texts.front().x = 0.5 * (x.from + x.to);
    panel.texts.front().y = y.from - 1.5 * padding;
  }
}

void add_snapshots(const MovingPress& press, WordList& words, std::vector<Figure>& figures) {
  const std::vector<Snapshot> snapshots = snapshots_of(press);
  double largest_force = 0.0, largest_torque = 0.0;
  for (const Snapshot& snapshot : snapshots) {
    largest_force = std::max(largest_force, snapshot.force.norm());
    largest_torque = std::max(largest_torque, snapshot.torque.norm());
  }
  // Of a straight press there is nothing but round-off and what grid and solver leave: a torque
  // whose lever is a thousandth of the radius at most tells nothing.
  const double lever = 1e-3 * press.summary.geometry.tip_radius;
  if (!(largest_torque > lever * largest_force)) largest_torque = 0.0;
  const Drawing drawing(press, snapshots.front(), largest_force, largest_torque);
  Figure figure{fmt::format("snapshots_{}", figures.size() + 1), 900, 860, 2, {}};
  for (const Snapshot& snapshot : snapshots) {
    figure.panels.push_back(drawing.panel(snapshot));
    figure.panels.back().texts.push_back({0.0, 0.0, wrench_text(snapshot, largest_torque)});
  }
  frame(figure);
  words.emplace_back()["figure"] = figure.name;
  words.back()["label"] = press.label;
  words.back()["torque"] = largest_torque > 0.0;
  figures.push_back(std::move(figure));
}

}  // namespace

Chapter snapshots_chapter(const std::vector<MovingPress>& presses) {
  ChapterData chapter("snapshots");
  WordList words;
  for (const MovingPress& press : presses) {
    const bool complete = !press.snapshots.empty() && !press.snapshot_points.empty() &&
                          !press.boundary.empty() &&
                          std::isfinite(press.summary.geometry.rod_length);
    if (press.pictured && complete) add_snapshots(press, words, chapter.figures);
  }
  chapter["presses"] = std::move(words);
  return written(std::move(chapter));
}

Chapter snapshots_chapter(const RunData& run) {
  return snapshots_chapter(presses_of_models(run));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
