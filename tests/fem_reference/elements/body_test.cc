#include "fem_reference/elements/body.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/tip/tip_body.h"
#include "meshes/base/errors.h"
#include "tests/fem_reference/shared_mesh.h"
#include "tests/fingers.h"

using namespace fingertip;
using fem_reference::Body;
using meshes::Geometry;
using meshes::PhysicalTag;
using meshes::Sector;
using meshes::Vector3;

namespace {

struct Options {
  double refinement = 0.5;
  int degree = 2;
  double tilt = 0.0;
  Sector sector = Sector::quarter;
  Geometry geometry{};
  int global_refinements = 0;
  /// Cells within this distance of the lowest point under the plane are refined once more [m].
  double refine_near_pole = 0.0;
};

std::unique_ptr<Body<3>> make_body(const Options& o) {
  const SharedMesh mesh(o.refinement, o.sector, o.geometry);
  auto body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), o.degree, o.tilt);
  body->triangulation.refine_global(unsigned(o.global_refinements));
  if (o.refine_near_pole > 0.0) {
    const dealii::Point<3> pole(0.0, 0.0, o.geometry.tip_radius);
    for (const auto& cell : body->triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center().distance(pole) < o.refine_near_pole)
        cell->set_refine_flag();
    body->triangulation.execute_coarsening_and_refinement();
  }
  body->number(fem_reference::tip_supports<3>());
  return body;
}

double area(const Body<3>& body, PhysicalTag tag) {
  return fem_reference::area(body, dealii::types::boundary_id(tag));
}

struct Measures {
  double volume, outer, bond, end;
  std::array<double, 4> relative_to(const Measures& exact) const {
    return {std::abs(volume / exact.volume - 1), std::abs(outer / exact.outer - 1),
            std::abs(bond / exact.bond - 1), std::abs(end / exact.end - 1)};
  }
};

/// Of the share `part` of the whole tip.
Measures exact(const Geometry& g, double part) {
  const double R = g.tip_radius, r = g.rod_radius, L = g.sleeve_length, pi = std::numbers::pi;
  return {part * g.tip_volume(), part * (2 * pi * R * R + 2 * pi * R * L),
          part * (2 * pi * r * r + 2 * pi * r * L), part * pi * (R * R - r * r)};
}

Measures measure(const Body<3>& body) {
  return {fem_reference::volume(body), area(body, PhysicalTag::outer),
          area(body, PhysicalTag::bond), area(body, PhysicalTag::end)};
}

/// Rod axes of a point given in plane axes: the rotation that takes the plane's normal (0, 0, -1)
/// to n = (-sin tilt, 0, -cos tilt).
Vector3 in_rod_axes(const dealii::Point<3>& x, double tilt) {
  const Eigen::AngleAxisd turn(tilt, Vector3::UnitY());
  return turn * Vector3(x[0], x[1], x[2]);
}

/// Calls `take` with every vertex of the boundary `tag` that this process owns a face of.
template <class Take>
void for_each_vertex(const Body<3>& body, PhysicalTag tag, Take take) {
  for (const auto& cell : body.triangulation.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == dealii::types::boundary_id(tag))
        for (const unsigned v : face->vertex_indices()) take(face->vertex(v));
  }
}

TEST(Body, CurvedSurfacesStayCurved) {
  for (const double length : {0.015, 0.0}) {
    Geometry geometry;
    geometry.sleeve_length = length;
    const auto error = [&](double refinement, int degree) {
      return measure(*make_body({.refinement = refinement, .degree = degree, .geometry = geometry}))
          .relative_to(exact(geometry, 0.25));
    };
    const auto coarse = error(0.5, 2), fine = error(1.0, 2), flat = error(1.0, 1),
               cubic = error(0.5, 3);
    for (std::size_t i = 0; i < 4; ++i) {
      SCOPED_TRACE(i);
      EXPECT_LT(fine[i], 1e-6);
      EXPECT_LT(fine[i], coarse[i] / 8);  // h⁴ would be 16
      EXPECT_LT(fine[i], flat[i] / 100);
      EXPECT_LT(cubic[i], coarse[i]);
    }
  }
}

/// Vertices made by refinement lie on the true sphere and cylinder, whatever the tilt.
TEST(Body, RefinedCellsKeepToTheirSurfaces) {
  const Geometry g;
  for (const double tilt : {0.0, 0.3}) {
    const auto body = make_body({.refinement = 0.3,
                                 .tilt = tilt,
                                 .sector = tilt == 0.0 ? Sector::quarter : Sector::half,
                                 .global_refinements = 1,
                                 .refine_near_pole = 4e-3});
    EXPECT_TRUE(body->triangulation.has_hanging_nodes());
    const auto lies_at = [&](PhysicalTag tag, double radius) {
      for_each_vertex(*body, tag, [&](const dealii::Point<3>& x) {
        EXPECT_NEAR(Geometry::radial_distance(in_rod_axes(x, tilt)), radius, 1e-15);
      });
    };
    lies_at(PhysicalTag::outer, g.tip_radius);
    lies_at(PhysicalTag::bond, g.rod_radius);
    for_each_vertex(*body, PhysicalTag::end, [&](const dealii::Point<3>& x) {
      EXPECT_NEAR(in_rod_axes(x, tilt).z(), -g.sleeve_length, 1e-15);
    });
  }
}

