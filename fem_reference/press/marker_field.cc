#include "fem_reference/press/marker_field.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/tip/job_mesh.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline press {
namespace {

using meshes::Vector3;

constexpr double nowhere = std::numeric_limits<double>::max();
/// Of an element's sides beyond its corners, over its diameter: of a quarter of a circle 0.11.
constexpr double side_bulge = 0.15;

/// A place on the mesh, and how displacements in space at it become the finger's.
template <int dim>
struct MeshPlace {
  dealii::Point<dim> at;
  Eigen::Matrix3d to_finger;
};

template <int dim>
MeshPlace<dim> mesh_place(const Vector3& marker, const ReferenceJob& job) {
  const Eigen::Matrix3d to_finger =
      Eigen::AngleAxisd(job.protocol.tilt, Vector3::UnitY()).toRotationMatrix();
  Vector3 at = to_finger.transpose() * marker;
  if constexpr (Kinematics<dim>::revolved) {
    const double around = std::atan2(at.y(), at.x());
    return {{std::hypot(at.x(), at.y()), at.z()},
            Eigen::AngleAxisd(around, Vector3::UnitZ()).toRotationMatrix()};
  } else {
    const meshes::Sector part = sector(job);
    Vector3 mirror = Vector3::Ones();
    if (part == meshes::Sector::quarter && at.x() < 0.0) mirror.x() = -1.0;
    if (part != meshes::Sector::full && at.y() < 0.0) mirror.y() = -1.0;
    at = mirror.cwiseProduct(at);
    return {{at.x(), at.y(), at.z()}, to_finger * mirror.asDiagonal()};
  }
}

/// Where an element of this process comes nearest to a place.
template <int dim>
struct InElement {
  double off = nowhere;  ///< distance between both [m]
  CellIterator<dim> cell{};
  dealii::Point<dim> unit;  ///< in the unit element
};

/// Looks for places among the elements of this process.
template <int dim>
class Elements {
 public:
  explicit Elements(const Body<dim>& body) : body_(body) {
    for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      auto box = body.mapping.get_bounding_box(cell);  // of its corners, beyond which sides bulge
      box.extend(side_bulge * cell->diameter());
      all_.emplace_back(box, cell);
    }
  }

  InElement<dim> nearest(const dealii::Point<dim>& at) const {
    // By the distance of their boxes, nearest first, until no other can be nearer.
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const auto& [low, high] = all_[i].first.get_boundary_points();
      double square = 0.0;
      for (unsigned d = 0; d < dim; ++d)
        square += std::pow(std::max({0.0, low[d] - at[d], at[d] - high[d]}), 2);
      order.emplace_back(std::sqrt(square), i);
    }
    std::ranges::make_heap(order, std::ranges::greater());
    InElement<dim> best;
    for (; !order.empty() && order.front().first < best.off; order.pop_back()) {
      const CellIterator<dim>& cell = all_[order.front().second].second;
      try {
        const auto unit = dealii::GeometryInfo<dim>::project_to_unit_cell(
            body_.mapping.transform_real_to_unit_cell(cell, at));
        const double off = at.distance(body_.mapping.transform_unit_to_real_cell(cell, unit));
        if (off < best.off) best = {off, cell, unit};
      } catch (const typename dealii::Mapping<dim>::ExcTransformationFailed&) {
        // Too far away for this element's coordinates.
      }
      std::ranges::pop_heap(order, std::ranges::greater());
    }
    return best;
  }

 private:
  const Body<dim>& body_;
  std::vector<std::pair<dealii::BoundingBox<dim>, CellIterator<dim>>> all_;
};

}  // namespace

template <int dim>
MarkerField<dim>::MarkerField(const Body<dim>& body, const ReferenceJob& job)
    : body_(&body), places_(job.protocol.markers), shares_(places_.size()) {
  if (places_.empty()) return;
  const Elements<dim> elements(body);
  std::vector<InElement<dim>> found;
  std::vector<double> off;
  for (const Vector3& place : places_) {
    found.push_back(elements.nearest(mesh_place<dim>(place, job).at));
    off.push_back(found.back().off);
  }
  // Of processes that come equally near the first one has it.
  const int own = int(dealii::Utilities::MPI::this_mpi_process(body.fine.communicator));
  std::vector<double> least(off.size());
  dealii::Utilities::MPI::min(off, body.fine.communicator, least);
  std::vector<int> bids, owners(off.size());
  for (std::size_t i = 0; i < off.size(); ++i)
    bids.push_back(off[i] <= least[i] ? own : std::numeric_limits<int>::max());
  dealii::Utilities::MPI::min(bids, body.fine.communicator, owners);
  const auto& element = body.fine.element;
  std::vector<dealii::types::global_dof_index> unknowns(element.n_dofs_per_cell());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!(least[i] < nowhere))
      throw meshes::NotConverged(
          "no element of the mesh holds the marker (" + meshes::to_text(places_[i].x()) + ", " +
          meshes::to_text(places_[i].y()) + ", " + meshes::to_text(places_[i].z()) + ") m");
    if (owners[i] != own) continue;
    const Eigen::Matrix3d to_finger = mesh_place<dim>(places_[i], job).to_finger;
    found[i].cell->get_dof_indices(unknowns);
    for (unsigned a = 0; a < unknowns.size(); ++a) {
      const auto axis = Kinematics<dim>::axis[element.system_to_component_index(a).first];
      shares_[i].push_back(
          {unknowns[a], element.shape_value(a, found[i].unit) * to_finger.col(Eigen::Index(axis))});
    }
  }
}

template <int dim>
std::vector<meshes::MarkerRow> MarkerField<dim>::rows(const Vector& displacement) const {
  if (places_.empty()) return {};
  const Vector u = body_->fine.ghosted(displacement);
  std::vector<double> own(3 * places_.size(), 0.0), sums(own.size());
  for (std::size_t i = 0; i < places_.size(); ++i)
    for (const Share& share : shares_[i])
      Eigen::Map<Vector3>(&own[3 * i]) += u[share.unknown] * share.weight;
  dealii::Utilities::MPI::sum(own, body_->fine.communicator, sums);
  std::vector<Vector3> displacements;
  for (std::size_t i = 0; i < places_.size(); ++i) displacements.emplace_back(&sums[3 * i]);
  return meshes::marker_rows(places_, displacements);
}

template class MarkerField<2>;
template class MarkerField<3>;

}  // namespace fingertip::fem_reference::inline press
