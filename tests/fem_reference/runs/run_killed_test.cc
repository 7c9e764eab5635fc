/// fingertip-fem killed: it goes on from its checkpoint. Slow, because a checkpoint is written
/// every ten seconds.
#include <gtest/gtest.h>

#include "tests/fem_reference/runs/fem_program.h"
#include "tests/fem_reference/runs/run_results.h"

using fingertip::fem_reference::ReferenceJob;
namespace fs = std::filesystem;

namespace {

/// Three meshes at large strain, some 20 s or more.
ReferenceJob long_job() {
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  for (int i = 1; i <= 8; ++i) job.protocol.samples.push_back(1e-4 * i);
  job.refinement = 0.3;
  job.strain = fingertip::fem_reference::Strain::finite;
  job.tolerance = 0.5;
  job.write_fields = false;
  return job;
}

/// Killed after the first checkpoint, interrupted after one more sample, finished at the third
/// attempt.
TEST(Killed, GoesOnWhereItWas) {
  const TemporaryFolder parent;
  const fs::path undisturbed = run_folder(parent, "undisturbed", long_job());
  ASSERT_EQ(carry_out(undisturbed), 0);
  const fs::path folder = run_folder(parent, "killed", long_job());
  {
    FemProgram program(folder, {folder.string()});
    ASSERT_TRUE(program.runs_until([&] { return fs::exists(folder / "checkpoint/run.json"); }))
        << "it ended before its first checkpoint: make the job longer";
    program.send(SIGKILL);
    EXPECT_EQ(program.wait(), -SIGKILL);
  }
  EXPECT_GE(samples_of(folder).size(), 1u);
  EXPECT_EQ(summary_of(folder).at("status"), "interrupted");
  {
    FemProgram program(folder, {folder.string()});
    ASSERT_TRUE(program.runs_until([&] {
      const std::size_t resumed = program.output().find("resumed on mesh");
      return resumed != std::string::npos &&
             program.output().find("F = ", resumed) != std::string::npos;
    }));
    program.send(SIGINT);
    EXPECT_EQ(program.wait(), 130);
  }
  FemProgram program(folder, {folder.string()});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_NE(program.output().find("resumed on mesh"), std::string::npos);
  expect_same_results(undisturbed, folder);
}

}  // namespace
