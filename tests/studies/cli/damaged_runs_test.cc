// Run folders with damage, and the verbs that read them: never another exit code than the
// documented ones, and words that name the file.

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/studies/cli/damage.h"
#include "tests/studies/workplace.h"

namespace {

namespace fs = std::filesystem;

const Words coarse = {"lattice.spacing=tip_radius/4", "press.depth=0.1 cm"};
const Words at_rest =
    coarse + Words{"press.mode=static", "press.samples=[\"0.05 cm\", \"0.1 cm\"]"};
const Words moving = coarse + Words{"press.speed=10 cm/s", "press.clearance=0.01 cm"};

/// A verb with its settings, and the folder that it makes.
struct TinyRun {
  std::string name, verb;
  Words settings;
};

/// Each well below a second.
const std::vector<TinyRun> runs = {
    {"rest", "press", at_rest},
    {"moving", "press", moving},
    {"modes", "modes", {"lattice.spacing=tip_radius/4", "lattice.modes=3"}},
    {"moduli", "calibrate", {}},
    {"points", "sweep", at_rest + Words{"lattice.model=[\"hookean\", \"network\"]"}}};

/// Makes the runs once, and copies of them to be damaged.
class DamagedRuns : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Workplace;
    for (const TinyRun& run : runs) folder_->run(run.verb + " --out " + run.name, run.settings);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  /// Damages a copy of one of the runs and reads it with every verb that takes it.
  void attack(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count && !HasFatalFailure(); ++i) {
      const TinyRun& run = runs[i % runs.size()];
      const fs::path copy = folder_->path() / "broken";
      fs::remove_all(copy);
      fs::copy(folder_->path() / run.name, copy, fs::copy_options::recursive);
      const std::string how = run.name + "/" + damage_something(copy, random);
      if (run.name == "points") {
        expect_sense("sweep --collect --out broken", {}, how);
      } else {
        expect_sense("report broken", {}, how);
        if (run.verb == "press") expect_sense("compare broken rest --out out --force", {}, how);
      }
      expect_sense(run.verb + " --out broken --resume auto", run.settings, how);
    }
    for (const auto& [code, times] : codes_) RecordProperty("code " + std::to_string(code), times);
  }

 private:
  void expect_sense(const std::string& command, const Words& settings, const std::string& how) {
    const ProgramResult result = folder_->run(command, settings, any_code);
    ++codes_[result.code];
    const std::string told = command + " after " + how;
    EXPECT_TRUE(result.code == 0 || result.code == 2 || result.code == 3 || result.code == 4 ||
                result.code == 130)
        << "exit code " << result.code << ", " << told << ": " << result.err;
    EXPECT_TRUE(result.code == 0 || says(result.err, "broken")) << told << ": " << result.err;
    EXPECT_TRUE(omits(result.err, {"json.exception", "basic_", "std::", "gnuplot could",
                                   "filesystem", "vector::", "stoi", "stod"}))
        << told;
  }

  static Workplace* folder_;
  std::map<int, int> codes_;
};

Workplace* DamagedRuns::folder_ = nullptr;

TEST_F(DamagedRuns, AreRefusedOrReadInPartWithTheFileNamed) {
  attack(DAMAGED_RUNS, 18);
}

}  // namespace
