// The verb sweep: shards of one sweep in several processes.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "meshes/tables/csv_table.h"
#include "tests/studies/workplace.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* examples = FINGERTIP_SOURCES "/studies/sweep/examples";

/// Six static presses, each well below a second.
const Words six_presses = {"press.mode=static", "press.contact=frictionless",
                           "press.samples=[\"0.05 cm\"]",
                           "lattice.model=[\"hookean\", \"network\"]",
                           "lattice.spacing=[\"tip_radius/4\", \"0.22 cm\", \"tip_radius/5\"]"};

/// First words of the lines of `text`.
Words first_words(const std::string& text) {
  Words words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    words.push_back(line.substr(0, line.find('\t')));
  return words;
}

/// The table's lines without what wall time makes differ.
Words stable_columns(const fs::path& table) {
  std::istringstream lines(read_text(table));
  Words kept;
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
  for (std::size_t i = 1; i < lines.size(); ++i) EXPECT_TRUE(says(lines[i], ",finished,"));
}

}  // namespace

TEST(SweepVerb, ShardsAreDisjointAndMakeUpTheWholeInAnyOrderOfWriting) {
  const Workplace folder;
  const Words whole = first_words(folder.run("sweep --list", six_presses).out);
  ASSERT_EQ(whole.size(), 6U);
  EXPECT_TRUE(std::ranges::is_sorted(whole));
  for (const int n : {1, 2, 4, 6, 9}) {
    Words joined;
    for (int i = 1; i <= n; ++i) {
      const std::string shard = std::to_string(i) + "/" + std::to_string(n);
      const Words part = first_words(folder.run("sweep --list --shard " + shard, six_presses).out);
      EXPECT_LE(part.size(), std::size_t((6 + n - 1) / n));
      joined = joined + part;
    }
    std::ranges::sort(joined);
    EXPECT_EQ(joined, whole) << n;
  }
  // The same axes with keys and values the other way round, and another number of threads.
  const Words turned = {
      R"(lattice.spacing=["tip_radius/5","tip_radius/4","0.22 cm","tip_radius/5"])",
      R"(lattice.model=["network","hookean"])", R"(press.samples=["0.05 cm"])",
      "press.contact=frictionless", "press.mode=static"};
  EXPECT_EQ(first_words(folder.run("sweep --list --threads 3", turned).out), whole);
}

/// The same points, one by one; what only some set is for the others as for the whole sweep.
TEST(SweepVerb, PointsMayBeListed) {
  const Workplace folder;
  const auto listed = [&](const Words& settings) {
    return first_words(folder.run("sweep --list", Words{"press.mode=static"} + settings).out);
  };
  const Words grid = listed({"press.depth=[\"1 mm\", \"2 mm\"]", "press.contact=[\"stick\"]"});
  ASSERT_EQ(grid.size(), 2U);
  EXPECT_EQ(
      listed(
          {R"(sweep.points=[{press.depth="2 mm"}, {press={depth="1 mm"}}, {press.depth="2 mm"}])",
           "press.contact=[\"stick\"]"}),
      grid);
  EXPECT_EQ(
      listed(
          {R"(sweep.points=[{press.depth="2 mm", press.contact="stick"}, {press.contact="stick"}])",
           "press.depth=1 mm"}),
      grid);
  folder.expect_refused("sweep --out no", {"sweep.points=[1]"}, {"points are a list of settings"});
  folder.expect_refused("sweep --out no", {"sweep.points=[{press.dept=\"1 mm\"}]"},
                        {"nearest valid key is press.depth"});
}

TEST(SweepVerb, AStatusThatNoRunHasIsDamage) {
  const Workplace folder;
  folder.run("sweep --out points", six_presses);
  const fs::path marker =
      fs::directory_iterator(folder / "points/points")->path() / "finished.json";
  std::string text = read_text(marker);
  text.replace(text.find("finished"), 8, "finhshed");
  std::ofstream(marker) << text;
  const ProgramResult result = folder.run("sweep --collect --out points", {}, 2);
  EXPECT_TRUE(says(result.err, marker.filename().string())) << result.err;
}

/// A press that moves laterally has a column more than one that does not.
TEST(SweepVerb, CurvesOfDifferentColumnsStandInOneTable) {
  const Workplace folder;
  EXPECT_TRUE(says(
      folder
          .run("sweep --out lateral", {"press.mode=static", "lattice.spacing=tip_radius/4",
                                       R"(press.samples=["0.5 mm", "1 mm"])", "press.depth=1 mm",
                                       "press.lateral_path=after", "press.lateral_samples=2",
                                       R"(press.lateral=["0 mm", "0.2 mm"])"})
          .out,
      "2 finished"));
  const auto curves = fingertip::meshes::read_csv(folder / "lateral/curves.csv");
  const auto sideways = curves.texts("lateral_displacement [m]");
  ASSERT_EQ(sideways.size(), 2U + 4U);
  EXPECT_EQ(std::ranges::count(sideways, ""), 2);
  EXPECT_EQ(std::ranges::count(sideways, "2e-04"), 1);
  const auto table = fingertip::meshes::read_csv(folder / "lateral/table.csv");
  for (const double force : table.numbers("normal_force [N]")) EXPECT_GT(force, 0.0);
}

