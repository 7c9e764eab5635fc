#include "studies/presses/press_notes.h"

#include <gtest/gtest.h>

#include "studies/config/loader.h"
#include "tests/studies/configured.h"

using namespace fingertip::studies;

namespace {

std::string note_on(std::vector<std::string> sets) {
  sets.emplace_back("run.integrator=mass-scaled");
  const auto notes = scaling_notes(setup_of(std::move(sets)));
  return notes.empty() ? "" : notes.front();
}

}  // namespace

TEST(PressNotes, ALawThatHasNoSayIsTold) {
  const std::vector<std::string> gent = {"rubber.law=gent", "rubber.gent_jm=9.0"};
  const auto notes = law_notes(setup_of(gent));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(says(notes[0], "gent, logarithmic"));
  auto network = gent;
  network.emplace_back("lattice.model=network");
  EXPECT_TRUE(law_notes(setup_of(network)).empty());
  EXPECT_TRUE(law_notes(setup_of({})).empty());
}

TEST(PressNotes, FastPressesWithLongStepsAreTold) {
  const std::string note = note_on({"press.speed=20 cm/s", "run.time_step=1 ms"});
  EXPECT_TRUE(says(note, {"scaled masses at steps of 1 ms", "more than 100 %",
                          "run.time_step = auto takes plain masses"}));
}

TEST(PressNotes, StepsThatAreNotGivenNameWhatWasChosen) {
  EXPECT_TRUE(says(note_on({"press.speed=20 cm/s"}), "plain masses are pressed"));
  const std::string slow = note_on({"press.speed=1 cm/s"});
  EXPECT_TRUE(says(slow, {"steps of 250 us", "from 0.5 mm on"}));
  EXPECT_EQ(note_on({"press.samples=[\"0.1 cm\", \"0.3 cm\"]"}), "");
}

TEST(PressNotes, PlainMassesAndEquilibriaNeedNone) {
  EXPECT_TRUE(scaling_notes(setup_of({"press.speed=20 cm/s"})).empty());
  EXPECT_EQ(note_on({"press.speed=20 cm/s", "press.mode=static"}), "");
}

TEST(PressNotes, AStiffRubberIsOfferedScaledMasses) {
  const std::vector<std::string> silicone = {"rubber.youngs_modulus=340 kPa",
                                             "rubber.shear_modulus=114 kPa", "press.depth=1 mm"};
  const auto note = duration_note(setup_of(silicone), 1);
  ASSERT_TRUE(note);
  EXPECT_TRUE(says(
      *note, {"run.integrator = mass-scaled would take some", "change the force by an estimated"}));
  EXPECT_FALSE(duration_note(setup_of({}), 1)) << "short enough";
  auto scaled = silicone;
  scaled.emplace_back("run.integrator=mass-scaled");
  EXPECT_FALSE(duration_note(setup_of(scaled), 1));
  auto central = silicone;
  central.emplace_back("lattice.model=central");
  EXPECT_FALSE(duration_note(setup_of(central), 1)) << "cannot be scaled";
}

TEST(PressNotes, TheIntegratorIsChosenByThePress) {
  using fingertip::lattice::Integrator;
  const auto chosen = [](std::vector<std::string> sets) {
    sets.emplace_back("run.integrator=auto");
    return setup_of(std::move(sets));
  };
  const auto slow = chosen({"press.speed=1 cm/s"});
  EXPECT_EQ(slow.integrator, Integrator::mass_scaled);
  EXPECT_TRUE(says(integrator_note(slow), "mass-scaled, steps of 250 us"));
  for (const char* plain : {"press.speed=20 cm/s", "press.mode=static", "run.time_step=10 us",
                            "lattice.model=published"}) {
    const auto setup = chosen({plain});
    EXPECT_EQ(setup.integrator, Integrator::symplectic_euler) << plain;
    EXPECT_TRUE(says(integrator_note(setup), "symplectic-euler")) << plain;
  }
}
