// STEP and BREP files, written here by gmsh's OpenCASCADE, as fingers.
#include "meshes/volume_mesh/cad_surface.h"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <set>
#include <utility>

#include "lattice/press/static_press.h"
#include "meshes/shape/solid.h"
#include "meshes/volume_mesh/volume_mesh.h"
#include "studies/config/loader.h"
#include "studies/config/shapes/solid_file.h"
#include "studies/exchange/fmu_files.h"
#include "tests/fingers.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using meshes::Geometry;

namespace {

const std::string rod =
    "x < 5 mm and x > -5 mm and y < 5 mm and y > -5 mm and z < 5 mm and "
    "z > -14.999 mm";

/// Writes what `make` adds to OpenCASCADE's model, in mm.
void write_cad(const std::filesystem::path& file, const std::function<void()>& make) {
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0.0);
  gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
  make();
  gmsh::model::occ::synchronize();
  gmsh::write(file.string());
  gmsh::finalize();
}

/// The paper's dome.
void make_dome() {
  namespace occ = gmsh::model::occ;
  gmsh::vectorpair whole, rest;
  std::vector<gmsh::vectorpair> map;
  const auto capsule = [&](double radius, double end) {
    const int ball = occ::addSphere(0, 0, 0, radius);
    const int shaft = occ::addCylinder(0, 0, 0, 0, 0, end, radius);
    gmsh::vectorpair upper, united;
    // The lower half of the ball lies within the shaft.
    occ::fuse({{3, ball}}, {{3, shaft}}, united, map);
    return united;
  };
  const auto outer = capsule(10, -15), inner = capsule(5, -15);
  occ::cut(outer, inner, rest, map);
}

TEST(CadFile, DomeOfAStepFileIsTheDome) {
  const TemporaryFolder folder;
  write_cad(folder / "dome.step", make_dome);
  meshes::write_cad_surface(folder / "dome.step", folder / "dome.stl");
  const Geometry dome, geometry = Geometry::of_solid(
                           studies::read_solid({folder / "dome.stl", "mm", rod}), -dome.rod_length);
  EXPECT_NEAR(geometry.tip_volume() / dome.tip_volume(), 1.0, 1e-3);
  EXPECT_NEAR(geometry.tip_radius, dome.tip_radius, 1e-5);
  EXPECT_NEAR(geometry.pole(), dome.pole(), 1e-5);
  EXPECT_NEAR(geometry.thickness(), dome.thickness(), 1e-5);
  EXPECT_NEAR(geometry.solid->wall(), dome.thickness(), 2e-5);
  lattice::PressSetup setup;
  setup.lattice.spacing = dome.tip_radius / 8;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = meshes::ContactMode::frictionless;
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  setup.protocol.samples = {1e-3, 2e-3, 3e-3};
  setup.protocol.depth = 3e-3;
  const auto expected = lattice::run_static_press(setup).response.samples();
  setup.geometry = geometry;
  const auto found = lattice::run_static_press(setup).response.samples();
  // Measured: 0.11 % at most, at R/12 0.085 %. Chords cut off a part of it; with 262 000 facets it
  // is 0.08 %, less than twice as many points of contact change the dome itself.
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i].normal_force / expected[i].normal_force, 1.0, 1.5e-3)
        << geometry.solid->mesh().triangles.size() << " facets";
}

TEST(CadFile, PlanesHaveFewFacets) {
  const TemporaryFolder folder;
  write_cad(folder / "block.step", [] { gmsh::model::occ::addBox(-4.5, -5, 0, 9, 10, 16); });
  meshes::write_cad_surface(folder / "block.step", folder / "block.stl");
  const Geometry block =
      Geometry::of_solid(studies::read_solid({folder / "block.stl", "mm", "z < 1 mm"}), 0.0);
  EXPECT_NEAR(block.tip_volume(), 1.44e-6, 1e-14);
  EXPECT_LT(block.solid->mesh().triangles.size(), 5000U);
}

