/// A skin of taxels: where they lie on the finger, and what they feel of a contact.
#pragma once

#include <span>
#include <vector>

#include "meshes/press/contact_field.h"
#include "meshes/shape/shape.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline press {

/// On the surface that may touch, in the undeformed finger.
struct Taxel {
  Vector3 place = Vector3::Zero();    ///< [m]
  Vector3 normal = Vector3::UnitZ();  ///< unit, out of the rubber
  double area = 0.0;                  ///< of the surface that it stands for [m²]
};
FINGERTIP_FIELDS(Taxel, place, normal, area);

/// What all taxels have in common, and where they are. Empty: no skin.
struct TaxelSkin {
  std::vector<Taxel> taxels = {};
  double depth = 0.0;         ///< below the surface, along its normal [m], >= 0
  double footprint = 1.0e-3;  ///< diameter of the disc over which a taxel averages [m], > 0

  /// Broken rules of depth and footprint (sensor.depth, sensor.footprint); none of no skin.
  std::vector<Violation> violations() const;
};
FINGERTIP_FIELDS(TaxelSkin, taxels, depth, footprint);

/// Stress on the taxel's disc, per area of the undeformed finger, of the obstacle's side on the
/// other one [Pa]. Axes: of the surface where the taxel is, u, v and the outward normal, which are
/// x, y and z turned along the shortest way from z to that normal.
struct TaxelReading {
  double normal_stress = 0.0;  ///< positive where the taxel is pressed
  double shear_u = 0.0, shear_v = 0.0;
};
FINGERTIP_FIELDS(TaxelReading, normal_stress, shear_u, shear_v);

/// The taxel nearest to a place [m]. Throws InvalidInput (key sensor.taxels) where that is farther
/// than a hundredth of the finger's largest radius from the surface that may touch, or at least as
/// near to the bond.
Taxel taxel_at(const Shape& shape, const Vector3& place);

/// `per_ring` taxels in each of `rings` around the pole, `pitch` [m] apart along the surface, the
/// first half a pitch away from the pole and from the x axis; an area is that between the middles.
/// Throws InvalidInput (key sensor.taxels) for a ring beyond the surface that may touch.
std::vector<Taxel> taxel_rings(const Shape& shape, int rings, int per_ring, double pitch);

/// What each taxel feels of one sample of a contact. `axes` are the finger's x, y, z as columns
/// along those of the points.
///
/// On the surface: the mean over the footprint of the field between its points (FootprintMeans).
/// Sums over a dense array times its areas are the contact's forces but for what the points leave
/// open: 0.5 % where the contact is some ten points wide. Below it: as the half space under the
/// flattened skin conducts a force F on its surface, from which r leads to the taxel:
///   stress on the parallel plane at depth h = 3 h (F·r) r/(2π |r|⁵)
/// (Boussinesq and Cerruti; Johnson, Contact Mechanics, 1985, sections 3.2 and 3.6), whatever
/// Poisson's ratio, spread over a disc of both areas' second moment. Curvature and the bond below
/// are not in it.
/// A skin that turns with the obstacle turns its normal along the shortest way, and u, v with it.
std::vector<TaxelReading> taxel_readings(std::span<const ContactPoint> points,
                                         const TaxelSkin& skin,
                                         const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

/// A row of taxels.csv.
struct TaxelRow {
  int sample = 0;                                            ///< row of response.csv, from 1
  double indentation = unknown;                              ///< there [m]
  int taxel = 0;                                             ///< from 1
  Vector3 place = Vector3::Zero();                           ///< Taxel::place [m]
  double area = 0.0;                                         ///< Taxel::area [m²]
  double normal_stress = 0.0, shear_u = 0.0, shear_v = 0.0;  ///< TaxelReading [Pa]
  double error = unknown;  ///< estimated, of each of them; unknown below the surface [Pa]
  /// Of what the field resolves there; 0 where nothing touches, unknown below the surface [m].
  double spacing = unknown;
};
consteval auto fields_of(const TaxelRow*) {
  return FINGERTIP_ALL_MEMBERS(TaxelRow, sample, indentation, taxel, place, area, normal_stress,
                               shear_u, shear_v, error, spacing)
      .in("m", "indentation place spacing")
      .in("m^2", "area")
      .in("Pa", "normal_stress shear_u shear_v error")
      .if_known("error spacing")
      .called("place", "x,y,z");
}

/// What the taxels of one sample feel together: areas times normal stress [N].
double felt_force(std::span<const TaxelRow> sample);

/// The coarsest that the field resolves where they touch; 0 where none does [m].
double coarsest_spacing(std::span<const TaxelRow> sample);

/// What is known of a field besides its points.
struct FieldQuality {
  std::vector<double> pressure_errors = {};  ///< PressSample::pressure_error per row, maybe unknown
  double spacing = 0.0;  ///< of what is behind the points: a lattice's particles [m]
};

/// A row for each taxel in each sample of a field (contact_field.csv). A row's error is what the
/// pressures are off, where that is known, and what the points leave open (FootprintMean::error).
std::vector<TaxelRow> taxel_rows(std::span<const ContactPoint> field, const TaxelSkin& skin,
                                 const Eigen::Matrix3d& axes, const FieldQuality& quality = {});

}  // namespace fingertip::meshes::inline press
