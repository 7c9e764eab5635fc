#include "studies/jobs/cache.h"
#include "studies/jobs/result_files.h"

#include <gtest/gtest.h>

#include "meshes/base/errors.h"
#include "studies/jobs/digest.h"
#include "studies/jobs/session.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

/// A job that counts how often it runs and writes one file into a sub-folder.
Job counting_job(int& runs, int input, const std::string& code = "code 1") {
  Job job;
  job.kind = "test";
  job.inputs = {{"input", input}};
  job.source_hash = code;
  job.run = [&runs, input](const fs::path& folder, const JobContext&) {
    ++runs;
    fs::create_directories(folder / "fields");
    write_text(folder / "fields" / "value.txt", std::to_string(input));
  };
  return job;
}

class SessionTest : public testing::Test {
 protected:
  /// Runs `planned` in a fresh run folder and hands back its path.
  fs::path run(const PlannedJob& planned, bool resume = false) {
    RunFolderOptions options;
    options.verb = "test";
    options.resume = resume;
    options.out = place_ / ("run" + std::to_string(resume ? folders_ : ++folders_));
    RunFolder folder(options, load_config({}));
    Progress progress(ProgressStyle::off);
    Session session(folder, progress, Cache(place_ / "cache"), 2);
    last_ = session.run(planned);
    folder.finish("finished", 0);
    return session.path_of(planned);
  }

  TemporaryFolder place_;
  int folders_ = 0;
  JobResult last_;
};

}  // namespace

TEST(Digest, IsSha256) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(SessionTest, EqualInputIsComputedOnce) {
  int runs = 0;
  run({"part", counting_job(runs, 7)});
  EXPECT_FALSE(last_.reused);
  const fs::path second = run({"part", counting_job(runs, 7)});
  EXPECT_TRUE(last_.reused);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(read_text(second / "fields/value.txt"), "7");
}

TEST_F(SessionTest, OtherInputOrOtherCodeIsComputedAnew) {
  int runs = 0;
  run({"part", counting_job(runs, 7)});
  run({"part", counting_job(runs, 8)});
  run({"part", counting_job(runs, 7, "code 2")});
  EXPECT_EQ(runs, 3);
}

TEST_F(SessionTest, ResumeKeepsFinishedPartsWithoutACache) {
  int runs = 0;
  run({"part", counting_job(runs, 7)});
  fs::remove_all(place_ / "cache");
  run({"part", counting_job(runs, 7)}, true);
  EXPECT_EQ(runs, 1);
  run({"part", counting_job(runs, 9)}, true);
  EXPECT_EQ(runs, 2) << "another input must not find the old result";
}

TEST_F(SessionTest, ADamagedCacheEntryIsComputedAnew) {
  int runs = 0;
  const Job job = counting_job(runs, 7);
  run({"part", job});
  write_text(place_ / "cache" / ("test-" + job.key()) / marker_name, "{ trunca");
  run({"part", job});
  EXPECT_EQ(runs, 2);
  run({"part", job});
  EXPECT_EQ(runs, 2) << "and replaced";
}

TEST_F(SessionTest, NoFlippedByteOfTheCacheIsServed) {
  int runs = 0;
  const Job job = counting_job(runs, 7);
  run({"part", job});
  const fs::path entry = place_ / "cache" / ("test-" + job.key());
  int tampered = 0;
  for (const char* name : {"fields/value.txt", marker_name}) {
    for (std::size_t part = 0; part < 7; ++part) {
      std::string content = read_text(entry / name);
      content[part * content.size() / 7] ^= 4;
      write_text(entry / name, content);
      const fs::path result = run({"part", job});
      EXPECT_FALSE(last_.reused) << name << ", part " << part;
      EXPECT_EQ(runs, 1 + ++tampered);
      EXPECT_EQ(read_text(result / "fields/value.txt"), "7");
    }
  }
  write_text(entry / "fields/more.txt", "not of the job");
  run({"part", job});
  fs::remove(entry / "fields/value.txt");
  run({"part", job});
  EXPECT_EQ(runs, 3 + tampered) << "neither is a file too many or one too few";
  const fs::path served = run({"part", job});
  EXPECT_TRUE(last_.reused) << "the mended entry is good again";
  EXPECT_FALSE(fs::exists(served / ".fetched"));
}

