#include "fem_reference/elements/element.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "meshes/base/errors.h"

using namespace fingertip;
using Eigen::Index;
using fem_reference::ElementKernel;
using fem_reference::ElementSystem;
using fem_reference::HookeKernel;
using fem_reference::HyperelasticKernel;
using fem_reference::MassKernel;
using fem_reference::Volumetric;
using meshes::HyperelasticLaw;
using meshes::VolumetricLaw;

namespace {

constexpr VolumetricLaw laws[] = {VolumetricLaw::logarithmic, VolumetricLaw::full_quadratic,
                                  VolumetricLaw::isochoric_logarithmic};

/// Neo-Hookean.
HyperelasticLaw law_of(VolumetricLaw volumetric, meshes::Rubber rubber = {}) {
  rubber.energy.volumetric = volumetric;
  return HyperelasticLaw(rubber);
}
constexpr Volumetric volumetrics[] = {Volumetric::pointwise, Volumetric::mean_dilatation};

/// One curved, skewed element of a shell of 1 cm, and the nodes' positions.
class CurvedElement {
 public:
  explicit CurvedElement(int degree)
      : element_(unsigned(degree)),
        mapping_(unsigned(degree)),
        values_(mapping_, element_, dealii::QGauss<3>(unsigned(degree) + 1),
                dealii::update_values | dealii::update_gradients |
                    dealii::update_quadrature_points | dealii::update_JxW_values) {
    dealii::GridGenerator::hyper_shell(mesh_, dealii::Point<3>(), 0.005, 0.01, 12);
    auto cell = mesh_.begin_active();
    cell->vertex(0) *= 1.05;
    cell->vertex(6) *= 0.96;
    values_.reinit(cell);
    for (const auto& point : element_.get_unit_support_points()) {
      const auto x = mapping_.transform_unit_to_real_cell(cell, point);
      nodes_.emplace_back(x[0], x[1], x[2]);
    }
  }

  const dealii::FEValues<3>& values() const { return values_; }
  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }
  Index unknowns() const { return 3 * Index(nodes_.size()); }
  double size() const { return 0.005; }

  double volume() const {
    double sum = 0.0;
    for (const double weight : values_.get_JxW_values()) sum += weight;
    return sum;
  }

  Eigen::VectorXd affine(const Eigen::Matrix3d& gradient, const Eigen::Vector3d& shift) const {
    Eigen::VectorXd u(unknowns());
    for (std::size_t a = 0; a < nodes_.size(); ++a)
      u.segment<3>(3 * Index(a)) = gradient * nodes_[a] + shift;
    return u;
  }

  /// A smooth, finite, non-affine deformation: gradients of some 0.3.
  Eigen::VectorXd smooth() const {
    Eigen::VectorXd u(unknowns());
    for (std::size_t a = 0; a < nodes_.size(); ++a) {
      const Eigen::Vector3d x = nodes_[a] / 0.01;
      u.segment<3>(3 * Index(a)) =
          0.01 * Eigen::Vector3d(0.2 * x.y() * x.z() + 0.1 * x.x(),
                                 0.15 * x.x() * x.x() - 0.1 * x.z(),
                                 0.2 * x.x() * x.y() - 0.12 * x.z() * x.z());
    }
    return u;
  }

  /// Nodal displacements at random, of the length given.
  Eigen::VectorXd random(double length, unsigned seed) const {
    std::srand(seed);
    return length * Eigen::VectorXd::Random(unknowns());
  }

 private:
  dealii::Triangulation<3> mesh_;
  dealii::FE_Q<3> element_;
  dealii::MappingQ<3> mapping_;
  dealii::FEValues<3> values_;
  std::vector<Eigen::Vector3d> nodes_;
};

ElementSystem integrate(ElementKernel<3>& kernel, const CurvedElement& element,
                        const Eigen::VectorXd& u) {
  ElementSystem result;
  kernel.integrate(element.values(), u, fem_reference::Parts::all, result);
  return result;
}

Eigen::Matrix3d some_gradient() {
  return (Eigen::Matrix3d() << 0.12, -0.2, 0.05, 0.1, -0.17, -0.14, 0.06, 0.25, 0.19).finished();
}

