#include "studies/cases/contact_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meshes/press/taxels.h"
#include "meshes/tables/table_rows.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::ContactPoint;
using meshes::PressSample;
using meshes::TaxelRow;

namespace {

/// Hertz's pressure for this force between the setup's ball and plane, times `scale`.
std::vector<ContactPoint> hertz_field(const lattice::PressSetup& setup, double force,
                                      double scale) {
  const double nu = setup.rubber.poissons_ratio(),
               modulus = setup.rubber.youngs_modulus / (1.0 - nu * nu),
               a = std::cbrt(0.75 * force * setup.geometry.tip_radius / modulus),
               peak = 1.5 * force / (std::numbers::pi * a * a);
  std::vector<ContactPoint> field;
  constexpr int rings = 60;
  for (int i = 0; i < rings; ++i) {
    const double r = a * (i + 0.5) / rings;
    ContactPoint ring{.sample = 1, .indentation = 1e-3, .place = {r, 0.0, 0.0}};
    ring.area = 2.0 * std::numbers::pi * r * a / rings;
    ring.normal_traction = scale * peak * std::sqrt(1.0 - r * r / (a * a));
    for (const ContactPoint& point : meshes::turned_around(ring, 48)) field.push_back(point);
  }
  return field;
}

void write_run(const std::filesystem::path& folder, const std::vector<ContactPoint>& field,
               const std::vector<TaxelRow>& taxels, double torque) {
  std::filesystem::create_directories(folder);
  meshes::PressResponse({PressSample{.indentation = 1e-3,
                                     .normal_force = 0.01,
                                     .lateral_force_x = 0.0,
                                     .spin_torque = torque}})
      .write_csv(folder / "response.csv");
  meshes::write_rows(field, folder / "contact_field.csv");
  if (!taxels.empty()) meshes::write_rows(taxels, folder / "taxels.csv");
}

TaxelRow taxel(int number, double normal, double shear) {
  return {.sample = 1,
          .indentation = 1e-3,
          .taxel = number,
          .area = 1e-5,
          .normal_stress = normal,
          .shear_u = shear};
}

TEST(ContactErrors, AreThoseOfFieldsTorquesAndTaxels) {
  const TemporaryFolder folder;
  lattice::PressSetup setup;
  setup.protocol.contact = meshes::ContactMode::frictionless;
  write_run(folder / "a", hertz_field(setup, 0.01, 1.1), {taxel(1, 530.0, 30.0), taxel(2, 0, 0)},
            1.2e-6);
  write_run(folder / "b", hertz_field(setup, 0.01, 1.0), {taxel(1, 500.0, 0.0), taxel(2, 0, 0)},
            1.0e-6);
  const ContactErrors errors = contact_errors(setup, folder / "a", folder / "b");
  // Of a tenth of Hertz's pressure, whose mean square over the contact is half its peak's.
  EXPECT_NEAR(errors.field.pressure_l2, 0.1 / std::sqrt(2.0), 0.002);
  EXPECT_NEAR(errors.field.peak, 0.1, 0.002);
  EXPECT_NEAR(errors.hertz, 0.0, 0.005);
  EXPECT_NEAR(errors.torque, 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(errors.lateral));
  EXPECT_NEAR(errors.taxels, std::sqrt((30.0 * 30.0 + 30.0 * 30.0) / 6.0) / 500.0, 1e-12);
  EXPECT_NEAR(errors.skin_force, std::abs(530.0 * 1e-5 / 0.01 - 1.0), 1e-12);
}

TEST(ContactErrors, OfWhatSticksAreThoseOfItsRadius) {
  const TemporaryFolder folder;
  lattice::PressSetup setup;
  setup.protocol.contact = meshes::ContactMode::coulomb;
  const auto stuck_to = [&](double share) {  // of the radius
    auto field = hertz_field(setup, 0.01, 1.0);
    double a = 0.0;
    for (const ContactPoint& point : field) a = std::max(a, point.place.head<2>().norm());
    for (ContactPoint& point : field)
      if (point.place.head<2>().norm() > share * a) point.state = meshes::ContactState::slip;
    return field;
  };
  write_run(folder / "a", stuck_to(0.5), {}, 0.0);
  write_run(folder / "b", stuck_to(0.6), {}, 0.0);
  EXPECT_NEAR(contact_errors(setup, folder / "a", folder / "b").stick_radius, 0.1, 0.02);
  setup.protocol.contact = meshes::ContactMode::stick;
  EXPECT_TRUE(std::isnan(contact_errors(setup, folder / "a", folder / "b").stick_radius));
}

TEST(ContactErrors, OfWhatIsMissingAreUnknown) {
  const TemporaryFolder folder;
  lattice::PressSetup setup;
  setup.protocol.contact = meshes::ContactMode::frictionless;
  write_run(folder / "a", hertz_field(setup, 0.01, 1.0), {}, 0.0);
  write_run(folder / "b", hertz_field(setup, 0.01, 1.0), {taxel(1, 0.0, 0.0)}, 0.0);
  const ContactErrors errors = contact_errors(setup, folder / "a", folder / "b");
  EXPECT_TRUE(std::isnan(errors.taxels));
  EXPECT_TRUE(std::isnan(errors.skin_force));
  // A skin that feels nothing is no success.
  write_run(folder / "a", {}, {taxel(1, 0.0, 0.0)}, 0.0);
  EXPECT_TRUE(std::isnan(contact_errors(setup, folder / "a", folder / "b").taxels));
  EXPECT_TRUE(std::isnan(contact_errors(setup, folder / "a", folder / "b").field.pressure_l2));
  // Hertz knows neither friction nor tilt.
  setup.protocol.tilt = 0.1;
  EXPECT_TRUE(std::isnan(contact_errors(setup, folder / "b", folder / "b").hertz));
  setup.protocol.tilt = 0.0;
  setup.protocol.contact = meshes::ContactMode::stick;
  EXPECT_TRUE(std::isnan(contact_errors(setup, folder / "b", folder / "b").hertz));
}

}  // namespace
