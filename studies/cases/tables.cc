#include "studies/cases/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <ostream>

#include "meshes/base/files.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/measures.h"
#include "studies/files/displacement_study.h"
#include "studies/files/run_tables.h"

namespace fingertip::studies::inline cases {

namespace {

using Text = std::function<std::string(const RunResult&)>;
using Number = std::function<double(const RunResult&, std::size_t depth)>;

/// A column holds texts or numbers.
struct Column {
  std::string name;
  Text text;
  Number number;

  std::string cell(const RunResult& result, std::size_t depth) const {
    return text ? meshes::csv_cell(text(result)) : meshes::to_text(number(result, depth));
  }
};

Column text(const char* name, Text cell) {
  return {name, std::move(cell), {}};
}

Column setting(const char* name, double (*value)(const lattice::LatticeSettings&)) {
  return {name, {}, [value](const RunResult& result, std::size_t) {
            return value(result.setup.lattice);
          }};
}

Column force(const char* name, std::vector<double> ForceComparison::*list) {
  return {name, {}, [list](const RunResult& result, std::size_t depth) {
            return (result.forces.*list)[depth];
          }};
}

double volume_defect(const RunResult& result, std::size_t) {
  const StaticCensusEntry& census = result.press.static_census;
  return census.volume / census.exact_volume - 1.0;
}

const std::vector<Column>& columns() {
  using R = const RunResult&;
  using L = const lattice::LatticeSettings&;
  static const std::vector<Column> all = {
      text("series", [](R r) { return r.run->series; }),
      text("name", [](R r) { return r.run->name; }),
      text("varied", [](R r) { return r.run->varied; }),
      text("fit", [](R r) { return r.fit == nullptr ? "" : r.fit->name; }),
      text("prediction", [](R r) { return r.run->name; }),
      text("model", [](R r) { return std::string(lattice::name(r.setup.lattice.model)); }),
      text("kinematics",
           [](R r) { return std::string(lattice::name(r.setup.lattice.kinematics)); }),
      text("contact", [](R r) { return std::string(meshes::name(r.setup.protocol.contact)); }),
      text("continuum", [](R r) { return r.against; }),
      text("status", [](R r) { return r.status; }),
      {"x", {}, [](R r, std::size_t) { return r.run->x; }},
      {"poissons_ratio", {}, [](R r, std::size_t) { return r.setup.rubber.poissons_ratio(); }},
      {"volume_defect", {}, volume_defect},
      {"wall_time [s]", {}, [](R r, std::size_t) { return r.press.wall_time; }},
      setting("spacing [m]", [](L l) { return l.spacing; }),
      setting("offset_x", [](L l) { return l.offset.x(); }),
      setting("offset_y", [](L l) { return l.offset.y(); }),
      setting("offset_z", [](L l) { return l.offset.z(); }),
      setting("ligament_stiffness", [](L l) { return l.ligament_stiffness; }),
      force("indentation [m]", &ForceComparison::depth),
      force("normal_force [N]", &ForceComparison::force),
      force("reference_force [N]", &ForceComparison::reference_force),
      force("reference_error", &ForceComparison::reference_error),
      force("relative_error", &ForceComparison::error)};
  return all;
}

void write_table(const std::vector<std::string>& heads, const Members& rows,
                 const std::filesystem::path& file) {
  if (rows.empty()) return;
  std::string text = fmt::format("{}\n", fmt::join(heads, ","));
  for (const RunResult* result : rows) {
    for (std::size_t depth = 0; depth < result->forces.depth.size(); ++depth) {
      std::vector<std::string> cells;
      for (const std::string& head : heads)
        cells.push_back(std::ranges::find(columns(), head, &Column::name)->cell(*result, depth));
      text += fmt::format("{}\n", fmt::join(cells, ","));
    }
  }
  meshes::write_atomically(file, [&](std::ostream& out) { out << text; });
}

/// later.csv, where there is something to tell.
void write_later(const Members& variants, const std::filesystem::path& file) {
  std::vector<LaterRow> rows;
  for (const RunResult* result : variants)
    for (const LaterForce& later : result->forces.later)
      rows.push_back({result->run->series, result->run->name, result->against, later.stage,
                      later.time, later.indentation, later.force, later.reference_force,
                      later.error});
  if (!rows.empty()) meshes::write_rows(rows, file);
}

/// displacements.csv and distances.json, where any were measured.
void write_displacements(const RunResults& results, const std::filesystem::path& folder) {
  const std::vector<Displaced> all = displaced(members(results, "variant"));
  if (all.empty()) return;
  std::vector<DisplacementRow> rows;
  DisplacementStudy study{{}, scatter_at_rest(*all.front().measured), {}};
  for (const Displaced& each : all) {
    const MarkerFields fields = computed_fields(*each.measured, folder / each.folder);
    std::ranges::move(rows_of(*each.measured, *each.distances, fields, each.name),
                      std::back_inserter(rows));
    std::ranges::move(entries_of(*each.measured, *each.distances, each.name),
                      std::back_inserter(study.distances));
  }
  for (const RunResult* fit : members(results, "run"))
    if (std::isfinite(fit->ratio.poissons_ratio))
      study.poissons_ratios.push_back(ratio_entry(fit->ratio, fit->run->name, fit->folder));
  meshes::write_rows(rows, folder / "displacements.csv");
  meshes::write_json_file(study, folder / "distances.json");
}

}  // namespace

std::vector<std::string> table_columns() {
  std::vector<std::string> names;
  for (const Column& column : columns()) names.push_back(column.name);
  return names;
}

void write_tables(const Case& study_case, const RunResults& results,
                  const std::filesystem::path& folder) {
  write_table(meshes::column_names<VariantRow>(), members(results, "variant"),
              folder / "variants.csv");
  write_later(members(results, "variant"), folder / "later.csv");
  write_displacements(results, folder);
  write_table(meshes::column_names<TransferRow>(), members(results, "prediction"),
              folder / "transfer.csv");
  for (const CaseTable& table : study_case.tables)
    write_table(table.columns, members(results, "run", table.series), folder / table.file);
}

}  // namespace fingertip::studies::inline cases
