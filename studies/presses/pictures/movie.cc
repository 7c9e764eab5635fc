#include "studies/presses/pictures/movie.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <utility>

#include "meshes/base/files.h"
#include "meshes/shape/meridian.h"
#include "studies/presses/pictures/vtk_text.h"

namespace fingertip::studies::inline presses::inline pictures {

using lattice::BoundaryView;
using lattice::FingerPicture;
using meshes::Vector3;

namespace {

constexpr std::size_t around = 32;  ///< points around the rod
constexpr int latitudes = 8;        ///< rings of its hemisphere

std::vector<double> list(const Vector3& value) {
  return {value.x(), value.y(), value.z()};
}

std::string piece_text(const MoviePiece& piece) {
  return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", piece.points.size(),
                     piece.types.size()) +
         "<PointData Vectors=\"displacement\">\n" +
         vtk::vectors("displacement", piece.displacement) +
         vtk::scalars("UInt8", "held", piece.held) + "</PointData>\n<CellData>\n" +
         vtk::scalars("Int32", "part", std::vector<std::int32_t>(piece.types.size(), piece.part)) +
         "</CellData>\n<Points>\n" + vtk::vectors("Points", piece.points) + "</Points>\n<Cells>\n" +
         vtk::scalars("Int32", "connectivity", piece.connectivity) +
         vtk::scalars("Int32", "offsets", piece.offsets) +
         vtk::scalars("UInt8", "types", piece.types) + "</Cells>\n</Piece>\n";
}

/// The places minus the first ones, which become the places when there are none yet.
std::vector<Vector3> moved_since(std::vector<Vector3>& first, const std::vector<Vector3>& places) {
  if (first.empty()) first = places;
  std::vector<Vector3> moved;
  for (std::size_t i = 0; i < places.size(); ++i) moved.emplace_back(places[i] - first[i]);
  return moved;
}

}  // namespace

void MoviePiece::add_cell(std::uint8_t type, std::initializer_list<std::size_t> corners) {
  for (const std::size_t corner : corners) connectivity.push_back(std::int32_t(corner));
  offsets.push_back(std::int32_t(connectivity.size()));
  types.push_back(type);
}

Movie::Movie(std::filesystem::path folder, const meshes::Geometry& geometry)
    : folder_(std::move(folder)), geometry_(geometry) {
  std::filesystem::create_directories(folder_);
}

MoviePiece Movie::tip_piece(const BoundaryView& view, const FingerPicture& picture) const {
  MoviePiece piece;
  piece.points = picture.boundary;
  piece.held = picture.held;
  for (std::size_t p = 0; p < view.size(); ++p) {
    piece.displacement.emplace_back(picture.boundary[p] - view.rest()[p]);
    piece.add_cell(vtk::vertex, {p});
  }
  for (const auto& [i, j] : view.springs())
    piece.add_cell(vtk::line, {std::size_t(i), std::size_t(j)});
  return piece;
}

/// Rings about the axis, joined along each outline; one point where it meets the axis.
MoviePiece Movie::rod_piece(const FingerPicture& picture) const {
  MoviePiece piece;
  piece.part = MoviePiece::rod;
  for (const auto& outline : meshes::held_outlines(geometry_, latitudes)) {
    std::vector<std::size_t> below, above;
    for (const meshes::Vector2& place : outline) {
      above.clear();
      for (std::size_t k = 0; k < (place.x() > 0.0 ? around : 1); ++k) {
        const double angle = 2.0 * std::numbers::pi * double(k) / double(around);
        above.push_back(piece.points.size());
        piece.points.push_back(picture.rod * Vector3(place.x() * std::cos(angle),
                                                     place.x() * std::sin(angle), place.y()));
      }
      for (std::size_t k = 0; k < around && !below.empty(); ++k) {
        const std::size_t next = (k + 1) % around;
        if (below.size() == around && above.size() == around)
          piece.add_cell(vtk::quadrangle, {below[k], below[next], above[next], above[k]});
        else if (above.size() == around)
          piece.add_cell(vtk::triangle, {below[0], above[next], above[k]});
        else if (below.size() == around)
          piece.add_cell(vtk::triangle, {below[k], below[next], above[0]});
      }
      below = above;
    }
  }
  piece.held.assign(piece.points.size(), 0);
  return piece;
}

MoviePiece Movie::plane_piece(const FingerPicture& picture) const {
  MoviePiece piece;
  piece.part = MoviePiece::plane;
  const lattice::Plane& plane = picture.plane;
  const Eigen::Matrix3d axes = plane.axes();
  const auto mesh = meshes::obstacle_mesh(plane.obstacle, 1.5 * geometry_.tip_radius);
  for (const Vector3& point : mesh.points) piece.points.emplace_back(plane.point + axes * point);
  for (const auto& [a, b, c, d] : mesh.quadrangles) piece.add_cell(vtk::quadrangle, {a, b, c, d});
  piece.held.assign(piece.points.size(), 0);
  return piece;
}

void Movie::add(const BoundaryView& view, const FingerPicture& picture) {
  const MoviePiece tip = tip_piece(view, picture);
  MoviePiece rod = rod_piece(picture), plane = plane_piece(picture);
  rod.displacement = moved_since(first_rod_, rod.points);
  plane.displacement = moved_since(first_plane_, plane.points);
  meshes::write_atomically(folder_ / vtk::frame_name(frames()), [&](std::ostream& out) {
    out << vtk::file_head("UnstructuredGrid") << "<UnstructuredGrid>\n<FieldData>\n"
        << vtk::field("TimeValue", {picture.time})
        << vtk::field("indentation", {picture.indentation})
        << vtk::field("endpoint", list(picture.endpoint))
        << vtk::field("force", list(picture.on_rod.force))
        << vtk::field("torque", list(picture.on_rod.torque)) << "</FieldData>\n"
        << piece_text(tip) << piece_text(rod) << piece_text(plane)
        << "</UnstructuredGrid>\n</VTKFile>\n";
  });
  times_.push_back(picture.time);
  vtk::write_series(folder_ / "movie.pvd", times_);
}

}  // namespace fingertip::studies::inline presses::inline pictures
