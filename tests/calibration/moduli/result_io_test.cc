#include "calibration/moduli/result_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace {

using fingertip::calibration::fit_moduli;
using fingertip::calibration::Material;
using fingertip::calibration::material_from;
using fingertip::calibration::ModuliFit;
using fingertip::lattice::ModelKind;
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

  std::filesystem::path folder_;
};

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
  EXPECT_EQ(json.at("statement"), fit_statement(central));
}

TEST_F(ResultFiles, AFitIsAMaterialThatSaysWhereItCameFrom) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central}) {
    const ModuliFit written = fit(model);
    const Material material = material_from(written);
    EXPECT_EQ(material.model, model);
    EXPECT_EQ(material.spacing, a);
    EXPECT_EQ(material.constants.k1, written.constants.k1);
    EXPECT_EQ(material.constants.kappa, written.constants.kappa);
    EXPECT_EQ(material.rubber.retardation_time, written.target.retardation_time);
    EXPECT_EQ(material.ligament_stiffness, 1.0);
    EXPECT_EQ(material.provenance.find("moduli"), 0U);
    EXPECT_NE(material.statement.find(fit_statement(written)), std::string::npos);
    EXPECT_TRUE(material.validity.contacts.empty());
    EXPECT_FALSE(material.validity.largest_indentation);
    EXPECT_NEAR(material.validity.smallest_poissons_ratio.value(), 3.0 / 7.0, 1e-12);
    EXPECT_TRUE(material.violations().empty());
  }
}

TEST_F(ResultFiles, UnwritablePlacesAreReported) {
  const std::filesystem::path file = folder_ / "no" / "such" / "folder" / "calibration.json";
  EXPECT_THROW(fingertip::calibration::write_calibration_json(fit(ModelKind::hookean), file),
               std::runtime_error);
}

}  // namespace
