/// Presses of fingertip-fem against axisymmetric solutions on far finer meshes, which share no code
/// with it: do the error bars reach the truth?
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/fem_reference/fem_program.h"
#include "tests/fem_reference/run_results.h"
#include "tests/verification/axisymmetric/axisymmetric_press.h"

namespace error_bars {

using namespace fingertip;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;

/// Lengths in cm: the default tip, one with thin rubber, and a thick one with a short sleeve.
struct Tip {
  double tip_radius, rod_radius, sleeve_length;
};
inline constexpr Tip tips[] = {{1.0, 0.5, 1.5}, {1.0, 0.65, 1.5}, {1.4, 0.6, 1.0}};

struct Press {
  Tip tip;
  double poissons_ratio;
  ContactMode contact;
  Strain strain;
  std::vector<double> depths;  ///< over R - r
};

inline ReferenceJob job_of(const Press& press, double tolerance) {
  ReferenceJob job;
  job.geometry = {press.tip.tip_radius * 1e-2, press.tip.rod_radius * 1e-2,
                  press.tip.sleeve_length * 1e-2, 0.03};
  job.rubber.youngs_modulus = 2.0 * (1.0 + press.poissons_ratio) * job.rubber.shear_modulus;
  job.protocol.contact = press.contact;
  job.strain = press.strain;
  job.tolerance = tolerance;
  job.write_fields = false;
  std::vector<double> depths;
  for (const double depth : press.depths) depths.push_back(depth * job.geometry.thickness());
  job.press_to(depths);
  return job;
}

inline std::vector<verification::AxisymmetricSample> truth_of(const ReferenceJob& job) {
  verification::AxisymmetricJob truth;
  truth.geometry = job.geometry;
  truth.rubber = job.rubber;
  truth.contact = job.protocol.contact;
  truth.finite = job.strain == Strain::finite;
  truth.samples = job.protocol.samples;
  truth.mesh.parts = 1;
  truth.mesh.contact_elements = truth.finite ? 48 : 120;
  return verification::press_axisymmetric(truth);
}

struct Tally {
  int covered = 0, values = 0;
};

/// Prints a line per sample; counts the bars that reach the truth.
inline Tally compare(const Press& press, double tolerance) {
  const TemporaryFolder parent;
  const ReferenceJob job = job_of(press, tolerance);
  const auto folder = run_folder(parent, "press", job);
  Tally tally;
  EXPECT_EQ(carry_out(folder), 0);
  const auto samples = samples_of(folder);
  const auto truth = truth_of(job);
  EXPECT_EQ(samples.size(), truth.size());
  for (std::size_t i = 0; i < std::min(samples.size(), truth.size()); ++i) {
    const double error = samples[i].normal_force - truth[i].force;
    const bool covered = std::abs(error) <= samples[i].force_error;
    tally.covered += covered ? 1 : 0;
    ++tally.values;
    std::printf(
        "r/R %.2f nu %.2f %s %s depth %.3f: error %+.3f %%, bar %.3f %%%s; radius %+.2f %%, "
        "pressure %+.2f %%\n",
        press.tip.rod_radius / press.tip.tip_radius, press.poissons_ratio,
        std::string(name(press.contact)).c_str(),
        press.strain == Strain::finite ? "law A" : "linear", press.depths[i],
        100.0 * error / truth[i].force, 100.0 * samples[i].force_error / truth[i].force,
        covered ? "" : " MISSED",
        100.0 * (samples[i].contact_radius / truth[i].contact_radius - 1.0),
        100.0 * (samples[i].max_pressure / truth[i].max_pressure - 1.0));
    EXPECT_NEAR(samples[i].contact_radius / truth[i].contact_radius, 1.0,
                press.depths[i] < 0.1 ? 0.04 : 0.015);
  }
  return tally;
}

}  // namespace error_bars
