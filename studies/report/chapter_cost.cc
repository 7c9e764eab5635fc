/// Time step, cost, mesh quality; provenance.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "studies/report/chapters.h"

namespace fingertip::studies::reporting {
namespace {

/// One line of the lattices' table: what it tells and how a model's summary.json tells it.
struct Quantity {
  std::string label, note;
  std::function<std::string(const JsonEntry& summary)> value;
};

/// An entry of the part `group` of summary.json, or of the file itself when `group` is empty.
double entry(const JsonEntry& summary, const std::string& group, const std::string& key) {
  return number_at(group.empty() ? summary : object_at(summary, group), key);
}

std::vector<Quantity> size_quantities() {
  const auto census = [](const char* key) {
    return [key](const JsonEntry& summary) { return count(entry(summary, "census", key)); };
  };
  return {{"Spacing", "", [](const JsonEntry& s) { return length(entry(s, "", "spacing")); }},
          {"Particles", "", census("particles")},
          {"Expected V/a³", "", census("expected_particles")},
          {"Springs", "", census("springs")},
          {"Cells", "", census("cells")},
          {"Boundary particles", "", census("boundary_particles")},
          {"Ligaments", "", census("ligaments")},
          {"Mass against ρV", "", [](const JsonEntry& s) {
             return percent(entry(s, "census", "mass") / entry(s, "census", "exact_mass") - 1.0);
           }}};
}

std::vector<Quantity> time_quantities() {
  const auto seconds = [](const char* group, const char* key) {
    return [group, key](const JsonEntry& summary) {
      return with_prefix(entry(summary, group, key), "s");
    };
  };
  const auto plain_number = [](const char* group, const char* key, int digits) {
    return
        [group, key, digits](const JsonEntry& s) { return number(entry(s, group, key), digits); };
  };
  const auto steps = [](const JsonEntry& s) {
    return count(std::round(entry(s, "", "simulated_time") / entry(s, "step", "step")));
  };
  return {
      {"ω₀ = √(2k/m)", "the paper's estimate, rad/s", plain_number("step", "omega0", 4)},
      {"1/ω₀", "the paper's bound", seconds("step", "paper_bound")},
      {"Spectral bound", "largest stable step", seconds("step", "spectral_bound")},
      {"Step used", "", seconds("step", "step")},
      {"Steps", "", steps},
      {"Simulated time", "", seconds("", "simulated_time")},
      {"Wall time", "of the run that computed it", seconds("", "wall_time")},
      {"Threads", "then", plain_number("", "threads", 4)},
      {"Real-time factor", "above 1: faster than real time",
       plain_number("", "real_time_factor", 3)},
      {"Momentum defect", "rod, tip and plane, relative", plain_number("", "momentum_defect", 2)}};
}

Table lattice_table(const RunData& run) {
  Table table;
  table.caption = "Size, time step and cost of the lattices.";
  table.header = {plain("Lattice")};
  for (const ModelData& model : run.models) {
    if (model.summary.empty()) continue;
    table.header.push_back(plain(model_label(model.name), text_at(model.summary, "kinematics")));
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

std::vector<MeshRow> problem_rows(const JsonEntry& summary) {
  const auto number_of = [&](const char* key, int digits) {
    return number(number_at(summary, key), digits);
  };
  const std::string law = text_at(summary, "law");
  return {{plain("Status"), text_at(summary, "status")},
          {plain("Contact"), text_at(summary, "contact")},
          {plain("Strain"), text_at(summary, "strain") + (law.empty() ? "" : ", law " + law)},
          {plain("Polynomial degree"), number_of("degree", 1)},
          {plain("Volumetric part", "of the energy"), text_at(summary, "volumetric")},
          {plain("Linear solver"), text_at(summary, "solver")},
          {plain("Processes"), count(number_at(summary, "ranks"))},
          {plain("Wanted force error"), percent_magnitude(number_at(summary, "tolerance"))},
          {plain("Wall time", "of all meshes"), with_prefix(number_at(summary, "wall_time"), "s")},
          {plain("Peak memory", "of one process"),
           with_prefix(number_at(summary, "peak_memory"), "B")}};
}

std::vector<MeshRow> mesh_rows(const JsonEntry& summary) {
  const JsonEntry first = object_at(summary, "mesh");
  const double volume = number_at(first, "volume");
  return {
      {plain("Cells", "finest mesh"), count(number_at(summary, "cells"))},
      {plain("Degrees of freedom", "finest mesh"), count(number_at(summary, "dofs"))},
      {plain("Of these in the contact zone"), count(number_at(summary, "contact_unknowns"))},
      {plain("Hexahedra", "first mesh"), count(number_at(first, "hexahedra"))},
      {plain("Smallest scaled Jacobian", "first mesh; 1 for a cube"),
       number(number_at(first, "min_scaled_jacobian"), 3)},
      {plain("Smallest Jacobian", "first mesh, m³"), number(number_at(first, "min_jacobian"), 3)},
      {plain("Volume", "first mesh: straight-sided elements, meshed sector"),
       std::isfinite(volume) ? number(volume * std::pow(shown_units().length.factor, 3)) + gap +
                                   unit_name(shown_units().length) + "³"
                             : ""}};
}

Table mesh_table(const RunData& run) {
  Table table;
  table.caption = "The continuum's problem, mesh and cost.";
  table.header = {plain("Continuum"), plain("Value")};
  for (const std::vector<MeshRow>& rows :
       {problem_rows(run.reference_summary), mesh_rows(run.reference_summary)}) {
    for (const auto& [label, value] : rows) {
      // Runs of other programs, modes or versions do not tell everything.
      if (!value.empty() && value != "–") table.rows.push_back({label, plain(value)});
    }
  }
  return table;
}

/// A list of words as one line, anything else as text_at.
std::string words_at(const JsonEntry& object, const std::string& key) {
  if (!object.at(key).is_list()) return text_at(object, key);
  std::string line;
  for (const JsonEntry& word : array_at(object, key))
    line += (line.empty() ? "" : " ") + word.text();
  return line;
}

/// name → value of a JSON object as rows of a table.
void add_rows(Table& table, const JsonEntry& object, const std::string& prefix) {
  for (const auto& [key, value] : object.members()) {
    Cell cell = plain(value.text());
    cell.words = true;
    table.rows.push_back({plain(prefix + key), cell});
  }
}

}  // namespace

Chapter cost_chapter(const RunData& run) {
  Chapter chapter{"cost", "Time step, cost and quality", {}};
  const Table lattices = lattice_table(run);
  if (lattices.header.size() > 1) chapter.blocks.push_back(lattices);
  for (const ModelData& model : run.models) {
    const std::string explanation = text_at(object_at(model.summary, "step"), "explanation");
    if (!explanation.empty())
      chapter.blocks.push_back(Paragraph{fmt::format("Step of {}.", model.name), explanation});
  }
  if (!run.reference_summary.empty()) chapter.blocks.push_back(mesh_table(run));
  return chapter;
}

Chapter provenance_chapter(const RunData& run) {
  Chapter chapter{"provenance", "Provenance", {}};
  Table table;
  table.caption = "What made these numbers, from manifest.json.";
  table.header = {plain("Entry"), plain("Value")};
  for (const char* key :
       {"version", "source_hash", "input_hash", "command", "command_line", "started", "finished"}) {
    Cell cell = plain(words_at(run.manifest, key));
    cell.words = true;
    if (!cell.text.empty()) table.rows.push_back({plain(key), cell});
  }
  add_rows(table, object_at(run.manifest, "host"), "host: ");
  add_rows(table, object_at(run.manifest, "packages"), "");
  if (!table.rows.empty()) chapter.blocks.push_back(std::move(table));
  if (!run.parameters.empty()) {
    chapter.blocks.push_back(Paragraph{
        "To reproduce:",
        fmt::format(
            "take parameters.toml from this folder (below) and run `fingertip {} --config "
            "parameters.toml`; every value that went into the run is in it. The curves, traces "
            "and fields in the subfolders are the data behind the figures.",
            run.verb)});
    chapter.blocks.push_back(Listing{"parameters.toml", run.parameters});
  }
  return chapter;
}

}  // namespace fingertip::studies::reporting
