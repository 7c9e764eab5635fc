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

std::vector<double> depths_of(const std::vector<Sample>& samples) {
  std::vector<double> depths;
  for (const Sample& sample : samples) depths.push_back(sample.depth);
  return depths;
}

/// The sample where `measure` is largest; null when it is finite nowhere.
template <class Measure>
const Sample* worst(const std::vector<Sample>& samples, Measure measure) {
  const Sample* found = nullptr;
  for (const Sample& sample : samples) {
    if (!std::isfinite(measure(sample))) continue;
    if (!found || measure(sample) > measure(*found)) found = &sample;
  }
  return found;
}

/// How far the force may be off, and how that is estimated; none where no depth has an estimate.
WordList certainty(const RunData& run, const std::vector<Sample>& samples) {
  const Sample* relative = worst(samples, [](const Sample& s) { return s.relative_error(); });
  if (!relative) return {};
  const auto estimated = std::count_if(samples.begin(), samples.end(), [](const Sample& s) {
    return std::isfinite(s.relative_error());
  });
  const Sample* absolute = worst(samples, [](const Sample& s) { return s.error; });
  const double share = relative->relative_error(), tolerance = run.continuum.tolerance;
  const bool all = std::size_t(estimated) == samples.size(), same = absolute == relative;
  Words words;
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
  Panel panel;
  panel.x_label = "unknowns of the mesh";
  panel.y_label = "F against the finest mesh [%]";
  panel.log_x = 10;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Sample& sample = *shown[i];
    Series series{depth_label(sample.depth), "", sample.unknowns, {}, {}, {}};
    series.style = {depth_shade(i, shown.size()), "", 1.6, 7, true, 0.5};
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
  Panel panel;
  panel.x_label = "unknowns of the mesh";
  panel.y_label = "magnitude [%]";
  panel.log_x = panel.log_y = 10;
  panel.key = "";
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Sample& sample = *shown[i];
    const std::string colour = depth_shade(i, shown.size());
    Series change{"", depth_label(sample.depth), {}, {}, {}, {colour, "", 1.6, 7, true, 0.5}};
    for (std::size_t k = 0; k + 1 < sample.forces.size(); ++k) {
      const double magnitude = std::abs(sample.forces[k] / sample.forces.back() - 1.0);
      change.x.push_back(sample.unknowns[k]);
      change.y.push_back(magnitude > 0.0 ? 100.0 * magnitude : meshes::unknown);
    }
    panel.series.push_back(change);
    if (!std::isfinite(sample.error)) continue;
    panel.series.push_back({"",
                            depth_label(sample.depth) + " estimate",
                            {sample.unknowns.back()},
                            {100.0 * sample.relative_error()},
                            {},
                            {colour, "", 1.6, 10, false, 0.9}});
  }
  return panel;
}

/// A line of the order 1.5 that the estimate assumes, h ~ unknowns^(-1/3), through the panel's top
/// left.
Series slope_guide(const Panel& panel) {
  double least = 1e300, most = 0.0, top = 0.0;
  for (const Series& series : panel.series) {
    for (double x : series.x) least = std::fmin(least, x), most = std::fmax(most, x);
    for (double y : series.y) top = std::fmax(top, y);
  }
  Series guide{"", "order 1.5", {}, {}, {}, {"#777777", "(2,3)", 1.5, 0, true}};
  for (double x : {least, most}) {
    guide.x.push_back(x);
    guide.y.push_back(1.6 * top / std::sqrt(x / least));
  }
  return guide;
}

Figure convergence_figure(const RunData& run, const std::vector<Sample>& samples) {
  std::vector<Sample> refined;
  for (const Sample& sample : samples)
    if (sample.forces.size() > 1) refined.push_back(sample);
  const std::vector<double> depths = shown_depths(run, depths_of(refined));
  std::vector<const Sample*> shown;
  for (const Sample& sample : refined)
    if (std::find(depths.begin(), depths.end(), sample.depth) != depths.end())
      shown.push_back(&sample);
  Figure figure{"mesh_convergence", 880, 640, 1, {change_panel(shown), decay_panel(shown)}, 175};
  figure.panels[0].key = figure.beside_panels();
  figure.panels[1].series.push_back(slope_guide(figure.panels[1]));
  for (const auto& [label, style] :
       {std::pair{"estimated error", Style{"#555555", "", 1.6, 10, false, 0.9}},
        std::pair{"order 1.5", Style{"#777777", "(2,3)", 1.5, 0, true}}}) {
    Series entry{label, "", {}, {}, {}, style};
    entry.legend_only = true;
    figure.panels[0].series.push_back(entry);
  }
  return figure;
}

/// A count of a sample; "–" where summary.json does not have the sample.
std::string whole(const Sample& sample, int fem_reference::PressState::*number) {
  return sample.details ? count(double((*sample.details).*number)) : "–";
}

/// A quantity of one sample in the table.
struct SampleColumn {
  Cell header;
  std::function<Cell(const Sample&)> cell;
};

