// The press of a body of revolution on its meridian: against the solid, against limits, against
// itself. Forces in closed form are with the verification.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fem_reference/analytic/bonded_disc.h"
#include "fem_reference/motion/transient_press.h"
#include "fem_reference/press/force_error.h"
#include "fem_reference/press/mesh_history.h"
#include "fem_reference/tip/tip_body.h"
#include "meshes/base/errors.h"
#include "tests/fem_reference/press/pressing.h"
#include "tests/fingers.h"

using namespace fingertip;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using fem_reference::Symmetry;
using meshes::ContactMode;
using meshes::VolumetricLaw;

namespace {

/// Meshes refined until the error estimate meets the job's tolerance at its samples.
std::vector<PressState> converged(const ReferenceJob& job) {
  Pressing pressing(job);
  fem_reference::MeshHistory history;
  for (int mesh = 0; mesh < 20; ++mesh) {
    if (mesh > 0 && !pressing.press.refine(0.5)) break;
    history.start_mesh(pressing.press.mesh());
    for (const double sample : job.protocol.samples) history.add(pressing.press.advance(sample));
    if (mesh >= 2 && history.worst_relative_error() <= job.tolerance) return history.best();
  }
  ADD_FAILURE() << "no mesh was good enough";
  return history.best();
}

TEST(Meridian, HasVolumeAndAreaOfTheBody) {
  const SharedMesh mesh(0.5, meshes::Sector::meridian);
  const auto tip = fem_reference::read_tip<2>(MPI_COMM_WORLD, mesh.file(), 2, 0.0);
  tip->number(fem_reference::tip_supports<2>());
  const meshes::Geometry g;
  const double R = g.tip_radius, r = g.rod_radius, s = g.sleeve_length, pi = std::numbers::pi;
  // Quadratic arcs miss the circle by a little.
  EXPECT_NEAR(volume(*tip), 2.0 / 3.0 * pi * (R * R * R - r * r * r) + pi * (R * R - r * r) * s,
              1e-5 * R * R * R);
  const auto outer = dealii::types::boundary_id(meshes::PhysicalTag::outer);
  EXPECT_NEAR(area(*tip, outer), 2 * pi * R * (R + s), 1e-4 * R * R);
  // The pole has no area; the others share it all.
  double shared = 0.0;
  for (const auto& node : outer_nodes(*tip)) {
    EXPECT_EQ(node.area > 0.0, node.position.x() > 1e-9 * R);
    EXPECT_EQ(node.position.y(), 0.0);
    EXPECT_FALSE(node.free[1]);
    shared += node.area;
  }
  EXPECT_NEAR(shared, area(*tip, outer), 1e-3 * R * R);
}

/// Radius and largest pressure, at the pole, of the same program at a tolerance of everyday: within
/// their own errors, and these not idle, also where few nodes touch.
TEST(Meridian, TellsHowFarRadiusAndLargestPressureMayBeOff) {
  constexpr double gf = 9.80665e-3, cm = 1e-2;
  struct Known {
    double depth, radius, pressure;
  };
  const std::vector<Known> known{{0.010, 0.1049, 3.288},  {0.020, 0.1509, 4.780},
                                 {0.030, 0.1869, 5.997},  {0.100, 0.3494, 12.567},
                                 {0.200, 0.4837, 20.599}, {0.300, 0.5720, 28.120}};
  constexpr double radius_known = 0.001 * cm, pressure_known = 5e-4;
  ReferenceJob job = meridian_press();
  job.rubber.youngs_modulus = 40 * gf / (cm * cm);
  job.rubber.shear_modulus = 14 * gf / (cm * cm);
  job.tolerance = 5e-3;
  std::vector<double> depths;
  for (const Known& at : known) depths.push_back(at.depth * cm);
  job.press_to(depths);
  const std::vector<PressState> states = converged(job);
  for (std::size_t i = 0; i < known.size(); ++i) {
    SCOPED_TRACE(known[i].depth);
    const PressState& sample = states[i];
    const double radius = known[i].radius * cm, pressure = known[i].pressure * gf / (cm * cm);
    EXPECT_NEAR(sample.max_pressure, pressure, 0.01 * pressure);
    EXPECT_NEAR(sample.max_pressure, pressure,
                sample.max_pressure_error + pressure_known * pressure);
    EXPECT_LT(sample.max_pressure_error, 0.03 * pressure);
    EXPECT_NEAR(sample.contact_radius, radius, sample.contact_radius_error + radius_known);
    EXPECT_LT(sample.contact_radius_error, 0.05 * radius);
    EXPECT_NEAR(sample.contact_area_error / sample.contact_area,
                2.0 * sample.contact_radius_error / sample.contact_radius, 1e-12);
    // It is the field's, whose points still add up to the force.
    double largest = 0.0, force = 0.0;
    for (const meshes::ContactPoint& point : sample.contact) {
      largest = std::max(largest, point.normal_traction);
      force -= point.force().z();
    }
    EXPECT_EQ(sample.max_pressure, largest);
    EXPECT_NEAR(force, sample.normal_force, 1e-10 * force);
  }
}

/// A cylinder glued at its base.
meshes::Geometry pad(double radius, double height) {
  using enum meshes::ProfileSurface;
  return meshes::Geometry::of_profile({{0.0, height, contact},
                                       {radius, height, meshes::ProfileSurface::free},
                                       {radius, 0.0, bond},
                                       {0.0, 0.0, axis}});
}

/// On a plane without friction it is half of a disc of twice the height, glued on both faces.
TEST(Meridian, PressesAPadAsHalfOfABondedDisc) {
  constexpr double radius = 0.01, height = 0.01, depth = 5e-4;
  ReferenceJob job = meridian_press();
  job.geometry = pad(radius, height);
  job.rubber.youngs_modulus = 1e5;
  job.rubber.shear_modulus = 1e5 / 2.9;
  job.tolerance = 1e-3;
  job.press_to({depth});
  const PressState state = converged(job).back();
  const fem_reference::analytic::BondedDisc disc(job.rubber, radius, 2 * height);
  const double force = 2 * depth * disc.extrapolated_stiffness(20);
  EXPECT_NEAR(state.normal_force, force, state.force_error);
  EXPECT_LT(state.force_error, 1e-3 * force);
  EXPECT_FALSE(state.free_edge);
  EXPECT_NEAR(state.contact_radius, radius, 1e-9 * radius);
}

/// At large strain, where refinement without end at the bond's corner would turn elements over.
TEST(Meridian, PressesAPadFarAndSaysHowSureItIs) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = meridian_press(mode, Strain::finite);
    job.geometry = pad(0.01, 0.01);
    job.rubber.youngs_modulus = 1e5;
    job.rubber.shear_modulus = 1e5 / 2.9;
    job.tolerance = 0.03;
    job.press_to({1e-4, 5e-4, 1e-3});
    const std::vector<PressState> coarse = converged(job);
    job.tolerance = 0.01;
    const std::vector<PressState> fine = converged(job);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      SCOPED_TRACE(coarse[i].indentation);
      EXPECT_FALSE(coarse[i].free_edge);
      EXPECT_NEAR(coarse[i].normal_force, fine[i].normal_force,
                  coarse[i].force_error + fine[i].force_error);
      EXPECT_NEAR(coarse[i].contact_radius, fine[i].contact_radius,
                  coarse[i].contact_radius_error + fine[i].contact_radius_error);
      if (mode == ContactMode::stick) continue;  // at the rim pressure has no largest value
      EXPECT_NEAR(coarse[i].max_pressure, fine[i].max_pressure,
                  coarse[i].max_pressure_error + fine[i].max_pressure_error);
    }
  }
}

