/// Pressure and shear in the contact, run beside run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "meshes/press/limit_surface.h"
#include "studies/report/chapters/press/press_chapters.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using meshes::ContactDifference;
using meshes::ContactMap;

/// Runs beside the first one that a figure has room for.
constexpr std::size_t max_maps = 3;

/// A quantity of a map along t1, in the middle.
Series section_of(const RunContact& run, const ContactMap& map, Eigen::ArrayXXd ContactMap::*of) {
  Series series{run.label, "", run.style.as_line()};
  const Eigen::Index middle = map.raster.count / 2;
  for (Eigen::Index i = 0; i < map.raster.count; ++i)
    series.add(shown_units().length(map.raster.x(i)),
               map.touches(i, middle) > 0.0 ? shown_units().stress((map.*of)(i, middle))
                                            : meshes::unknown);
  return series;
}

bool is_sheared(const ContactMap& map) {
  return map.shear_x.size() > 0 &&
         (map.shear_x.abs() + map.shear_y.abs()).maxCoeff() > 1e-6 * map.pressure.maxCoeff();
}

/// What a run tells of its pressures' error at a depth [Pa]; unknown where it tells none.
double told_error(const RunContact& run, double depth) {
  for (const meshes::PressSample& sample : run.response->pressing())
    if (std::abs(sample.indentation - depth) <= 1e-9) return sample.pressure_error;
  return meshes::unknown;
}

/// The area between a pressure's limits; nothing where no error is told.
Series error_band(const Series& pressure, double error) {
  Series band{"", pressure.label + " error", pressure.style};
  band.filled = true;
  const double bar = shown_units().stress(error);
  const auto add = [&](std::size_t i, double off) {
    const double value = pressure.y[i] + off;
    if (!std::isnan(value)) band.add(pressure.x[i], std::max(value, 0.0));
  };
  for (std::size_t i = 0; i < pressure.x.size(); ++i) add(i, bar);
  for (std::size_t i = pressure.x.size(); i-- > 0;) add(i, -bar);
  return band;
}

Figure section_figure(const std::vector<RunContact>& runs, const ContactsAtDepth& contacts) {
  const std::vector<ContactMap>& maps = contacts.maps;
  const ShownUnit &length = shown_units().length, &stress = shown_units().stress;
  const auto panel = [&](const char* what, Eigen::ArrayXXd ContactMap::*of) {
    Panel made{.x_label = length.label("along t1"),
               .y_label = stress.label(what),
               .key = runs.size() > 1 ? above : ""};
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (maps[i].pressure.size() > 0) made.series.push_back(section_of(runs[i], maps[i], of));
    return made;
  };
  const auto with_bands = [&](Panel made) {
    std::vector<Series> bands;
    for (std::size_t i = 0, line = 0; i < runs.size(); ++i) {
      if (maps[i].pressure.size() == 0) continue;
      Series band = error_band(made.series[line++], told_error(runs[i], contacts.depth));
      if (!band.x.empty()) bands.push_back(std::move(band));
    }
    made.series.insert(made.series.begin(), bands.begin(), bands.end());
    return made;
  };
  Figure figure{
      "contact_section", 760, 380, 1, {with_bands(panel("pressure", &ContactMap::pressure))}};
  figure.panels.front().y_range = Range{0.0};
  if (!std::ranges::any_of(maps, is_sheared)) return figure;
  figure.panels.push_back(panel("shear along t1", &ContactMap::shear_x));
  figure.panels.back().key = "";
  figure.height = 620;
  return figure;
}

/// Of a contact's places a value each, in the colours of `range`.
Panel map_panel(const std::string& title, const ContactMap& map, const Eigen::ArrayXXd& values,
                const Eigen::ArrayXXd& shown, const Range& range, const std::string& label) {
  const ShownUnit& length = shown_units().length;
  Panel panel{.title = title,
              .x_label = length.label("along t1"),
              .y_label = length.label("along t2"),
              .equal_scales = true,
              .key = ""};
  HeatMap colours{{}, range, label, range.from < 0.0};
  for (Eigen::Index i = 0; i < map.raster.count; ++i) {
    colours.function.x.push_back(length(map.raster.x(i)));
    colours.function.y.push_back(length(map.raster.y(i)));
    auto& row = colours.function.values.emplace_back();
    for (Eigen::Index j = 0; j < map.raster.count; ++j)
      row.push_back(shown(i, j) > 0.0 ? values(i, j) : meshes::unknown);
  }
  panel.x_range = Range{colours.function.x.front(), colours.function.x.back()};
  panel.y_range = Range{colours.function.y.front(), colours.function.y.back()};
  panel.map = std::move(colours);
  return panel;
}

