#include "studies/run/fem_process.h"

#include <gtest/gtest.h>

#include "meshes/errors.h"
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
      return !stop_;
    };
    context.log = [this](const std::string& line) { log_ += line + "\n"; };
    run_fem_process(program, place_.path(), context);
  }

  TemporaryFolder place_;
  double fraction_ = -1.0;
  std::string stage_;
  std::string log_;
  bool stop_ = false;
};

}  // namespace

TEST_F(FemProcess, GetsItsFolderAndReportsProgress) {
  run("echo '{\"stage\":\"press\",\"done\":1,\"total\":2,\"message\":\"half way\"}'\n"
      "echo plain; echo warning >&2; touch \"$1/done\"; echo $OMP_NUM_THREADS > \"$1/threads\"");
  EXPECT_TRUE(fs::exists(place_ / "done"));
  EXPECT_EQ(stage_, "press");
  EXPECT_GT(fraction_, 0.3);
  EXPECT_LT(fraction_, 0.9);
  EXPECT_EQ(read_text(place_ / "threads"), "1\n");
  for (const char* line : {"half way", "fem: plain", "fem: warning"}) {
    EXPECT_NE(log_.find(line), std::string::npos) << line;
  }
}

TEST_F(FemProcess, ExitCodesBecomeExceptions) {
  EXPECT_THROW(run("exit 2"), meshes::InvalidInput);
  EXPECT_THROW(run("exit 130"), meshes::Interrupted);
  EXPECT_THROW(run("exit 1"), std::runtime_error);
  EXPECT_THROW(run("kill -SEGV $$"), std::runtime_error);
  try {
    run("echo 'contact did not settle' >&2; exit 3");
    FAIL();
  } catch (const meshes::NotConverged& error) {
    EXPECT_NE(std::string(error.what()).find("contact did not settle"), std::string::npos);
  }
}

TEST_F(FemProcess, IsAskedToStopWhenTheUserWantsTo) {
  stop_ = true;
  EXPECT_THROW(run("trap 'touch \"$1/stopped\"; exit 130' INT\nwhile true; do sleep 0.05; done"),
               meshes::Interrupted);
  EXPECT_TRUE(fs::exists(place_ / "stopped"));
}

TEST_F(FemProcess, AMissingProgramIsBadInput) {
  JobContext context;
  EXPECT_THROW(run_fem_process(place_ / "absent", place_.path(), context), meshes::InvalidInput);
}
