#include "lattice/statics/cube.h"

#include "lattice/model/model.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"

namespace fingertip::lattice::inline statics {

CubeLattice cube_lattice(ModelKind kind, const SpringConstants& constants, double spacing,
                         int cells) {
  constexpr double any_density = 1.0;  // statics does not see it
  const LatticeBody body = body_of_block(build_block(kind, Kinematics::small, constants, spacing,
                                                     {cells, cells, cells}, any_density, 0.0));
  const ElasticSystem system(body);
  Eigen::VectorXd force;
  Tangent stiffness = system.empty_tangent();
  system.assemble(Eigen::VectorXd::Zero(body.unknowns()), force, &stiffness);
  return {body.rest, stiffness.selfadjointView<Eigen::Lower>(), spacing, cells};
}

}  // namespace fingertip::lattice::inline statics
