/// material.toml: bits, old files, bad files; and what of a press lies outside of a fit.
#include "calibration/material/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "calibration/material/moduli.h"
#include "meshes/base/errors.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::calibration;
using lattice::Kinematics;
using lattice::ModelKind;
using meshes::ContactMode;

namespace {

constexpr double a = 1.0e-2 / 12.0;  // [m]

/// Everything known, nothing round.
Material fitted(ModelKind model) {
  Material m;
  m.model = model;
  m.spacing = a;
  m.kinematics = model == ModelKind::network ? Kinematics::finite : Kinematics::small;
  m.rubber = {4000.0 / 3.0 * std::numbers::e,
              1000.0 * std::numbers::sqrt2,
              1234.5 / 7.0,
              1.0 / 3.0e3,
              {},
              {}};
  m.constants = lattice::hookean_constants(m.rubber, a);
  if (model == ModelKind::central) m.constants.kappa = 0.0;
  m.geometry = meshes::Geometry{1.0e-2 / 3.0, 0.1e-2, 0.7e-2, 0.9e-2};
  m.ligament_stiffness = 1.0 + 1.0 / 49.0;
  m.contact_stiffness = 2.0;
  m.validity = {0.1e-2 / 3.0,
                0.5e-2,
                0.5,
                a,
                0.11e-2,
                0.1 + 0.2,
                0.43,
                1.0 / 3.0e2,
                {ContactMode::stick, ContactMode::frictionless}};
  m.provenance = "curve \"a\\b\".csv\nSHA-256 00ff\tµm, \x01\x7f";
  m.program = "fingertip 0.1.0";
  m.date = "2026-11-20T05:12:00Z";
  m.statement = "good for little";
  return m;
}

void expect_equal(const Material& got, const Material& wanted) {
  EXPECT_EQ(got.model, wanted.model);
  EXPECT_EQ(got.spacing, wanted.spacing);
  EXPECT_EQ(got.kinematics, wanted.kinematics);
  EXPECT_EQ(got.constants.k1, wanted.constants.k1);
  EXPECT_EQ(got.constants.k2, wanted.constants.k2);
  EXPECT_EQ(got.constants.k3, wanted.constants.k3);
  EXPECT_EQ(got.constants.kappa, wanted.constants.kappa);
  EXPECT_EQ(got.ligament_stiffness, wanted.ligament_stiffness);
  EXPECT_EQ(got.contact_stiffness, wanted.contact_stiffness);
  EXPECT_EQ(got.rubber.youngs_modulus, wanted.rubber.youngs_modulus);
  EXPECT_EQ(got.rubber.shear_modulus, wanted.rubber.shear_modulus);
  EXPECT_EQ(got.rubber.density, wanted.rubber.density);
  EXPECT_EQ(got.rubber.retardation_time, wanted.rubber.retardation_time);
  EXPECT_EQ(got.validity.largest_indentation, wanted.validity.largest_indentation);
  EXPECT_EQ(got.validity.thickness, wanted.validity.thickness);
  EXPECT_EQ(got.validity.rod_ratio, wanted.validity.rod_ratio);
  EXPECT_EQ(got.validity.smallest_spacing, wanted.validity.smallest_spacing);
  EXPECT_EQ(got.validity.largest_spacing, wanted.validity.largest_spacing);
  EXPECT_EQ(got.validity.smallest_poissons_ratio, wanted.validity.smallest_poissons_ratio);
  EXPECT_EQ(got.validity.largest_poissons_ratio, wanted.validity.largest_poissons_ratio);
  EXPECT_EQ(got.validity.model_error, wanted.validity.model_error);
  EXPECT_EQ(got.validity.contacts, wanted.validity.contacts);
  ASSERT_EQ(got.geometry.has_value(), wanted.geometry.has_value());
  if (wanted.geometry) {
    EXPECT_EQ(got.geometry->tip_radius, wanted.geometry->tip_radius);
    EXPECT_EQ(got.geometry->rod_radius, wanted.geometry->rod_radius);
    EXPECT_EQ(got.geometry->sleeve_length, wanted.geometry->sleeve_length);
    EXPECT_EQ(got.geometry->rod_length, wanted.geometry->rod_length);
  }
  EXPECT_EQ(got.density_known, wanted.density_known);
  EXPECT_EQ(got.retardation_time_known, wanted.retardation_time_known);
  EXPECT_EQ(got.rejected, wanted.rejected);
  EXPECT_EQ(got.provenance, wanted.provenance);
  EXPECT_EQ(got.program, wanted.program);
  EXPECT_EQ(got.date, wanted.date);
  EXPECT_EQ(got.statement, wanted.statement);
}

/// As version 0.1 wrote it before [validity].
constexpr const char* old_file = R"(# Calibrated lattice constants, SI.

[lattice]
model = "hookean"
spacing = "0.0008333333333333334 m"

[constants]
k1 = "1.1441091666666667 N/m"
k2 = "1.1441091666666667 N/m"
k3 = "0 N/m"
kappa = "6864.655 Pa"

[rubber]
youngs_modulus = "3922.66 Pa"
shear_modulus = "1372.931 Pa"
density = "500 kg/m^3"
retardation_time = "0.0003 s"

[about]
provenance = "least-squares fit"
validity = "small strain"
)";

