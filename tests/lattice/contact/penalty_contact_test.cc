#include "lattice/contact/penalty_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "lattice/forces/energy.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"
#include "lattice/statics/static_contact.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::EmbeddedPoint;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::LatticeSettings;
using lattice::ModelKind;
using lattice::PenaltyContact;
using lattice::Plane;
using lattice::State;
using lattice::StaticContact;
using lattice::VectorField;
using meshes::ContactMode;

namespace {

constexpr double clearance = 0.1e-3;
constexpr int looks = 8 * 65;  // after so many every point has been looked at
constexpr std::array both_modes{ContactMode::frictionless, ContactMode::stick};
const std::array all_laws{lattice::ContactLaw{ContactMode::frictionless},
                          lattice::ContactLaw{ContactMode::stick},
                          lattice::ContactLaw{ContactMode::coulomb, 0.05},
                          lattice::ContactLaw{ContactMode::coulomb, 1.0}};

/// A tip on a grid that is aligned with nothing, and a tilted plane 0.1 mm from its surface.
struct Scene {
  LatticeSettings settings;
  lattice::PressPlane press;
  LatticeModel model;
  Plane plane;
  mutable lattice::Team team{1};

  explicit Scene(const meshes::Obstacle& obstacle = {}, Kinematics kinematics = Kinematics::small)
      : settings(
            settings_for(kinematics == Kinematics::small ? ModelKind::hookean : ModelKind::network,
                         kinematics, 6)) {
    settings.axes = Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).matrix();
    settings.offset = Vector3(0.3, -0.2, 0.1);
    model = lattice::build_cut_model({}, {}, settings);
    meshes::PressProtocol protocol;
    protocol.tilt = 0.25;
    protocol.obstacle = obstacle;
    press = lattice::press_plane(protocol, {});
    plane.point = press.point(-clearance);
    plane.normal = press.normal;
    plane.obstacle = obstacle;
  }
  /// Every particle displaced by `shift` (tip's frame).
  State moved(const Vector3& shift) const {
    State state(model);
    for (const std::size_t i : model.particles) {
      state.displacement.set(i, model.grid.axes.transpose() * shift);
    }
    return state;
  }
  /// A smooth deformation, so that points move apart, on the way `share` of which is gone.
  State pressed(double share) const {
    State state(model);
    for (const std::size_t i : model.particles) {
      const Vector3 q = 200.0 * model.rest_position(i);
      const Vector3 u = -1e-3 * plane.normal + 2e-4 * Vector3(std::sin(q.y()), q.x() * q.y() / 4.0,
                                                              std::cos(q.x() + q.z()));
      state.displacement.set(i, model.grid.axes.transpose() * (share * u));
    }
    return state;
  }
  double gap(const EmbeddedPoint& tie, const State& state) const {
    return plane.normal.dot(tie.rest + model.grid.axes * shift(tie, state) - plane.point);
  }
  /// Along the grid's axes.
  static Vector3 shift(const EmbeddedPoint& tie, const State& state) {
    Vector3 sum = Vector3::Zero();
    for (std::size_t c = 0; c < 8; ++c) {
      sum += tie.weights[c] * state.displacement.at(tie.corners[c]);
    }
    return sum;
  }
  int penetrating(const State& state) const {
    return int(std::count_if(model.outer.begin(), model.outer.end(),
                             [&](const EmbeddedPoint& tie) { return gap(tie, state) < 0.0; }));
  }
};

VectorField forces(const Scene& s, PenaltyContact& contact, const State& state, int times = 1) {
  VectorField force;
  for (int n = 0; n < times; ++n) {
    force = VectorField(s.model.points());
    contact.add(state, s.plane, 0.0, force);
  }
  return force;
}

double difference(const LatticeModel& model, const VectorField& a, const VectorField& b) {
  double result = 0.0;
  for (const std::size_t i : model.particles) result = std::max(result, (a.at(i) - b.at(i)).norm());
  return result;
}

}  // namespace

