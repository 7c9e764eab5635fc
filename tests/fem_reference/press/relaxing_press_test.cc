// Presses of a rubber that relaxes: against Lee & Radok's integral over the elastic curve, against
// limits, against themselves in smaller steps.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fem_reference/press/press_course.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_motion.h"
#include "tests/fem_reference/press/pressing.h"

using namespace fingertip;
using fem_reference::PressCourse;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using fem_reference::Symmetry;
using meshes::ContactMode;

namespace {

ReferenceJob relaxing_press(Strain strain = Strain::linear,
                            ContactMode contact = ContactMode::frictionless) {
  ReferenceJob job = meridian_press(contact, strain);
  job.protocol.speed = 0.01;
  job.press_to({1e-4, 3e-4, 6e-4, 1e-3});
  job.rubber.energy.volumetric = meshes::VolumetricLaw::quadratic;
  job.rubber.relaxation = {{{0.3, 0.01}, {0.25, 0.2}}, true};
  return job;
}

std::vector<double> forces(const ReferenceJob& job, double relaxing_step = 0.0) {
  Pressing pressing(job);
  if (relaxing_step > 0.0) pressing.press.set_relaxing_step(relaxing_step);
  std::vector<double> result;
  for (const double sample : job.protocol.samples)
    result.push_back(pressing.press.advance(sample).normal_force);
  return result;
}

/// Lee & Radok (J. Appl. Mech. 27, 1960, 438-444): contact that grows, all moduli relaxing alike:
/// F(t) = ∫ G(t - s)/G_inf dF_el(delta(s)).
TEST(RelaxingPress, IsLeeAndRadoksIntegralOverTheElasticCurve) {
  for (const Symmetry symmetry : {Symmetry::axisymmetric, Symmetry::none}) {
    ReferenceJob job = relaxing_press();
    job.symmetry = symmetry;
    const meshes::Relaxation relaxation = job.rubber.relaxation;
    const std::vector<double> found = forces(job);

    ReferenceJob elastic = job;
    elastic.rubber.relaxation = {};
    const int pieces = symmetry == Symmetry::none ? 80 : 400;
    std::vector<double> places{0.0};
    for (int i = 1; i <= pieces; ++i) places.push_back(1e-3 * i / pieces);
    elastic.press_to({places.begin() + 1, places.end()});
    std::vector<double> curve = forces(elastic);
    curve.insert(curve.begin(), 0.0);

    double worst = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double time = job.protocol.samples[k] / job.protocol.speed;
      double wanted = 0.0;
      for (std::size_t i = 1; i < places.size() && places[i] <= job.protocol.samples[k] + 1e-9;
           ++i) {
        // The modulus in the middle of a piece, within which F_el is nearly straight.
        const double middle = (places[i] + places[i - 1]) / 2 / job.protocol.speed;
        wanted += relaxation.modulus(time - middle) * (curve[i] - curve[i - 1]);
      }
      EXPECT_NEAR(found[k] / wanted, 1.0, 3e-3) << time;
      worst = std::max(worst, std::abs(found[k] / wanted - 1.0));
      // It matters.
      const double still = curve[std::size_t(std::lround(job.protocol.samples[k] / 1e-3 * pieces))];
      EXPECT_GT(found[k] / still, 1.2);
    }
    RecordProperty(std::string(name(symmetry)), std::to_string(worst));
  }
}

TEST(RelaxingPress, QuickBranchesAreGoneAndSlowOnesAreSprings) {
  for (const Strain strain : {Strain::linear, Strain::finite})
    for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
      for (const bool bulk : {true, false}) {
        ReferenceJob job = relaxing_press(strain, contact);
        job.press_to({4e-4});
        job.rubber.relaxation.bulk = bulk;
        ReferenceJob soft = job, hard = job;
        soft.rubber.relaxation = hard.rubber.relaxation = {};
        const double G = job.rubber.relaxation.instantaneous_ratio() * job.rubber.shear_modulus,
                     K = job.rubber.bulk_modulus() *
                         (bulk ? job.rubber.relaxation.instantaneous_ratio() : 1.0);
        hard.rubber.set_lame(G, K - 2.0 / 3.0 * G);
        // In the same steps: where a node first touches depends on them.
        for (auto& branch : job.rubber.relaxation.branches) branch.time *= 1e-7;
        EXPECT_NEAR(forces(job, 1.0).back() / forces(soft).back(), 1.0, 1e-5);
        for (auto& branch : job.rubber.relaxation.branches) branch.time *= 1e14;
        EXPECT_NEAR(forces(job, 1.0).back() / forces(hard).back(), 1.0, 1e-5);
      }
}

