#include "studies/exchange/mass_frames.h"

#include <fmt/format.h>

#include <ostream>

#include "meshes/base/files.h"
#include "studies/presses/pictures/vtk_text.h"

namespace fingertip::studies {

using meshes::Vector3;

MassFrames::MassFrames(std::filesystem::path folder, const lattice::LatticeModel& model)
    : folder_(std::move(folder)), model_(&model) {
  std::filesystem::create_directories(folder_);
  std::vector<std::int32_t> number(model.points(), -1);
  const auto add_cell = [&](std::uint8_t type, std::initializer_list<std::int32_t> corners) {
    connectivity_.insert(connectivity_.end(), corners);
    offsets_.push_back(std::int32_t(connectivity_.size()));
    types_.push_back(type);
  };
  for (const std::uint32_t i : model.particles) {
    number[i] = std::int32_t(offsets_.size());
    add_cell(vtk::vertex, {number[i]});
  }
  for (const std::uint32_t i : model.particles) {
    for (int s = 0; s < lattice::directions; ++s) {
      const auto& direction = lattice::half_stencil[std::size_t(s)];
      if (direction.family != lattice::axis || !(model.weight[std::size_t(s)][i] > 0.0)) continue;
      const std::size_t j = i + std::size_t(lattice::neighbour_offset(model.grid.size, s));
      add_cell(vtk::line, {number[i], number[j]});
    }
  }
}

void MassFrames::add(const lattice::State& state, double time) {
  std::vector<Vector3> places, displacements, velocities;
  for (const std::uint32_t i : model_->particles) {
    places.push_back(lattice::position(*model_, state, i));
    displacements.emplace_back(model_->grid.axes * state.displacement.at(i));
    velocities.emplace_back(model_->grid.axes * state.velocity.at(i));
  }
  meshes::write_atomically(folder_ / vtk::frame_name(times_.size()), [&](std::ostream& out) {
    out << vtk::file_head("UnstructuredGrid") << "<UnstructuredGrid>\n<FieldData>\n"
        << vtk::field("TimeValue", {time}) << "</FieldData>\n"
        << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", places.size(),
                       types_.size())
        << "<PointData Vectors=\"displacement\">\n"
        << vtk::vectors("displacement", displacements) << vtk::vectors("velocity", velocities)
        << "</PointData>\n<Points>\n"
        << vtk::vectors("Points", places) << "</Points>\n<Cells>\n"
        << vtk::scalars("Int32", "connectivity", connectivity_)
        << vtk::scalars("Int32", "offsets", offsets_) << vtk::scalars("UInt8", "types", types_)
        << "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  });
  times_.push_back(time);
  vtk::write_series(folder_ / "frames.pvd", times_);
}

}  // namespace fingertip::studies