Cell contact_nodes(const Sample& sample, double radius, bool slides) {
  const double spacing = sample.details ? sample.details->node_spacing : meshes::unknown;
  std::string note;
  if (spacing > 0.0 && std::isfinite(radius))
    note = fmt::format("{} along a", number(radius / spacing, 2));
  if (slides)
    note += fmt::format(", {} slide", whole(sample, &fem_reference::PressState::sliding_nodes));
  return plain(whole(sample, &fem_reference::PressState::active_nodes), note);
}

Cell iterations(const Sample& sample, bool finite) {
  std::string note = "contact " + whole(sample, &fem_reference::PressState::active_set_iterations);
  if (finite)
    note = "Newton " + whole(sample, &fem_reference::PressState::newton_iterations) + ", " + note;
  return plain(whole(sample, &fem_reference::PressState::steps), note);
}

std::vector<SampleColumn> force_columns(const RunData& run) {
  std::vector<SampleColumn> columns;
  columns.push_back({plain("Force", unit_name(shown_units().force)), [](const Sample& s) {
                       return plain(number_with_error(shown_units().force(s.force),
                                                      shown_units().force(s.error), 5),
                                    si_note(s.force, "N"));
                     }});
  columns.push_back({plain("Error", "estimated"), [](const Sample& s) {
                       if (!std::isfinite(s.error)) return plain("–");
                       return plain(percent_magnitude(s.relative_error()),
                                    with_unit(s.error, shown_units().force, 2));
                     }});
  columns.push_back({plain("Convergence", "order"), [](const Sample& s) {
                       const auto details = s.details.value_or(fem_reference::PressState());
                       const double order = details.order;
                       return plain(details.convergence.empty() ? "–" : details.convergence,
                                    std::isfinite(order) ? number(order, 2) : "");
                     }});
  if (const auto hertz = hertz_contact(run))
    columns.push_back({plain("Against Hertz", "F/F_Hertz − 1"), [=](const Sample& s) {
                         return plain(percent(s.force / hertz->force(s.depth) - 1.0));
                       }});
  return columns;
}

std::vector<SampleColumn> contact_columns(const RunData& run) {
  const bool finite = run.continuum.strain == "finite";
  const bool slides = run.continuum.contact == "coulomb";
  std::map<double, meshes::PressSample> response;
  for (const meshes::PressSample& sample : run.reference.pressing())
    response[sample.indentation] = sample;
  std::vector<SampleColumn> columns;
  columns.push_back(
      {plain("Contact radius", unit_name(shown_units().length)), [=](const Sample& s) {
         const double a = response.at(s.depth).contact_radius;
         return plain(number(shown_units().length(a)), si_note(a, "m"));
       }});
  columns.push_back({plain("Peak pressure", unit_name(shown_units().stress)), [=](const Sample& s) {
                       const double p = response.at(s.depth).max_pressure;
                       return plain(number(shown_units().stress(p)), si_note(p, "Pa"));
                     }});
  columns.push_back({plain("Nodes in contact", "along its radius a"), [=](const Sample& s) {
                       return contact_nodes(s, response.at(s.depth).contact_radius, slides);
                     }});
  columns.push_back(
      {plain("Steps", "iterations"), [=](const Sample& s) { return iterations(s, finite); }});
  if (finite)
    columns.push_back({plain("Smallest J", "1 undeformed"), [](const Sample& s) {
                         return plain(
                             number(s.details ? s.details->min_jacobian : meshes::unknown, 3));
                       }});
  return columns;
}

Table sample_table(const RunData& run, const std::vector<Sample>& samples) {
  Table table;
  std::vector<SampleColumn> columns = force_columns(run);
  for (SampleColumn& column : contact_columns(run)) columns.push_back(std::move(column));
  table.header = {plain("Indentation", unit_name(shown_units().length))};
  for (const SampleColumn& column : columns) table.header.push_back(column.header);
  for (const Sample& sample : samples) {
    std::vector<Cell> row{plain(fmt::format("{:.4g}", shown_units().length(sample.depth)),
                                si_note(sample.depth, "m"))};
    for (const SampleColumn& column : columns) row.push_back(column.cell(sample));
    table.rows.push_back(std::move(row));
  }
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
  Table table;
  table.header = {plain("Mesh"),   plain("Cells"),     plain("Unknowns"),
                  plain("Depths"), plain("Wall time"), plain("Force off the finest", "largest")};
  int number = 0;
  for (const fem_reference::MeshEntry& mesh : run.continuum.meshes) {
    ++number;
    table.rows.push_back({plain(std::to_string(number)), plain(count(double(mesh.cells))),
                          plain(count(double(mesh.dofs))),
                          plain(count(double(mesh.samples.value_or(0)))),
                          plain(with_prefix(mesh.wall_time, "s")),
                          plain(percent_magnitude(largest_change(samples, number)))});
  }
  return table;
}

/// Both ends of the press beside Hertz's.
WordList beside_hertz(const RunData& run, const std::vector<Sample>& samples) {
  const auto hertz = hertz_contact(run);
  if (!hertz) return {};
  const auto off = [&](const Sample& s) { return s.force / hertz->force(s.depth) - 1.0; };
  const Sample &first = samples.front(), &last = samples.back();
  const meshes::PressSample& deepest = run.reference.pressing().back();
  Words words;
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
  if (!run.pressure.empty()) chapter.figures.push_back(pressure_figure(run));
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline continuum
