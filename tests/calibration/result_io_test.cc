#include "calibration/result_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "meshes/errors.h"

namespace {

using fingertip::calibration::at_spacing;
using fingertip::calibration::fit_moduli;
using fingertip::calibration::homogenised_moduli;
using fingertip::calibration::Material;
using fingertip::calibration::ModuliFit;
using fingertip::calibration::read_material_toml;
using fingertip::lattice::ModelKind;
using fingertip::meshes::InvalidInput;
using fingertip::meshes::Rubber;

constexpr double a = 1.0e-2 / 12.0;  // [m]

ModuliFit fit(ModelKind model) {
  return fit_moduli(Rubber{}, {.model = model, .spacing = a});
}

std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class ResultFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("fingertip_result_io_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes a good material file with `from` replaced by `to`.
  std::filesystem::path spoiled(const std::string& from, const std::string& to) const {
    const std::filesystem::path file = folder_ / "material.toml";
    fingertip::calibration::write_material_toml(fit(ModelKind::hookean), file);
    std::string text = contents(file);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(file) << text;
    return file;
  }

  std::filesystem::path folder_;
};

void expect_refused(const std::filesystem::path& file, const std::string& place,
                    const std::string& rule) {
  try {
    read_material_toml(file);
    FAIL() << "accepted a file with " << rule;
  } catch (const InvalidInput& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(file.string() + place), std::string::npos) << message;
    EXPECT_NE(message.find(rule), std::string::npos) << message;
  }
}

TEST_F(ResultFiles, CalibrationJsonHoldsTheContractInSi) {
  const ModuliFit central = fit(ModelKind::central);
  const std::filesystem::path file = folder_ / "calibration.json";
  fingertip::calibration::write_calibration_json(central, file);
  const nlohmann::json json = nlohmann::json::parse(contents(file));

  EXPECT_EQ(json.at("model"), "central");
  EXPECT_EQ(json.at("spacing").get<double>(), a);
  EXPECT_EQ(json.at("constants").at("k1").get<double>(), central.constants.k1);
  EXPECT_EQ(json.at("constants").at("k2").get<double>(), central.constants.k2);
  EXPECT_EQ(json.at("constants").at("k3").get<double>(), 0.0);
  EXPECT_EQ(json.at("constants").at("kappa").get<double>(), 0.0);
  EXPECT_TRUE(json.contains("damping"));
  EXPECT_EQ(json.at("target").at("youngs_modulus").get<double>(), 3922.66);
  EXPECT_EQ(json.at("target").at("shear_modulus").get<double>(), 1372.931);
  EXPECT_NEAR(json.at("target").at("poissons_ratio").get<double>(), 3.0 / 7.0, 1e-12);
  EXPECT_NEAR(json.at("target").at("bulk_modulus").get<double>(), 9152.87, 0.01);
  for (const char* key : {"youngs_modulus_100", "youngs_modulus_110", "youngs_modulus_111",
                          "shear_modulus", "poissons_ratio_100", "bulk_modulus", "anisotropy"})
    EXPECT_TRUE(json.at("achieved").at(key).is_number()) << key;
  EXPECT_TRUE(json.at("covariance").is_null());
  ASSERT_EQ(json.at("unidentifiable").size(), 1u);
  EXPECT_EQ(json.at("unidentifiable")[0].at("meaning"), "k1 + 1, k2 - 1, k3 + 0.75");
  EXPECT_LT(std::abs(json.at("residuals").at("E_100").get<double>()), 1e-9);
  EXPECT_EQ(json.at("statement"), central.statement);
}

