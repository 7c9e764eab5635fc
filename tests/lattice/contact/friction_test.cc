// Coulomb friction on the tip's true surface: point by point, and of whole presses.
#include <gtest/gtest.h>

#include <cmath>

#include "lattice/contact/penalty_contact.h"
#include "lattice/control/virtual_finger.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::ContactLaw;
using lattice::EmbeddedPoint;
using lattice::FingerSetup;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::PenaltyContact;
using lattice::Plane;
using lattice::State;
using lattice::VectorField;
using lattice::VirtualFinger;
using meshes::ContactMode;

namespace {

constexpr double clearance = 0.1e-3;

Plane plane_above() {
  return {Vector3(0.0, 0.0, 0.01 + clearance), -Vector3::UnitZ()};
}

/// The undeformed tip, pushed into the plane and along it.
struct RigidTip {
  LatticeModel model;
  lattice::Team team{1};
  PenaltyContact contact;

  explicit RigidTip(double mu, ModelKind kind = ModelKind::hookean)
      : model(tip(kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 6)),
        contact(model, plane_above(), {ContactMode::coulomb, mu}, team) {}
  /// The plane's force on the tip displaced by `shift`.
  Vector3 force(const Vector3& shift) {
    State state(model);
    const Vector3 along_grid = model.grid.axes.transpose() * shift;
    for (const std::size_t i : model.particles) state.displacement.set(i, along_grid);
    VectorField force(model.points());
    return contact.add(state, plane_above(), 0.0, force).force;
  }
  /// Depths of the points behind the plane, with their ties' stiffness.
  template <typename Visit>
  void for_each(double push, Visit visit) const {
    for (const EmbeddedPoint& tie : model.outer) {
      const double depth = push + tie.rest.z() - (0.01 + clearance);
      if (depth > 0.0) visit(depth, tie.stiffness);
    }
  }
};

/// A tip on a rod that does not move, and a plane that does.
struct Experiment {
  FingerSetup setup;
  std::unique_ptr<VirtualFinger> finger;

  explicit Experiment(const ContactLaw& law, ModelKind kind = ModelKind::hookean) {
    const bool finite = kind == ModelKind::network;
    setup.lattice = settings_for(kind, finite ? Kinematics::finite : Kinematics::small, 6);
    setup.contact = law;
    setup.plane = plane_above();
    setup.prescribed = true;
    setup.threads = 1;
  }
  void build() {
    finger = std::make_unique<VirtualFinger>(setup);
    finger->write([](double) { return lattice::RodMotion{}; });
  }
  /// Moves the plane for a time; of its force on the tip, the last one.
  Vector3 move(const Vector3& velocity, double duration) {
    if (!finger) build();
    Plane plane = finger->finger().plane();
    plane.velocity = velocity;
    finger->move_plane(plane);
    finger->do_step(duration);
    return force();
  }
  Vector3 force() const { return finger->finger().plane_impulse().force / finger->finger().step(); }
  /// Presses to a depth [m].
  Vector3 press(double depth, double speed = 0.02) {
    return move(-speed * Vector3::UnitZ(), (clearance + depth) / speed);
  }
};

double tangential(const Vector3& force) {
  return std::hypot(force.x(), force.y());
}

}  // namespace

TEST(CoulombPoint, SticksUpToMuTimesThePushAndSlidesUnderExactlyThat) {
  const double mu = 0.3, push = 4e-4;
  const Vector3 along(0.6, 0.8, 0.0);
  for (const ModelKind kind : {ModelKind::hookean, ModelKind::network}) {
    RigidTip tip(mu, kind);
    tip.force(Vector3::Zero());
    Vector3 force = tip.force(push * Vector3::UnitZ());
    EXPECT_LT(tangential(force), 1e-12 * force.norm());
    EXPECT_EQ(tip.contact.sliding(), 0);
    for (const double way : {0.5e-5, 2e-5, 5e-5, 8.9e-5, 9.1e-5, 5e-4, 2e-3}) {
      force = tip.force(push * Vector3::UnitZ() + way * along);
      double normal = 0.0, friction = 0.0, energy = 0.0;
      int sliding = 0;
      tip.for_each(push, [&](double depth, double stiffness) {
        const lattice::kernel::TiePush<double> tie(tip.model.contact, depth);
        const double slips_at = mu * tie.length;
        normal += stiffness * tie.length;
        friction += stiffness * std::min(way, slips_at);
        energy += stiffness * (tie.energy + 0.5 * std::pow(std::min(way, slips_at), 2));
        sliding += way > slips_at;
      });
      EXPECT_NEAR(-force.z(), normal, 1e-10 * normal);
      EXPECT_LT((force - force.z() * Vector3::UnitZ() + friction * along).norm(), 1e-10 * normal);
      EXPECT_EQ(tip.contact.sliding(), sliding);
      EXPECT_NEAR(tip.contact.energy(), energy, 1e-10 * energy);
    }
    EXPECT_EQ(tip.contact.sliding(), tip.contact.touching());
    EXPECT_NEAR(tangential(force), mu * -force.z(), 1e-10 * mu * -force.z());
  }
}

