#include "fem_reference/press/marker_field.h"

#include <deal.II/dofs/dof_tools.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/press/mesh_history.h"
#include "fem_reference/tip/job_mesh.h"
#include "fem_reference/tip/tip_body.h"
#include "meshes/press/marker_measures.h"
#include "tests/fem_reference/press/pressing.h"
#include "tests/fingers.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::Kinematics;
using fem_reference::MarkerField;
using fem_reference::ReferenceJob;
using fem_reference::Vector;
using meshes::MarkerRow;
using meshes::Vector3;

namespace {

/// On the dome and in it, on its sleeve, on every side of the axis.
std::vector<Vector3> scattered() {
  std::vector<Vector3> places = {{0.0, 0.0, 10e-3}, {0.0, 0.0, 7.7e-3}};
  for (const double angle : {0.0, 0.4, 2.0, 3.3, 5.5})
    for (const double radius : {5e-3, 6.8e-3, 10e-3})
      for (const double height : {-15e-3, -6.3e-3, 0.0, 0.6})  // a share of the radius above 0
        places.emplace_back(radius * (height > 0.0 ? 0.8 : 1.0) * std::cos(angle),
                            radius * (height > 0.0 ? 0.8 : 1.0) * std::sin(angle),
                            height > 0.0 ? radius * height : height);
  return places;
}

/// `field` in space at the nodes, along the mesh's components.
template <int dim>
Vector interpolated(const Body<dim>& body, const std::function<Vector3(const Vector3&)>& field) {
  std::map<dealii::types::global_dof_index, dealii::Point<dim>> points;
  dealii::DoFTools::map_dofs_to_support_points(body.mapping, body.fine.dofs, points);
  std::vector<dealii::types::global_dof_index> unknowns(body.fine.element.n_dofs_per_cell());
  Vector u = body.fine.vector();
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(unknowns);
    for (unsigned a = 0; a < unknowns.size(); ++a) {
      if (!body.fine.owned.is_element(unknowns[a])) continue;
      const Vector3 at =
          fem_reference::in_space<dim>(dealii::Tensor<1, dim>(points.at(unknowns[a])));
      u[unknowns[a]] =
          field(at)[Kinematics<dim>::axis[body.fine.element.system_to_component_index(a).first]];
    }
  }
  u.compress(dealii::VectorOperation::insert);
  return u;
}

/// How far the markers of a job are off `expected`, over the radius, where the mesh's nodes move by
/// `field` in its own axes.
template <int dim>
double patch_error(const ReferenceJob& job, const std::function<Vector3(const Vector3&)>& field,
                   const std::function<Vector3(const Vector3&)>& expected, int components = dim) {
  const SharedMesh mesh(job.refinement, sector(job), job.geometry);
  const auto body = fem_reference::read_tip<dim>(MPI_COMM_WORLD, mesh.file(), job.degree,
                                                 job.protocol.tilt, job.geometry, components);
  // Hanging nodes, too.
  for (const auto& cell : body->triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center().norm() > 8.5e-3) cell->set_refine_flag();
  body->triangulation.execute_coarsening_and_refinement();
  body->number({});
  double worst = 0.0;
  for (const MarkerRow& row : MarkerField<dim>(*body, job).rows(interpolated<dim>(*body, field)))
    worst = std::max(worst, (row.displacement - expected(row.place)).norm());
  return worst / job.geometry.tip_radius;
}

const Eigen::Matrix3d gradient =
    (Eigen::Matrix3d() << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.25, -0.9).finished();

/// Places on the surface lie off the elements that stand for it.
constexpr double off_surface = 2e-4;

TEST(MarkerField, ReproducesALinearDisplacement) {
  for (const int degree : {1, 2}) {
    ReferenceJob job = small_press();
    job.degree = degree;
    job.protocol.markers = scattered();
    std::erase_if(job.protocol.markers, [](const Vector3& at) {  // those on curved surfaces
      return std::abs(at.norm() - 10e-3) < 1e-9 || std::abs(at.norm() - 5e-3) < 1e-9 ||
             (at.z() < 0.0 && std::abs(at.head<2>().norm() - 7.5e-3) > 2e-3);
    });
    ASSERT_GE(job.protocol.markers.size(), 12u);
    const Eigen::Matrix3d in_quarter = gradient.diagonal().asDiagonal();
    const auto stretched = [&](const Vector3& x) -> Vector3 { return in_quarter * x; };
    EXPECT_LT(patch_error<3>(job, stretched, stretched), 1e-12);
    // A tilted finger is a half, turned.
    job.protocol.tilt = 0.2;
    Eigen::Matrix3d in_half = gradient;
    in_half(0, 1) = in_half(1, 0) = in_half(1, 2) = in_half(2, 1) = 0.0;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(job.protocol.tilt, Vector3::UnitY()).toRotationMatrix();
    EXPECT_LT(
        patch_error<3>(
            job, [&](const Vector3& x) -> Vector3 { return in_half * x; },
            [&](const Vector3& x) -> Vector3 { return turn * in_half * turn.transpose() * x; }),
        1e-12);
  }
}