TEST(PenaltyContact, FrictionlessPushesAlongTheNormalWhatPenetrates) {
  for (const Kinematics kinematics : both_kinematics) {
    const Scene s({}, kinematics);
    PenaltyContact contact(s.model, s.plane, ContactMode::frictionless, s.team);
    EXPECT_EQ(largest(s.model, forces(s, contact, s.moved(-0.9 * clearance * s.plane.normal))),
              0.0);
    EXPECT_EQ(contact.touching(), 0);
    EXPECT_EQ(contact.energy(), 0.0);

    const State state = s.pressed(1.0);
    const VectorField force = forces(s, contact, state, looks);
    VectorField expected(s.model.points());
    double energy = 0.0;
    const Vector3 normal = s.model.grid.axes.transpose() * s.plane.normal;
    for (const EmbeddedPoint& tie : s.model.outer) {
      const double gap = s.gap(tie, state);
      if (gap >= 0.0) continue;
      const lattice::kernel::TiePush<double> push(s.model.contact, -gap);
      energy += tie.stiffness * push.energy;
      for (std::size_t c = 0; c < 8; ++c) {
        expected.add(tie.corners[c], tie.weights[c] * tie.stiffness * push.length * normal);
      }
    }
    EXPECT_LT(difference(s.model, force, expected), 1e-11 * largest(s.model, expected));
    EXPECT_NEAR(contact.energy(), energy, 1e-11 * energy);
    EXPECT_EQ(contact.touching(), s.penetrating(state));
    EXPECT_GT(contact.touching(), 20);
  }
}

namespace {

void expect_static_contact(const Scene& s) {
  const lattice::LatticeBody body = lattice::build_cut_tip({}, {}, s.settings, 1);
  const lattice::ElasticSystem system(body);
  const auto unknowns = [&](const State& state) {
    Eigen::VectorXd u(body.unknowns());
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      u.segment<3>(3 * Eigen::Index(p)) =
          s.model.grid.axes * state.displacement.at(s.model.particles[p]);
    }
    return u;
  };
  for (const ContactMode mode : both_modes) {
    PenaltyContact moving(s.model, s.plane, mode, s.team);
    StaticContact resting(body, s.press, mode);
    resting.begin_step(-clearance, Eigen::VectorXd::Zero(body.unknowns()));
    VectorField force;
    Eigen::VectorXd before = Eigen::VectorXd::Zero(body.unknowns()), u, in_statics;
    const int steps = 200;
    for (int n = 1; n <= steps; ++n) {
      const State state = s.pressed(double(n) / steps);
      force = forces(s, moving, state);
      u = unknowns(state);
      if (mode == ContactMode::stick) resting.anchor_touching(before, -clearance, u);
      before = u;
    }
    in_statics = Eigen::VectorXd::Zero(body.unknowns());
    resting.add(u, system, in_statics, nullptr);
    const double scale = largest(s.model, force);
    EXPECT_GT(scale, 0.0);
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      const Vector3 at = s.model.grid.axes * force.at(s.model.particles[p]);
      EXPECT_LT((at - in_statics.segment<3>(3 * Eigen::Index(p))).norm(), 1e-9 * scale)
          << name(mode);
    }
    EXPECT_NEAR(moving.energy(), resting.energy(u), 1e-9 * moving.energy()) << name(mode);
    std::vector<lattice::TiedPoint> ties = resting.points(u);
    for (std::size_t i = 0; i < ties.size(); ++i) {  // areas at rest
      meshes::ContactPoint& point = ties[i].point;
      const Vector3 push = point.force();
      point.area = seen_area(body.outer[i], s.press.normal) / std::abs(point.normal.z());
      point.set_force(push);
    }
    const meshes::ContactPatch patch = moving.patch(), expected = lattice::tied_patch(ties, 1);
    EXPECT_NEAR(patch.radius, expected.radius, 1e-9 * expected.radius) << name(mode);
    EXPECT_EQ(patch.is_ellipse(), expected.is_ellipse()) << name(mode);
    if (expected.is_ellipse()) {
      EXPECT_NEAR(patch.max_pressure, expected.max_pressure, 1e-9 * expected.max_pressure);
      EXPECT_GT(patch.max_pressure, 0.0);
    }
  }
}

}  // namespace

