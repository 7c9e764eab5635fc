// What happens as nu -> 1/2.
#include <array>

#include "fem_reference/analytic/bonded_disc.h"
#include "fem_reference/press/press.h"
#include "fem_reference/tip/job_mesh.h"
#include "fem_reference/verification/exact_cases.h"
#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference::inline verification {
namespace {

constexpr std::array elements{
    ElementType{1, Volumetric::pointwise}, ElementType{1, Volumetric::mean_dilatation},
    ElementType{2, Volumetric::pointwise}, ElementType{2, Volumetric::mean_dilatation},
    ElementType{3, Volumetric::pointwise}};

LockingPoint point(const char* problem, const ElementType& element, double poissons_ratio,
                   double value, double reference) {
  return {problem, name(element), poissons_ratio, value, reference, value / reference - 1.0};
}

double press_force(const ElementType& element, double poissons_ratio,
                   const std::filesystem::path& mesh) {
  ReferenceJob job;
  job.symmetry = Symmetry::none;
  job.rubber = rubber_with(poissons_ratio);
  job.protocol.contact = meshes::ContactMode::frictionless;
  job.press_to({1e-3});
  job.degree = element.degree;
  job.volumetric = element.volumetric;
  return ContinuumPress::on(job, mesh)->advance(1e-3).normal_force;
}

}  // namespace

std::vector<LockingPoint> lock_cantilever(const std::vector<double>& poissons_ratios) {
  std::vector<LockingPoint> points;
  for (const double nu : poissons_ratios) {
    const meshes::Rubber rubber = rubber_with(nu);
    const analytic::PlaneStrainCantilever exact = cantilever(rubber);
    for (const ElementType& element : elements) {
      const auto problem = ElasticProblem::on(cantilever_body(2), element, rubber);
      problem->solve(cantilever_loading(exact));
      // Stiffness against the end load of 1 N/m.
      points.push_back(point("cantilever", element, nu,
                             1.0 / problem->mean_displacement(boundary::high_x).z(),
                             1.0 / exact.tip_deflection()));
    }
  }
  return points;
}

std::vector<LockingPoint> lock_disc(const std::vector<double>& poissons_ratios) {
  constexpr double thickness = 0.005, approach = 1e-5;
  std::vector<LockingPoint> points;
  for (const double nu : poissons_ratios) {
    const meshes::Rubber rubber = rubber_with(nu);
    const double exact =
        analytic::BondedDisc(rubber, disc_radius, thickness).extrapolated_stiffness(20);
    for (const ElementType& element : elements) {
      const auto problem = ElasticProblem::on(disc_body(thickness, 4, 0), element, rubber);
      problem->solve(disc_loading(approach));
      points.push_back(point("bonded disc", element, nu,
                             16.0 * problem->energy() / (approach * approach), exact));
    }
  }
  return points;
}

std::vector<LockingPoint> lock_press(const std::vector<double>& poissons_ratios,
                                     const std::filesystem::path& folder) {
  std::vector<double> finest;
  const meshes::TipMeshOptions options;
  const std::filesystem::path mesh = folder / verification_mesh;
  write_mesh_once({}, options.refined(0.6), mesh);
  for (const double nu : poissons_ratios)
    finest.push_back(press_force({2, Volumetric::mean_dilatation}, nu, mesh));
  write_mesh_once({}, options.refined(0.4), mesh);
  std::vector<LockingPoint> points;
  for (std::size_t i = 0; i < poissons_ratios.size(); ++i)
    for (const ElementType& element : elements)
      points.push_back(point("press", element, poissons_ratios[i],
                             press_force(element, poissons_ratios[i], mesh), finest[i]));
  return points;
}

}  // namespace fingertip::fem_reference::inline verification