TEST(CoulombPoint, ToAndFroDissipatesMuTimesThePushTimesTheWay) {
  // Elastic-plastic hysteresis: a point with the slip length s = mu n/k encloses 4 mu n (A - s)
  // between the ends +A and -A of its way.
  const double mu = 0.3, push = 4e-4, reach = 2e-4;
  RigidTip tip(mu);
  tip.force(Vector3::Zero());
  Vector3 last = tip.force(push * Vector3::UnitZ());
  double at = 0.0, work = 0.0;
  const int steps = 2000;
  const auto go = [&](double to) {
    const double from = at;
    work = 0.0;
    for (int n = 1; n <= steps; ++n) {
      const double next = from + (to - from) * n / steps;
      const Vector3 force = tip.force(push * Vector3::UnitZ() + next * Vector3::UnitX());
      work -= 0.5 * (force + last).x() * (next - at);
      last = force;
      at = next;
    }
    return work;
  };
  go(reach);
  const double there = go(-reach), back = go(reach);
  double expected = 0.0;
  tip.for_each(push, [&](double depth, double stiffness) {
    expected += 4.0 * mu * stiffness * depth * (reach - mu * depth);
  });
  EXPECT_NEAR(there + back, expected, 1e-4 * expected);
  EXPECT_NEAR(there, back, 1e-4 * expected);
}

TEST(CoulombPress, GrossSlidingTakesMuTimesThePushAgainstTheSlip) {
  const double mu = 0.3;
  Experiment e({ContactMode::coulomb, mu});
  e.press(1.5e-3);
  const Vector3 slip = 0.02 * Vector3(-0.8, 0.6, 0.0);  // of the tip against the plane
  for (const double sense : {1.0, -1.0}) {
    double most = 0.0;
    Vector3 force;
    for (int n = 0; n < 40; ++n) {
      force = e.move(-sense * slip, 0.005);
      most = std::max(most, tangential(force) / -force.z());
    }
    EXPECT_EQ(e.finger->finger().sliding(), e.finger->finger().touching());
    EXPECT_NEAR(most, mu, 0.01 * mu);  // never beyond, and it slides when it is there
    EXPECT_NEAR(tangential(force), mu * -force.z(), 0.01 * mu * -force.z());
    const Vector3 expected = -sense * mu * -force.z() * slip.normalized();
    EXPECT_LT((force - force.z() * Vector3::UnitZ() - expected).norm(), 0.01 * expected.norm());
  }
}

TEST(CoulombPress, TheEdgeOfTheContactSlipsFirst) {
  Experiment e({ContactMode::coulomb, 0.5});
  e.press(1.5e-3);
  e.move(0.02 * Vector3::UnitX(), 0.02);
  const LatticeModel& model = e.finger->model();
  const std::vector<std::uint8_t> held = e.finger->finger().held();
  double sticking = 0.0, sliding = 0.0;
  int stick = 0, slide = 0;
  for (std::size_t b = 0; b < held.size(); ++b) {
    const Vector3 x = model.rest_position(model.boundary[b]);
    const double radius = std::hypot(x.x(), x.y());
    if (held[b] == 1) sticking += radius, ++stick;
    if (held[b] == 2) sliding += radius, ++slide;
  }
  EXPECT_GT(stick, 10);
  EXPECT_GT(slide, 10);
  EXPECT_GT(sliding / slide, 1.5 * sticking / stick);
}

TEST(CoulombPress, GoesFromNoFrictionToStick) {
  const auto path = [](const ContactLaw& law) {
    Experiment e(law);
    e.press(1.5e-3);
    return e.move(0.02 * Vector3::UnitX(), 0.05);
  };
  const Vector3 stick = path(ContactMode::stick), free = path(ContactMode::frictionless);
  EXPECT_GT(tangential(stick), 0.2 * -stick.z());
  EXPECT_GT((stick - free).norm(), 0.2 * stick.norm());
  EXPECT_LT((path({ContactMode::coulomb, 1e12}) - stick).norm(), 1e-9 * stick.norm());
  EXPECT_LT((path({ContactMode::coulomb, 1e-9}) - free).norm(), 1e-6 * free.norm());
}

TEST(CoulombPress, DoesNotDependOnTheStepOrTheThreads) {
  const auto path = [](double share, int threads) {
    Experiment e({ContactMode::coulomb, 0.3});
    e.setup.threads = threads;
    e.build();
    if (share < 1.0) e.setup.time_step = share * e.finger->finger().step();
    e.build();
    std::vector<Vector3> forces{e.press(1.5e-3)};
    for (int n = 0; n < 6; ++n) forces.push_back(e.move(0.02 * Vector3::UnitX(), 0.01));
    for (int n = 0; n < 3; ++n) forces.push_back(e.move(-0.02 * Vector3::UnitX(), 0.01));
    return forces;
  };
  const auto once = path(1.0, 1), shared = path(1.0, 2), halved = path(0.5, 1);
  for (std::size_t n = 0; n < once.size(); ++n) {
    EXPECT_EQ(once[n], shared[n]);
    EXPECT_LT((once[n] - halved[n]).norm(), 0.005 * once[n].norm()) << n;
  }
}
