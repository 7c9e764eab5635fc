#include "fem_reference/elements/assembly.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_tools.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "fem_reference/tip/tip_body.h"
#include "meshes/base/errors.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::HookeKernel;
using fem_reference::HyperelasticKernel;
using fem_reference::LinearSystem;
using fem_reference::Space;
using fem_reference::Vector;
using fem_reference::Volumetric;
using meshes::HyperelasticLaw;

namespace {

void refine_pole(Body<3>& body) {
  for (const auto& cell : body.triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center().distance(dealii::Point<3>(0, 0, 0.01)) < 4e-3)
      cell->set_refine_flag();
  body.triangulation.execute_coarsening_and_refinement();
}

/// A coarse quarter tip, if wanted fine near the pole, so that there are hanging nodes on and
/// in it.
std::unique_ptr<Body<3>> make_body(int degree,
                                   const std::vector<fem_reference::FixedComponent>& fixed,
                                   bool hanging = true, int refinements = 0) {
  const SharedMesh mesh(0.3);
  auto body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), degree, 0.0);
  if (hanging) refine_pole(*body);
  body->triangulation.refine_global(unsigned(refinements));
  body->number(fixed);
  return body;
}
using Field = std::function<Eigen::Vector3d(const dealii::Point<3>&)>;

/// Nodal values of a field on the owned unknowns, constrained ones zero.
Vector interpolate(const Body<3>& body, const Space<3>& space, const Field& field) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(body.mapping, space.dofs, points);
  std::vector<dealii::types::global_dof_index> indices(space.element.n_dofs_per_cell());
  Vector u = space.vector();
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < indices.size(); ++i)
      if (space.owned.is_element(indices[i]) && !space.constraints.is_constrained(indices[i]))
        u[indices[i]] =
            field(points.at(indices[i]))[space.element.system_to_component_index(i).first];
  }
  u.compress(dealii::VectorOperation::insert);
  return u;
}

const Eigen::Matrix3d gradient =
    (Eigen::Matrix3d() << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.25, -0.9).finished();

Eigen::Vector3d linear(const dealii::Point<3>& x) {
  return gradient * Eigen::Vector3d(x[0], x[1], x[2]);
}

class Assembly : public ::testing::TestWithParam<int> {};

/// Largest force inside the body in a linear displacement, over the largest at the surface; what
/// the energy and the matrix say is checked against the exact energy.
double force_inside(const Body<3>& body, double energy_tolerance) {
  const meshes::Rubber rubber;
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const double density = rubber.lame_lambda() / 2 * std::pow(strain.trace(), 2) +
                         rubber.shear_modulus * strain.squaredNorm();
  HookeKernel<3> kernel(rubber, Volumetric::mean_dilatation);
  LinearSystem system(body, false);
  const Vector u = interpolate(body, body.fine, linear);
  assemble(body, kernel, u, system);
  EXPECT_NEAR(system.energy / (density * fem_reference::volume(body)), 1.0, energy_tolerance);
  EXPECT_NEAR(u * system.force / (2 * system.energy), 1.0, 1e-12);
  Vector product = body.fine.vector();
  system.matrix.vmult(product, u);
  product -= system.force;
  EXPECT_LT(product.l2_norm(), 1e-12 * system.force.l2_norm());

  const dealii::IndexSet surface =
      dealii::DoFTools::extract_boundary_dofs(body.fine.dofs, dealii::ComponentMask(3, true));
  double largest = 0.0;
  int inside = 0;
  for (const auto i : body.fine.owned)
    if (!surface.is_element(i)) {
      largest = std::max(largest, std::abs(double(system.force[i])));
      ++inside;
    }
  EXPECT_GT(dealii::Utilities::MPI::sum(inside, MPI_COMM_WORLD), 10);
  return dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD) / system.force.linfty_norm();
}

/// Linear displacement is in equilibrium on curved elements: no force on nodes inside, and the
/// exact energy. The integrand of the forces, cofactors of the mapping times a shape function's
/// gradient, is of degree 3k - 1 in each coordinate, and k + 1 Gauss points integrate degree 2k +
/// 1: exact for k = 1 and 2, nearly so for k = 3.
TEST_P(Assembly, PassesThePatchTest) {
  EXPECT_LT(force_inside(*make_body(GetParam(), {}, false), 1e-12), GetParam() < 3 ? 1e-11 : 1e-6);
}