TEST(PenaltyContact, HasTheEnergyAndForcesOfTheStaticContact) {
  for (const Kinematics kinematics : both_kinematics) expect_static_contact(Scene({}, kinematics));
  for (const meshes::ObstacleShape shape :
       {meshes::ObstacleShape::sphere, meshes::ObstacleShape::cylinder,
        meshes::ObstacleShape::edge})
    for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
      SCOPED_TRACE(std::string(name(shape)) + (kinematics == Kinematics::small ? " small" : ""));
      expect_static_contact(Scene({.shape = shape, .radius = 3e-3, .offset = 1e-3}, kinematics));
    }
}

TEST(PenaltyContact, AnchorsWhereThePlaneWasCrossedAndLetsGoWhenPulled) {
  const Scene s;
  PenaltyContact contact(s.model, s.plane, ContactMode::stick, s.team);
  // Toward the plane and along it at once: a point with the gap g crosses after g/depth of the way.
  const double depth = 0.3e-3, tangential = 0.2e-3;
  const Vector3 along = s.press.t1, end = -depth * s.plane.normal + tangential * along;
  forces(s, contact, State(s.model));
  VectorField force = forces(s, contact, s.moved(end)), expected(s.model.points());
  int crossed = 0;
  for (const EmbeddedPoint& tie : s.model.outer) {
    const double gap = s.plane.normal.dot(tie.rest - s.plane.point);
    if (gap >= depth) continue;
    ++crossed;
    const Vector3 pull = tie.stiffness * (gap / depth - 1.0) * end;
    for (std::size_t c = 0; c < 8; ++c) {
      expected.add(tie.corners[c], tie.weights[c] * (s.model.grid.axes.transpose() * pull));
    }
  }
  EXPECT_GT(crossed, 10);
  EXPECT_EQ(contact.touching(), crossed);
  EXPECT_LT(difference(s.model, force, expected), 1e-11 * largest(s.model, expected));

  // Half way back the points that had less than half to go still hold, against the drag.
  forces(s, contact, s.moved(0.5 * end));
  EXPECT_EQ(contact.touching(), s.penetrating(s.moved(0.5 * end)));
  EXPECT_GT(contact.touching(), 0);
  EXPECT_EQ(largest(s.model, forces(s, contact, State(s.model))), 0.0);
  EXPECT_EQ(contact.touching(), 0);

  // And they are anchored anew where they touch again: straight down, there is no drag.
  forces(s, contact, s.moved(tangential * along));
  force = forces(s, contact, s.moved(-depth * s.plane.normal + tangential * along));
  EXPECT_EQ(contact.touching(), crossed);
  for (const std::size_t i : s.model.particles) {
    EXPECT_NEAR((s.model.grid.axes * force.at(i)).dot(along), 0.0, 1e-12 * largest(s.model, force));
  }
}

TEST(PenaltyContact, FindsPointsThatComeNearLateAndAgain) {
  for (const ContactMode mode : both_modes) {
    const Scene s;
    PenaltyContact contact(s.model, s.plane, mode, s.team);
    const State deep = s.moved(-2e-3 * s.plane.normal), far = s.moved(5e-3 * s.plane.normal);
    const int expected = s.penetrating(deep);
    for (const State* state : {&deep, &far, &deep}) {
      forces(s, contact, *state, looks);
      EXPECT_EQ(contact.touching(), state == &far ? 0 : expected) << name(mode);
    }
    EXPECT_GT(expected, s.penetrating(s.moved(-1e-3 * s.plane.normal)));
    forces(s, contact, far, looks);
    EXPECT_EQ(contact.energy(), 0.0);
  }
}