TEST(MarkerField, TurnsTheMeridianAroundTheAxis) {
  ReferenceJob job = meridian_press();
  job.protocol.markers = scattered();
  // Of (r, z) and, where it is twisted, of the angle.
  const auto on_meridian = [](const Vector3& x) -> Vector3 {
    return {0.3 * x.x(), 0.1 * x.x(), -0.2 * x.z()};
  };
  const auto stretched = [](const Vector3& x) -> Vector3 {
    return {0.3 * x.x(), 0.3 * x.y(), -0.2 * x.z()};
  };
  const auto twisted = [&](const Vector3& x) -> Vector3 {
    return stretched(x) + 0.1 * Vector3::UnitZ().cross(x);
  };
  EXPECT_LT(patch_error<2>(job, on_meridian, stretched), off_surface);
  EXPECT_LT(patch_error<2>(job, on_meridian, twisted, 3), off_surface);
  std::erase_if(job.protocol.markers, [](const Vector3& at) {
    return std::abs(at.norm() - 10e-3) < 1e-9 || std::abs(at.norm() - 5e-3) < 1e-9;
  });
  EXPECT_LT(patch_error<2>(job, on_meridian, twisted, 3), 1e-13);
}

/// Held below; with one corner pulled out [m] it is no mirror image of itself.
meshes::Geometry block(double pulled) {
  meshes::TriangleMesh box = fingers::box({-0.008, -0.01, 0.0}, {0.008, 0.01, 0.018});
  for (int axis = 0; axis < 2; ++axis) box.vertices.back()[axis] += pulled;
  return meshes::Geometry::of_solid(
      std::make_shared<meshes::Solid>(box, meshes::Region{{{2, true, 1e-3}}}));
}

TEST(MarkerField, KnowsSolidsThatAreComputedWhole) {
  ReferenceJob job = small_press();
  job.geometry = block(2e-6);
  ASSERT_EQ(sector(job), meshes::Sector::full);
  for (const double side : {-1.0, 1.0})
    job.protocol.markers.emplace_back(side * 3e-3, -side * 4e-3, 10e-3);
  const auto linear = [](const Vector3& x) -> Vector3 { return gradient * x; };
  EXPECT_LT(patch_error<3>(job, linear, linear), 1e-13);
}

/// The quarter's mirror images are the whole's markers, but for another mesh.
TEST(ContinuumPress, MarkersOfAQuarterAreThoseOfTheWhole) {
  std::vector<std::vector<MarkerRow>> rows;
  for (const double pulled : {0.0, 2e-6}) {
    ReferenceJob job = small_press();
    job.geometry = block(pulled);
    job.refinement = 0.5;
    for (const double x : {-5e-3, 5e-3})
      for (const double y : {-6e-3, 6e-3}) job.protocol.markers.emplace_back(x, y, 12e-3);
    rows.push_back(pressed(job).markers);
  }
  EXPECT_NEAR(rows[0][0].displacement.y(), -rows[0][1].displacement.y(), 1e-15);
  EXPECT_NEAR(rows[0][0].displacement.x(), -rows[0][2].displacement.x(), 1e-15);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(rows[0][i].displacement.norm(), 0.3e-3);
    EXPECT_LT((rows[0][i].displacement - rows[1][i].displacement).norm(), 0.02e-3);
  }
}

/// Press by press the meridian's markers are the quarter's, within what coarse meshes are off.
TEST(ContinuumPress, MarkersOfTheMeridianAreThoseOfTheSolid) {
  for (const auto strain : {fem_reference::Strain::linear, fem_reference::Strain::finite}) {
    ReferenceJob solid = small_press();
    solid.strain = strain;
    solid.protocol.contact = meshes::ContactMode::stick;
    solid.refinement = 0.5;
    solid.protocol.markers = scattered();
    ReferenceJob meridian = solid;
    meridian.symmetry = fem_reference::Symmetry::axisymmetric;
    meridian.refinement = 2.0;
    const std::vector<MarkerRow> one = pressed(solid).markers, other = pressed(meridian).markers;
    ASSERT_EQ(one.size(), solid.protocol.markers.size());
    // The pole goes with the plane.
    EXPECT_NEAR((other[0].displacement - Vector3(0.0, 0.0, -1e-3)).norm(), 0.0, 1e-9);
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_LT((one[i].displacement - other[i].displacement).norm(), 0.02e-3) << i;
  }
}

