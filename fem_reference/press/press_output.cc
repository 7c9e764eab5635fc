/// Files for ParaView, the section, and checkpoints of a press.
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/numerics/data_out.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/job/processes.h"
#include "fem_reference/output/press_fields.h"
#include "fem_reference/press/press_model.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline press {
namespace {

using Json = nlohmann::json;
using namespace dealii::DataComponentInterpretation;

/// What cells or their points know, as fields of an element, so that it travels with the mesh.
template <int dim>
class TravellingFields {
 public:
  TravellingFields(const dealii::FiniteElement<dim>& element,
                   const Triangulation<dim>& triangulation)
      : dofs_(triangulation) {
    dofs_.distribute_dofs(element);
  }
  const dealii::DoFHandler<dim>& dofs() const { return dofs_; }
  Vector zero() const { return Vector(dofs_.locally_owned_dofs(), MPI_COMM_WORLD); }
  /// Calls action(cell, unknowns) for this process's cells.
  void for_each_cell(auto action) const {
    std::vector<dealii::types::global_dof_index> unknowns(dofs_.get_fe().n_dofs_per_cell());
    for (const auto& cell : dofs_.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      cell->get_dof_indices(unknowns);
      action(cell->active_cell_index(), unknowns);
    }
  }
  /// A field whose entries `fill` sets; it knows the neighbours' entries, too.
  Vector filled(auto fill) const {
    Vector own = zero();
    fill(own);
    own.compress(dealii::VectorOperation::insert);
    dealii::IndexSet relevant;
    dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
    Vector result(dofs_.locally_owned_dofs(), relevant, MPI_COMM_WORLD);
    result = own;
    return result;
  }

