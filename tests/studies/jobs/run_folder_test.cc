#include "studies/jobs/run_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "studies/files/json_entry.h"
#include "studies/jobs/file_lock.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

RunFolderOptions into(const fs::path& out) {
  RunFolderOptions options;
  options.verb = "press";
  options.out = out;
  options.command_line = {"fingertip", "press"};
  return options;
}

}  // namespace

TEST(RunFolder, TellsWhatItIsFromTheFirstMoment) {
  const TemporaryFolder place;
  const LoadedConfig loaded = load_config({{}, {"press.depth=0.2 cm"}, {}});
  RunFolder folder(into(place / "a/b/run"), loaded);
  const auto manifest = parse_json(place / "a/b/run/manifest.json");
  EXPECT_EQ(manifest["status"], "running");
  EXPECT_EQ(manifest["command_line"][1], "press");
  for (const char* entry :
       {"version", "source_hash", "input_hash", "packages", "host", "started"}) {
    EXPECT_TRUE(manifest.contains(entry)) << entry;
  }
  EXPECT_EQ(load_config({folder.path() / "parameters.toml", {}, {}}).config.press.protocol.depth,
            0.002);
  folder.finish("finished", 0);
  EXPECT_EQ(parse_json(folder.path() / "manifest.json")["status"], "finished");
  EXPECT_NE(read_text(folder.path() / "log.txt").find("exit code 0"), std::string::npos);
}

TEST(RunFolder, SaysFailedWhenItIsAbandoned) {
  const TemporaryFolder place;
  { const RunFolder folder(into(place / "run"), load_config({})); }
  EXPECT_EQ(parse_json(place / "run/manifest.json")["status"], "failed");
}

TEST(RunFolder, RefusesAnExistingFolderAndLeavesItAlone) {
  const TemporaryFolder place;
  write_text(place / "precious.txt", "keep me");
  const LoadedConfig loaded = load_config({});
  EXPECT_THROW(RunFolder(into(place.path()), loaded), ConfigError);
  RunFolderOptions forced = into(place.path());
  forced.force = true;
  EXPECT_THROW(RunFolder(forced, loaded), ConfigError) << "it is no run folder";
  EXPECT_EQ(read_text(place / "precious.txt"), "keep me");
  EXPECT_FALSE(fs::exists(place / "manifest.json"));
}

TEST(RunFolder, ForceReplacesOnceTheRunGotThroughItsInput) {
  const TemporaryFolder place;
  const LoadedConfig loaded = load_config({});
  RunFolder(into(place / "run"), loaded).finish("finished", 0);
  write_text(place / "run/response.csv", "old");
  RunFolderOptions forced = into(place / "run");
  forced.force = true;
  {
    RunFolder folder(forced, loaded);
    EXPECT_FALSE(fs::exists(place / "run/response.csv"));
    folder.discard();
  }
  EXPECT_EQ(read_text(place / "run/response.csv"), "old") << "bad input must not cost old results";
  EXPECT_EQ(parse_json(place / "run/manifest.json")["status"], "finished");
  RunFolder(forced, loaded).finish("finished", 0);
  EXPECT_FALSE(fs::exists(place / "run/response.csv"));
  EXPECT_FALSE(fs::exists(place / "run/.replaced"));
}

// What a run with --force had to replace is there whenever it was killed.
TEST(RunFolder, AKilledReplacementLosesNothing) {
  const TemporaryFolder place;
  const LoadedConfig loaded = load_config({});
  const fs::path run = place / "run";
  RunFolderOptions forced = into(run), resumed = into(run);
  forced.force = true;
  resumed.resume = true;
  RunFolder(into(run), loaded).finish("finished", 0);
  write_text(run / "response.csv", "old");

  // Killed while it put the old content aside: the manifest went first.
  fs::create_directory(run / ".replaced");
  fs::rename(run / "manifest.json", run / ".replaced/manifest.json");
  RunFolder(resumed, loaded).finish("finished", 0);
  EXPECT_EQ(read_text(run / "response.csv"), "old");
  EXPECT_FALSE(fs::exists(run / ".replaced"));

  // Killed while it computed.
  fs::create_directory(run / ".replaced");
  for (const char* name : {"manifest.json", "response.csv"})
    fs::rename(run / name, run / ".replaced" / name);
  write_text(run / "manifest.json", "{}");
  write_text(run / "response.csv", "half of the new");
  {
    RunFolder folder(forced, loaded);
    EXPECT_FALSE(fs::exists(run / "response.csv"));
    folder.discard();
  }
  EXPECT_EQ(read_text(run / "response.csv"), "old");
}

