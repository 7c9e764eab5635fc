// The continuum of profiles and solids in space: their meshes follow the true surface, and presses
// agree with those of the dome where they are the dome.
#include <deal.II/dofs/dof_tools.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "fem_reference/elements/assembly.h"
#include "fem_reference/motion/tip_modes.h"
#include "fem_reference/tip/curved_sides.h"
#include "fem_reference/tip/tip_body.h"
#include "meshes/shape/geometry.h"
#include "tests/fem_reference/press/pressing.h"
#include "tests/fingers.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;
using meshes::Geometry;
using meshes::PhysicalTag;
using meshes::Sector;
using meshes::Vector3;

namespace {

/// With one corner pulled out [m]: beyond 1.3e-6 it is no mirror image of itself any more.
Geometry block(double pulled = 0.0) {
  meshes::TriangleMesh box = fingers::box({-0.008, -0.01, 0.0}, {0.008, 0.01, 0.018});
  for (int axis = 0; axis < 2; ++axis) box.vertices.back()[axis] += pulled;
  return Geometry::of_solid(
      std::make_shared<meshes::Solid>(box, meshes::Region{{{2, true, 1e-3}}}));
}

std::unique_ptr<Body<3>> read(const SharedMesh& mesh, const Geometry& geometry, double tilt = 0.0) {
  return fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), 2, tilt, geometry);
}

double area(const Body<3>& body, PhysicalTag tag) {
  return fem_reference::area(body, dealii::types::boundary_id(tag));
}

TEST(AnyShape, RefinedCellsKeepToTheSurface) {
  const double tilt = 0.3;
  for (const Geometry& geometry :
       {fingers::solid_dome(48, 32), Geometry::of_profile(fingers::dome())}) {
    const Sector sector = geometry.solid ? Sector::full : Sector::half;
    const double share = geometry.solid ? 1.0 : 0.5;
    const SharedMesh mesh(0.5, sector, geometry);
    const auto body = read(mesh, geometry, tilt);
    body->triangulation.refine_global(1);
    body->number(fem_reference::tip_supports<3>());
    const auto shape = meshes::shape_of(geometry);
    const auto near = [&](double value, double exact) {
      EXPECT_NEAR(value / (share * exact), 1.0, 2e-3);
    };
    near(volume(*body), shape->volume());
    near(area(*body, PhysicalTag::bond), shape->area(meshes::ProfileSurface::bond));
    near(area(*body, PhysicalTag::outer), shape->area(meshes::ProfileSurface::contact));
    const double s = std::sin(tilt), c = std::cos(tilt);
    double farthest = 0.0;
    for (const auto& node : outer_nodes(*body)) {
      const Vector3& at = node.position;
      const Vector3 own(c * at.x() + s * at.z(), at.y(), c * at.z() - s * at.x());
      farthest = std::max(farthest, shape->nearest(meshes::ProfileSurface::contact, own).distance);
    }
    EXPECT_LT(farthest, 1e-11);
  }
}

/// A linear displacement is in equilibrium, also where elements meet smaller ones, whichever way
/// the divided tetrahedra turn their faces to each other.
TEST(AnyShape, PassesThePatchTest) {
  const Geometry geometry = block();
  const SharedMesh mesh(0.3, Sector::full, geometry);
  const auto body = read(mesh, geometry);
  for (const auto& cell : body->triangulation.active_cell_iterators())
    if (cell->center().distance(dealii::Point<3>(0, 0, 0.018)) < 8e-3) cell->set_refine_flag();
  body->triangulation.execute_coarsening_and_refinement();
  body->number({});
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(body->mapping, body->fine.dofs, points);
  fem_reference::Vector u = body->fine.vector();
  std::vector<dealii::types::global_dof_index> indices(body->fine.element.n_dofs_per_cell());
  const Eigen::Matrix3d gradient =
      (Eigen::Matrix3d() << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.25, -0.9).finished();
  for (const auto& cell : body->fine.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < indices.size(); ++i) {
      const auto& x = points.at(indices[i]);
      if (!body->fine.constraints.is_constrained(indices[i]))
        u[indices[i]] =
            (gradient *
             Vector3(x[0], x[1], x[2]))[body->fine.element.system_to_component_index(i).first];
    }
  }
  fem_reference::HookeKernel<3> kernel({}, fem_reference::Volumetric::mean_dilatation);
  fem_reference::LinearSystem system(*body, false);
  assemble(*body, kernel, u, system);
  const dealii::IndexSet surface =
      dealii::DoFTools::extract_boundary_dofs(body->fine.dofs, dealii::ComponentMask(3, true));
  double inside = 0.0;
  for (const auto i : body->fine.owned)
    if (!surface.is_element(i)) inside = std::max(inside, std::abs(double(system.force[i])));
  EXPECT_LT(inside, 1e-11 * system.force.linfty_norm());
  // What is not held is the block; the lower edges, which are held, are rounded off.
  EXPECT_NEAR(area(*body, PhysicalTag::outer) / (2 * 0.036 * 0.017 + 0.016 * 0.02), 1.0, 1e-9);
  EXPECT_NEAR(volume(*body) / (0.016 * 0.02 * 0.018), 1.0, 0.01);
}

