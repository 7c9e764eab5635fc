/// The press on a mesh: body, material, solver and contact, and how they make a step. deal.II's
/// side of ContinuumPress.
#pragma once

#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/numerics/data_component_interpretation.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fem_reference/contact/plane_contact.h"
#include "fem_reference/elements/memory.h"
#include "fem_reference/output/press_fields.h"
#include "fem_reference/press/known_way.h"
#include "fem_reference/press/marker_field.h"
#include "fem_reference/press/press.h"
#include "fem_reference/solvers/field_solver.h"
#include "fem_reference/tip/tip_body.h"

namespace fingertip::fem_reference::inline press {

/// Carries fields to a refined mesh, or through a file.
template <int dim>
using Transfer = dealii::parallel::distributed::SolutionTransfer<dim, Vector>;

/// What it takes: of a const list pointers to const fields.
template <typename Fields>
auto pointers_to(Fields& fields) {
  std::vector<decltype(fields.data())> list;
  for (auto& field : fields) list.push_back(&field);
  return list;
}

/// A sample's state, to be written while the mesh is the same.
struct PressSnapshot {
  Vector displacement;
  PlaneContact::State contact;
  RememberedStress remembered;
};

/// A solid, or a body of revolution on its meridian.
template <int dim>
class TipPress final : public ContinuumPress {
 public:
  TipPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
           std::function<bool()> stop_requested);

  MeshSummary mesh() const override;
  bool refine(double share, const std::vector<char>& wanted) override;
  std::shared_ptr<const PressSnapshot> snapshot() const override;
  void write_fields(const PressSnapshot& state, const std::filesystem::path& file) const override;
  std::vector<SectionRow> section(const PressSnapshot& state) const override;
  meshes::Vector3 bond_reaction() const override;
  void save(const std::filesystem::path& folder) const override;
  void load(const std::filesystem::path& folder) override;

 private:
  void step(double place, bool sampled, PressEffort& effort) override;
  int meshes_before(double place) const override { return way_.reaches(place) ? way_.meshes() : 0; }
  void abandon() override { contact_->abandon(); }
  PressState evaluate() override;
  /// Chooses the solver of the numbered mesh, and puts the tip at rest under the plane.
  void prepare();
  std::unique_ptr<FieldSolver> make_solver(const std::vector<long>& contact_unknowns) const;
  PlanePose pose(double place) const;
  /// The material of a step of that length [s]; of a rubber that relaxes it depends on both.
  void prepare_step(double duration);
  void linear_step(const PlanePose& target, PressEffort& effort);
  /// Where Newton's method starts from; contact starts from what is expected at `place`.
  Vector foreseen(double place);
  void newton_step(double place, bool sampled, PressEffort& effort);
  Eigen::VectorXd at_contact(const Vector& field) const;
  /// Assembles the force at `displacement`; force of the system minus the plane's forces, where
  /// nothing is held, over the largest nodal force. Notes how far what touches is off the obstacle.
  double residual(const Vector& displacement, const PlanePose& target);
  std::vector<meshes::Vector3> displacements(const std::vector<SurfaceNode>& nodes) const;
  void check_other_nodes(double place) const;
  /// From where contact starts, across the press [m].
  double radius(const meshes::Vector3& position) const;
  /// Whether contact is a disc about the axis.
  bool is_round() const;
  void add_resultant(PressState& state) const;
  double outermost() const;  ///< reference radius of the farthest node that touches [m]
  /// Whether among the candidates on an element's face those that touch end, and not at a rim.
  bool edge_moves_among(const std::vector<std::size_t>& candidates) const;
  double half_width() const;  ///< of the contact where it is narrowest, in the reference [m]
  void note_indicators(PressState& state);
  void load_marks(std::size_t samples);
  void load_stresses();

  meshes::Sector sector_;
  double touch_;            ///< height of the obstacle's top at first touch [m]
  meshes::Vector3 centre_;  ///< of the contact, in plane axes; the dome's is its own [m]
  std::unique_ptr<Body<dim>> body_;
  std::unique_ptr<ElementKernel<dim>> kernel_;
  std::unique_ptr<LinearSystem> system_;
  std::unique_ptr<FieldSolver> solver_;
  std::unique_ptr<PlaneContact> contact_;
  std::vector<SurfaceNode> outer_nodes_;
  std::optional<MarkerField<dim>> markers_;
  LinearSolver solver_kind_ = LinearSolver::automatic;
  Vector displacement_;              ///< of the last converged step
  LinearMemory<dim> linear_memory_;  ///< of that step, at small strain
  PointMemory<dim> point_memory_;    ///< at large strain
  double off_surface_ = 0.0;         ///< [m]
  KnownWay way_;
  /// Where a sample asks for smaller elements, per local cell.
  struct Marks {
    dealii::Vector<float> indicators;  ///< squared error indicators over their sum
    dealii::Vector<float> edge;  ///< at the contact edge: 1 too coarse, 0.5 fine enough; else 0
  };
  std::vector<Marks> marks_;  ///< of the samples so far
};

}  // namespace fingertip::fem_reference::inline press
