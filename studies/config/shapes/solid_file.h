/// The file of a solid (keys geometry.file, unit and bond).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "meshes/shape/solid.h"

namespace fingertip::studies::inline config::inline shapes {

/// What the keys say.
struct SolidFile {
  std::filesystem::path file;  ///< absolute; .stl, .step, .brep, or a meridian's .csv
  std::string unit = "mm";     ///< of length, of the file's numbers; STEP and CSV have their own
  std::string bond;            ///< "z < 1 mm and x > 0 mm or ...", or names of faces
  std::string up = "+z";       ///< the file's direction that becomes +z, as "-y"
  /// The place in the file that becomes the origin [m]. `touch`: instead the one on the finger's
  /// axis below what is highest.
  meshes::Vector3 origin = meshes::Vector3::Zero();
  bool touch = false;

  bool operator==(const SolidFile&) const = default;
};

/// By its name: .stl, .step, .stp, .brep, .brp.
bool is_solid_file(const std::filesystem::path& file);

/// Refuses what is neither such a file nor a meridian's .csv (geometry.file).
void check_kind_of_solid(const std::filesystem::path& file);

/// Triangles of an STL file, binary or ASCII, with the corners of each facet as they stand there,
/// in the file's unit; the solids of a text that have a name are its faces. Throws InvalidInput
/// with the line, or the facet, that cannot be read.
meshes::TriangleMesh read_stl(const std::filesystem::path& file);

/// What a Solid holds.
struct Bond {
  meshes::Region region;
  std::vector<std::string> faces;
};

/// Half spaces `x|y|z <|> QUANTITY` joined by `and`, which binds closer, and `or`, by which names
/// of `faces` are joined, too; empty for an empty text. Throws InvalidInput (geometry.bond).
Bond parse_bond(const std::string& text, const std::vector<std::string>& faces = {});

/// Reads, turns, shifts and checks it; `bond` is told of where it stands then. Throws InvalidInput
/// (geometry.file, unit, bond or origin; see Solid).
std::shared_ptr<const meshes::Solid> read_solid(const SolidFile& solid);

}  // namespace fingertip::studies::inline config::inline shapes
