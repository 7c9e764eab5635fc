/// The rules that the compiler does not enforce, checked on the source text.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace architecture {

/// One broken rule, "file:line: what is wrong" (line 0 for a whole file).
struct Finding {
  std::string file;  ///< relative to the source folder; a unit or a room where that is at fault
  int line = 0;
  std::string what;
};

std::string to_string(const Finding& finding);

/// Rooms of tests/architecture/rooms.txt, lowest first.
std::vector<std::string> room_names(const std::filesystem::path& source);

/// Rooms use rooms of lines above their own alone; every room has a README.md, and so has tests;
/// every source stands in the folder of a room.
std::vector<Finding> check_table(const std::filesystem::path& source);

/// Includes between rooms that the table does not have.
std::vector<Finding> check_include_arrows(const std::filesystem::path& source);

/// Units (a header with its source, or either alone) that include each other in a circle, with one
/// finding for all units that reach each other.
std::vector<Finding> check_circles(const std::filesystem::path& source);

/// Every file opens the namespace of its folder (`lattice/model`: fingertip::lattice::model, where
/// a room's may be inline) and no other of the project; a program's main and headers for C need
/// none. One finding for all files of a room that open the same other namespace.
std::vector<Finding> check_namespaces(const std::filesystem::path& source);

/// The table's arrows between the libraries that the rooms' CMakeLists.txt link; and the gmsh
/// mesher is linked by fem_reference alone.
std::vector<Finding> check_link_arrows(const std::filesystem::path& source);

/// Heavy packages where they do not belong: deal.II outside fem_reference or in one of its headers
/// that the application reaches, Ceres outside calibration's sources, gmsh and CGAL outside their
/// sources in meshes, and the mesher's headers outside fem_reference.
std::vector<Finding> check_packages(const std::filesystem::path& source);

/// Every header starts with a /// comment and has #pragma once; no source is longer than 600 lines.
std::vector<Finding> check_form(const std::filesystem::path& source);

}  // namespace architecture