TEST(PenaltyContact, DoesNotDependOnWhoseTurnItIs) {
  for (const ContactMode mode : both_modes) {
    const Scene s;
    PenaltyContact in_turn(s.model, s.plane, mode, s.team), ahead(s.model, s.plane, mode, s.team);
    forces(s, ahead, State(s.model), 5);  // five turns ahead
    VectorField a, b;
    for (int n = 1; n <= 200; ++n) {
      const State state = s.pressed(n / 200.0);
      a = forces(s, in_turn, state);
      b = forces(s, ahead, state);
      EXPECT_LT(difference(s.model, a, b), 1e-12 * (largest(s.model, a) + 1e-9)) << n;
    }
    EXPECT_GT(largest(s.model, a), 0.0);
  }
}

TEST(PenaltyContact, ThePlaneReceivesWhatTheParticlesLose) {
  for (const Kinematics kinematics : both_kinematics) {
    for (const ContactMode mode : both_modes) {
      for (const double step : {0.0, 1e-4, 1.0}) {
        const Scene s({}, kinematics);
        PenaltyContact contact(s.model, s.plane, mode, s.team);
        forces(s, contact, s.pressed(0.5), looks);
        State state = s.pressed(1.0);
        const State rough = random_state(s.model, 1.0, 0.05, 3);
        state.velocity = rough.velocity;
        const VectorField others = rough.displacement;
        VectorField force = others;
        const Vector3 plane_force = contact.add(state, s.plane, step, force).force;
        Vector3 sum = Vector3::Zero();
        double tangential = 0.0, magnitude = 0.0;
        for (const std::size_t i : s.model.particles) {
          const Vector3 change = s.model.grid.axes * (force.at(i) - others.at(i));
          sum += change;
          magnitude += change.norm();
          tangential =
              std::max(tangential, (change - change.dot(s.plane.normal) * s.plane.normal).norm());
        }
        EXPECT_GT(magnitude, 0.0);
        EXPECT_LT((sum - plane_force).norm(), 1e-12 * magnitude) << name(mode) << step;
        // A tie's direction is known to round-off of its inertia over the mass.
        std::vector<lattice::ContactInertia> ties;
        contact.list_inertia(step, ties);
        double heaviest = 0.0;
        for (const lattice::ContactInertia& tie : ties)
          heaviest = std::max(heaviest, tie.inertia.trace() / s.model.mass[tie.particle]);
        const double known = std::max(1e-13, 1e-15 * heaviest) * magnitude;
        EXPECT_EQ(tangential < known, mode == ContactMode::frictionless) << name(mode) << step;
      }
    }
  }
}

TEST(PenaltyContact, ActsAsItWillBeAtTheEndOfTheStep) {
  for (const Kinematics kinematics : both_kinematics) {
    for (const ContactMode mode : both_modes) {
      const Scene s({}, kinematics);
      const double step = 1e-3;
      PenaltyContact moving(s.model, s.plane, mode, s.team),
          resting(s.model, s.plane, mode, s.team);
      State start = s.pressed(0.3);
      const State end = s.pressed(0.35);
      forces(s, moving, start, looks);
      forces(s, resting, start, looks);
      for (const std::size_t i : s.model.particles) {
        start.velocity.set(i, (end.displacement.at(i) - start.displacement.at(i)) / step);
      }
      VectorField a(s.model.points()), b = a;
      moving.add(start, s.plane, step, a);
      resting.add(end, s.plane, step, b);
      EXPECT_GT(largest(s.model, b), 0.0);
      EXPECT_LT(difference(s.model, a, b), 1e-9 * largest(s.model, b)) << name(mode);
    }
  }
}