/// A finger of R = 7.5 mm on a recess, its bottom edge rounded by 0.2 mm: a fillet is a chamfer
/// where it is below the shortest edge, and facets of the top grow with their depth (88 800 if they
/// do not).
TEST(CadFile, FilletsAndTopHaveFewFacets) {
  const TemporaryFolder folder;
  write_cad(folder / "fillet.step", [] {
    namespace occ = gmsh::model::occ;
    const auto point = [](double r, double z) { return occ::addPoint(r, 0, z); };
    const int rim = point(4.9, 0), foot = point(7.3, 0), side = point(7.5, 0.2),
              neck = point(7.5, 8), pole = point(0, 15.5), floor = point(0, 1.5),
              corner = point(4.9, 1.5);
    const std::vector<int> lines = {
        occ::addLine(rim, foot),   occ::addCircleArc(foot, point(7.3, 0.2), side),
        occ::addLine(side, neck),  occ::addCircleArc(neck, point(0, 8), pole),
        occ::addLine(pole, floor), occ::addLine(floor, corner),
        occ::addLine(corner, rim)};
    gmsh::vectorpair turned;
    occ::revolve({{2, occ::addPlaneSurface({occ::addCurveLoop(lines)})}}, 0, 0, 0, 0, 0, 1,
                 2.0 * std::numbers::pi, turned);
    occ::remove({{2, 1}}, false);
  });
  meshes::write_cad_surface(folder / "fillet.step", folder / "fillet.stl");
  const auto solid =
      studies::read_solid({folder / "fillet.stl", "mm",
                           "z < 1.51 mm and z > 0.01 mm and x < 4.92 mm and x > -4.92 mm and "
                           "y < 4.92 mm and y > -4.92 mm"});
  EXPECT_LT(solid->mesh().triangles.size(), 45000U);
  EXPECT_NEAR(solid->pole(), 15.5e-3, 1e-5);
  // The fillet cuts (1 - pi/4) 0.04 mm² off the edge, along 2 pi 7.455 mm.
  const double whole = std::numbers::pi * (7.5 * 7.5 * 8 + 2.0 / 3.0 * 421.875 - 4.9 * 4.9 * 1.5),
               cut = (1.0 - std::numbers::pi / 4.0) * 0.04 * 2.0 * std::numbers::pi * 7.455;
  EXPECT_NEAR(Geometry::of_solid(solid, 0.0).tip_volume() / (1e-9 * (whole - cut)), 1.0, 1e-3);
}

/// What touches first is finer wherever it points in the file.
TEST(CadFile, TheEndThatPointsUpIsFiner) {
  const TemporaryFolder folder;
  std::vector<double> counts;
  for (const char* up : {"+z", "+y"}) {
    write_cad(folder / "dome.step", [&] {
      make_dome();
      gmsh::vectorpair all;
      gmsh::model::occ::getEntities(all, 3);
      if (up[1] == 'y')  // z becomes y
        gmsh::model::occ::rotate(all, 0, 0, 0, 1, 0, 0, -0.5 * std::numbers::pi);
    });
    meshes::write_cad_surface(folder / "dome.step", folder / "dome.stl", up);
    const auto solid = studies::read_solid({folder / "dome.stl", "mm", rod, up});
    counts.push_back(double(solid->mesh().triangles.size()));
    EXPECT_NEAR(solid->pole(), 10e-3, 1e-5) << up;
    EXPECT_NEAR(solid->bond_top(), 5e-3, 1e-5) << up;
  }
  EXPECT_NEAR(counts[1] / counts[0], 1.0, 0.1);
}

/// Four upright edges are sharp, those of the top round. With refinement 0.5 the sizes first tried
/// leave elements turned inside out.
void make_pad() {
  namespace occ = gmsh::model::occ;
  const int box = occ::addBox(-8, -6, 0, 16, 12, 18);
  occ::synchronize();
  gmsh::vectorpair edges, rounded;
  gmsh::model::getEntitiesInBoundingBox(-9, -7, 17.9, 9, 7, 18.1, edges, 1);
  std::vector<int> upper;
  for (const auto& [dimension, tag] : edges) upper.push_back(tag);
  occ::fillet({box}, upper, {4.0}, rounded);
}

TEST(CadFile, SharpAndRoundEdgesAreFilledWithHexahedra) {
  const TemporaryFolder folder;
  write_cad(folder / "pad.step", make_pad);
  meshes::write_cad_surface(folder / "pad.step", folder / "pad.stl");
  const Geometry pad =
      Geometry::of_solid(studies::read_solid({folder / "pad.stl", "mm", "z < 2 mm"}), 0.0);
  for (const int axis : {0, 1}) EXPECT_TRUE(pad.solid->mirrored(axis));
  for (const auto& [sector, parts] :
       {std::pair{meshes::Sector::full, 1.0}, {meshes::Sector::quarter, 4.0}})
    for (const double refinement : {0.4, 0.5, 0.6}) {
      meshes::TipMeshOptions options = meshes::TipMeshOptions{}.refined(refinement);
      options.sector = sector;
      const meshes::MeshQuality quality = meshes::write_tip_mesh(pad, options, folder / "pad.msh");
      EXPECT_GT(quality.min_scaled_jacobian, 0.04) << refinement;
      // Straight sides.
      EXPECT_NEAR(parts * quality.volume / pad.tip_volume(), 1.0, 0.04) << refinement;
    }
}

