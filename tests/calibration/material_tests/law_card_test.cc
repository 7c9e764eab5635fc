/// The card of a law: to the bits and back, and what is refused.
#include "calibration/material_tests/law_card.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/material/material.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::calibration;

namespace {

LawCard ogden_card() {
  LawCard card;
  card.choice = {meshes::RubberLaw::ogden, 2};
  card.coefficients = {{1234.5678901234567, 1200.0, 1270.0},
                       {2.1, 2.0, 2.2},
                       {77.7, std::nan(""), std::nan("")},
                       {-3.3, -3.5, -3.1}};
  card.bulk_modulus = CardValue{2e6, 1.9e6, 2.1e6};
  card.tested = {0.4, 2.5};
  card.rates = {0.005, 0.2};
  card.tests = {{"pull \"fast\"", TestKind::uniaxial, true, 12, 0.01, 0.02},
                {"sheet", TestKind::planar, false, 7, 0.1, 0.2}};
  card.contradictions = {"one", "a second \\ one"};
  card.material = "silicone";
  card.provenance = "a.csv (SHA-256 00)";
  card.statement = "What it is.";
  return card;
}

class Cards : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_ / "material.toml"; }
  void expect_refused(const std::string& from, const std::string& to, const std::string& part) {
    write_law_card(ogden_card(), file());
    std::string text = read_text(file());
    const auto at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    write_text(file(), text.replace(at, from.size(), to));
    EXPECT_TRUE(
        refuses<meshes::InvalidInput>([&] { read_law_card(file()); }, {part, "material.toml"}));
  }
  TemporaryFolder folder_;
};

LawCard relaxing_card() {
  LawCard card = ogden_card();
  card.choice.branches = 2;
  for (const double value : {0.15, 0.012345678901234567, 0.3, 4.5})
    card.coefficients.push_back({value, 0.9 * value, 1.1 * value});
  card.times = {0.003, 60.5};
  card.tests.push_back(
      {"ramp and hold", TestKind::uniaxial, true, 90, 0.01, 0.03, TestCourse::relaxation});
  return card;
}

TEST_F(Cards, ARelaxationIsReadBackToTheSameBits) {
  const LawCard written = relaxing_card();
  write_law_card(written, file());
  const LawCard read = read_law_card(file());
  EXPECT_EQ(read.choice, written.choice);
  EXPECT_EQ(read.relaxation(), written.relaxation());
  EXPECT_EQ(read.relaxation().branches.at(0).time, 0.012345678901234567);
  EXPECT_EQ(read.coefficients.back().upper, written.coefficients.back().upper);
  EXPECT_EQ(read.times, written.times);
  EXPECT_EQ(read.tests.back().course, TestCourse::relaxation);
  EXPECT_EQ(read.tests.front().course, TestCourse::slow);
}

TEST_F(Cards, ARelaxationThatIsNoneIsRefused) {
  const auto refused = [&](const std::string& from, const std::string& to, const char* part) {
    write_law_card(relaxing_card(), file());
    std::string text = read_text(file());
    const auto at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    write_text(file(), text.replace(at, from.size(), to));
    EXPECT_TRUE(refuses<meshes::InvalidInput>([&] { read_law_card(file()); }, part));
  };
  refused("relaxation_g2 = 0.3", "relaxation_g2 = 0.9", "sum to less than 1");
  refused("relaxation_g2 = 0.3", "relaxation_g2 = -0.3", "must be positive");
  refused("relaxation_tau2 = \"4.5 s\"", "relaxation_tau2 = \"0 s\"", "must be positive");
  refused("relaxation_tau2 = \"4.5 s\"", "relaxation_tau2 = \"4.5 m\"", "relaxation_tau2");
  refused("shortest_time = \"0.003 s\"\n", "", "shortest_time");
  refused("course = \"relaxation\"", "course = \"slow\"", "a course (relaxation or cycles)");
  refused("+prony-2", "", "no such key");
  refused("+prony-2", "+prony-3", "relaxation_g3");
  refused("+prony-2", "+prony-7", "must be one of");
}

