/// deal.II's side of ElasticTip; included by the sources that need deal.II and by nobody else.
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include "fem_reference/elastic_tip.h"

namespace fingertip::fem_reference {

struct ElasticTip::Discretisation {
  static constexpr int dim = 3;

  explicit Discretisation(int degree);

  dealii::Triangulation<dim> triangulation;
  dealii::FESystem<dim> element;
  /// Of the element's degree, so that linear displacements are reproduced exactly. Quadratic, and
  /// with the manifolds, the surface's distance from sphere and cylinder falls like h⁴.
  dealii::MappingQ<dim> mapping;
  dealii::DoFHandler<dim> dof_handler;
};

}  // namespace fingertip::fem_reference