/// Displacement of a half space z > 0 under Hertz' pressure p0 sqrt(1 - r²/a²), over the approach
/// pi p0 a/(2 E*), at (r, 0, z) over a: Johnson, Contact Mechanics, 1985, eqs. (3.18), (3.41),
/// (3.42).
Vector3 hertz_displacement(double r, double z, double nu) {
  const double pi = std::numbers::pi, edge = std::min(r, 1.0),
               inward = (1.0 - 2.0 * nu) / (1.0 - nu);
  if (z == 0.0) {
    const double within = std::pow(1.0 - edge * edge, 1.5),
                 along = r <= 1.0
                             ? 1.0 - 0.5 * r * r
                             : ((2.0 - r * r) * std::asin(1.0 / r) + std::sqrt(r * r - 1.0)) / pi;
    return {r > 0.0 ? -2.0 * inward / (3.0 * pi * r) * (1.0 - within) : 0.0, 0.0, along};
  }
  // Boussinesq's point forces, summed up; s = sin t.
  constexpr int rings = 200, sectors = 200;
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double t = 0.5 * pi * (i + 0.5) / rings, around = 2.0 * pi * (j + 0.5) / sectors;
      const double load =
          std::pow(std::cos(t), 2) * std::sin(t) * 0.5 * pi / rings * 2.0 * pi / sectors;
      const Vector3 to(r - std::sin(t) * std::cos(around), -std::sin(t) * std::sin(around), z);
      const double far = to.norm();
      Vector3 u = to * (z / std::pow(far, 3));
      u.head<2>() -= (1.0 - 2.0 * nu) / (far * (far + z)) * to.head<2>();
      u.z() += 2.0 * (1.0 - nu) / far;
      sum += load * u;
    }
  // 1/(4 pi G) over pi/(2 E*), with E*/G = 2/(1 - nu).
  return sum / (pi * pi * (1.0 - nu));
}

/// A ball on a block much larger than the contact: linear in their ratio, displacements go to those
/// of the half space.
TEST(ContinuumPress, MarkersBelowASmallContactAreHertz) {
  using enum meshes::ProfileSurface;
  using enum meshes::ProfileCurve;
  const double size = 0.02, radius = 0.05;
  ReferenceJob job = meridian_press();
  job.geometry = meshes::Geometry::of_profile({{size, 0.0, free, straight},
                                               {size, size, contact, straight},
                                               {0.0, size, axis, straight},
                                               {0.0, 0.0, bond, straight}});
  job.protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = radius};
  const std::vector<std::array<double, 2>> places = {{0.0, 0.5}, {0.0, 1.0}, {0.0, 2.0}, {0.0, 4.0},
                                                     {0.7, 0.6}, {1.5, 1.0}, {3.0, 2.0}, {0.5, 0.0},
                                                     {0.9, 0.0}, {1.5, 0.0}, {3.0, 0.0}};
  double told = 0.0;
  const auto displacements = [&](double reach) {  // over the approach
    const double a = reach * size, depth = a * a / radius;
    job.press_to({depth});
    job.protocol.markers.clear();
    for (const auto& [r, z] : places)
      job.protocol.markers.emplace_back(0.6 * a * r, -0.8 * a * r, size - a * z);
    Pressing pressing(job);
    fem_reference::MeshHistory history;
    for (int mesh = 0; mesh < 3 || !(history.worst_relative_error() <= 5e-4); ++mesh) {
      if (mesh > 0 && !pressing.press.refine(0.5)) break;
      history.start_mesh(pressing.press.mesh());
      history.add(pressing.press.advance(depth));
    }
    EXPECT_LE(history.worst_relative_error(), 5e-4);
    std::vector<Vector3> along;
    fem_reference::PressState best = history.best()[0];
    set_marker_errors(best, {0.0, 0.0, size}, best.markers);
    for (const MarkerRow& row : best.markers) {
      const Vector3& u = row.displacement;
      EXPECT_GT(row.error, 0.0);
      told = std::max(told, row.error / depth);
      along.emplace_back(Vector3(0.6 * u.x() - 0.8 * u.y(), 0.8 * u.x() + 0.6 * u.y(), -u.z()) /
                         depth);
    }
    return along;
  };
  const std::vector<Vector3> near = displacements(0.05), far = displacements(0.025);
  EXPECT_LT(told, 0.01);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector3 exact =
        hertz_displacement(places[i][0], places[i][1], job.rubber.poissons_ratio());
    EXPECT_LT((2.0 * far[i] - near[i] - exact).norm(), 0.005)
        << places[i][0] << " " << places[i][1];
  }
}

}  // namespace
