/// Where markers go.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "studies/report/chapters/press/press_chapters.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using meshes::MarkerLengths;
using meshes::MarkerRow;
using meshes::Vector3;

constexpr int most_across = 24;            ///< arrows that a reader can tell apart
constexpr double longest_arrow = 0.12;     ///< over the width of what is shown
constexpr double least_arrow = 0.02;       ///< over the longest one: below, a dot says it
constexpr double room_around = 0.06;       ///< around markers, over the width
constexpr double flattest = 0.45;          ///< height of what is shown, over its width
constexpr std::size_t enough_aside = 5;    ///< markers in the plane that is seen from the side
constexpr std::size_t nearest_aside = 30;  ///< else so many, the nearest to it

/// Two axes of the finger, and what lies before them.
struct View {
  const char* x_label;
  const char* y_label;
  int x, y;
};
constexpr View along_rod{"x", "y", 0, 1}, from_side{"x", "z", 0, 2};

/// As far apart as can be told: of each square of a raster about the axis the marker nearest to its
/// middle.
std::vector<std::size_t> spread(MarkerField rows, const View& view) {
  double reach = 0.0;
  for (const MarkerRow& row : rows)
    reach = std::max({reach, std::abs(row.place[view.x]), std::abs(row.place[view.y])});
  const double square = std::max(2.0 * reach / most_across, 1e-12);
  std::map<std::pair<long, long>, std::pair<double, std::size_t>> nearest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double x = rows[i].place[view.x] / square, y = rows[i].place[view.y] / square;
    const double off = std::hypot(x - std::round(x), y - std::round(y));
    const auto [known, first] =
        nearest.try_emplace({std::lround(x), std::lround(y)}, std::pair(off, i));
    if (!first && off < known->second.first) known->second = {off, i};
  }
  std::vector<std::size_t> shown;
  for (const auto& [place, marker] : nearest) shown.push_back(marker.second);
  return shown;
}

/// Of what is seen from the side those in the plane y = 0 or near it.
std::vector<std::size_t> near_plane(MarkerField rows) {
  std::vector<std::size_t> order(rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto off = [&](std::size_t i) { return std::abs(rows[i].place.y()); };
  std::ranges::stable_sort(order, {}, off);
  constexpr double same_plane = 1e-6;  // [m]
  const auto beyond = std::ranges::find_if(
      order, [&](std::size_t i) { return off(i) > off(order.front()) + same_plane; });
  const std::size_t in_plane = std::size_t(beyond - order.begin());
  order.resize(in_plane >= enough_aside ? in_plane : std::min(order.size(), nearest_aside));
  return order;
}

std::vector<std::size_t> shown_in(const View& view, MarkerField rows) {
  if (&view == &along_rod) return spread(rows, view);
  std::vector<std::size_t> near = near_plane(rows), shown;
  std::vector<MarkerRow> own;
  for (const std::size_t i : near) own.push_back(rows[i]);
  for (const std::size_t i : spread(own, view)) shown.push_back(near[i]);
  return shown;
}

/// The fields of a figure: which markers, how long their arrows, which colours.
struct Scene {
  std::vector<std::pair<std::string, MarkerField>> fields;  ///< titles and displacements
  std::string what;                                         ///< is coloured

  double largest() const {
    double most = 0.0;
    for (const auto& [title, rows] : fields) most = std::max(most, marker_lengths(rows).largest);
    return most;
  }
  MarkerField places() const { return fields.front().second; }
};

/// 1, 2 or 5 times a power of ten, not above `value`.
double rounded_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0})
    if (step * power <= value * (1.0 + 1e-9)) return step * power;
  return power;
}

/// Panels of one view, side by side, and by how much their arrows are longer than what they show.
struct ViewPanels {
  std::vector<Panel> panels;
  double enlarged = 1.0;
};

ViewPanels view_panels(const Scene& scene, const View& view) {
  const std::vector<std::size_t> shown = shown_in(view, scene.places());
  const ShownUnit& unit = shown_units().length;
  const auto ends = [&](const Vector3& place) { return std::pair(place[view.x], place[view.y]); };
  Range x, y;
  double longest = 0.0;
  for (const std::size_t i : shown) {
    const auto [own_x, own_y] = ends(scene.places()[i].place);
    x.include(own_x), y.include(own_y);
    for (const auto& [title, rows] : scene.fields) {
      const auto [u, v] = ends(rows[i].displacement);
      longest = std::max(longest, std::hypot(u, v));
    }
  }
  const double width = std::max({x.to - x.from, y.to - y.from, 1e-9});
  ViewPanels made;
  if (longest > 0.0) made.enlarged = std::max(1.0, rounded_down(longest_arrow * width / longest));
  for (const auto& [title, rows] : scene.fields) {
    Panel panel{.title = title,
                .x_label = unit.label(view.x_label),
                .y_label = unit.label(view.y_label),
                .equal_scales = true,
                .key = ""};
    ColouredArrows drawn{
        {}, {}, {0.0, unit(std::max(scene.largest(), 1e-12))}, unit.label(scene.what)};
    Series places{"", "markers", {"#888888", "", 1.0, 7, false, 0.25}};
    for (const std::size_t i : shown) {
      const MarkerRow& row = rows[i];
      const auto [from_x, from_y] = ends(row.place);
      const auto [to_x, to_y] = ends(row.place + made.enlarged * row.displacement);
      places.add(unit(from_x), unit(from_y));
      x.include(to_x), y.include(to_y);
      if (std::hypot(to_x - from_x, to_y - from_y) <= least_arrow * made.enlarged * longest)
        continue;
      drawn.arrows.push_back({unit(from_x), unit(from_y), unit(to_x), unit(to_y), ""});
      drawn.values.push_back(unit(row.displacement.norm()));
    }
    panel.series = {std::move(places)};
    panel.coloured_arrows = std::move(drawn);
    made.panels.push_back(std::move(panel));
  }
  x = {x.from - room_around * width, x.to + room_around * width};
  y = {y.from - room_around * width, y.to + room_around * width};
  const double lacking = 0.5 * (flattest * (x.to - x.from) - (y.to - y.from));
  if (lacking > 0.0) y = {y.from - lacking, y.to + lacking};
  for (Panel& panel : made.panels) {
    panel.x_range = Range{unit(x.from), unit(x.to)};
    panel.y_range = Range{unit(y.from), unit(y.to)};
  }
  return made;
}

