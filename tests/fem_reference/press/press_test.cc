/// The press along the axis at small strain; tilted_press_test.cc, finite_press_test.cc and
/// press_checkpoint_test.cc have the rest.
#include "fem_reference/press/press.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/press/contact_edge.h"
#include "meshes/base/errors.h"
#include "tests/fem_reference/press/pressing.h"

using namespace fingertip;
using fem_reference::LinearSolver;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;

namespace {

double force_of(const ReferenceJob& job, double longest_step = 0.01) {
  return pressed(job, longest_step).normal_force;
}

/// The force [gf] that two independent programs give; tests/fem_reference/data has all of them.
constexpr std::pair<double, double> table[] = {{1e-4, 0.07573}, {3e-4, 0.44099},  {5e-4, 1.02296},
                                               {1e-3, 3.25628}, {2e-3, 10.22344}, {3e-3, 19.42179}};

TEST(ContinuumPress, FrictionlessForceIsThatOfTheTable) {
  ReferenceJob job = small_press();
  job.refinement = 0.5;
  job.press_to({3e-3});
  Pressing pressing(job);
  for (const auto& [indentation, force] : table) {
    const PressState state = pressing.press.advance(indentation);
    EXPECT_NEAR(state.normal_force / 9.80665e-3 / force, 1.0, indentation < 5e-4 ? 0.03 : 0.005)
        << indentation;
    EXPECT_EQ(state.steps, 1);  // it does not depend on its path
  }
}

/// What the plane gives, the rod takes.
TEST(ContinuumPress, ForcesBalance) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press();
    job.protocol.contact = mode;
    Pressing pressing(job);
    double previous = 0.0;
    for (const double indentation : {1e-4, 5e-4, 1e-3}) {
      const PressState state = pressing.press.advance(indentation);
      const meshes::Vector3 bond = pressing.press.bond_reaction();
      EXPECT_NEAR(4 * bond.z() / state.normal_force, 1.0, 1e-9);
      EXPECT_GT(state.normal_force, previous);
      EXPECT_EQ(state.lateral_force_x, 0.0);
      EXPECT_EQ(state.torque_y, 0.0);
      previous = state.normal_force;
    }
  }
}

/// Virtual work: nothing slips against friction, so the force is the energy's derivative.
TEST(ContinuumPress, ForceIsTheEnergysDerivative) {
  ReferenceJob job = small_press();
  for (const double indentation : {3e-4, 1e-3}) {
    const double h = 1e-3 * indentation;
    job.press_to({indentation + h});
    Pressing pressing(job);
    const double before = pressing.press.advance(indentation - h).energy;
    const double force = pressing.press.advance(indentation).normal_force;
    const double after = pressing.press.advance(indentation + h).energy;
    EXPECT_NEAR((after - before) / (2 * h) / force, 1.0, 1e-5);
  }
}

/// Along the axis a node once stuck stays, so that the plane does no work but along its normal.
TEST(ContinuumPress, StickStoresTheWorkOfItsForce) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  Pressing pressing(job);
  double work = 0.0, last = 0.0, energy = 0.0, indentation = 0.0;
  while (indentation < job.protocol.depth * (1 - 1e-9)) {
    const double step = std::min(2e-5, job.protocol.depth - indentation);
    indentation += step;
    const PressState state = pressing.press.advance(indentation);
    work += step * (last + state.normal_force) / 2;
    last = state.normal_force;
    energy = state.energy;
  }
  EXPECT_NEAR(energy / work, 1.0, 2e-3);
}

TEST(ContinuumPress, PressuresArePositiveAndAddUp) {
  ReferenceJob job = small_press();
  const PressState state = pressed(job);
  int in_quarter = 0;  // what was computed; on its mirror planes a node is its own image
  for (const meshes::ContactPoint& point : state.contact) {
    EXPECT_GE(point.normal_traction, 0.0);
    in_quarter += point.place.x() >= 0.0 && point.place.y() >= 0.0;
  }
  EXPECT_EQ(in_quarter, state.active_nodes);
  const double a = state.contact_radius;
  EXPECT_NEAR(a, 3.494e-3, state.node_spacing);
  // Hertz's profile has 1.5 times the mean pressure at the pole; the bond makes it steeper.
  const double mean = state.normal_force / (std::numbers::pi * a * a);
  EXPECT_GT(state.max_pressure, 1.4 * mean);
  EXPECT_LT(state.max_pressure, 1.7 * mean);
}