/// The project's reference numbers of the default specimen, small strain, frictionless, E = 40,
/// G = 14 gf/cm²: an axisymmetric program of its own, node spacing 0.001 cm, in gf at cm.
TEST(Meridian, GivesTheForcesOfAnotherProgram) {
  constexpr double gf = 9.80665e-3, cm = 1e-2;
  const std::vector<std::pair<double, double>> known{
      {0.010, 0.07573}, {0.050, 1.02296}, {0.100, 3.25628}, {0.200, 10.22344}};
  ReferenceJob job = meridian_press();
  job.rubber.youngs_modulus = 40 * gf / (cm * cm);
  job.rubber.shear_modulus = 14 * gf / (cm * cm);
  job.tolerance = 3e-4;
  std::vector<double> depths;
  for (const auto& [depth, force] : known) depths.push_back(depth * cm);
  job.press_to(depths);
  const std::vector<PressState> states = converged(job);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto& sample = states[i];
    EXPECT_NEAR(sample.normal_force / gf, known[i].second, 2e-4 * known[i].second);
    EXPECT_LE(std::abs(sample.normal_force / gf - known[i].second),
              sample.force_error / gf + 5e-5 * known[i].second);  // its own last digits
  }
}

/// The dome written as a profile, on gmsh's unstructured mesh: within both bars.
TEST(Meridian, ProfileOfTheDomeIsTheDome) {
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    ReferenceJob dome = meridian_press(ContactMode::stick, strain);
    dome.refinement = 1.0;
    dome.tolerance = 0.003;
    dome.press_to({5e-4, 1e-3});
    ReferenceJob profile = dome;
    profile.geometry = meshes::Geometry::of_profile(fingers::dome({}, 0.004));
    const auto expected = converged(dome), found = converged(profile);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto &a = expected[i], &b = found[i];
      EXPECT_LE(std::abs(a.normal_force - b.normal_force), a.force_error + b.force_error);
      EXPECT_NEAR(a.contact_radius, b.contact_radius,
                  expected[i].node_spacing + found[i].node_spacing);
    }
  }
}

