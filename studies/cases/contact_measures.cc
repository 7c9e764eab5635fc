#include "studies/cases/contact_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/press/taxels.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/force_comparison.h"
#include "studies/report/results/contact_comparison.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;
using meshes::ContactPoint, meshes::PressSample, meshes::TaxelRow;
using Field = std::span<const ContactPoint>;

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

/// Radii of discs as large as a sample's contact and as its part that sticks [m].
struct Discs {
  double contact = 0.0, stick = 0.0;

  explicit Discs(Field sample) {
    for (const ContactPoint& point : sample) {
      contact += point.area;
      if (point.state == meshes::ContactState::stick) stick += point.area;
    }
    for (double* disc : {&contact, &stick}) *disc = std::sqrt(*disc / std::numbers::pi);
  }
};

double stick_radius_error(Field press, Field wanted) {
  const auto own = meshes::samples_of(press), others = meshes::samples_of(wanted);
  if (own.empty() || own.size() != others.size()) return meshes::unknown;
  double worst = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i].front().sample != others[i].front().sample) return meshes::unknown;
    const Discs mine(own[i]), theirs(others[i]);
    worst = larger(worst, std::abs(mine.stick - theirs.stick) / theirs.contact);
  }
  return worst;
}

double taxel_error(const std::vector<TaxelRow>& press, const std::vector<TaxelRow>& wanted) {
  if (wanted.empty() || press.size() != wanted.size()) return meshes::unknown;
  double scale = 0.0;
  for (const TaxelRow& row : wanted) scale = larger(scale, row.normal_stress);
  if (!(scale > 0.0)) return meshes::unknown;
  double worst = 0.0;
  auto other = wanted.begin();
  for (const auto sample : meshes::samples_of(press)) {
    double squares = 0.0;
    for (const TaxelRow& row : sample) {
      if (row.sample != other->sample || row.taxel != other->taxel) return meshes::unknown;
      for (const auto stress : {&TaxelRow::normal_stress, &TaxelRow::shear_u, &TaxelRow::shear_v})
        squares += std::pow(row.*stress - (*other).*stress, 2);
      ++other;
    }
    worst = larger(worst, std::sqrt(squares / (3.0 * double(sample.size()))) / scale);
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
  const auto contacts =
      report::compared_contacts({{"", {}, &wanted, &wanted_field}, {"", {}, &own, &own_field}});
  if (contacts.runs.size() == 2 && !contacts.depths.empty()) {
    errors.field = contacts.depths.back().difference(1);
    errors.hertz = hertz_error(setup, contacts.depths.back().fields.front());
  }
  if (setup.protocol.contact == meshes::ContactMode::coulomb)
    errors.stick_radius = stick_radius_error(own_field, wanted_field);
  const auto felt = rows_in<TaxelRow>(press / "taxels.csv");
  errors.taxels = taxel_error(felt, rows_in<TaxelRow>(reference / "taxels.csv"));
  for (const auto sample : meshes::samples_of(felt))
    if (std::size_t(sample.front().sample) == own.pressing().size())
      errors.skin_force = std::abs(felt_force(sample) / own.pressing().back().normal_force - 1.0);
  return errors;
}

}  // namespace fingertip::studies::inline cases
