// Single figures that are known otherwise: patches, rigid motions, fields, bonded disc.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <numbers>

#include "fem_reference/analytic/bonded_disc.h"
#include "fem_reference/verification/exact_cases.h"
#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using meshes::Vector3;

/// u = A x + b.
class LinearField : public analytic::ElasticField {
 public:
  LinearField(const meshes::Rubber& rubber, const analytic::Matrix3& slope, const Vector3& offset)
      : slope_(slope), offset_(offset), stress_(analytic::hooke_stress(rubber, slope_)) {}
  Vector3 displacement(const Vector3& x) const override { return slope_ * x + offset_; }
  analytic::Matrix3 gradient(const Vector3&) const override { return slope_; }
  analytic::Matrix3 stress(const Vector3&) const override { return stress_; }

 private:
  const analytic::Matrix3 slope_;
  const Vector3 offset_;
  const analytic::Matrix3 stress_;
};

/// Stretches, shears and a rotation, all different.
const analytic::Matrix3 any_slope{
    {0.010, -0.004, 0.007}, {0.006, -0.003, 0.002}, {-0.001, 0.005, 0.008}};
/// What keeps a body of revolution one.
const analytic::Matrix3 even_slope{{0.010, 0.0, 0.0}, {0.0, 0.010, 0.0}, {0.0, 0.0, -0.006}};

LinearField linear_field(const meshes::Rubber& rubber, Shape shape) {
  return revolved(shape) ? LinearField(rubber, even_slope, {0.0, 0.0, 0.001})
                         : LinearField(rubber, any_slope, {0.003, -0.002, 0.001});
}

/// Unit translations and rotations about the origin, as columns.
Eigen::Matrix<double, 3, 6> rigid_motions_at(const Vector3& x) {
  Eigen::Matrix<double, 3, 6> motions;
  for (int k = 0; k < 3; ++k) {
    motions.col(k) = Vector3::Unit(k);
    motions.col(3 + k) = Vector3::Unit(k).cross(x);
  }
  return motions;
}

/// Motions that strain nothing, as columns.
Eigen::MatrixXd rigid_motions(const std::vector<Vector3>& nodes, Shape shape) {
  if (revolved(shape)) return Eigen::Vector2d(0.0, 1.0).replicate(Eigen::Index(nodes.size()), 1);
  Eigen::MatrixXd motions(3 * Eigen::Index(nodes.size()), 6);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    motions.middleRows<3>(3 * Eigen::Index(a)) = rigid_motions_at(nodes[a]);
  return motions;
}

struct NamedBody {
  const char* name;
  BodyMesh body;
};

/// Meshes on which something must hold to round-off.
std::vector<NamedBody> small_bodies() {
  BodyMesh distorted;
  distorted.size = {1.0, 0.8, 1.2};
  distorted.divisions = {3, 2, 2};
  distorted.distortion = 0.25;
  BodyMesh hanging = distorted;
  hanging.local_refinements = 1;
  BodyMesh curved = distorted;
  curved.shape = Shape::curved_block;
  curved.distortion = 0.0;
  std::vector<NamedBody> bodies{
      {"distorted", distorted}, {"hanging nodes", hanging}, {"curved", curved}};
  for (const auto& [name, body] :
       {NamedBody{"meridian, distorted", distorted}, NamedBody{"meridian, hanging nodes", hanging},
        NamedBody{"meridian, curved", curved}}) {
    bodies.push_back({name, body});
    bodies.back().body.shape = body.shape == Shape::block ? Shape::ring : Shape::curved_ring;
  }
  return bodies;
}

}  // namespace

std::vector<Check> check_patch(const ElementType& element) {
  const meshes::Rubber rubber = rubber_with(3.0 / 7.0);
  std::vector<Check> checks;
  for (const auto& [mesh_name, body] : small_bodies()) {
    const LinearField exact = linear_field(rubber, body.shape);
    // Displacements on three faces, tractions on the others.
    const Loading loading =
        loading_of(exact, whole({boundary::low_x, boundary::low_y, boundary::high_z}));
    // Gauss' rule of degree + 1 points integrates a constant stress exactly on curved elements up
    // to degree 2: the integrand has degree 3 k - 1 along each axis, the rule 2 k + 1.
    const bool exact_quadrature =
        (body.shape != Shape::curved_block && body.shape != Shape::curved_ring) ||
        element.degree < 3;
    const auto problem = ElasticProblem::on(body, element, rubber);
    problem->solve(loading);
    checks.push_back(
        vanishing(std::string("patch test, ") + mesh_name + ", " + name(element),
                  "largest nodal error of a linear displacement", "constant strain is in the space",
                  problem->nodal_error(loading.displacement), exact_quadrature ? 1e-10 : 1e-4));
  }
  return checks;
}