/// Nothing but its neighbours holds the pole of the meridian down: left to itself it rises through
/// the plane, and beyond some 0.6 of the thickness no step converges.
TEST(Meridian, GoesDeepWithoutFriction) {
  ReferenceJob job = meridian_press(ContactMode::frictionless, Strain::finite);
  job.refinement = 1.0;
  const double deep = 0.7 * job.geometry.thickness();
  job.press_to({deep});
  Pressing pressing(job);
  const PressState state = pressing.press.advance(deep);
  EXPECT_GT(state.min_jacobian, 0.1);
  const meshes::Geometry& g = job.geometry;
  for (const auto& edge : pressing.press.section(*pressing.press.snapshot()))
    EXPECT_LE(std::max(edge.deformed[1], edge.deformed[3]), g.tip_radius - deep + 1e-3 * deep);
}

struct Case {
  ContactMode contact;
  Strain strain;
  VolumetricLaw law;
};

class MeridianAndSolid : public testing::TestWithParam<Case> {};

TEST_P(MeridianAndSolid, AgreeWithinTheSolidsBar) {
  ReferenceJob job = meridian_press(GetParam().contact, GetParam().strain);
  job.rubber.energy.volumetric = GetParam().law;
  const bool finite = job.strain == Strain::finite;
  job.press_to(finite ? std::vector{1e-3} : std::vector{5e-4, 1e-3});
  ReferenceJob solid = job;
  solid.symmetry = Symmetry::none;
  solid.tolerance = finite ? 0.06 : 0.02;
  job.tolerance = 0.003;
  const auto flat = converged(job), full = converged(solid);
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const auto &meridian = flat[i], &solid_sample = full[i];
    EXPECT_LE(std::abs(meridian.normal_force - solid_sample.normal_force),
              meridian.force_error + solid_sample.force_error);
    EXPECT_NEAR(meridian.contact_radius, solid_sample.contact_radius,
                flat[i].node_spacing + full[i].node_spacing);
    EXPECT_EQ(meridian.lateral_force_x, 0.0);
    EXPECT_EQ(meridian.torque_y, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Presses, MeridianAndSolid,
    testing::Values(Case{ContactMode::frictionless, Strain::linear, VolumetricLaw::logarithmic},
                    Case{ContactMode::stick, Strain::linear, VolumetricLaw::logarithmic},
                    Case{ContactMode::coulomb, Strain::linear, VolumetricLaw::logarithmic},
                    Case{ContactMode::stick, Strain::finite, VolumetricLaw::logarithmic}),
    [](const auto& instance) {
      const Case& c = instance.param;
      return std::string(meshes::name(c.contact)) + "_" +
             (c.strain == Strain::linear ? "small_strain" : std::string("law_a"));
    });

TEST(Meridian, CoulombsLawLiesBetweenItsLimits) {
  const auto force = [](ContactMode contact, double friction) {
    ReferenceJob job = meridian_press(contact);
    job.refinement = 1.0;
    job.protocol.friction = friction;
    job.press_to({2e-3});
    return pressed(job).normal_force;
  };
  const double free = force(ContactMode::frictionless, 0.5), stuck = force(ContactMode::stick, 0.5);
  EXPECT_GT(stuck, 1.05 * free);
  EXPECT_DOUBLE_EQ(force(ContactMode::coulomb, 10.0), stuck);
  EXPECT_NEAR(force(ContactMode::coulomb, 1e-6), free, 1e-4 * free);
  double last = free;
  for (const double friction : {0.05, 0.1, 0.2, 0.4}) {
    const double next = force(ContactMode::coulomb, friction);
    EXPECT_GT(next, last) << friction;
    last = next;
  }
  EXPECT_LE(last, stuck);
}

TEST(Meridian, OfStickHardlyDependsOnTheStep) {
  ReferenceJob job = meridian_press(ContactMode::stick);
  job.refinement = 1.0;
  job.press_to({2e-3});
  const double coarse = pressed(job, 0.02).normal_force;
  const double usual = pressed(job, 0.01).normal_force;
  const double fine = pressed(job, 0.0025).normal_force;
  EXPECT_NEAR(usual, fine, 5e-4 * fine);
  EXPECT_LE(std::abs(usual - fine), std::abs(coarse - fine) + 1e-6 * fine);
}

/// The plane's work is what the rubber stores: dE/d(delta) = F, by central differences.
TEST(Meridian, ForceIsTheSlopeOfTheEnergy) {
  const auto check = [](const ReferenceJob& job) {
    Pressing pressing(job);
    std::vector<PressState> states;
    for (const double sample : job.protocol.samples)
      states.push_back(pressing.press.advance(sample));
    const double way = job.protocol.samples[2] - job.protocol.samples[0];
    EXPECT_NEAR((states[2].energy - states[0].energy) / way, states[1].normal_force,
                2e-3 * states[1].normal_force);
    return states[1].normal_force;
  };
  ReferenceJob job = meridian_press();
  job.refinement = 1.0;
  job.press_to({1.48e-3, 1.5e-3, 1.52e-3});
  double last = check(job);
  job.strain = Strain::finite;
  for (const VolumetricLaw law : meshes::values(VolumetricLaw())) {
    job.rubber.energy.volumetric = law;
    const double next = check(job);
    EXPECT_GT(std::abs(next - last), 1e-3 * last);  // laws differ
    last = next;
  }
}

meshes::Obstacle ball(double radius) {
  return {.shape = meshes::ObstacleShape::sphere, .radius = radius};
}

TEST(Meridian, PressesABallAsTheSolidDoes) {
  for (const ContactMode contact :
       {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb})
    for (const Strain strain : {Strain::linear, Strain::finite}) {
      ReferenceJob job = meridian_press(contact, strain);
      job.protocol.obstacle = ball(4e-3);
      job.protocol.friction = 0.1;
      job.press_to({8e-4});
      ReferenceJob solid = job;
      solid.symmetry = Symmetry::none;
      solid.tolerance = strain == Strain::finite ? 0.06 : 0.03;
      job.tolerance = 0.003;
      const auto flat = converged(job), full = converged(solid);
      const auto &a = flat[0], &b = full[0];
      EXPECT_LE(std::abs(a.normal_force - b.normal_force), a.force_error + b.force_error)
          << meshes::name(contact) << int(strain);
      EXPECT_NEAR(a.contact_radius, b.contact_radius, flat[0].node_spacing + full[0].node_spacing);
    }
}

/// dE/d(delta) = F holds of any frictionless obstacle, and nothing stands inside the ball.
TEST(Meridian, ForceOfABallIsTheSlopeOfTheEnergy) {
  for (const double radius : {2e-3, 2e-2})
    for (const Strain strain : {Strain::linear, Strain::finite}) {
      ReferenceJob job = meridian_press(ContactMode::frictionless, strain);
      job.protocol.obstacle = ball(radius);
      job.refinement = 1.0;
      job.press_to({1.98e-3, 2e-3, 2.02e-3});
      Pressing pressing(job);
      std::vector<PressState> states;
      for (const double sample : job.protocol.samples)
        states.push_back(pressing.press.advance(sample));
      EXPECT_NEAR((states[2].energy - states[0].energy) / 4e-5, states[1].normal_force,
                  2e-3 * states[1].normal_force)
          << radius << int(strain);
      if (strain == Strain::linear) continue;
      const double centre = job.geometry.tip_radius - 2.02e-3 + radius;
      for (const auto& edge : pressing.press.section(*pressing.press.snapshot()))
        EXPECT_GT(std::hypot(edge.deformed[0], centre - edge.deformed[1]), 0.99 * radius);
    }
}

/// Hertz (1882), F = 4/3 E/(1 - nu²) sqrt(radius) depth^(3/2): a ball on a block that is larger and
/// larger beside the contact, extrapolated to one without end.
TEST(Meridian, BallOnALargeBlockIsHertz) {
  using enum meshes::ProfileSurface;
  using enum meshes::ProfileCurve;
  const double size = 0.02, radius = 0.05;
  ReferenceJob job = meridian_press();
  job.geometry = meshes::Geometry::of_profile({{size, 0.0, free, straight},
                                               {size, size, contact, straight},
                                               {0.0, size, axis, straight},
                                               {0.0, 0.0, bond, straight}});
  job.protocol.obstacle = ball(radius);
  job.tolerance = 5e-4;
  const double nu = job.rubber.poissons_ratio(),
               modulus = job.rubber.youngs_modulus / (1.0 - nu * nu);
  const auto ratio = [&](double reach) {  // contact radius over the block's size
    const double depth = std::pow(reach * size, 2) / radius;
    job.press_to({depth});
    return converged(job)[0].normal_force /
           (4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5));
  };
  const double near = ratio(0.05), far = ratio(0.025);
  EXPECT_GT(near, far);
  EXPECT_NEAR(2.0 * far - near, 1.0, 0.005);
}

