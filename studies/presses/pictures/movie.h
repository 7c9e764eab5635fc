/// Pictures of a press as a time series for ParaView.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/press/boundary_view.h"
#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline presses::inline pictures {

/// A mesh with data, one piece of a VTK file: points in m, cells as VTK knows them.
struct MoviePiece {
  enum Part : int { tip = 0, rod = 1, plane = 2 };
  Part part = tip;
  std::vector<meshes::Vector3> points;        ///< in world axes [m]
  std::vector<meshes::Vector3> displacement;  ///< since the first picture, the tip's since rest [m]
  std::vector<std::uint8_t> held;             ///< per point: 1 where the obstacle holds the tip
  std::vector<std::int32_t> connectivity, offsets;  ///< offsets: ends of the cells
  std::vector<std::uint8_t> types;                  ///< 1 vertex, 3 line, 5 triangle, 9 quadrangle

  void add_cell(std::uint8_t type, std::initializer_list<std::size_t> corners);
};

/// Writes FOLDER/frame_0000.vtu, ... and FOLDER/movie.pvd, which is complete after every picture.
/// Pieces of a frame, told apart by the cell data `part`: 0 masses (vertices) and springs (lines)
/// of the tip's boundary, 1 the rod's surface, 2 the plane, 3 R wide. Point data: displacement [m]
/// and held. Field data: TimeValue [s], indentation [m], and of the rod's endpoint its place [m]
/// and the tip's force [N] and torque [N m] there.
class Movie {
 public:
  Movie(std::filesystem::path folder, const meshes::Geometry& geometry);

  void add(const lattice::BoundaryView& view, const lattice::FingerPicture& picture);
  std::size_t frames() const { return times_.size(); }

 private:
  MoviePiece tip_piece(const lattice::BoundaryView& view,
                       const lattice::FingerPicture& picture) const;
  MoviePiece rod_piece(const lattice::FingerPicture& picture) const;
  MoviePiece plane_piece(const lattice::FingerPicture& picture) const;

  std::filesystem::path folder_;
  meshes::Geometry geometry_;
  std::vector<double> times_;                             ///< [s]
  std::vector<meshes::Vector3> first_rod_, first_plane_;  ///< places in the first picture [m]
};

}  // namespace fingertip::studies::inline presses::inline pictures