/// Whatever is mirrored, turned around, tilted or curved.
TEST(ContinuumPress, TheFieldOfTheContactAddsUpToForceAndTorque) {
  std::vector<ReferenceJob> jobs = {meridian_press(), small_press(), small_press(), small_press()};
  jobs[0].protocol.contact = ContactMode::stick;
  jobs[0].strain = Strain::finite;
  jobs[0].protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = 8e-3};
  jobs[2].protocol.contact = ContactMode::stick;
  jobs[2].protocol.tilt = 0.1;
  jobs[3].strain = Strain::finite;
  jobs[3].protocol.obstacle = {
      .shape = meshes::ObstacleShape::sphere, .radius = 8e-3, .offset = 1e-3};
  for (const ReferenceJob& job : jobs) {
    const PressState state = pressed(job, 0.05);
    const Eigen::AngleAxisd to_rod(job.protocol.tilt, meshes::Vector3::UnitY());
    const auto sums =
        meshes::sums_of(state.contact, to_rod.inverse() * job.geometry.rod_endpoint());
    const meshes::Vector3 torque = to_rod * sums.torque;
    const double force = state.normal_force, arm = force * job.geometry.rod_length;
    ASSERT_GT(force, 0.0);
    EXPECT_NEAR(-sums.force.z(), force, 1e-10 * force);
    EXPECT_NEAR(sums.force.x(), state.lateral_force_x, 1e-10 * force);
    EXPECT_NEAR(sums.force.y(), state.lateral_force_y, 1e-10 * force);
    EXPECT_NEAR(torque.x(), state.torque_x, 1e-10 * arm);
    EXPECT_NEAR(torque.y(), state.torque_y, 1e-10 * arm);
    EXPECT_NEAR(torque.z(), state.torque_z, 1e-10 * arm);
    double area = 0.0;
    for (const meshes::ContactPoint& point : state.contact) {
      EXPECT_NEAR(point.shear.dot(point.normal), 0.0, 1e-12 * state.max_pressure);
      if (job.protocol.contact == ContactMode::frictionless) {
        EXPECT_LE(point.shear.norm(), 1e-6 * state.max_pressure);
      }
      area += point.area * -point.normal.z();
    }
    EXPECT_NEAR(std::sqrt(area / std::numbers::pi), state.contact_radius, state.node_spacing);
  }
}

TEST(ContinuumPress, StickIsStifferAndDoesNotDependOnItsSteps) {
  ReferenceJob job = small_press();
  job.press_to({2e-3});
  const double frictionless = force_of(job);
  job.protocol.contact = ContactMode::stick;
  const double coarse = force_of(job, 0.04), fine = force_of(job, 0.01);  // 0.02 and 0.005 cm
  EXPECT_GT(fine, 1.04 * frictionless);
  EXPECT_NEAR(coarse / fine, 1.0, 1e-3);
}

TEST(ContinuumPress, IsHomogeneousInLengthAndStiffness) {
  // Twice the lengths, thrice the stiffness: four times three the force.
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  const double force = force_of(job);
  job.rubber.youngs_modulus *= 3;
  job.rubber.shear_modulus *= 3;
  job.geometry = {0.02, 0.01, 0.03, 0.06};
  job.press_to({2e-3});
  EXPECT_NEAR(force_of(job) / (12 * force), 1.0, 1e-6);
}

TEST(ContinuumPress, DegreesConvergeToOneAnother) {
  ReferenceJob job = small_press();
  job.refinement = 0.7;
  const double quadratic = force_of(job);
  job.refinement = 0.4;
  job.degree = 3;
  EXPECT_NEAR(force_of(job) / quadratic, 1.0, 5e-3);
  job.degree = 1;
  const double coarse = force_of(job);
  job.refinement = 0.8;
  const double fine = force_of(job);
  EXPECT_LT(std::abs(fine / quadratic - 1), 0.7 * std::abs(coarse / quadratic - 1));
}