/// Energy of a rotation by a small angle, over that of a shear by the same angle.
double energy_of_rotation(const Body<3>& body) {
  const meshes::Rubber rubber;
  HookeKernel<3> kernel(rubber, Volumetric::mean_dilatation);
  LinearSystem system(body, false);
  const double angle = 0.1;
  const Vector rotation = interpolate(body, body.fine, [&](const dealii::Point<3>& x) {
    return Eigen::Vector3d(angle * (x[2] - x[1]), angle * x[0], -angle * x[0]);
  });
  assemble(body, kernel, rotation, system);
  return system.energy / (rubber.shear_modulus * angle * angle * fem_reference::volume(body));
}

/// Where an element meets smaller ones, their curved faces differ by a little, and with them the
/// nodes from where the constraints put them: by h^(k+1), thus in energy by h^(2k) in a layer of
/// thickness h. For degree 3 the exponent stays at 5, because the manifold divides an arc by the
/// mean of directions, which is not the same for an arc and for its halves.
TEST_P(Assembly, HangingNodesMissRigidRotationsByLittle) {
  const auto coarse = make_body(GetParam(), {}), fine = make_body(GetParam(), {}, true, 1);
  EXPECT_TRUE(coarse->triangulation.has_hanging_nodes());
  const double before = energy_of_rotation(*coarse), after = energy_of_rotation(*fine);
  EXPECT_LT(before, GetParam() == 1 ? 1e-4 : 1e-6);
  EXPECT_LT(after, before / (GetParam() == 1 ? 5 : 20));
}

TEST_P(Assembly, RigidMotionsCostNothing) {
  const auto body = make_body(GetParam(), {}, false);
  HookeKernel<3> kernel(meshes::Rubber{}, Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  const Vector rigid = interpolate(*body, body->fine, [](const dealii::Point<3>& x) {
    return Eigen::Vector3d(0.01 - 0.3 * x[1] + 0.5 * x[2], 0.02 + 0.3 * x[0] - 0.8 * x[2],
                           -0.03 - 0.5 * x[0] + 0.8 * x[1]);
  });
  assemble(*body, kernel, rigid, system);
  EXPECT_LT(system.force.linfty_norm(),
            1e-12 * system.matrix.frobenius_norm() * rigid.linfty_norm());
}

/// Hanging or not.
TEST_P(Assembly, TranslationsCostNothing) {
  const auto body = make_body(GetParam(), {});
  HookeKernel<3> kernel(meshes::Rubber{}, Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  const Vector shift = interpolate(*body, body->fine, [](const dealii::Point<3>&) {
    return Eigen::Vector3d(0.01, 0.02, -0.03);
  });
  assemble(*body, kernel, shift, system);
  Vector force = body->fine.vector();
  system.matrix.vmult(force, shift);
  const double scale = system.matrix.frobenius_norm() * shift.linfty_norm();
  EXPECT_LT(force.linfty_norm(), 1e-13 * scale);
  EXPECT_LT(system.force.linfty_norm(), 1e-13 * scale);
}

/// What hanging nodes and held components do not touch stays symmetric.
TEST_P(Assembly, MatrixIsSymmetric) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  HookeKernel<3> kernel(meshes::Rubber{}, Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  assemble(*body, kernel, body->fine.vector(), system);
  Vector a = interpolate(*body, body->fine, [](const auto& x) {
    return Eigen::Vector3d(std::sin(900 * x[0]), std::cos(700 * x[1]), std::sin(500 * x[2] + 1));
  });
  Vector b = interpolate(*body, body->fine, [](const auto& x) {
    return Eigen::Vector3d(std::cos(400 * x[2]), x[0] * 100, std::sin(800 * x[1] + 2));
  });
  Vector ka = a, kb = b;
  system.matrix.vmult(ka, a);
  system.matrix.vmult(kb, b);
  EXPECT_NEAR((b * ka) / (a * kb), 1.0, 1e-12);
}

/// The Galerkin product: the energy of a piecewise linear field is the same in both matrices.
TEST_P(Assembly, CoarseMatrixIsTheRestrictionToLinearElements) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  HookeKernel<3> kernel(meshes::Rubber{}, Volumetric::mean_dilatation);
  LinearSystem system(*body, true);
  assemble(*body, kernel, body->fine.vector(), system);
  const auto energy = [&](const Field& field) {
    const Vector coarse = interpolate(*body, body->coarse, field);
    Vector product = coarse;
    system.coarse_matrix.vmult(product, coarse);
    const double in_coarse = coarse * product;

    Vector fine = body->fine.vector();
    dealii::AffineConstraints<double> none;
    none.close();
    dealii::FETools::interpolate(body->coarse.dofs, body->coarse.ghosted(coarse), body->fine.dofs,
                                 none, fine);
    for (const auto i : body->fine.owned)
      if (body->fine.constraints.is_constrained(i)) fine[i] = 0.0;
    fine.compress(dealii::VectorOperation::insert);
    Vector fine_product = fine;
    system.matrix.vmult(fine_product, fine);
    return std::pair(in_coarse, fine * fine_product);
  };
  for (const double wave : {100.0, 400.0, 900.0}) {
    const auto [coarse, fine] = energy([&](const auto& x) {
      return Eigen::Vector3d(std::sin(wave * x[0]), std::cos(wave * x[1]),
                             std::sin(wave * x[2] + 1));
    });
    EXPECT_GT(fine, 0.0);
    EXPECT_NEAR(coarse / fine, 1.0, 1e-12) << wave;
  }
}

/// What the bond exerts on the body balances what pulls elsewhere.
TEST_P(Assembly, UnconstrainedForcesAddUpToZero) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  HyperelasticKernel<3> kernel(HyperelasticLaw(meshes::Rubber{}), Volumetric::mean_dilatation);
  const Vector u = interpolate(*body, body->fine, [](const auto& x) {
    return Eigen::Vector3d(2 * x[0] * x[2], x[1] * x[1], -3 * x[2] * x[0]);
  });
  const Vector force = unconstrained_force(*body, kernel, u);
  EXPECT_GT(force.linfty_norm(), 0.0);
  EXPECT_LT(std::abs(force.mean_value()), 1e-12 * force.linfty_norm());
}