TEST(PenaltyContact, DoesNotLimitTheStep) {
  for (const Kinematics kinematics : both_kinematics) {
    // Particles without rubber between them, thrown against the plane at steps below and far above
    // what explicit ties would allow: they come to rest or bounce off, with no more energy than
    // they had.
    for (const lattice::ContactLaw& law : all_laws) {
      for (const double step : {1e-7, 1e-5, 1e-3}) {
        const Scene s({}, kinematics);
        PenaltyContact contact(s.model, s.plane, law, s.team);
        State state = random_state(s.model, 0.0, 0.1, 7);
        const double speed = 0.1 * clearance / step;
        for (const std::size_t i : s.model.particles) {
          const Vector3 straight = s.model.grid.axes.transpose() * (-s.plane.normal);
          state.velocity.set(i, speed * (straight + state.velocity.at(i)));
        }
        const double start = lattice::kinetic_energy(s.model, state);
        double most = 0.0;
        int touching = 0;
        for (int n = 0; n < 60; ++n) {
          VectorField force(s.model.points());
          contact.add(state, s.plane, step, force);
          touching = std::max(touching, contact.touching());
          for (const std::size_t i : s.model.particles) {
            state.velocity.add(i, step * s.model.inverse_mass[i] * force.at(i));
            state.displacement.add(i, step * state.velocity.at(i));
          }
          most = std::max(most, lattice::kinetic_energy(s.model, state));
        }
        EXPECT_LE(most, 1.001 * start) << name(law.mode) << step;
        EXPECT_GT(touching, 0) << name(law.mode) << step;
      }
    }
  }
}

TEST(PenaltyContact, HoldsTheParticlesOfItsTies) {
  const Scene s;
  PenaltyContact contact(s.model, s.plane, ContactMode::frictionless, s.team);
  const State state = s.pressed(1.0);
  const VectorField force = forces(s, contact, state, looks);
  const std::vector<std::uint8_t> held = contact.held();
  ASSERT_EQ(held.size(), s.model.boundary.size());
  int pushed = 0;
  for (std::size_t b = 0; b < held.size(); ++b) {
    const std::uint32_t i = s.model.boundary[b];
    if (force.at(i).isZero(0.0)) continue;
    EXPECT_EQ(held[b], 1);
    ++pushed;
  }
  EXPECT_GT(pushed, 0);
  EXPECT_LT(std::count(held.begin(), held.end(), 1), std::ptrdiff_t(held.size()) / 2);
}

TEST(PenaltyContact, AFastTipIsLookedAtWholeInEveryStep) {
  // From far away to beyond the plane within one step: half a spacing is passed in no time.
  const Scene s;
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    PenaltyContact contact(s.model, s.plane, mode, s.team);
    State state = s.pressed(1.0);
    const double step = 1e-4;
    const Vector3 velocity =
        -s.model.spacing() / step * (s.model.grid.axes.transpose() * s.plane.normal);
    for (const std::size_t i : s.model.particles) {
      state.velocity.set(i, velocity);
      state.displacement.add(i, -step * velocity);  // `pressed` after the step
    }
    VectorField force(s.model.points());
    contact.add(state, s.plane, step, force);
    EXPECT_EQ(contact.touching(), s.penetrating(s.pressed(1.0))) << name(mode);
  }
}

TEST(PenaltyContact, EveryRegisterWidthGivesTheSameBits) {
  for (const Kinematics kinematics : both_kinematics) {
    const Scene s({}, kinematics);
    for (const lattice::ContactLaw& law : all_laws) {
      PenaltyContact narrow(s.model, s.plane, law, s.team, 2);
      for (int width = 4; width <= lattice::kernel::supported_width(); width *= 2) {
        PenaltyContact wide(s.model, s.plane, law, s.team, width), fresh = narrow;
        for (int n = 1; n <= 20; ++n) {
          State state = s.pressed(n / 20.0);
          state.velocity = random_state(s.model, 0.0, 0.05, unsigned(n)).velocity;
          VectorField expected(s.model.points()), force = expected;
          const lattice::Wrench a = fresh.add(state, s.plane, 1e-4, expected);
          const lattice::Wrench b = wide.add(state, s.plane, 1e-4, force);
          EXPECT_EQ(difference(s.model, force, expected), 0.0) << name(law.mode) << width;
          EXPECT_EQ(a.force, b.force);
          EXPECT_EQ(a.torque, b.torque);
          EXPECT_EQ(fresh.energy(), wide.energy());
          EXPECT_EQ(fresh.sliding(), wide.sliding());
        }
        EXPECT_GT(wide.touching(), 0);
      }
    }
  }
}
