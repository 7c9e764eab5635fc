#include "studies/exchange/sofa_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "meshes/base/files.h"
#include "studies/exchange/soft_body.h"
#include "studies/exchange/texts/texts.h"
#include "studies/presses/pictures/vtk_text.h"

namespace fingertip::studies::inline exchange {

namespace {

using meshes::to_text;

constexpr double sofa_step = 1e-3;  ///< [s]; its implicit Euler is stable at any

const char* const same_tetrahedra =
    "Force of linear tetrahedra of St. Venant-Kirchhoff's law at rest, pressed by a plane, over "
    "that of the continuum";

std::string scene(const LoadedConfig& loaded, const ContactCurve& curve, const SoftBody& soft) {
  const meshes::Rubber& rubber = loaded.config.press.rubber;
  return filled("finger.scn", fmt::arg("finger", loaded.config.press.geometry.shape_name()),
                fmt::arg("depth", 1e3 * curve.forces.indentation.back()),
                fmt::arg("step", sofa_step), fmt::arg("damping", to_text(rubber.retardation_time)),
                fmt::arg("places", soft.places()), fmt::arg("tetrahedra", soft.tetrahedra()),
                fmt::arg("mass", rubber.density * soft.body.volume()),
                fmt::arg("shear", soft.shear_modulus()), fmt::arg("lambda", soft.lambda()),
                fmt::arg("plane", -soft.body.top()), fmt::arg("stiffness", soft.stiffness),
                fmt::arg("held", soft.held()));
}

std::string vtu(const LoadedConfig& loaded, const SoftBody& soft) {
  const meshes::Tetrahedra& mesh = soft.body.mesh;
  const std::size_t cells = mesh.tetrahedra.size();
  std::vector<std::int32_t> connectivity, offsets;
  for (const auto& t : mesh.tetrahedra) {
    connectivity.insert(connectivity.end(), t.begin(), t.end());
    offsets.push_back(std::int32_t(connectivity.size()));
  }
  std::vector<std::uint8_t> held(soft.body.held.begin(), soft.body.held.end());
  const auto everywhere = [&](const char* name, double value) {
    return vtk::scalars("Float64", name, std::vector<double>(cells, value));
  };
  return vtk::file_head("UnstructuredGrid") + "<UnstructuredGrid>\n" +
         fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.vertices.size(),
                     cells) +
         "<PointData>\n" + vtk::scalars("UInt8", "held", held) + "</PointData>\n<CellData>\n" +
         everywhere("youngs_modulus", soft.youngs_modulus) +
         everywhere("poissons_ratio", soft.poissons_ratio) +
         everywhere("density", loaded.config.press.rubber.density) + "</CellData>\n<Points>\n" +
         vtk::vectors("Points", mesh.vertices) + "</Points>\n<Cells>\n" +
         vtk::scalars("Int32", "connectivity", connectivity) +
         vtk::scalars("Int32", "offsets", offsets) +
         vtk::scalars("UInt8", "types", std::vector<std::uint8_t>(cells, vtk::tetrahedron)) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

ContactExport soft_export(const char* format, const std::string& readme,
                          const ContactSource& source) {
  const SoftBody& soft = source.soft();
  ContactExport made;
  made.readme = readme + description(soft) + soft.limit(source.curves.front()) + "\n\n";
  made.said = summary(soft, source.curves.front()) + "\n";
  made.transfer = transfer_of(format, same_tetrahedra, source.lost, source.curves,
                              {foretold("tetrahedra", soft)});
  return made;
}

}  // namespace

ContactExport sofa_export(const ContactSource& source) {
  const SoftBody& soft = source.soft();
  ContactExport made = soft_export("sofa",
                                   filled("sofa_readme.txt", fmt::arg("plane", -soft.body.top()),
                                          fmt::arg("stiffness", soft.stiffness)),
                                   source);
  made.files = {{"finger.scn", scene(source.loaded, source.curves.front(), soft)}};
  return made;
}

ContactExport vtk_export(const ContactSource& source) {
  ContactExport made = soft_export("vtk", filled("vtk_readme.txt"), source);
  made.files = {{"finger.vtu", vtu(source.loaded, source.soft())}};
  return made;
}

}  // namespace fingertip::studies::inline exchange