/// Nearly incompressible rubber locks plain elements and not projected ones.
TEST(ContinuumPress, ProjectionDoesNotLock) {
  ReferenceJob job = small_press();
  job.rubber.shear_modulus = job.rubber.youngs_modulus / (2 * 1.499);  // nu = 0.499
  job.press_to({5e-4});
  job.refinement = 0.6;
  const double fine = force_of(job);
  job.refinement = 0.3;
  const double projected = force_of(job);
  job.volumetric = fem_reference::Volumetric::pointwise;
  const double plain = force_of(job);
  EXPECT_LT(std::abs(projected / fine - 1), 0.05);
  EXPECT_GT(plain / fine - 1, 2 * std::abs(projected / fine - 1));
}

/// Two linear solvers that share nothing but the matrix.
TEST(ContinuumPress, MultigridAgreesWithTheFactorisation) {
  for (const ContactMode mode :
       {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb}) {
    ReferenceJob job = small_press();
    job.protocol.contact = mode;
    job.press_to({5e-4});
    job.solver = LinearSolver::condensed;
    const PressState condensed = pressed(job, 0.05);
    job.solver = LinearSolver::multigrid;
    const PressState multigrid = pressed(job, 0.05);
    EXPECT_EQ(condensed.cg_iterations, 0);
    EXPECT_GT(multigrid.cg_iterations, 0);
    EXPECT_EQ(condensed.active_nodes, multigrid.active_nodes);
    EXPECT_NEAR(multigrid.normal_force / condensed.normal_force, 1.0, 1e-7);
    EXPECT_NEAR(multigrid.energy / condensed.energy, 1.0, 1e-7);
    EXPECT_NEAR(multigrid.max_pressure / condensed.max_pressure, 1.0, 1e-6);
  }
}

/// At large strain each of Newton's systems is solved as far as its next step is worth. Anchors of
/// stick remember what the steps on the way, which are balanced roughly, leave.
TEST(ContinuumPress, InexactMultigridAgreesWithTheFactorisation) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press();
    job.strain = fem_reference::Strain::finite;
    job.protocol.contact = mode;
    job.protocol.tilt = 0.1;
    const PressState factored = pressed(job, 0.05);
    job.solver = LinearSolver::multigrid;
    const PressState multigrid = pressed(job, 0.05);
    const double share = mode == ContactMode::stick ? 1e-4 : 1e-7;
    EXPECT_EQ(factored.active_nodes, multigrid.active_nodes);
    EXPECT_NEAR(multigrid.normal_force / factored.normal_force, 1.0, share);
    EXPECT_NEAR(multigrid.torque_y / factored.torque_y, 1.0, 20.0 * share);
    EXPECT_NEAR(multigrid.max_pressure / factored.max_pressure, 1.0, 10.0 * share);
  }
}

TEST(ContinuumPress, WorksWithoutASleeve) {
  ReferenceJob job = small_press();
  const double with_sleeve = force_of(job);
  job.geometry.sleeve_length = 0.0;
  const double without = force_of(job);
  EXPECT_LT(without, with_sleeve);
  EXPECT_GT(without, 0.5 * with_sleeve);
}

TEST(ContinuumPress, RefinesWhereItMattersAndStartsAnew) {
  ReferenceJob job = small_press();
  Pressing pressing(job);
  const auto& before = pressing.press.mesh();
  const PressState coarse = pressing.press.advance(1e-3);
  pressing.press.refine(0.7);
  const auto after = pressing.press.mesh();
  EXPECT_GT(after.cells, before.cells);
  EXPECT_LT(after.cells, 8 * before.cells);
  EXPECT_GT(double(after.unknowns), 1.5 * double(before.unknowns));
  const PressState fine = pressing.press.advance(1e-3);
  const double truth = 3.25628 * 9.80665e-3;
  EXPECT_LT(std::abs(fine.normal_force / truth - 1), 5e-3);
  EXPECT_LT(fine.node_spacing, 0.7 * coarse.node_spacing);
  EXPECT_NEAR(4 * pressing.press.bond_reaction().z() / fine.normal_force, 1.0, 1e-8);
}