TEST(Body, RefinementBringsVolumeAndAreasNearer) {
  const Measures truth = exact({}, 0.25);
  const auto coarse = measure(*make_body({.refinement = 0.3})).relative_to(truth);
  const auto fine =
      measure(*make_body({.refinement = 0.3, .global_refinements = 1})).relative_to(truth);
  const auto mixed =
      measure(*make_body({.refinement = 0.3, .global_refinements = 1, .refine_near_pole = 4e-3}))
          .relative_to(truth);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(fine[i], coarse[i] / 8) << i;
    EXPECT_LE(mixed[i], fine[i] * (1 + 1e-9)) << i;
  }
}

TEST(Body, TiltTurnsTheTipAndChangesNothingElse) {
  const Geometry g;
  const double tilt = 0.25;
  const auto upright = make_body({.sector = Sector::half});
  const auto tilted = make_body({.tilt = tilt, .sector = Sector::half});
  const auto change = measure(*tilted).relative_to(measure(*upright));
  for (const double entry : change) EXPECT_LT(entry, 1e-12);

  // The tip's pole, on the rod's axis, is where the axis (0, 0, 1) of the rod has gone.
  const Vector3 axis = Eigen::AngleAxisd(-tilt, Vector3::UnitY()) * Vector3::UnitZ();
  EXPECT_LT(axis.x(), 0.0);
  double nearest = 1.0;
  for_each_vertex(*tilted, PhysicalTag::outer, [&](const dealii::Point<3>& x) {
    nearest = std::min(nearest, (Vector3(x[0], x[1], x[2]) - g.tip_radius * axis).norm());
  });
  EXPECT_LT(dealii::Utilities::MPI::min(nearest, MPI_COMM_WORLD), 1e-15);
}

TEST(OuterNodes, AreasAddUpOnEveryMesh) {
  const double truth = exact({}, 0.25).outer;
  const auto check = [&](const Options& o, double tolerance) {
    const auto body = make_body(o);
    double sum = 0.0;
    for (const auto& node : fem_reference::outer_nodes(*body)) {
      EXPECT_GT(node.area, 0.0);
      EXPECT_TRUE(node.free[2]);
      EXPECT_EQ(node.free[0], node.position.x() > 1e-12);  // x = 0 and y = 0 are planes of symmetry
      EXPECT_EQ(node.free[1], node.position.y() > 1e-12);
      sum += node.area;
    }
    EXPECT_NEAR(sum / truth, 1.0, tolerance) << "degree " << o.degree;
  };
  check({.refinement = 0.5, .degree = 1}, 1e-2);
  check({.refinement = 0.5, .degree = 2}, 1e-4);
  check({.refinement = 0.5, .degree = 3}, 1e-6);
  // With hanging nodes nothing is lost: their shares go to the nodes that carry them.
  check({.refinement = 0.5, .degree = 1, .refine_near_pole = 4e-3}, 1e-2);
  check({.refinement = 0.5, .degree = 2, .refine_near_pole = 4e-3}, 1e-4);
  check({.refinement = 0.5, .degree = 3, .refine_near_pole = 4e-3}, 1e-6);
}

TEST(OuterNodes, HangingOnesAreNoCandidates) {
  const auto body = make_body({.refinement = 0.4, .refine_near_pole = 4e-3});
  const auto nodes = fem_reference::outer_nodes(*body);
  for (const auto& node : nodes)
    for (std::size_t c = 0; c < 3; ++c)
      if (body->fine.relevant.is_element(unsigned(node.unknown[c]))) {
        EXPECT_EQ(body->fine.constraints.is_constrained(unsigned(node.unknown[c])), !node.free[c]);
      }
  // Sorted from the pole down, and the pole is there.
  EXPECT_NEAR((nodes.front().position - Vector3(0, 0, Geometry{}.tip_radius)).norm(), 0.0, 1e-12);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    EXPECT_LE(nodes[i].position.z(), nodes[i - 1].position.z() + 1e-9);
}

