// The verb sweep: shards of one sweep in several processes.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>
#include <sstream>
#include <thread>

#include "meshes/tables/csv_table.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* examples = FINGERTIP_SOURCES "/studies/sweep/examples";

/// Six static presses, each well below a second.
std::vector<std::string> sweep(const std::vector<std::string>& more) {
  std::vector<std::string> words{"sweep"};
  for (const char* set : {"press.mode=static", "press.contact=frictionless",
                          "press.samples=[\"0.05 cm\"]", "lattice.model=[\"hookean\", \"network\"]",
                          "lattice.spacing=[\"tip_radius/4\", \"0.22 cm\", \"tip_radius/5\"]"}) {
    words.insert(words.end(), {"--set", set});
  }
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// First words of the lines of `text`.
std::vector<std::string> first_words(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    words.push_back(line.substr(0, line.find('\t')));
  return words;
}

std::vector<std::string> listed(const TemporaryFolder& folder,
                                const std::vector<std::string>& more) {
  std::vector<std::string> words = sweep({"--list"});
  words.insert(words.end(), more.begin(), more.end());
  const ProgramResult result = run_program(folder.path(), words);
  EXPECT_EQ(result.code, 0) << result.err;
  return first_words(result.out);
}

/// The table's lines without what wall time makes differ.
std::vector<std::string> stable_columns(const fs::path& table) {
  std::istringstream lines(read_text(table));
  std::vector<std::string> kept;
  for (std::string line; std::getline(lines, line);) {
    // point, status and the two axes
    std::size_t end = 0;
    for (int column = 0; column < 4; ++column) end = line.find(',', end + 1);
    kept.push_back(line.substr(0, end));
  }
  return kept;
}

int bash(const fs::path& folder, const std::string& command) {
  return std::system(("cd '" + folder.string() +
                      "' && export XDG_CACHE_HOME=$PWD/cache FINGERTIP=" + FINGERTIP_PROGRAM +
                      " SWEEP=" + examples + "/sweep.toml; { " + command + "; } > words 2>&1")
                         .c_str());
}

/// Twelve finished points and a header.
void expect_example_done(const fs::path& results) {
  const auto lines = stable_columns(results / "table.csv");
  ASSERT_EQ(lines.size(), 13U);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_NE(lines[i].find(",finished,"), std::string::npos) << lines[i];
  }
}

}  // namespace

TEST(SweepVerb, ShardsAreDisjointAndMakeUpTheWholeInAnyOrderOfWriting) {
  const TemporaryFolder folder;
  const auto whole = listed(folder, {});
  ASSERT_EQ(whole.size(), 6U);
  EXPECT_TRUE(std::ranges::is_sorted(whole));
  for (const int n : {1, 2, 4, 6, 9}) {
    std::vector<std::string> joined;
    for (int i = 1; i <= n; ++i) {
      const auto part = listed(folder, {"--shard", std::to_string(i) + "/" + std::to_string(n)});
      EXPECT_LE(part.size(), std::size_t((6 + n - 1) / n));
      joined.insert(joined.end(), part.begin(), part.end());
    }
    std::ranges::sort(joined);
    EXPECT_EQ(joined, whole) << n;
  }
  // The same axes with keys and values the other way round, and another number of threads.
  const ProgramResult turned = run_program(
      folder.path(),
      {"sweep", "--list", "--threads", "3", "--set",
       "lattice.spacing=[\"tip_radius/5\",\"tip_radius/4\",\"0.22 cm\",\"tip_radius/5\"]", "--set",
       "lattice.model=[\"network\",\"hookean\"]", "--set", "press.samples=[\"0.05 cm\"]", "--set",
       "press.contact=frictionless", "--set", "press.mode=static"});
  EXPECT_EQ(first_words(turned.out), whole) << turned.err;
}

/// A press that moves laterally has a column more than one that does not.
TEST(SweepVerb, CurvesOfDifferentColumnsStandInOneTable) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(),
                  {"sweep", "--out", "lateral", "--set", "press.mode=static", "--set",
                   "lattice.spacing=tip_radius/4", "--set", "press.samples=[\"0.5 mm\", \"1 mm\"]",
                   "--set", "press.depth=1 mm", "--set", "press.lateral_path=after", "--set",
                   "press.lateral_samples=2", "--set", "press.lateral=[\"0 mm\", \"0.2 mm\"]"});
  EXPECT_EQ(result.code, 0) << result.err << result.out;
  EXPECT_NE(result.out.find("2 finished"), std::string::npos) << result.out;
  const auto curves = fingertip::meshes::read_csv(folder / "lateral/curves.csv");
  const auto sideways = curves.texts("lateral_displacement [m]");
  ASSERT_EQ(sideways.size(), 2U + 4U);
  EXPECT_EQ(std::ranges::count(sideways, ""), 2);
  EXPECT_EQ(std::ranges::count(sideways, "2e-04"), 1);
  const auto table = fingertip::meshes::read_csv(folder / "lateral/table.csv");
  for (const double force : table.numbers("normal_force [N]")) EXPECT_GT(force, 0.0);
}

