/// The text of VTK's XML files.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline presses::inline pictures::vtk {

/// VTK's numbers for kinds of cells.
inline constexpr std::uint8_t vertex = 1, line = 3, triangle = 5, quadrangle = 9, tetrahedron = 10;

/// First lines of a file, `type` is UnstructuredGrid or Collection.
std::string file_head(const char* type);

/// An array in VTK's inline binary format: its size in bytes as UInt64, then the numbers.
std::string data_array(const char* type, const char* name, int components,
                       const std::string& numbers);

/// A vector per point, in single precision.
std::string vectors(const char* name, const std::vector<meshes::Vector3>& values);

/// A number per point or cell; `type` is VTK's name for Number.
template <class Number>
std::string scalars(const char* type, const char* name, const std::vector<Number>& values) {
  std::string numbers(values.size() * sizeof(Number), '\0');
  if (!values.empty()) std::memcpy(numbers.data(), values.data(), numbers.size());
  return data_array(type, name, 1, numbers);
}

/// One tuple of numbers for the whole file.
std::string field(const char* name, const std::vector<double>& values);

/// "frame_0000.vtu"
std::string frame_name(std::size_t frame);

/// Writes a .pvd that lists frame_0000.vtu, ... beside it with their times [s].
void write_series(const std::filesystem::path& file, const std::vector<double>& times);

}  // namespace fingertip::studies::inline presses::inline pictures::vtk