std::vector<Check> check_rigid_modes(const ElementType& element) {
  std::vector<Check> checks;
  for (auto& [mesh_name, body] : small_bodies()) {
    if (element.degree == 3) body.divisions = {2, 1, 1};
    const auto problem = ElasticProblem::on(body, element, rubber_with(3.0 / 7.0));
    const Eigen::MatrixXd stiffness = problem->stiffness();
    const Eigen::MatrixXd motions = rigid_motions(problem->nodes(), body.shape);
    const Eigen::VectorXd spectrum =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, Eigen::EigenvaluesOnly)
            .eigenvalues();
    const double largest = spectrum.maxCoeff();
    const std::string title = std::string("rigid modes, ") + mesh_name + ", " + name(element);
    const Eigen::RowVectorXd forces = (stiffness * motions).colwise().norm();
    checks.push_back(
        vanishing(title, "largest force of a rigid motion over stiffness and motion",
                  "translations and rotations",
                  (forces.array() / motions.colwise().norm().array()).maxCoeff() / largest, 1e-12));
    checks.push_back(compare(title, "eigenvalues below 1e-10 of the largest",
                             revolved(body.shape) ? "moving along the axis strains nothing"
                                                  : "six rigid motions strain nothing",
                             double((spectrum.array() < 1e-10 * largest).count()),
                             double(motions.cols()), 0.0));
  }
  return checks;
}

std::vector<Check> check_fields(const ElementType& element, int divisions) {
  const meshes::Rubber rubber = rubber_with(3.0 / 7.0);
  const std::string with = ", " + name(element);
  std::vector<Check> checks;
  const auto add_stress = [&](const char* body, const ElasticProblem& problem,
                              const analytic::ElasticField& exact) {
    checks.push_back(vanishing(body + with, "L2 error of the stress", "closed form",
                               problem.stress_error(exact), element.degree == 1 ? 0.25 : 0.03));
  };
  const double tolerance = element.degree == 1 ? 0.05 : 1e-3;
  {
    const auto problem = ElasticProblem::on(sphere_body(divisions), element, rubber);
    problem->solve(sphere_loading());
    // The outward normals of an octant have the mean (1, 1, 1)/2.
    checks.push_back(compare("thick sphere" + with, "radial displacement of the inner wall [m]",
                             "Lamé 1852", problem->mean_displacement(boundary::inner).sum() / 1.5,
                             sphere(rubber).radial_displacement(sphere_body(1).size[0]),
                             tolerance));
    add_stress("thick sphere", *problem, sphere(rubber));
  }
  {
    const auto problem = ElasticProblem::on(cylinder_body(divisions), element, rubber);
    problem->solve(cylinder_loading());
    const Vector3 mean = problem->mean_displacement(boundary::inner);
    checks.push_back(compare("thick cylinder" + with, "radial displacement of the inner wall [m]",
                             "Lamé 1852", (mean.x() + mean.y()) * std::numbers::pi / 4,
                             cylinder(rubber).radial_displacement(cylinder_body(1).size[0]),
                             tolerance));
    add_stress("thick cylinder", *problem, cylinder(rubber));
  }
  {
    const analytic::PlaneStrainCantilever exact = cantilever(rubber);
    const auto problem = ElasticProblem::on(cantilever_body(divisions), element, rubber);
    problem->solve(cantilever_loading(exact));
    // Cubic elements contain the solution.
    checks.push_back(compare("cantilever" + with, "deflection of the end [m]",
                             "Timoshenko & Goodier, section 21",
                             problem->mean_displacement(boundary::high_x).z(),
                             exact.tip_deflection(), element.degree == 3 ? 1e-10 : tolerance));
    add_stress("cantilever", *problem, exact);
  }
  return checks;
}

std::vector<Check> check_disc(double thickness, double poissons_ratio, const ElementType& element,
                              int local_refinements, Meshed meshed) {
  constexpr double approach = 1e-5;
  // An eighth of the energy and a quarter of the force, or a half and all.
  const double energies = meshed == Meshed::solid ? 8.0 : 2.0;
  const double forces = meshed == Meshed::solid ? 4.0 : 1.0;
  const meshes::Rubber rubber = rubber_with(poissons_ratio);
  const auto problem =
      ElasticProblem::on(disc_body(thickness, 4, local_refinements, meshed), element, rubber);
  problem->solve(disc_loading(approach));
  const double stiffness = 2.0 * energies * problem->energy() / (approach * approach);
  char title[96];
  std::snprintf(title, sizeof title, "bonded disc%s, H/R = %g, nu = %.4g, %s",
                meshed == Meshed::meridian ? " (meridian)" : "", thickness / disc_radius,
                poissons_ratio, name(element).c_str());
  return {compare(title, "stiffness from the energy [N/m]", "Ritz, analytic::BondedDisc", stiffness,
                  analytic::BondedDisc(rubber, disc_radius, thickness).extrapolated_stiffness(20),
                  2e-3),
          compare(title, "stiffness from the force on the plate [N/m]", "work of the plates",
                  -forces * problem->reaction(boundary::high_z).z() / approach, stiffness, 1e-9)};
}

}  // namespace fingertip::fem_reference::inline verification
