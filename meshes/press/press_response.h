/// What a press yields, from whichever model: force, torque and contact against indentation.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "meshes/tables/csv_table.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline press {

/// Of a sample, what its errors follow from (PressSample::set_errors): none negative.
struct RelativeErrors {
  double normal = unknown;  ///< of the normal force
  double aside = unknown;   ///< of the lateral force
  double spin = unknown;    ///< of the spin torque
  double centre = 0.0;      ///< of the centre of what sticks, over the contact's radius
  double lever = 0.0;       ///< from the rod's endpoint to the contact [m]
};

/// One row of response.csv, SI. Signs: n points from the plane toward the rod; normal_force = F·n
/// >= 0 in compression with F the sum of bond forces on the rod; torque about the rod's endpoint
/// in the rod's starting axes, right-handed; indentation > 0 when pressed.
struct PressSample {
  double indentation = 0.0;          ///< [m]
  double normal_force = 0.0;         ///< [N]
  double lateral_force_x = unknown;  ///< along t1 [N]
  double lateral_force_y = unknown;  ///< along t2 [N]
  double torque_x = unknown;         ///< [N m]
  double torque_y = unknown;         ///< [N m]
  double torque_z = unknown;         ///< [N m]
  double contact_radius = unknown;   ///< of the circle that has the contact's area [m]
  double contact_area = unknown;     ///< seen along the normal [m²]
  double mean_pressure = unknown;    ///< normal_force over it [Pa]
  double max_pressure = unknown;     ///< [Pa]
  double force_error = unknown;      ///< estimated error of normal_force [N]
  double step_error = unknown;       ///< of it, what the steps of a lattice at rest leave [N]
  double time = unknown;             ///< since the start of the press [s]; empty for static runs
  double lateral_displacement = unknown;  ///< of the plane along t1, seen from the rod [m]
  double twist = unknown;                 ///< of the plane about n, seen from the rod [rad]
  double spin_torque =
      unknown;  ///< of the plane on the tip about n at the centre of pressure [N m]
  double lateral_force_error = unknown;  ///< length of the estimated error of both [N]
  double torque_error = unknown;         ///< length of the estimated error of all three [N m]
  double stage = unknown;                ///< of the press's program, from 1; unknown without one
  /// Estimated root mean square over the contact of what its pressures are off [Pa].
  double pressure_error = unknown;
  /// Of the normal force of a lattice at rest by the rubber's moduli: by E at held Poisson's ratio
  /// [N/Pa = m²], by Poisson's ratio at held E [N].
  double slope_youngs_modulus = unknown, slope_poissons_ratio = unknown;
  /// Estimated errors of what they are called by, of a continuum from its meshes [m], [m²], [Pa].
  double contact_radius_error = unknown, contact_area_error = unknown, max_pressure_error = unknown;

  /// Radius, area, mean and largest pressure; the normal force must be known by then.
  void set_contact(double radius, double peak);
  /// Force and torque as vectors; nothing where one of them is unknown.
  Eigen::Vector3d force() const { return {lateral_force_x, lateral_force_y, normal_force}; }
  Eigen::Vector3d torque() const { return {torque_x, torque_y, torque_z}; }
  /// Whether both stand at one place of one stage, to 1e-9 of it.
  bool is_beside(const PressSample& other) const;
  /// From those of N, Q and M = spin_torque, a the contact's radius, T the torque, T'² = T² - M²;
  /// sources that have nothing to do with each other, so that squares are added:
  ///   lateral  aside |Q|
  ///            normal |N|/8: what is off of the pressure pushes aside by (1 - 2 nu)/(2 - 2 nu),
  ///            1/8 at nu = 0.43
  ///            s = centre |M|/a: a turn about another centre moves what sticks, nearly by
  ///            8 G a/(2 - nu) (3 |M|/(16 G a³)) centre a
  ///   torque   spin |M|
  ///            normal (T' + a (|N| + |Q|)) where something pushes aside: the place of the force
  ///            is known to that share of a
  ///            lever ((aside - normal) |Q| + s): what Q is off beyond that
  /// Unknown where symmetry leaves no Q or no T.
  void set_errors(const RelativeErrors& relative);
  void set_errors(double relative) {
    set_errors({.normal = relative, .aside = relative, .spin = relative});
  }
  /// By what its force is off, and besides by `profile`, over the largest pressure; unknown where
  /// one of these is.
  void set_pressure_error(double profile);
};