TEST_F(SessionTest, LeftoversOfKilledProcessesDisappear) {
  int runs = 0;
  // No process has this number: it is beyond the largest that Linux allows.
  fs::create_directories(place_ / "cache/press-0123.part4194305");
  fs::create_directories(place_ / "cache/press-0456.part1");
  const fs::path folder = run({"", counting_job(runs, 7)});
  Cache(place_ / "cache").tidy();
  EXPECT_FALSE(fs::exists(place_ / "cache/press-0123.part4194305"));
  EXPECT_TRUE(fs::exists(place_ / "cache/press-0456.part1")) << "process 1 is alive";
  write_text(folder / "manifest.json.part4194305", "{");
  run({"", counting_job(runs, 7)}, true);
  EXPECT_FALSE(fs::exists(folder / "manifest.json.part4194305"));
  EXPECT_EQ(runs, 1);
}

TEST_F(SessionTest, AnUnwritableCacheCostsNoResult) {
  int runs = 0;
  write_text(place_ / "cache", "a file where the folder should be");
  const fs::path result = run({"part", counting_job(runs, 7)});
  EXPECT_EQ(read_text(result / "fields/value.txt"), "7");
}

TEST_F(SessionTest, AnExhibitMayFailToConvergeAndIsRemembered) {
  int runs = 0;
  Job job = counting_job(runs, 7);
  job.run = [&runs](const fs::path& folder, const JobContext&) {
    ++runs;
    write_text(folder / "partial.txt", "half");
    throw fingertip::meshes::NotConverged("blew up");
  };
  const fs::path folder = run({"part", job, true});
  EXPECT_EQ(last_.status, "not converged: blew up");
  EXPECT_EQ(read_text(folder / "partial.txt"), "half");
  run({"part", job, true});
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(last_.status, "not converged: blew up");
  EXPECT_THROW(run({"part", job, false}), fingertip::meshes::NotConverged);
}

namespace {

/// A job in two halves, of which the first attempt ends with `Failure` after the first.
template <typename Failure>
Job interrupted_job(int& runs, int input, bool resumable = true) {
  Job job = counting_job(runs, input);
  job.resumable = resumable;
  job.run = [&runs](const fs::path& folder, const JobContext&) {
    ++runs;
    if (fs::exists(folder / "half.txt")) return write_text(folder / "whole.txt", "");
    write_text(folder / "half.txt", std::to_string(runs));
    throw Failure("stopped half way");
  };
  return job;
}

}  // namespace

TEST_F(SessionTest, ResumeGoesOnInsideAResumableJob) {
  int runs = 0;
  const Job job = interrupted_job<fingertip::meshes::Interrupted>(runs, 7);
  EXPECT_THROW(run({"part", job}), fingertip::meshes::Interrupted);
  const fs::path folder = run({"part", job}, true);
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(read_text(folder / "half.txt"), "1") << "of the first attempt";
  EXPECT_TRUE(fs::exists(folder / "whole.txt"));
  EXPECT_FALSE(fs::exists(folder / attempt_name));
  run({"part", job}, true);
  EXPECT_EQ(runs, 2) << "now it is finished";
  EXPECT_FALSE(fs::exists(place_ / "cache" / ("test-" + job.key()) / attempt_name));
}

TEST_F(SessionTest, ResumeStartsOtherInputOrAnUnresumableJobAnew) {
  using fingertip::meshes::NotConverged;
  int runs = 0;
  EXPECT_THROW(run({"part", interrupted_job<NotConverged>(runs, 7)}), NotConverged);
  EXPECT_THROW(run({"part", interrupted_job<NotConverged>(runs, 8)}, true), NotConverged)
      << "the half of another job must not be taken";
  EXPECT_NO_THROW(run({"part", interrupted_job<NotConverged>(runs, 8)}, true));
  EXPECT_THROW(run({"part", interrupted_job<NotConverged>(runs, 9, false)}), NotConverged);
  EXPECT_THROW(run({"part", interrupted_job<NotConverged>(runs, 9, false)}, true), NotConverged);
}

