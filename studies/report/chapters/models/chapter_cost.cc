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
struct CostLine {
  std::string label, note;
  std::function<std::string(const PressSummary& summary)> value;
};

std::string seconds(double value) {
  return with_prefix(value, "s");
}

std::vector<CostLine> cost_lines() {
  using S = PressSummary;
  return {
      {"Spacing", "", [](const S& s) { return length(s.spacing); }},
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
       [](const S& s) { return percent(s.census.mass / s.census.exact_mass - 1.0); }},
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
  Table table{{"Lattice"}};
  for (const CostLine& line : cost_lines()) table.rows.push_back({{line.label, line.note}});
  for (const ModelData& model : run.models) {
    if (model.summary.empty()) continue;
    table.header.emplace_back(model_label(model.name), model.summary.kinematics);
    std::size_t row = 0;
    for (const CostLine& line : cost_lines())
      table.rows[row++].push_back(line.value(model.summary));
  }
  return table;
}

/// "" of a count that no mesh has.
std::string some(std::size_t number) {
  return number > 0 ? count(double(number)) : "";
}

Table mesh_table(const fem_reference::RunSummary& summary) {
  const meshes::MeshQuality& first = summary.mesh;
  const ShownUnit& length = shown_units().length;
  Table table{heads({"Continuum", "Value"})};
  table.rows = {{"Status", summary.status},
                {"Contact", summary.contact},
                {"Strain", summary.strain + (summary.law.empty() ? "" : ", " + summary.law)},
                {"Polynomial degree", number(double(summary.degree), 1)},
                {{"Volumetric part", "of the energy"}, summary.volumetric},
                {"Linear solver", summary.solver},
                {"Processes", count(double(summary.ranks))},
                {"Wanted force error", percent_magnitude(summary.tolerance)},
                {{"Wall time", "of all meshes"}, seconds(summary.wall_time)},
                {{"Peak memory", "of one process"}, with_prefix(summary.peak_memory, "B")},
                {{"Cells", "finest mesh"}, some(summary.cells)},
                {{"Degrees of freedom", "finest mesh"}, some(summary.dofs)},
                {"Of these in the contact zone", some(summary.contact_unknowns)},
                {{"Hexahedra", "first mesh"}, some(first.hexahedra)},
                {{"Smallest scaled Jacobian", "first mesh; 1 for a cube"},
                 number(first.min_scaled_jacobian, 3)},
                {{"Smallest Jacobian", "first mesh, m³"}, number(first.min_jacobian, 3)},
                {{"Volume", "first mesh: straight-sided elements, meshed sector"},
                 if_known(first.volume, number(first.volume * std::pow(length.factor, 3)) + gap +
                                            unit_name(length) + "³")}};
  // Runs of other programs or modes do not tell everything.
  std::erase_if(table.rows, [](const std::vector<Cell>& row) { return row[1].is_unknown(); });
  return table;
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
  if (!run.continuum.empty()) chapter.tables["continuum"] = mesh_table(run.continuum);
  return written(std::move(chapter));
}

Chapter provenance_chapter(const RunData& run) {
  Table table{heads({"Entry", "Value"})};
  table.header.back().words = true;  // as its values are
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) table.rows.push_back({name, prose(value)});
  };
  const auto add_all = [&](const nlohmann::ordered_json& object, const std::string& prefix) {
    for (const auto& [key, value] : object.items())
      add(prefix + key, value.is_string() ? value.get<std::string>() : value.dump());
  };
  const Manifest& manifest = run.manifest;
  add("version", manifest.version);
  add("source_hash", manifest.source_hash);
  add("input_hash", manifest.input_hash);
  add("command_line", fmt::format("{}", fmt::join(manifest.command_line, " ")));
  add("started", manifest.started);
  add("finished", manifest.finished.value_or(""));
  add_all(manifest.host, "host: ");
  add_all(manifest.packages, "");
  ChapterData chapter("provenance");
  chapter.tables["manifest"] = std::move(table);
  chapter["verb"] = run.verb;
  chapter["parameters"] = !run.parameters.empty();
  if (!run.parameters.empty()) chapter.listings["parameters"] = run.parameters;
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
