/// What a table of natural vibrations tells about their shapes.
#pragma once

#include <string>
#include <vector>

#include "meshes/csv_table.h"

namespace fingertip::studies {

/// The kind of motion per row of a modes.csv in words, of the lattice's own (`motion`) or from the
/// continuum's `symmetry` and `multiplicity`: shapes that are alike around the axis (multiplicity
/// 1) twist when antisymmetric about both planes; pairs have an odd number of waves around the axis
/// when the two planes differ, sideways being one wave, and an even number otherwise. "" where the
/// table tells neither. Throws InvalidInput for damaged cells.
std::vector<std::string> mode_motions(const meshes::CsvTable& modes);

}  // namespace fingertip::studies
