#include "meshes/volume_mesh/cad_surface.h"

#include <gmsh.h>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/shape/stl_file.h"
#include "meshes/volume_mesh/step_faces.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

/// Edges around a full circle: chords are within pi²/(2 n²) of its radius. With 120 the rubber that
/// they cut off takes 0.06 % of the dome's force, with 160 half of that.
constexpr double edges_around = 160.0;
/// Where the top, which touches first, is curved, over the solid's width w: depth counts from the
/// highest vertex, forces from the mean facet. A facet of edge e lies e² kappa/8 below its surface,
/// which is touched at its depth z below the top: with e = top_edge w sqrt(max(1, z/(top_depth w)))
/// that is at most 0.05 % of z on a dome (kappa = 2/w), and facets are as many in every doubling of
/// z.
constexpr double top_depth = 0.02, top_edge = 0.006;
/// Longest and shortest edge over the solid's extent. A fillet of a radius below the shortest edge
/// is a chamfer: the rubber that this takes or adds is far less than chords around the finger take.
constexpr double longest_edge = 0.1, shortest_edge = 1.0 / 150.0;

class Gmsh {
 public:
  Gmsh() {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0.0);
    // OpenCASCADE would count entities on the screen, in colours.
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Gmsh() { gmsh::finalize(); }
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
};

[[noreturn]] void refuse_cad(const std::filesystem::path& file, const std::string& rule,
                             const std::string& remedy) {
  throw InvalidInput({file.filename().string(), "", rule, remedy});
}

/// A place of a meshed surface that is on none of its neighbours: a node off its rim, or where it
/// has none, the middle of a facet.
Vector3 inside(int surface) {
  std::vector<std::size_t> tags, corners;
  std::vector<double> places, none;
  gmsh::model::mesh::getNodes(tags, places, none, 2, surface, false, false);
  if (!tags.empty()) return {places[0], places[1], places[2]};
  gmsh::model::mesh::getBarycenters(2, surface, false, true, places);
  if (places.empty()) return Vector3::Zero();  // without facets
  return {places[0], places[1], places[2]};
}

/// Adds those of one surface; `side` is -1 where it faces into the solid. `names`, where there are
/// any, tell its own.
void take_facets(int surface, int side, const StepFaces* names, TriangleMesh& mesh) {
  std::vector<std::size_t> nodes;
  std::vector<double> places, none;
  gmsh::model::mesh::getNodes(nodes, places, none, 2, surface, true, false);
  std::map<std::size_t, int> number;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    number[nodes[n]] = int(mesh.vertices.size());
    mesh.vertices.emplace_back(places[3 * n], places[3 * n + 1], places[3 * n + 2]);
  }
  std::vector<std::size_t> tags, corners;
  constexpr int triangle = 2;
  gmsh::model::mesh::getElementsByType(triangle, tags, corners, surface);
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    std::array<int, 3> facet{number.at(corners[t]), number.at(corners[t + 1]),
                             number.at(corners[t + 2])};
    if (side < 0) std::swap(facet[1], facet[2]);
    mesh.triangles.push_back(facet);
  }
  if (names != nullptr)
    mesh.faces.resize(mesh.triangles.size(), mesh.face_number(names->name_at(inside(surface))));
}

bool is_step(const std::filesystem::path& cad) {
  std::string kind = cad.extension().string();
  std::ranges::transform(kind, kind.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return kind == ".step" || kind == ".stp";
}

/// A plane is one whatever its facets' size.
std::vector<double> curved(const gmsh::vectorpair& surfaces) {
  std::vector<double> result;
  for (const auto& [dimension, tag] : surfaces) {
    std::string kind;
    gmsh::model::getType(dimension, std::abs(tag), kind);
    if (kind != "Plane") result.push_back(std::abs(tag));
  }
  return result;
}

/// Facets are to be small near the top where these surfaces are. `box`: of the solid, lowest and
/// highest corner; the top is where `up` points to.
void refine_top(const std::array<double, 6>& box, const std::string& up,
                const std::vector<double>& surfaces) {
  if (surfaces.empty()) return;
  const std::size_t along = std::size_t(up.back() - 'x');
  double width = std::numeric_limits<double>::max();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis != along) width = std::min(width, box[axis + 3] - box[axis]);
  const bool down = up.front() == '-';
  const std::string place(1, up.back());
  const std::string share = "((" + to_text(down ? -box[along] : box[along + 3]) +
                            (down ? "+" : "-") + place + ")/" + to_text(top_depth * width) + ")";
  const int sizes = gmsh::model::mesh::field::add("MathEval");
  gmsh::model::mesh::field::setString(
      sizes, "F", to_text(top_edge * width) + "*sqrt((1+" + share + "+abs(1-" + share + "))/2)");
  const int there = gmsh::model::mesh::field::add("Restrict");
  gmsh::model::mesh::field::setNumber(there, "InField", sizes);
  gmsh::model::mesh::field::setNumbers(there, "SurfacesList", surfaces);
  gmsh::model::mesh::field::setAsBackgroundMesh(there);
}

/// In the file's numbers.
TriangleMesh facets_of(const std::filesystem::path& cad, const std::string& up) {
  const Gmsh session;
  gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
  gmsh::vectorpair shapes, solids, surfaces;
  gmsh::model::occ::importShapes(cad.string(), shapes);
  gmsh::model::occ::synchronize();
  gmsh::model::getEntities(solids, 3);
  if (solids.size() != 1)
    refuse_cad(cad, std::to_string(solids.size()) + " solids, where there must be one",
               "export one body as a solid, not as surfaces or an assembly");
  std::array<double, 6> box{};
  gmsh::model::getBoundingBox(3, solids[0].second, box[0], box[1], box[2], box[3], box[4], box[5]);
  const double extent = std::max({box[3] - box[0], box[4] - box[1], box[5] - box[2]});
  gmsh::model::getBoundary(solids, surfaces, false, true);
  refine_top(box, up, curved(surfaces));
  for (const auto& [option, value] :
       std::map<std::string, double>{{"Mesh.MeshSizeFromCurvature", edges_around},
                                     {"Mesh.MeshSizeMax", longest_edge * extent},
                                     {"Mesh.MeshSizeMin", shortest_edge * extent},
                                     {"Mesh.MeshSizeExtendFromBoundary", 0.0},
                                     {"Mesh.Algorithm", 6.0}})
    gmsh::option::setNumber(option, value);
  gmsh::model::mesh::generate(2);
  std::optional<StepFaces> names;
  if (is_step(cad)) names.emplace(cad);
  const bool named = names && names->any_named();
  TriangleMesh mesh;
  for (const auto& [dimension, tag] : surfaces)
    if (dimension == 2)
      take_facets(std::abs(tag), tag < 0 ? -1 : 1, named ? &*names : nullptr, mesh);
  return mesh;
}

}  // namespace

void write_cad_surface(const std::filesystem::path& cad, const std::filesystem::path& stl,
                       const std::string& up) {
  TriangleMesh mesh;
  try {
    mesh = facets_of(cad, up);
  } catch (const std::string& words) {  // as gmsh throws
    refuse_cad(cad, "gmsh cannot mesh it: " + words, "mend the solid in the CAD program");
  } catch (const InvalidInput&) {
    throw;
  } catch (const std::exception& error) {
    refuse_cad(cad, std::string("gmsh cannot mesh it: ") + error.what(),
               "mend the solid in the CAD program");
  }
  write_stl(mesh, 1.0, "surface of a CAD solid", stl);
}

}  // namespace fingertip::meshes::inline volume_mesh
