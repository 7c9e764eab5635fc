#include "studies/exchange/sofa_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "meshes/base/files.h"
#include "studies/exchange/soft_body.h"
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
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!-- {}, fitted to {:.4g} mm on a plane; pole up, SI. README.md says how to use it. -->\n"
      "<Node name=\"root\" gravity=\"0 0 0\" dt=\"{}\">\n"
      "  <RequiredPlugin pluginName=\"Sofa.Component\"/>\n"
      "  <DefaultAnimationLoop/>\n"
      "  <Node name=\"finger\">\n"
      "    <EulerImplicitSolver rayleighStiffness=\"{}\" rayleighMass=\"0\"/>\n"
      "    <CGLinearSolver iterations=\"500\" tolerance=\"1e-9\" threshold=\"1e-9\"/>\n"
      "    <TetrahedronSetTopologyContainer name=\"mesh\" position=\"",
      loaded.config.press.geometry.shape_name(), 1e3 * curve.forces.indentation.back(), sofa_step,
      to_text(rubber.retardation_time));
  text += soft.places() + "\"\n      tetrahedra=\"" + soft.tetrahedra();
  fmt::format_to(
      std::back_inserter(text),
      "\"/>\n    <TetrahedronSetGeometryAlgorithms template=\"Vec3d\"/>\n"
      "    <MechanicalObject name=\"state\" template=\"Vec3d\"/>\n"
      "    <UniformMass totalMass=\"{:.9g}\"/>\n"
      "    <TetrahedronHyperelasticityFEMForceField materialName=\"StVenantKirchhoff\" "
      "ParameterSet=\"{:.9g} {:.9g}\"/>\n"
      "    <PlaneForceField name=\"obstacle\" normal=\"0 0 -1\" d=\"{:.9g}\" stiffness=\"{:.9g}\" "
      "damping=\"0\"/>\n"
      "    <FixedProjectiveConstraint indices=\"",
      rubber.density * soft.body.volume(), soft.shear_modulus(), soft.lambda(), -soft.body.top(),
      soft.stiffness);
  return text + soft.held() + "\"/>\n  </Node>\n</Node>\n";
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
  ContactExport made = soft_export(
      "sofa",
      fmt::format(
          "# A finger for SOFA\n\n"
          "`finger.scn` (SOFA 24.06 and later; before, `FixedProjectiveConstraint` is "
          "`FixedConstraint`). The plane `obstacle` touches the pole:\nraise its `d`, {:.6g} m at "
          "first, by the indentation to press. It pushes every vertex behind it with {:.6g} N/m, "
          "without friction.\n",
          -soft.body.top(), soft.stiffness),
      source);
  made.files = {{"finger.scn", scene(source.loaded, source.curves.front(), soft)}};
  return made;
}

ContactExport vtk_export(const ContactSource& source) {
  ContactExport made = soft_export(
      "vtk",
      "# A finger as a mesh\n\n`finger.vtu` (ParaView, meshio): tetrahedra in metres, pole up; per "
      "cell `youngs_modulus` and `density` (SI),\n`poissons_ratio`; per point `held` (1 where the "
      "finger is bonded).\n",
      source);
  made.files = {{"finger.vtu", vtu(source.loaded, source.soft())}};
  return made;
}

}  // namespace fingertip::studies::inline exchange
