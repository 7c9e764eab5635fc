/// Presses of fingertip-fem: do the error bars reach the truth? It is an axisymmetric solution on a
/// far finer mesh by a program that shares no code with it, or a finer one of its own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/fem_reference/runs/fem_program.h"
#include "tests/fem_reference/runs/run_results.h"
#include "tests/verification/axisymmetric/axisymmetric_press.h"

namespace error_bars {

using namespace fingertip;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;
using meshes::VolumetricLaw;

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
  VolumetricLaw law = VolumetricLaw::logarithmic;
};

inline ReferenceJob job_of(const Press& press, double tolerance) {
  ReferenceJob job;
  job.geometry = {press.tip.tip_radius * 1e-2, press.tip.rod_radius * 1e-2,
                  press.tip.sleeve_length * 1e-2, 0.03};
  job.rubber.youngs_modulus = 2.0 * (1.0 + press.poissons_ratio) * job.rubber.shear_modulus;
  job.protocol.contact = press.contact;
  job.strain = press.strain;
  job.rubber.energy.volumetric = press.law;
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
  std::vector<double> idleness;  ///< bar over error

  void add(double error, double bar) {
    covered += std::abs(error) <= bar ? 1 : 0;
    ++values;
    idleness.push_back(bar / std::abs(error));
  }
  Tally& operator+=(const Tally& other) {
    covered += other.covered;
    values += other.values;
    idleness.insert(idleness.end(), other.idleness.begin(), other.idleness.end());
    return *this;
  }
  double median_idleness() const {
    std::vector<double> sorted = idleness;
    std::ranges::sort(sorted);
    return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
  }
  void print() const {
    std::printf("%d of %d covered, median of bar over error %.2f\n", covered, values,
                median_idleness());
  }
};

/// The samples of one run of the program.
inline std::vector<meshes::PressSample> pressed(const ReferenceJob& job) {
  const TemporaryFolder parent;
  const auto folder = run_folder(parent, "press", job);
  EXPECT_EQ(carry_out(folder), 0);
  return samples_of(folder);
}

inline std::string text_of(const Press& press) {
  char text[96];
  std::snprintf(text, sizeof text, "r/R %.2f nu %.2f %s %s",
                press.tip.rod_radius / press.tip.tip_radius, press.poissons_ratio,
                std::string(name(press.contact)).c_str(),
                press.strain == Strain::finite ? std::string(name(press.law)).c_str() : "linear");
  return text;
}

/// Prints a line per sample; counts the bars that reach the independent solution.
inline Tally compare(const Press& press, double tolerance) {
  const ReferenceJob job = job_of(press, tolerance);
  const auto samples = pressed(job);
  const auto truth = truth_of(job);
  EXPECT_EQ(samples.size(), truth.size());
  Tally tally;
  for (std::size_t i = 0; i < std::min(samples.size(), truth.size()); ++i) {
    const double error = samples[i].normal_force - truth[i].force;
    tally.add(error, samples[i].force_error);
    std::printf(
        "%s depth %.3f: error %+.3f %%, bar %.3f %%%s; radius %+.2f %%, pressure %+.2f %%\n",
        text_of(press).c_str(), press.depths[i], 100.0 * error / truth[i].force,
        100.0 * samples[i].force_error / truth[i].force,
        std::abs(error) <= samples[i].force_error ? "" : " MISSED",
        100.0 * (samples[i].contact_radius / truth[i].contact_radius - 1.0),
        100.0 * (samples[i].max_pressure / truth[i].max_pressure - 1.0));
    EXPECT_NEAR(samples[i].contact_radius / truth[i].contact_radius, 1.0,
                press.depths[i] < 0.1 ? 0.04 : 0.015);
  }
  return tally;
}

/// The same against the program's own elements of degree 3 at a tenth of the tolerance.
inline Tally compare_with_finer(const Press& press, double tolerance = 1e-3) {
  const auto samples = pressed(job_of(press, tolerance));
  ReferenceJob finer = job_of(press, tolerance / 10);
  finer.degree = 3;
  const auto truth = pressed(finer);
  EXPECT_EQ(samples.size(), truth.size());
  Tally tally;
  for (std::size_t i = 0; i < std::min(samples.size(), truth.size()); ++i) {
    const double error = samples[i].normal_force - truth[i].normal_force;
    tally.add(error, samples[i].force_error);
    std::printf("%s depth %.3f: error %+.4f %%, bar %.4f %%%s\n", text_of(press).c_str(),
                press.depths[i], 100.0 * error / truth[i].normal_force,
                100.0 * samples[i].force_error / truth[i].normal_force,
                std::abs(error) <= samples[i].force_error ? "" : " MISSED");
  }
  return tally;
}

}  // namespace error_bars
