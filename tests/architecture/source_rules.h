/// The rules that the compiler does not enforce, checked on the source text.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace architecture {

/// One broken rule, "file:line: what is wrong" (line 0 for a whole file).
struct Finding {
  std::string file;  ///< relative to the source folder
  int line = 0;
  std::string what;
};

std::string to_string(const Finding& finding);

/// Includes between rooms other than lattice → meshes, fem_reference → meshes,
/// calibration → {lattice, meshes}, studies → all, and those between the rooms of lattice.
std::vector<Finding> check_include_arrows(const std::filesystem::path& source);

/// The same arrows between the libraries that the rooms' CMakeLists.txt link; and the gmsh mesher
/// is linked by fem_reference alone.
std::vector<Finding> check_link_arrows(const std::filesystem::path& source);

/// Heavy packages where they do not belong: deal.II outside fem_reference or in one of its headers
/// that the application reaches, Ceres outside calibration's sources, gmsh outside
/// its three sources in meshes, CGAL outside meshes/triangle_tree.cc, and the mesher's header
/// outside fem_reference.
std::vector<Finding> check_packages(const std::filesystem::path& source);

/// Headers of the rooms that include each other in a circle.
std::vector<Finding> check_header_cycles(const std::filesystem::path& source);

/// Every header starts with a /// comment and has #pragma once; every file opens only its own
/// room's namespace, and at least that unless it is a program's main; none is longer than 600
/// lines, and none stands in the root of a room that has rooms of its own.
std::vector<Finding> check_form(const std::filesystem::path& source);

/// Every room, and tests, has a README.md.
std::vector<Finding> check_readmes(const std::filesystem::path& source);

}  // namespace architecture
