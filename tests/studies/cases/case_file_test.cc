#include "studies/cases/case_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshes/tables/table_rows.h"
#include "studies/cases/measures.h"
#include "studies/cases/outputs.h"
#include "studies/config/documents.h"
#include "studies/files/run_tables.h"
#include "tests/studies/cases/case_tables.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace meshes = fingertip::meshes;
namespace fs = std::filesystem;

TEST(Cases, EveryCaseOfTheProjectLoads) {
  const auto files = all_cases();
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    const Case study_case = load_case(file, {});
    EXPECT_FALSE(study_case.title.empty()) << file;
    EXPECT_FALSE(study_case.criteria.empty()) << file;
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
    EXPECT_EQ(error.violations().size(), 4U) << error.what();
    EXPECT_NE(std::string(error.what()).find("hookean.speed_deviation"), std::string::npos);
  }
}

TEST(Cases, WithoutRunsTakeThoseOfTheCoreCase) {
  const TemporaryFolder folder;
  write_text(folder / "mine.toml",
             "[press]\ndepth = \"0.2 cm\"\n[lattice]\nspacing = \"tip_radius/12\"\n");
  const Case core = load_case(find_case("01"), {}), mine = load_case(folder / "mine.toml", {});
  ASSERT_FALSE(core.runs.empty());
  EXPECT_EQ(planned_jobs(mine).size(), planned_jobs(core).size());
  EXPECT_EQ(mine.tables.size(), core.tables.size());
  EXPECT_TRUE(mine.criteria.empty());
}

TEST(Cases, RefusesRunsAndTablesThatMeanNothing) {
  const TemporaryFolder folder;
  const std::string press = "[[case.run]]\nverb = \"press\"\nname = \"a\"\n";
  EXPECT_EQ(refusal(folder, press), "");
  EXPECT_TRUE(says(refusal(folder, "[[case.run]]\nname = \"a\"\n"), "must say what is run"));
  EXPECT_TRUE(says(refusal(folder, press + "when = \"finer\"\n"), "must be coarser or another"));
  EXPECT_TRUE(says(refusal(folder, press + "beside = \"b\"\n"), "must be a press above"));
  EXPECT_TRUE(says(refusal(folder, press + "snapshots = true\n"), "no such entry of a run"));
  EXPECT_TRUE(says(refusal(folder, press + "times = { \"press.depth\" = 2.0 }\n"), "a factor"));
  const std::string table = "[[case.table]]\nfile = \"t.csv\"\nseries = \"\"\n";
  EXPECT_EQ(refusal(folder, press + table + "columns = [\"name\"]\n"), "");
  EXPECT_TRUE(says(refusal(folder, press + table + "columns = [\"nam\"]\n"), "one is name"));
  EXPECT_TRUE(says(refusal(folder, table + "columns = [\"name\"]\n"), "needs exactly file"));
  EXPECT_TRUE(says(refusal(folder, press + "[[case.table]]\nfile = \"../t.csv\"\nseries = \"\"\n"
                                           "columns = []\n"),
                   "needs exactly file"));
}

TEST(Cases, TablesHaveTheColumnsThatTheReportReads) {
  const std::vector<std::string> known = table_columns();
  for (const auto& columns :
       {meshes::column_names<VariantRow>(), meshes::column_names<TransferRow>()})
    for (const std::string& column : columns)
      EXPECT_NE(std::ranges::find(known, column), known.end()) << column;
  const Case core = load_case(find_case("01"), {});
  const auto columns_of = [&](const char* file) {
    return std::ranges::find(core.tables, file, &CaseTable::file)->columns;
  };
  EXPECT_EQ(columns_of("published_study.csv"), meshes::column_names<PublishedStudyRow>());
  EXPECT_EQ(columns_of("equilibrium_study.csv"), meshes::column_names<EquilibriumStudyRow>());
}

TEST(Cases, FoldersStayBelowThatOfTheRun) {
  EXPECT_EQ(as_folder("R/6, 0.5"), "R_6__0.5");
  for (const char* name : {"..", ".", "/", "../.."}) {
    EXPECT_EQ(fs::path(as_folder(name)).filename(), as_folder(name));
    EXPECT_FALSE(as_folder(name).starts_with("."));
  }
  const TemporaryFolder folder;
  const Case study_case =
      case_with(folder, "[[case.run]]\nverb = \"cubes\"\nname = \"variants\"\n");
  EXPECT_EQ(planned_jobs(study_case).front().name, "variants_") << "that of other runs";
}

TEST(Measures, AreTakenFromTheSummaries) {
  Case study_case;
  meshes::Rubber& rubber = study_case.loaded.config.press.rubber;
  rubber.youngs_modulus = 2.8;
  rubber.shear_modulus = 1.0;
  for (const char* name : {"cubes", "hookean"})
    study_case.runs.push_back(
        {.kind = "run", .verb = *name == 'c' ? "cubes" : "press", .name = name});
  study_case.runs.back().continuum = true;
  RunResult press;
  press.run = &study_case.runs.back();
  press.press.moduli = {.E_100 = 2.8,
                        .E_110 = 2.8,
                        .E_111 = 2.828,
                        .G = 1.1,
                        .nu_100 = 0.15,
                        .K = rubber.bulk_modulus()};
  press.press.momentum_defect = 1e-12;
  press.forces.depth = {1e-3, 2e-3};
  press.forces.error = {0.01, -0.2};
  press.forces.reference_error = {0.001, std::nan("")};
  press.measures = measures_of_run(study_case, press, {});
  const auto taken = take_measures(
      study_case, {finished_run(study_case.runs[0], {{"hookean_error", 1e-10}}), press});
  EXPECT_NEAR(taken.at("hookean.youngs_modulus_error"), 0.01, 1e-12);
  EXPECT_NEAR(taken.at("hookean.shear_modulus_error"), 0.1, 1e-12);
  EXPECT_NEAR(taken.at("hookean.poissons_ratio_error"), 0.25, 1e-12);
  EXPECT_EQ(taken.at("hookean.bulk_modulus_error"), 0.0);
  EXPECT_EQ(taken.at("hookean.max_force_error"), 0.2);
  EXPECT_EQ(taken.at("hookean.momentum_defect"), 1e-12);
  EXPECT_EQ(taken.at("cubes.hookean_error"), 1e-10);
  EXPECT_EQ(taken.count("reference.force_error"), 0U) << "unknown at one depth";
  EXPECT_EQ(taken.count("hookean.speed_deviation"), 0U) << "no controller, no tracking";
}