TEST(RelaxingPress, StepsAreFineEnough) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
    for (const Strain strain : {Strain::linear, Strain::finite}) {
      ReferenceJob job = relaxing_press(strain, contact);
      job.press_to({1e-4, 1e-3});
      for (const double time : {1e-3, 1e-2}) {
        job.rubber.relaxation.branches = {{0.6, time}};
        const std::vector<double> usual = forces(job), fine = forces(job, 1.0 / 256.0);
        for (std::size_t k = 0; k < fine.size(); ++k)
          EXPECT_NEAR(usual[k] / fine[k], 1.0, strain == Strain::linear ? 1e-4 : 3e-4)
              << name(contact) << " " << name(strain) << " " << time << " " << k;
      }
    }
}

TEST(RelaxingPress, ForceIsThatOfTheBond) {
  for (const Strain strain : {Strain::linear, Strain::finite})
    for (const bool bulk : {true, false}) {
      ReferenceJob job = relaxing_press(strain, ContactMode::stick);
      job.rubber.relaxation.bulk = bulk;
      Pressing pressing(job);
      const PressState state = pressing.press.advance(4e-4);
      EXPECT_NEAR(pressing.press.bond_reaction().z() / state.normal_force, 1.0, 1e-6);
      EXPECT_DOUBLE_EQ(state.time, 0.04);
    }
}

TEST(RelaxingPress, GoesOnFromACheckpoint) {
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    const ReferenceJob job = relaxing_press(strain, ContactMode::stick);
    Pressing whole(job);
    whole.press.advance(2e-4);
    whole.press.save(whole.folder().path());
    const double wanted = whole.press.advance(4e-4).normal_force;
    Pressing again(job);
    again.press.load(whole.folder().path());
    EXPECT_NEAR(again.press.advance(4e-4).normal_force / wanted, 1.0, 1e-10);
  }
}

// --- Programs. ---

ReferenceJob program_press(Strain strain, ContactMode contact) {
  ReferenceJob job = relaxing_press(strain, contact);
  job.press_to({2e-4, 4e-4, 7e-4, 1e-3});
  job.protocol.program = {
      {1e-3, 0.01, 0.0}, {1e-3, 0.0, 0.5}, {0.0, 0.02, 0.0}, {0.0, 0.0, 1.0}, {4e-4, 0.01, 0.0}};
  return job;
}

std::vector<PressState> states(const ReferenceJob& job, double relaxing_step = 0.0) {
  Pressing pressing(job);
  if (relaxing_step > 0.0) pressing.press.set_relaxing_step(relaxing_step);
  std::vector<PressState> result;
  const PressCourse course(job.protocol, job.in_time());
  for (const double place : course.samples()) result.push_back(pressing.press.advance(place));
  return result;
}

TEST(ProgramPress, ReturnsAlongTheElasticCurve) {
  // Nothing sticks, nothing relaxes: what was on the way down is on the way up.
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    ReferenceJob job = program_press(strain, ContactMode::frictionless);
    job.rubber.relaxation = {};
    ReferenceJob once = job;
    once.protocol.program.clear();
    const std::vector<double> down = forces(once);
    const std::vector<PressState> all = states(job);
    ASSERT_EQ(all.size(), 10U);  // 4 down, 4 up, 2 down
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(all[i].normal_force / down[i], 1.0, 1e-6);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(all[4 + i].normal_force / down[2 - i], 1.0, 1e-6);
    EXPECT_NEAR(all[7].normal_force / down[3], 0.0, 1e-9);
    EXPECT_LT(all[7].contact_radius, 1e-5);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(all[8 + i].normal_force / down[i], 1.0, 1e-6);
    EXPECT_TRUE(std::isnan(all[0].time));
  }
}