/// Each view a figure, each field a column of it.
Figure view_figure(const std::string& name, const Scene& scene, const View& view,
                   std::string& enlarged) {
  ViewPanels made = view_panels(scene, view);
  enlarged = made.enlarged > 1.0
                 ? fmt::format("{:g} times as long as the displacements", made.enlarged)
                 : "as long as the displacements";
  const int columns = int(made.panels.size());
  const Range &x = *made.panels.front().x_range, &y = *made.panels.front().y_range;
  const double slender = (y.to - y.from) / (x.to - x.from);
  const int side = columns == 1 ? 420 : 330;
  Figure figure{name, 0, 0, columns, std::move(made.panels), 120};
  figure.width = columns * (side + 190);
  figure.height = 120 + int(side * std::min(slender, 1.6));
  return figure;
}

Cell length_cell(double value, double error) {
  return amount_cell(value, shown_units().length, error);
}

/// "0.0123 (marker 5)"
Cell largest_cell(const MarkerLengths& lengths) {
  Cell cell = amount_cell(lengths.largest, shown_units().length);
  if (!cell.is_unknown()) cell.note = fmt::format("marker {}", lengths.marker);
  return cell;
}

Table marker_table(const MarkerComparison& markers) {
  const std::string unit = unit_name(shown_units().length);
  const auto name = [&](std::size_t run) {
    const std::string& label = markers.runs[run].label;
    return label.empty() ? std::string() : label + ": ";
  };
  Table table{heads({"Indentation\n" + unit})};
  const auto head = [&](const std::string& title, const std::string& note) {
    table.header.emplace_back(title, note);
  };
  for (std::size_t run = 0; run < markers.runs.size(); ++run) {
    head(name(run) + "displacement, rms", unit);
    head(run == 0 ? name(run) + "largest" : name(run) + "difference, rms", unit);
    if (run == 0) continue;
    head(name(run) + "largest difference", unit);
    head(name(run) + "relative difference", "of rms");
  }
  for (const MarkersAtSample& here : thinned(markers.samples)) {
    std::vector<Cell> row{fmt::format("{:.4g}", shown_units().length(here.indentation))};
    for (std::size_t run = 0; run < markers.runs.size(); ++run) {
      const MarkerLengths own = meshes::marker_lengths(here.fields[run]);
      row.push_back(length_cell(own.rms, own.error));
      if (run == 0) {
        row.push_back(largest_cell(own));
        continue;
      }
      const MarkerLengths off = here.difference(run);
      row.push_back(length_cell(off.rms, off.error));
      row.push_back(largest_cell(off));
      const double relative = here.relative(run), error = here.relative_error(run);
      row.emplace_back(percent_magnitude(relative),
                       if_known(error, "errors " + percent_magnitude(error)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Chapter marker_chapter(const MarkerComparison& markers, const std::string& name,
                       std::size_t number) {
  if (markers.samples.empty()) return {};
  const MarkersAtSample& last = markers.samples.back();
  ChapterData chapter("markers");
  const bool compared = markers.runs.size() > 1;
  chapter["count"] = std::to_string(last.fields.front().size());
  chapter["depth"] = length(last.indentation);
  chapter["compared"] = compared;
  chapter["first"] = markers.runs.front().label;
  Scene moved{{}, "displacement"}, off{{}, "difference"};
  for (std::size_t run = 0; run < markers.runs.size(); ++run) {
    if (last.fields[run].empty()) continue;
    moved.fields.emplace_back(markers.runs[run].label, last.fields[run]);
    if (run > 0) off.fields.emplace_back(markers.runs[run].label, last.differences[run]);
  }
  std::string along, side, difference;
  chapter.figures = {view_figure("markers_along", moved, along_rod, along),
                     view_figure("markers_side", moved, from_side, side)};
  if (!off.fields.empty())
    chapter.figures.push_back(view_figure("markers_difference", off, from_side, difference));
  chapter["along"] = along;
  chapter["side"] = side;
  chapter["difference"] = difference;
  chapter.tables["markers"] = marker_table(markers);
  return written_of(std::move(chapter), name, number);
}

Chapter marker_chapter(const RunData& run) {
  std::vector<RunContact> runs{{model_label("reference"), model_style("reference"), &run.reference,
                                nullptr, nullptr, &run.reference_markers}};
  for (const ModelData& model : run.models)
    runs.push_back({model_label(model.name), model_style(model.name), &model.response, nullptr,
                    nullptr, &model.markers});
  return marker_chapter(compared_markers(std::move(runs)));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