TEST_F(SessionTest, AResultInTheCacheReplacesAHalfDoneJob) {
  int runs = 0;
  const Job job = counting_job(runs, 7);
  Job half = interrupted_job<fingertip::meshes::Interrupted>(runs, 7);
  EXPECT_THROW(run({"part", half}), fingertip::meshes::Interrupted);
  const int first = folders_;
  run({"part", job});
  folders_ = first;
  const fs::path folder = run({"part", half}, true);
  EXPECT_TRUE(last_.reused);
  EXPECT_EQ(read_text(folder / "fields/value.txt"), "7");
  EXPECT_FALSE(fs::exists(folder / "half.txt"));
}

TEST_F(SessionTest, ALostProcessIsNoResultNotEvenOfAnExhibit) {
  int runs = 0;
  const Job job = interrupted_job<ProcessLost>(runs, 7);
  EXPECT_THROW(run({"part", job, true}), ProcessLost);
  EXPECT_FALSE(fs::exists(place_ / "cache" / ("test-" + job.key())));
  run({"part", job, true}, true);
  EXPECT_TRUE(last_.ok());
}

TEST_F(SessionTest, RanksReachTheJobAndNotItsKey) {
  int runs = 0;
  int ranks = 0;
  Job job = counting_job(runs, 7);
  const std::string key = job.key();
  job.run = [&ranks](const fs::path&, const JobContext& context) { ranks = context.ranks; };
  RunFolderOptions options;
  options.verb = "test";
  options.out = place_ / "run";
  RunFolder folder(options, load_config({}));
  Progress progress(ProgressStyle::off);
  Session(folder, progress, Cache(place_ / "cache"), 2, 3).run({"part", job});
  EXPECT_EQ(ranks, 3);
  EXPECT_EQ(job.key(), key);
}

TEST_F(SessionTest, RunFilesStayOutOfTheCache) {
  int runs = 0;
  const Job job = counting_job(runs, 7);
  run({"", job});
  const fs::path entry = place_ / "cache" / ("test-" + job.key());
  EXPECT_TRUE(fs::exists(entry / "fields/value.txt"));
  EXPECT_FALSE(fs::exists(entry / "manifest.json"));
}

TEST(SessionLanes, RunAllKeepsTheOrderOfResultsAndThrowsTheFirstFailure) {
  const TemporaryFolder place;
  RunFolderOptions options;
  options.verb = "test";
  options.out = place / "run";
  RunFolder folder(options, load_config({}));
  Progress progress(ProgressStyle::off);
  Session session(folder, progress, Cache(place / "cache"), 2);
  int ignored[4] = {};
  std::vector<PlannedJob> jobs;
  for (int i = 0; i < 4; ++i) {
    jobs.push_back({"part" + std::to_string(i), counting_job(ignored[i], i), false});
  }
  const auto results = session.run_all(jobs);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(results[std::size_t(i)].name, jobs[std::size_t(i)].name);
  jobs[0].job.source_hash = "fails";
  jobs[0].job.run = [](const fs::path&, const JobContext&) {
    throw fingertip::meshes::NotConverged("no");
  };
  EXPECT_THROW(session.run_all(jobs), fingertip::meshes::NotConverged);
}

TEST_F(SessionTest, DamagedResultsAreComputedAgainAndNeverServed) {
  int runs = 0;
  const fs::path first = run({"part", counting_job(runs, 7)});
  // In the run folder: a resumed run sees it, and the cache still has the result.
  write_text(first / "fields/value.txt", "8");
  run({"part", counting_job(runs, 7)}, true);
  EXPECT_EQ(read_text(first / "fields/value.txt"), "7");
  EXPECT_EQ(runs, 1);
  // In the cache, too.
  for (const auto& item : fs::recursive_directory_iterator(place_ / "cache"))
    if (item.path().filename() == "value.txt") write_text(item.path(), "8");
  const fs::path second = run({"part", counting_job(runs, 7)});
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(read_text(second / "fields/value.txt"), "7");
  // What took its place in the cache is whole again.
  const fs::path third = run({"part", counting_job(runs, 7)});
  EXPECT_EQ(runs, 2);
  fs::remove(third / "fields/value.txt");
  fs::remove_all(place_ / "cache");
  run({"part", counting_job(runs, 7)}, true);
  EXPECT_EQ(runs, 3);
}
