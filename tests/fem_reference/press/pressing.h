/// A press of the default specimen on a mesh of its own.
#pragma once

#include "fem_reference/press/press.h"
#include "fem_reference/tip/job_mesh.h"
#include "tests/fem_reference/shared_mesh.h"

/// A press of the solid to 1 mm on one coarse mesh; change what the test is about.
inline fingertip::fem_reference::ReferenceJob small_press() {
  fingertip::fem_reference::ReferenceJob job;
  job.protocol.contact = fingertip::meshes::ContactMode::frictionless;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.press_to({1e-3});
  job.refinement = 0.3;
  job.estimate_error = false;
  job.write_fields = false;
  return job;
}

/// The same on the meridian.
inline fingertip::fem_reference::ReferenceJob meridian_press(
    fingertip::meshes::ContactMode contact = fingertip::meshes::ContactMode::frictionless,
    fingertip::fem_reference::Strain strain = fingertip::fem_reference::Strain::linear) {
  fingertip::fem_reference::ReferenceJob job = small_press();
  job.symmetry = fingertip::fem_reference::Symmetry::axisymmetric;
  job.protocol.contact = contact;
  job.strain = strain;
  return job;
}

/// Mesh and press; collective.
class Pressing {
 public:
  explicit Pressing(const fingertip::fem_reference::ReferenceJob& job,
                    std::function<bool()> stop_requested = {})
      : mesh_(job.refinement, sector(job), job.geometry),
        made_(fingertip::fem_reference::ContinuumPress::on(job, mesh_.file(),
                                                           std::move(stop_requested))) {}

  const SharedFolder& folder() const { return mesh_.folder(); }

 private:
  SharedMesh mesh_;
  std::unique_ptr<fingertip::fem_reference::ContinuumPress> made_;

 public:
  fingertip::fem_reference::ContinuumPress& press = *made_;
};

/// The state at the job's last sample, reached in steps of at most `longest_step` (R - r).
inline fingertip::fem_reference::PressState pressed(
    const fingertip::fem_reference::ReferenceJob& job, double longest_step = 0.01) {
  Pressing pressing(job);
  pressing.press.set_longest_step(longest_step);
  return pressing.press.advance(job.protocol.samples.back());
}
