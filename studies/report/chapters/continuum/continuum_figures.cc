#include "studies/report/chapters/continuum/continuum_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "meshes/shape/geometry.h"

namespace fingertip::studies::report::inline chapters::inline continuum {
namespace {

constexpr std::size_t max_shown = 6;  ///< curves that a reader tells apart
constexpr int rings = 80;             ///< into which a contact is divided for drawing
constexpr int curve_points = 80;

/// The ends of a mesh edge in the units shown, undeformed or deformed.
struct SectionEdge {
  double x1, z1, x2, z2;
};

std::vector<SectionEdge> section_edges(const std::vector<fem_reference::SectionRow>& section,
                                       bool deformed) {
  std::vector<SectionEdge> edges;
  // Neighbouring elements both report the edge between them.
  std::set<std::array<long, 4>> seen;
  for (const fem_reference::SectionRow& row : section) {
    const auto& [x1, z1, x2, z2] = deformed ? row.deformed : row.undeformed;
    std::array<long, 2> first{std::lround(1e9 * x1), std::lround(1e9 * z1)};
    std::array<long, 2> second{std::lround(1e9 * x2), std::lround(1e9 * z2)};
    if (second < first) std::swap(first, second);
    if (!seen.insert({first[0], first[1], second[0], second[1]}).second) continue;
    edges.push_back({shown_units().length(x1), shown_units().length(z1), shown_units().length(x2),
                     shown_units().length(z2)});
  }
  return edges;
}

bool touches(const SectionEdge& edge, const Window& window) {
  return !(std::max(edge.x1, edge.x2) < window.x_from || std::min(edge.x1, edge.x2) > window.x_to ||
           std::max(edge.z1, edge.z2) < window.z_from || std::min(edge.z1, edge.z2) > window.z_to);
}

/// The nodes' pressures at one indentation.
struct PressureProfile {
  double depth;                          ///< [m]
  std::vector<double> radius, pressure;  ///< [m], [Pa]
};

std::vector<PressureProfile> pressure_profiles(const RunData& run) {
  std::vector<PressureProfile> profiles;
  for (const auto points : meshes::samples_of(run.reference_contact)) {
    const double depth = points.front().indentation;
    // At full depth others may follow, of a lateral motion.
    if (!profiles.empty() && same_depth(profiles.back().depth, depth)) continue;
    const meshes::Vector3 centre = meshes::centre_of_pressure(points);
    PressureProfile& profile = profiles.emplace_back(PressureProfile{depth, {}, {}});
    for (const meshes::ContactPoint& point : points) {
      profile.radius.push_back((point.place - centre).head<2>().norm());
      profile.pressure.push_back(point.normal_traction);
    }
  }
  return profiles;
}

/// A page cannot hold a dot per node of a fine mesh: of every ring those of the highest and of the
/// lowest pressure, so that peaks and scatter stay.
Series thinned(const PressureProfile& profile, const std::string& colour) {
  Series series{depth_label(profile.depth),
                depth_label(profile.depth) + " continuum",
                {colour, "", 2.0, 7, false, 0.32}};
  const double outermost = *std::max_element(profile.radius.begin(), profile.radius.end());
  std::map<int, std::pair<std::size_t, std::size_t>> extremes;
  for (std::size_t i = 0; i < profile.radius.size(); ++i) {
    const int ring = outermost > 0.0 ? int(rings * profile.radius[i] / outermost) : 0;
    const auto [found, fresh] = extremes.try_emplace(ring, i, i);
    if (fresh) continue;
    auto& [lowest, highest] = found->second;
    if (profile.pressure[i] < profile.pressure[lowest]) lowest = i;
    if (profile.pressure[i] > profile.pressure[highest]) highest = i;
  }
  for (const auto& [ring, pair] : extremes) {
    for (const std::size_t i : std::set<std::size_t>{pair.first, pair.second}) {
      series.add(shown_units().length(profile.radius[i]),
                 shown_units().stress(profile.pressure[i]));
    }
  }
  return series;
}

Series hertz_series(const fem_reference::analytic::Hertz& hertz, double depth,
                    const std::string& colour) {
  Series series{"", depth_label(depth) + " Hertz", {colour, "(7,4)", 1.3}};
  const double a = hertz.contact_radius(depth);
  for (int i = 0; i <= curve_points; ++i) {
    // Denser towards the edge, where the curve is steep.
    const double r = i == curve_points ? a : a * std::sin(std::acos(-1.0) / 2 * i / curve_points);
    series.add(shown_units().length(r), shown_units().stress(hertz.pressure(r, depth)));
  }
  return series;
}

Panel section_panel(const std::string& title) {
  return {.title = title,
          .x_label = shown_units().length.label("x"),
          .y_label = shown_units().length.label("z"),
          .equal_scales = true,
          .key = ""};
}

/// Everything, at first touch.
Panel whole_section(const RunData& run) {
  Panel panel = section_panel("the whole section, at first touch");
  panel.series.push_back(section_series(run, false, thin("#333333", 0.5)));
  const double plane = first_touch(run).plane;
  double width = 0.0;
  Range z{1e9, plane};  // a ball beside the axis tops out below the pole
  for (const double x : panel.series[0].x) width = std::fmax(width, std::abs(x));
  for (const double height : panel.series[0].y) z.include(height);
  panel.x_range = Range{-1.15 * width, 1.15 * width};
  // Pole down.
  panel.y_range = Range{z.to + 0.1 * width, z.from - 0.1 * width};
  panel.series.push_back(obstacle_series(run, *panel.x_range, plane));
  return panel;
}

/// The contact, pressed to the end.
Panel contact_section(const RunData& run) {
  Panel panel = section_panel("near the contact, pressed");
  const double a = shown_units().length(run.reference.samples().back().contact_radius);
  const FirstTouch touch = first_touch(run);
  const double plane = touch.plane - shown_units().length(run.reference.depth());
  const bool half = is_half_section(run);
  // A mirrored picture shows nothing new: one half, twice as large.
  const double centre = obstacle_of(run).on_axis() ? 0.0 : touch.x;
  const double from = half ? -0.05 * a : centre - 1.6 * a, to = centre + 1.6 * a,
               height = 0.95 * (to - from);
  panel.x_range = Range{from, to};
  const Series obstacle = obstacle_series(run, *panel.x_range, plane);
  // What touches is to be seen, and rubber.
  double lowest = plane;
  for (std::size_t i = 0; i < obstacle.x.size(); ++i)
    if (std::abs(obstacle.x[i] - centre) < 1.2 * a)
      lowest = std::clamp(obstacle.y[i], lowest, plane + 0.4 * height);
  panel.y_range = Range{lowest + 0.06 * height, lowest - 0.94 * height};
  panel.series.push_back(section_series(run, true, thin("#333333", 0.6),
                                        {from, to, lowest - 0.94 * height, meshes::unknown}));
  panel.series.push_back(obstacle);
  if (obstacle_of(run).on_axis()) panel.markers.push_back({a, "#D55E00"});
  return panel;
}

}  // namespace

void add_segment(Series& series, double x1, double z1, double x2, double z2) {
  series.add(x1, z1);
  series.add(x2, z2);
  series.add(meshes::unknown, meshes::unknown);
}

Style thin(const std::string& colour, double width) {
  return {colour, "", width, 0};
}

bool is_half_section(const RunData& run) {
  return std::ranges::none_of(run.section, [](const fem_reference::SectionRow& row) {
    return row.undeformed.front() < -1e-8;
  });
}

Series section_series(const RunData& run, bool deformed, const Style& style, const Window& window) {
  Series series{"", deformed ? "mesh deformed" : "mesh undeformed", style};
  const bool mirror = is_half_section(run);
  for (const SectionEdge& edge : section_edges(run.section, deformed)) {
    const SectionEdge mirrored{-edge.x1, edge.z1, -edge.x2, edge.z2};
    if (touches(edge, window)) add_segment(series, edge.x1, edge.z1, edge.x2, edge.z2);
    if (mirror && touches(mirrored, window))
      add_segment(series, mirrored.x1, mirrored.z1, mirrored.x2, mirrored.z2);
  }
  return series;
}

bool same_depth(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::max(a, b);
}

std::string depth_label(double depth) {
  return shown_units().length.text(depth);
}

std::vector<double> shown_depths(const RunData& run, const std::vector<double>& computed) {
  const auto among = [](const std::vector<double>& depths, double depth) {
    return std::any_of(depths.begin(), depths.end(),
                       [depth](double other) { return same_depth(depth, other); });
  };
  std::vector<double> wanted = run.depths;
  const bool of_verdict = std::any_of(computed.begin(), computed.end(),
                                      [&](double depth) { return among(wanted, depth); });
  if (!of_verdict || wanted.size() > max_shown) {
    const std::size_t count = std::min(max_shown, computed.size());
    wanted.clear();
    for (std::size_t i = 0; i < count; ++i)
      wanted.push_back(computed[count > 1 ? i * (computed.size() - 1) / (count - 1) : 0]);
  }
  double worst = 0.0;
  for (const meshes::PressSample& sample : run.reference.pressing())
    worst = std::fmax(worst, sample.force_error / sample.normal_force);
  for (const meshes::PressSample& sample : run.reference.pressing())
    if (worst > 0.0 && sample.force_error / sample.normal_force == worst)
      wanted.push_back(sample.indentation);
  std::vector<double> shown;
  std::copy_if(computed.begin(), computed.end(), std::back_inserter(shown),
               [&](double depth) { return among(wanted, depth); });
  return shown;
}

meshes::Obstacle obstacle_of(const ObstacleEntry& entry) {
  meshes::Obstacle obstacle;
  for (const auto shape : values(meshes::ObstacleShape()))
    if (name(shape) == entry.shape) obstacle.shape = shape;
  for (const auto axis : values(meshes::ObstacleAxis()))
    if (name(axis) == entry.along) obstacle.along = axis;
  if (std::isfinite(entry.radius)) obstacle.radius = entry.radius;
  if (std::isfinite(entry.offset)) obstacle.offset = entry.offset;
  return obstacle;
}

meshes::Obstacle obstacle_of(const RunData& run) {
  const JsonEntry told = object_if_any(object_if_any(run.reference_job, "protocol"), "obstacle");
  if (!told.empty())
    return obstacle_of(ObstacleEntry{text_if_any(told, "shape"), number_if_any(told, "radius"),
                                     text_if_any(told, "along"), number_if_any(told, "offset")});
  for (const ModelData& model : run.models)
    if (model.summary.obstacle) return obstacle_of(*model.summary.obstacle);
  return {};
}

FirstTouch first_touch(const RunData& run) {
  const meshes::Obstacle obstacle = obstacle_of(run);
  FirstTouch first;
  const auto touch = [&](const meshes::Vector3& at) {
    const double plane = shown_units().length(at.z() + height(obstacle, at));
    if (plane > first.plane) first = {shown_units().length(at.x()), plane};
  };
  const bool mirror = is_half_section(run);
  for (const fem_reference::SectionRow& row : run.section) {
    const auto& [x1, z1, x2, z2] = row.undeformed;
    for (const auto& [x, z] : {std::pair(x1, z1), std::pair(x2, z2)}) {
      touch({x, 0.0, z});
      if (mirror) touch({-x, 0.0, z});
    }
  }
  if (run.section.empty())
    for (const ModelData& model : run.models)
      for (const BoundaryRow& row : model.boundary) touch(row.rest);
  return first;
}

Series obstacle_series(const RunData& run, const Range& x, double plane) {
  const meshes::Obstacle obstacle = obstacle_of(run);
  const bool ends = obstacle.shape == meshes::ObstacleShape::sphere ||
                    (obstacle.shape == meshes::ObstacleShape::cylinder && !obstacle.along_x());
  Series series{"", std::string(name(obstacle.shape)), {"#333333", "", 2.4}};
  const double one = shown_units().length(1.0);
  double from = x.from / one, to = x.to / one;
  if (ends) {
    from = std::max(from, obstacle.offset - obstacle.radius);
    to = std::min(to, obstacle.offset + obstacle.radius);
  }
  const int steps = obstacle.is_plane() ? 1 : 4 * curve_points;
  for (int i = 0; i <= steps && from < to; ++i) {
    // Denser towards the ends, where a ball is steep.
    const double at = from + 0.5 * (to - from) * (1.0 - std::cos(std::acos(-1.0) * i / steps));
    series.add(shown_units().length(at),
               plane - shown_units().length(height(obstacle, {at, 0.0, 0.0})));
  }
  return series;
}

double tip_radius(const RunData& run) {
  if (run.reference_job.empty()) return meshes::unknown;
  // What a job leaves out has its default.
  const double radius = number_if_any(object_if_any(run.reference_job, "geometry"), "tip_radius");
  return std::isfinite(radius) ? radius : meshes::Geometry{}.tip_radius;
}

std::optional<fem_reference::analytic::Hertz> hertz_contact(const RunData& run) {
  double radius = tip_radius(run);
  const meshes::Obstacle obstacle = obstacle_of(run);
  if (!obstacle.on_axis()) return std::nullopt;
  if (!obstacle.is_plane()) radius = 1.0 / (1.0 / radius + 1.0 / obstacle.radius);
  meshes::Rubber rubber;
  const JsonEntry given = object_if_any(run.reference_job, "rubber");
  for (const auto& [key, value] : {std::pair{"youngs_modulus", &rubber.youngs_modulus},
                                   std::pair{"shear_modulus", &rubber.shear_modulus}}) {
    if (std::isfinite(number_if_any(given, key))) *value = number_if_any(given, key);
  }
  // Of a profile the radius at the pole is not told.
  const bool dome = !object_if_any(run.reference_job, "geometry").contains("profile");
  if (!dome || !(radius > 0.0) || !rubber.violations().empty()) return std::nullopt;
  return fem_reference::analytic::Hertz(rubber, radius);
}

Figure mesh_figure(const RunData& run) {
  return {"adaptive_mesh", 900, 460, 2, {whole_section(run), contact_section(run)}};
}

Figure pressure_figure(const RunData& run) {
  Panel panel{.x_label = shown_units().length.label("radius"),
              .y_label = shown_units().stress.label("contact pressure"),
              .y_range = Range{0.0},
              .key = "outside right top"};
  const std::vector<PressureProfile> profiles = pressure_profiles(run);
  std::vector<double> computed;
  for (const PressureProfile& profile : profiles) computed.push_back(profile.depth);
  const std::vector<double> shown = shown_depths(run, computed);
  const auto hertz = hertz_contact(run);
  std::vector<Series> dots;
  for (const PressureProfile& profile : profiles) {
    const auto found = std::ranges::find(shown, profile.depth);
    if (found == shown.end()) continue;
    const std::string colour = depth_shade(std::size_t(found - shown.begin()), shown.size());
    if (hertz) panel.series.push_back(hertz_series(*hertz, profile.depth, colour));
    dots.push_back(thinned(profile, colour));
  }
  panel.series.insert(panel.series.end(), dots.begin(), dots.end());
  if (hertz) panel.series.push_back(legend_entry("Hertz", {"#555555", "(7,4)", 1.3}));
  return {"pressure", 760, 430, 1, {panel}};
}

}  // namespace fingertip::studies::report::inline chapters::inline continuum
