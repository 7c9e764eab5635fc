#include "studies/jobs/progress.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

using namespace fingertip::studies;

namespace {

/// What a Progress of this style writes while `use` uses it.
template <typename Use>
std::string written(ProgressStyle style, Use&& use) {
  std::FILE* file = std::tmpfile();
  {
    Progress progress(style, file);
    use(progress);
  }
  std::string text;
  std::rewind(file);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += char(c);
  std::fclose(file);
  return text;
}

}  // namespace

TEST(Progress, TheRestTakesAsLongAsWhatWasDoneTook) {
  EXPECT_NEAR(*remaining_time(30.0, 0.25, 0.75), 90.0, 1e-12);
  EXPECT_NEAR(*remaining_time(30.0, 25.0, 75.0), 90.0, 1e-12) << "whatever the unit of the work";
  EXPECT_EQ(remaining_time(30.0, 1.0, 0.0), 0.0);
  EXPECT_FALSE(remaining_time(0.5, 0.25, 0.75)) << "too soon";
  EXPECT_FALSE(remaining_time(30.0, 0.001, 0.999)) << "too little";
  EXPECT_FALSE(remaining_time(30.0, 0.0, 1.0));
}

TEST(Progress, LinesGetRarer) {
  EXPECT_EQ(next_line(0.0), 10.0);
  EXPECT_EQ(next_line(10.0), 20.0);
  EXPECT_EQ(next_line(80.0), 100.0);
  EXPECT_EQ(next_line(36000.0), 36600.0);
}

TEST(Progress, DurationsAreRough) {
  EXPECT_EQ(rough_duration(7.2), "8 s");
  EXPECT_EQ(rough_duration(89.5), "90 s");
  EXPECT_EQ(rough_duration(100.0), "2 min");
  EXPECT_EQ(rough_duration(7500.0), "2 h");
  EXPECT_EQ(rough_duration(8400.0), "2 h 20 min");
  EXPECT_EQ(rough_duration(50000.0), "13 h");
}

TEST(Progress, TheBarTellsTheTimeLeftAndNotTheTimeGone) {
  const std::string text = written(ProgressStyle::tty, [](Progress& progress) {
    progress.expect("kept", 1000.0);
    progress.expect("press", 10.0);
    progress.reused("kept");
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.report("press", 0.5, "pressing");
  });
  EXPECT_NE(text.find("time left not yet known"), std::string::npos) << text;
  // What was reused took no time: half of the press is left, not a two hundredth of all.
  EXPECT_NE(text.find("about 2 s left  press: pressing"), std::string::npos) << text;
}

TEST(Progress, NeverGoesBackwards) {
  const std::string text = written(ProgressStyle::tty, [](Progress& progress) {
    progress.expect("data", 10.0);
    progress.expect_later(10.0);
    progress.report("data", 1.0, "computed");
    progress.expect_later(0.0);
    progress.expect("fit", 30.0);  // weighs more than was thought
    progress.report("fit", 1.0 / 3.0, "first search");
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    progress.report("fit", 0.1, "second search");
  });
  EXPECT_NE(text.find(" 50 %"), std::string::npos) << text;
  EXPECT_EQ(text.find(" 25 %"), std::string::npos) << text;
  EXPECT_EQ(text.find("100 %"), std::string::npos) << text;
}

TEST(Progress, JsonHasElapsedAndRemaining) {
  const std::string text = written(ProgressStyle::json, [](Progress& progress) {
    progress.expect("press");
    progress.report("press", 1.0, "finished");
  });
  const auto line = nlohmann::json::parse(text);
  EXPECT_EQ(line.at("fraction"), 1.0);
  EXPECT_EQ(line.at("remaining"), 0.0);
  EXPECT_GE(line.at("elapsed"), 0.0);
}

TEST(Progress, LinesSayNothingOnShortRuns) {
  EXPECT_EQ(written(ProgressStyle::lines,
                    [](Progress& progress) {
                      progress.report("press", 0.5, "pressing");
                      progress.report("press", 1.0, "finished");
                    }),
            "");
}