/// Runs `check(kernel, what)` for every law and both volumetric terms.
template <class Check>
void for_every_hyperelastic_kernel(Check check) {
  for (const VolumetricLaw law : laws)
    for (const Volumetric volumetric : volumetrics) {
      const std::string what = std::string(name(law)) + " " + std::string(name(volumetric));
      SCOPED_TRACE(what);
      HyperelasticKernel<3> kernel(law_of(law), volumetric);
      check(kernel);
    }
}

class Element : public ::testing::TestWithParam<int> {
 protected:
  const CurvedElement element{GetParam()};
};

TEST_P(Element, PolynomialsAreOrthonormalAndReproduceTheirDegree) {
  const auto& values = element.values();
  const Index points = Index(values.n_quadrature_points);
  Eigen::VectorXd weights(points), quadratic(points), linear(points);
  for (Index q = 0; q < points; ++q) {
    const auto& x = values.quadrature_point(unsigned(q));
    weights[q] = values.JxW(unsigned(q));
    linear[q] = 3.0 * x[0] - x[1] + 0.5 * x[2] - 0.004;
    quadratic[q] = x[0] * x[1] - 2 * x[2] * x[2] + x[1] * 0.003;
  }
  for (const int degree : {0, 1, 2}) {
    if (degree > GetParam()) continue;  // the rule would be too coarse to tell them apart
    const Eigen::MatrixXd basis =
        fem_reference::ElementPolynomials(values, degree).at(values.get_quadrature_points());
    EXPECT_EQ(basis.cols(), (degree + 1) * (degree + 2) * (degree + 3) / 6);
    const Eigen::MatrixXd products = basis.transpose() * weights.asDiagonal() * basis;
    EXPECT_LT((products - Eigen::MatrixXd::Identity(basis.cols(), basis.cols())).norm(), 1e-9);
    const auto missed = [&](const Eigen::VectorXd& f) {
      return (basis * (basis.transpose() * weights.cwiseProduct(f)) - f).norm() / f.norm();
    };
    EXPECT_EQ(missed(linear) < 1e-10, degree >= 1);
    EXPECT_EQ(missed(quadratic) < 1e-10, degree >= 2);
  }
}

TEST_P(Element, HookeHasSixRigidModesAndIsStiffOtherwise) {
  for (const Volumetric volumetric : volumetrics) {
    HookeKernel<3> kernel(meshes::Rubber{}, volumetric);
    const auto system = integrate(kernel, element, Eigen::VectorXd::Zero(element.unknowns()));
    const Eigen::MatrixXd& k = system.matrix;
    EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(k);
    const Eigen::VectorXd& values = modes.eigenvalues();
    EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-13 * values.maxCoeff());
    EXPECT_GT(values[6], 1e-6 * values.maxCoeff());

    Eigen::Matrix3d spin;
    spin << 0, -0.3, 0.5, 0.3, 0, -0.8, -0.5, 0.8, 0;
    const Eigen::VectorXd rigid = element.affine(spin, {0.01, -0.02, 0.03});
    EXPECT_LT((k * rigid).norm(), 1e-12 * k.norm() * rigid.norm());
  }
}

TEST_P(Element, HookeEnergyOfAnAffineDisplacementIsExact) {
  const meshes::Rubber rubber;
  const Eigen::Matrix3d gradient = some_gradient(), strain = (gradient + gradient.transpose()) / 2;
  const double exact = element.volume() * (rubber.lame_lambda() / 2 * std::pow(strain.trace(), 2) +
                                           rubber.shear_modulus * strain.squaredNorm());
  const Eigen::VectorXd u = element.affine(gradient, {1e-3, 2e-3, 3e-3});
  Eigen::VectorXd force;
  for (const Volumetric volumetric : volumetrics) {
    HookeKernel<3> kernel(rubber, volumetric);
    const auto system = integrate(kernel, element, u);
    EXPECT_NEAR(system.energy / exact, 1.0, 1e-12);
    EXPECT_LT((system.force - system.matrix * u).norm(), 1e-12 * system.force.norm());
    if (force.size() > 0) {
      EXPECT_LT((system.force - force).norm(), 1e-11 * force.norm());
    }
    force = system.force;
  }
}

