/// Time step, cost, mesh quality; provenance.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

/// One line of the lattices' table: what it tells and how a model's summary.json tells it.
struct Quantity {
  std::string label, note;
  std::function<std::string(const PressSummary& summary)> value;
};

std::string seconds(double value) {
  return with_prefix(value, "s");
}

std::vector<Quantity> size_quantities() {
  using S = PressSummary;
  return {{"Spacing", "", [](const S& s) { return length(s.spacing); }},
          {"Particles", "", [](const S& s) { return count(double(s.census.particles)); }},
          {"Computed", "of mirror images one",
           [](const S& s) {
             return s.census.sectors > 1 ? fmt::format("1/{}", s.census.sectors) : "all";
           }},
          {"Expected V/a³", "", [](const S& s) { return count(s.census.expected_particles); }},
          {"Springs", "", [](const S& s) { return count(double(s.census.springs)); }},
          {"Cells", "", [](const S& s) { return count(double(s.census.cells)); }},
          {"Boundary particles", "",
           [](const S& s) { return count(double(s.census.boundary_particles)); }},
          {"Ligaments", "", [](const S& s) { return count(double(s.census.ligaments)); }},
          {"Mass against ρV", "",
           [](const S& s) { return percent(s.census.mass / s.census.exact_mass - 1.0); }}};
}

std::vector<Quantity> time_quantities() {
  using S = PressSummary;
  return {
      {"ω₀ = √(2k/m)", "the paper's estimate, rad/s",
       [](const S& s) { return number(s.step.omega0, 4); }},
      {"1/ω₀", "the paper's bound", [](const S& s) { return seconds(s.step.paper_bound); }},
      {"Spectral bound", "largest stable step",
       [](const S& s) { return seconds(s.step.spectral_bound); }},
      {"Step used", "", [](const S& s) { return seconds(s.step.step); }},
      {"Steps", "", [](const S& s) { return count(std::round(s.simulated_time / s.step.step)); }},
      {"Simulated time", "", [](const S& s) { return seconds(s.simulated_time); }},
      {"Wall time", "of the run that computed it", [](const S& s) { return seconds(s.wall_time); }},
      {"Threads", "then", [](const S& s) { return number(double(s.threads), 4); }},
      {"Real-time factor", "above 1: faster than real time",
       [](const S& s) { return number(s.real_time_factor, 3); }},
      {"Momentum defect", "rod, tip and plane, relative",
       [](const S& s) { return number(s.momentum_defect, 2); }}};
}

Table lattice_table(const RunData& run) {
  Table table;
  table.header = {plain("Lattice")};
  for (const ModelData& model : run.models) {
    if (model.summary.empty()) continue;
    table.header.push_back(plain(model_label(model.name), model.summary.kinematics));
  }
  for (const std::vector<Quantity>& group : {size_quantities(), time_quantities()}) {
    for (const Quantity& quantity : group) {
      std::vector<Cell> row{plain(quantity.label, quantity.note)};
      for (const ModelData& model : run.models) {
        if (!model.summary.empty()) row.push_back(plain(quantity.value(model.summary)));
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

/// What a row tells and its value, "" or "–" when summary.json does not have it.
using MeshRow = std::pair<Cell, std::string>;

std::vector<MeshRow> problem_rows(const fem_reference::RunSummary& summary) {
  return {{plain("Status"), summary.status},
          {plain("Contact"), summary.contact},
          {plain("Strain"), summary.strain + (summary.law.empty() ? "" : ", " + summary.law)},
          {plain("Polynomial degree"), number(double(summary.degree), 1)},
          {plain("Volumetric part", "of the energy"), summary.volumetric},
          {plain("Linear solver"), summary.solver},
          {plain("Processes"), count(double(summary.ranks))},
          {plain("Wanted force error"), percent_magnitude(summary.tolerance)},
          {plain("Wall time", "of all meshes"), seconds(summary.wall_time)},
          {plain("Peak memory", "of one process"), with_prefix(summary.peak_memory, "B")}};
}

/// "" of a count that no mesh has.
std::string some(std::size_t number) {
  return number > 0 ? count(double(number)) : "";
}

std::vector<MeshRow> mesh_rows(const fem_reference::RunSummary& summary) {
  const meshes::MeshQuality& first = summary.mesh;
  return {{plain("Cells", "finest mesh"), some(summary.cells)},
          {plain("Degrees of freedom", "finest mesh"), some(summary.dofs)},
          {plain("Of these in the contact zone"), some(summary.contact_unknowns)},
          {plain("Hexahedra", "first mesh"), some(first.hexahedra)},
          {plain("Smallest scaled Jacobian", "first mesh; 1 for a cube"),
           number(first.min_scaled_jacobian, 3)},
          {plain("Smallest Jacobian", "first mesh, m³"), number(first.min_jacobian, 3)},
          {plain("Volume", "first mesh: straight-sided elements, meshed sector"),
           std::isfinite(first.volume)
               ? number(first.volume * std::pow(shown_units().length.factor, 3)) + gap +
                     unit_name(shown_units().length) + "³"
               : ""}};
}

Table mesh_table(const RunData& run) {
  Table table;
  table.header = {plain("Continuum"), plain("Value")};
  for (const std::vector<MeshRow>& rows : {problem_rows(run.continuum), mesh_rows(run.continuum)}) {
    for (const auto& [label, value] : rows) {
      // Runs of other programs, modes or versions do not tell everything.
      if (!value.empty() && value != "–") table.rows.push_back({label, plain(value)});
    }
  }
  return table;
}

void add_row(Table& table, const std::string& key, const std::string& value) {
  Cell cell = plain(value);
  cell.words = true;
  if (!value.empty()) table.rows.push_back({plain(key), cell});
}

/// name → value of a JSON object as rows of a table.
void add_rows(Table& table, const nlohmann::ordered_json& object, const std::string& prefix) {
  for (const auto& [key, value] : object.items())
    add_row(table, prefix + key, value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

Chapter cost_chapter(const RunData& run) {
  ChapterData chapter("cost");
  if (Table lattices = lattice_table(run); lattices.header.size() > 1)
    chapter.tables["lattices"] = std::move(lattices);
  WordList steps;
  for (const ModelData& model : run.models) {
    if (model.summary.step.explanation.empty()) continue;
    steps.emplace_back()["model"] = model.name;
    steps.back()["explanation"] = model.summary.step.explanation;
  }
  chapter["steps"] = std::move(steps);
  if (!run.continuum.empty()) chapter.tables["continuum"] = mesh_table(run);
  return written(std::move(chapter));
}

Chapter provenance_chapter(const RunData& run) {
  Table table;
  table.header = {plain("Entry"), plain("Value")};
  table.header.back().words = true;  // as its values are
  const Manifest& manifest = run.manifest;
  add_row(table, "version", manifest.version);
  add_row(table, "source_hash", manifest.source_hash);
  add_row(table, "input_hash", manifest.input_hash);
  add_row(table, "command_line", fmt::format("{}", fmt::join(manifest.command_line, " ")));
  add_row(table, "started", manifest.started);
  add_row(table, "finished", manifest.finished.value_or(""));
  add_rows(table, manifest.host, "host: ");
  add_rows(table, manifest.packages, "");
  ChapterData chapter("provenance");
  chapter.tables["manifest"] = std::move(table);
  chapter["verb"] = run.verb;
  chapter["parameters"] = !run.parameters.empty();
  if (!run.parameters.empty()) chapter.listings["parameters"] = run.parameters;
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