/// The program makes triangles of it and keeps them.
TEST(CadFile, IsCheckedAndPressedByTheProgram) {
  const TemporaryFolder folder;
  write_cad(folder / "block.brep", [] { gmsh::model::occ::addBox(-0.4, -0.5, 0, 0.9, 1, 1.6); });
  write_text(folder / "block.toml",
             "[geometry]\nshape = \"solid\"\nfile = \"block.brep\"\nunit = \"cm\"\n"
             "bond = \"z < 0.1 cm\"\n[press]\nmode = \"static\"\ndepth = \"1 mm\"\n"
             "contact = \"frictionless\"\n[lattice]\nspacing = \"tip_radius/4\"\n");
  const ProgramResult checked = run_program(folder.path(), {"check", "block.toml"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  const auto surfaces = folder.path() / "cache" / "fingertip" / "surfaces";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(surfaces), {}), 1);
  const ProgramResult shape =
      run_program(folder.path(), {"shape", "block.brep", "--config", "block.toml"});
  EXPECT_EQ(shape.code, 0) << shape.err;
  EXPECT_NE(shape.out.find("1440 mm^3"), std::string::npos) << shape.out;
  const ProgramResult pressed =
      run_program(folder.path(), {"press", "--config", "block.toml", "--out", "run"});
  EXPECT_EQ(pressed.code, 0) << pressed.err;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(surfaces), {}), 1);
}

/// A CAD file would need fingertip-fem wherever the unit is loaded.
TEST(CadFile, AMockUpUnitCarriesItsTriangles) {
  const TemporaryFolder folder;
  write_cad(folder / "block.step", [] { gmsh::model::occ::addBox(-4.5, -5, 0, 9, 10, 16); });
  const std::string settings =
      "[geometry]\nshape = \"solid\"\nfile = \"block.step\"\nbond = \"z < 1 mm\"\n"
      "[lattice]\nspacing = \"tip_radius/4\"\n";
  write_text(folder / "block.toml", settings);
  const ProgramResult checked = run_program(folder.path(), {"check", "block.toml"});
  ASSERT_EQ(checked.code, 0) << checked.err;
  // The test has no fingertip-fem beside it: the triangles are those that the program has kept.
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  const studies::FmuExport unit =
      studies::fmu_export(studies::load_config({folder / "block.toml", {}, {}}));
  ASSERT_EQ(unit.files.size(), 1U);
  EXPECT_EQ(unit.files[0].name, "block.stl");
  EXPECT_NE(unit.settings.find("file = \"block.stl\""), std::string::npos) << unit.settings;
  EXPECT_EQ(unit.settings.find(".step"), std::string::npos) << unit.settings;
  const auto content_of = [](const std::filesystem::path& file) {
    return studies::read_solid({file, "mm", "z < 1 mm"})->content();
  };
  std::filesystem::copy_file(unit.files[0].source, folder / "block.stl");
  EXPECT_EQ(content_of(folder / "block.stl"), content_of(folder / "block.step"));
}

/// Face 1, face 2 ... in the order of the file.
void name_faces(const std::filesystem::path& step) {
  const std::string entity = "ADVANCED_FACE('";
  std::string text = read_text(step);
  int number = 0;
  for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos;) {
    at += entity.size();
    text.replace(at, text.find('\'', at) - at, "face " + std::to_string(++number));
  }
  write_text(step, text);
}

/// What a mesh has of a face.
struct FaceOf {
  Eigen::AlignedBox3d box;
  double area = 0.0, largest_radius = 0.0;
};
FaceOf face_of(const meshes::TriangleMesh& mesh, int number) {
  FaceOf face;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.faces[t] != number) continue;
    face.area += mesh.area_vector(t).norm();
    for (std::size_t c = 0; c < 3; ++c) {
      face.box.extend(mesh.corner(t, c));
      face.largest_radius = std::max(face.largest_radius, mesh.corner(t, c).head<2>().norm());
    }
  }
  return face;
}

