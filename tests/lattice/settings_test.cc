#include "lattice/settings.h"

#include <gtest/gtest.h>

#include "fixtures.h"
#include "lattice/press.h"

using namespace fingertip;
using meshes::ContactMode;

namespace {

lattice::PressSetup valid_setup() {
  lattice::PressSetup setup;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return setup;
}

std::vector<std::string> keys_of(const std::vector<meshes::Violation>& violations) {
  std::vector<std::string> keys;
  for (const meshes::Violation& violation : violations) keys.push_back(violation.key);
  return keys;
}

}  // namespace

TEST(PressSetup, TheDefaultIsValid) {
  EXPECT_TRUE(valid_setup().violations().empty());
}

TEST(PressSetup, RefusesWhatOnlyTheContinuumCanDo) {
  using Keys = std::vector<std::string>;
  lattice::PressSetup setup = valid_setup();
  setup.protocol.contact = ContactMode::coulomb;
  EXPECT_EQ(keys_of(setup.violations()), Keys{"press.contact"});
  setup.protocol.tilt = -0.1;
  setup.protocol.lateral = 1e-3;
  EXPECT_EQ(keys_of(setup.violations()), (Keys{"press.contact", "press.tilt", "press.lateral"}));
  for (const meshes::Violation& violation : setup.violations()) {
    EXPECT_NE(violation.remedy.find("`reference`"), std::string::npos) << violation.key;
  }
  EXPECT_THROW(lattice::run_press(setup), meshes::InvalidInput);
}

TEST(PressSetup, FrictionMattersToCoulombContactAlone) {
  lattice::PressSetup setup = valid_setup();
  for (const ContactMode mode : {ContactMode::stick, ContactMode::frictionless}) {
    setup.protocol.contact = mode;
    setup.protocol.friction = -1.0;
    EXPECT_TRUE(setup.violations().empty()) << name(mode);
  }
}
