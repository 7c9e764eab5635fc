// Orders of convergence.
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/analytic/cantilever.h"
#include "fem_reference/analytic/manufactured_displacement.h"
#include "fem_reference/analytic/thick_shell.h"
#include "fem_reference/verification/exact_cases.h"
#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using analytic::ManufacturedDisplacement;

/// `body_of(n)` has n elements along `edge` [m].
ConvergenceStudy converge(std::string problem, const meshes::Rubber& rubber,
                          const ElementType& element, double edge,
                          const std::vector<int>& divisions,
                          const std::function<BodyMesh(int)>& body_of, const Loading& loading,
                          const analytic::ElasticField& exact) {
  ConvergenceStudy study;
  study.problem = std::move(problem);
  study.degree = element.degree;
  study.volumetric = element.volumetric;
  study.poissons_ratio = rubber.poissons_ratio();
  study.expected_l2 = element.degree + 1.0;
  study.expected_h1 = element.degree;
  for (const int n : divisions) {
    const auto elastic = ElasticProblem::on(body_of(n), element, rubber);
    elastic->solve(loading);
    const FieldError error = elastic->error(exact);
    study.meshes.push_back({edge / n, double(elastic->unknowns()), error.l2, error.h1});
  }
  const auto& coarse = study.meshes[study.meshes.size() - 2];
  const auto& fine = study.meshes.back();
  const double ratio = std::log(coarse.h / fine.h);
  study.order_l2 = std::log(coarse.error_l2 / fine.error_l2) / ratio;
  study.order_h1 = std::log(coarse.error_h1 / fine.error_h1) / ratio;
  return study;
}

}  // namespace

ConvergenceStudy study_manufactured(const ManufacturedCase& problem, const ElementType& element,
                                    const std::vector<int>& divisions) {
  const meshes::Rubber rubber = rubber_with(problem.poissons_ratio);
  // Three times as long as the block: orders show from a few elements on.
  const ManufacturedDisplacement exact(rubber, 3.0, 0.01,
                                       problem.nearly_solenoidal
                                           ? ManufacturedDisplacement::Variant::nearly_solenoidal
                                           : ManufacturedDisplacement::Variant::general);
  const auto body_of = [&](int n) {
    BodyMesh body;
    body.shape = problem.curved ? Shape::curved_block : Shape::block;
    body.divisions = {n, n, n};
    body.distortion = problem.curved ? 0.0 : 0.15;
    return body;
  };
  return converge(std::string("manufactured, ") +
                      (problem.nearly_solenoidal ? "nearly solenoidal, " : "general, ") +
                      (problem.curved ? "curved block" : "distorted block"),
                  rubber, element, 1.0, divisions, body_of,
                  loading_of(exact, whole({boundary::low_x, boundary::low_y, boundary::high_z})),
                  exact);
}

ConvergenceStudy study_manufactured_meridian(bool curved, const ElementType& element,
                                             const std::vector<int>& divisions) {
  const meshes::Rubber rubber = rubber_with(3.0 / 7.0);
  const analytic::ManufacturedRevolution exact(rubber, 2.0, 0.01);
  const auto body_of = [&](int n) {
    BodyMesh body;
    body.shape = curved ? Shape::curved_ring : Shape::ring;
    body.divisions = {n, n, n};
    body.distortion = curved ? 0.0 : 0.15;
    return body;
  };
  std::vector<Prescribed> prescribed = whole({boundary::high_x, boundary::low_z});
  prescribed.push_back({boundary::low_x, 0});  // the axis
  return converge(
      std::string("manufactured, meridian of a ") + (curved ? "curved" : "distorted") + " cylinder",
      rubber, element, 1.0, divisions, body_of, loading_of(exact, prescribed), exact);
}

ConvergenceStudy study_sphere(const ElementType& element, double poissons_ratio,
                              const std::vector<int>& divisions, Meshed meshed) {
  const meshes::Rubber rubber = rubber_with(poissons_ratio);
  const double wall = sphere_body(1).size[1] - sphere_body(1).size[0];
  return converge(
      std::string("thick sphere") + (meshed == Meshed::meridian ? ", meridian" : ""), rubber,
      element, wall, divisions, [meshed](int n) { return sphere_body(n, meshed); },
      sphere_loading(), sphere(rubber));
}

ConvergenceStudy study_cylinder(const ElementType& element, double poissons_ratio,
                                const std::vector<int>& divisions, Meshed meshed) {
  const meshes::Rubber rubber = rubber_with(poissons_ratio);
  const double wall = cylinder_body(1).size[1] - cylinder_body(1).size[0];
  return converge(
      std::string("thick cylinder") + (meshed == Meshed::meridian ? ", meridian" : ""), rubber,
      element, wall, divisions, [meshed](int n) { return cylinder_body(n, meshed); },
      cylinder_loading(), cylinder(rubber));
}

ConvergenceStudy study_cantilever(const ElementType& element, double poissons_ratio,
                                  const std::vector<int>& divisions) {
  const meshes::Rubber rubber = rubber_with(poissons_ratio);
  const analytic::PlaneStrainCantilever exact = cantilever(rubber);
  return converge("cantilever", rubber, element, cantilever_body(1).size[2], divisions,
                  cantilever_body, cantilever_loading(exact), exact);
}

}  // namespace fingertip::fem_reference::inline verification