TEST(ProgramPress, StickLetsGoOfWhatIsPulled) {
  // What sticks is drawn together by the way back: more than without friction, and no pull.
  ReferenceJob job = program_press(Strain::linear, ContactMode::stick);
  job.rubber.relaxation = {};
  const std::vector<PressState> all = states(job);
  for (const PressState& state : all) {
    EXPECT_GE(state.normal_force, 0.0);
    for (const auto& point : state.contact) EXPECT_GT(point.normal_traction, -1e-6 * state.max_pressure);
  }
  EXPECT_EQ(all[7].normal_force, 0.0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(all[4 + i].normal_force / all[2 - i].normal_force, 1.0, 0.1);
  // Once let go the tip is as new.
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(all[8 + i].normal_force / all[i].normal_force, 1.0, 5e-3);
}

TEST(ProgramPress, HoldsAsLeeAndRadokSay) {
  // Until the rod goes back: F(t) = ∫ G(t - s)/G_inf dF_el(delta(s)).
  const ReferenceJob job = program_press(Strain::linear, ContactMode::frictionless);
  const meshes::PressMotion motion(job.protocol);
  ReferenceJob elastic = job;
  elastic.rubber.relaxation = {};
  elastic.protocol.program.clear();
  const int pieces = 400;
  std::vector<double> depths;
  std::vector<double> times{0.0};
  for (int i = 1; i <= pieces; ++i) depths.push_back(1e-3 * i / pieces);
  for (const double depth : depths) times.push_back(motion.time_at(depth) - motion.touch_time());
  elastic.press_to(depths);
  std::vector<double> curve = forces(elastic);
  curve.insert(curve.begin(), 0.0);
  Pressing pressing(job);
  const PressCourse course(job.protocol, true);
  for (std::size_t k = 0; k < 14; ++k) {
    const PressState state = pressing.press.advance(course.samples()[k]);
    const double time = motion.samples()[k].time - motion.touch_time();
    EXPECT_NEAR(state.time, time, 1e-12);
    double wanted = 0.0;
    for (std::size_t i = 1; i < times.size() && times[i] <= time + 1e-9; ++i)
      wanted += job.rubber.relaxation.modulus(time - (times[i] + times[i - 1]) / 2) *
                (curve[i] - curve[i - 1]);
    EXPECT_NEAR(state.normal_force / wanted, 1.0, 3e-3) << k;
    RecordProperty("sample" + std::to_string(k), std::to_string(state.normal_force / wanted - 1));
  }
}

TEST(ProgramPress, GoesThroughEveryStageOfARubberThatRelaxes) {
  for (const Strain strain : {Strain::linear, Strain::finite})
    for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
      const ReferenceJob job = program_press(strain, contact);
      const std::vector<PressState> usual = states(job), fine = states(job, 1.0 / 128.0);
      const double largest = usual[3].normal_force;
      EXPECT_LT(usual[13].normal_force, 0.8 * largest);          // it has relaxed
      EXPECT_LT(usual[15].normal_force, usual[2].normal_force);  // hysteresis
      double last = 0.0;
      for (std::size_t i = 0; i < usual.size(); ++i) {
        const auto& sample = usual[i];
        EXPECT_GT(sample.time, last);
        last = sample.time;
        EXPECT_GE(sample.normal_force, 0.0);
        EXPECT_NEAR(sample.normal_force, fine[i].normal_force, 2e-3 * largest) << i;
      }
      // After a second of rest the branch of 0.2 s has forgotten most; the rod slows down to its
      // end, so that more has relaxed than on the first way.
      const double again = usual.back().normal_force / usual[1].normal_force;
      EXPECT_LT(again, 0.95);
      EXPECT_GT(again, 0.8);
    }
}

}  // namespace