/// The columns of response.csv.
consteval auto fields_of(const PressSample*) {
  return FINGERTIP_ALL_MEMBERS(
             PressSample, indentation, normal_force, lateral_force_x, lateral_force_y, torque_x,
             torque_y, torque_z, contact_radius, max_pressure, force_error, time, contact_area,
             mean_pressure, lateral_displacement, twist, spin_torque, lateral_force_error,
             torque_error, stage, pressure_error, contact_radius_error, contact_area_error,
             max_pressure_error, step_error, slope_youngs_modulus, slope_poissons_ratio)
      .in("m", "indentation contact_radius lateral_displacement contact_radius_error")
      .in("rad", "twist")
      .in("N",
          "normal_force lateral_force_x lateral_force_y force_error step_error lateral_force_error "
          "slope_poissons_ratio")
      .in("N m", "torque_x torque_y torque_z spin_torque torque_error")
      .in("m^2", "contact_area contact_area_error slope_youngs_modulus")
      .in("Pa", "mean_pressure max_pressure pressure_error max_pressure_error")
      .in("s", "time")
      .if_known(
          "lateral_displacement twist spin_torque lateral_force_error torque_error stage "
          "pressure_error contact_radius_error contact_area_error max_pressure_error step_error "
          "slope_youngs_modulus slope_poissons_ratio");
}

/// A curve of samples by increasing indentation, and then, where a lateral motion or a twist
/// follows the press, at full depth by increasing distance or angle; of a program its first stage
/// by increasing indentation, and then the others in the order of time.
class PressResponse {
 public:
  PressResponse() = default;
  explicit PressResponse(std::vector<PressSample> samples) : samples_(std::move(samples)) {}

  const std::vector<PressSample>& samples() const { return samples_; }
  /// The last one, to be completed. Not of an empty response.
  PressSample& back() { return samples_.back(); }
  bool empty() const { return samples_.empty(); }
  void append(const PressSample& sample) { samples_.push_back(sample); }

  /// The samples of the first loading: by increasing indentation.
  std::span<const PressSample> pressing() const;
  /// Those of the lateral motion or twist that follows, all at full depth; mostly none.
  std::span<const PressSample> sliding() const;

  /// Those of the further stages of a program; mostly none.
  std::span<const PressSample> following() const;

  /// Largest indentation of the first loading, up to which forces are known [m]; 0 when empty.
  double depth() const { return samples_.empty() ? 0.0 : pressing().back().indentation; }
  /// Largest indentation reached, in a later stage of a program perhaps [m]; 0 when empty.
  double deepest() const;

  /// Normal force [N] at `indentation` [m] by monotone piecewise-cubic interpolation
  /// (Fritsch & Carlson 1980) through pressing() and the origin, so that it never overshoots.
  /// Throws std::out_of_range beyond the largest sample or below zero.
  double normal_force_at(double indentation) const;

  /// force_error over the force, of the first loading's sample there; elsewhere the larger one of
  /// the samples beside, before and behind all that have one that of the nearest; NaN where none
  /// has.
  double relative_error_at(double indentation) const;

  /// Writes the CSV whose first line holds names with units (see README), atomically.
  void write_csv(const std::filesystem::path& file) const;

  /// Reads a CSV with at least the columns `indentation [m]` and `normal_force [N]`; others may
  /// be missing or empty. Throws InvalidInput naming file and line for a missing column, a cell
  /// that is no number, a truncated row, or indentations that do not increase, unless it is the
  /// lateral displacement or twist that does, or the stage of a program and with it the time.
  static PressResponse read_csv(const std::filesystem::path& file);
  static PressResponse of(const CsvTable& table);

 private:
  std::vector<PressSample> samples_;
};

/// (F(indentation) - F_ref(indentation)) / F_ref(indentation), dimensionless, for
/// 0 < indentation <= both depths [m]. Throws std::out_of_range beyond; NaN where F_ref vanishes.
double relative_force_error(const PressResponse& response, const PressResponse& reference,
                            double indentation);

/// sqrt(∫(F - F_ref)² / ∫F_ref²), dimensionless, over 0 <= from < to <= both depths [m], by the
/// trapezoidal rule on 200 intervals. Throws std::out_of_range beyond the depths.
double relative_l2_force_error(const PressResponse& response, const PressResponse& reference,
                               double from, double to);

}  // namespace fingertip::meshes::inline press