 private:
  dealii::DoFHandler<dim> dofs_;
};

/// For error indicators: one value per cell.
template <int dim>
TravellingFields<dim> cell_fields(const Body<dim>& body) {
  return {dealii::FE_DGQ<dim>(0), body.triangulation};
}

/// For stresses: the element's nodes are the quadrature points.
template <int dim>
TravellingFields<dim> point_fields(const Body<dim>& body) {
  const dealii::QGauss<1> points(unsigned(body.degree()) + 1);
  return {dealii::FESystem<dim>(dealii::FE_DGQArbitraryNodes<dim>(points), 6), body.triangulation};
}

/// Calls action(entry, unknown) for every entry of a stress.
template <int dim>
void for_each_entry(const TravellingFields<dim>& fields, auto& stresses, auto action) {
  fields.for_each_cell([&](unsigned cell, const auto& unknowns) {
    auto values = stresses.of_cell(cell);
    for (unsigned q = 0; q < stresses.points; ++q)
      for (unsigned c = 0; c < 6; ++c)
        action(values(c, q), unknowns[fields.dofs().get_fe().component_to_system_index(c, q)]);
  });
}

Json to_json(const Eigen::VectorXd& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

Eigen::VectorXd vector_from(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

}  // namespace

template <int dim>
std::shared_ptr<const PressSnapshot> TipPress<dim>::snapshot() const {
  return std::make_shared<PressSnapshot>(PressSnapshot{
      displacement_, contact_->committed(), {linear_memory_.past(), point_memory_.past()}});
}

template <int dim>
void TipPress<dim>::write_fields(const PressSnapshot& state,
                                 const std::filesystem::path& file) const {
  const Vector u = body_->fine.ghosted(state.displacement);
  const bool finite = job_.strain == Strain::finite;  // then pressure is per deformed area
  PlaneContact then = *contact_;
  then.restore(state.contact);
  const ContactField<dim> contact(*body_, then,
                                  outer_area(*body_, finite ? &state.displacement : nullptr));
  const StressField<dim> stress(*body_, job_, state.displacement, state.remembered);
  FieldOutput<dim> out;
  std::vector<std::string> names(dim, "displacement");
  std::vector<DataComponentInterpretation> kinds(dim, component_is_part_of_vector);
  names.resize(std::size_t(body_->components()), "displacement_around_axis");
  kinds.resize(names.size(), component_is_scalar);
  out.add_data_vector(body_->fine.dofs, u, names, kinds);
  stress.add_to(out);
  contact.add_to(out);
  out.build_patches(body_->mapping, unsigned(job_.degree),
                    dealii::DataOut<dim>::curved_inner_cells);
  out.write(file, job_.field_sectors);
}

template <int dim>
std::vector<SectionRow> TipPress<dim>::section(const PressSnapshot& state) const {
  const Vector u = body_->fine.ghosted(state.displacement);
  std::vector<std::array<double, 8>> own;
  const auto take = [&](const auto& line) {
    std::array<double, 8> edge{};
    for (unsigned end = 0; end < 2; ++end)
      for (unsigned k = 0; k < 2; ++k) {
        const unsigned component = k * (dim - 1);  // across and along the axis
        edge[2 * end + k] = line->vertex(end)[component];
        edge[4 + 2 * end + k] =
            line->vertex(end)[component] + u[line->vertex_dof_index(end, component)];
      }
    own.push_back(edge);
  };
  // Where the sides of a face of the surface cross the plane, by their displacements in between.
  const auto cross = [&](const auto& face) {
    std::array<double, 8> edge{};
    unsigned found = 0;
    for (unsigned l = 0; l < 4 && found < 2; ++l) {
      const auto& line = face->line(l);
      const double from = line->vertex(0)[1], to = line->vertex(1)[1];
      if ((from < 0.0) == (to < 0.0)) continue;
      const double share = from / (from - to);
      for (unsigned k = 0; k < 2; ++k) {
        const unsigned component = 2 * k;
        const auto between = [&](double a, double b) { return a + share * (b - a); };
        edge[2 * found + k] = between(line->vertex(0)[component], line->vertex(1)[component]);
        edge[4 + 2 * found + k] =
            edge[2 * found + k] + between(u[line->vertex_dof_index(0, component)],
                                          u[line->vertex_dof_index(1, component)]);
      }
      ++found;
    }
    if (found == 2) own.push_back(edge);
  };
  const auto in_section = [](const auto& face) {
    return face->at_boundary() &&
           face->boundary_id() == dealii::types::boundary_id(meshes::PhysicalTag::symmetry_y);
  };
  for (const auto& cell : body_->fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const auto& face : cell->face_iterators()) {
      if constexpr (dim == 2) {
        take(face);
      } else if (in_section(face)) {
        for (unsigned l = 0; l < 4; ++l) take(face->line(l));
      } else if (sector_ == meshes::Sector::full && face->at_boundary()) {
        cross(face);
      }
    }
  }
  std::vector<SectionRow> edges;
  for (const auto& part : dealii::Utilities::MPI::gather(MPI_COMM_WORLD, own))
    for (const auto& e : part)
      edges.push_back({{e[0], e[1], e[2], e[3]}, {e[4], e[5], e[6], e[7]}});
  return edges;
}

template <int dim>
void TipPress<dim>::save(const std::filesystem::path& folder) const {
  const TravellingFields<dim> cells = cell_fields(*body_), points = point_fields(*body_);
  std::vector<Vector> displacements = {body_->fine.ghosted(displacement_)};
  for (const Vector& branch : linear_memory_.branches())
    displacements.push_back(body_->fine.ghosted(branch));
  std::vector<double> way;
  for (const auto& [place, state] : way_.points()) {
    way.push_back(place);
    displacements.push_back(body_->fine.ghosted(state));
  }
  if (!way.empty()) displacements.push_back(body_->fine.ghosted(way_.difference()));
  std::vector<Vector> marks;
  for (const Marks& sample : marks_)
    for (const auto* values : {&sample.indicators, &sample.edge})
      marks.push_back(cells.filled([&](Vector& own) {
        cells.for_each_cell(
            [&](unsigned cell, const auto& unknown) { own[unknown[0]] = double((*values)[cell]); });
      }));
  Transfer<dim> displacement_transfer(body_->fine.dofs), cell_transfer(cells.dofs());
  displacement_transfer.prepare_for_serialization(pointers_to(std::as_const(displacements)));
  if (!marks.empty()) cell_transfer.prepare_for_serialization(pointers_to(std::as_const(marks)));
  Transfer<dim> point_transfer(points.dofs());
  std::vector<Vector> stresses;
  for (const PointStresses* field : point_memory_.stresses())
    stresses.push_back(points.filled([&](Vector& own) {
      for_each_entry(points, *field, [&](double value, auto unknown) { own[unknown] = value; });
    }));
  if (!stresses.empty())
    point_transfer.prepare_for_serialization(pointers_to(std::as_const(stresses)));
  body_->triangulation.save((folder / "mesh").string());
  if (!first_process()) return;
  const PlaneContact::State& state = contact_->committed();
  std::vector<int> status;
  for (const NodeStatus node : state.status) status.push_back(int(node));
  const Json json{{"place", place_},
                  {"samples", marks_.size()},
                  {"way", way},
                  {"meshes_before", way_.meshes()},
                  {"status", status},
                  {"anchors", state.anchors},
                  {"feet", state.feet},
                  {"displacement", to_json(state.displacement)},
                  {"reaction", to_json(state.reaction)}};
  meshes::write_atomically(folder / "contact.json", [&](std::ostream& out) { out << json; });
}

template <int dim>
void TipPress<dim>::load_marks(std::size_t samples) {
  marks_.assign(samples, {});
  if (samples == 0) return;
  const TravellingFields<dim> cells = cell_fields(*body_);
  const dealii::Vector<float> empty(body_->triangulation.n_active_cells());
  std::vector<Vector> fields(2 * samples, cells.zero());
  auto list = pointers_to(fields);
  Transfer<dim> transfer(cells.dofs());
  transfer.deserialize(list);
  for (std::size_t i = 0; i < samples; ++i) {
    marks_[i] = {empty, empty};
    cells.for_each_cell([&](unsigned cell, const auto& unknown) {
      marks_[i].indicators[cell] = float(double(fields[2 * i][unknown[0]]));
      marks_[i].edge[cell] = float(double(fields[2 * i + 1][unknown[0]]));
    });
  }
}

template <int dim>
void TipPress<dim>::load_stresses() {
  if (point_memory_.empty()) return;
  const TravellingFields<dim> points = point_fields(*body_);
  const std::vector<PointStresses*> stresses = point_memory_.stresses();
  std::vector<Vector> fields(stresses.size(), points.zero());
  auto list = pointers_to(fields);
  Transfer<dim>(points.dofs()).deserialize(list);
  for (std::size_t i = 0; i < fields.size(); ++i)
    for_each_entry(points, *stresses[i],
                   [&](double& value, auto unknown) { value = fields[i][unknown]; });
}

template <int dim>
void TipPress<dim>::load(const std::filesystem::path& folder) {
  body_->triangulation.load((folder / "mesh").string());
  body_->number(tip_supports<dim>(body_->components()));
  prepare();
  std::ostringstream text;
  if (first_process()) text << std::ifstream(folder / "contact.json").rdbuf();
  const Json json = Json::parse(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, text.str()));
  std::vector<Vector*> displacements = {&displacement_};
  for (Vector& branch : linear_memory_.branches()) displacements.push_back(&branch);
  const auto places = json.at("way").get<std::vector<double>>();
  std::vector<Vector> way(places.empty() ? 0 : places.size() + 1, body_->fine.vector());
  for (Vector& state : way) displacements.push_back(&state);
  Transfer<dim>(body_->fine.dofs).deserialize(displacements);
  load_marks(json.at("samples").get<std::size_t>());
  load_stresses();

