#include "studies/presses/pictures/contact_frames.h"

#include <fmt/format.h>

#include <ostream>

#include "meshes/base/files.h"
#include "studies/presses/pictures/vtk_text.h"

namespace fingertip::studies::inline presses::inline pictures {

namespace fs = std::filesystem;
using meshes::ContactPoint, meshes::Vector3;

namespace {

std::string frame_text(std::span<const ContactPoint> points) {
  std::vector<Vector3> places, shears, tractions;
  std::vector<double> pressures, areas;
  std::vector<std::uint8_t> states;
  std::vector<std::int32_t> cells, ends;
  for (const ContactPoint& point : points) {
    places.push_back(point.place);
    shears.push_back(point.shear);
    tractions.push_back(point.traction());
    pressures.push_back(point.normal_traction);
    areas.push_back(point.area);
    states.push_back(point.state == meshes::ContactState::stick ? 1 : 2);
    cells.push_back(std::int32_t(cells.size()));
    ends.push_back(cells.back() + 1);
  }
  return vtk::file_head("UnstructuredGrid") + "<UnstructuredGrid>\n<FieldData>\n" +
         vtk::field("TimeValue", {double(points.front().sample)}) +
         vtk::field("indentation", {points.front().indentation}) + "</FieldData>\n" +
         fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfCells=\"{0}\">\n", points.size()) +
         "<PointData Scalars=\"pressure\">\n" + vtk::scalars("Float64", "pressure", pressures) +
         vtk::vectors("shear", shears) + vtk::vectors("traction", tractions) +
         vtk::scalars("Float64", "area", areas) + vtk::scalars("UInt8", "state", states) +
         "</PointData>\n<Points>\n" + vtk::vectors("Points", places) + "</Points>\n<Cells>\n" +
         vtk::scalars("Int32", "connectivity", cells) + vtk::scalars("Int32", "offsets", ends) +
         vtk::scalars("UInt8", "types", std::vector<std::uint8_t>(points.size(), vtk::vertex)) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

void write_contact_frames(std::span<const ContactPoint> field, const fs::path& folder) {
  const fs::path frames = folder / "contact";
  fs::remove_all(frames);
  if (field.empty()) return;
  fs::create_directories(frames);
  std::vector<double> times;
  for (const auto& points : meshes::samples_of(field)) {
    meshes::write_atomically(frames / vtk::frame_name(times.size()),
                             [&](std::ostream& out) { out << frame_text(points); });
    times.push_back(points.front().sample);
  }
  vtk::write_series(frames / "contact.pvd", times);
}

}  // namespace fingertip::studies::inline presses::inline pictures
