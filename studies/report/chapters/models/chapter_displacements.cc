/// Measured displacements beside those of presses and their continua.
#include <algorithm>
#include <cmath>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

using DistanceEntries = std::vector<DisplacementEntry>;

constexpr const char* continuum_name = "continuum, finite strain";

Style displacement_style(const std::string& name) {
  if (name == continuum_name) return model_style("reference");
  if (name.starts_with("continuum")) return {"#000000", "(2,3)", 1.4};
  return model_style(name);
}

std::vector<double> indentations(const DistanceEntries& entries) {
  std::vector<double> depths;
  for (const DisplacementEntry& entry : entries)
    if (std::ranges::find(depths, entry.indentation) == depths.end())
      depths.push_back(entry.indentation);
  return depths;
}

/// Distances of every model at each indentation, the largest below; the last column tells how the
/// fields compare in size at the deepest.
Table distance_table(const DistanceEntries& entries) {
  const ShownUnit& length = shown_units().length;
  const std::vector<double> depths = indentations(entries);
  Table table{heads({"Model"})};
  for (const double depth : depths) table.header.emplace_back("rms", length.text(depth));
  table.header.emplace_back("Measured over computed", length.text(depths.back()));
  for (const std::string& name : distinct(entries, &DisplacementEntry::name)) {
    std::vector<Cell> row{name};
    double ratio = meshes::unknown;
    for (const DisplacementEntry& entry : entries) {
      if (entry.name != name) continue;
      row.push_back({number(length(entry.rms)), "largest " + number(length(entry.largest)) +
                                                    ", point " + std::to_string(entry.farthest)});
      ratio = entry.ratio;
    }
    row.resize(depths.size() + 1);
    row.emplace_back(number(ratio));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What displacements tell of Poisson's ratio, fit by fit.
Table ratio_table(const std::vector<RatioEntry>& fits) {
  const ShownUnit& length = shown_units().length;
  Table table{
      heads({"Fit", "Model", "Freed", "ν", "95 %", "Noise\n" + unit_name(length), "Missed"})};
  for (const RatioEntry& fit : fits)
    table.rows.push_back({fit.name,
                          {fit.model, fit.strain + " strain"},
                          fit.freed.empty() ? "–" : fit.freed,
                          number(fit.poissons_ratio, 4),
                          {number(fit.lower, 4) + " to " + number(fit.upper, 4),
                           fit.at_bound ? "an end of what is sought" : ""},
                          number(length(fit.noise), 2),
                          percent_magnitude(fit.misfit)});
  return table;
}

Figure distance_figure(const DisplacementStudy& study) {
  const ShownUnit& length = shown_units().length;
  Figure figure;
  figure.name = "displacements_distance";
  Panel panel = over_indentation("Distance, rms [" + unit_name(length) + "]");
  for (const std::string& name : distinct(study.distances, &DisplacementEntry::name)) {
    DistanceEntries own = study.distances;
    std::erase_if(own, [&](const DisplacementEntry& entry) { return entry.name != name; });
    Style style = displacement_style(name);
    style.point = 7;
    panel.series.push_back(curve(name.starts_with("continuum") ? name : model_label(name), name,
                                 style, own, in(length, &DisplacementEntry::indentation),
                                 in(length, &DisplacementEntry::rms)));
  }
  if (study.scatter_at_rest) panel.band = Band{0.0, length(study.scatter_at_rest->rms)};
  panel.y_range = Range{0.0, meshes::unknown};
  figure.panels.push_back(std::move(panel));
  return figure;
}

/// The points of a slab through the middle across y, where they are at the deepest indentation.
std::vector<DisplacementRow> slab(const std::vector<DisplacementRow>& rows, double pitch) {
  double depth = 0.0, mean = 0.0;
  Range extent;
  for (const DisplacementRow& row : rows) {
    depth = std::max(depth, row.indentation);
    mean += row.place.y() / double(rows.size());
    extent.include(row.place.y());
  }
  const double half = 0.5 * (std::isfinite(pitch) ? pitch : 0.2 * (extent.to - extent.from));
  std::vector<DisplacementRow> kept;
  std::ranges::copy_if(rows, std::back_inserter(kept), [&](const DisplacementRow& row) {
    return row.indentation == depth && std::abs(row.place.y() - mean) < half;
  });
  return kept;
}

/// A panel per model: measured places filled, computed ones open, joined.
Figure side_figure(const DisplacementStudy& study, const std::vector<DisplacementRow>& points) {
  const ShownUnit& length = shown_units().length;
  const double pitch = study.scatter_at_rest ? study.scatter_at_rest->pitch : NAN;
  const std::vector<DisplacementRow> rows = slab(points, pitch);
  Figure figure;
  figure.name = "displacements_side";
  const std::vector<std::string> names = distinct(rows, &DisplacementRow::name);
  figure.columns = names.size() > 1 ? 2 : 1;
  for (const std::string& name : names) {
    const Style style = displacement_style(name);
    Panel panel{.title = name.starts_with("continuum") ? name : model_label(name),
                .x_label = "x [" + unit_name(length) + "]",
                .y_label = "z [" + unit_name(length) + "]"};
    Series measured{"", "measured, " + name, Style{"#555555"}.as_points(7)},
        computed{"", name, style.as_points(6)}, between{"", "between, " + name, style.as_line()};
    between.style.dash = "";
    between.style.width = 1.2;
    for (const DisplacementRow& row : rows) {
      if (row.name != name) continue;
      const meshes::Vector3 seen = row.place + row.measured, found = row.place + row.computed;
      measured.add(length(seen.x()), length(seen.z()));
      computed.add(length(found.x()), length(found.z()));
      for (const meshes::Vector3& at : {seen, found}) between.add(length(at.x()), length(at.z()));
      between.add(NAN, NAN);
    }
    panel.series = {between, measured, computed};
    panel.equal_scales = true;
    panel.key = "";
    figure.panels.push_back(std::move(panel));
  }
  figure.width = 860;
  figure.height = 60 + 300 * int((names.size() + 1) / 2);
  return figure;
}

}  // namespace

Chapter displacements_chapter(const DisplacementStudy& study,
                              const std::vector<DisplacementRow>& points) {
  const DistanceEntries& entries = study.distances;
  if (entries.empty()) return {};
  const ShownUnit& length = shown_units().length;
  ChapterData chapter("displacements");
  const std::vector<double> depths = indentations(entries);
  const auto deepest = [&](const DisplacementEntry& entry) {
    return entry.indentation == depths.back() ? entry.rms : meshes::unknown;
  };
  const DisplacementEntry* worst = largest_in(entries, deepest);
  const DisplacementEntry* best =
      largest_in(entries, [&](const DisplacementEntry& entry) { return -deepest(entry); });
  chapter["known"] = best != nullptr;
  if (best != nullptr) {
    chapter["best"] = best->name;
    chapter["best_rms"] = length.text(best->rms);
    chapter["several"] = worst->name != best->name;
    chapter["worst"] = worst->name;
    chapter["worst_rms"] = length.text(worst->rms);
    chapter["size"] = length.text(best->size);
    chapter["turn"] = number(best->turn * 180.0 / std::acos(-1.0), 2);
  }
  chapter["length_unit"] = unit_name(length);
  chapter["depth"] = length.text(depths.back());
  chapter["scattered"] = study.scatter_at_rest.has_value();
  if (const auto& scatter = study.scatter_at_rest) {
    chapter["scatter"] = length.text(scatter->rms);
    chapter["scatter_largest"] = length.text(scatter->largest);
    chapter["pitch"] = length.text(scatter->pitch);
  }
  chapter.figures.push_back(distance_figure(study));
  chapter.figures.push_back(side_figure(study, points));
  chapter.tables["distances"] = distance_table(entries);
  chapter.tables["ratios"] = ratio_table(study.poissons_ratios);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
