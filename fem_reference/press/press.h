/// A static press of the elastic tip on the rigid plane, sample by sample. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "fem_reference/job/job.h"
#include "fem_reference/press/press_state.h"

namespace fingertip::fem_reference::inline press {

struct PressSnapshot;

/// A tip under a plane that comes nearer, in equilibrium; a rubber that relaxes is in time, without
/// inertia, under a plane that moves along the path at the job's speed from first touch on.
///
/// Computed is its meridian when the job is axisymmetric, a quarter of it when nothing else breaks
/// the symmetry, a half (y >= 0) when it is tilted or moved laterally; a solid as a whole.
/// All processes of MPI_COMM_WORLD take part in every call.
class ContinuumPress {
 public:
  /// Reads the first mesh, which must be of the sector that `sector(job)` names. Throws
  /// InvalidInput for a mesh that cannot be read.
  ContinuumPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                 std::function<bool()> stop_requested = {});
  ~ContinuumPress();
  static constexpr double usual_relaxing_step = 1.0 / 64.0;
  ContinuumPress(const ContinuumPress&) = delete;
  ContinuumPress& operator=(const ContinuumPress&) = delete;

  MeshSummary mesh() const;

  /// Longest step in units of R - r; at first 0.01, or 0.1 where nothing sticks.
  void set_longest_step(double step);
  /// Longest step of a rubber that relaxes, over the time since first touch or since the program's
  /// stage began; at first `usual_relaxing_step`, with which forces at large strain are within 0.03
  /// % of those of ever smaller steps, at small strain within 0.01 %.
  void set_relaxing_step(double share);

  /// Moves on to `place` [m] of the job's PressCourse, at least the present one. Throws
  /// NotConverged, which leaves the press at the last step that converged; Interrupted between
  /// steps once `stop_requested` says so.
  PressState advance(double place);

  /// Refines the mesh and starts anew from rest. `wanted` has one flag per sample so far; empty
  /// means all. Refined are the elements with the largest error indicators of the wanted samples,
  /// which together carry `share` of the squared error (Kelly's estimate: jumps of the
  /// displacement's normal derivative across faces; each sample's normalised by its sum), and those
  /// at contact edges: all that are too coarse for the contact's radius, and of samples wanted by
  /// name every one.
  /// False, and the press cannot go on, when the mesh would exceed the job's `max_unknowns`.
  bool refine(double share, const std::vector<char>& wanted = {});

  /// The last sample, to be written later but before the mesh is refined.
  std::shared_ptr<const PressSnapshot> snapshot() const;
  /// VTU of a sample: displacement [m], stress, von Mises stress [Pa], and on the contact surface
  /// pressure and shear of the plane [Pa] and status (0 open, 1 stick, 2 slide).
  void write_fields(const PressSnapshot& state, const std::filesystem::path& file) const;
  /// The mesh's edges in the plane y = 0 at a sample, complete on the first process.
  std::vector<SectionEdge> section(const PressSnapshot& state) const;

  /// Force with which the rod holds the sector's bond surface at the last sample, from the residual
  /// there, in plane axes [N].
  meshes::Vector3 bond_reaction() const;

  /// Saves or restores mesh, solution, contact state and what the rubber remembers; `folder` must
  /// exist.
  void save(const std::filesystem::path& folder) const;
  void load(const std::filesystem::path& folder);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::fem_reference::inline press