TEST(SweepVerb, TwoShardsAtATimeGiveTheTableOfTheWhole) {
  const Workplace folder, other, second_place;
  other.run("sweep --out whole --threads 1", six_presses);
  const std::string shared = "sweep --threads 1 --out " + (folder / "results").string();
  Program first = folder.start(shared + " --shard 1/2", six_presses);
  Program second = second_place.start(shared + " --shard 2/2", six_presses);
  const ProgramResult of_first = first.wait(), of_second = second.wait();
  EXPECT_EQ(of_first.code, 0) << of_first.err;
  EXPECT_EQ(of_second.code, 0) << of_second.err;
  folder.run("sweep --collect --out results");
  EXPECT_EQ(stable_columns(folder / "results/table.csv"),
            stable_columns(other / "whole/table.csv"));
  EXPECT_EQ(folder.text("results/curves.csv"), other.text("whole/curves.csv"));
  // The answer stands behind the axes.
  EXPECT_TRUE(says(
      folder.text("results/table.csv"),
      {"census.particles",
       "lattice.spacing,indentation [m],normal_force [N],force_error [N],contact_radius [m],"}));
}

TEST(SweepVerb, AKilledShardGoesOnWhereItWas) {
  const Workplace folder;
  const std::string command = "sweep --out results --shard 1/1 --threads 1";
  Program killed = folder.start(command, six_presses);
  folder.hears("[1/6]");
  killed.send(SIGKILL);
  killed.wait();
  // Else it was quicker than the signal.
  const bool in_time = folder.run("sweep --collect --out results", {}, any_code).code == 3;
  const std::string rest = folder.run(command, six_presses).out;
  EXPECT_TRUE(says(rest, "(earlier)"));
  EXPECT_TRUE(!in_time || says(rest, "finished\n")) << rest;
  folder.run("sweep --collect --out results");
}

TEST(SweepVerb, BadInputIsToldBeforeAnythingIsMade) {
  const Workplace folder;
  const std::string speeds = "press.speed=[\"1 cm/s\"]";
  for (const auto& [command, settings, told] :
       std::vector<std::tuple<std::string, Words, std::string>>{
           {"sweep --out r", {}, "no key has a list of values"},
           {"sweep --out r --shard 0/4", {speeds}, "1 <= i <= N"},
           {"sweep --out r --shard 5/4", {speeds}, "1 <= i <= N"},
           {"sweep --out r", {"press.speed=[\"1 cm\"]"}, "press.speed"},
           {"sweep --out r", {"press.speed=[]"}, "list"},
           {"sweep --out r",
            {R"(lattice.spacing=["tip_radius/8", "0.9 cm"])"},
            "two cells through the rubber"},
           {"sweep validate --out r", {speeds}, "press, modes"},
           {"sweep", {speeds}, "--out DIR"},
           {"sweep --collect --out r", {}, "not the folder of a sweep"}})
    folder.expect_refused(command, settings, told);
}

TEST(SweepVerb, AFolderBelongsToOneSweep) {
  const Workplace folder;
  const auto quick = [&](const std::string& spacing, const std::string& more, int code) {
    return folder.run("sweep --out r" + more,
                      {"press.mode=static", "press.samples=[\"0.05 cm\"]",
                       "lattice.spacing=[\"" + spacing + "\"]"},
                      code);
  };
  quick("tip_radius/4", "", 0);
  quick("tip_radius/4", "", 2);
  quick("tip_radius/4", " --resume auto", 0);
  EXPECT_TRUE(says(quick("0.22 cm", " --shard 1/1", 2).err, "another sweep"));
}

TEST(SweepExamples, ASlurmArrayComputesTheExample) {
  const Workplace folder;
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
  const Workplace folder;
  ASSERT_EQ(bash(folder.path(), std::string("SHARDS=3 bash ") + examples + "/gnu_parallel.sh"), 0)
      << read_text(folder / "words");
  expect_example_done(folder / "results");
}

TEST(SweepExamples, SnakemakeComputesTheExample) {
  if (std::system("command -v snakemake > /dev/null") != 0) GTEST_SKIP() << "no snakemake here";
  const Workplace folder;
  ASSERT_EQ(
      bash(folder.path(), std::string("snakemake --cores 2 -s ") + examples +
                              "/Snakefile --config fingertip=$FINGERTIP sweep=$SWEEP shards=3"),
      0)
      << read_text(folder / "words");
  expect_example_done(folder / "results");
}
