/// A static press of the elastic tip on the rigid plane, sample by sample. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "fem_reference/elastic_tip.h"
#include "fem_reference/job.h"
#include "fem_reference/plane_contact.h"
#include "meshes/press_response.h"

namespace fingertip::fem_reference {

/// A node that the plane pushes.
struct ContactPoint {
  double radius = 0.0;    ///< distance from the axis in the reference shape [m]
  double pressure = 0.0;  ///< nodal force over lumped area [Pa]
};

/// What one sample yields, and what it cost.
struct PressState {
  meshes::PressSample sample;
  std::vector<ContactPoint> contact;  ///< by increasing radius
  double node_spacing = 0.0;          ///< of the candidate nodes around the contact edge [m]
  int steps = 0;
  int active_set_iterations = 0;
  int cg_iterations = 0;
  int active_nodes = 0;
  double wall_time = 0.0;  ///< [s]
};

/// Radius of the contact edge [m]. Pressure vanishes at the edge like the square root of the
/// distance from it, as in Hertz's p² ∝ a² - r²: the zero of a straight line fitted to p² against
/// r² over the outer part of the contact, kept between the outermost node that is pushed and one
/// node spacing beyond. `contact` is sorted by radius.
double contact_edge(const std::vector<ContactPoint>& contact, double node_spacing);

/// The quarter of a tip under a plane that comes nearer.
class ContinuumPress {
 public:
  struct Options {
    int degree = 2;
    LinearSolver solver = LinearSolver::automatic;
    double tolerance = 1e-8;
    /// Longest step of a stick press, in units of R - r. Frictionless presses take one step from
    /// sample to sample, for they do not depend on the path.
    double step = 0.01;
    std::function<bool()> stop_requested;  ///< asked between steps; may be empty
  };

  /// Reads the mesh, assembles, and prepares contact down to `depth` [m].
  ContinuumPress(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                 meshes::ContactMode contact, double depth, const std::filesystem::path& mesh_file,
                 const Options& options);
  ~ContinuumPress();
  ContinuumPress(const ContinuumPress&) = delete;
  ContinuumPress& operator=(const ContinuumPress&) = delete;

  /// Presses on to `indentation` [m], at least the present one and at most the depth. Throws
  /// NotConverged; Interrupted between steps once `Options::stop_requested` says so.
  PressState advance(double indentation);

  const ElasticTip& tip() const { return tip_; }
  LinearSolver solver() const { return solver_kind_; }
  int contact_unknowns() const;
  /// Displacement of all unknowns [m] and forces of the plane on them [N] at the last sample.
  const Eigen::VectorXd& displacement() const { return displacement_; }
  Eigen::VectorXd plane_force() const;

 private:
  double next_step(double target) const;
  void check_other_nodes() const;
  PressState evaluate() const;

  meshes::Geometry geometry_;
  meshes::ContactMode mode_;
  Options options_;
  ElasticTip tip_;
  LinearSolver solver_kind_;
  std::unique_ptr<ContactSolver> solver_;
  std::unique_ptr<PlaneContact> contact_;
  Eigen::VectorXd displacement_;
};

}  // namespace fingertip::fem_reference