/// Where the dilatation varies, projecting it takes energy out: that is what cures locking.
TEST_P(Element, ProjectionSoftensWhatIsNotAffine) {
  HookeKernel<3> plain(meshes::Rubber{}, Volumetric::pointwise);
  HookeKernel<3> projected(meshes::Rubber{}, Volumetric::mean_dilatation);
  const Eigen::VectorXd u = element.random(1e-4, 3);
  EXPECT_LT(integrate(projected, element, u).energy, 0.99 * integrate(plain, element, u).energy);
}

/// Of all laws, both volumetric terms: the energy of the exact volume at the exact gradient.
TEST_P(Element, HyperelasticEnergyOfAnAffineDeformationIsExact) {
  const Eigen::Matrix3d gradient = some_gradient(), F = Eigen::Matrix3d::Identity() + gradient;
  const Eigen::VectorXd u = element.affine(gradient, {1e-3, 2e-3, 3e-3});
  for (const VolumetricLaw law : laws) {
    const HyperelasticLaw point = law_of(law);
    const double exact = element.volume() * point.complete(F).energy;
    HyperelasticKernel<3> plain(point, Volumetric::pointwise),
        smooth(point, Volumetric::mean_dilatation);
    const auto a = integrate(plain, element, u), b = integrate(smooth, element, u);
    EXPECT_NEAR(a.energy / exact, 1.0, 1e-12) << name(law);
    EXPECT_NEAR(b.energy / exact, 1.0, 1e-12) << name(law);
    EXPECT_LT((a.force - b.force).norm(), 1e-11 * a.force.norm());
    EXPECT_NEAR(a.min_jacobian, F.determinant(), 1e-12);
    const Eigen::VectorXd stretch =
        element.affine(Eigen::Vector3d(1, 2, -1).asDiagonal(), Eigen::Vector3d::Zero());
    EXPECT_LT(((a.matrix - b.matrix) * stretch).norm(), 1e-10 * (a.matrix * stretch).norm());
  }
}

TEST_P(Element, ForceIsTheEnergysDerivative) {
  const Eigen::VectorXd u = element.smooth();
  for_every_hyperelastic_kernel([&](ElementKernel<3>& kernel) {
    const auto system = integrate(kernel, element, u);
    EXPECT_GT(std::abs(system.min_jacobian - 1.0), 1e-3);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Eigen::VectorXd direction = element.random(1.0, seed);
      const double h = 1e-7;
      const double slope = (integrate(kernel, element, u + h * direction).energy -
                            integrate(kernel, element, u - h * direction).energy) /
                           (2 * h);
      EXPECT_NEAR(slope, system.force.dot(direction),
                  1e-6 * system.force.norm() * direction.norm());
    }
  });
}

TEST_P(Element, TangentIsTheForcesDerivative) {
  const Eigen::VectorXd u = element.smooth();
  for_every_hyperelastic_kernel([&](ElementKernel<3>& kernel) {
    const Eigen::MatrixXd tangent = integrate(kernel, element, u).matrix;
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * tangent.norm());
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Eigen::VectorXd direction = element.random(1.0, seed);
      const double h = 1e-8;
      const Eigen::VectorXd slope = (integrate(kernel, element, u + h * direction).force -
                                     integrate(kernel, element, u - h * direction).force) /
                                    (2 * h);
      EXPECT_LT((slope - tangent * direction).norm(), 1e-7 * (tangent * direction).norm());
    }
  });
}

