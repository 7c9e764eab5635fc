#include "studies/bench/history.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/temporary_folder.h"

using namespace fingertip;
using nlohmann::ordered_json;

namespace {

ordered_json run(int number) {
  return {{"schema", 1},
          {"number", number},
          {"kernels", {{{"name", "network_step"}, {"rounds", {1.0, 2.0}}}}},
          {"peers", ordered_json::array()},
          {"ratio_rounds", {{"threads_20", {1.0}}}}};
}

}  // namespace

TEST(History, GrowsByALinePerRun) {
  const TemporaryFolder folder;
  const auto file = studies::history_file(folder / "new/folder");
  for (int i = 1; i <= 3; ++i) studies::append_history(run(i), file);
  std::istringstream lines(read_text(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto entry = ordered_json::parse(line);
    EXPECT_EQ(entry["number"], ++number);
    EXPECT_FALSE(entry.contains("ratio_rounds"));
    EXPECT_FALSE(entry["kernels"][0].contains("rounds"));
  }
  EXPECT_EQ(number, 3);
}
