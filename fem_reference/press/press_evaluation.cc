/// What is read off a converged state: forces, contact, error indicators, refinement.
#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/numerics/error_estimator.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/press/contact_edge.h"
#include "fem_reference/press/press_model.h"
#include "fem_reference/tip/job_mesh.h"

namespace fingertip::fem_reference::inline press {
namespace {

/// A contact edge asks for nodes at least this many to its radius: the radius jumps from node to
/// node, and the force with it.
constexpr double nodes_per_edge_radius = 10.0;

/// Sine of the angle at which a surface leaves the obstacle too steeply for the contact to follow:
/// its edge stays where that begins, at the rim of a pad.
constexpr double steep = 0.7;

/// Excess of a mesh's energy over the sum of its squared error indicators. The solid's is in the
/// factor of safety of MeshHistory::error; a meridian's indicators are smaller for the same error.
/// Found from 480 forces against forces of finer meshes: MEASUREMENTS.md, On the meridian.
template <int dim>
constexpr double excess_energy = dim == 2 ? 2.5 : 1.0;

/// Distance to the nearest other node, averaged over the candidates next to `edge`.
double spacing_around(const std::vector<SurfaceNode>& nodes, double edge, const auto& radius) {
  double sum = 0.0;
  int count = 0;
  for (double band = 0.05; count < 3 && band < 10.0; band *= 2) {
    sum = 0.0, count = 0;
    for (const SurfaceNode& node : nodes) {
      if (std::abs(radius(node.position) - edge) > band * edge) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const SurfaceNode& other : nodes)
        if (&other != &node) nearest = std::min(nearest, (other.position - node.position).norm());
      sum += nearest, ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

template <int dim>
PressState TipPress<dim>::evaluate() {
  PressState state;
  const meshes::PressPose pose = course_.at(place_);
  state.indentation = pose.indentation;
  state.lateral_displacement = pose.lateral;
  state.twist = pose.twist;
  state.active_nodes = contact_->active_nodes();
  state.sliding_nodes = job_.protocol.contact == meshes::ContactMode::coulomb
                            ? int(std::ranges::count(contact_->status(), NodeStatus::slide))
                            : 0;
  solver_->forget();
  if (!job_.rubber.relaxation.empty()) state.time = course_.time(place_);
  if (job_.strain == Strain::finite) {
    state.min_jacobian = system_->min_jacobian;
    if (!point_memory_.empty())  // the last kernel was a step's
      assemble_force(*body_, *make_kernel<dim>(job_, 1.0, 0.0), displacement_, *system_);
    state.energy = system_->energy;
  } else {
    Vector force = body_->fine.vector();
    system_->matrix.vmult(force, displacement_);
    if (!linear_memory_.empty())  // a step's matrix
      force.add(-linear_memory_.stiffening(), linear_memory_.relaxing_force(displacement_));
    state.energy = 0.5 * (force * displacement_);
  }
  add_resultant(state);
  note_indicators(state);
  state.markers = markers_->rows(displacement_);
  return state;
}

template <int dim>
double TipPress<dim>::radius(const meshes::Vector3& position) const {
  return std::hypot(position.x() - centre_.x(), position.y() - centre_.y());
}

template <int dim>
bool TipPress<dim>::is_round() const {
  const bool turned =
      job_.protocol.tilt != 0.0 || job_.protocol.lateral_range() != std::pair(0.0, 0.0);
  return !job_.geometry.solid && !turned && job_.protocol.obstacle.on_axis();
}

template <int dim>
void TipPress<dim>::add_resultant(PressState& state) const {
  const double sectors = copies(sector_);
  state.energy *= sectors;
  const std::vector<SurfaceNode>& nodes = contact_->unknowns().nodes;
  const bool finite = job_.strain == Strain::finite;
  // Large strain: true pressure on the deformed surface, moments at deformed positions.
  const std::vector<double> seen = seen_areas(*body_, nodes, finite ? &displacement_ : nullptr);
  const std::vector<meshes::Vector3> moved =
      finite ? displacements(nodes)
             : std::vector<meshes::Vector3>(nodes.size(), meshes::Vector3::Zero());
  const Eigen::AngleAxisd to_rod(job_.protocol.tilt, meshes::Vector3::UnitY());
  const meshes::Vector3 endpoint = to_rod.inverse() * job_.geometry.rod_endpoint();
  meshes::Vector3 force = meshes::Vector3::Zero(), torque = force;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const meshes::Vector3 push = contact_->reaction(i);
    force += push;
    torque += (nodes[i].position + moved[i] - endpoint).cross(push);
  }
  std::vector<double> squares;
  if constexpr (Kinematics<dim>::revolved)
    squares = mean_squares(*body_, nodes, finite ? &displacement_ : nullptr);
  PushedNodes pushed{.nodes = pushed_nodes(*contact_, moved, seen, squares),
                     .sectors = int(sectors),
                     .meridian = Kinematics<dim>::revolved};
  state.normal_force = -sectors * force.z();
  torque = to_rod * torque;
  // What breaks no symmetry vanishes.
  const bool whole = sector_ == meshes::Sector::full,
             along_x = whole || sector_ == meshes::Sector::half;
  state.lateral_force_x = along_x ? sectors * force.x() : 0.0;
  state.torque_y = along_x ? sectors * torque.y() : 0.0;
  state.lateral_force_y = whole ? force.y() : 0.0;
  state.torque_x = whole ? torque.x() : 0.0;
  state.torque_z = whole || Kinematics<dim>::revolved ? torque.z() : 0.0;
  if (!pushed.nodes.empty())
    pushed.spacing = spacing_around(outer_nodes_, outermost(),
                                    [this](const meshes::Vector3& at) { return radius(at); });
  measure_contact(state, pushed);
  state.spin_torque = spin_torque(state.contact);
}

template <int dim>
double TipPress<dim>::outermost() const {
  double result = 0.0;
  for (std::size_t i = 0; i < contact_->status().size(); ++i)
    if (contact_->status()[i] != NodeStatus::open)
      result = std::max(result, radius(contact_->unknowns().nodes[i].position));
  return result;
}

template <int dim>
double TipPress<dim>::half_width() const {
  // A ball's contact with a plane is round, whatever its tilt.
  if (is_round() || (job_.geometry.is_dome() && job_.protocol.obstacle.on_axis()))
    return outermost();
  meshes::Vector3 low = meshes::Vector3::Constant(std::numeric_limits<double>::infinity()),
                  high = -low;
  for (std::size_t i = 0; i < contact_->status().size(); ++i) {
    if (contact_->status()[i] == NodeStatus::open) continue;
    // With its images in the planes of symmetry.
    meshes::Vector3 at = contact_->unknowns().nodes[i].position, image = at;
    if (sector_ != meshes::Sector::full) image.y() = -at.y();
    if (sector_ == meshes::Sector::quarter) image.x() = -at.x();
    low = low.cwiseMin(at).cwiseMin(image);
    high = high.cwiseMax(at).cwiseMax(image);
  }
  return std::max(0.0, 0.5 * (high - low).head<2>().minCoeff());
}

template <int dim>
bool TipPress<dim>::edge_moves_among(const std::vector<std::size_t>& candidates) const {
  const std::vector<SurfaceNode>& nodes = contact_->unknowns().nodes;
  const auto is_open = [this](std::size_t i) { return contact_->status()[i] == NodeStatus::open; };
  for (const std::size_t i : candidates) {
    if (!is_open(i)) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::size_t j : candidates)
      if (!is_open(j)) nearest = std::min(nearest, (nodes[i].position - nodes[j].position).norm());
    if (contact_->gap(i) < steep * nearest && std::isfinite(nearest)) return true;
  }
  return false;
}

template <int dim>
void TipPress<dim>::note_indicators(PressState& state) {
  Marks marks;
  dealii::Vector<float>& now = marks.indicators;
  now.reinit(body_->triangulation.n_active_cells());
  marks.edge.reinit(now.size());
  // The estimator squares this factor: a face of the meridian counts all around.
  const dealii::ScalarFunctionFromFunctionObject<dim> around(
      [](const dealii::Point<dim>& p) { return std::sqrt(circumference(p)); });
  dealii::KellyErrorEstimator<dim>::estimate(
      body_->mapping, body_->fine.dofs, dealii::QGauss<dim - 1>(unsigned(job_.degree) + 1), {},
      body_->fine.ghosted(displacement_), now, dealii::ComponentMask(), &around, 1,
      body_->triangulation.locally_owned_subdomain());
  double sum = 0.0;
  for (float& value : now) sum += double(value *= value);
  sum = dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  if (sum > 0.0) now *= float(1.0 / sum);
  state.indicator = excess_energy<dim> * copies(sector_) * job_.rubber.shear_modulus * sum;

  std::map<long, std::size_t> candidates;
  for (std::size_t i = 0; i < contact_->status().size(); ++i)
    candidates[contact_->unknowns().nodes[i].unknown[2]] = i;
  const double edge = half_width();
  std::vector<dealii::types::global_dof_index> indices(body_->fine.element.n_dofs_per_cell());
  for (const auto& cell : body_->fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned() || !cell->at_boundary()) continue;
    cell->get_dof_indices(indices);
    for (const unsigned face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() ||
          cell->face(face)->boundary_id() != dealii::types::boundary_id(meshes::PhysicalTag::outer))
        continue;
      std::vector<std::size_t> nodes;
      for (unsigned i = 0; i < indices.size(); ++i) {
        const auto found = candidates.find(long(indices[i]));
        if (found != candidates.end() && body_->fine.element.has_support_on_face(i, face))
          nodes.push_back(found->second);
      }
      if (!edge_moves_among(nodes)) continue;
      const double spacing = cell->face(face)->diameter() / std::sqrt(dim - 1.0) / job_.degree;
      marks.edge[cell->active_cell_index()] = spacing > edge / nodes_per_edge_radius ? 1.0F : 0.5F;
    }
  }
  state.free_edge = dealii::Utilities::MPI::max(marks.edge.linfty_norm(), MPI_COMM_WORLD) > 0.0F;
  marks_.push_back(std::move(marks));
}