/// One small strain for all laws. Law C projects the dilatation of K, not of lambda, so that with
/// H the stiffness of Hooke's law its own is H_projected + 2G/(3 lambda) (H_projected -
/// H_pointwise).
TEST_P(Element, AtRestEveryLawIsHookes) {
  const meshes::Rubber rubber;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(element.unknowns());
  HookeKernel<3> plain(rubber, Volumetric::pointwise),
      projected(rubber, Volumetric::mean_dilatation);
  const Eigen::MatrixXd pointwise = integrate(plain, element, rest).matrix,
                        smooth = integrate(projected, element, rest).matrix;
  const double ratio = 2 * rubber.shear_modulus / (3 * rubber.lame_lambda());
  for (const Volumetric volumetric : volumetrics)
    for (const VolumetricLaw law : laws) {
      SCOPED_TRACE(std::string(name(law)) + " " + std::string(name(volumetric)));
      Eigen::MatrixXd expected = volumetric == Volumetric::pointwise ? pointwise : smooth;
      if (law == VolumetricLaw::isochoric_logarithmic && volumetric == Volumetric::mean_dilatation)
        expected += ratio * (smooth - pointwise);
      HyperelasticKernel<3> kernel(law_of(law, rubber), volumetric);
      const auto system = integrate(kernel, element, rest);
      EXPECT_LT((system.matrix - expected).norm(), 1e-12 * expected.norm());
      EXPECT_LT(system.force.norm(), 1e-12 * expected.norm() * element.size());
      EXPECT_NEAR(system.energy, 0.0, 1e-12 * element.volume() * rubber.shear_modulus);
      EXPECT_NEAR(system.min_jacobian, 1.0, 1e-12);
    }
}

/// A finite rotation is free of stress, unlike in Hooke's law.
TEST_P(Element, RotationsCostNothingAtLargeStrain) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Eigen::VectorXd u = element.affine(turn - Eigen::Matrix3d::Identity(), {1e-3, 0, 0});
  for_every_hyperelastic_kernel([&](ElementKernel<3>& kernel) {
    const auto system = integrate(kernel, element, u);
    EXPECT_LT(system.force.norm(), 1e-11 * system.matrix.norm() * element.size());
    EXPECT_NEAR(system.min_jacobian, 1.0, 1e-12);
  });
}

TEST_P(Element, ForceAloneIsThatOfTheWholeSystem) {
  const Eigen::VectorXd u = element.random(0.05 * element.size(), 7);
  for_every_hyperelastic_kernel([&](ElementKernel<3>& kernel) {
    const ElementSystem whole = integrate(kernel, element, u);
    ElementSystem alone;
    kernel.integrate(element.values(), u, fem_reference::Parts::force, alone);
    EXPECT_EQ(alone.force, whole.force);
    EXPECT_EQ(alone.energy, whole.energy);
    EXPECT_EQ(alone.min_jacobian, whole.min_jacobian);
  });
}

TEST_P(Element, InvertedIsRefused) {
  const Eigen::VectorXd mirrored =
      element.affine(Eigen::Vector3d(0, 0, -2.0).asDiagonal(), Eigen::Vector3d::Zero());
  const Eigen::VectorXd flat =
      element.affine(Eigen::Vector3d(0, 0, -1.0).asDiagonal(), Eigen::Vector3d::Zero());
  Eigen::VectorXd unknown = Eigen::VectorXd::Zero(element.unknowns());
  unknown[0] = std::nan("");
  for_every_hyperelastic_kernel([&](ElementKernel<3>& kernel) {
    EXPECT_THROW(integrate(kernel, element, mirrored), meshes::NotConverged);
    EXPECT_THROW(integrate(kernel, element, flat), meshes::NotConverged);
    EXPECT_THROW(integrate(kernel, element, unknown), meshes::NotConverged);
  });
}

TEST_P(Element, MassIsDensityTimesVolume) {
  const double density = 500.0, mass = density * element.volume();
  MassKernel<3> kernel(density);
  const auto system = integrate(kernel, element, Eigen::VectorXd::Zero(element.unknowns()));
  const Eigen::MatrixXd& m = system.matrix;
  EXPECT_LT((m - m.transpose()).norm(), 1e-14 * m.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues()[0], 0.0);
  const Eigen::VectorXd along_x = element.affine(Eigen::Matrix3d::Zero(), {1, 0, 0});
  const Eigen::VectorXd along_z = element.affine(Eigen::Matrix3d::Zero(), {0, 0, 1});
  EXPECT_NEAR(along_x.dot(m * along_x) / mass, 1.0, 1e-12);
  EXPECT_NEAR(along_z.dot(m * along_z) / mass, 1.0, 1e-12);
  EXPECT_NEAR(along_x.dot(m * along_z) / mass, 0.0, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Element, ::testing::Values(1, 2, 3));

}  // namespace
