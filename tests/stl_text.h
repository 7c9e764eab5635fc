/// Triangles as STL files, for tests.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "meshes/shape/triangle_mesh.h"

/// In millimetres.
inline std::string stl_text(const fingertip::meshes::TriangleMesh& mesh) {
  std::string text = "solid finger\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (std::size_t c = 0; c < 3; ++c) {
      char line[128];
      const auto w = 1e3 * mesh.corner(t, c);
      std::snprintf(line, sizeof line, "   vertex %.9g %.9g %.9g\n", w.x(), w.y(), w.z());
      text += line;
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid finger\n";
}

/// The same in the binary format.
inline std::string stl_bytes(const fingertip::meshes::TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](auto number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  put(std::uint32_t(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int d = 0; d < 3; ++d) put(0.0F);
    for (std::size_t c = 0; c < 3; ++c)
      for (Eigen::Index d = 0; d < 3; ++d) put(float(1e3 * mesh.corner(t, c)[d]));
    put(std::uint16_t(0));
  }
  return bytes;
}
