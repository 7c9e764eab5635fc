#include "studies/files/mode_table.h"

#include <algorithm>

#include "fem_reference/job/run_tables.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/run_tables.h"

namespace fingertip::studies::inline files {

namespace {

std::string motion_of(const std::string& symmetry, int multiplicity) {
  if (multiplicity == 1) return symmetry == "AA" ? "torsion" : "along the axis, breathing";
  if (symmetry == "SA" || symmetry == "AS") return "sideways (an odd number of waves)";
  return symmetry.empty() ? "" : "an even number of waves";
}

/// It has a column that no lattice has.
bool is_of_continuum(const meshes::CsvTable& table) {
  return std::ranges::any_of(
      meshes::column_names<fem_reference::ModeRow>(), [&](const std::string& name) {
        const auto lattice = meshes::column_names<LatticeModeRow>();
        return table.has(name) && std::ranges::find(lattice, name) == lattice.end();
      });
}

}  // namespace

std::vector<VibrationMode> vibration_modes(const meshes::CsvTable& table) {
  std::vector<VibrationMode> modes;
  if (is_of_continuum(table)) {
    for (const auto& row : meshes::rows_of<fem_reference::ModeRow>(table))
      modes.push_back({row.mode, row.frequency, row.frequency_error,
                       motion_of(row.symmetry, row.multiplicity)});
  } else {
    for (const auto& row : meshes::rows_of<LatticeModeRow>(table))
      modes.push_back(
          {row.mode, row.frequency, meshes::unknown, row.motion, true, row.mass, row.inertia});
  }
  return modes;
}

}  // namespace fingertip::studies::inline files