TEST(Meridian, CoulombOnABallLiesBetweenItsLimits) {
  const auto force = [](ContactMode contact, double friction) {
    ReferenceJob job = meridian_press(contact, Strain::finite);
    job.protocol.obstacle = ball(4e-3);
    job.refinement = 1.0;
    job.protocol.friction = friction;
    job.press_to({1.5e-3});
    return pressed(job).normal_force;
  };
  const double free = force(ContactMode::frictionless, 0.5), stuck = force(ContactMode::stick, 0.5);
  EXPECT_GT(stuck, 1.005 * free);
  EXPECT_NEAR(force(ContactMode::coulomb, 10.0), stuck, 1e-6 * stuck);
  EXPECT_NEAR(force(ContactMode::coulomb, 1e-6), free, 1e-4 * free);
  const double between = force(ContactMode::coulomb, 0.1);
  EXPECT_GT(between, free);
  EXPECT_LT(between, stuck);
}

TEST(Meridian, BondCarriesWhatThePlanePushes) {
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    ReferenceJob job = meridian_press(ContactMode::stick, strain);
    if (strain == Strain::finite) job.protocol.obstacle = ball(4e-3);
    Pressing pressing(job);
    const PressState state = pressing.press.advance(1e-3);
    EXPECT_NEAR(pressing.press.bond_reaction().z(), state.normal_force, 1e-8 * state.normal_force);
    EXPECT_EQ(pressing.press.bond_reaction().x(), 0.0);
  }
}

