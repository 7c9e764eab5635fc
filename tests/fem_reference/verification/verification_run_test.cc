#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fem_reference/verification/verification.h"
#include "tests/temporary_folder.h"

using namespace fingertip::fem_reference;

namespace {

using Json = nlohmann::json;

/// Stopped after its first part, a run leaves a table with that part.
TEST(VerificationRun, LeavesWhatItHasWhenStopped) {
  const TemporaryFolder folder;
  ReferenceJob job;
  job.analysis = Analysis::verification;
  std::ostringstream progress;
  int asked = 0;
  const RunOutcome outcome =
      run_verification(folder.path(), job, progress, [&] { return asked++ > 0; });
  EXPECT_EQ(outcome.status, RunOutcome::Status::interrupted);
  EXPECT_FALSE(outcome.message.empty());

  const Json table = Json::parse(std::ifstream(folder / "verification.json"));
  EXPECT_TRUE(table.at("studies").empty());
  EXPECT_TRUE(table.at("locking").empty());
  ASSERT_EQ(table.at("checks").size(), 6u * (6u + 12u));
  for (const Json& check : table.at("checks")) {
    EXPECT_TRUE(check.at("passed").get<bool>()) << check.at("name");
    for (const char* key : {"value", "expected", "relative_error", "tolerance"})
      EXPECT_TRUE(check.at(key).is_number()) << key;
    for (const char* key : {"name", "quantity", "source"})
      EXPECT_FALSE(check.at(key).get<std::string>().empty()) << key;
  }
  const Json summary = Json::parse(std::ifstream(folder / "summary.json"));
  EXPECT_EQ(summary.at("status"), "interrupted");
  EXPECT_EQ(summary.at("analysis"), "verification");
  EXPECT_EQ(summary.at("failed_checks"), 0);

  std::istringstream lines(progress.str());
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const Json first = Json::parse(line);
  EXPECT_EQ(first.at("stage"), "verify");
  EXPECT_EQ(first.at("done"), 0);
  EXPECT_GT(first.at("total"), 5);
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
