#include "studies/cases/case_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "studies/cases/measures.h"
#include "studies/config/documents.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

TEST(Cases, EveryCaseOfTheProjectLoads) {
  const auto files = all_cases();
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    const Case one = load_case(file, {});
    EXPECT_FALSE(one.title.empty()) << file;
    EXPECT_FALSE(one.criteria.empty()) << file;
  }
}

TEST(Cases, PublishedAndCentralAreExhibitsNeverCriteria) {
  std::size_t criteria = 0;
  for (const fs::path& file : all_cases()) {
    for (const CaseCriterion& criterion : load_case(file, {}).criteria) {
      EXPECT_FALSE(criterion.measure.starts_with("published.")) << file;
      EXPECT_FALSE(criterion.measure.starts_with("central.")) << file;
      ++criteria;
    }
  }
  EXPECT_GE(criteria, all_cases().size());
}

TEST(Cases, FoundByNameStartFolderOrFile) {
  const fs::path file = cases_folder() / "01_paper_rubber" / "case.toml";
  EXPECT_EQ(find_case("01_paper_rubber"), file);
  EXPECT_EQ(find_case("01"), file);
  EXPECT_EQ(find_case(file.parent_path().string()), file);
  EXPECT_EQ(find_case(file.string()), file);
  EXPECT_THROW(find_case("99_nothing"), ConfigError);
}

TEST(Cases, ParametersOfARunAreACaseAgain) {
  const TemporaryFolder folder;
  const Case first = load_case(find_case("01"), {{}, {"press.depth=0.2 cm"}, {}});
  write_text(folder / "parameters.toml", parameters_toml(first.loaded, "test") + first.text);
  const Case again = load_case(folder / "parameters.toml", {});
  EXPECT_EQ(again.title, first.title);
  EXPECT_EQ(again.loaded.config.press.protocol.depth, 0.002);
  ASSERT_EQ(again.criteria.size(), first.criteria.size());
  for (std::size_t i = 0; i < first.criteria.size(); ++i) {
    EXPECT_EQ(again.criteria[i].measure, first.criteria[i].measure);
    EXPECT_EQ(again.criteria[i].limit, first.criteria[i].limit);
  }
}

TEST(Cases, RefusesCriteriaThatCannotBeJudged) {
  const TemporaryFolder folder;
  write_text(folder / "case.toml",
             "[case]\ntitle = 1\nextra = 2\n[[case.criteria]]\nname = \"a\"\nmeasure = "
             "\"hookean.sped_deviation\"\nlimit = 1\n[[case.criteria]]\nname = \"b\"\nmeasure = "
             "\"hookean.tilt_deg\"\nlimit = nan\n");
  try {
    load_case(folder / "case.toml", {});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.problems().size(), 4U) << error.what();
    EXPECT_NE(std::string(error.what()).find("hookean.speed_deviation"), std::string::npos);
  }
}

TEST(Measures, AreTakenFromTheSummaries) {
  using nlohmann::ordered_json;
  const ordered_json perfect = {{"E_100", 3.0},
                                {"E_110", 3.0},
                                {"E_111", 3.03},
                                {"G", 1.1},
                                {"nu_100", 0.25},
                                {"K", 2.0},
                                {"force_error", {0.01, -0.2}},
                                {"relative_l2_force_error", 0.1}};
  ordered_json summary = {{"target",
                           {{"youngs_modulus", 3.0},
                            {"shear_modulus", 1.0},
                            {"poissons_ratio", 0.5},
                            {"bulk_modulus", 2.0}}},
                          {"reference", {{"relative_force_error", {0.001, nullptr}}}}};
  std::map<std::string, ordered_json> press;
  for (const std::string& model : validated_models()) {
    summary["models"][model] = perfect;
    press[model] = {{"momentum_defect", 1e-12}};
  }
  const auto taken = take_measures(summary, press, 1e-10);
  EXPECT_NEAR(taken.at("hookean.youngs_modulus_error"), 0.01, 1e-12);
  EXPECT_NEAR(taken.at("hookean.shear_modulus_error"), 0.1, 1e-12);
  EXPECT_NEAR(taken.at("hookean.poissons_ratio_error"), 0.25, 1e-12);
  EXPECT_EQ(taken.at("hookean.bulk_modulus_error"), 0.0);
  EXPECT_EQ(taken.at("hookean.max_force_error"), 0.2);
  EXPECT_EQ(taken.at("cubes.hookean_error"), 1e-10);
  EXPECT_EQ(taken.count("reference.force_error"), 0U) << "unknown at one depth";
  EXPECT_EQ(taken.count("hookean.speed_deviation"), 0U) << "no controller, no tracking";
}
