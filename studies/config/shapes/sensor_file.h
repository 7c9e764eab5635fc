/// Taxels and markers as people give them (section [sensor]).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "meshes/press/markers.h"
#include "meshes/press/taxels.h"
#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline config::inline shapes {

/// Where the taxels are; rings, a file, or no skin.
struct TaxelLayout {
  std::filesystem::path file = {};  ///< absolute; empty for none
  int rings = 0, per_ring = 0;      ///< of a table that names one, the other's usual number
  std::optional<double> pitch = {}, footprint = {};  ///< [m]; empty: a tenth of the finger's radius

  bool has_skin() const { return !file.empty() || rings > 0 || per_ring > 0; }
};

/// Where the markers are; a file, a grid, or none.
struct MarkerLayout {
  std::filesystem::path file = {};   ///< absolute; "grid" and empty for a grid and none
  std::optional<double> pitch = {};  ///< [m]; empty: a tenth of the finger's radius
  double depth = 0.0;                ///< of a grid below the surface [m], >= 0
};

/// Of a file: a row per place, `x [UNIT],y [UNIT],z [UNIT]`, any units of length. Separators:
/// read_profile. Faults of rows are refused with file and line, all of them, and so are two rows of
/// one place.
///
/// The taxels on a finger, and their footprint; a file may have `area [UNIT]`, without which a
/// taxel stands for its footprint. Throws InvalidInput: meshes::taxel_at, meshes::taxel_rings.
void lay_taxels(const TaxelLayout& layout, const meshes::Geometry& finger, meshes::TaxelSkin& skin);

/// The markers in a finger [m]. Throws InvalidInput: meshes::marker_at, meshes::marker_grid.
std::vector<meshes::Vector3> lay_markers(const MarkerLayout& layout,
                                         const meshes::Geometry& finger);

}  // namespace fingertip::studies::inline config::inline shapes
