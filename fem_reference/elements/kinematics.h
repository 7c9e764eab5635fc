/// How displacements on a mesh deform space: the one place that knows what two dimensions mean.
/// deal.II's side.
///
/// dim = 3: Cartesian coordinates, F = I + grad u.
/// dim = 2: the meridian (r, z) of a body of revolution. In the axes (e_r, e_phi, e_z)
///
///     F = [ 1 + u_r,r   0          u_r,z     ]
///         [ 0           1 + u_r/r  0         ]      dV = 2 pi r dr dz,
///         [ u_z,r       0          1 + u_z,z ]
///
/// and a face sweeps 2 pi r ds. Quadrature points with a positive weight never lie on the axis.
/// Where a body of revolution is twisted, at small strain alone, a node has a third component,
/// u_phi, with the shears u_phi,r - u_phi/r and u_phi,z; it knows nothing of the other two.
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Core>
#include <array>
#include <numbers>

namespace fingertip::fem_reference::inline elements {

template <int dim>
struct Kinematics;

template <>
struct Kinematics<3> {
  /// Axis of space along which a component or coordinate points.
  static constexpr std::array<unsigned, 3> axis{0, 1, 2};
  /// Which entries of F (row by row) an element can change: first those of the gradient, component
  /// by component, then the hoop's.
  static constexpr std::array<Eigen::Index, 9> entries{0, 1, 2, 3, 4, 5, 6, 7, 8};
  /// Those that each component changes by its slopes: its derivatives and, in a body of revolution,
  /// u/r. -1: no such slope.
  static constexpr std::array<std::array<int, 3>, 3> slopes{{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  static constexpr bool revolved = false;
};

template <>
struct Kinematics<2> {
  static constexpr std::array<unsigned, 3> axis{0, 2, 1};
  static constexpr std::array<Eigen::Index, 5> entries{0, 2, 6, 8, 4};
  static constexpr std::array<std::array<int, 3>, 2> slopes{{{0, 2, 4}, {6, 8, -1}}};
  static constexpr bool revolved = true;
};

/// How far a point of the mesh reaches around the axis [m]; 1 for a solid.
template <int dim>
double circumference(const dealii::Point<dim>& point) {
  return Kinematics<dim>::revolved ? 2.0 * std::numbers::pi * point[0] : 1.0;
}

/// Volume [m³] or area [m²] that a quadrature point stands for.
template <int dim>
double weight(const dealii::FEValuesBase<dim>& values, unsigned q) {
  return values.JxW(q) * circumference(values.quadrature_point(q));
}

/// A place or direction of the mesh, in space; a meridian lies in the plane y = 0.
template <int dim>
Eigen::Vector3d in_space(const dealii::Tensor<1, dim>& v) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (unsigned i = 0; i < dim; ++i) result[Kinematics<dim>::axis[i]] = v[i];
  return result;
}

/// grad u in space, from its gradient on the mesh and, for the hoop, u and its place. On the axis
/// u_r/r is its limit u_r,r.
template <int dim>
Eigen::Matrix3d gradient_in_space(const dealii::Tensor<2, dim>& gradient,
                                  const dealii::Tensor<1, dim>& displacement,
                                  const dealii::Point<dim>& point) {
  constexpr auto axis = Kinematics<dim>::axis;
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (unsigned i = 0; i < dim; ++i)
    for (unsigned j = 0; j < dim; ++j) result(axis[i], axis[j]) = gradient[i][j];
  if constexpr (Kinematics<dim>::revolved) {
    constexpr double on_axis = 1e-9;  // of the distance from the origin
    result(1, 1) = point[0] > on_axis * point.norm() ? displacement[0] / point[0] : gradient[0][0];
  }
  return result;
}

}  // namespace fingertip::fem_reference::inline elements
