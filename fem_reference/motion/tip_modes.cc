#include "fem_reference/motion/tip_modes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/data_component_interpretation.h>
#include <deal.II/numerics/data_out.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "fem_reference/output/vtu_output.h"
#include "fem_reference/solvers/eigen_solver.h"
#include "fem_reference/tip/tip_body.h"

namespace fingertip::fem_reference::inline motion {
namespace {

using meshes::PhysicalTag;

/// Share of a mode's kinetic energy below which a motion is discretisation error, not physics.
constexpr double negligible_share = 0.01;

void support_plane(PhysicalTag plane, int normal, Parity parity,
                   std::vector<FixedComponent>& fixed) {
  for (int component = 0; component < 3; ++component)
    if ((component == normal) == (parity == Parity::symmetric))
      fixed.push_back({dealii::types::boundary_id(plane), component});
}

std::vector<FixedComponent> supports(SymmetryClass symmetry) {
  std::vector<FixedComponent> fixed;
  for (int component = 0; component < 3; ++component)
    fixed.push_back({dealii::types::boundary_id(PhysicalTag::bond), component});
  support_plane(PhysicalTag::symmetry_x, 0, symmetry.x, fixed);
  support_plane(PhysicalTag::symmetry_y, 1, symmetry.y, fixed);
  return fixed;
}

/// ∫ u_phi² over ∫ |u|²: the share of the motion that goes around the axis.
double circumferential_share(const Body<3>& body, const Vector& shape) {
  dealii::FEValues<3> values(
      body.mapping, body.fine.element, dealii::QGauss<3>(unsigned(body.degree()) + 1),
      dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
  const Vector u = body.fine.ghosted(shape);
  std::vector<dealii::Vector<double>> at_points(values.n_quadrature_points,
                                                dealii::Vector<double>(3));
  double around = 0.0, all = 0.0;
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    values.get_function_values(u, at_points);
    for (const unsigned q : values.quadrature_point_indices()) {
      const auto& x = values.quadrature_point(q);
      const double across = x[0] * at_points[q][1] - x[1] * at_points[q][0];
      around += values.JxW(q) * across * across / (x[0] * x[0] + x[1] * x[1]);
      all += values.JxW(q) * at_points[q].norm_sqr();
    }
  }
  const MPI_Comm communicator = body.fine.communicator;
  return dealii::Utilities::MPI::sum(around, communicator) /
         dealii::Utilities::MPI::sum(all, communicator);
}

int multiplicity(const Body<3>& body, const Vector& shape, SymmetryClass symmetry) {
  if (symmetry.x != symmetry.y) return 2;  // odd around the axis
  const double around = circumferential_share(body, shape);
  const double beside = symmetry.x == Parity::symmetric ? around : 1.0 - around;
  return beside < negligible_share ? 1 : 2;
}

/// Scales the largest component to +1.
void normalise(Vector& shape) {
  double least = 0.0, largest = 0.0;
  for (const double value : shape) {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  const MPI_Comm communicator = shape.get_mpi_communicator();
  least = dealii::Utilities::MPI::min(least, communicator);
  largest = dealii::Utilities::MPI::max(largest, communicator);
  shape /= largest > -least ? largest : least;
}

/// Output of the whole tip: a quarter and its mirror images.
class WholeTipOutput : public dealii::DataOut<3> {
 public:
  /// Call after build_patches with curved cells.
  void complete(SymmetryClass symmetry) {
    whole_ = dealii::DataOut<3>::get_patches();
    mirror(0, symmetry.x);
    mirror(1, symmetry.y);
  }
  const std::vector<Patch>& get_patches() const override {
    return whole_.empty() ? dealii::DataOut<3>::get_patches() : whole_;
  }

 private:
  using Patch = dealii::DataOut<3>::Patch;

  void mirror(unsigned axis, Parity parity) {
    const std::size_t count = whole_.size();
    for (std::size_t i = 0; i < count; ++i) whole_.push_back(image(whole_[i], axis, parity));
    for (std::size_t i = 0; i < whole_.size(); ++i) whole_[i].patch_index = unsigned(i);
  }

  /// The data's rows are three displacements and three coordinates of every point. Points are taken
  /// in reverse along the cell's first direction, or the image would be inside out.
  static Patch image(const Patch& patch, unsigned axis, Parity parity) {
    Patch result = patch;
    for (auto& neighbour : result.neighbors) neighbour = Patch::no_neighbor;
    for (unsigned v = 0; v < 8; ++v) {
      result.vertices[v] = patch.vertices[v ^ 1U];
      result.vertices[v][axis] *= -1.0;
    }
    const unsigned points = patch.n_subdivisions + 1;
    const float sign = parity == Parity::symmetric ? 1.0F : -1.0F;
    for (unsigned row = 0; row < 2 * 3; ++row)
      for (unsigned p = 0; p < patch.data.n_cols(); ++p) {
        const unsigned first = p % points, source = p - first + (points - 1 - first);
        const float factor = (row < 3 ? sign : 1.0F) * (row % 3 == axis ? -1.0F : 1.0F);
        result.data(row, p) = factor * patch.data(row, source);
      }
    return result;
  }

  std::vector<Patch> whole_;
};

std::size_t class_index(SymmetryClass symmetry) {
  return 2 * std::size_t(symmetry.x) + std::size_t(symmetry.y);
}

}  // namespace

std::string name(SymmetryClass symmetry) {
  const auto letter = [](Parity parity) { return parity == Parity::symmetric ? 'S' : 'A'; };
  return {letter(symmetry.x), letter(symmetry.y)};
}

struct TipModes::Implementation {
  bool is_quarter;
  std::unique_ptr<Body<3>> body;
  HookeKernel<3> stiffness;
  MassKernel<3> mass;
  /// Of every class, with the unknowns numbered as `body` does for all classes alike.
  std::array<std::vector<Vector>, 4> shapes;
};

TipModes::TipModes(const ReferenceJob& job, const std::filesystem::path& mesh_file)
    : implementation_(
          new Implementation{!job.geometry.solid,
                             read_tip<3>(MPI_COMM_WORLD, mesh_file, job.degree, 0.0, job.geometry),
                             HookeKernel<3>(job.rubber, job.volumetric),
                             MassKernel<3>(job.rubber.density),
                             {}}) {
  implementation_->body->number(supports({}));
}

TipModes::~TipModes() = default;

MeshSummary TipModes::mesh() const {
  const Body<3>& body = *implementation_->body;
  return {std::size_t(body.triangulation.n_global_active_cells()), std::size_t(body.unknowns()), 0,
          LinearSolver::automatic};
}

std::vector<NaturalMode> TipModes::solve(SymmetryClass symmetry, int count) {
  Implementation& self = *implementation_;
  self.body->number(supports(symmetry));
  std::vector<Vector>& shapes = self.shapes[class_index(symmetry)];
  shapes.clear();
  std::vector<NaturalMode> modes;
  for (Eigenpair& pair : lowest_eigenpairs(*self.body, self.stiffness, self.mass, count)) {
    modes.push_back({std::sqrt(pair.eigenvalue) / (2.0 * std::numbers::pi), symmetry, modes.size(),
                     self.is_quarter ? multiplicity(*self.body, pair.shape, symmetry) : 1});
    normalise(pair.shape);
    shapes.push_back(std::move(pair.shape));
  }
  return modes;
}

void TipModes::write_fields(const NaturalMode& mode, const std::filesystem::path& file) const {
  using namespace dealii::DataComponentInterpretation;
  const Body<3>& body = *implementation_->body;
  const Vector& shape = implementation_->shapes[class_index(mode.symmetry)].at(mode.number);
  Vector u(body.fine.owned, body.fine.relevant, body.fine.communicator);
  u = shape;
  WholeTipOutput out;
  out.add_data_vector(body.fine.dofs, u, std::vector<std::string>(3, "displacement"),
                      std::vector<DataComponentInterpretation>(3, component_is_part_of_vector));
  out.build_patches(body.mapping, unsigned(body.degree()), dealii::DataOut<3>::curved_inner_cells);
  if (implementation_->is_quarter) out.complete(mode.symmetry);
  write_vtu(out, file);
}

}  // namespace fingertip::fem_reference::inline motion
