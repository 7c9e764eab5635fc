#include "studies/config/shapes/solid_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "studies/config/shapes/surface_cache.h"
#include "studies/config/text/trimmed.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config::inline shapes {
namespace {

namespace fs = std::filesystem;
using meshes::HalfSpace;
using meshes::InvalidInput;
using meshes::TriangleMesh;

constexpr std::size_t head_bytes = 84, facet_bytes = 50;
/// Beyond, the checks take minutes.
constexpr std::size_t max_facets = 2'000'000, max_names = 10'000;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return char(std::tolower(c)); });
  return lower;
}

[[noreturn]] void refuse_facets(std::size_t count) {
  throw InvalidInput({"geometry.file", std::to_string(count) + " facets",
                      "a surface has at most two million", "export it with fewer facets"});
}

template <typename Number>
Number number_at(const std::string& bytes, std::size_t place) {
  static_assert(std::endian::native == std::endian::little, "as the numbers of an STL file are");
  Number value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

void add_triangle(const std::array<meshes::Vector3, 3>& corners, TriangleMesh& mesh) {
  const int first = int(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

TriangleMesh binary_facets(const std::string& bytes, std::size_t count) {
  TriangleMesh mesh;
  for (std::size_t f = 0; f < count; ++f) {
    std::array<meshes::Vector3, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t d = 0; d < 3; ++d)
        corners[c][Eigen::Index(d)] =
            double(number_at<float>(bytes, head_bytes + facet_bytes * f + 12 + 12 * c + 4 * d));
    add_triangle(corners, mesh);
  }
  return mesh;
}

TriangleMesh text_facets(const fs::path& file, const std::string& text) {
  TriangleMesh mesh;
  std::istringstream lines(text);
  std::size_t number = 0, corner = 0;
  int face = -1;
  bool ended = false;
  std::array<meshes::Vector3, 3> corners;
  const auto refuse = [&](const std::string& rule, const std::string& remedy) {
    throw InvalidInput({file.string() + ":" + std::to_string(number), "", rule, remedy});
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(lower_case(line));
    std::string word;
    words >> word;
    if (word == "vertex") {
      if (corner == 3) refuse("a facet has three vertices", "export the surface as triangles");
      for (Eigen::Index d = 0; d < 3; ++d) {
        words >> word;
        double value = std::nan("");
        const char* const end = word.data() + word.size();
        const char* const start = word.data() + (word.starts_with('+') ? 1 : 0);
        const auto [rest, error] = std::from_chars(start, end, value);
        if (!words || error != std::errc() || rest != end)
          refuse("a vertex has three numbers", "write vertex X Y Z");
        corners[corner][d] = value;
      }
      ++corner;
    } else if (word == "endfacet") {
      if (corner != 3) refuse("a facet has three vertices", "export the surface as triangles");
      add_triangle(corners, mesh);
      mesh.faces.push_back(face);
      if (mesh.triangles.size() > max_facets) refuse_facets(mesh.triangles.size());
      corner = 0;
    } else if (word == "endsolid") {
      ended = true;
    } else if (word == "solid") {
      ended = false;
      face = mesh.face_number(std::string(trimmed(trimmed(line).substr(word.size()))));
      if (mesh.face_names.size() > max_names)
        refuse("at most ten thousand solids of a file have names", "leave the names out");
    } else if (word == "facet") {
      ended = false;
    } else if (!word.empty() && word != "outer" && word != "endloop") {
      refuse("no line of an STL file: " + word.substr(0, 20),
             "a line begins with solid, facet, outer loop, vertex, endloop, endfacet or endsolid");
    }
  }
  if (!ended || corner != 0) refuse("the file is cut off before its endsolid", "export it anew");
  return mesh;
}

using Names = std::vector<std::string>;

[[noreturn]] void refuse_bond(const std::string& part, const std::string& rule,
                              const Names& faces) {
  const char* no_face = "";
  if (std::ranges::find(faces, part) != faces.end())
    no_face = "faces are joined by or, never by and; ";
  else if (!part.empty() && part.find_first_of("<>") == std::string::npos)
    no_face =
        faces.empty() ? "the file names no faces, and " : "no face of the file has this name, and ";
  throw InvalidInput({"geometry.bond", part, no_face + rule,
                      "write half spaces joined by and, or, e.g. geometry.bond = \"z < 1 mm\"" +
                          meshes::or_faces(faces)});
}

HalfSpace parse_half_space(const std::string& text, const Names& faces) {
  HalfSpace space;
  const std::string_view whole = trimmed(text);
  const std::size_t axis =
      whole.empty() ? std::string::npos : std::string_view("xyz").find(whole.front());
  if (axis == std::string::npos) refuse_bond(text, "a half space begins with x, y or z", faces);
  const std::string_view rest = trimmed(whole.substr(1));
  if (rest.empty() || (rest.front() != '<' && rest.front() != '>'))
    refuse_bond(text, "< or > follows the axis of a half space", faces);
  space.axis = int(axis);
  space.below = rest.front() == '<';
  std::string_view limit = rest.substr(1);
  if (limit.starts_with('=')) limit.remove_prefix(1);
  try {
    space.limit = parse_quantity(trimmed(limit), "m", "1 mm");
  } catch (const UnitError& error) {
    refuse_bond(text, error.rule, faces);
  }
  return space;
}

constexpr const char* kinds[] = {".stl", ".step", ".stp", ".brep", ".brp"};

std::string kind_of_file(const fs::path& file) {
  return lower_case(file.extension().string());
}

double metres_per(const SolidFile& solid, const char* with_unit) {
  if (with_unit != nullptr && solid.unit != "mm")
    throw InvalidInput({"geometry.unit", solid.unit,
                        std::string(with_unit) + " has a unit of its own",
                        "leave geometry.unit out"});
  try {
    return parse_quantity("1 " + solid.unit, "m", "1 mm");
  } catch (const UnitError& error) {
    throw InvalidInput({"geometry.unit", solid.unit, error.rule,
                        "write a unit of length, e.g. geometry.unit = \"mm\""});
  }
}

/// The shortest turn that makes `up` +z; of -z half a turn about x.
meshes::Vector3 turned(const std::string& up, const meshes::Vector3& w) {
  const double sign = up.front() == '-' ? -1.0 : 1.0;
  switch (up.back()) {
    case 'x': return {-sign * w.z(), w.y(), sign * w.x()};
    case 'y': return {w.x(), -sign * w.z(), sign * w.y()};
    default: return {w.x(), sign * w.y(), sign * w.z()};
  }
}

/// By a plane across z: the highest vertex; of a flat top the middle of its area, of an edge that
/// of its vertices.
meshes::Vector3 first_touched(const TriangleMesh& mesh) {
  constexpr double level = 1e-6;  // over the height: digits of a file
  const auto height = [](const meshes::Vector3& w) { return w.z(); };
  const auto [low, high] = std::ranges::minmax_element(mesh.vertices, {}, height);
  if (low == mesh.vertices.end()) return meshes::Vector3::Zero();
  const double least = high->z() - level * (high->z() - low->z());
  meshes::Vector3 moment = meshes::Vector3::Zero(), sum = meshes::Vector3::Zero();
  double area = 0.0, count = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    int corners = 0;
    for (std::size_t c = 0; c < 3; ++c)
      if (mesh.corner(t, c).z() >= least) sum += mesh.corner(t, c), ++count, ++corners;
    if (corners < 3) continue;
    area += mesh.area_vector(t).norm();
    moment += mesh.area_vector(t).norm() * mesh.centroid(t);
  }
  return area > 0.0 ? meshes::Vector3(moment / area) : meshes::Vector3(sum / count);
}

}  // namespace

