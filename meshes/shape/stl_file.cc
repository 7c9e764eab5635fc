#include "meshes/shape/stl_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <numeric>
#include <ostream>
#include <vector>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline shape {
namespace {

constexpr std::size_t title_letters = 80;

template <typename Number>
void put(std::ostream& out, Number number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof number);
}

void write_bytes(const TriangleMesh& mesh, double unit, const std::string& title,
                 std::ostream& out) {
  std::string head = title;
  head.resize(title_letters, ' ');
  out << head;
  put(out, std::uint32_t(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int d = 0; d < 3; ++d) put(out, 0.0F);  // readers find the normal themselves
    for (std::size_t c = 0; c < 3; ++c)
      for (const double x : mesh.corner(t, c)) put(out, float(x / unit));
    put(out, std::uint16_t(0));
  }
}

void write_text(const TriangleMesh& mesh, double unit, std::ostream& out) {
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t t) { return mesh.faces[t]; });
  const auto name_of = [&](int face) {
    return face < 0 ? "" : " " + mesh.face_names[std::size_t(face)];
  };
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int face = mesh.faces[order[i]];
    if (i == 0 || face != mesh.faces[order[i - 1]]) out << "solid" << name_of(face) << '\n';
    out << "facet normal 0 0 0\nouter loop\n";
    for (std::size_t c = 0; c < 3; ++c) {
      out << "vertex";
      for (const double x : mesh.corner(order[i], c)) {
        char digits[32] = " ";
        const auto end = std::to_chars(digits + 1, digits + sizeof digits, float(x / unit));
        out.write(digits, end.ptr - digits);
      }
      out << '\n';
    }
    out << "endloop\nendfacet\n";
    if (i + 1 == order.size() || face != mesh.faces[order[i + 1]])
      out << "endsolid" << name_of(face) << '\n';
  }
}

}  // namespace

void write_stl(const TriangleMesh& mesh, double unit, const std::string& title,
               const std::filesystem::path& file) {
  write_atomically(file, [&](std::ostream& out) {
    if (mesh.face_names.empty())
      write_bytes(mesh, unit, title, out);
    else
      write_text(mesh, unit, out);
  });
}

}  // namespace fingertip::meshes::inline shape
