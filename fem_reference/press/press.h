/// A static press of the elastic tip on the rigid plane, sample by sample. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "fem_reference/job/press_state.h"
#include "fem_reference/job/run_tables.h"
#include "fem_reference/press/press_course.h"

namespace fingertip::fem_reference::inline press {

struct PressSnapshot;

/// A tip under a plane that comes nearer, in equilibrium; a rubber that relaxes is in time, without
/// inertia, under a plane that moves along the path at the job's speed from first touch on.
///
/// Computed is its meridian when the job is axisymmetric, a quarter of it when nothing else breaks
/// the symmetry, a half (y >= 0) when it is tilted or moved laterally; so of a solid that is its
/// own mirror image, of others the whole. All processes of MPI_COMM_WORLD take part in every call.
class ContinuumPress {
 public:
  static constexpr double usual_relaxing_step = 1.0 / 64.0;

  /// Reads the first mesh, which must be of the sector that `sector(job)` names. Throws
  /// InvalidInput for a mesh that cannot be read.
  static std::unique_ptr<ContinuumPress> on(const ReferenceJob& job,
                                            const std::filesystem::path& mesh_file,
                                            std::function<bool()> stop_requested = {});
  /// By which forces of such a job may be off, over themselves, for the steps of a way that is
  /// known from mesh to mesh; 0 where its steps are the usual ones or do not matter. Compared with
  /// usual steps on every mesh: MEASUREMENTS.md, The known way.
  static double step_error(const ReferenceJob& job);

  virtual ~ContinuumPress() = default;
  ContinuumPress(const ContinuumPress&) = delete;
  ContinuumPress& operator=(const ContinuumPress&) = delete;

  virtual MeshSummary mesh() const = 0;

  /// Longest step in units of R - r; at first 0.01, or 0.1 where nothing sticks. Where the way is
  /// kept from mesh to mesh, steps are up to twice as long by the job's tolerance.
  void set_longest_step(double step) { steps_.longest = step; }
  /// Longest step of a rubber that relaxes, over the time since first touch or since the program's
  /// stage began; at first `usual_relaxing_step`, with which forces at large strain are within 0.03
  /// % of those of ever smaller steps, at small strain within 0.01 %.
  void set_relaxing_step(double share) { steps_.of_relaxing = share; }

  /// Moves on to `place` [m] of the job's PressCourse, at least the present one. Throws
  /// NotConverged, or Interrupted once `stop_requested` says so; both leave the press at the last
  /// step that converged.
  PressState advance(double place);

  /// Refines the mesh and starts anew from rest. `wanted` has one flag per sample so far; empty
  /// means all. Refined are the elements with the largest error indicators of the wanted samples,
  /// which together carry `share` of the squared error (Kelly's estimate: jumps of the
  /// displacement's normal derivative across faces; each sample's normalised by its sum), and those
  /// at contact edges: all that are too coarse for the contact's radius, and of samples wanted by
  /// name every one.
  /// False, and the press cannot go on, when the mesh would exceed the job's `max_unknowns`.
  virtual bool refine(double share, const std::vector<char>& wanted = {}) = 0;

  /// The last sample, to be written later but before the mesh is refined.
  virtual std::shared_ptr<const PressSnapshot> snapshot() const = 0;
  /// VTU of a sample: displacement [m], stress, von Mises stress [Pa], and on the contact surface
  /// pressure and shear of the plane [Pa] and status (0 open, 1 stick, 2 slide).
  virtual void write_fields(const PressSnapshot& state,
                            const std::filesystem::path& file) const = 0;
  /// The mesh's edges in the plane y = 0 at a sample, complete on the first process.
  virtual std::vector<SectionRow> section(const PressSnapshot& state) const = 0;

  /// Force with which the rod holds the sector's bond surface at the last sample, from the residual
  /// there, in plane axes [N].
  virtual meshes::Vector3 bond_reaction() const = 0;

  /// Saves or restores mesh, solution, contact state and what the rubber remembers; `folder` must
  /// exist.
  virtual void save(const std::filesystem::path& folder) const = 0;
  virtual void load(const std::filesystem::path& folder) = 0;

 protected:
  ContinuumPress(const ReferenceJob& job, std::function<bool()> stop_requested);

  /// One step to `place` [m]; adds what it cost to `effort`. Throws NotConverged.
  virtual void step(double place, bool sampled, PressEffort& effort) = 0;
  /// From how many coarser meshes the way to `place` [m] is known.
  virtual int meshes_before(double place) const = 0;
  /// Back to the last step that converged.
  virtual void abandon() = 0;
  /// Reads the sample off the present state and remembers where its error is large.
  virtual PressState evaluate() = 0;

  /// Whether what is found on a mesh shortens the way on the next, so that steps may be long: at
  /// large strain, where each step costs several factorisations. A meridian's cost nothing;
  /// friction and relaxation remember more than first touch, and keep their steps: relaxation all,
  /// Coulomb's law their length.
  static bool keeps_way(const ReferenceJob& job);

  const ReferenceJob job_;
  const PressCourse course_;
  const std::function<bool()> stop_requested_;
  double place_ = 0.0;  ///< on the course [m]

 private:
  /// Steps, as fractions of the first sample, of the way so far (contact grows fastest at first
  /// touch), and of R - r; those of a rubber that relaxes as shares of the way from where the stage
  /// began to the next sample, for the rate of strain counts as constant within a step.
  struct Steps {
    double first, growth, longest, of_relaxing = usual_relaxing_step;
  };
  bool frictionless() const { return job_.protocol.contact == meshes::ContactMode::frictionless; }
  bool relaxes() const { return !job_.rubber.relaxation.empty(); }
  bool one_step() const { return frictionless() && job_.strain == Strain::linear && !relaxes(); }
  /// The steps to a sample.
  Steps steps_to(double target) const;
  double next_step(double target, double limit) const;

  Steps steps_;
};

}  // namespace fingertip::fem_reference::inline press