bool is_solid_file(const fs::path& file) {
  const std::string kind = kind_of_file(file);
  return std::ranges::any_of(kinds, [&](const char* known) { return kind == known; });
}

TriangleMesh read_stl(const fs::path& file) {
  const std::string bytes = meshes::read_text(file);
  const auto starts = [&](const char* word) { return lower_case(bytes.substr(0, 5)) == word; };
  const std::size_t count = bytes.size() >= head_bytes ? number_at<std::uint32_t>(bytes, 80) : 0;
  const bool fits = bytes.size() >= head_bytes && bytes.size() == head_bytes + facet_bytes * count;
  if (!fits && starts("solid")) return text_facets(file, bytes);
  if (bytes.size() < head_bytes + facet_bytes * count || bytes.size() < head_bytes)
    throw InvalidInput({file.string(), std::to_string(bytes.size()) + " bytes",
                        "no complete STL file: a binary one has 84 bytes and 50 for each of its "
                        "facets, here " +
                            std::to_string(count) + "; a text begins with solid",
                        "export it anew"});
  if (count > max_facets) refuse_facets(count);
  return binary_facets(bytes, count);
}

Bond parse_bond(const std::string& text, const Names& faces) {
  Bond bond;
  const std::string whole(trimmed(text));
  if (whole.empty()) return bond;
  const auto is_face = [&](const std::string& name) {
    return std::ranges::find(faces, name) != faces.end();
  };
  // A name may hold the words and, or.
  if (is_face(whole)) return {{}, {whole}};
  std::vector<HalfSpace> all;
  std::string part;
  const auto end_part = [&](bool ends_list) {
    if (ends_list && all.empty() && is_face(part))
      bond.faces.push_back(part);
    else
      all.push_back(parse_half_space(part, faces));
    part.clear();
    if (ends_list && !all.empty()) bond.region.push_back(std::exchange(all, {}));
  };
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word == "and" || word == "or")
      end_part(word == "or");
    else
      part += (part.empty() ? "" : " ") + word;
  }
  end_part(true);
  return bond;
}

void check_kind_of_solid(const fs::path& file) {
  const std::string kind = kind_of_file(file);
  if (kind == ".csv" || is_solid_file(file)) return;
  const bool cad = kind == ".igs" || kind == ".iges";
  throw InvalidInput({"geometry.file", file.string(),
                      "a solid is an STL, STEP or BREP file, or a meridian's CSV file",
                      std::string("export it as ") + (cad ? ".step" : ".stl") +
                          ": a .stl, .step, .brep or .csv file is read"});
}

std::shared_ptr<const meshes::Solid> read_solid(const SolidFile& solid) {
  check_kind_of_solid(solid.file);
  const std::string kind = kind_of_file(solid.file);
  const bool step = kind == ".step" || kind == ".stp", meridian = kind == ".csv";
  const double metres = metres_per(solid, step       ? "a STEP file"
                                          : meridian ? "a meridian's file"
                                                     : nullptr);
  TriangleMesh mesh = read_stl(kind == ".stl" ? solid.file : triangulated(solid.file, solid.up));
  for (meshes::Vector3& vertex : mesh.vertices)
    vertex = turned(solid.up, metres * vertex - solid.origin);
  if (solid.touch) {
    const meshes::Vector3 top = first_touched(mesh);
    for (meshes::Vector3& vertex : mesh.vertices) vertex.head<2>() -= top.head<2>();
  }
  const Bond bond = parse_bond(solid.bond, mesh.face_names);
  return std::make_shared<meshes::Solid>(mesh, bond.region, bond.faces);
}

}  // namespace fingertip::studies::inline config::inline shapes
