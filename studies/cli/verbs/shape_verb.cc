#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/cells/cubic_grid.h"
#include "meshes/shape/geometry.h"
#include "meshes/shape/meridian.h"
#include "meshes/shape/revolved_surface.h"
#include "meshes/shape/solid.h"
#include "meshes/shape/stl_file.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/shapes/profile_file.h"
#include "studies/report/figure/drawing.h"

namespace fingertip::studies::inline cli::inline verbs {
namespace {

using meshes::Geometry;
using meshes::Meridian;
using meshes::MeridianPiece;
using meshes::ProfileSurface;
using meshes::Solid;
using meshes::Vector3;

constexpr double mm = 1e-3, um = 1e-6;
/// Memory of a press in motion, at all and per V/a³ [MB]: measured on the dome at R/12, R/24, R/32
/// (network; 77, 339 and 691 MB).
constexpr double min_memory = 40.0, memory_per_mass = 3.7e-3;

struct Look {
  ProfileSurface surface;
  const char* colour;
  const char* meaning;
};
constexpr Look looks[] = {{ProfileSurface::contact, "#0072b2", "contact: may touch"},
                          {ProfileSurface::bond, "#d55e00", "bond: held by the hand"},
                          {ProfileSurface::free, "#666666", "free"}};

void add(report::Series& outline, double across, double up) {
  outline.add(across / mm, up / mm);
}
void end(report::Series& outline) {
  outline.add(meshes::unknown, meshes::unknown);
}

/// Of the whole section, left half mirrored.
void trace(const Meridian& meridian, ProfileSurface surface, report::Series& outline) {
  for (const double side : {1.0, -1.0})
    for (const MeridianPiece& piece : meridian.pieces()) {
      if (piece.surface() != surface) continue;
      constexpr int points = 48;
      for (int i = 0; i <= points; ++i) {
        const meshes::Vector2 place = piece.at(double(i) / points);
        add(outline, side * place.x(), place.y());
      }
      end(outline);
    }
}

/// Where facets meet the plane y = 0.
void trace(const Solid& solid, ProfileSurface surface, report::Series& outline) {
  if (surface == ProfileSurface::free) return;  // what is not held may touch
  for (std::size_t t = 0; t < solid.mesh().triangles.size(); ++t) {
    if (solid.is_bond(t) != (surface == ProfileSurface::bond)) continue;
    int crossings = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3 &a = solid.mesh().corner(t, c), &b = solid.mesh().corner(t, (c + 1) % 3);
      if ((a.y() < 0.0) == (b.y() < 0.0)) continue;
      const Vector3 place = a + a.y() / (a.y() - b.y()) * (b - a);
      add(outline, place.x(), place.z());
      ++crossings;
    }
    if (crossings > 0) end(outline);
  }
}

report::Figure section(const auto& shape, const std::string& name) {
  report::Panel panel{
      .x_label = "x [mm]", .y_label = "z [mm]", .equal_scales = true, .key = "outside right top"};
  for (const Look& look : looks) {
    report::Series outline{look.meaning, "", {look.colour, "", 2.5}};
    trace(shape, look.surface, outline);
    if (!outline.x.empty()) panel.series.push_back(std::move(outline));
  }
  return {.name = name, .panels = {panel}};
}

/// What a lattice of it takes.
void print_lattices(const Geometry& geometry) {
  const double coarsest = geometry.coarsest_spacing();
  for (const double spacing : {std::min(coarsest, geometry.tip_radius / 8),
                               std::min(0.5 * coarsest, geometry.tip_radius / 16)}) {
    const double masses = meshes::expected_particle_count(geometry, spacing);
    fmt::print(
        "  lattice           tip_radius/{:.3g} = {:.3g} mm: about {:.2g} masses, {:.0f} MB in "
        "motion\n",
        std::ceil(10.0 * geometry.tip_radius / spacing) / 10.0, spacing / mm, masses,
        min_memory + masses * memory_per_mass);
  }
  if (const std::string thin = thin_part(geometry); !thin.empty())
    fmt::print("                    {}\n", thin);
}

/// Whether most of the axis runs outside the rubber, from the bond to where it leaves at the top: a
/// recess or a notch is no cavity that a wall surrounds.
bool is_hollow(const meshes::Shape& shape) {
  constexpr int places = 64;
  int rubber = 0, empty = 0;
  for (int i = places - 1; i >= 0; --i) {
    const double share = (i + 0.5) / places;
    const double z = shape.bond_top() + share * (shape.pole() - shape.bond_top());
    if (shape.signed_distance({0.0, 0.0, z}) <= 0.0)
      ++rubber;
    else if (rubber > 0)
      ++empty;
  }
  return empty >= rubber;
}

/// Of a hollow finger the wall. Of a solid one the shortest way through it, unless nothing is
/// shorter than the height of the pole over the bond, which Shape::wall() gives then.
void print_thinnest(const meshes::Shape& shape) {
  constexpr double round_off = 1e-9;
  if (is_hollow(shape))
    fmt::print("  thinnest wall     {:.4g} mm\n", shape.wall() / mm);
  else if (shape.wall() < (1.0 - round_off) * (shape.pole() - shape.bond_top()))
    fmt::print("  solid             at least {:.4g} mm thick, straight inward from contact\n",
               shape.wall() / mm);
  else
    fmt::print("  solid             no wall\n");
}

void print_measures(const Geometry& geometry, const meshes::Shape& shape) {
  fmt::print("  height            {:.4g} mm, from {:.4g} to the pole at {:.4g} mm\n",
             (shape.pole() - shape.lowest()) / mm, (shape.lowest() + 0.0) / mm,
             (shape.pole() + 0.0) / mm);
  fmt::print("  largest radius    {:.4g} mm\n", shape.largest_radius() / mm);
  fmt::print("  rubber            {:.5g} mm^3\n", shape.volume() / (mm * mm * mm));
  for (const Look& look : looks)
    fmt::print("  {:<8}          {:.5g} mm^2\n", name(look.surface),
               shape.area(look.surface) / (mm * mm));
  print_thinnest(shape);
  fmt::print("  pole above bond   {:.4g} mm, the limit of press.depth\n",
             geometry.thickness() / mm);
  print_lattices(geometry);
}

/// Names for geometry.bond.
void print_faces(const meshes::TriangleMesh& mesh) {
  std::vector<double> areas(mesh.face_names.size(), 0.0);
  for (std::size_t t = 0; t < mesh.faces.size(); ++t)
    if (mesh.faces[t] >= 0) areas[std::size_t(mesh.faces[t])] += mesh.area_vector(t).norm();
  for (std::size_t f = 0; f < areas.size(); ++f)
    fmt::print("  face              {}, {:.5g} mm^2\n", mesh.face_names[f], areas[f] / (mm * mm));
}

/// What [geometry] says of a solid in this file. A press need not fit it yet.
Geometry solid_of(const CommandLine& line, const std::filesystem::path& file) {
  ConfigSource source = line.config;
  source.sets.emplace_back("geometry.shape=dome");
  Config config = load_config(source).config;
  config.solid.file = std::filesystem::absolute(file);
  return Geometry::of_solid(read_solid(config.solid), config.endpoint);
}

/// A table, unless its name is that of a solid or of another kind of surface.
bool is_meridian(const std::filesystem::path& file) {
  if (file.extension() != ".txt" && !boost::iequals(file.extension().string(), ".csv"))
    check_kind_of_solid(file);
  return !is_solid_file(file);
}

/// Of a meridian: triangles of its surface, and how far they are from it.
meshes::TriangleMesh triangles_of(const Meridian& meridian) {
  const meshes::TriangleMesh mesh = meshes::revolved_surface(meridian);
  const meshes::SurfaceDeviation far = meshes::deviation(mesh, meridian);
  fmt::print("  triangles         {}, within {:.2g} um of the surface, volume {:+.2g} %\n",
             mesh.triangles.size(), far.largest / um, 100.0 * far.volume);
  return mesh;
}

/// Refuses what is no name of a file that can be written.
void check_stl(const CommandLine& line) {
  if (line.stl.empty()) return;
  if (line.arguments.size() > 1)
    refuse("shape --stl", "it takes the surface of one finger", "give one file");
  if (std::filesystem::exists(line.stl) && !line.force)
    refuse("shape --stl " + line.stl.string(), "the file exists already",
           "choose another name, or say --force to replace it");
}

void write_triangles(const CommandLine& line, const meshes::TriangleMesh& mesh,
                     const std::string& name) {
  const std::filesystem::path folder = line.stl.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  meshes::write_stl(mesh, mm, "surface of " + name, line.stl);
  fmt::print("  written           {}\n", line.stl.string());
}

/// Tells a finger and draws its section.
void tell(const CommandLine& line, const std::filesystem::path& file, const Geometry& geometry) {
  namespace fs = std::filesystem;
  const std::string stem = file.stem().string() + "_section";
  report::Figure figure;
  if (geometry.solid) {
    const meshes::TriangleMesh& mesh = geometry.solid->mesh();
    fmt::print("{}: a closed surface of {} facets\n", file.string(), mesh.triangles.size());
    print_measures(geometry, *geometry.solid);
    print_faces(mesh);
    if (!line.stl.empty()) write_triangles(line, mesh, file.stem());
    figure = section(*geometry.solid, stem);
  } else {
    const Meridian meridian(geometry.corners());
    fmt::print("{}: a closed meridian of {} pieces\n", file.string(), meridian.pieces().size());
    print_measures(geometry, meridian);
    if (!line.stl.empty()) write_triangles(line, triangles_of(meridian), file.stem());
    figure = section(meridian, stem);
  }
  const fs::path& folder = line.out;  // here, where none is named: the file may be somebody else's
  if (!folder.empty()) fs::create_directories(folder);
  report::draw(figure, file.stem().string() + ", section", folder.empty() ? "." : folder);
  fmt::print("  drawn             {}\n", (folder / (stem + ".svg")).string());
}

/// The finger that a configuration names.
void tell_configured(const CommandLine& line, const ConfigSource& source) {
  const Config config = load_config(source).config;
  if (config.shape == ShapeKind::dome)
    refuse(
        "shape", "the configuration's finger is the dome, which is no file",
        "write geometry.shape = \"profile\" and geometry.profile = \"FILE.csv\", or \"solid\" and "
        "geometry.file");
  const auto& file = config.shape == ShapeKind::profile ? config.profile : config.solid.file;
  tell(line, std::filesystem::proximate(file), config.press.geometry);
}

}  // namespace

int run_shape(const CommandLine& line) {
  check_stl(line);
  if (line.arguments.empty()) {
    if (line.config.file.empty() && line.config.sets.empty())
      refuse("shape", "no file is given",
             "give the CSV file of a meridian, or a solid's, or a configuration that names one: "
             "--config FILE.toml");
    tell_configured(line, line.config);
  }
  for (const std::filesystem::path file : line.arguments) {
    if (file.extension() == ".toml")
      tell_configured(line, {file, line.config.sets, {}});
    else
      tell(line, file,
           is_meridian(file) ? Geometry::of_profile(read_profile(file)) : solid_of(line, file));
  }
  return 0;
}

}  // namespace fingertip::studies::inline cli::inline verbs
