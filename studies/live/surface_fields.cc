#include "studies/live/surface_fields.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline live {

using meshes::Vector3;

namespace {

/// Larger arrays than this are no surface to look at [bytes].
constexpr std::size_t max_bytes = 512UL << 20U;
constexpr int vtk_hexahedron = 12;

[[noreturn]] void refuse(const std::string& file, const std::string& rule) {
  throw meshes::InvalidInput({file, "", rule, "give a run of `fingertip reference`"});
}

/// Base64 (RFC 4648) until padding or the end.
std::string decode_base64(std::string_view text) {
  std::string padded(
      text.substr(0, std::min(text.find('='), text.find_last_not_of(" \n\r\t") + 1)));
  const std::size_t bytes = padded.size() * 3 / 4;
  padded.resize((padded.size() + 3) / 4 * 4, 'A');
  std::string decoded(padded.size() / 4 * 3, '\0');
  if (EVP_DecodeBlock(reinterpret_cast<unsigned char*>(decoded.data()),
                      reinterpret_cast<const unsigned char*>(padded.data()),
                      int(padded.size())) < 0)
    return {};
  decoded.resize(bytes);
  return decoded;
}

template <class Number>
std::vector<Number> numbers_in(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty())  // else there is no address to copy to
    std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

/// The arrays of one file.
class VtuFile {
 public:
  explicit VtuFile(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream in(file, std::ios::binary);
    // Reading a folder throws.
    if (!in || !std::filesystem::is_regular_file(file)) refuse(name_, "the file cannot be read");
    text_.assign(std::istreambuf_iterator<char>(in), {});
    if (text_.find("type=\"UnstructuredGrid\"") == std::string::npos ||
        text_.find("byte_order=\"LittleEndian\"") == std::string::npos) {
      refuse(name_, "this is no little-endian unstructured grid in VTK's XML format");
    }
    compressed_ = text_.find("compressor=\"vtkZLibDataCompressor\"") != std::string::npos;
  }

  /// The array whose element after `section` has the attributes given.
  template <class Number>
  std::vector<Number> array(const char* section, const std::string& type, const std::string& name) {
    std::size_t at = text_.find(section);
    while (at != std::string::npos) {
      at = text_.find("<DataArray", at);
      if (at == std::string::npos) break;
      const std::size_t end = text_.find('>', at);
      if (end == std::string::npos) break;
      const std::string_view element(text_.data() + at, end - at);
      const bool wanted = name.empty() || has(element, "Name=\"" + name + '"');
      if (wanted && has(element, "type=\"" + type + '"') && has(element, "format=\"binary\""))
        return numbers_in<Number>(content(end + 1));
      at = end;
    }
    refuse(name_, "the file holds no binary array " + (name.empty() ? "of points" : name));
  }
  const std::string& name() const { return name_; }

 private:
  static bool has(std::string_view element, const std::string& attribute) {
    return element.find(attribute) != std::string_view::npos;
  }

  std::string content(std::size_t begin) const {
    const std::size_t first = text_.find_first_not_of(" \n\r\t", begin);
    const std::size_t end = std::min(text_.find('<', begin), text_.size());
    if (first == std::string::npos || first >= end) refuse(name_, "an array is empty");
    const std::string_view encoded(text_.data() + first, end - first);
    if (compressed_) return inflated(encoded);
    const std::string bytes = decode_base64(encoded);
    if (bytes.size() < 4) refuse(name_, "an array is empty");
    return bytes.substr(4);  // behind its length
  }

  /// Header [blocks, size of a block, size of the last one or 0, compressed sizes ...] of uint32
  /// and then the blocks, each of both in base64 with a padding of its own.
  std::string inflated(std::string_view encoded) const {
    const auto count = numbers_in<std::uint32_t>(decode_base64(encoded.substr(0, 8)));
    if (count.empty() || count[0] > max_bytes / 64) refuse(name_, "an array's header is damaged");
    const std::size_t header_bytes = 4 * (3 + std::size_t(count[0]));
    const std::size_t header_text = (header_bytes + 2) / 3 * 4;
    if (header_text > encoded.size()) refuse(name_, "an array's header is damaged");
    const auto header = numbers_in<std::uint32_t>(decode_base64(encoded.substr(0, header_text)));
    if (header.size() < 3 + std::size_t(count[0])) refuse(name_, "an array's header is damaged");
    const std::string packed = decode_base64(encoded.substr(header_text));
    std::string bytes;
    std::size_t at = 0;
    for (std::size_t block = 0; block < count[0]; ++block) {
      const bool last = block + 1 == count[0] && header[2] != 0;
      uLongf size = last ? header[2] : header[1];
      const std::size_t from = bytes.size();
      if (from + size > max_bytes || at + header[3 + block] > packed.size())
        refuse(name_, "an array is cut off");
      bytes.resize(from + size);
      const int result =
          uncompress(reinterpret_cast<Bytef*>(bytes.data() + from), &size,
                     reinterpret_cast<const Bytef*>(packed.data() + at), header[3 + block]);
      if (result != Z_OK) refuse(name_, "an array is damaged");
      at += header[3 + block];
    }
    return bytes;
  }

