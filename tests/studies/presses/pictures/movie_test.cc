// A movie for ParaView, read back without the code that wrote it.

#include "studies/presses/pictures/movie.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lattice/press/press.h"
#include "tests/coarse_press.h"
#include "tests/expectations.h"
#include "tests/studies/presses/pictures/vtk_reader.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using meshes::Vector3;
using studies::Movie;

namespace {

/// Checks that arrays fit together and returns the number of cells per VTK type.
std::map<int, int> cells_of(const std::string& piece) {
  const auto points = std::stoul(between(piece, "NumberOfPoints=\"", "\""));
  const auto cells = std::stoul(between(piece, "NumberOfCells=\"", "\""));
  EXPECT_EQ(array_of<float>(piece, "Points").size(), 3 * points);
  EXPECT_EQ(array_of<float>(piece, "displacement").size(), 3 * points);
  EXPECT_EQ(array_of<std::uint8_t>(piece, "held").size(), points);
  const auto corners = array_of<std::int32_t>(piece, "connectivity");
  const auto ends = array_of<std::int32_t>(piece, "offsets");
  const auto types = array_of<std::uint8_t>(piece, "types");
  EXPECT_EQ(types.size(), cells);
  EXPECT_EQ(ends.size(), cells);
  for (const std::int32_t corner : corners) EXPECT_LT(std::size_t(corner), points);
  const std::map<int, int> corners_of = {{1, 1}, {3, 2}, {5, 3}, {9, 4}};
  std::map<int, int> counts;
  std::int32_t begin = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    EXPECT_EQ(ends[c] - begin, corners_of.at(types[c]));
    begin = ends[c];
    ++counts[types[c]];
  }
  EXPECT_EQ(std::size_t(begin), corners.size());
  return counts;
}

}  // namespace

TEST(Movie, FramesHoldTipRodAndPlaneAsVtkReadsThem) {
  const TemporaryFolder folder;
  const lattice::PressSetup setup = coarse_press(2e-3);
  Movie movie(folder / "movie", setup.geometry);
  std::size_t places = 0, springs = 0;
  const lattice::PressOutcome outcome = lattice::run_press(
      setup, {}, {5, [&](const lattice::BoundaryView& view, const lattice::FingerPicture& picture) {
                    places = view.size();
                    springs = view.springs().size();
                    movie.add(view, picture);
                  }});
  ASSERT_EQ(movie.frames(), 5u);
  const std::string series = read_text(folder / "movie/movie.pvd");
  EXPECT_TRUE(says(series, "<DataSet timestep=\"0\" part=\"0\" file=\"frame_0000.vtu\"/>"));
  const std::string last = read_text(folder / "movie/frame_0004.vtu");
  EXPECT_NEAR(std::stod(between(between(last, "\"TimeValue\"", "</"), ">", " <")),
              outcome.simulated_time, 1e-3);
  const std::vector<std::string> pieces = pieces_of(last);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(cells_of(pieces[0]), (std::map<int, int>{{1, int(places)}, {3, int(springs)}}));
  EXPECT_EQ(cells_of(pieces[1]), (std::map<int, int>{{5, 64}, {9, 256}}));
  EXPECT_EQ(cells_of(pieces[2]), (std::map<int, int>{{9, 1}}));
  // The rod has moved straight ahead, by clearance and depth; the plane has not.
  const auto rod = array_of<float>(pieces[1], "displacement");
  for (std::size_t i = 0; i < rod.size(); ++i) EXPECT_NEAR(rod[i], i % 3 == 2 ? 3e-3 : 0.0, 1e-5);
  for (const float moved : array_of<float>(pieces[2], "displacement")) EXPECT_EQ(moved, 0.0F);
  for (const int part : {0, 1, 2})
    for (const std::int32_t told : array_of<std::int32_t>(pieces[std::size_t(part)], "part"))
      EXPECT_EQ(told, part);
  int held = 0;
  for (const std::uint8_t flag : array_of<std::uint8_t>(pieces[0], "held"))
    held += flag > 0 ? 1 : 0;
  EXPECT_GT(held, 3);
}

TEST(Movie, PlaneAndRodFollowTheirPoses) {
  const TemporaryFolder folder;
  const lattice::LatticeModel model = lattice::LatticeModel();
  const meshes::Geometry geometry;
  Movie movie(folder.path(), geometry);
  const lattice::BoundaryView nothing(model, geometry);
  lattice::FingerPicture picture;
  picture.plane.point = Vector3(0.0, 0.0, 0.012);
  movie.add(nothing, picture);
  const Vector3 turn(0.0, 0.3, 0.0);
  picture.plane.turned = lattice::rotation_by(turn);
  picture.plane.normal = picture.plane.turned * picture.plane.normal;
  picture.rod.orientation = lattice::rotation_by(turn);
  picture.rod.position = Vector3(0.001, 0.0, 0.0);
  movie.add(nothing, picture);
  const std::vector<std::string> pieces = pieces_of(read_text(folder / "frame_0001.vtu"));
  ASSERT_EQ(pieces.size(), 3u);
  const auto plane = array_of<float>(pieces[2], "Points");
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Vector3 place(plane[3 * corner], plane[3 * corner + 1], plane[3 * corner + 2]);
    EXPECT_NEAR(picture.plane.gap(place), 0.0, 1e-8);
    EXPECT_NEAR((place - picture.plane.point).norm(), 0.015 * std::sqrt(2.0), 1e-8);
  }
  const auto rod = array_of<float>(pieces[1], "Points");
  const Vector3 pole = picture.rod * Vector3(0.0, 0.0, geometry.rod_radius);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(rod[rod.size() - 3 + std::size_t(axis)], pole[axis], 1e-8);
}
