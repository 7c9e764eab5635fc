#include "studies/bench/history.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

using namespace fingertip;
using nlohmann::ordered_json;

namespace {

ordered_json run(int number) {
  return {{"schema", 1},
          {"number", number},
          {"kernels", {{{"name", "springs"}, {"rounds", {1.0, 2.0}}}}},
          {"peers", ordered_json::array()},
          {"ratio_rounds", {{"threads_20", {1.0}}}}};
}

}  // namespace

TEST(History, GrowsByALinePerRun) {
  const TemporaryFolder folder;
  const auto file = studies::history_file(folder / "new/folder");
  EXPECT_TRUE(studies::read_history(file).empty());
  for (int i = 1; i <= 3; ++i) studies::append_history(run(i), file);
  const ordered_json runs = studies::read_history(file);
  ASSERT_EQ(runs.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(runs[std::size_t(i)]["number"], i + 1);
  EXPECT_FALSE(runs[0].contains("ratio_rounds"));
  EXPECT_FALSE(runs[0]["kernels"][0].contains("rounds"));
  const std::string text = read_text(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST(History, SurvivesALineThatWasCutOff) {
  const TemporaryFolder folder;
  const auto file = studies::history_file(folder.path());
  studies::append_history(run(1), file);
  std::ofstream(file, std::ios::app) << "{\"schema\": 1, \"num\n";
  studies::append_history(run(2), file);
  EXPECT_EQ(studies::read_history(file).size(), 2u);
}