TEST(CadFile, FacesKeepTheNamesOfAStepFile) {
  const TemporaryFolder folder;
  write_cad(folder / "block.step", [] { gmsh::model::occ::addBox(-4, -5, 0, 9, 11, 16); });
  meshes::write_cad_surface(folder / "block.step", folder / "none.stl");
  EXPECT_TRUE(studies::read_stl(folder / "none.stl").face_names.empty());
  name_faces(folder / "block.step");
  meshes::write_cad_surface(folder / "block.step", folder / "block.stl");
  const auto mesh = studies::read_stl(folder / "block.stl");
  ASSERT_EQ(mesh.face_names.size(), 6u);
  // Each is one side of the block.
  std::multiset<long> areas;
  for (int f = 0; f < 6; ++f) {
    const FaceOf face = face_of(mesh, f);
    EXPECT_NEAR(face.box.sizes().minCoeff(), 0.0, 1e-6) << mesh.face_names[std::size_t(f)];
    EXPECT_NEAR(face.area,
                face.box.sizes().x() * face.box.sizes().y() +
                    face.box.sizes().y() * face.box.sizes().z() +
                    face.box.sizes().z() * face.box.sizes().x(),
                1e-3);
    areas.insert(std::lround(face.area));
    const bool is_base = face.box.max().z() < 1e-6;
    if (!is_base) continue;
    const std::string base = mesh.face_names[std::size_t(f)];
    EXPECT_EQ(studies::read_solid({folder / "block.stl", "mm", base})->content(),
              studies::read_solid({folder / "block.stl", "mm", "z < 0 mm"})->content());
  }
  EXPECT_EQ(areas, (std::multiset<long>{99, 99, 144, 144, 176, 176}));
}

/// Curved ones, of which several are held.
TEST(CadFile, NamedFacesHoldTheDome) {
  const TemporaryFolder folder;
  write_cad(folder / "dome.step", make_dome);
  name_faces(folder / "dome.step");
  meshes::write_cad_surface(folder / "dome.step", folder / "dome.stl");
  const auto mesh = studies::read_stl(folder / "dome.stl");
  std::string held;
  for (int f = 0; f < int(mesh.face_names.size()); ++f)
    if (face_of(mesh, f).largest_radius < 5.001)
      held += (held.empty() ? "" : " or ") + mesh.face_names[std::size_t(f)];
  const auto by_name = studies::read_solid({folder / "dome.stl", "mm", held}),
             by_place = studies::read_solid({folder / "dome.stl", "mm", rod});
  using enum meshes::ProfileSurface;
  // Half spaces leave the last micrometre of the sleeve free, so that its end is.
  EXPECT_NEAR(by_name->area(bond) / by_place->area(bond), 1.0, 1e-4);
  EXPECT_NEAR(by_name->bond_top(), 5e-3, 1e-6);
  EXPECT_NEAR(by_name->bond_radius(), 5e-3, 1e-6);
}

TEST(CadFile, RefusesNamesThatAreNone) {
  const TemporaryFolder folder;
  write_cad(folder / "block.step", [] { gmsh::model::occ::addBox(-4, -5, 0, 9, 11, 16); });
  name_faces(folder / "block.step");
  const auto checked = [&](const std::string& bond) {
    write_text(folder / "block.toml",
               "[geometry]\nshape = \"solid\"\nfile = \"block.step\"\nbond = \"" + bond +
                   "\"\n[press]\ndepth = \"1 mm\"\n");
    return run_program(folder.path(), {"check", "block.toml"});
  };
  const ProgramResult wrong = checked("base");
  EXPECT_EQ(wrong.code, 2);
  for (const char* part : {"block.toml:4", "base", "face 1, face 2", "face 6"})
    EXPECT_NE(wrong.err.find(part), std::string::npos) << part << " not in\n" << wrong.err;
  int taken = 0;  // the top may not be held, the bottom and a side may
  for (int f = 1; f <= 6; ++f) taken += checked("face " + std::to_string(f)).code == 0;
  EXPECT_EQ(taken, 5);
}

TEST(CadFile, RefusesWhatIsNoSolid) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      meshes::write_cad_surface(folder / name, folder / "out.stl");
    } catch (const meshes::InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  write_text(folder / "text.step", "no STEP file");
  EXPECT_NE(refusal("text.step").find("text.step"), std::string::npos);
  write_cad(folder / "two.step", [] {
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::addBox(2, 0, 0, 1, 1, 1);
  });
  EXPECT_NE(refusal("two.step").find("2 solids"), std::string::npos) << refusal("two.step");
  write_cad(folder / "disk.brep", [] { gmsh::model::occ::addDisk(0, 0, 0, 1, 1); });
  EXPECT_NE(refusal("disk.brep").find("0 solids"), std::string::npos) << refusal("disk.brep");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.stl"));
  write_text(folder / "case.toml",
             "[geometry]\nshape = \"solid\"\nfile = \"text.step\"\n"
             "bond = \"z < 1 mm\"\n");
  const ProgramResult checked = run_program(folder.path(), {"check", "case.toml"});
  EXPECT_EQ(checked.code, 2);
  EXPECT_NE(checked.err.find("case.toml:3"), std::string::npos) << checked.err;
  EXPECT_EQ(checked.err.find('\033'), std::string::npos) << checked.err;  // colours
}

}  // namespace
