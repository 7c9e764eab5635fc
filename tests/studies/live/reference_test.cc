#include "studies/live/reference.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>

#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::Vector3;

namespace {

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8U) | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0U);
    for (unsigned k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[(group >> (18U - 6U * k)) & 63U];
  }
  return text;
}

template <class Number>
std::string raw(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// As deal.II writes it: one compressed block.
std::string packed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string block(size, '\0');
  compress(reinterpret_cast<Bytef*>(block.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  block.resize(size);
  const std::vector<std::uint32_t> header = {1, std::uint32_t(bytes.size()),
                                             std::uint32_t(bytes.size()), std::uint32_t(size)};
  return base64(raw(header)) + base64(block);
}

/// Part of a shell about z, from angle 0 on, `eighths` of half a turn, of hexahedra that share no
/// points; displaced by a linear field.
struct Shell {
  std::vector<float> points, moved;
  std::vector<std::int32_t> corners, offsets;
  std::vector<std::uint8_t> types;

  explicit Shell(int eighths = 8) {
    const auto place = [](int i, int j, int k) {
      const double radius = k == 0 ? 0.5 : 1.0, angle = M_PI * i / 8.0, height = -0.2 * j;
      return Vector3(radius * std::cos(angle), radius * std::sin(angle), height);
    };
    for (int i = 0; i < eighths; ++i)
      for (int j = 0; j < 3; ++j) {
        for (int corner = 0; corner < 8; ++corner) {
          const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
          const int* at = around[corner % 4];
          const Vector3 p = place(i + at[0], j + at[1], corner / 4);
          const Vector3 u = 0.1 * Vector3(p.z(), -p.x(), p.y());
          for (int c = 0; c < 3; ++c) {
            points.push_back(float(p[c]));
            moved.push_back(float(u[c]));
          }
          corners.push_back(std::int32_t(corners.size()));
        }
        offsets.push_back(std::int32_t(corners.size()));
        types.push_back(12);
      }
  }
  std::string text() const {
    const auto array = [](const std::string& attributes, const std::string& bytes) {
      return "<DataArray " + attributes + " format=\"binary\">\n" + packed(bytes) +
             "\n</DataArray>\n";
    };
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
           "compressor=\"vtkZLibDataCompressor\" byte_order=\"LittleEndian\">\n<Points>\n" +
           array("type=\"Float32\" NumberOfComponents=\"3\"", raw(points)) +
           "</Points>\n<Cells>\n" + array("type=\"Int32\" Name=\"connectivity\"", raw(corners)) +
           array("type=\"Int32\" Name=\"offsets\"", raw(offsets)) +
           array("type=\"UInt8\" Name=\"types\"", raw(types)) + "</Cells>\n<PointData>\n" +
           array("type=\"Float32\" Name=\"displacement\" NumberOfComponents=\"3\"", raw(moved)) +
           "</PointData>\n</VTKFile>\n";
  }
};

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace

TEST(SurfaceFields, FindsTheOuterSurfaceAndItsDisplacement) {
  const TemporaryFolder folder;
  write(folder.path() / "a.vtu", Shell().text());
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
  write(folder.path() / "a.vtu", Shell(4).text());
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
  const std::string good = Shell().text();
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
  write(run / "reference" / "fields" / "press_0001.vtu", Shell().text());
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
