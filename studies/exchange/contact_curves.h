/// The continuum's forces that contact laws of other programs are fitted to and judged by.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/contact_laws/pressure_law.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline exchange {

/// A press against one obstacle.
struct ContactCurve {
  std::string name;  ///< "plane", "sphere of 5 mm"
  meshes::Obstacle obstacle;
  bool fitted = false;              ///< else predicted
  calibration::ForceCurve forces;   ///< empty where the press did not converge
  std::vector<double> force_error;  ///< estimated [N]
  /// At which friction lets go of a turn about the normal, over its coefficient [N m]; NaN where
  /// the contact is not known.
  std::vector<double> greatest_moment;
  std::vector<double> lattice;  ///< forces of the lattice at rest, where it was pressed [N]

  bool empty() const { return forces.force.empty(); }
};

/// Presses of the configuration's finger against its own obstacle, which is fitted, and against two
/// of other radii: of a plane balls of the pole's radius and of half of it, else the same shape at
/// twice and half the radius. Twelve depths to press.depth.
class ContactCurves {
 public:
  enum class Of { contacts, body, lattice };
  /// Of a soft body or a lattice: its own obstacle alone; and the lattice at rest, where it can
  /// rest, beside the continuum. Throws ConfigError for what is not fitted: a tilt, a lateral
  /// motion, a program.
  explicit ContactCurves(const LoadedConfig& loaded, Of of = Of::contacts);

  /// The continuum's jobs; the own obstacle's must converge, others are exhibits, as the lattice's
  /// is after them. The continuum is at large strain unless reference.strain is given.
  const std::vector<PlannedJob>& jobs() const { return jobs_; }
  /// What they left below `folder`, in the same order.
  std::vector<ContactCurve> read(const std::filesystem::path& folder) const;

 private:
  std::vector<ContactCurve> curves_;
  std::vector<PlannedJob> jobs_;
};

/// What keeps a press from being one straight down: a tilt, a lateral motion, a program.
std::vector<meshes::Violation> not_straight(const meshes::PressProtocol& protocol);

/// What is not handed over of this press, with what to do; the first word is the key.
std::vector<meshes::Violation> lost_in_contact(const LoadedConfig& loaded);

}  // namespace fingertip::studies::inline exchange
