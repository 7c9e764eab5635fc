/// How far the continuum's forces may be off, and what its contact looks like.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/continuum/continuum_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline continuum {
namespace {

/// One depth of the press on all meshes that computed it, coarse to fine.
struct Sample {
  double depth = meshes::unknown;                    ///< [m]
  std::vector<double> unknowns, forces;              ///< of each mesh: number, [N]
  std::vector<int> meshes;                           ///< their numbers, from 1
  double force = meshes::unknown;                    ///< of the finest [N]
  double error = meshes::unknown;                    ///< estimated, of the finest [N]
  std::optional<fem_reference::PressState> details;  ///< the entry of summary.json

  double relative_error() const { return error / force; }
};

std::vector<Sample> read_samples(const RunData& run) {
  std::vector<Sample> samples;
  for (const meshes::PressSample& from : run.reference.pressing()) {
    Sample sample;
    sample.depth = from.indentation;
    sample.force = from.normal_force;
    sample.error = from.force_error;
    for (const fem_reference::PressState& entry : run.continuum.samples)
      if (!sample.details && same_depth(entry.indentation, sample.depth)) sample.details = entry;
    for (const fem_reference::PressState& entry : run.continuum.transient_samples)
      if (!sample.details && same_depth(entry.indentation, sample.depth)) sample.details = entry;
    samples.push_back(std::move(sample));
  }
  for (const fem_reference::ConvergenceRow& row : run.convergence) {
    for (Sample& sample : samples) {
      if (!same_depth(sample.depth, row.indentation)) continue;
      // Later rows of a mesh at one depth belong to a lateral motion that followed.
      if (!sample.meshes.empty() && sample.meshes.back() == row.mesh) continue;
      sample.meshes.push_back(row.mesh);
      sample.unknowns.push_back(double(row.unknowns));
      sample.forces.push_back(row.normal_force);
    }
  }
  return samples;
}

/// How far the force may be off, and how that is estimated; none where no depth has an estimate.
WordList certainty(const RunData& run, const std::vector<Sample>& samples) {
  const Sample* relative = largest_in(samples, &Sample::relative_error);
  if (!relative) return {};
  const auto estimated = std::count_if(samples.begin(), samples.end(), [](const Sample& s) {
    return std::isfinite(s.relative_error());
  });
  const Sample* absolute = largest_in(samples, &Sample::error);
  const double share = relative->relative_error(), tolerance = run.continuum.tolerance;
  const bool all = std::size_t(estimated) == samples.size(), same = absolute == relative;
  TemplateData words;
  words["error"] = percent_magnitude(share);
  words["estimated"] = all ? "" : std::to_string(estimated);
  words["all"] = std::to_string(samples.size());
  words["worst_error"] = force(relative->error);
  words["worst_depth"] = length(relative->depth);
  words["largest_error"] = same ? "" : force(absolute->error);
  words["largest_depth"] = length(absolute->depth);
  words["tolerance"] = if_known(tolerance, percent_magnitude(tolerance));
  words["reached"] = share <= tolerance;
  words["meshes"] = std::to_string(relative->forces.size());
  words["two"] = relative->forces.size() == 2;
  words["verified"] = !run.verification.empty();
  return {words};
}

/// Change of force against the finest mesh in percent, with the estimate as bars of the latter.
Panel change_panel(const std::vector<const Sample*>& shown) {
  Panel panel{
      .x_label = "unknowns of the mesh", .y_label = "F against the finest mesh [%]", .log_x = 10};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Sample& sample = *shown[i];
    Series series{depth_label(sample.depth),
                  "",
                  {depth_shade(i, shown.size()), "", 1.6, 7, true, 0.5},
                  sample.unknowns};
    series.shift = std::pow(1.025, double(i) - 0.5 * double(shown.size() - 1));
    for (double f : sample.forces) series.y.push_back(100.0 * (f / sample.forces.back() - 1.0));
    series.error.assign(sample.forces.size(), 0.0);
    if (std::isfinite(sample.error)) series.error.back() = 100.0 * sample.relative_error();
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// Magnitude of the same, and the estimate in the place of the finest mesh.
Panel decay_panel(const std::vector<const Sample*>& shown) {
  Panel panel{.x_label = "unknowns of the mesh",
              .y_label = "magnitude [%]",
              .log_x = 10,
              .log_y = 10,
              .key = ""};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Sample& sample = *shown[i];
    const std::string colour = depth_shade(i, shown.size());
    Series change{"", depth_label(sample.depth), {colour, "", 1.6, 7, true, 0.5}};
    for (std::size_t k = 0; k + 1 < sample.forces.size(); ++k) {
      const double magnitude = std::abs(sample.forces[k] / sample.forces.back() - 1.0);
      change.add(sample.unknowns[k], magnitude > 0.0 ? 100.0 * magnitude : meshes::unknown);
    }
    panel.series.push_back(change);
    if (std::isfinite(sample.error))
      panel.series.push_back({"",
                              depth_label(sample.depth) + " estimate",
                              {colour, "", 1.6, 10, false, 0.9},
                              {sample.unknowns.back()},
                              {100.0 * sample.relative_error()}});
  }
  return panel;
}

/// A line of the order 1.5 that the estimate assumes, h ~ unknowns^(-1/3), through the panel's top
/// left.
Series slope_guide(const Panel& panel) {
  const Range x = extent_of(panel.series, &Series::x);
  const double top = extent_of(panel.series, &Series::y).to;
  Series guide{"", "order 1.5", {"#777777", "(2,3)", 1.5}};
  for (const double at : {x.from, x.to}) guide.add(at, 1.6 * top / std::sqrt(at / x.from));
  return guide;
}

Figure convergence_figure(const RunData& run, const std::vector<Sample>& samples) {
  std::vector<const Sample*> shown;
  std::vector<double> depths;
  for (const Sample& sample : samples)
    if (sample.forces.size() > 1) depths.push_back(sample.depth);
  depths = shown_depths(run, depths);
  for (const Sample& sample : samples)
    if (sample.forces.size() > 1 && std::ranges::find(depths, sample.depth) != depths.end())
      shown.push_back(&sample);
  Figure figure{"mesh_convergence", 880, 640, 1, {change_panel(shown), decay_panel(shown)}, 175};
  figure.panels[0].key = figure.beside_panels();
  figure.panels[1].series.push_back(slope_guide(figure.panels[1]));
  figure.panels[0].series.push_back(
      legend_entry("estimated error", {"#555555", "", 1.6, 10, false, 0.9}));
  figure.panels[0].series.push_back(legend_entry("order 1.5", {"#777777", "(2,3)", 1.5}));
  return figure;
}

/// A count of a sample; "–" where summary.json does not have the sample.
std::string whole(const Sample& sample, int fem_reference::PressState::*number) {
  return sample.details ? count(double((*sample.details).*number)) : "–";
}

std::string contact_nodes_note(const Sample& sample, double radius, bool slides) {
  const double spacing = sample.details ? sample.details->node_spacing : meshes::unknown;
  std::string note;
  if (spacing > 0.0 && std::isfinite(radius))
    note = fmt::format("{} along a", number(radius / spacing, 2));
  if (slides)
    note += fmt::format(", {} slide", whole(sample, &fem_reference::PressState::sliding_nodes));
  return note;
}

std::string iterations(const Sample& sample, bool finite) {
  const std::string contact =
      "contact " + whole(sample, &fem_reference::PressState::active_set_iterations);
  return finite ? "Newton " + whole(sample, &fem_reference::PressState::newton_iterations) + ", " +
                      contact
                : contact;
}

Table sample_table(const RunData& run, const std::vector<Sample>& samples) {
  using Entry = fem_reference::PressState;
  const ShownUnits& units = shown_units();
  const bool finite = run.continuum.strain == "finite", slides = run.continuum.contact == "coulomb";
  const auto hertz = hertz_contact(run);
  Table table{heads(
      {"Indentation\n" + unit_name(units.length), "Force\n" + unit_name(units.force),
       "Error\nestimated", "Convergence\norder", "Against Hertz\nF/F_Hertz − 1",
       "Contact radius\n" + unit_name(units.length), "Peak pressure\n" + unit_name(units.stress),
       "Nodes in contact\nalong its radius a", "Steps\niterations", "Smallest J\n1 undeformed"})};
  const auto response = run.reference.pressing();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    const Entry details = s.details.value_or(Entry());
    table.rows.push_back(
        {{fmt::format("{:.4g}", units.length(s.depth)), si_note(s.depth, "m")},
         {number_with_error(units.force(s.force), units.force(s.error), 5), si_note(s.force, "N")},
         {percent_magnitude(s.relative_error()),
          if_known(s.error, with_unit(s.error, units.force, 2))},
         {details.convergence.empty() ? "–" : details.convergence,
          if_known(details.order, number(details.order, 2))},
         hertz ? percent(s.force / hertz->force(s.depth) - 1.0) : "",
         amount_cell(response[i].contact_radius, units.length, response[i].contact_radius_error),
         amount_cell(response[i].max_pressure, units.stress, response[i].max_pressure_error),
         {whole(s, &Entry::active_nodes),
          contact_nodes_note(s, response[i].contact_radius, slides)},
         {whole(s, &Entry::steps), iterations(s, finite)},
         number(details.min_jacobian, 3)});
  }
  if (!finite) table.drop_column(9);
  if (!hertz) table.drop_column(4);
  return table;
}