/// The deformed surface's shadow on the plane: a stretched disc, for the sleeve has none.
TEST(OuterArea, OfTheDeformedSurfaceIsItsShadow) {
  const double stretch_x = 1.3, stretch_y = 0.8, stretch_z = 0.6, R = Geometry{}.tip_radius;
  const auto shadow = [&](double refinement) {
    const SharedMesh mesh(refinement);
    const auto body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), 2, 0.0);
    body->number({});
    fem_reference::Vector u = body->fine.vector();
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(body->mapping, body->fine.dofs, points);
    std::vector<dealii::types::global_dof_index> indices(body->fine.element.n_dofs_per_cell());
    for (const auto& cell : body->fine.dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      cell->get_dof_indices(indices);
      for (unsigned i = 0; i < indices.size(); ++i) {
        const unsigned c = body->fine.element.system_to_component_index(i).first;
        const double stretch = std::array{stretch_x, stretch_y, stretch_z}[c];
        if (body->fine.owned.is_element(indices[i]))
          u[indices[i]] = (stretch - 1) * points.at(indices[i])[c];
      }
    }
    u.compress(dealii::VectorOperation::insert);
    const fem_reference::Vector areas = fem_reference::outer_area(*body, &u);
    return areas.mean_value() * double(areas.size());
  };
  const double truth = stretch_x * stretch_y * std::numbers::pi * R * R / 4;
  EXPECT_NEAR(shadow(1.0) / truth, 1.0, 1e-4);
  EXPECT_LT(std::abs(shadow(1.0) / truth - 1), std::abs(shadow(0.5) / truth - 1));
}

/// One process: the file is spoilt by hand.
class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const SharedMesh mesh(0.3);
    good_ = read_text(mesh.file());
  }
  bool refuses(const std::string& text) const {
    const TemporaryFolder folder;
    write_text(folder / "tip.msh", text);
    try {
      fem_reference::read_tip<3>(MPI_COMM_SELF, folder / "tip.msh", 2, 0.0);
    } catch (const meshes::InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("tip.msh"), std::string::npos);
      return true;
    }
    return false;
  }
  std::string good_;
};

TEST_F(MeshFile, IsReadWhenWhole) {
  EXPECT_FALSE(refuses(good_));
}

TEST_F(MeshFile, IsRefusedWhenMissing) {
  EXPECT_THROW(fem_reference::read_tip<3>(MPI_COMM_SELF, "no/such/file.msh", 2, 0.0),
               meshes::InvalidInput);
}

TEST_F(MeshFile, IsRefusedWhenItIsNone) {
  EXPECT_TRUE(refuses(""));
  EXPECT_TRUE(refuses("this is no mesh\n"));
}

TEST_F(MeshFile, IsRefusedWhenOverwritten) {
  for (const double place : {0.1, 0.3, 0.6, 0.9}) {
    std::string noise = good_;
    noise.replace(std::size_t(place * double(noise.size())), 200, std::string(200, '#'));
    EXPECT_TRUE(refuses(noise)) << place;
  }
}

/// What is left of the file, from nothing but its head to all but its last line.
class TruncatedMeshFile : public MeshFile, public ::testing::WithParamInterface<double> {};

TEST_P(TruncatedMeshFile, IsRefused) {
  EXPECT_TRUE(refuses(good_.substr(0, std::size_t(GetParam() * double(good_.size())))));
}

INSTANTIATE_TEST_SUITE_P(Shares, TruncatedMeshFile,
                         ::testing::Values(0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.9995));

/// A node on the axis pulled through the element above it.
TEST_F(MeshFile, IsRefusedWhenAnElementIsInverted) {
  const std::size_t at = good_.find("\n0 0 0.01\n");
  ASSERT_NE(at, std::string::npos);
  std::string inverted = good_;
  inverted.replace(at, 10, "\n0 0 0.004\n");
  EXPECT_TRUE(refuses(inverted));
}

}  // namespace

TEST(Body, TheUnknownsOfAMeshAreKnownBeforeItsElements) {
  fem_reference::ReferenceJob job;
  job.symmetry = fem_reference::Symmetry::none;
  for (const auto& geometry : {Geometry{}, fingers::solid_dome(24, 16)}) {
    for (int degree = 1; degree <= 3; ++degree) {
      job.degree = degree;
      const Options options{.refinement = 0.4, .degree = degree, .geometry = geometry};
      const SharedMesh mesh(options.refinement, options.sector, geometry);
      const meshes::MeshQuality quality = meshes::inspect_tip_mesh(mesh.file());
      const double told = fem_reference::expected_unknowns(job, double(quality.hexahedra),
                                                           double(quality.nodes)),
                   number = double(make_body(options)->unknowns());
      EXPECT_NEAR(told / number, 1.0, degree == 1 ? 1e-12 : 0.1) << "degree " << degree;
    }
  }
}

TEST(Body, TheUnknownsOfAMeridianAreKnownExactly) {
  fem_reference::ReferenceJob job;
  ASSERT_TRUE(job.axisymmetric());
  const SharedMesh mesh(0.5, Sector::meridian);
  const meshes::MeshQuality quality = meshes::inspect_tip_mesh(mesh.file());
  for (int degree = 1; degree <= 3; ++degree) {
    job.degree = degree;
    const auto body = fem_reference::read_tip<2>(MPI_COMM_SELF, mesh.file(), degree, 0.0);
    body->number(fem_reference::tip_supports<2>());
    EXPECT_EQ(
        fem_reference::expected_unknowns(job, double(quality.hexahedra), double(quality.nodes)),
        double(body->unknowns()));
  }
}
