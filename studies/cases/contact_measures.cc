#include "studies/cases/contact_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/press/taxels.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/force_comparison.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;
using meshes::ContactPoint, meshes::PressSample, meshes::TaxelRow;
using Field = std::span<const ContactPoint>;

constexpr Eigen::Index places = 81;  ///< along each side of the raster

template <typename Row>
std::vector<Row> rows_in(const fs::path& file) {
  return fs::exists(file) ? meshes::read_rows<Row>(file) : std::vector<Row>();
}

/// Largest difference of a value at the same samples, over the largest.
double largest_difference(std::span<const PressSample> press, std::span<const PressSample> wanted,
                          double PressSample::*value) {
  if (press.size() != wanted.size()) return meshes::unknown;
  double most = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < press.size(); ++i) {
    most = larger(most, std::abs(press[i].*value - wanted[i].*value));
    scale = larger(scale, std::abs(wanted[i].*value));
  }
  return most / scale;
}

/// Of a sample, none where it did not touch.
Field field_of(const std::vector<ContactPoint>& field, int sample) {
  for (const Field points : meshes::samples_of(field))
    if (points.front().sample == sample) return points;
  return {};
}

/// Radius of the ball on a plane that the two are to Hertz; nothing where they are none, or do not
/// touch in the axis.
std::optional<double> hertz_radius(const lattice::PressSetup& setup) {
  const meshes::Obstacle& obstacle = setup.protocol.obstacle;
  const bool ball = obstacle.shape == meshes::ObstacleShape::sphere;
  if (setup.protocol.contact != meshes::ContactMode::frictionless ||
      setup.lattice.kinematics != lattice::Kinematics::small || setup.geometry.solid ||
      (!ball && !obstacle.is_plane()) || setup.protocol.tilt != 0.0 || obstacle.offset != 0.0)
    return {};
  const double finger = shape_of(setup.geometry)->pole_radius();
  return 1.0 / (1.0 / finger + (ball ? 1.0 / obstacle.radius : 0.0));
}

double hertz_error(const lattice::PressSetup& setup, Field field) {
  const std::optional<double> radius = hertz_radius(setup);
  if (!radius || field.empty()) return meshes::unknown;
  const double force = -meshes::sums_of(field, meshes::Vector3::Zero()).force.z(),
               nu = setup.rubber.poissons_ratio(),
               modulus = setup.rubber.youngs_modulus / (1.0 - nu * nu),
               a = std::cbrt(0.75 * force * *radius / modulus),
               peak = 1.5 * force / (std::numbers::pi * a * a);
  double squares = 0.0, area = 0.0;
  for (const ContactPoint& point : field) {
    const double r = point.place.head<2>().norm() / a,
                 off = point.normal_traction / peak - std::sqrt(std::max(0.0, 1.0 - r * r));
    squares += point.area * off * off;
    area += point.area;
  }
  return std::sqrt(squares / area);
}

double taxel_error(const std::vector<TaxelRow>& press, const std::vector<TaxelRow>& wanted) {
  if (wanted.empty() || press.size() != wanted.size()) return meshes::unknown;
  double scale = 0.0;
  for (const TaxelRow& row : wanted) scale = larger(scale, row.normal_stress);
  if (!(scale > 0.0)) return meshes::unknown;
  double worst = 0.0;
  for (std::size_t i = 0; i < press.size();) {
    double squares = 0.0;
    std::size_t end = i;
    for (; end < press.size() && press[end].sample == press[i].sample; ++end) {
      if (press[end].sample != wanted[end].sample || press[end].taxel != wanted[end].taxel)
        return meshes::unknown;
      for (const auto stress : {&TaxelRow::normal_stress, &TaxelRow::shear_u, &TaxelRow::shear_v})
        squares += std::pow(press[end].*stress - wanted[end].*stress, 2);
    }
    worst = larger(worst, std::sqrt(squares / (3.0 * double(end - i))) / scale);
    i = end;
  }
  return worst;
}

}  // namespace

ContactErrors contact_errors(const lattice::PressSetup& setup, const fs::path& press,
                             const fs::path& reference) {
  ContactErrors errors;
  const meshes::PressResponse own = response_in(press), wanted = response_in(reference);
  errors.lateral =
      largest_difference(own.samples(), wanted.samples(), &PressSample::lateral_force_x);
  errors.torque = largest_difference(own.samples(), wanted.samples(), &PressSample::spin_torque);
  const auto own_field = rows_in<ContactPoint>(press / "contact_field.csv"),
             wanted_field = rows_in<ContactPoint>(reference / "contact_field.csv");
  const int last = int(own.pressing().size());
  const std::array<Field, 2> fields{field_of(wanted_field, last), field_of(own_field, last)};
  if (!fields[0].empty() && !fields[1].empty()) {
    const meshes::Raster raster = meshes::raster_around(fields, places);
    errors.field = difference_of(contact_map(fields[1], raster), contact_map(fields[0], raster));
  }
  errors.hertz = hertz_error(setup, fields[0]);
  const auto felt = rows_in<TaxelRow>(press / "taxels.csv");
  errors.taxels = taxel_error(felt, rows_in<TaxelRow>(reference / "taxels.csv"));
  double force = 0.0;
  for (const TaxelRow& row : felt)
    if (row.sample == last) force += row.area * row.normal_stress;
  if (!felt.empty() && last > 0)
    errors.skin_force = std::abs(force / own.pressing().back().normal_force - 1.0);
  return errors;
}

}  // namespace fingertip::studies::inline cases