template <int dim>
bool TipPress<dim>::refine(double share, const std::vector<char>& wanted) {
  const bool all = wanted.empty();
  dealii::Vector<float> indicators(body_->triangulation.n_active_cells());
  std::vector<char> at_edge(indicators.size(), 0);
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    if (!all && !wanted[i]) continue;
    for (unsigned k = 0; k < indicators.size(); ++k) {
      indicators[k] = std::max(indicators[k], marks_[i].indicators[k]);
      // A sample whose force is not known well enough needs a finer edge, however fine it is.
      if (marks_[i].edge[k] > (all ? 0.75F : 0.25F)) at_edge[k] = 1;
    }
  }
  dealii::parallel::distributed::GridRefinement::refine_and_coarsen_fixed_fraction(
      body_->triangulation, indicators, share, 0.0);
  for (const auto& cell : body_->triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && at_edge[cell->active_cell_index()]) cell->set_refine_flag();
  body_->triangulation.prepare_coarsening_and_refinement();
  std::vector<Vector> known;
  for (const auto& [place, state] : way_.points()) known.push_back(body_->fine.ghosted(state));
  Transfer<dim> transfer(body_->fine.dofs);
  if (!known.empty())
    transfer.prepare_for_coarsening_and_refinement(pointers_to(std::as_const(known)));
  body_->triangulation.execute_coarsening_and_refinement();
  body_->number(tip_supports<dim>(body_->components()));
  if (double(body_->unknowns()) > job_.max_unknowns) return false;
  std::vector<Vector> carried(known.size(), body_->fine.vector());
  auto targets = pointers_to(carried);
  if (!carried.empty()) transfer.interpolate(targets);
  const int meshes = way_.meshes() + 1;
  KnownWay::Points points;
  for (const auto& [place, state] : way_.points()) {
    Vector& here = carried[points.size()];
    body_->fine.constraints.distribute(here);
    points.emplace(place, here);
  }
  prepare();
  if (!points.empty()) way_ = KnownWay(meshes, std::move(points), 0.0, displacement_);
  return true;
}

template PressState TipPress<2>::evaluate();
template PressState TipPress<3>::evaluate();
template double TipPress<2>::radius(const meshes::Vector3&) const;
template double TipPress<3>::radius(const meshes::Vector3&) const;
template bool TipPress<2>::is_round() const;
template bool TipPress<3>::is_round() const;
template double TipPress<2>::outermost() const;
template double TipPress<3>::outermost() const;
template bool TipPress<2>::edge_moves_among(const std::vector<std::size_t>&) const;
template bool TipPress<3>::edge_moves_among(const std::vector<std::size_t>&) const;
template double TipPress<2>::half_width() const;
template double TipPress<3>::half_width() const;
template bool TipPress<2>::refine(double, const std::vector<char>&);
template bool TipPress<3>::refine(double, const std::vector<char>&);

}  // namespace fingertip::fem_reference::inline press
