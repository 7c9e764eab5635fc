#include "meshes/cad_surface.h"

#include <gmsh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::meshes {
namespace {

/// Edges around a full circle: chords are within pi²/(2 n²) of its radius.
constexpr double edges_around = 120.0;
/// At the top, which touches first: depth counts from the highest vertex, forces from the mean
/// facet. Height and longest edge over the solid's width.
constexpr double top_height = 0.2, top_edge = 0.01;
/// Longest and shortest edge over the solid's extent.
constexpr double longest_edge = 0.1, shortest_edge = 1.0 / 400.0;

class Gmsh {
 public:
  Gmsh() {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0.0);
  }
  ~Gmsh() { gmsh::finalize(); }
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
};

[[noreturn]] void refuse_cad(const std::filesystem::path& file, const std::string& rule,
                             const std::string& remedy) {
  throw InvalidInput({file.filename().string(), "", rule, remedy});
}

using Facet = std::array<std::array<float, 3>, 3>;

/// Of one surface; `side` is -1 where it faces into the solid.
void take_facets(int surface, int side, std::vector<Facet>& facets) {
  std::vector<std::size_t> nodes;
  std::vector<double> places, none;
  gmsh::model::mesh::getNodes(nodes, places, none, 2, surface, true, false);
  std::map<std::size_t, std::array<float, 3>> place;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    place[nodes[n]] = {float(places[3 * n]), float(places[3 * n + 1]), float(places[3 * n + 2])};
  std::vector<std::size_t> tags, corners;
  constexpr int triangle = 2;
  gmsh::model::mesh::getElementsByType(triangle, tags, corners, surface);
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    Facet facet{place.at(corners[t]), place.at(corners[t + 1]), place.at(corners[t + 2])};
    if (side < 0) std::swap(facet[1], facet[2]);
    facets.push_back(facet);
  }
}

std::vector<Facet> facets_of(const std::filesystem::path& cad) {
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
  const double width = std::min(box[3] - box[0], box[4] - box[1]);
  const int top = gmsh::model::mesh::field::add("Box");
  for (const auto& [option, value] :
       std::map<std::string, double>{{"VIn", top_edge * width},
                                     {"VOut", longest_edge * extent},
                                     {"XMin", box[0] - extent},
                                     {"XMax", box[3] + extent},
                                     {"YMin", box[1] - extent},
                                     {"YMax", box[4] + extent},
                                     {"ZMin", box[5] - top_height * width},
                                     {"ZMax", box[5] + extent},
                                     {"Thickness", top_height * width}})
    gmsh::model::mesh::field::setNumber(top, option, value);
  gmsh::model::mesh::field::setAsBackgroundMesh(top);
  for (const auto& [option, value] :
       std::map<std::string, double>{{"Mesh.MeshSizeFromCurvature", edges_around},
                                     {"Mesh.MeshSizeMax", longest_edge * extent},
                                     {"Mesh.MeshSizeMin", shortest_edge * extent},
                                     {"Mesh.Algorithm", 6.0}})
    gmsh::option::setNumber(option, value);
  gmsh::model::mesh::generate(2);
  gmsh::model::getBoundary(solids, surfaces, false, true);
  std::vector<Facet> facets;
  for (const auto& [dimension, tag] : surfaces)
    if (dimension == 2) take_facets(std::abs(tag), tag < 0 ? -1 : 1, facets);
  return facets;
}

template <typename Number>
void put(std::ostream& out, Number number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

void write_cad_surface(const std::filesystem::path& cad, const std::filesystem::path& stl) {
  std::vector<Facet> facets;
  try {
    facets = facets_of(cad);
  } catch (const std::string& words) {  // as gmsh throws
    refuse_cad(cad, "gmsh cannot mesh it: " + words, "mend the solid in the CAD program");
  } catch (const InvalidInput&) {
    throw;
  } catch (const std::exception& error) {
    refuse_cad(cad, std::string("gmsh cannot mesh it: ") + error.what(),
               "mend the solid in the CAD program");
  }
  write_atomically(stl, [&](std::ostream& out) {
    out << "surface of a CAD solid" << std::string(80 - 22, ' ');
    put(out, std::uint32_t(facets.size()));
    for (const Facet& facet : facets) {
      for (int d = 0; d < 3; ++d) put(out, 0.0F);  // readers find the normal themselves
      for (const auto& corner : facet)
        for (const float x : corner) put(out, x);
      put(out, std::uint16_t(0));
    }
  });
}

}  // namespace fingertip::meshes
