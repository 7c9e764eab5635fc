/// A press at constant speed, with the rubber's inertia and damping. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "fem_reference/job/press_state.h"
#include "fem_reference/job/run_tables.h"
#include "fem_reference/press/press_course.h"

namespace fingertip::fem_reference::inline motion {

/// The press of ContinuumPress at the job's speed: small strain, frictionless or stick, along the
/// axis, Kelvin-Voigt damping C = tau K of the moduli after long times, relaxation, consistent mass
/// M. In the rod's frame, which is inertial because the rod's speed is constant, the tip starts at
/// rest and the plane comes at that speed, first touching at time 0. A program's rod accelerates by
/// a(t): in its frame -rho a acts on the rubber, and the rod carries its mass. No gravity.
///
/// The force on the rod is the resultant of the bond, including what damping adds; by the balance
/// of momentum it is the plane's force less the rate of the rubber's momentum.
///
/// Time steps: generalised-alpha with rho_inf = 0 (generalised_alpha.h), contact enforced at the
/// end of every step by PlaneContact. Within the interval before a sample all steps have one length
/// and end at the sample; none is longer than 1/400 of R - r over the speed or 1/32 of the sample's
/// time since the stage began. In a hold they grow to 1/32 of the time since it began. All
/// processes of MPI_COMM_WORLD take part in every call.
class TransientPress {
 public:
  /// On the mesh of a quarter or meridian (`sector(job)`), or on one that `ContinuumPress::save`
  /// left in `adapted` for the same `mesh_file` (empty: none). Throws InvalidInput.
  static std::unique_ptr<TransientPress> on(const ReferenceJob& job,
                                            const std::filesystem::path& mesh_file,
                                            const std::filesystem::path& adapted = {},
                                            std::function<bool()> stop_requested = {});
  virtual ~TransientPress() = default;
  TransientPress(const TransientPress&) = delete;
  TransientPress& operator=(const TransientPress&) = delete;

  virtual MeshSummary mesh() const = 0;

  /// Multiplies the longest time step, > 0; 1 at first.
  void set_step_factor(double factor) { step_factor_ = factor; }

  /// Presses on to a place [m] of the job's PressCourse, beyond the present one; without a program
  /// an indentation. Throws NotConverged; Interrupted between steps once `stop_requested` says so.
  PressState advance(double place);

  /// normal_force of the last step once more, from the residual at the bond instead of the balance
  /// of momentum [N].
  virtual double bond_force() const = 0;

  /// Every step so far.
  const std::vector<TransientStep>& steps() const { return steps_; }

  /// VTU of the last step: displacement [m], velocity [m/s] in the rod's frame.
  virtual void write_fields(const std::filesystem::path& file) const = 0;

 protected:
  TransientPress(const ReferenceJob& job, std::function<bool()> stop_requested)
      : job_(job), course_(job.protocol, true), stop_requested_(std::move(stop_requested)) {}

  /// One step to a place [m] of the course that takes `duration` [s].
  virtual void step_to(double place, double duration, PressEffort& effort) = 0;
  virtual PressState evaluate() const = 0;

  const ReferenceJob job_;
  const PressCourse course_;
  double place_ = 0.0;  ///< [m]
  std::vector<TransientStep> steps_{TransientStep{}};

 private:
  const std::function<bool()> stop_requested_;
  double step_factor_ = 1.0;
};

}  // namespace fingertip::fem_reference::inline motion