  std::string name_, text_;
  bool compressed_ = false;
};

std::vector<Vector3> vectors_from(const std::vector<float>& numbers) {
  std::vector<Vector3> vectors;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return vectors;
}

/// Numbers points so that those within 1e-7 of the tip's size coincide.
std::vector<std::uint32_t> joined(const std::vector<Vector3>& points, double size,
                                  std::vector<std::uint32_t>& kept) {
  std::map<std::array<long, 3>, std::uint32_t> seen;
  std::vector<std::uint32_t> number(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<long, 3> key{};
    for (std::size_t k = 0; k < 3; ++k)
      key[k] = std::lround(points[i][Eigen::Index(k)] / (1e-5 * size));
    const auto [place, fresh] = seen.emplace(key, std::uint32_t(kept.size()));
    if (fresh) kept.push_back(std::uint32_t(i));
    number[i] = place->second;
  }
  return number;
}

/// Corners of a VTK hexahedron's faces, in turn around each.
constexpr std::array<std::array<unsigned, 4>, 6> faces{
    {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 3, 7, 4}, {1, 2, 6, 5}}};

/// Whether all of the mesh lies on one side of the plane through 0 across `axis`.
bool ends_at_symmetry_plane(const SurfaceMesh& mesh, Eigen::Index axis) {
  double least = 0.0, most = 0.0;
  for (const Vector3& p : mesh.rest) {
    least = std::min(least, p[axis]);
    most = std::max(most, p[axis]);
  }
  return std::min(-least, most) <= 1e-3 * std::max(-least, most);
}

void add_mirror_image(SurfaceMesh& mesh, Eigen::Index axis) {
  const std::size_t points = mesh.rest.size(), edges = mesh.edges.size();
  Vector3 mirror = Vector3::Ones();
  mirror[axis] = -1.0;
  for (std::size_t i = 0; i < points; ++i) {
    mesh.rest.push_back(mesh.rest[i].cwiseProduct(mirror));
    mesh.displacement.push_back(mesh.displacement[i].cwiseProduct(mirror));
  }
  for (std::size_t e = 0; e < edges; ++e) {
    const auto [i, j] = mesh.edges[e];
    mesh.edges.push_back({i + std::uint32_t(points), j + std::uint32_t(points)});
  }
}

}  // namespace

HexahedralField read_vtu(const std::filesystem::path& path) {
  VtuFile file(path);
  HexahedralField field;
  field.points = vectors_from(file.array<float>("<Points>", "Float32", ""));
  field.displacement = vectors_from(file.array<float>("<PointData", "Float32", "displacement"));
  const auto corners = file.array<std::int32_t>("<Cells>", "Int32", "connectivity");
  const auto types = file.array<std::uint8_t>("<Cells>", "UInt8", "types");
  const bool hexahedra =
      std::ranges::all_of(types, [](std::uint8_t type) { return type == vtk_hexahedron; });
  if (!hexahedra || corners.size() != 8 * types.size())
    refuse(file.name(), "the cells must be hexahedra");
  if (field.displacement.size() != field.points.size())
    refuse(file.name(), "every point needs a displacement");
  const auto finite = [](const Vector3& vector) { return vector.allFinite(); };
  if (!std::ranges::all_of(field.points, finite) ||
      !std::ranges::all_of(field.displacement, finite))
    refuse(file.name(), "places and displacements must be finite");
  for (std::size_t i = 0; i < corners.size(); i += 8) {
    std::array<std::uint32_t, 8> cell{};
    for (std::size_t k = 0; k < 8; ++k) {
      if (corners[i + k] < 0 || std::size_t(corners[i + k]) >= field.points.size())
        refuse(file.name(), "a cell names a point that does not exist");
      cell[k] = std::uint32_t(corners[i + k]);
    }
    field.cells.push_back(cell);
  }
  return field;
}

SurfaceMesh outer_surface(const HexahedralField& field) {
  double radius = 0.0;
  for (const Vector3& p : field.points)
    radius = std::max(radius, meshes::Geometry::radial_distance(p));
  std::vector<std::uint32_t> kept;
  const std::vector<std::uint32_t> number = joined(field.points, radius, kept);

  std::map<std::array<std::uint32_t, 4>, std::array<std::uint32_t, 4>> open;
  for (const auto& cell : field.cells) {
    for (const auto& face : faces) {
      std::array<std::uint32_t, 4> corners{};
      for (std::size_t k = 0; k < 4; ++k) corners[k] = number[cell[face[k]]];
      std::array<std::uint32_t, 4> key = corners;
      std::ranges::sort(key);
      if (const auto [place, fresh] = open.emplace(key, corners); !fresh) open.erase(place);
    }
  }
  SurfaceMesh surface;
  std::map<std::uint32_t, std::uint32_t> of_surface;
  const auto name = [&](std::uint32_t point) {
    const auto [place, fresh] = of_surface.emplace(point, std::uint32_t(surface.rest.size()));
    if (fresh) {
      surface.rest.push_back(field.points[kept[point]]);
      surface.displacement.push_back(field.displacement[kept[point]]);
    }
    return place->second;
  };
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const auto& [key, corners] : open) {
    const bool outside = std::ranges::all_of(corners, [&](std::uint32_t c) {
      return meshes::Geometry::radial_distance(field.points[kept[c]]) > (1.0 - 1e-3) * radius;
    });
    if (!outside) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t i = name(corners[k]), j = name(corners[(k + 1) % 4]);
      edges.insert({std::min(i, j), std::max(i, j)});
    }
  }
  surface.edges.assign(edges.begin(), edges.end());
  return surface;
}

SurfaceMesh completed(const SurfaceMesh& part) {
  SurfaceMesh whole = part;
  for (const Eigen::Index axis : {0, 1}) {
    if (ends_at_symmetry_plane(whole, axis)) add_mirror_image(whole, axis);
  }
  return whole;
}

}  // namespace fingertip::studies::inline live