Panel stress_panel(const std::string& title, const ContactMap& map, const Eigen::ArrayXXd& stress,
                   double highest, const char* what) {
  const ShownUnit& unit = shown_units().stress;
  return map_panel(title, map, stress.unaryExpr([&](double value) { return unit(value); }),
                   map.touches, {0.0, unit(highest)}, unit.label(what));
}

Panel difference_panel(const ContactMap& map, const ContactMap& first) {
  const Eigen::ArrayXXd off = 100.0 * (map.pressure - first.pressure) / first.pressure.maxCoeff();
  const double largest = std::max(off.abs().maxCoeff(), 0.1);
  return map_panel("difference", map, off, map.touches + first.touches, {-largest, largest},
                   "% of the largest");
}

Figure map_figure(const std::vector<RunContact>& runs, const std::vector<ContactMap>& maps) {
  const ContactMap& first = maps.front();
  double highest = 0.0;
  for (const ContactMap& map : maps)
    if (map.pressure.size() > 0) highest = std::max(highest, map.pressure.maxCoeff());
  Figure figure{"contact_maps", 1220, 0, 3, {}, 110};
  if (runs.size() == 1) {
    figure.columns = 1;
    figure.width = 560;
    figure.panels = {stress_panel("", first, first.pressure, highest, "pressure")};
    figure.right_margin = 130;
    if (is_sheared(first)) {
      const Eigen::ArrayXXd shear = (first.shear_x.square() + first.shear_y.square()).sqrt();
      figure.columns = 2;
      figure.width = 960;
      figure.panels.front().title = "pressure";
      figure.panels.push_back(
          stress_panel("shear", first, shear, shear.maxCoeff(), "shear, its magnitude"));
    }
  }
  for (std::size_t i = 1; i < runs.size() && figure.panels.size() < 3 * max_maps; ++i) {
    if (maps[i].pressure.size() == 0) continue;
    figure.panels.push_back(
        stress_panel(runs.front().label, first, first.pressure, highest, "pressure"));
    figure.panels.push_back(
        stress_panel(runs[i].label, maps[i], maps[i].pressure, highest, "pressure"));
    figure.panels.push_back(difference_panel(maps[i], first));
  }
  const int rows = (int(figure.panels.size()) + figure.columns - 1) / figure.columns;
  figure.height = 60 + 330 * rows;
  return figure;
}

bool is_held(std::span<const meshes::ContactPoint> field) {
  return std::ranges::any_of(field, [](const meshes::ContactPoint& point) {
    return point.state == meshes::ContactState::stick || !point.shear.isZero(0.0);
  });
}

/// Moment over force at which the contacts slide as a whole, per unit of friction and of N, and of
/// N a; the ellipse of the first.
Figure limit_figure(const std::vector<RunContact>& runs, const ContactsAtDepth& contacts) {
  Panel panel{.x_label = "force/(μ N)",
              .y_label = "moment/(μ N a)",
              .x_range = Range{0.0, 1.05},
              .y_range = Range{0.0},
              .key = "outside right top"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const meshes::LimitSurface surface = limit_surface(contacts.fields[i]);
    if (surface.points.empty()) continue;
    const double arm = surface.normal_force * surface.radius;
    if (panel.series.empty()) {
      Series ellipse{"ellipse", "", {"#999999", "(2,3)", 1.5}};
      constexpr int steps = 60;
      for (int s = 0; s <= steps; ++s) {
        const double angle = 0.5 * std::acos(-1.0) * s / steps;
        ellipse.add(std::cos(angle), surface.moment_share() * std::sin(angle));
      }
      panel.series.push_back(std::move(ellipse));
    }
    Series series{runs[i].label.empty() ? "its pressure" : runs[i].label, "",
                  runs[i].style.as_line()};
    for (const meshes::LimitPoint& point : surface.points)
      series.add(point.force / surface.normal_force, point.moment / arm);
    panel.series.push_back(std::move(series));
  }
  return {"limit_surface", 760, 380, 1, {std::move(panel)}};
}

