/// fingertip-fem interrupted: it keeps what it has, and the job can be done again.
#include <gtest/gtest.h>

#include "tests/fem_reference/runs/fem_program.h"
#include "tests/fem_reference/runs/run_results.h"

using fingertip::fem_reference::ReferenceJob;
namespace fs = std::filesystem;

namespace {

ReferenceJob small_job() {
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.press_to({2e-4, 4e-4, 6e-4, 8e-4, 1e-3, 1.2e-3});
  job.refinement = 0.3;
  job.tolerance = 0.5;
  job.write_fields = false;
  return job;
}

/// A rubber that relaxes remembers what was before.
TEST(Interrupted, GoesOnWithWhatTheRubberRemembers) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.strain = fingertip::fem_reference::Strain::finite;
  job.protocol.speed = 0.01;
  job.rubber.relaxation = {{{0.3, 0.02}, {0.2, 0.2}}, true};
  job.symmetry = fingertip::fem_reference::Symmetry::axisymmetric;
  const fs::path undisturbed = run_folder(parent, "undisturbed", job);
  ASSERT_EQ(carry_out(undisturbed), 0);
  const fs::path folder = run_folder(parent, "stopped", job);
  FemProgram program(folder, {folder.string()});
  ASSERT_TRUE(program.runs_until([&] { return samples_of(folder).size() >= 2; }));
  program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 130);
  ASSERT_EQ(carry_out(folder), 0);
  expect_same_results(undisturbed, folder);
}

/// Both signals ask it to stop; the same job done again in the folder ends as if undisturbed.
TEST(Interrupted, KeepsItsSamplesAndCanBeDoneAgain) {
  const TemporaryFolder parent;
  const fs::path undisturbed = run_folder(parent, "undisturbed", small_job());
  ASSERT_EQ(carry_out(undisturbed), 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path folder = run_folder(parent, std::to_string(signal), small_job());
    FemProgram program(folder, {folder.string()});
    ASSERT_TRUE(program.runs_until([&] { return samples_of(folder).size() >= 2; }));
    program.send(signal);
    EXPECT_EQ(program.wait(), 130);
    EXPECT_GE(samples_of(folder).size(), 2u);
    EXPECT_EQ(summary_of(folder).at("status"), "interrupted");
    ASSERT_EQ(carry_out(folder), 0);
    expect_same_results(undisturbed, folder);
  }
}

/// What is left of another job, or damaged, is not resumed.
TEST(Resume, PassesOverAForeignCheckpoint) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.estimate_error = false;
  const fs::path folder = run_folder(parent, "run", job);
  const nlohmann::json other_form{{"job", read_text(folder / "job.json")},
                                  {"history", nlohmann::json::array({{{"cells", 1}}})}};
  for (const std::string& text :
       {std::string(R"({"job": "another", "mesh_history": []})"), std::string(R"({"job": )"),
        std::string("[]"), other_form.dump()}) {
    fs::create_directories(folder / "checkpoint");
    write_text(folder / "checkpoint/run.json", text);
    EXPECT_EQ(carry_out(folder), 0) << text;
    EXPECT_EQ(samples_of(folder).size(), job.protocol.samples.size());
  }
}

}  // namespace
