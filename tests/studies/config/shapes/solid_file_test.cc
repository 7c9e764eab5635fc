#include "studies/config/shapes/solid_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/shape/revolved_surface.h"
#include "meshes/shape/stl_file.h"
#include "tests/fingers.h"
#include "tests/stl_text.h"
#include "tests/studies/loaded.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::Vector3;

namespace {

meshes::TriangleMesh finger() {
  return fingers::box({-0.006, -0.005, 0.0}, {0.004, 0.007, 0.02});
}

const std::string settings =
    "[geometry]\nshape = \"solid\"\nfile = \"finger.stl\"\nbond = \"z < 1 mm\"\n"
    "[press]\ndepth = \"1 mm\"\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// What the loader says of a configuration with this file; empty when it is fine.
std::string refusal_of(const std::string& stl, const std::string& toml = settings) {
  const TemporaryFolder folder;
  write_text(folder / "finger.stl", stl);
  write_text(folder / "case.toml", toml);
  return config_refusal([&] { config_in(folder / "case.toml"); });
}

void expect_refused(const std::string& refusal, const std::vector<std::string>& parts) {
  EXPECT_TRUE(says(refusal, parts));
}

TEST(SolidFile, ReadsBothFormsOfStl) {
  const TemporaryFolder folder;
  write_text(folder / "text.stl", stl_text(finger()));
  // A binary file may begin with the word solid, too.
  write_text(folder / "bytes.STL", with(stl_bytes(finger()), "     ", "solid"));
  for (const char* name : {"text.stl", "bytes.STL"}) {
    const auto mesh = read_stl(folder / name);
    ASSERT_EQ(mesh.triangles.size(), 12u) << name;
    for (std::size_t t = 0; t < 12; ++t)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR((mesh.corner(t, c) - 1e3 * finger().corner(t, c)).norm(), 0.0, 1e-6);
  }
}

TEST(SolidFile, MakesTheFingerOfAConfiguration) {
  const TemporaryFolder folder;
  write_text(folder / "finger.stl", stl_text(finger()));
  write_text(folder / "case.toml", with(settings, "shape", "endpoint = \"-2 mm\"\nshape") +
                                       "\n[lattice]\nspacing = \"tip_radius/12\"\n");
  const LoadedConfig finger_case = config_in(folder / "case.toml");
  const meshes::Geometry& geometry = finger_case.config.press.geometry;
  ASSERT_TRUE(geometry.solid);
  EXPECT_EQ(geometry.shape_name(), "solid");
  EXPECT_NEAR(geometry.tip_volume(), 2.4e-6, 1e-15);
  EXPECT_NEAR(geometry.tip_radius, std::hypot(0.006, 0.007), 1e-12);
  EXPECT_NEAR(geometry.thickness(), 0.019, 1e-12);
  EXPECT_NEAR(geometry.rod_endpoint().z(), -0.002, 1e-15);
  EXPECT_NEAR(finger_case.config.press.lattice.spacing, geometry.tip_radius / 12, 1e-12);
  // The resolved configuration is the same finger from anywhere.
  const auto again =
      load_config({{},
                   {"geometry.shape=solid", "geometry.bond=z < 1 mm",
                    "geometry.file=" + (folder / "finger.stl").string(), "press.depth=1 mm"},
                   {}});
  EXPECT_EQ(again.config.press.geometry.solid->content(), geometry.solid->content());
  // Another unit of the same numbers.
  const auto centimetres =
      config_in(folder / "case.toml", {"geometry.unit=cm", "geometry.bond=z < 1 cm"});
  EXPECT_NEAR(centimetres.config.press.geometry.tip_volume() / geometry.tip_volume(), 1000.0, 1e-6);
}

/// The block is 10 x 12 x 20 mm; what points up in the file becomes +z, the shortest way.
TEST(SolidFile, TurnsAndShiftsTheFinger) {
  const TemporaryFolder folder;
  write_text(folder / "finger.stl", stl_text(finger()));
  const Vector3 low(-0.006, -0.005, 0.0), high(0.004, 0.007, 0.02);
  const auto read = [&](const std::string& up, const Vector3& origin, bool touch = false) {
    const auto solid = read_solid({folder / "finger.stl", "mm", "z < -2.9 mm", up, origin, touch});
    EXPECT_NEAR(solid->volume(), 2.4e-6, 1e-15) << up;
    return solid;
  };
  const auto box_of = [](const meshes::Solid& solid) {
    Eigen::AlignedBox3d box;
    for (const Vector3& vertex : solid.mesh().vertices) box.extend(vertex);
    return box;
  };
  // Rows: the file's directions, with their signs, that are x, y and z then.
  const std::map<std::string, std::array<int, 3>> turns = {{"+z", {1, 2, 3}},  {"-z", {1, -2, -3}},
                                                           {"+x", {-3, 2, 1}}, {"-x", {3, 2, -1}},
                                                           {"+y", {1, -3, 2}}, {"-y", {1, 3, -2}}};
  for (const auto& [up, rows] : turns) {
    const Vector3 origin(1e-3, 2e-3, 10e-3);
    const auto box = box_of(*read(up, origin));
    for (int axis = 0; axis < 3; ++axis) {
      const int from = std::abs(rows[std::size_t(axis)]) - 1;
      const double a = (low - origin)[from], b = (high - origin)[from];
      const double sign = rows[std::size_t(axis)] < 0 ? -1.0 : 1.0;
      EXPECT_NEAR(box.min()[axis], std::min(sign * a, sign * b), 1e-9) << up << axis;
      EXPECT_NEAR(box.max()[axis], std::max(sign * a, sign * b), 1e-9) << up << axis;
    }
  }
  // The middle of the end is on the axis; heights stay.
  const auto touched = box_of(*read("+y", Vector3(0.0, 0.0, 0.0), true));
  EXPECT_NEAR(touched.center().x(), 0.0, 1e-9);
  EXPECT_NEAR(touched.center().y(), 0.0, 1e-9);
  EXPECT_NEAR(touched.max().z(), 0.007, 1e-9);
  // As keys.
  write_text(folder / "case.toml", settings);
  const auto box_with = [&](std::vector<std::string> sets) {
    sets.emplace_back("geometry.bond=z < -4 mm");
    return box_of(*config_in(folder / "case.toml", sets).config.press.geometry.solid);
  };
  EXPECT_NEAR(box_with({"geometry.up=+y", "geometry.origin=touch"}).center().y(), 0.0, 1e-9);
  EXPECT_NEAR(box_with({"geometry.origin=[\"1 mm\", \"0 mm\", \"1 cm\"]"}).max().z(), 0.01, 1e-9);
  const auto refused = [&](const std::string& geometry) {
    return refusal_of(stl_text(finger()), with(settings, "shape", geometry + "\nshape"));
  };
  expect_refused(refused("up = \"y\""), {"case.toml:2", "geometry.up", "+y"});
  expect_refused(refused("origin = \"top\""), {"case.toml:2", "list of quantities", "touch"});
  expect_refused(refused("origin = [\"touch\", \"0 mm\", \"0 mm\"]"), {"case.toml:2", "touch"});
  expect_refused(refusal_of(stl_text(finger()), with(settings, "z < 1 mm", "z > 15.3 mm")),
                 {"bond up to z = 20 mm", "no bond may lie higher", "geometry.up = \"-z\""});
  expect_refused(refused("origin = [\"9 mm\", \"0 mm\", \"0 mm\"]"),
                 {"axis x = y = 0", "geometry.origin = \"touch\""});
}

/// A meridian's file is made into an STL file, in mm, which is read as any other.
TEST(SolidFile, MakesTrianglesOfAMeridian) {
  const TemporaryFolder folder;
  const meshes::Geometry profile = meshes::Geometry::of_profile(fingers::solid());
  write_text(folder / "finger.CSV",
             "r [cm],z [cm],surface,curve\n1.25,0,contact,\n1.25,1.25,contact,arc 0 1.25\n"
             "0,2.5,axis,\n0,0,bond,\n");
  const auto solid = read_solid({folder / "finger.CSV", "mm", "z < 0 mm"});
  const meshes::TriangleMesh mesh = meshes::revolved_surface(meshes::Meridian(profile.corners()));
  // An STL file has seven digits.
  EXPECT_NEAR(solid->volume() / profile.tip_volume(),
              1.0 + meshes::deviation(mesh, meshes::Meridian(profile.corners())).volume, 1e-6);
  EXPECT_NEAR(solid->area(meshes::ProfileSurface::bond), std::numbers::pi * 0.0125 * 0.0125, 1e-6);
  meshes::write_stl(mesh, 1e-3, "a finger", folder / "finger.stl");
  const auto again = read_solid({folder / "finger.stl", "mm", "z < 0 mm"});
  EXPECT_EQ(again->content(), solid->content());
  EXPECT_THROW(read_solid({folder / "finger.CSV", "cm", "z < 0 mm"}), meshes::InvalidInput);
  write_text(folder / "open.csv", "r [mm],z [mm],surface,curve\n5,0,contact,\n0,9,axis,\n");
  expect_refused(refusal_of("", with(settings, "finger.stl", (folder / "open.csv").string())),
                 {"case.toml:3", "open.csv", "at least three"});
}

TEST(SolidFile, ReadsHalfSpaces) {
  const auto region = parse_bond("z < 1 mm and x>-0.2cm or y <= 3e-3 m").region;
  ASSERT_EQ(region.size(), 2u);
  ASSERT_EQ(region[0].size(), 2u);
  ASSERT_EQ(region[1].size(), 1u);
  EXPECT_EQ(region[0][0].axis, 2);
  EXPECT_TRUE(region[0][0].below);
  EXPECT_NEAR(region[0][0].limit, 1e-3, 1e-18);
  EXPECT_EQ(region[0][1].axis, 0);
  EXPECT_FALSE(region[0][1].below);
  EXPECT_NEAR(region[0][1].limit, -2e-3, 1e-18);
  EXPECT_EQ(region[1][0].axis, 1);
  EXPECT_NEAR(region[1][0].limit, 3e-3, 1e-18);
  EXPECT_TRUE(parse_bond("  ").region.empty());
}

TEST(SolidFile, ReadsNamesOfFaces) {
  const std::vector<std::string> faces = {"base", "left and right", "z < 9 mm"};
  EXPECT_EQ(parse_bond(" base ", faces).faces, std::vector<std::string>{"base"});
  EXPECT_EQ(parse_bond("left and right", faces).faces, std::vector<std::string>{faces[1]});
  EXPECT_TRUE(parse_bond("z < 9 mm", faces).region.empty());  // a name is one, whatever it says
  const Bond both = parse_bond("z < 1 mm and x > 0 mm or base or y > 2 mm", faces);
  EXPECT_EQ(both.faces, std::vector<std::string>{"base"});
  ASSERT_EQ(both.region.size(), 2u);
  EXPECT_EQ(both.region[0].size(), 2u);
  EXPECT_EQ(both.region[1].size(), 1u);
  EXPECT_THROW(parse_bond("base and z < 1 mm", faces), meshes::InvalidInput);
  EXPECT_THROW(parse_bond("Base", faces), meshes::InvalidInput);
}

/// A text holds several solids; the program that wrote it names them.
TEST(SolidFile, SolidsOfATextAreFaces) {
  const TemporaryFolder folder;
  meshes::TriangleMesh mesh = finger();
  mesh.faces.assign(12, -1);  // as fingers::box has them: base, top, four sides
  for (const std::size_t t : {0, 1}) mesh.faces[t] = mesh.face_number("glued base");
  for (const std::size_t t : {4, 5, 6, 7}) mesh.faces[t] = mesh.face_number("Sides");
  meshes::write_stl(mesh, 1e-3, "", folder / "finger.stl");
  const auto read = read_stl(folder / "finger.stl");
  EXPECT_EQ(read.face_names, (std::vector<std::string>{"glued base", "Sides"}));
  EXPECT_EQ(std::ranges::count(read.faces, 0), 2);
  EXPECT_EQ(std::ranges::count(read.faces, 1), 4);
  EXPECT_EQ(std::ranges::count(read.faces, -1), 6);
  const auto area = [&](const char* bond) {
    return read_solid({folder / "finger.stl", "mm", bond})->area(meshes::ProfileSurface::bond);
  };
  EXPECT_NEAR(area("glued base"), 120e-6, 1e-12);
  EXPECT_NEAR(area("z < 2 mm or glued base"), 120e-6 + 2e-3 * 0.044, 1e-12);  // cut facets too
  const std::string text = read_text(folder / "finger.stl");
  const auto asked = [&](const std::string& bond) {
    return refusal_of(text, with(settings, "z < 1 mm", bond));
  };
  EXPECT_EQ(asked("glued base"), "");
  expect_refused(asked("base"),
                 {"case.toml:4", "base: no face of the file has this name", "glued base, Sides"});
  expect_refused(asked(""), {"held by the hand", "glued base, Sides"});
  // Up to its face, in a cup; but not by what should touch.
  EXPECT_EQ(asked("glued base or Sides"), "");
  expect_refused(asked("z > 20 mm"), {"no bond may lie higher"});
}

TEST(SolidFile, RefusesWithPlaceAndRemedy) {
  const std::string good = stl_text(finger()), bytes = stl_bytes(finger());
  EXPECT_EQ(refusal_of(good), "");
  EXPECT_EQ(refusal_of(bytes), "");
  const auto asked = [&](const std::string& from, const std::string& to) {
    return refusal_of(good, with(settings, from, to));
  };
  expect_refused(asked("file = \"finger.stl\"\n", ""), {"case.toml:2", "geometry.file", "surface"});
  expect_refused(asked("finger.stl", "other.stl"), {"other.stl", "no such file"});
  expect_refused(asked("finger.stl", "finger.obj"),
                 {"case.toml:3", "finger.obj", "export it as .stl"});
  expect_refused(asked("finger.stl", "finger.igs"), {"case.toml:3", "export it as .step"});
  expect_refused(asked("bond = \"z < 1 mm\"\n", ""), {"geometry.bond = \"z < 1 mm\"", "held"});
  expect_refused(asked("z < 1 mm", "z < 1"), {"case.toml:4", "z < 1", "unit"});
  expect_refused(asked("z < 1 mm", "w < 1 mm"), {"case.toml:4", "x, y or z"});
  expect_refused(asked("z < 1 mm", "z = 1 mm"), {"case.toml:4", "< or >"});
  expect_refused(asked("z < 1 mm", "base"),
                 {"case.toml:4", "base: no face of the file has this name", "name faces: finger"});
  expect_refused(refusal_of(bytes, with(settings, "z < 1 mm", "base")),
                 {"case.toml:4", "base: the file names no faces"});
  expect_refused(asked("z < 1 mm", "z < 1 mm and"), {"case.toml:4", "and"});
  expect_refused(asked("z < 1 mm", "z < 1 kg"), {"case.toml:4", "kg"});
  expect_refused(asked("bond", "unit = \"m\"\nbond"),
                 {"case.toml:4", "20 m across", "0.5 mm to 0.5 m", "geometry.unit"});
  expect_refused(asked("bond", "unit = \"kg\"\nbond"), {"case.toml:4", "kg", "unit of length"});
  expect_refused(asked("\"1 mm\"\n", "\"25 mm\"\n"), {"press.depth", "pole over the bond"});
  expect_refused(refusal_of(""), {"finger.stl", "no complete STL file"});
  expect_refused(refusal_of(with(good, "endsolid finger", "")), {"finger.stl", "cut off"});
  expect_refused(refusal_of(with(good, "vertex", "vertx")), {"finger.stl:4", "vertx"});
  expect_refused(refusal_of(with(good, "vertex -6", "vertex six")), {"finger.stl:4", "numbers"});
  expect_refused(refusal_of(with(good, "   vertex", "vertex 0 0 0\n   vertex")),
                 {"finger.stl:7", "three vertices"});
  expect_refused(refusal_of(bytes.substr(0, bytes.size() - 30)),
                 {"finger.stl", "84 bytes", "12", "anew"});
  const std::size_t first = good.find(" facet"), second = good.find(" facet", first + 1);
  expect_refused(refusal_of(std::string(good).erase(first, second - first)),
                 {"case.toml:3", "open edge at (x, y, z) = (", "fill the hole"});
}

/// Corners moved at random: what crosses itself is told, what does not is a finger.
TEST(SolidFile, SurvivesBentFingers) {
  std::mt19937 generator(5);
  std::normal_distribution<double> shift(0.0, 1.0);
  const auto straight =
      fingers::revolved({{0.0, 0.0}, {0.006, 0.0}, {0.006, 0.006}, {0.0, 0.012}}, 7);
  int accepted = 0;
  for (int i = 0; i < 500; ++i) {
    auto bent = straight;
    for (Vector3& w : bent.vertices)
      w += 1e-5 * double(i) * Vector3(shift(generator), shift(generator), shift(generator));
    try {
      const meshes::Solid solid(bent, {{{2, true, 1e-3}}});
      EXPECT_GT(solid.volume(), 0.0);
      EXPECT_GT(solid.wall(), 0.0);
      ++accepted;
    } catch (const meshes::InvalidInput&) {
    }
  }
  EXPECT_GT(accepted, 50);
  EXPECT_LT(accepted, 450);
}

}  // namespace
