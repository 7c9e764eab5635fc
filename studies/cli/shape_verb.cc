#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "meshes/cubic_grid.h"
#include "meshes/meridian.h"
#include "studies/cli/verbs.h"
#include "studies/config/profile_file.h"
#include "studies/report/figure.h"

namespace fingertip::studies {
namespace {

using meshes::Geometry;
using meshes::Meridian;
using meshes::MeridianPiece;
using meshes::ProfileSurface;

constexpr double mm = 1e-3;
/// Memory of a press in motion, at all and per V/a³ [MB]: measured on the dome at R/12, R/24, R/32
/// (network; 77, 339 and 691 MB).
constexpr double least_memory = 40.0, memory_per_mass = 3.7e-3;

struct Look {
  ProfileSurface surface;
  const char* colour;
  const char* meaning;
};
constexpr Look looks[] = {{ProfileSurface::contact, "#0072b2", "contact: may touch"},
                          {ProfileSurface::bond, "#d55e00", "bond: held by the hand"},
                          {ProfileSurface::free, "#666666", "free"}};

/// The whole section, left half mirrored.
reporting::Figure section(const Meridian& meridian, const std::string& name) {
  reporting::Panel panel;
  panel.x_label = "x [mm]", panel.y_label = "z [mm]";
  panel.equal_scales = true;
  panel.key = "outside right top";
  for (const Look& look : looks) {
    reporting::Series series{look.meaning, "", {}, {}, {}, {look.colour, "", 2.5}};
    for (const double side : {1.0, -1.0})
      for (const MeridianPiece& piece : meridian.pieces()) {
        if (piece.surface() != look.surface) continue;
        constexpr int points = 48;
        for (int i = 0; i <= points; ++i) {
          const meshes::Vector2 place = piece.at(double(i) / points);
          series.x.push_back(side * place.x() / mm);
          series.y.push_back(place.y() / mm);
        }
        series.x.push_back(std::nan("")), series.y.push_back(std::nan(""));
      }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  reporting::Figure figure;
  figure.name = name;
  figure.panels.push_back(std::move(panel));
  return figure;
}

}  // namespace

int run_shape(const CommandLine& line) {
  namespace fs = std::filesystem;
  if (line.arguments.empty())
    refuse("shape", "no file is given", "give the CSV file of a meridian");
  for (const std::string& word : line.arguments) {
    const fs::path file = word;
    const Geometry geometry = Geometry::of_profile(read_profile(file));
    const Meridian meridian(geometry);
    fmt::print("{}: a closed meridian of {} pieces\n", word, meridian.pieces().size());
    fmt::print("  height            {:.4g} mm, from {:.4g} to the pole at {:.4g} mm\n",
               (meridian.pole() - meridian.lowest()) / mm, meridian.lowest() / mm,
               meridian.pole() / mm);
    fmt::print("  largest radius    {:.4g} mm\n", meridian.largest_radius() / mm);
    fmt::print("  rubber            {:.5g} mm^3\n", meridian.volume() / (mm * mm * mm));
    for (const Look& look : looks)
      fmt::print("  {:<8}          {:.5g} mm^2\n", name(look.surface),
                 meridian.area(look.surface) / (mm * mm));
    fmt::print("  thinnest wall     {:.4g} mm\n", meridian.wall() / mm);
    fmt::print("  pole above bond   {:.4g} mm, the limit of press.depth\n",
               geometry.thickness() / mm);
    const double coarsest = geometry.coarsest_spacing();
    for (const double spacing : {std::min(coarsest, geometry.tip_radius / 8),
                                 std::min(0.5 * coarsest, geometry.tip_radius / 16)}) {
      const double masses = meshes::expected_particle_count(geometry, spacing);
      fmt::print(
          "  lattice           tip_radius/{:.3g} = {:.3g} mm: about {:.2g} masses, {:.0f} MB in "
          "motion\n",
          std::ceil(10.0 * geometry.tip_radius / spacing) / 10.0, spacing / mm, masses,
          least_memory + masses * memory_per_mass);
    }
    const fs::path folder = line.out.empty() ? file.parent_path() : line.out;
    if (!folder.empty()) fs::create_directories(folder);
    const std::string stem = file.stem().string() + "_section";
    reporting::draw(section(meridian, stem), file.stem().string() + ", section",
                    folder.empty() ? "." : folder);
    fmt::print("  drawn             {}\n", (folder / (stem + ".svg")).string());
  }
  return 0;
}

}  // namespace fingertip::studies