/// Where the bond hides the block's lower edges, sides are parabolas that keep to themselves.
TEST(AnyShape, CellsAtHiddenEdgesAreDividedAndNotTurned) {
  const double tilt = 0.3;
  const Geometry geometry = block();
  const SharedMesh mesh(0.4, Sector::full, geometry);
  const auto body = read(mesh, geometry, tilt);
  body->number({});
  const double whole = volume(*body), held = area(*body, PhysicalTag::bond);
  for (int level = 0; level < 2; ++level) {
    for (const auto& cell : body->triangulation.active_cell_iterators())
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary() && PhysicalTag(face->boundary_id()) == PhysicalTag::bond)
          cell->set_refine_flag();
    body->triangulation.execute_coarsening_and_refinement();
  }
  body->number({});
  EXPECT_NEAR(area(*body, PhysicalTag::bond) / held, 1.0, 1e-5);
  EXPECT_NEAR(volume(*body) / whole, 1.0, 2e-4);
  fem_reference::HookeKernel<3> kernel({}, fem_reference::Volumetric::mean_dilatation);
  fem_reference::LinearSystem system(*body, false);
  // Refuses cells that are turned.
  EXPECT_NO_THROW(assemble(*body, kernel, body->fine.vector(), system));
}

/// A cylinder of few facets under a dome: at the end of its bond edges are no parabolas.
TEST(AnyShape, CellsAtAnEdgeOfFacetsAreDividedAndNotTurned) {
  constexpr double radius = 8e-3, bond = 3e-3;
  std::vector<std::array<double, 2>> curve = {{0.0, 0.0}, {radius, 0.0}};
  for (const double angle : {0.0, 0.4, 0.8, 1.2})
    curve.push_back({radius * std::cos(angle), 0.012 + radius * std::sin(angle)});
  curve.push_back({0.0, 0.012 + radius});
  const Geometry geometry = Geometry::of_solid(std::make_shared<meshes::Solid>(
      fingers::revolved(curve, 10), meshes::Region{{{2, true, bond}}}));
  const SharedMesh mesh(0.5, Sector::half, geometry);
  const auto body = read(mesh, geometry);
  for (int level = 0; level < 4; ++level) {
    for (const auto& cell : body->triangulation.active_cell_iterators())
      for (const auto& face : cell->face_iterators())
        for (const unsigned v : face->vertex_indices())
          if (face->at_boundary() && PhysicalTag(face->boundary_id()) == PhysicalTag::bond &&
              std::abs(face->vertex(v)[2] - bond) < 1e-7)
            cell->set_refine_flag();
    const unsigned before = body->triangulation.n_active_cells();
    body->triangulation.execute_coarsening_and_refinement();
    ASSERT_GT(body->triangulation.n_active_cells(), before + 100);
  }
  body->number({});
  fem_reference::HookeKernel<3> kernel({}, fem_reference::Volumetric::mean_dilatation);
  fem_reference::LinearSystem system(*body, false);
  EXPECT_NO_THROW(assemble(*body, kernel, body->fine.vector(), system));
}

/// A cell across the block's lower edge that a parabola would turn inside out, and no other.
TEST(AnyShape, SidesAreFlatWhereTheLastCellWouldBeTurned) {
  const Geometry geometry = block();
  std::vector<dealii::Point<3>> corners;
  for (const double y : {2e-4, -2e-4})
    for (const auto& [x, z] :
         {std::pair{7.6e-3, 0.0}, {8e-3, 3e-4}, {7.3e-3, 1e-4}, {7.9e-3, 6e-4}})
      corners.emplace_back(x, y, z);
  std::vector<dealii::CellData<3>> cells(1);
  for (unsigned v = 0; v < 8; ++v) cells[0].vertices[v] = v;
  dealii::SubCellData sides;
  sides.boundary_quads.emplace_back();
  sides.boundary_quads.back().vertices = {0, 1, 4, 5};
  sides.boundary_quads.back().boundary_id = dealii::types::boundary_id(PhysicalTag::bond);
  Body<3> body(MPI_COMM_SELF, 2);
  body.triangulation.create_triangulation(corners, cells, sides);
  fem_reference::follow_boundary(body, geometry, 0.0);
  const auto cell = body.triangulation.begin();
  for (const unsigned l : cell->line_indices())
    EXPECT_EQ(cell->line(l)->manifold_id(), dealii::numbers::flat_manifold_id) << l;
  for (const auto& face : cell->face_iterators())
    EXPECT_EQ(face->manifold_id(), dealii::numbers::flat_manifold_id);
}