TEST(RunFolder, AFolderWhoseProcessWasKilledBeforeTheManifestGoesOn) {
  const TemporaryFolder place;
  fs::create_directory(place / "run");
  write_text(place / "run/manifest.json.part4194305", "{");
  RunFolderOptions resumed = into(place / "run");
  resumed.resume = true;
  RunFolder(resumed, load_config({})).finish("finished", 0);
  EXPECT_FALSE(fs::exists(place / "run/manifest.json.part4194305"));
}

/// Process 1 always lives, and never writes here.
TEST(RunFolder, PartsInALockedFolderAreAbandonedWhoeverHasTheirNumberNow) {
  const TemporaryFolder place;
  fs::create_directories(place / "run/points/a");
  for (const char* part : {"run/manifest.json.part1", "run/points/a/response.csv.part1"})
    write_text(place / part, "{");
  write_text(place / "run/points/a/kept.part1.csv", "a name that only looks like it");
  RunFolderOptions resumed = into(place / "run");
  resumed.resume = true;
  write_text(place / "run/manifest.json", "{}");
  RunFolder(resumed, load_config({})).finish("finished", 0);
  EXPECT_FALSE(fs::exists(place / "run/manifest.json.part1"));
  EXPECT_FALSE(fs::exists(place / "run/points/a/response.csv.part1"));
  EXPECT_TRUE(fs::exists(place / "run/points/a/kept.part1.csv"));
}

TEST(RunFolder, PartsOfTheLivingStayWhereOthersMayBeAtWork) {
  const TemporaryFolder place;
  write_text(place / "entry.part1", "");
  write_text(place / "entry.part4194305", "");
  remove_abandoned_parts(place.path());
  EXPECT_TRUE(fs::exists(place / "entry.part1"));
  EXPECT_FALSE(fs::exists(place / "entry.part4194305"));
}

TEST(RunFolder, DiscardRemovesANewFolder) {
  const TemporaryFolder place;
  RunFolder folder(into(place / "run"), load_config({}));
  folder.discard();
  EXPECT_FALSE(fs::exists(place / "run"));
}

TEST(RunFolder, ResumeKeepsWhatIsThere) {
  const TemporaryFolder place;
  const LoadedConfig loaded = load_config({});
  RunFolderOptions resumed = into(place / "run");
  resumed.resume = true;
  EXPECT_FALSE(RunFolder(resumed, loaded).resumed()) << "nothing there yet";
  write_text(place / "run/response.csv", "old");
  EXPECT_TRUE(RunFolder(resumed, loaded).resumed());
  EXPECT_EQ(read_text(place / "run/response.csv"), "old");
}

TEST(RunFolder, OneAtATimeWorksInAFolder) {
  const TemporaryFolder place;
  const LoadedConfig loaded = load_config({});
  RunFolderOptions resumed = into(place / "run/"), forced = into(place / "run");
  resumed.resume = true;
  forced.force = true;
  {
    RunFolder first(resumed, loaded);
    write_text(place / "run/response.csv", "mine");
    for (const RunFolderOptions& other : {into(place / "run"), resumed, forced})
      EXPECT_THROW(RunFolder(other, loaded), ConfigError);
    EXPECT_EQ(read_text(place / "run/response.csv"), "mine");
    first.finish("finished", 0);
  }
  EXPECT_TRUE(RunFolder(resumed, loaded).resumed());
}

TEST(RunFolder, RefusesAFolderThatCannotBeWritten) {
  const TemporaryFolder place;
  write_text(place / "file", "");
  EXPECT_THROW(RunFolder(into(place / "file/run"), load_config({})), ConfigError);
  EXPECT_THROW(RunFolder(into("/proc/fingertip/run"), load_config({})), ConfigError);
}

/// The lock of the launcher's build is held; what waits for it is ended before it does anything.
TEST(Launcher, TellsThatItWaitsForAnotherCallsBuild) {
  const TemporaryFolder folder;
  const std::string place = folder.path().string(), sources = FINGERTIP_SOURCES;
  const std::string held = "exec 8>'" + place + "/.lock'; flock 8; FINGERTIP_BUILD_DIR='" + place +
                           "' timeout 4 '" + sources + "/fingertip' doctor 2>'" + place +
                           "/said' 8>&-";
  EXPECT_NE(std::system(held.c_str()), 0);
  EXPECT_EQ(read_text(folder / "said"), "fingertip: another call builds in " + place +
                                            "; this one waits for it (its log: " + place +
                                            "/build.log)\n");
}