TEST_F(ResultFiles, MaterialReadsBackToTheSameBits) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central}) {
    const ModuliFit written = fit(model);
    const std::filesystem::path file = folder_ / "material.toml";
    fingertip::calibration::write_material_toml(written, file);
    const Material read = read_material_toml(file);
    EXPECT_EQ(read.model, model);
    EXPECT_EQ(read.spacing, a);
    EXPECT_EQ(read.constants.k1, written.constants.k1);
    EXPECT_EQ(read.constants.k2, written.constants.k2);
    EXPECT_EQ(read.constants.k3, written.constants.k3);
    EXPECT_EQ(read.constants.kappa, written.constants.kappa);
    EXPECT_EQ(read.rubber.youngs_modulus, written.target.youngs_modulus);
    EXPECT_EQ(read.rubber.shear_modulus, written.target.shear_modulus);
    EXPECT_EQ(read.rubber.density, written.target.density);
    EXPECT_EQ(read.rubber.retardation_time, written.target.retardation_time);
    EXPECT_NE(read.provenance.find(written.statement), std::string::npos);
    EXPECT_FALSE(read.validity.empty());
  }
}

TEST_F(ResultFiles, ConstantsScaleToAnotherSpacingAtTheSameModuli) {
  const Material material = fingertip::calibration::material_from(fit(ModelKind::hookean));
  const double finer = 0.37 * a;
  const auto moduli = homogenised_moduli(at_spacing(material, finer), finer);
  EXPECT_NEAR(moduli.youngs_modulus_100 / material.rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(moduli.bulk_modulus / material.rubber.bulk_modulus(), 1.0, 1e-9);
}

TEST_F(ResultFiles, BadMaterialFilesAreRefusedWithFileLineAndRule) {
  expect_refused(folder_ / "absent.toml", ": ", "cannot be read");
  expect_refused(folder_, ": ", "cannot be read");
  std::ofstream(folder_ / "empty.toml").close();
  expect_refused(folder_ / "empty.toml", ": ", "is empty");
  expect_refused(spoiled("[constants]", "[constants"), ":7", "");
  expect_refused(spoiled("N/m\"\nk2", "Pa\"\nk2"), ":8: constants.k1", "the unit N/m");
  expect_refused(spoiled("k1 = \"", "k1 = \"nan "), ":8: constants.k1", "finite number");
  expect_refused(spoiled("k1 = \"", "k1 = \"-"), ":8: constants.k1", "must not be negative");
  expect_refused(spoiled("k1 = \"", "k9 = \""), ":21: constants.k1", "missing");
  expect_refused(spoiled("[about]", "[rubber.more]\n[about]"), ":19: rubber.more", "no such key");
  expect_refused(spoiled("\"hookean\"", "\"published\""), ":4: lattice.model",
                 "central and hookean");
  expect_refused(spoiled("\"hookean\"", "\"central\""), ":11: constants.kappa", "must be 0");
  expect_refused(spoiled("\"hookean\"", "7"), ":4: lattice.model", "must be a string");
  expect_refused(spoiled("shear_modulus = \"1372.931", "shear_modulus = \"1307.5"),
                 ":15: rubber.shear_modulus", "G must exceed E/3");
  expect_refused(spoiled("kappa = \"", "kappa = \"-"), ":8: constants.k1",
                 "resist every deformation");
}

TEST_F(ResultFiles, TruncatedMaterialFilesAreRefusedWhereverTheyEnd) {
  const std::filesystem::path file = folder_ / "material.toml";
  fingertip::calibration::write_material_toml(fit(ModelKind::hookean), file);
  const std::string text = contents(file);
  // The last quote and newline may go missing together only with the string they close.
  for (std::size_t length = 0; length + 1 < text.size(); length += 7) {
    std::ofstream(file) << text.substr(0, length);
    EXPECT_THROW(read_material_toml(file), InvalidInput) << "truncated to " << length;
  }
}

TEST_F(ResultFiles, UnwritablePlacesAreReported) {
  const std::filesystem::path file = folder_ / "no" / "such" / "folder" / "material.toml";
  EXPECT_THROW(fingertip::calibration::write_material_toml(fit(ModelKind::hookean), file),
               std::runtime_error);
  EXPECT_THROW(fingertip::calibration::write_calibration_json(fit(ModelKind::hookean), file),
               std::runtime_error);
}

}  // namespace