TEST(SweepVerb, TwoShardsAtATimeGiveTheTableOfTheWhole) {
  const TemporaryFolder folder, other;
  ASSERT_EQ(run_program(other.path(), sweep({"--out", "whole", "--threads", "1"})).code, 0);
  fs::create_directory(folder / "a");
  fs::create_directory(folder / "b");
  Program first(folder / "a", sweep({"--out", "../results", "--shard", "1/2", "--threads", "1"}));
  Program second(folder / "b", sweep({"--out", "../results", "--shard", "2/2", "--threads", "1"}));
  const ProgramResult of_first = first.wait(), of_second = second.wait();
  EXPECT_EQ(of_first.code, 0) << of_first.err;
  EXPECT_EQ(of_second.code, 0) << of_second.err;
  const ProgramResult table =
      run_program(folder.path(), {"sweep", "--collect", "--out", "results"});
  EXPECT_EQ(table.code, 0) << table.err << table.out;
  EXPECT_EQ(stable_columns(folder / "results/table.csv"),
            stable_columns(other / "whole/table.csv"));
  EXPECT_EQ(read_text(folder / "results/curves.csv"), read_text(other / "whole/curves.csv"));
  const std::string text = read_text(folder / "results/table.csv");
  EXPECT_NE(text.find("census.particles"), std::string::npos);
  // The answer stands behind the axes.
  EXPECT_NE(text.find("lattice.spacing,indentation [m],normal_force [N],contact_radius [m],"),
            std::string::npos)
      << text.substr(0, text.find('\n'));
}

TEST(SweepVerb, AKilledShardGoesOnWhereItWas) {
  const TemporaryFolder folder;
  const auto words = sweep({"--out", "results", "--shard", "1/1", "--threads", "1"});
  Program killed(folder.path(), words);
  for (int wait = 0; wait < 500 && read_text(folder / "stdout").find("[1/6]") == std::string::npos;
       ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  killed.send(SIGKILL);
  killed.wait();
  const ProgramResult part = run_program(folder.path(), {"sweep", "--collect", "--out", "results"});
  const bool in_time = part.code == 3;  // else it was quicker than the signal
  const ProgramResult rest = run_program(folder.path(), words);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_NE(rest.out.find("(earlier)"), std::string::npos) << rest.out;
  EXPECT_TRUE(!in_time || rest.out.find("finished\n") != std::string::npos) << rest.out;
  EXPECT_EQ(run_program(folder.path(), {"sweep", "--collect", "--out", "results"}).code, 0);
}

TEST(SweepVerb, BadInputIsToldBeforeAnythingIsMade) {
  const auto refused = [](std::vector<std::string> words, const std::string& told) {
    const TemporaryFolder folder;
    words.insert(words.begin(), "sweep");
    const ProgramResult result = run_program(folder.path(), words);
    EXPECT_EQ(result.code, 2) << result.out;
    EXPECT_NE(result.err.find(told), std::string::npos) << result.err;
    EXPECT_TRUE(made_in(folder.path()).empty());
  };
  refused({"--out", "r"}, "no key has a list of values");
  refused({"--out", "r", "--shard", "0/4", "--set", "press.speed=[\"1 cm/s\"]"}, "1 <= i <= N");
  refused({"--out", "r", "--shard", "5/4", "--set", "press.speed=[\"1 cm/s\"]"}, "1 <= i <= N");
  refused({"--out", "r", "--set", "press.speed=[\"1 cm\"]"}, "press.speed");
  refused({"--out", "r", "--set", "press.speed=[]"}, "list");
  refused({"--out", "r", "--set", "lattice.spacing=[\"tip_radius/8\", \"0.9 cm\"]"},
          "two cells through the rubber");
  refused({"validate", "--out", "r", "--set", "press.speed=[\"1 cm/s\"]"}, "press, modes");
  refused({"--set", "press.speed=[\"1 cm/s\"]"}, "--out DIR");
  refused({"--collect", "--out", "r"}, "not the folder of a sweep");
}

TEST(SweepVerb, AFolderBelongsToOneSweep) {
  const TemporaryFolder folder;
  const auto quick = [&](const char* spacings, std::vector<std::string> more) {
    std::vector<std::string> words{
        "sweep", "--out", "r", "--set", "press.mode=static", "--set", "press.samples=[\"0.05 cm\"]",
        "--set", spacings};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder.path(), words);
  };
  ASSERT_EQ(quick("lattice.spacing=[\"tip_radius/4\"]", {}).code, 0);
  EXPECT_EQ(quick("lattice.spacing=[\"tip_radius/4\"]", {}).code, 2);
  EXPECT_EQ(quick("lattice.spacing=[\"tip_radius/4\"]", {"--resume", "auto"}).code, 0);
  const ProgramResult other = quick("lattice.spacing=[\"0.22 cm\"]", {"--shard", "1/1"});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("another sweep"), std::string::npos) << other.err;
}

TEST(SweepExamples, ASlurmArrayComputesTheExample) {
  const TemporaryFolder folder;
  const std::string script = std::string("bash ") + examples + "/slurm_array.sh";
  ASSERT_EQ(bash(folder.path(),
                 "for i in 1 2 3 4; do SLURM_ARRAY_TASK_ID=$i "
                 "SLURM_ARRAY_TASK_COUNT=4 SLURM_CPUS_PER_TASK=1 " +
                     script + " || exit; done; $FINGERTIP sweep --collect --out results"),
            0)
      << read_text(folder / "words");
  expect_example_done(folder / "results");
}

TEST(SweepExamples, GnuParallelComputesTheExample) {
  const TemporaryFolder folder;
  ASSERT_EQ(bash(folder.path(), std::string("SHARDS=3 bash ") + examples + "/gnu_parallel.sh"), 0)
      << read_text(folder / "words");
  expect_example_done(folder / "results");
}

TEST(SweepExamples, SnakemakeComputesTheExample) {
  if (std::system("command -v snakemake > /dev/null") != 0) GTEST_SKIP() << "no snakemake here";
  const TemporaryFolder folder;
  ASSERT_EQ(
      bash(folder.path(), std::string("snakemake --cores 2 -s ") + examples +
                              "/Snakefile --config fingertip=$FINGERTIP sweep=$SWEEP shards=3"),
      0)
      << read_text(folder / "words");
  expect_example_done(folder / "results");
}
