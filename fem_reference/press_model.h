/// One press on one mesh: body, material, solver and contact, and how they make a step. deal.II's
/// side of ContinuumPress.
#pragma once

#include <deal.II/numerics/data_component_interpretation.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "fem_reference/field_solver.h"
#include "fem_reference/plane_contact.h"
#include "fem_reference/press.h"
#include "fem_reference/tip_body.h"

namespace fingertip::fem_reference {

class PressModel {
 public:
  PressModel(const ReferenceJob& job, const std::filesystem::path& mesh_file);

  const ReferenceJob& job() const { return job_; }
  /// On the job's path [m].
  double place() const { return place_; }
  MeshSummary mesh() const;

  /// One step to `place` [m]; adds what it cost to `effort`. Throws NotConverged.
  void step(double place, PressState& effort);
  /// Back to the last step that converged.
  void abandon();

  /// Reads the sample off the present state and remembers where its error is large.
  PressState evaluate();
  bool refine(double share, const std::vector<char>& wanted);

  void write_fields(const std::filesystem::path& file) const;
  std::vector<SectionEdge> section() const;
  meshes::Vector3 bond_reaction() const;
  void save(const std::filesystem::path& folder) const;
  void load(const std::filesystem::path& folder);

 private:
  /// Chooses the solver of the numbered mesh, and puts the tip at rest under the plane.
  void prepare();
  PlanePose pose(double place) const;
  void linear_step(const PlanePose& target, PressState& effort);
  void newton_step(const PlanePose& target, PressState& effort);
  /// Assembles at `displacement`; force of the system minus the plane's forces, where nothing is
  /// held, over the largest nodal force.
  double residual(const Vector& displacement);
  void check_other_nodes(double place) const;
  void add_resultant(PressState& state) const;
  void note_indicators(PressState& state);
  void load_marks(std::size_t samples);

  ReferenceJob job_;
  meshes::PressPath path_;
  std::unique_ptr<Body> body_;
  std::unique_ptr<ElementKernel> kernel_;
  std::unique_ptr<LinearSystem> system_;
  std::unique_ptr<FieldSolver> solver_;
  std::unique_ptr<PlaneContact> contact_;
  std::vector<SurfaceNode> outer_nodes_;
  LinearSolver solver_kind_ = LinearSolver::automatic;
  double place_ = 0.0;
  Vector displacement_;  ///< of the last converged step
  /// Where a sample asks for smaller elements, per local cell.
  struct Marks {
    dealii::Vector<float> indicators;  ///< squared error indicators over their sum
    dealii::Vector<float> edge;  ///< at the contact edge: 1 too coarse, 0.5 fine enough; else 0
  };
  std::vector<Marks> marks_;  ///< of the samples so far
};

}  // namespace fingertip::fem_reference
