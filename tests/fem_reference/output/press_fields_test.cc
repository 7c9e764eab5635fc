#include "fem_reference/output/press_fields.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_values.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "fem_reference/tip/tip_body.h"
#include "meshes/rubber/hyperelastic_law.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::ReferenceJob;
using fem_reference::StressField;
using fem_reference::Vector;
using fem_reference::Volumetric;

namespace {

using Field = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

std::unique_ptr<Body<3>> make_body(int degree) {
  const SharedMesh mesh(0.3);
  auto body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), degree, 0.0);
  body->number({});
  return body;
}

Vector interpolate(const Body<3>& body, const Field& field) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(body.mapping, body.fine.dofs, points);
  std::vector<dealii::types::global_dof_index> indices(body.fine.element.n_dofs_per_cell());
  Vector u = body.fine.vector();
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < indices.size(); ++i) {
      if (!body.fine.owned.is_element(indices[i])) continue;
      const auto& x = points.at(indices[i]);
      u[indices[i]] = field(
          {x[0], x[1], x[2]})[Eigen::Index(body.fine.element.system_to_component_index(i).first)];
    }
  }
  u.compress(dealii::VectorOperation::insert);
  return u;
}

const Eigen::Matrix3d gradient =
    (Eigen::Matrix3d() << 0.03, -0.02, 0.05, 0.01, 0.07, -0.04, 0.06, 0.025, -0.09).finished();

class ConstantStress : public ::testing::TestWithParam<int> {};

TEST_P(ConstantStress, IsExactAtEveryNodeForBothStrains) {
  const auto body = make_body(GetParam());
  const Vector u = interpolate(*body, [](const Eigen::Vector3d& x) { return gradient * x; });
  for (const auto strain : {fem_reference::Strain::linear, fem_reference::Strain::finite})
    for (const auto volumetric : {Volumetric::pointwise, Volumetric::mean_dilatation}) {
      ReferenceJob job;
      job.degree = GetParam();
      job.strain = strain;
      job.volumetric = volumetric;
      const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d wanted =
          strain == fem_reference::Strain::linear
              ? Eigen::Matrix3d(job.rubber.lame_lambda() * gradient.trace() * identity +
                                job.rubber.shear_modulus * (gradient + gradient.transpose()))
              : Eigen::Matrix3d(
                    meshes::HyperelasticLaw(job.rubber).complete(identity + gradient).stress *
                    (identity + gradient).transpose() / (identity + gradient).determinant());
      const StressField<3> field(*body, job, u);
      double worst = 0.0;
      for (const auto& cell : body->fine.dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const Eigen::Matrix3d& found : field.on(cell))
            worst = std::max(worst, (found - wanted).norm());
      EXPECT_LT(worst, 1e-9 * wanted.norm());
    }
}

INSTANTIATE_TEST_SUITE_P(Degrees, ConstantStress, ::testing::Values(1, 2, 3));

// Quadratic elements: the dilatation in the mean stress must differ from div u by something that is
// orthogonal to all linear polynomials, in an element where div u is not linear.
TEST(StressField, TakesTheBestLinearDilatation) {
  const auto body = make_body(2);
  const ReferenceJob job;
  const Vector u = interpolate(*body, [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(std::sin(400 * x.x()), std::sin(600 * x.y()), 0.0);
  });
  const Vector ghosted = body->fine.ghosted(u);
  const StressField<3> field(*body, job, u);
  const dealii::FE_DGQ<3> element(2);
  const auto flags =
      dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values;
  dealii::FEValues<3> inside(body->mapping, body->fine.element, dealii::QGauss<3>(3), flags);
  dealii::FEValues<3> nodes(body->mapping, body->fine.element,
                            dealii::Quadrature<3>(element.get_unit_support_points()),
                            dealii::update_gradients);
  const auto divergence = [&](const dealii::FEValues<3>& values) {
    std::vector<double> found(values.n_quadrature_points);
    values[dealii::FEValuesExtractors::Vector(0)].get_function_divergences(ghosted, found);
    return found;
  };
  const double lambda = job.rubber.lame_lambda(), shear = job.rubber.shear_modulus;
  double worst = 0.0, pointwise = 0.0;
  for (const auto& cell : body->fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    inside.reinit(cell);
    nodes.reinit(cell);
    const auto stress = field.on(cell);
    const auto at_nodes = divergence(nodes), at_points = divergence(inside);
    Eigen::Vector4d moments = Eigen::Vector4d::Zero();
    double size = 0.0;
    for (const unsigned q : inside.quadrature_point_indices()) {
      double dilatation = 0.0;
      for (unsigned a = 0; a < stress.size(); ++a)
        dilatation += element.shape_value(a, inside.get_quadrature().point(q)) *
                      (stress[a].trace() - 2 * shear * at_nodes[a]) / (3 * lambda);
      const auto x = (inside.quadrature_point(q) - cell->center()) / cell->diameter();
      const double difference = dilatation - at_points[q];
      moments += inside.JxW(q) * difference * Eigen::Vector4d(1, x[0], x[1], x[2]);
      size += inside.JxW(q) * std::abs(at_points[q]);
      pointwise = std::max(pointwise, std::abs(difference / at_points[q]));
    }
    worst = std::max(worst, moments.norm() / size);
  }
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(pointwise, 1e-2);  // otherwise the field would prove nothing
}

}  // namespace
