#include "lattice/model/cut_tip.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline model {

using meshes::CubicGrid;
using meshes::CutCell;
using meshes::Geometry;
using meshes::ProfileSurface;
using meshes::Rubber;
using meshes::SurfacePoint;
using meshes::Vector3;
using meshes::Violation;

namespace {

/// Surface points lie a third of a spacing apart.
constexpr double points_per_spacing = 3.0;

void check_tip(const Geometry& geometry, const Rubber& rubber, const LatticeSettings& settings,
               int sectors) {
  std::vector<Violation> found = geometry.violations();
  append(found, cell_violations(rubber, settings));
  append(found, settings.grid_violations(geometry));
  if (settings.spacing < smallest_spacing * geometry.tip_radius) {
    found.push_back({"lattice.spacing", meshes::to_text(settings.spacing) + " m",
                     "the spacing of cells cut by true surfaces must be at least R/320",
                     "choose a coarser lattice"});
  }
  append(found, sector_violations(geometry, settings, sectors));
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// Points of a surface above `lowest` [m], in the sector, embedded with `stiffness` [Pa/m].
std::vector<EmbeddedPoint> embedded_surface(const GridCells& cells, const Geometry& geometry,
                                            ProfileSurface surface, double lowest, int sectors,
                                            double stiffness) {
  std::vector<EmbeddedPoint> embedded;
  const double apart = cells.grid().spacing / points_per_spacing;
  for (const SurfacePoint& point : meshes::surface_points(geometry, surface, apart)) {
    const Vector3& at = point.position;
    if (at.z() < lowest || (sectors > 1 && at.y() < 0.0) || (sectors == 4 && at.x() < 0.0)) {
      continue;
    }
    embedded.push_back(tie(cells, point, stiffness));
  }
  return embedded;
}

}  // namespace

CutTip cut_tip(const Geometry& geometry, const Rubber& rubber, const LatticeSettings& settings,
               int sectors, int spare_rows) {
  check_tip(geometry, rubber, settings, sectors);
  CubicGrid grid = tip_grid(geometry, settings, sectors);
  grid.size[0] += spare_rows;
  std::vector<CutCell> cut = meshes::cut_cells(geometry, grid, smallest_fraction);
  const Sector sector(sectors, grid.axes);
  std::erase_if(cut, [&](const CutCell& cell) { return sector.is_before(cell.index); });
  CutTip tip{GridCells(grid, largest_piece(grid, cut)),
             sector,
             formulation_for(rubber, settings),
             {},
             {},
             {}};
  const double stiffness = tie_stiffness * tip.formulation.shear / grid.spacing;
  // All of the bond holds, wherever it lies; of a profile's contact what round-off may put below.
  constexpr double everywhere = -std::numeric_limits<double>::infinity();
  const double slack = geometry.is_dome() ? 0.0 : 1e-9 * geometry.tip_radius;
  tip.bond = embedded_surface(tip.cells, geometry, ProfileSurface::bond, everywhere, sectors,
                              stiffness * settings.ligament_stiffness);
  tip.outer = embedded_surface(tip.cells, geometry, ProfileSurface::contact,
                               lowest_contact(geometry) - slack, sectors,
                               stiffness * settings.contact_stiffness);
  if (tip.formulation.material.large_strain()) tip.contact = layer_law(rubber.energy, grid.spacing);
  return tip;
}

// x is nearest the finger's axis: rows are longest there, and forces are computed row by row.
CubicGrid tip_grid(const Geometry& geometry, const LatticeSettings& settings, int sectors) {
  Eigen::Index nearest = 0;
  settings.axes.row(2).cwiseAbs().maxCoeff(&nearest);
  Eigen::Matrix3d order = Eigen::Matrix3d::Zero();
  for (Eigen::Index d = 0; d < 3; ++d) order((nearest + d) % 3, d) = 1.0;
  CubicGrid grid = meshes::covering_grid(
      geometry, settings.spacing, order.transpose() * settings.offset, 1, settings.axes * order);
  Sector(sectors, grid.axes).crop(grid);
  // Planes through the finger's axis lie where a part has its mirror planes: at an odd index.
  const std::array<int, 3> middle = grid.nearest(Vector3::Zero());
  for (std::size_t d = 1; d < 3; ++d) {
    if (middle[d] % 2 != 0) continue;
    grid.origin[Eigen::Index(d)] -= grid.spacing;
    ++grid.size[d];
  }
  return grid;
}

int grid_symmetry(const Geometry& geometry, const LatticeSettings& settings) {
  if (!settings.axes.isIdentity(0.0)) return 1;
  const auto mirrored = [&](int axis) {
    return settings.offset[axis] == 0.0 && geometry.mirrored(axis);
  };
  return !mirrored(1) ? 1 : mirrored(0) ? 4 : 2;
}

std::vector<Violation> sector_violations(const Geometry& geometry, const LatticeSettings& settings,
                                         int sectors) {
  const bool known = sectors == 1 || sectors == 2 || sectors == 4;
  if (known && sectors <= grid_symmetry(geometry, settings)) return {};
  return {
      {"sectors", std::to_string(sectors),
       "the tip divides into 1, 2 or 4 parts, and into several only along planes of grid points",
       "compute the whole tip, or remove offset and rotation; a solid must be its own mirror "
       "image"}};
}

double lowest_contact(const Geometry& geometry) {
  return std::max(geometry.lowest(), geometry.pole() - geometry.tip_radius - geometry.thickness());
}

}  // namespace fingertip::lattice::inline model