  place_ = json.at("place").get<double>();
  KnownWay::Points points;
  for (std::size_t i = 0; i < places.size(); ++i) points.emplace(places[i], way[i]);
  if (!places.empty())
    way_ = KnownWay(json.at("meshes_before").get<int>(), std::move(points), place_, way.back());
  PlaneContact::State state;
  state.pose = pose(place_);
  for (const int node : json.at("status").get<std::vector<int>>())
    state.status.push_back(NodeStatus(node));
  state.anchors = json.at("anchors").get<std::vector<std::array<double, 3>>>();
  state.feet = json.at("feet").get<std::vector<std::array<double, 2>>>();
  state.displacement = vector_from(json.at("displacement"));
  state.reaction = vector_from(json.at("reaction"));
  if (state.status.size() != contact_->unknowns().nodes.size() ||
      state.displacement.size() != Eigen::Index(contact_->unknowns().unknowns.size()))
    throw meshes::InvalidInput({"checkpoint", folder.string(), "must belong to the same job",
                                "delete it and start the run anew"});
  contact_->restore(std::move(state));
}

#define FINGERTIP_INSTANTIATE(dim)                                                              \
  template std::shared_ptr<const PressSnapshot> TipPress<dim>::snapshot() const;                \
  template void TipPress<dim>::write_fields(const PressSnapshot&, const std::filesystem::path&) \
      const;                                                                                    \
  template std::vector<SectionRow> TipPress<dim>::section(const PressSnapshot&) const;          \
  template void TipPress<dim>::save(const std::filesystem::path&) const;                        \
  template void TipPress<dim>::load(const std::filesystem::path&);
FINGERTIP_INSTANTIATE(2)
FINGERTIP_INSTANTIATE(3)
#undef FINGERTIP_INSTANTIATE

}  // namespace fingertip::fem_reference::inline press