/// A cell across a fillet that is small beside it, on the finger's outer surface. Its side's middle
/// is nearest to the base or to the flank: either turns a corner of the cell inside out.
TEST(AnyShape, SidesAreFlatAtFilletsThatAreSmallBesideTheCell) {
  std::vector<std::array<double, 2>> curve{
      {0.0, 1.5e-3}, {4.9e-3, 1.5e-3}, {4.9e-3, 0.0}, {7.3e-3, 0.0}};
  for (int i = 1; i <= 6; ++i) {
    const double angle = std::numbers::pi * i / 12;
    curve.push_back({7.3e-3 + 2e-4 * std::sin(angle), 2e-4 - 2e-4 * std::cos(angle)});
  }
  curve.insert(curve.end(), {{7.5e-3, 9e-3}, {0.0, 16.5e-3}});
  const meshes::Region recess{{{0, true, 4.95e-3},
                               {0, false, -4.95e-3},
                               {1, true, 4.95e-3},
                               {1, false, -4.95e-3},
                               {2, true, 1.6e-3},
                               {2, false, 1e-4}}};
  const Geometry geometry =
      Geometry::of_solid(std::make_shared<meshes::Solid>(fingers::revolved(curve, 180), recess));
  std::vector<dealii::Point<3>> corners;
  for (const double y : {2e-4, -2e-4})
    for (const auto& [x, z] :
         {std::pair{7.0e-3, 0.0}, {7.5e-3, 5e-4}, {6.9e-3, 1e-5}, {7.49e-3, 6e-4}})
      corners.emplace_back(x, y, z);
  std::vector<dealii::CellData<3>> cells(1);
  for (unsigned v = 0; v < 8; ++v) cells[0].vertices[v] = v;
  dealii::SubCellData sides;
  sides.boundary_quads.emplace_back();
  sides.boundary_quads.back().vertices = {0, 1, 4, 5};
  sides.boundary_quads.back().boundary_id = dealii::types::boundary_id(PhysicalTag::outer);
  Body<3> body(MPI_COMM_SELF, 2);
  body.triangulation.create_triangulation(corners, cells, sides);
  fem_reference::follow_boundary(body, geometry, 0.0);
  const auto cell = body.triangulation.begin();
  for (const unsigned l : cell->line_indices())
    EXPECT_EQ(cell->line(l)->manifold_id(), dealii::numbers::flat_manifold_id) << l;
  for (const auto& face : cell->face_iterators())
    EXPECT_EQ(face->manifold_id(), dealii::numbers::flat_manifold_id);
}

ReferenceJob small_press_of(const Geometry& geometry, ContactMode contact = ContactMode::stick) {
  ReferenceJob job = small_press();
  job.geometry = geometry;
  job.protocol.contact = contact;
  job.refinement = 0.5;
  return job;
}

/// The edge of a contact moves over a dome, and stays at the rim of a block.
TEST(AnyShape, KnowsWhetherItsEdgeIsFree) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press_of(block(), mode);
    job.refinement = 0.3;
    job.press_to({2e-4});
    EXPECT_FALSE(pressed(job, 1.0).free_edge);
    job.geometry = fingers::solid_dome(24, 16);
    EXPECT_TRUE(pressed(job, 1.0).free_edge);
    // A ball leaves most of the block's face alone.
    job.geometry = block();
    job.protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = 0.02};
    EXPECT_TRUE(pressed(job, 1.0).free_edge);
  }
}

/// One coarse mesh is a percent or two off; with error bars they are in MEASUREMENTS.md.
TEST(AnyShape, TiltedDomeOfAnyKindIsTheDome) {
  ReferenceJob job = small_press_of({}, ContactMode::frictionless);
  job.protocol.tilt = 0.3;
  const fem_reference::PressState dome = pressed(job, 1.0);
  for (const Geometry& geometry :
       {Geometry::of_profile(fingers::dome(), -0.03), fingers::solid_dome(48, 32)}) {
    job.geometry = geometry;
    const fem_reference::PressState sample = pressed(job, 1.0);
    EXPECT_NEAR(sample.normal_force / dome.normal_force, 1.0, 0.02);
    EXPECT_NEAR(sample.contact_radius / dome.contact_radius, 1.0, 0.12);
    const double moment = 0.03 * dome.normal_force;
    EXPECT_NEAR(sample.torque_y, dome.torque_y, 0.01 * moment);
    EXPECT_NEAR(sample.torque_x, 0.0, 0.01 * moment);
    EXPECT_NEAR(sample.torque_z, 0.0, 0.01 * moment);
    EXPECT_EQ(sample.lateral_force_y, 0.0);  // frictionless
  }
}

