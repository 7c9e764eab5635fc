/// A skin of taxels as people give it (section [sensor]).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

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

/// The taxels on a finger, and their footprint. Of a file, which has a row per taxel, `x [UNIT],
/// y [UNIT],z [UNIT]` and maybe `area [UNIT]`, any units of length and area; without an area a
/// taxel stands for its footprint. Separators: read_profile. Throws InvalidInput: meshes::taxel_at
/// with file and line, all of them; meshes::taxel_rings.
void lay_taxels(const TaxelLayout& layout, const meshes::Geometry& finger, meshes::TaxelSkin& skin);

}  // namespace fingertip::studies::inline config::inline shapes
