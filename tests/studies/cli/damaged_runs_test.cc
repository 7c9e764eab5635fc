// Run folders with damage, and the verbs that read them: never another exit code than the
// documented ones, and words that name the file.

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/studies/cli/damage.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const Words coarse = {"--set", "lattice.spacing=tip_radius/4", "--set", "press.depth=0.1 cm"};
const Words at_rest = with(
    coarse, {"--set", "press.mode=static", "--set", "press.samples=[\"0.05 cm\", \"0.1 cm\"]"});
const Words moving =
    with(coarse, {"--set", "press.speed=10 cm/s", "--set", "press.clearance=0.01 cm"});

/// A verb and the folder that it makes.
struct TinyRun {
  std::string name;
  Words words;
};

/// Each well below a second.
const std::vector<TinyRun>& runs() {
  static const std::vector<TinyRun> all = {
      {"rest", with({"press"}, at_rest)},
      {"moving", with({"press"}, moving)},
      {"modes", {"modes", "--set", "lattice.spacing=tip_radius/4", "--set", "lattice.modes=3"}},
      {"moduli", {"calibrate"}},
      {"points", with({"sweep", "--set", "lattice.model=[\"hookean\", \"network\"]"}, at_rest)}};
  return all;
}

/// Makes the runs once, and copies of them to be damaged.
class DamagedRuns : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    for (const TinyRun& run : runs()) {
      const ProgramResult made = run_program(folder_->path(), with(run.words, {"--out", run.name}));
      ASSERT_EQ(made.code, 0) << run.name << ": " << made.err;
    }
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  /// Damages a copy of one of the runs and reads it with every verb that takes it.
  void attack(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count && !HasFatalFailure(); ++i) {
      const TinyRun& run = runs()[i % runs().size()];
      const fs::path copy = folder_->path() / "broken";
      fs::remove_all(copy);
      fs::copy(folder_->path() / run.name, copy, fs::copy_options::recursive);
      const std::string how = run.name + "/" + damage_something(copy, random);
      if (run.name == "points") {
        expect_sense({"sweep", "--collect", "--out", "broken"}, how);
      } else {
        expect_sense({"report", "broken"}, how);
        if (run.name != "modes" && run.name != "moduli")
          expect_sense({"compare", "broken", "rest", "--out", "out", "--force"}, how);
      }
      expect_sense(with(run.words, {"--out", "broken", "--resume", "auto"}), how);
    }
    for (const auto& [code, times] : codes_) RecordProperty("code " + std::to_string(code), times);
  }

 private:
  void expect_sense(const Words& words, const std::string& how) {
    const ProgramResult result = run_program(folder_->path(), words);
    ++codes_[result.code];
    const std::string told = words.front() + " after " + how + ": " + result.err;
    EXPECT_TRUE(result.code == 0 || result.code == 2 || result.code == 3 || result.code == 4 ||
                result.code == 130)
        << "exit code " << result.code << ", " << told;
    if (result.code != 0) {
      EXPECT_NE(result.err.find("broken"), std::string::npos) << told;
    }
    for (const char* word : {"json.exception", "basic_", "std::", "gnuplot could", "filesystem",
                             "vector::", "stoi", "stod"})
      EXPECT_EQ(result.err.find(word), std::string::npos) << told;
  }

  static TemporaryFolder* folder_;
  std::map<int, int> codes_;
};

TemporaryFolder* DamagedRuns::folder_ = nullptr;

TEST_F(DamagedRuns, AreRefusedOrReadInPartWithTheFileNamed) {
  attack(DAMAGED_RUNS, 18);
}

}  // namespace