/// Near nu = 1/2 the projected element does not lock: a coarse mesh comes as near as at 3/7.
TEST(Meridian, DoesNotLock) {
  for (const double nu : {3.0 / 7.0, 0.49, 0.499, 0.4999}) {
    ReferenceJob job = meridian_press();
    job.rubber.shear_modulus = job.rubber.youngs_modulus / (2 * (1 + nu));
    job.press_to({1e-3});
    job.refinement = 0.7;
    const double coarse = pressed(job).normal_force;
    job.tolerance = 2e-3;
    const double fine = converged(job).front().normal_force;
    EXPECT_NEAR(coarse, fine, 0.02 * fine) << "nu = " << nu;
  }
}

/// At large strain and nu = 0.49 to half of the rubber's thickness.
TEST(Meridian, GoesDeepNearIncompressibility) {
  ReferenceJob job = meridian_press(ContactMode::stick, Strain::finite);
  job.rubber.shear_modulus = job.rubber.youngs_modulus / (2 * 1.49);
  job.press_to({2.5e-3});
  const PressState state = pressed(job);
  EXPECT_GT(state.min_jacobian, 0.5);
  EXPECT_GT(state.normal_force, 0.0);
}

TEST(Meridian, ResumesWhereItWasSaved) {
  ReferenceJob job = meridian_press(ContactMode::stick, Strain::finite);
  job.press_to({5e-4, 1e-3});
  Pressing straight(job), first(job), second(job);
  for (Pressing* p : {&straight, &first}) {
    p->press.advance(5e-4);
    p->press.refine(0.5);
    p->press.advance(5e-4);
  }
  first.press.save(first.folder().path());
  second.press.load(first.folder().path());
  EXPECT_EQ(second.press.advance(1e-3).normal_force, straight.press.advance(1e-3).normal_force);
}