class MaterialFile : public testing::Test {
 protected:
  /// What reading the good file of `model` says once `from` is replaced by `to`.
  std::string refusal(const std::string& from, const std::string& to,
                      ModelKind model = ModelKind::hookean) const {
    write_material_toml(fitted(model), file_);
    std::string text = read_text(file_);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write_text(file_, text.replace(at, from.size(), to));
    return refusal();
  }
  std::string refusal() const {
    try {
      read_material_toml(file_);
    } catch (const meshes::InvalidInput& error) {
      return error.what();
    }
    return "";
  }
  /// The message names file, line and key, and the rule.
  void expect_refused(const std::string& from, const std::string& to, const std::string& place,
                      const std::string& rule, ModelKind model = ModelKind::hookean) const {
    const std::string message = refusal(from, to, model);
    EXPECT_EQ(message.find(file_.string() + place), 0U) << message;
    EXPECT_NE(message.find(rule), std::string::npos) << message;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "material.toml";
};

TEST_F(MaterialFile, ReadsBackToTheSameBits) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central, ModelKind::network}) {
    const Material written = fitted(model);
    write_material_toml(written, file_);
    expect_equal(read_material_toml(file_), written);
  }
}

TEST_F(MaterialFile, ARelaxationIsReadBackToTheSameBits) {
  Material written = fitted(ModelKind::network);
  written.rubber.relaxation.branches = {{0.1 + 0.2, 0.01 / 3.0}, {0.1, 7.0 / 3.0}};
  write_material_toml(written, file_);
  EXPECT_EQ(read_material_toml(file_).rubber.relaxation, written.rubber.relaxation);
  written.rubber.relaxation.bulk = false;
  EXPECT_THROW(write_material_toml(written, file_), meshes::InvalidInput);
  written.rubber.relaxation = {std::vector<meshes::RelaxationBranch>(6, {0.1, 1.0}), true};
  EXPECT_THROW(write_material_toml(written, file_), meshes::InvalidInput);
}

TEST_F(MaterialFile, LeavesOutWhatIsUnknown) {
  Material written = fitted(ModelKind::hookean);
  written.kinematics.reset();
  written.validity = {};
  written.program = written.date = "";
  write_material_toml(written, file_);
  EXPECT_EQ(read_text(file_).find("[validity]"), std::string::npos);
  expect_equal(read_material_toml(file_), written);
}

