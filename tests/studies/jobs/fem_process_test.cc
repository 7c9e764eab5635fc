#include "studies/jobs/fem_process.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <thread>

#include "meshes/press/no_equilibrium.h"
#include "studies/files/places.h"
#include "studies/files/process.h"
#include "studies/jobs/fem_launch.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;
namespace meshes = fingertip::meshes;

namespace {

/// Shell scripts in the place of fingertip-fem.
class FemProcess : public testing::Test {
 protected:
  void run(const std::string& script) {
    const fs::path program = place_ / "program";
    write_text(program, "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    JobContext context;
    context.report = [this](double fraction, const std::string& stage) {
      fraction_ = fraction;
      stage_ = stage;
      return !stop_();
    };
    context.log = [this](const std::string& line) { log_ += line + "\n"; };
    context.threads = threads_;
    context.ranks = ranks_;
    run_fem_process(program, place_.path(), context);
  }

  /// The message of the ProcessLost that `script` ends with; empty when it ends otherwise.
  std::string loss(const std::string& script) {
    try {
      run(script);
    } catch (const ProcessLost& error) {
      return error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    return {};
  }

  TemporaryFolder place_;
  double fraction_ = -1.0;
  std::string stage_;
  std::string log_;
  std::function<bool()> stop_ = [] { return false; };
  int threads_ = 1;
  int ranks_ = 1;
};

/// Shell: the number of this rank.
constexpr const char* rank = "$OMPI_COMM_WORLD_RANK";

}  // namespace

TEST_F(FemProcess, GetsItsFolderAndReportsProgress) {
  run("echo '{\"stage\":\"press\",\"done\":1,\"total\":2,\"message\":\"half way\"}'\n"
      "echo plain; echo warning >&2; touch \"$1/done\"; echo $OMP_NUM_THREADS > \"$1/threads\"");
  EXPECT_TRUE(fs::exists(place_ / "done"));
  EXPECT_EQ(stage_, "press");
  EXPECT_GT(fraction_, 0.2);
  EXPECT_LT(fraction_, 0.5);
  EXPECT_EQ(read_text(place_ / "threads"), "1\n");
  for (const char* line : {"half way", "fem: plain", "fem: warning"}) {
    EXPECT_NE(log_.find(line), std::string::npos) << line;
  }
}

TEST_F(FemProcess, ExitCodesBecomeExceptions) {
  EXPECT_THROW(run("exit 2"), meshes::InvalidInput);
  EXPECT_THROW(run("exit 130"), meshes::Interrupted);
  EXPECT_THROW(run("exit 1"), std::runtime_error);
  try {
    run("echo 'contact did not converge' >&2; exit 3");
    FAIL();
  } catch (const meshes::NotConverged& error) {
    EXPECT_NE(std::string(error.what()).find("contact did not converge"), std::string::npos);
  }
  try {
    run("echo '{\"reached\": 0.0062}' > \"$1/summary.json\"; echo 'no further' >&2; exit 3");
    FAIL();
  } catch (const meshes::NoEquilibrium& error) {
    EXPECT_EQ(error.indentation(), 0.0062);
    EXPECT_STREQ(error.what(), "no further");
  }
}

TEST_F(FemProcess, ProgressGrowsFromMeshToMesh) {
  const std::string meshes =
      "for mesh in 1 2 3; do\n for stage in mesh assemble press fields; do\n"
      "  for done in 0 1 2; do echo \"{\\\"stage\\\":\\\"$stage\\\",\\\"done\\\":$done,"
      "\\\"total\\\":2}\"; done\n done\ndone\n";
  run(meshes);
  EXPECT_GT(fraction_, 0.8);
  EXPECT_LT(fraction_, 1.0);
}

TEST_F(FemProcess, TheTimeLeftThatARunTellsIsItsProgress) {
  const auto told = [this](const char* left, const char* memory) {
    run(std::string("sleep 0.2; echo '{\"stage\":\"assemble\",\"done\":0,\"total\":1,\"left\":") +
        left + ",\"memory\":" + memory + "}'; sleep 0.2");
    return fraction_;
  };
  const double half = told("0.4", "2e8");
  EXPECT_GT(half, 0.3);
  EXPECT_LT(half, 1.0);
  EXPECT_EQ(stage_, "assemble");
  EXPECT_LT(told("1e5", "5e9"), 1e-4);  // of a machine that is slow to start a shell, too
  EXPECT_EQ(stage_.find("assemble, some 5 GB"), 0u) << stage_;
  told("1e5", "9e15");
  EXPECT_TRUE(says(stage_, "GB here")) << stage_;
}

TEST_F(FemProcess, ALostProcessIsToldWithItsSignalAndWhereTheSamplesAre) {
  EXPECT_TRUE(says(loss("kill -SEGV $$"), "signal 11"));
  EXPECT_TRUE(says(loss("kill -KILL $$"), "no sample had been finished"));
  const std::string text = loss("echo 'a,b' > \"$1/response.csv\"; kill -KILL $$");
  for (const std::string& part :
       {std::string("signal 9"), std::string("memory"), (place_ / "response.csv").string()}) {
    EXPECT_TRUE(says(text, part)) << part << "\nin\n" << text;
  }
}

TEST_F(FemProcess, AloneItHasTheThreads) {
  threads_ = 3;
  run("echo $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS $DEAL_II_NUM_THREADS > \"$1/threads\"");
  EXPECT_EQ(read_text(place_ / "threads"), "3 3 3\n");
}

TEST_F(FemProcess, RanksHaveOneThreadEachAndTheSameFolder) {
  threads_ = ranks_ = 3;
  run(std::string("echo $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS > \"$1/rank") + rank + "\"\n[ " +
      rank + " = 0 ] && echo '{\"stage\":\"press\",\"done\":1,\"total\":2}'; true");
  for (const char* file : {"rank0", "rank1", "rank2"}) EXPECT_EQ(read_text(place_ / file), "1 1\n");
  EXPECT_FALSE(fs::exists(place_ / "rank3"));
  EXPECT_EQ(stage_, "press");
}

TEST_F(FemProcess, MoreRanksThanCoresAreAllowed) {
  ranks_ = 2 * int(std::thread::hardware_concurrency()) + 1;
  run(std::string("touch \"$1/rank") + rank + "\"");
  EXPECT_TRUE(fs::exists(place_ / ("rank" + std::to_string(ranks_ - 1))));
}

TEST_F(FemProcess, ExitCodesComeThroughMpirunWithNothingButTheProgramsWords) {
  ranks_ = 2;
  const std::string word = std::string("[ ") + rank + " = 0 ] && echo 'it did not converge' >&2\n";
  try {
    run(word + "sleep 0.3; exit 3");
    FAIL();
  } catch (const ProcessLost& error) {
    FAIL() << error.what();
  } catch (const meshes::NotConverged& error) {
    EXPECT_STREQ(error.what(), "it did not converge");
  }
  EXPECT_THROW(run("exit 2"), meshes::InvalidInput);
  EXPECT_THROW(run("exit 130"), meshes::Interrupted);
}

TEST_F(FemProcess, ALostRankEndsTheOthersAndIsTold) {
  ranks_ = 3;
  const auto start = std::chrono::steady_clock::now();
  const std::string text =
      loss(std::string("[ ") + rank + " = 1 ] && sleep 0.5 && kill -KILL $$\n" + "exec sleep 60");
  EXPECT_TRUE(says(text, "signal 9")) << text;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(FemProcess, EveryRankIsAskedToStopAndHasTimeToFinish) {
  ranks_ = 3;
  const auto all = [this](const std::string& name) {
    return fs::exists(place_ / (name + "0")) && fs::exists(place_ / (name + "1")) &&
           fs::exists(place_ / (name + "2"));
  };
  stop_ = [&] { return all("ready"); };
  // Like MPI ranks, they leave together; it takes them longer than mpirun's own patience of 1 s.
  write_text(place_ / "stop.sh",
             std::string("sleep 2; touch \"$1/stopped") + rank +
                 "\"\nuntil [ -e \"$1/stopped0\" -a -e \"$1/stopped1\" -a -e \"$1/stopped2\" ]\n"
                 "do sleep 0.05; done\nsleep 0.2; exit 130\n");
  EXPECT_THROW(run(std::string("trap '. \"$1/stop.sh\"' INT\ntouch \"$1/ready") + rank +
                   "\"\nwhile true; do sleep 0.05; done"),
               meshes::Interrupted);
  EXPECT_TRUE(all("stopped"));
}

TEST_F(FemProcess, StoppingRanksThatHaveHardlyStartedEndsThemToo) {
  ranks_ = 3;
  stop_ = [] { return true; };
  EXPECT_THROW(run("while true; do sleep 0.05; done"), meshes::Interrupted);
}

TEST_F(FemProcess, WithoutMpirunSeveralRanksAreBadInput) {
  const std::string path = ::getenv("PATH");
  ::setenv("PATH", place_.path().c_str(), 1);
  EXPECT_THROW(fem_command("/bin/sh", place_.path(), 1, 2), meshes::InvalidInput);
  EXPECT_NO_THROW(fem_command("/bin/sh", place_.path(), 1, 1));
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(FemProcess, IsAskedToStopWhenTheUserWantsTo) {
  stop_ = [] { return true; };
  EXPECT_THROW(run("trap 'touch \"$1/stopped\"; exit 130' INT\nwhile true; do sleep 0.05; done"),
               meshes::Interrupted);
  EXPECT_TRUE(fs::exists(place_ / "stopped"));
}

TEST_F(FemProcess, AMissingProgramIsBadInput) {
  JobContext context;
  EXPECT_THROW(run_fem_process(place_ / "absent", place_.path(), context), meshes::InvalidInput);
}

/// The launcher that started this program builds what is missing; who has none is told how.
TEST(BuiltReferenceProgram, IsBuiltByTheLauncherWhenItIsFirstAskedFor) {
  const fs::path program = reference_program();
  ASSERT_FALSE(fs::exists(program)) << "beside the tests there is none";
  const auto refusal = [] {
    try {
      built_reference_program();
    } catch (const meshes::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("built");
  };
  ::unsetenv("FINGERTIP_LAUNCHER");
  EXPECT_TRUE(says(refusal(), "FINGERTIP_FEM=ON"));
  const TemporaryFolder folder;
  const auto launch = [&](const std::string& script) {
    write_text(folder / "launcher", "#!/bin/sh\n" + script);
    fs::permissions(folder / "launcher", fs::perms::owner_all);
    ::setenv("FINGERTIP_LAUNCHER", (folder / "launcher").c_str(), 1);
  };
  launch("test \"$1\" = --continuum && : > '" + program.string() + "'");
  EXPECT_EQ(built_reference_program(), program);
  fs::remove(program);
  launch("echo no network; exit 1");
  EXPECT_TRUE(says(refusal(), {"no network", "./fingertip reference"}));
  launch("echo another");
  EXPECT_TRUE(says(refusal(), "no network")) << "it is tried once";
  ::unsetenv("FINGERTIP_LAUNCHER");
}