/// The file of the fields at an indentation [m].
std::string fields_at(double indentation, const ReferenceJob& job) {
  Pressing pressing(job);
  pressing.press.advance(indentation);
  const auto file = pressing.folder() / "fields.vtu";
  pressing.press.write_fields(*pressing.press.snapshot(), file);
  return read_text(file);
}

/// Surfaces in the plane y = 0 whose fields lie in space: three components of displacement, nine of
/// stress.
TEST(Meridian, FieldsAreInSpace) {
  const std::string text = fields_at(1e-3, meridian_press(ContactMode::stick, Strain::finite));
  EXPECT_NE(text.find("Name=\"displacement\" NumberOfComponents=\"3\""), std::string::npos);
  EXPECT_NE(text.find("Name=\"stress\" NumberOfComponents=\"9\""), std::string::npos);
  for (const char* scalar :
       {"von_mises_stress", "contact_pressure", "contact_shear", "contact_status"})
    EXPECT_NE(text.find(std::string("Name=\"") + scalar + "\""), std::string::npos) << scalar;
  EXPECT_EQ(text.find("none"), std::string::npos);
}

TEST(Meridian, IsTurnedIntoTheBodyOnWish) {
  ReferenceJob job = meridian_press();
  const auto cells = [&](int sectors) {
    job.field_sectors = sectors;
    const std::string text = fields_at(1e-3, job);
    const std::string key = "NumberOfCells=\"";
    return std::stoi(text.substr(text.find(key) + key.size()));
  };
  // Each element of degree 2 is drawn as 2 x 2 quadrilaterals, or 2 x 2 x 2 hexahedra a sector.
  EXPECT_EQ(cells(8), 8 * 2 * cells(0));
}

TEST(Meridian, PressAtSpeedGivesTheForceOfTheSolid) {
  ReferenceJob job = meridian_press();
  job.analysis = fem_reference::Analysis::transient;
  job.protocol.speed = 0.1;
  job.refinement = 0.4;
  ReferenceJob solid = job;
  solid.symmetry = Symmetry::none;
  const auto press = [](const ReferenceJob& what) {
    const SharedMesh mesh(what.refinement, sector(what), what.geometry);
    const auto motion = fem_reference::TransientPress::on(what, mesh.file());
    const PressState state = motion->advance(1e-3);
    EXPECT_NEAR(motion->bond_force(), state.normal_force, 1e-6 * state.normal_force);
    const auto& last = motion->steps().back();
    EXPECT_NEAR(last.work, last.kinetic_energy + last.elastic_energy + last.dissipated_energy,
                0.01 * last.work);
    return state.normal_force;
  };
  const double expected = press(solid);
  EXPECT_NEAR(press(job), expected, 0.02 * expected);
}

TEST(Meridian, IsRefusedWhereTheSymmetryIsBroken) {
  ReferenceJob job = meridian_press();
  EXPECT_TRUE(job.violations().empty());
  job.protocol.tilt = 0.1;
  ASSERT_EQ(job.violations().size(), 1u);
  EXPECT_EQ(job.violations().front().key, "reference.symmetry");
  job.symmetry = Symmetry::automatic;
  EXPECT_TRUE(job.violations().empty());
  EXPECT_FALSE(job.axisymmetric());
  job.protocol.tilt = 0.0;
  EXPECT_TRUE(job.axisymmetric());
  job.protocol.lateral = 1e-3;
  EXPECT_FALSE(job.axisymmetric());
  job.protocol.lateral = 0.0;
  job.analysis = fem_reference::Analysis::modes;
  EXPECT_FALSE(job.axisymmetric());
}

}  // namespace
