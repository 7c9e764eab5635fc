#include "fem_reference/verification/exact_cases.h"

#include <algorithm>

#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using meshes::Vector3;

constexpr double inner_radius = 0.005, outer_radius = 0.01;       // [m]
constexpr double inner_pressure = 400.0, outer_pressure = 150.0;  // [Pa]
constexpr double plate_length = 0.04, plate_width = 0.005, plate_height = 0.01;

Vector3 pressure(int where, const Vector3&, const Vector3& normal) {
  if (where == boundary::inner) return -inner_pressure * normal;
  if (where == boundary::outer) return -outer_pressure * normal;
  return Vector3::Zero();
}

}  // namespace

meshes::Rubber rubber_with(double poissons_ratio) {
  meshes::Rubber rubber;
  rubber.shear_modulus = rubber.youngs_modulus / (2.0 * (1.0 + poissons_ratio));
  return rubber;
}

std::string name(const ElementType& element) {
  return "Q" + std::to_string(element.degree) + " " + std::string(name(element.volumetric));
}

analytic::ThickSphere sphere(const meshes::Rubber& rubber) {
  return {rubber, {inner_radius, outer_radius, inner_pressure, outer_pressure}};
}

BodyMesh sphere_body(int divisions, Meshed meshed) {
  BodyMesh body;
  body.shape = meshed == Meshed::solid ? Shape::sphere_octant : Shape::sphere_meridian;
  body.size = {inner_radius, outer_radius, 0.0};
  body.divisions[0] = divisions;
  return body;
}

Loading sphere_loading() {
  Loading loading;
  loading.prescribed = {{boundary::low_x, 0}, {boundary::low_y, 1}, {boundary::low_z, 2}};
  loading.traction = pressure;
  return loading;
}

analytic::ThickCylinder cylinder(const meshes::Rubber& rubber) {
  return {rubber, {inner_radius, outer_radius, inner_pressure, outer_pressure}};
}

BodyMesh cylinder_body(int divisions, Meshed meshed) {
  BodyMesh body;
  body.shape = meshed == Meshed::solid ? Shape::cylinder_quarter : Shape::cylinder_meridian;
  body.size = {inner_radius, outer_radius, 0.005};
  body.divisions = {divisions, 2 * divisions, 1};
  return body;
}

Loading cylinder_loading() {
  Loading loading;
  loading.prescribed = {
      {boundary::low_x, 0}, {boundary::low_y, 1}, {boundary::low_z, 2}, {boundary::high_z, 2}};
  loading.traction = pressure;
  return loading;
}

analytic::PlaneStrainCantilever cantilever(const meshes::Rubber& rubber) {
  return {rubber, {plate_height, plate_length, 1.0}};
}

BodyMesh cantilever_body(int divisions) {
  BodyMesh body;
  body.size = {plate_length, plate_width, plate_height};
  body.origin = {0.0, 0.0, -plate_height / 2};
  body.divisions = {4 * divisions, std::max(1, divisions / 2), divisions};
  return body;
}

Loading cantilever_loading(const analytic::PlaneStrainCantilever& exact) {
  std::vector<Prescribed> prescribed = whole({boundary::low_x});
  prescribed.push_back({boundary::low_y, 1});
  prescribed.push_back({boundary::high_y, 1});
  return loading_of(exact, prescribed);
}

BodyMesh disc_body(double thickness, int divisions, int local_refinements, Meshed meshed) {
  BodyMesh body;
  body.shape = meshed == Meshed::solid ? Shape::disc_octant : Shape::disc_meridian;
  body.size = {disc_radius, 0.0, thickness / 2};
  // The octant's mesh has twice the divisions along its radius.
  body.divisions[0] = meshed == Meshed::solid ? divisions : 2 * divisions;
  body.divisions[2] = divisions;
  body.local_refinements = local_refinements;
  return body;
}

Loading disc_loading(double approach) {
  Loading loading;
  loading.prescribed = whole({boundary::high_z});
  loading.prescribed.push_back({boundary::low_x, 0});
  loading.prescribed.push_back({boundary::low_y, 1});
  loading.prescribed.push_back({boundary::low_z, 2});
  // Only the bonded face moves; the symmetry planes' own components are zero there, too.
  loading.displacement = [approach](const Vector3& x) {
    return Vector3(0.0, 0.0, x.z() > 0.0 ? -approach / 2 : 0.0);
  };
  return loading;
}

}  // namespace fingertip::fem_reference::inline verification
