#include "studies/run/movie.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <ostream>
#include <utility>

#include "meshes/files.h"

namespace fingertip::studies {

using lattice::BoundaryView;
using lattice::FingerPicture;
using meshes::Vector3;

namespace {

constexpr std::uint8_t vertex = 1, line = 3, triangle = 5, quadrangle = 9;  // VTK's numbers
constexpr std::size_t around = 32;    ///< points around the rod
constexpr std::size_t latitudes = 8;  ///< rings of its hemisphere

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), int(bytes.size()));
  text.resize(std::size_t(length));
  return text;
}

template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

/// An array in VTK's inline binary format: its size in bytes as UInt64, then the numbers.
std::string data_array(const char* type, const char* name, int components,
                       const std::string& numbers) {
  std::string bytes;
  append(bytes, std::uint64_t(numbers.size()));
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}"
      "</DataArray>\n",
      type, name, components, base64(bytes + numbers));
}

std::string vectors(const char* name, const std::vector<Vector3>& values) {
  std::string numbers;
  for (const Vector3& value : values)
    for (int axis = 0; axis < 3; ++axis) append(numbers, float(value[axis]));
  return data_array("Float32", name, 3, numbers);
}

template <class Number>
std::string scalars(const char* type, const char* name, const std::vector<Number>& values) {
  std::string numbers;
  for (const Number value : values) append(numbers, value);
  return data_array(type, name, 1, numbers);
}

std::string field(const char* name, const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += ' ' + meshes::to_text(value);
  return fmt::format(
      "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{} </DataArray>\n",
      name, values.size(), text);
}

std::vector<double> list(const Vector3& value) {
  return {value.x(), value.y(), value.z()};
}

std::string piece_text(const MoviePiece& piece) {
  return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", piece.points.size(),
                     piece.types.size()) +
         "<PointData Vectors=\"displacement\">\n" + vectors("displacement", piece.displacement) +
         scalars("UInt8", "held", piece.held) + "</PointData>\n<CellData>\n" +
         scalars("Int32", "part", std::vector<std::int32_t>(piece.types.size(), piece.part)) +
         "</CellData>\n<Points>\n" + vectors("Points", piece.points) + "</Points>\n<Cells>\n" +
         scalars("Int32", "connectivity", piece.connectivity) +
         scalars("Int32", "offsets", piece.offsets) + scalars("UInt8", "types", piece.types) +
         "</Cells>\n</Piece>\n";
}

std::string file_head(const char* type) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n",
      type, order);
}

std::string frame_name(std::size_t frame) {
  return fmt::format("frame_{:04d}.vtu", frame);
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
    piece.add_cell(vertex, {p});
  }
  for (const auto& [i, j] : view.springs()) piece.add_cell(line, {std::size_t(i), std::size_t(j)});
  return piece;
}

/// The end's centre, a ring at the end, one at z = 0 and those of the hemisphere, the pole.
MoviePiece Movie::rod_piece(const FingerPicture& picture) const {
  MoviePiece piece;
  piece.part = MoviePiece::rod;
  const double r = geometry_.rod_radius;
  piece.points.push_back(picture.rod * Vector3(0.0, 0.0, -geometry_.rod_length));
  for (std::size_t ring = 0; ring <= latitudes; ++ring) {
    const double latitude = 0.5 * std::numbers::pi * (double(ring) - 1.0) / double(latitudes);
    const double radius = ring == 0 ? r : r * std::cos(latitude);
    const double height = ring == 0 ? -geometry_.rod_length : r * std::sin(latitude);
    for (std::size_t k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * double(k) / double(around);
      piece.points.push_back(picture.rod *
                             Vector3(radius * std::cos(angle), radius * std::sin(angle), height));
    }
  }
  const std::size_t pole = piece.points.size();
  piece.points.push_back(picture.rod * Vector3(0.0, 0.0, r));
  for (std::size_t k = 0; k < around; ++k) {
    const std::size_t next = (k + 1) % around;
    piece.add_cell(triangle, {0, 1 + next, 1 + k});
    for (std::size_t ring = 0; ring < latitudes; ++ring) {
      const std::size_t below = 1 + ring * around, above = below + around;
      piece.add_cell(quadrangle, {below + k, below + next, above + next, above + k});
    }
    const std::size_t last = 1 + latitudes * around;
    piece.add_cell(triangle, {last + k, last + next, pole});
  }
  piece.held.assign(piece.points.size(), 0);
  return piece;
}

MoviePiece Movie::plane_piece(const FingerPicture& picture) const {
  MoviePiece piece;
  piece.part = MoviePiece::plane;
  const Vector3 start = picture.plane.turned.conjugate() * picture.plane.normal;
  const Vector3 t1 = lattice::first_tangent(start), t2 = t1.cross(start);
  const double half = 1.5 * geometry_.tip_radius;
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    piece.points.push_back(picture.plane.place(half * (a * t1 + b * t2)));
  piece.add_cell(quadrangle, {0, 1, 2, 3});
  piece.held.assign(piece.points.size(), 0);
  return piece;
}

void Movie::add(const BoundaryView& view, const FingerPicture& picture) {
  const MoviePiece tip = tip_piece(view, picture);
  MoviePiece rod = rod_piece(picture), plane = plane_piece(picture);
  rod.displacement = moved_since(first_rod_, rod.points);
  plane.displacement = moved_since(first_plane_, plane.points);
  meshes::write_atomically(folder_ / frame_name(frames()), [&](std::ostream& out) {
    out << file_head("UnstructuredGrid") << "<UnstructuredGrid>\n<FieldData>\n"
        << field("TimeValue", {picture.time}) << field("indentation", {picture.indentation})
        << field("endpoint", list(picture.endpoint)) << field("force", list(picture.on_rod.force))
        << field("torque", list(picture.on_rod.torque)) << "</FieldData>\n"
        << piece_text(tip) << piece_text(rod) << piece_text(plane)
        << "</UnstructuredGrid>\n</VTKFile>\n";
  });
  times_.push_back(picture.time);
  write_series();
}

void Movie::write_series() const {
  meshes::write_atomically(folder_ / "movie.pvd", [&](std::ostream& out) {
    out << file_head("Collection") << "<Collection>\n";
    for (std::size_t frame = 0; frame < frames(); ++frame) {
      out << fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n",
                         meshes::to_text(times_[frame]), frame_name(frame));
    }
    out << "</Collection>\n</VTKFile>\n";
  });
}

}  // namespace fingertip::studies