/// Of a default density a file says nothing, of a fit that failed its own tests it says so.
TEST_F(MaterialFile, SaysWhatIsNotKnownAndWhatIsNotAccepted) {
  Material wanted = fitted(ModelKind::hookean);
  wanted.rubber.density = meshes::Rubber().density;
  wanted.rubber.retardation_time = meshes::Rubber().retardation_time;
  wanted.density_known = wanted.retardation_time_known = false;
  wanted.rejected = "chi-square is 313 at 20 degrees of freedom";
  write_material_toml(wanted, file_);
  EXPECT_EQ(read_text(file_).find("density"), std::string::npos);
  EXPECT_EQ(read_text(file_).rfind("# NOT ACCEPTED", 0), 0u);
  const Material got = read_material_toml(file_);
  expect_equal(got, wanted);
  lattice::PressSetup setup;
  setup.lattice.spacing = a;
  setup.rubber = wanted.rubber;
  setup.rubber.density = 2000.0;
  const auto said = warnings(got, setup);
  const auto tells = [&](const char* words) {
    return std::ranges::any_of(
        said, [&](const std::string& text) { return text.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(tells("failed its own tests: chi-square is 313"));
  EXPECT_FALSE(tells("density")) << "the press's own rules where the material's is not known";
}

TEST_F(MaterialFile, TheNetworkHasModuliOnly) {
  write_material_toml(fitted(ModelKind::network), file_);
  EXPECT_EQ(read_text(file_).find("[constants]"), std::string::npos);
  expect_refused("[rubber]", "[constants]\nk1 = \"1 N/m\"\n[rubber]", ":11: constants.k1",
                 "E and G in [rubber]", ModelKind::network);
}

TEST_F(MaterialFile, ReadsFilesOfEarlierVersions) {
  write_text(file_, old_file);
  const Material m = read_material_toml(file_);
  EXPECT_EQ(m.constants.kappa, 6864.655);
  EXPECT_EQ(m.rubber.shear_modulus, 1372.931);
  EXPECT_EQ(m.contact_stiffness, 1.0);
  EXPECT_EQ(m.statement, "small strain");
  EXPECT_FALSE(m.validity.thickness || m.kinematics);
  lattice::PressSetup press;
  press.protocol.depth = 4e-3;
  EXPECT_TRUE(warnings(m, press).empty()) << "nothing is known that could warn";
  // Both names of the same thing are one too many.
  write_text(file_, std::string(old_file) + "statement = \"x\"\n");
  EXPECT_NE(refusal().find(":21: about.validity: no such key"), std::string::npos) << refusal();
}

TEST_F(MaterialFile, RefusesWithFileLineAndRule) {
  EXPECT_NE(refusal().find("cannot be read"), std::string::npos) << "absent";
  write_text(file_, "");
  EXPECT_NE(refusal().find("is empty"), std::string::npos);
  expect_refused("[constants]", "[constants", ":10", "");
  expect_refused("N/m\"\nk2", "Pa\"\nk2", ":11: constants.k1", "the unit N/m");
  expect_refused("k1 = \"", "k1 = \"nan ", ":11: constants.k1", "finite number");
  expect_refused("k1 = \"", "k1 = \"-", ":11: constants.k1", "must not be negative");
  expect_refused("k1 = \"", "k9 = \"", ":43: constants.k1", "missing");
  expect_refused("[rubber]", "[rubber.more]\n[rubber]", ":16: rubber.more", "no such key");
  expect_refused("\"hookean\"", "\"published\"", ":4: lattice.model", "central, hookean, network");
  expect_refused("\"hookean\"", "\"central\"", ":14: constants.kappa", "must be 0");
  expect_refused("\"hookean\"", "7", ":4: lattice.model", "must be a string");
  expect_refused("\"small\"", "\"large\"", ":5: lattice.kinematics", "small, finite");
  expect_refused("contact_stiffness = 2", "contact_stiffness = \"2\"", ":8: lattice.contact",
                 "without quotes");
  expect_refused("contact_stiffness = 2", "contact_stiffness = 0", ":8: lattice.contact", "0.001");
  expect_refused("contact_stiffness = 2", "contact_stiffness = inf", ":8: lattice.contact",
                 "finite");
  expect_refused("shear_modulus = \"1414.2", "shear_modulus = \"1200.2",
                 ":18: rubber.shear_modulus", "G must exceed E/3");
  expect_refused("kappa = \"", "kappa = \"-99", ":11: constants.k1", "resist every deformation");
}

TEST_F(MaterialFile, RefusesAValidityThatIsNone) {
  expect_refused("thickness = \"0.005 m\"", "thickness = \"0.0003 m\"",
                 ":30: validity.largest_indentation", "less than validity.thickness");
  expect_refused("thickness = \"0.005 m\"", "thickness = \"-1 m\"", ":31: validity.thickness",
                 "positive");
  expect_refused("rod_ratio = 0.5", "rod_ratio = 1", ":32: validity.rod_ratio", "between 0 and 1");
  expect_refused("largest_spacing = \"0.0011 m\"", "largest_spacing = \"0.0001 m\"",
                 ":34: validity.largest_spacing", "in this order");
  expect_refused("largest_spacing = \"0.0011 m\"\n", "", ":33: validity.smallest_spacing",
                 "give both");
  expect_refused("model_error = 0.", "model_error = -0.", ":37: validity.model_error", "negative");
  expect_refused("[\"stick\"", "[\"slip\"", ":29: validity.contacts",
                 "stick, frictionless, coulomb");
  expect_refused("[\"stick\"", "[1", ":29: validity.contacts", "list of words");
  expect_refused("thickness = ", "thick = ", ":31: validity.thick", "no such key");
}

TEST_F(MaterialFile, TruncatedFilesAreRefusedWhereverTheyEnd) {
  write_material_toml(fitted(ModelKind::hookean), file_);
  const std::string text = read_text(file_);
  // The last quote and newline may go missing together only with the string they close.
  for (std::size_t length = 0; length + 1 < text.size(); length += 7) {
    write_text(file_, text.substr(0, length));
    EXPECT_THROW(read_material_toml(file_), meshes::InvalidInput) << "truncated to " << length;
  }
}

TEST_F(MaterialFile, OnlyWhatCanBeReadIsWritten) {
  EXPECT_THROW(write_material_toml(fitted(ModelKind::hookean), folder_ / "no/such/folder/m.toml"),
               std::runtime_error);
  const auto refused = [&](const std::function<void(Material&)>& spoil) {
    Material m = fitted(ModelKind::hookean);
    spoil(m);
    EXPECT_THROW(write_material_toml(m, file_), meshes::InvalidInput);
    EXPECT_FALSE(std::filesystem::exists(file_));
  };
  refused([](Material& m) { m.model = ModelKind::published; });
  refused([](Material& m) { m.constants.k1 = std::nan(""); });
  refused([](Material& m) { m.validity.model_error = INFINITY; });
  refused([](Material& m) { m.provenance = "data \xff.csv"; });
}

TEST(Material, ConstantsScaleToAnotherSpacingAtTheSameModuli) {
  const Material material = fitted(ModelKind::hookean);
  const double finer = 0.37 * a;
  const auto moduli = homogenised_moduli(at_spacing(material, finer), finer);
  EXPECT_NEAR(moduli.youngs_modulus_100 / material.rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(moduli.bulk_modulus / material.rubber.bulk_modulus(), 1.0, 1e-9);
}

/// A press of which everything is as in the fit.
lattice::PressSetup known_press(const Material& m) {
  lattice::PressSetup press;
  press.rubber = m.rubber;
  press.lattice.model = m.model;
  press.lattice.kinematics = *m.kinematics;
  press.lattice.spacing = m.spacing;
  press.lattice.ligament_stiffness = m.ligament_stiffness;
  press.lattice.contact_stiffness = m.contact_stiffness;
  press.protocol.depth = 0.9 * *m.validity.largest_indentation;
  return press;
}

TEST(Warnings, NoneInsideOneForEachStepOutside) {
  Material m = fitted(ModelKind::hookean);
  m.validity.smallest_poissons_ratio = 0.2;
  using Setup = lattice::PressSetup;
  const Setup inside = known_press(m);
  EXPECT_TRUE(warnings(m, inside).empty()) << warnings(m, inside).front();
  const struct {
    const char* says;
    std::function<void(Setup&)> leave;
    bool concerns_the_press;
  } steps[] = {
      {"of the rubber's thickness", [](Setup& s) { s.protocol.depth = 1e-3; }, true},
      {"the contact is coulomb", [](Setup& s) { s.protocol.contact = ContactMode::coulomb; }, true},
      {"does not scale", [](Setup& s) { s.lattice.spacing = 2e-3; }, false},
      {"does not scale", [](Setup& s) { s.lattice.spacing = 0.99 * a; }, false},
      {"used at finite strain", [](Setup& s) { s.lattice.kinematics = Kinematics::finite; }, false},
      {"r/R", [](Setup& s) { s.geometry.rod_radius = 4e-3; }, false},
      {"have no effect", [](Setup& s) { s.rubber.youngs_modulus *= 1.01; }, false},
      {"Poisson's ratio", [](Setup& s) { s.rubber.youngs_modulus = 2.3 * s.rubber.shear_modulus; },
       false},
      {"density", [](Setup& s) { s.rubber.density *= 2.0; }, false},
      {"retardation time", [](Setup& s) { s.rubber.retardation_time = 0.0; }, false},
      {"factor on the bond", [](Setup& s) { s.lattice.ligament_stiffness = 1.0; }, false},
      {"factor on the contact", [](Setup& s) { s.lattice.contact_stiffness = 1.0; }, false},
  };
  for (const auto& step : steps) {
    Setup outside = inside;
    step.leave(outside);
    std::string all;
    for (const std::string& sentence : warnings(m, outside)) all += sentence + "\n";
    EXPECT_NE(all.find(step.says), std::string::npos) << step.says << ": " << all;
    EXPECT_EQ(lattice_warnings(m, outside).empty(), step.concerns_the_press) << step.says;
  }
}

TEST(Warnings, AFingerTwiceAsLargeIsTheSameFinger) {
  // Equilibria have no length of their own: depth and spacing count as shares of the thickness.
  Material m = fitted(ModelKind::hookean);
  lattice::PressSetup press = known_press(m);
  m.validity.smallest_poissons_ratio = 0.2;
  press.geometry.tip_radius *= 2.0;
  press.geometry.rod_radius *= 2.0;
  press.protocol.depth *= 2.0;
  press.lattice.spacing *= 2.0;
  EXPECT_TRUE(warnings(m, press).empty()) << warnings(m, press).front();
  press.lattice.spacing /= 2.0;
  EXPECT_FALSE(warnings(m, press).empty()) << "twice as many cells as the fit had";
}

TEST(Warnings, TheNetworkIsMadeForFiniteStrain) {
  Material m = fitted(ModelKind::network);
  m.validity.smallest_poissons_ratio = 0.2;
  EXPECT_TRUE(warnings(m, known_press(m)).empty());
  lattice::PressSetup press = known_press(m);
  press.lattice.kinematics = Kinematics::small;
  EXPECT_EQ(warnings(m, press).size(), 1U);
  m.kinematics.reset();
  EXPECT_TRUE(warnings(m, press).empty()) << "unknown";
}

}  // namespace