/// Inverted at the pole alone, so that not every process sees it; all of them say so.
TEST_P(Assembly, AnInvertedElementStopsEveryProcess) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  HyperelasticKernel<3> kernel(HyperelasticLaw(meshes::Rubber{}), Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  const Vector u = interpolate(*body, body->fine, [](const auto& x) {
    return Eigen::Vector3d(0, 0, x.distance(dealii::Point<3>(0, 0, 0.01)) < 1e-9 ? -0.01 : 0.0);
  });
  EXPECT_THROW(assemble(*body, kernel, u, system), meshes::NotConverged);
  // And the body can be assembled again.
  assemble(*body, kernel, body->fine.vector(), system);
  EXPECT_NEAR(system.min_jacobian, 1.0, 1e-12);
}

TEST_P(Assembly, AnElementOfTheMeshThatIsTurnedInsideOutIsTold) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  const auto cell = body->triangulation.begin_active();
  std::swap(cell->vertex(0), cell->vertex(7));
  body->number(fem_reference::tip_supports<3>());
  HyperelasticKernel<3> kernel(HyperelasticLaw(meshes::Rubber{}), Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  EXPECT_THROW(assemble(*body, kernel, body->fine.vector(), system), meshes::NotConverged);
}

/// The sum of elements without constrained unknowns takes a way of its own.
TEST_P(Assembly, SumsElementsLikeTheirConstraints) {
  const auto body = make_body(GetParam(), fem_reference::tip_supports<3>());
  const Space<3>& space = body->fine;
  HyperelasticKernel<3> kernel(HyperelasticLaw(meshes::Rubber{}), Volumetric::mean_dilatation);
  LinearSystem system(*body, false);
  const Vector u = interpolate(*body, space, [](const dealii::Point<3>& x) {
    return Eigen::Vector3d(0.2 * x[2] * x[1], 0.6 * x[0] * x[2], 0.2 * x[2] * x[2]);
  });
  assemble(*body, kernel, u, system);
  auto expected = space.matrix();
  std::vector<dealii::types::global_dof_index> indices(space.element.n_dofs_per_cell());
  int cells = 0, free_cells = 0;
  for_each_element(*body, kernel, u,
                   [&](const auto& cell, const auto& matrix, const auto&, const auto&) {
                     cell->get_dof_indices(indices);
                     space.constraints.distribute_local_to_global(matrix, indices, expected);
                     ++cells;
                     if (std::ranges::none_of(
                             indices, [&](auto i) { return space.constraints.is_constrained(i); }))
                       ++free_cells;
                   });
  expected.compress(dealii::VectorOperation::add);
  const auto count = [](int own) { return dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD); };
  EXPECT_GT(count(free_cells), 10);
  EXPECT_LT(count(free_cells), count(cells) - 10);
  const double size = expected.frobenius_norm();
  expected.add(-1.0, system.matrix);
  EXPECT_LT(expected.frobenius_norm(), 1e-14 * size);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Assembly, ::testing::Values(1, 2, 3));

}  // namespace
