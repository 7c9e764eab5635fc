#include "studies/live/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "shell_vtu.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::Vector3;

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace

TEST(SurfaceFields, FindsTheOuterSurfaceAndItsDisplacement) {
  const TemporaryFolder folder;
  write(folder.path() / "a.vtu", ShellVtu().text());
  const SurfaceMesh half = outer_surface(read_vtu(folder.path() / "a.vtu"));
  EXPECT_EQ(half.rest.size(), 9u * 4u);
  EXPECT_EQ(half.edges.size(), 8u * 4u + 9u * 3u);
  for (std::size_t i = 0; i < half.rest.size(); ++i) {
    const Vector3& p = half.rest[i];
    EXPECT_NEAR(std::hypot(p.x(), p.y()), 1.0, 1e-6);
    EXPECT_LT((half.displacement[i] - 0.1 * Vector3(p.z(), -p.x(), p.y())).norm(), 1e-7);
  }
  const SurfaceMesh whole = completed(half);
  EXPECT_EQ(whole.rest.size(), 2 * half.rest.size());
  EXPECT_EQ(whole.edges.size(), 2 * half.edges.size());
  EXPECT_EQ(completed(whole).rest.size(), whole.rest.size());
}

TEST(SurfaceFields, AQuarterBecomesTheWholeTip) {
  const TemporaryFolder folder;
  write(folder.path() / "a.vtu", ShellVtu(4).text());
  const SurfaceMesh quarter = outer_surface(read_vtu(folder.path() / "a.vtu"));
  const SurfaceMesh whole = completed(quarter);
  ASSERT_EQ(whole.rest.size(), 4 * quarter.rest.size());
  EXPECT_EQ(whole.edges.size(), 4 * quarter.edges.size());
  for (const auto& [i, j] : whole.edges)
    EXPECT_LT((whole.rest[i] - whole.rest[j]).norm(), 0.5);  // neighbours stay neighbours
  for (const Vector3& mirror : {Vector3(-1, 1, 1), Vector3(1, -1, 1), Vector3(-1, -1, 1)}) {
    for (std::size_t i = 0; i < quarter.rest.size(); ++i) {
      std::size_t found = 0;
      for (std::size_t k = 0; k < whole.rest.size(); ++k) {
        const bool here = whole.rest[k] == mirror.cwiseProduct(quarter.rest[i]);
        found +=
            here && whole.displacement[k] == mirror.cwiseProduct(quarter.displacement[i]) ? 1 : 0;
      }
      EXPECT_GE(found, 1u);
    }
  }
}

TEST(SurfaceFields, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string good = ShellVtu().text();
  const auto file = folder.path() / "b.vtu";
  EXPECT_THROW(read_vtu(folder.path() / "absent.vtu"), meshes::InvalidInput);
  for (const std::string& text : {std::string(), std::string("<VTKFile>"),
                                  good.substr(0, good.size() / 2), good.substr(0, 300)}) {
    write(file, text);
    EXPECT_THROW(read_vtu(file), meshes::InvalidInput);
  }
  // Whatever a changed byte does, it is either no matter or refused.
  for (std::size_t at = 0; at < good.size(); at += 37) {
    std::string text = good;
    text[at] = char(text[at] ^ 0x15);
    write(file, text);
    try {
      read_vtu(file);
    } catch (const meshes::InvalidInput&) {
    }
  }
}

TEST(Reference, ReadsCurveAndFieldsOfARunFolder) {
  const TemporaryFolder folder;
  const auto run = folder.path() / "run";
  EXPECT_THROW(read_reference(run), meshes::InvalidInput);
  write(run / "reference" / "response.csv",
        "indentation [m],normal_force [N]\n0.001,0.03\n0.002,0.1\n");
  const Reference bare = read_reference(run);
  EXPECT_EQ(bare.response.samples().size(), 2u);
  EXPECT_TRUE(bare.overlays.empty());
  write(run / "reference" / "fields" / "press_0001.vtu", ShellVtu().text());
  write(run / "reference" / "fields" / "press.pvd",
        "<VTKFile><Collection><DataSet timestep=\"0.001\" part=\"0\" file=\"press_0001.vtu\"/>"
        "</Collection></VTKFile>");
  const Reference full = read_reference(run);
  ASSERT_EQ(full.overlays.size(), 1u);
  EXPECT_EQ(full.overlays[0].indentation, 0.001);
  const std::string bytes = encode_overlay(full.overlays[0]);
  const SurfaceMesh& surface = full.overlays[0].surface;
  EXPECT_EQ(bytes.size(), 8 + 24 * surface.rest.size() + 8 * surface.edges.size());
  write(run / "reference" / "fields" / "press.pvd", "<DataSet timestep=\"x\" file=\"y\"/>");
  EXPECT_THROW(read_reference(run), meshes::InvalidInput);
}
