#include "meshes/stl_file.h"

#include <cstdint>
#include <ostream>

#include "meshes/files.h"

namespace fingertip::meshes {
namespace {

constexpr std::size_t title_letters = 80;

template <typename Number>
void put(std::ostream& out, Number number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

void write_stl(const TriangleMesh& mesh, double unit, const std::string& title,
               const std::filesystem::path& file) {
  write_atomically(file, [&](std::ostream& out) {
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
  });
}

}  // namespace fingertip::meshes