TEST_F(Cards, OneThatIsNotAcceptedSaysSoFirst) {
  LawCard written = ogden_card();
  written.rejected = "one; it is a foam";
  write_law_card(written, file());
  EXPECT_EQ(read_text(file()).rfind("# NOT ACCEPTED", 0), 0u);
  const LawCard read = read_law_card(file());
  EXPECT_EQ(read.rejected, written.rejected);
  const auto told = warnings(read, std::nullopt);
  ASSERT_EQ(told.size(), 2u);  // "one" stands in the first
  EXPECT_EQ(told[0], "the fit failed its own tests: one; it is a foam");
  EXPECT_EQ(told[1], "a second \\ one");
}

TEST_F(Cards, ReadBackToTheSameBits) {
  const LawCard written = ogden_card();
  write_law_card(written, file());
  EXPECT_TRUE(omits(read_text(file()), "ACCEPTED"));
  const LawCard read = read_law_card(file());
  EXPECT_EQ(read.choice, written.choice);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(read.coefficients[i].value, written.coefficients[i].value);
  EXPECT_EQ(read.coefficients[0].upper, 1270.0);
  EXPECT_TRUE(std::isnan(read.coefficients[2].lower));
  EXPECT_EQ(read.bulk_modulus->lower, 1.9e6);
  EXPECT_EQ(read.tested, written.tested);
  EXPECT_EQ(read.rates, written.rates);
  ASSERT_EQ(read.tests.size(), 2u);
  EXPECT_EQ(read.tests[0].name, "pull \"fast\"");
  EXPECT_FALSE(read.tests[1].fitted);
  EXPECT_EQ(read.contradictions, written.contradictions);
  EXPECT_EQ(read.statement, "What it is.");
  const std::string text = read_text(file());
  write_law_card(read, file());
  EXPECT_EQ(read_text(file()), text);
}

TEST_F(Cards, RefusalsNameFileAndKey) {
  expect_refused("name = \"ogden-2\"", "name = \"ogden-9\"", "must be one of neo-hookean");
  expect_refused("name = \"ogden-2\"", "name = \"yeoh-2\"", "yeoh_c1");
  expect_refused("1234.5678901234567 Pa", "1234.5678901234567 kPa", "the unit Pa");
  expect_refused("1234.5678901234567 Pa", "-1e5 Pa", "positive shear modulus");
  expect_refused("ogden_alpha1 = 2.1", "ogden_alpha1 = 0.0", "exponents must not be 0");
  expect_refused("ogden_alpha1 = 2.1", "ogden_alpha1 = \"x\"", "ogden_alpha1");
  expect_refused("largest_stretch = 2.5", "largest_stretch = 0.9", "holds 1");
  expect_refused("kind = \"planar\"", "kind = \"bent\"", "a test has name, kind");
  expect_refused("material = ", "matrial = ", "no such key");
  expect_refused("slowest_rate = \"0.005 1/s\"", "slowest_rate = \"5 1/s\"", "in order");
  expect_refused("statement = ", "#statement = ", "about.statement");
}

TEST_F(Cards, LatticeAndLawPointAtEachOther) {
  write_law_card(ogden_card(), file());
  EXPECT_TRUE(refuses<meshes::InvalidInput>([&] { read_material_toml(file()); }, "rubber.card"));
  write_text(file(), "[lattice]\nmodel = \"hookean\"\n");
  EXPECT_TRUE(refuses<meshes::InvalidInput>([&] { read_law_card(file()); }, "lattice.constants"));
}

TEST_F(Cards, AUseBeyondTheTestsIsTold) {
  const LawCard card = ogden_card();
  EXPECT_EQ(warnings(card, std::array{0.5, 1.4}).size(), 2u);  // the contradictions
  const auto beyond = warnings(card, std::array{0.2, 1.4});
  ASSERT_EQ(beyond.size(), 3u);
  EXPECT_TRUE(says(beyond[0], "it is a guess"));
}

}  // namespace