/// A pressure's difference, the error that the run tells of it, and the others beneath it.
Cell difference_cell(const ContactDifference& d, double told) {
  if (std::isnan(d.pressure_l2)) return {};
  std::string note = fmt::format("largest {}, radius {}", percent(d.peak), percent(d.radius));
  if (!std::isnan(told)) note.insert(0, fmt::format("told {}, ", percent_magnitude(told)));
  if (d.shear_l2 > 0.0) note.insert(0, fmt::format("shear {}, ", percent_magnitude(d.shear_l2)));
  return {percent_magnitude(d.pressure_l2), note};
}

Table contact_table(const ContactComparison& contacts) {
  Table table{heads({"Indentation\n" + unit_name(shown_units().length)})};
  for (std::size_t i = 1; i < contacts.runs.size(); ++i)
    table.header.emplace_back(contacts.runs[i].label);
  for (const ContactsAtDepth& here : contacts.depths) {
    auto& row = table.rows.emplace_back();
    row.push_back(fmt::format("{:.4g}", shown_units().length(here.depth)));
    for (std::size_t i = 1; i < contacts.runs.size(); ++i)
      row.push_back(difference_cell(here.difference(i), told_error(contacts.runs[i], here.depth) /
                                                            here.maps.front().pressure.maxCoeff()));
  }
  return table;
}

}  // namespace

Chapter written_of(ChapterData chapter, const std::string& name, std::size_t number) {
  const std::string prefix = name.empty() ? "" : fmt::format("press{}_", number);
  chapter["prefix"] = prefix;
  chapter["name"] = name;
  chapter.id.insert(0, prefix);
  for (Figure& figure : chapter.figures) figure.name.insert(0, prefix);
  std::map<std::string, Table> tables;
  for (auto& [id, table] : chapter.tables) tables[prefix + id] = std::move(table);
  chapter.tables = std::move(tables);
  return written(std::move(chapter));
}

Chapter contact_chapter(const ContactComparison& contacts, const std::string& name,
                        std::size_t number) {
  if (contacts.depths.empty()) return {};
  const std::vector<RunContact>& runs = contacts.runs;
  const ContactsAtDepth& deepest = contacts.depths.back();
  if (!(deepest.maps.front().pressure.maxCoeff() > 0.0)) return {};  // points in a line
  ChapterData chapter("contact");
  chapter["compared"] = runs.size() > 1;
  chapter["first"] = runs.front().label;
  chapter["depth"] = length(deepest.depth);
  chapter.figures = {section_figure(runs, deepest), map_figure(runs, deepest.maps)};
  const auto& first = deepest.fields.front();
  const meshes::LimitSurface held = limit_surface(first);
  chapter["moment"] = shown_units().torque.text(held.greatest_moment);
  chapter["share"] = fmt::format("{:.3f}", held.moment_share());
  chapter["ellipse"] = percent_magnitude(held.ellipse_error);
  if (is_held(first) && !held.points.empty())
    chapter.figures.push_back(limit_figure(runs, deepest));
  if (!name.empty()) append_motions(runs, "motion_lateral", "motion_twist", chapter.figures);
  if (runs.size() > 1) chapter.tables["contact"] = contact_table(contacts);
  return written_of(std::move(chapter), name, number);
}

Chapter contact_chapter(const RunData& run) {
  std::vector<RunContact> runs{
      {model_label("reference"), model_style("reference"), &run.reference, &run.reference_contact}};
  for (const ModelData& model : run.models)
    runs.push_back(
        {model_label(model.name), model_style(model.name), &model.response, &model.contact});
  return contact_chapter(compared_contacts(std::move(runs)));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
