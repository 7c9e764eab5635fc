// The page of a study that fits some presses and predicts others.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_fit.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using nlohmann::json;

class TransferReport : public testing::Test {
 protected:
  TransferReport() { report_testing::write_transfer_study(run_); }

  std::string report() const {
    studies::report::write_report(run_);
    const std::string html = read_text(run_ / "report.html");
    const auto faults = report_testing::structure_faults(html);
    EXPECT_TRUE(faults.empty()) << faults.front();
    return html;
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(TransferReport, NamesWhatCarriesFarthest) {
  const std::string html = report(), text = report_testing::visible_text(html);
  for (const char* part :
       {"Of 2 fits, “both” carries farthest: it predicts every press asked for within 4.0 %.",
        "The largest error of all, 25.0 %, is that of “alone”.",
        "The criterion of the case is met.", "at 2 mm", "Fit alone", "Fit both"})
    EXPECT_TRUE(says(text, part));
  for (const char* id : {"transfer", "fit_1", "fit_2"})
    EXPECT_TRUE(says(html, "<section id=\"" + std::string(id) + "\">")) << id;
  for (const char* other : {"force", "control", "elasticity"})
    EXPECT_TRUE(omits(html, "<section id=\"" + std::string(other) + "\">")) << other;
  // Grades: 4 % is fair, 25 % off, 1 % close.
  EXPECT_TRUE(says(text, {"4.0 % ◐", "25.0 % ○", "1.0 % ●"}));
  const std::string csv = read_text(run_ / "figures" / "transfer_error.csv");
  EXPECT_TRUE(says(csv, {"tilted,alone,2,25\n", "stick,both,2,-1\n"}));
}

TEST_F(TransferReport, TruthStandsBesideTheEstimates) {
  const std::string text = report_testing::visible_text(report());
  // 4.0 of 4.1 kPa and 1.4 of 1.3 kPa.
  EXPECT_TRUE(says(text, {"missed by 2.4 %", "missed by 7.7 %"}));
  EXPECT_TRUE(says(read_text(run_ / "figures" / "fit_1_profile.svg"), "truth"));
}

TEST_F(TransferReport, PredictionsThatStoppedSayWhyAndDoNotWin) {
  std::string rows = read_text(run_ / "transfer.csv");
  rows += "alone,deep,hookean,0.003,,0.2,0.004,,\"not converged: at 0.1 cm\"\n";
  rows += "both,deep,hookean,0.003,,0.2,0.004,,\"not converged: at 0.1 cm\"\n";
  report_testing::write_file(run_ / "transfer.csv", rows);
  const std::string text = report_testing::visible_text(report());
  EXPECT_TRUE(says(text, {"not converged: at 0.1 cm", "No fit predicted every press asked for."}));
  EXPECT_TRUE(omits(text, "nan "));
}

TEST_F(TransferReport, WithoutTheTableTheSummaryCounts) {
  fs::remove(run_ / "transfer.csv");
  const std::string text = report_testing::visible_text(report());
  EXPECT_TRUE(says(text, {"(transfer.csv)",
                          "carries farthest: it predicts every press asked for within 4.0 %"}));
  EXPECT_FALSE(fs::exists(run_ / "figures" / "transfer_error.svg"));
}

TEST_F(TransferReport, FitsAreFoundWithoutTheSummary) {
  json summary = json::parse(read_text(run_ / "summary.json"));
  summary["calibration"] = {{"fits", nullptr}, {"predictions", nullptr}, {"worst_error", nullptr}};
  report_testing::write_file(run_ / "summary.json", summary.dump());
  fs::remove_all(run_ / "fits" / "alone");
  const std::string text = report_testing::visible_text(report());
  EXPECT_TRUE(says(text, "Fit both"));
  EXPECT_TRUE(says(text, "Fit of alone")) << "named as missing";
  EXPECT_TRUE(says(text, "25.0 %"));
}

TEST_F(TransferReport, TextIsPlain) {
  const std::string text = studies::report::verdict_text(run_);
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int(c);
  EXPECT_TRUE(says(text, {"youngs_modulus", "E [kPa]", "4.000", "25.0 %", "met     carries"}));
}

}  // namespace