TEST(ContinuumPress, StopsOnRequest) {
  Pressing pressing(small_press(), [] { return true; });
  EXPECT_THROW(pressing.press.advance(1e-3), meshes::Interrupted);
}

/// Within a step, between iterations of Newton's method, which then begins again.
TEST(ContinuumPress, GoesOnAfterAStop) {
  ReferenceJob job = small_press();
  job.strain = fem_reference::Strain::finite;
  int asked = 0;
  Pressing undisturbed(job), stopped(job, [&asked] { return ++asked == 3; });
  EXPECT_THROW(stopped.press.advance(1e-3), meshes::Interrupted);
  const double force = undisturbed.press.advance(1e-3).normal_force;
  EXPECT_NEAR(stopped.press.advance(1e-3).normal_force / force, 1.0, 1e-6);
}

TEST(ContinuumPress, RefusesAMeshOfNothing) {
  EXPECT_THROW(fem_reference::ContinuumPress::on(small_press(), "no/such/file.msh"),
               meshes::InvalidInput);
}

/// Edges of the mesh in y = 0: they surround the rubber, and the pole's has gone up by the press.
TEST(ContinuumPress, SectionShowsTheDeformedMesh) {
  ReferenceJob job = small_press();
  Pressing pressing(job);
  pressing.press.advance(1e-3);
  const auto edges = pressing.press.section(*pressing.press.snapshot());
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) return;
  double top = 0.0, deformed_top = 0.0, lowest = 0.0;
  for (const auto& edge : edges)
    for (std::size_t end = 0; end < 4; end += 2) {
      EXPECT_GE(edge.undeformed[end], -1e-15);
      top = std::max(top, edge.undeformed[end + 1]);
      deformed_top = std::max(deformed_top, edge.deformed[end + 1]);
      lowest = std::min(lowest, edge.undeformed[end + 1]);
    }
  EXPECT_NEAR(top, job.geometry.tip_radius, 1e-12);
  EXPECT_NEAR(deformed_top, job.geometry.tip_radius - 1e-3, 1e-6);
  EXPECT_NEAR(lowest, -job.geometry.sleeve_length, 1e-12);
}

