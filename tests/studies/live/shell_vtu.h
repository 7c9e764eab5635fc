/// A .vtu as deal.II writes it, of part of a shell about z.
#pragma once

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "meshes/shape/geometry.h"

/// Hexahedra that share no points, from angle 0 on, `eighths` of half a turn; radii 0.5 and 1;
/// displaced by a linear field.
class ShellVtu {
 public:
  explicit ShellVtu(int eighths = 8) {
    for (int i = 0; i < eighths; ++i)
      for (int j = 0; j < 3; ++j) add_cell(i, j);
  }

  /// Arrays compressed by zlib in one block, or plain.
  std::string text(bool compressed = true) const {
    const auto array = [&](const std::string& attributes, const std::string& bytes) {
      return "<DataArray " + attributes + " format=\"binary\">\n" +
             (compressed ? packed(bytes) : plain(bytes)) + "\n</DataArray>\n";
    };
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" " +
           std::string(compressed ? "compressor=\"vtkZLibDataCompressor\" " : "") +
           "byte_order=\"LittleEndian\">\n<Points>\n" +
           array("type=\"Float32\" NumberOfComponents=\"3\"", raw(points_)) +
           "</Points>\n<Cells>\n" + array("type=\"Int32\" Name=\"connectivity\"", raw(corners_)) +
           array("type=\"Int32\" Name=\"offsets\"", raw(offsets_)) +
           array("type=\"UInt8\" Name=\"types\"", raw(types_)) + "</Cells>\n<PointData>\n" +
           array("type=\"Float32\" Name=\"displacement\" NumberOfComponents=\"3\"", raw(moved_)) +
           "</PointData>\n</VTKFile>\n";
  }

 private:
  void add_cell(int i, int j) {
    constexpr int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int corner = 0; corner < 8; ++corner) {
      const int* at = around[corner % 4];
      const double radius = corner < 4 ? 0.5 : 1.0, angle = M_PI * (i + at[0]) / 8.0;
      const fingertip::meshes::Vector3 p(radius * std::cos(angle), radius * std::sin(angle),
                                         -0.2 * (j + at[1]));
      const fingertip::meshes::Vector3 u(0.1 * p.z(), -0.1 * p.x(), 0.1 * p.y());
      for (int c = 0; c < 3; ++c) {
        points_.push_back(float(p[c]));
        moved_.push_back(float(u[c]));
      }
      corners_.push_back(std::int32_t(corners_.size()));
    }
    offsets_.push_back(std::int32_t(corners_.size()));
    types_.push_back(12);
  }

  template <class Number>
  static std::string raw(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
  }

  static std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      unsigned group = 0;
      for (std::size_t k = 0; k < 3; ++k)
        group = (group << 8U) | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0U);
      for (unsigned k = 0; k < 4; ++k)
        text += i + k > bytes.size() ? '=' : digits[(group >> (18U - 6U * k)) & 63U];
    }
    return text;
  }

  static std::string plain(const std::string& bytes) {
    return base64(raw(std::vector<std::uint32_t>{std::uint32_t(bytes.size())}) + bytes);
  }

  static std::string packed(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string block(size, '\0');
    compress(reinterpret_cast<Bytef*>(block.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    block.resize(size);
    const std::vector<std::uint32_t> header = {1, std::uint32_t(bytes.size()),
                                               std::uint32_t(bytes.size()), std::uint32_t(size)};
    return base64(raw(header)) + base64(block);
  }

  std::vector<float> points_, moved_;
  std::vector<std::int32_t> corners_, offsets_;
  std::vector<std::uint8_t> types_;
};
