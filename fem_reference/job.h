/// The order slip between the two programs: `fingertip` writes it, `fingertip-fem` carries it out.
/// Free of deal.II, so that the application does not link it.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "meshes/geometry.h"
#include "meshes/press_protocol.h"
#include "meshes/rubber.h"

namespace fingertip::fem_reference {

/// How the linear systems are solved.
enum class LinearSolver {
  automatic,  ///< condensed while it fits into memory, multigrid beyond
  condensed,  ///< one sparse Cholesky factorisation, condensed to the contact unknowns
  multigrid,  ///< conjugate gradients preconditioned by algebraic multigrid
};

std::string_view name(LinearSolver solver);

/// One press of the continuum, SI. Small-strain linear elasticity, static.
struct ReferenceJob {
  meshes::Geometry geometry;
  meshes::Rubber rubber;
  meshes::ContactMode contact = meshes::ContactMode::stick;
  std::vector<double> samples;  ///< indentations to solve for [m], increasing
  int degree = 2;               ///< polynomial degree of the elements, 1 or 2
  double refinement = 1.0;      ///< factor on the element counts of the default mesh, 0.5 ... 4
  double tolerance = 1e-8;      ///< residual of the multigrid solver over the reactions
  LinearSolver solver = LinearSolver::automatic;
  bool write_fields = true;    ///< VTU per sample and a PVD over them
  bool estimate_error = true;  ///< solve on two coarser meshes, too, and fill in force_error

  std::vector<meshes::Violation> violations() const;
};

/// JSON in and out (file `job.json` in the run folder). Reading throws InvalidInput with the
/// file and the offending entry; entries that are absent keep their defaults.
void write_job(const ReferenceJob& job, const std::filesystem::path& file);
ReferenceJob read_job(const std::filesystem::path& file);

}  // namespace fingertip::fem_reference