TEST(ContinuumPress, FieldsAreWrittenForParaView) {
  ReferenceJob job = small_press();
  Pressing pressing(job);
  pressing.press.advance(5e-4);
  const auto file = pressing.folder() / "press_0001.vtu";
  pressing.press.write_fields(*pressing.press.snapshot(), file);
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string text = read_text(file);
  for (const char* field : {"displacement", "stress", "von_mises_stress", "contact_pressure",
                            "contact_shear", "contact_status"})
    EXPECT_NE(text.find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
  EXPECT_NE(text.find("</VTKFile>"), std::string::npos);
}

using fem_reference::PushedNodes;

meshes::ContactPoint node(double x, double y, double pressure, double area) {
  meshes::ContactPoint point;
  point.place = {x, y, 0.0};
  point.area = area;
  point.normal_traction = pressure;
  return point;
}

/// Rings `spacing` apart up to `edge`.
PushedNodes rings(double spacing, double edge, const std::function<double(double)>& pressure) {
  PushedNodes contact{.meridian = true, .spacing = spacing};
  for (int i = 0; i * spacing < edge; ++i) {
    const double r = i * spacing,
                 area = 2.0 * std::numbers::pi * std::max(r, spacing / 8) * spacing;
    contact.nodes.push_back(node(r, 0.0, pressure(r), area));
  }
  return contact;
}

/// Hertz's pressure over an ellipse, on squares of a grid, of which sectors are left.
PushedNodes ellipse(double a, double b, const Eigen::Vector2d& centre, double spacing,
                    int sectors) {
  PushedNodes contact{.sectors = sectors, .spacing = spacing};
  const int most = int((centre.norm() + std::max(a, b)) / spacing) + 1;
  for (int i = sectors > 2 ? 0 : -most; i <= most; ++i)
    for (int j = sectors > 1 ? 0 : -most; j <= most; ++j) {
      const Eigen::Vector2d at = spacing * Eigen::Vector2d(i + 0.5, j + 0.5), d = at - centre;
      const double s = std::pow(d.x() / a, 2) + std::pow(d.y() / b, 2);
      if (s >= 1.0) continue;
      contact.nodes.push_back(node(at.x(), at.y(), std::sqrt(1.0 - s), spacing * spacing));
    }
  return contact;
}

/// Hertz's pressure on nodes of a regular grid, whose outermost node misses the edge.
TEST(ContactEdge, FindsTheEdgeBetweenNodes) {
  for (const double edge : {0.985, 1.0, 1.013}) {
    const PushedNodes contact =
        rings(0.03, edge, [&](double r) { return std::sqrt(1 - std::pow(r / edge, 2)); });
    EXPECT_NEAR(fem_reference::contact_radius(contact), edge, 1e-6);
  }
}

/// Law A, frictionless, 0.3 cm: p/p(0) from axisymmetric finite elements (tests/verification).
TEST(ContactEdge, IsMetUnderAPeakedPressure) {
  constexpr std::array<double, 8> at = {0.0, 0.25, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0};
  constexpr std::array<double, 8> pressure = {1.0, 0.910, 0.706, 0.464, 0.286, 0.204, 0.135, 0.0};
  const PushedNodes contact = rings(0.0123, 1.0, [&](double r) {
    const std::size_t k = std::size_t(std::upper_bound(at.begin(), at.end(), r) - at.begin());
    const double share = (r * r - at[k - 1] * at[k - 1]) / (at[k] * at[k] - at[k - 1] * at[k - 1]);
    return std::sqrt((1.0 - share) * std::pow(pressure[k - 1], 2) +
                     share * std::pow(pressure[k], 2));
  });
  EXPECT_NEAR(fem_reference::contact_radius(contact), 1.0, 0.008);
}

/// Round or not, in the middle or beside it, whole or in part.
TEST(ContactEdge, IsOneForContactsOfAnyShapeAndPlace) {
  for (const double b : {1.0, 0.999, 0.7})
    for (const int sectors : {1, 2, 4})
      for (const double x : {0.0, 1e-3, 0.13}) {
        if (sectors == 4 && x > 0.0) continue;
        const PushedNodes contact = ellipse(1.0, b, {x, 0.0}, 0.03, sectors);
        EXPECT_NEAR(fem_reference::contact_radius(contact) / std::sqrt(b), 1.0, 2e-3)
            << b << ' ' << sectors << ' ' << x;
      }
}

/// What is no ellipse has the area of its nodes, to a spacing.
TEST(ContactEdge, IsThatOfTheAreaWhateverThePressure) {
  EXPECT_EQ(fem_reference::contact_radius({}), 0.0);
  for (const auto& pressure : std::vector<std::function<double(double)>>{
           [](double r) { return 1.0 + 100.0 * r; }, [](double) { return 1.0; }})
    EXPECT_NEAR(fem_reference::contact_radius(rings(0.01, 0.305, pressure)), 0.305, 0.0101);
  PushedNodes two = ellipse(0.3, 0.3, {1.0, 0.0}, 0.02, 1);
  const PushedNodes other = ellipse(0.3, 0.3, {-1.0, 0.0}, 0.02, 1);
  two.nodes.insert(two.nodes.end(), other.nodes.begin(), other.nodes.end());
  double area = 0.0;
  for (const auto& node : two.nodes) area += node.area;
  EXPECT_NEAR(area, 2.0 * std::numbers::pi * 0.09, 0.01);
  EXPECT_NEAR(fem_reference::contact_radius(two), std::sqrt(area / std::numbers::pi), 0.0201);
  PushedNodes line{.spacing = 0.1};
  for (int i = 0; i < 30; ++i) line.nodes.push_back(node(0.1 * i, 0.0, 1.0, 0.01));
  EXPECT_NEAR(fem_reference::contact_radius(line), std::sqrt(0.3 / std::numbers::pi), 1e-12);
}

}  // namespace
