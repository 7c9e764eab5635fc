/// What a press yielded on each mesh of a sequence, and how far the finest may be off. Free of
/// deal.II.
#pragma once

#include <functional>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <utility>
#include <vector>

#include "fem_reference/job/press_state.h"
#include "fem_reference/press/force_error.h"

namespace fingertip::fem_reference::inline press {

/// A mesh and the samples computed on it so far, in their order.
struct MeshRecord {
  MeshSummary mesh;
  std::vector<PressState> states;
  double wall_time = 0.0;  ///< of mesh, matrices and samples [s]
};

/// The sequence of meshes, coarse to fine.
class MeshHistory {
 public:
  /// A value of a sample that the meshes tell an error of.
  using Value = double meshes::PressSample::*;

  /// `safety` multiplies every error of a mesh. Forces below `min_share` of the largest need not
  /// be known better than one of that size: where a press ends unloaded, or nearly. `sticks`: all
  /// that touches does.
  explicit MeshHistory(double safety = 1.0, double min_share = 0.0, bool sticks = false)
      : safety_(safety), min_share_(min_share), sticks_(sticks) {}
  /// What the steps in time add to the errors, over the forces of the samples; none at first.
  void set_step_errors(std::vector<double> errors) { step_errors_ = std::move(errors); }
  const std::vector<double>& step_errors() const { return step_errors_; }
  void start_mesh(const MeshSummary& mesh) { meshes_.push_back({mesh, {}, 0.0}); }
  /// Appends the next sample of the finest mesh and estimates its error.
  void add(PressState state);

  const std::vector<MeshRecord>& meshes() const { return meshes_; }
  MeshRecord& finest() { return meshes_.back(); }
  /// Each sample from the finest mesh on which it has been computed, with its error().
  std::vector<PressState> best() const;
  /// Error of sample `index` on the finest mesh that has it: the safety times max(e, m w, b), and
  /// the steps' share; NaN while e is. Where nothing touches the largest force of a coarser mesh.
  ///
  /// e: estimate_force_error with the node spacing h at this sample's contact edge as the measure
  /// of a mesh: adaptive meshes are refined here for one sample and there for another, and a mesh
  /// that is no finer at the edge tells nothing about it. NaN while there is one such spacing only.
  /// Where no edge moves - a pad touches with all of its face - nodes at the edge decide nothing,
  /// and refinement has no reason to go there. Then F is off by what the mesh stores too much,
  /// whose share S/E (below) falls like the square of h: the measure is h = (S/E)^1/2.
  ///
  /// m w: three forces may agree by chance. F is stationary in the contact radius a, which jumps by
  /// up to h, so its noise is of the order w = F (h/a)² at every depth, F h² where no edge moves; m
  /// is the median of e/w over the samples.
  ///
  /// b: no difference shows what no refinement has touched. F is the derivative of the energy E by
  /// the indentation, and a mesh stores too much of it everywhere; as both grow with like powers of
  /// the indentation, F is too large by about the share that E is. So b = 2 F S/E, of what sticks
  /// F S/E, S the finest mesh's indicator (PressState::indicator). Against axisymmetric solutions
  /// the mean excess of solids is 0.4 ... 1.7 F S/E without friction at small strain, -0.9 ... 0.9
  /// with stick. It is no correction: its factor varies with mesh and rubber.
  ForceError error(std::size_t index) const;
  /// Of the contact radius [m] and the largest pressure [Pa], NaN while that of the force is: from
  /// the meshes in the same way, but not less than three floors. Both: the relative error of the
  /// force, of the pressure twice that. Radius: 0.3 node spacings at a free edge. Pressure: 0.2
  /// d²/a² of it, d the node spacing at the peak. Where pressure has no largest value, at a rim
  /// that sticks, it grows with every mesh, and its error with it.
  double radius_error(std::size_t index) const;
  double pressure_error(std::size_t index) const;
  /// Of a vector of the sample, by its parts: the length of e over them, but that its noise may be
  /// of the order h. Under stick a force aside goes with the radius of what sticks, and the torque
  /// of a turn with its cube (meshes::PressSample::set_errors). In h^1/2 that noise is of second
  /// order, as the force's in h, and so this takes the place of h.
  double vector_error(std::size_t index, std::initializer_list<Value> parts) const;
  /// Which of the `best` are off by more than that share of normal_force.
  std::vector<char> beyond(double tolerance) const;
  /// Largest force_error over normal_force; NaN before there is an estimate for every sample.
  double worst_relative_error() const;

  nlohmann::json to_json() const;
  /// With the options of `like`.
  static MeshHistory from_json(const nlohmann::json& json, MeshHistory like = MeshHistory());

 private:
  std::vector<double> relative_errors() const;
  const PressState* finest_state(std::size_t index) const;
  /// e, of a value whose noise is of the order h to that power.
  ForceError mesh_error(std::size_t index, const std::function<double(const PressState&)>& value,
                        double noise = 2.0) const;
  double typical_error(bool free_edge, Value value) const;         ///< m
  ForceError contact_error(std::size_t index, Value value) const;  ///< max(e, m w)

  std::vector<MeshRecord> meshes_;
  double safety_, min_share_;
  bool sticks_;
  std::vector<double> step_errors_;
};

}  // namespace fingertip::fem_reference::inline press