/// Largest change of force of mesh `number` against the finest mesh, over all depths; NaN without.
double largest_change(const std::vector<Sample>& samples, int number) {
  double largest = meshes::unknown;
  for (const Sample& sample : samples) {
    for (std::size_t k = 0; k + 1 < sample.forces.size(); ++k) {
      if (sample.meshes[k] == number)
        largest = std::fmax(largest, std::abs(sample.forces[k] / sample.forces.back() - 1.0));
    }
  }
  return largest;
}

Table sequence_table(const RunData& run, const std::vector<Sample>& samples) {
  Table table{
      heads({"Mesh", "Cells", "Unknowns", "Depths", "Wall time", "Force off the finest\nlargest"})};
  int number = 0;
  for (const fem_reference::MeshEntry& mesh : run.continuum.meshes)
    table.rows.push_back({std::to_string(++number), count(double(mesh.cells)),
                          count(double(mesh.dofs)), count(double(mesh.samples.value_or(0))),
                          with_prefix(mesh.wall_time, "s"),
                          percent_magnitude(largest_change(samples, number))});
  return table;
}

/// Both ends of the press beside Hertz's.
WordList beside_hertz(const RunData& run, const std::vector<Sample>& samples) {
  const auto hertz = hertz_contact(run);
  if (!hertz) return {};
  const auto off = [&](const Sample& s) { return s.force / hertz->force(s.depth) - 1.0; };
  const Sample &first = samples.front(), &last = samples.back();
  const meshes::PressSample& deepest = run.reference.pressing().back();
  TemplateData words;
  words["radius"] = length(tip_radius(run));
  words["ball"] = !obstacle_of(run).is_plane();
  words["first"] = percent(off(first));
  words["first_depth"] = length(first.depth);
  words["last"] = samples.size() > 1 ? percent(off(last)) : "";
  words["last_depth"] = length(last.depth);
  words["pressure"] = percent(deepest.max_pressure / hertz->max_pressure(last.depth) - 1.0);
  words["contact_radius"] =
      percent(deepest.contact_radius / hertz->contact_radius(last.depth) - 1.0);
  words["stiffer"] = off(last) > 0.0 && off(last) >= off(first);
  words["rubs"] = run.continuum.contact != "frictionless";
  words["finite"] = run.continuum.strain == "finite";
  return {words};
}

}  // namespace

Chapter continuum_chapter(const RunData& run) {
  const std::vector<Sample> samples = read_samples(run);
  ChapterData chapter("continuum");
  chapter["status"] = run.continuum.status == "ok" ? "" : run.continuum.status;
  chapter["message"] = run.continuum.message;
  const WordList known = certainty(run, samples);
  chapter["unknown"] = known.empty() && !samples.empty();
  chapter["known"] = known;
  chapter["on_axis"] = obstacle_of(run).on_axis();
  chapter["hertz"] = samples.empty() ? WordList() : beside_hertz(run, samples);
  if (samples.empty()) return written(std::move(chapter));
  if (std::any_of(samples.begin(), samples.end(),
                  [](const Sample& s) { return s.forces.size() > 1; }))
    chapter.figures.push_back(convergence_figure(run, samples));
  chapter.tables["samples"] = sample_table(run, samples);
  chapter.tables["meshes"] = sequence_table(run, samples);
  if (!run.section.empty() && run.reference.samples().back().contact_radius > 0.0)
    chapter.figures.push_back(mesh_figure(run));
  if (!run.reference_contact.empty()) chapter.figures.push_back(pressure_figure(run));
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline continuum