/// Tilt, lateral motion and a ball beside the axis at once, also at large strain: the hand takes
/// what the obstacle gives, and the work of the press is stored.
TEST(AnyShape, SolidHandsOnAllThatPushesIt) {
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    ReferenceJob job = small_press_of(block(1e-5));
    job.strain = strain;
    job.refinement = 0.3;
    job.protocol.tilt = 0.15;
    job.protocol.lateral = 3e-4;
    job.protocol.obstacle = {meshes::ObstacleShape::sphere, 0.02, meshes::ObstacleAxis::y, 2e-3};
    Pressing pressing(job);
    pressing.press.set_longest_step(0.05);
    const fem_reference::PressState sample = pressing.press.advance(1e-3);
    const Vector3 bond = pressing.press.bond_reaction();
    EXPECT_GT(sample.normal_force, 0.0);
    EXPECT_NEAR(bond.z() / sample.normal_force, 1.0, 1e-6);
    EXPECT_NEAR(-bond.x() / sample.lateral_force_x, 1.0, 1e-5);
    EXPECT_NEAR(-bond.y(), sample.lateral_force_y, 1e-6 * sample.normal_force);
    // Where the solid is cut by y = 0 it is drawn.
    const auto section = pressing.press.section(*pressing.press.snapshot());
    EXPECT_GT(section.size(), 20u);
    for (const auto& edge : section) EXPECT_TRUE(std::isfinite(edge.deformed[0]));
  }
}

/// A half and a quarter with its mirror planes is the whole but for their coarse meshes.
TEST(AnyShape, AMirroredSolidIsPressedByItsParts) {
  ReferenceJob job = small_press_of(block());
  const auto whole = [&] {
    ReferenceJob other = job;
    other.geometry = block(1e-5);
    EXPECT_EQ(sector(other), Sector::full);
    return pressed(other, 0.1);
  };
  EXPECT_EQ(sector(job), Sector::quarter);
  const PressState quarter = pressed(job, 0.1), all = whole();
  EXPECT_NEAR(quarter.normal_force / all.normal_force, 1.0, 0.02);
  EXPECT_NEAR(quarter.contact_radius / all.contact_radius, 1.0, 0.05);
  EXPECT_EQ(quarter.lateral_force_x, 0.0);
  job.protocol.lateral = 3e-4;
  EXPECT_EQ(sector(job), Sector::half);
  const PressState half = pressed(job, 0.1), moved = whole();
  EXPECT_NEAR(half.normal_force / moved.normal_force, 1.0, 0.02);
  EXPECT_NEAR(half.lateral_force_x / moved.lateral_force_x, 1.0, 0.02);
  EXPECT_NEAR(half.torque_y / moved.torque_y, 1.0, 0.05);
  EXPECT_EQ(half.lateral_force_y, 0.0);
}

/// What is turned by 180 degrees about the axis is pushed aside the other way.
TEST(AnyShape, TurnsWithItsObstacle) {
  ReferenceJob job = small_press_of(fingers::solid_dome(48, 32));
  job.protocol.obstacle = {meshes::ObstacleShape::sphere, 0.01, meshes::ObstacleAxis::y, 3e-3};
  const PressState right = pressed(job, 0.2);
  job.protocol.obstacle.offset = -3e-3;
  const PressState left = pressed(job, 0.2);
  const double force = right.normal_force;
  EXPECT_NEAR(left.normal_force / force, 1.0, 0.02);
  EXPECT_GT(std::abs(right.lateral_force_x), 0.05 * force);
  EXPECT_NEAR(left.lateral_force_x, -right.lateral_force_x, 0.02 * force);
  EXPECT_NEAR(right.lateral_force_y, 0.0, 0.02 * force);
}

/// The lowest mode, torsion, of a whole solid, of a quarter of a profile and of the dome.
TEST(AnyShape, TwistsAsTheDome) {
  ReferenceJob job;
  job.analysis = fem_reference::Analysis::modes;
  const auto lowest = [&](const Geometry& geometry) {
    job.geometry = geometry;
    const SharedMesh mesh(0.35, sector(job), geometry);
    fem_reference::TipModes modes(job, mesh.file());
    return modes.solve(fem_reference::symmetry_classes[geometry.solid ? 0 : 3], 1)[0].frequency;
  };
  const double dome = lowest({});
  EXPECT_NEAR(lowest(Geometry::of_profile(fingers::dome())) / dome, 1.0, 0.01);
  EXPECT_NEAR(lowest(fingers::solid_dome(48, 32)) / dome, 1.0, 0.01);
}

}  // namespace
