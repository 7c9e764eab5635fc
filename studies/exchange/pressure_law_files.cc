#include "studies/exchange/pressure_law_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "meshes/files.h"
#include "meshes/shape.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using namespace calibration;

/// Which of the twelve samples are told: 1/6, 1/3, 1/2, 2/3 and all of the depth.
constexpr std::size_t told[] = {1, 3, 5, 7, 11};

struct Laws {
  PressureTable table;
  PowerLaw power;
  PressurePolynomial polynomial, line;
};

TransferObstacleEntry judged(const ContactCurve& curve, const Laws& laws, const GapField& field) {
  TransferObstacleEntry entry{curve.name, curve.fitted, {}};
  for (const std::size_t i : told) {
    if (curve.empty()) continue;
    const double depth = curve.forces.indentation[i], force = curve.forces.force[i];
    const auto error = [&](const auto& law) { return force_of(law, field, depth) / force - 1.0; };
    entry.depths.push_back({depth, force, curve.force_error[i], error(laws.table),
                            error(laws.power), error(laws.polynomial), error(laws.line)});
  }
  return entry;
}

std::string percent(double share) {
  return std::isnan(share) ? "?" : fmt::format("{:+.1f} %", 100.0 * share);
}

std::string transfer_table(const TransferFile& transfer) {
  std::string text =
      "| obstacle | indentation [mm] | force [N] | table | power | polynomial | line |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const TransferObstacleEntry& obstacle : transfer.obstacles)
    for (const TransferDepthEntry& depth : obstacle.depths)
      text += fmt::format("| {}{} | {:.4g} | {:.4g} | {} | {} | {} | {} |\n", obstacle.obstacle,
                          obstacle.fitted ? " (fitted)" : "", 1e3 * depth.indentation, depth.force,
                          percent(depth.table_error), percent(depth.power_error),
                          percent(depth.polynomial_error), percent(depth.line_error));
  return text;
}

std::string readme(const PressureLawExport& made) {
  const PressureLawFile& law = made.law;
  std::string text = fmt::format(
      "# A finger as pressure over penetration\n\n"
      "Finger ({}) and obstacle keep their shapes and overlap. Where the overlap is d deep, the "
      "pressure is p(d), in Pa over m, whichever of these a program can take:\n\n"
      "| law | p(d) |\n|---|---|\n"
      "| table | `pressure_table.csv`, straight lines between its rows |\n"
      "| power | {:.6g} d^{:.4f} |\n"
      "| polynomial | {:.6g} d + {:.6g} d² + {:.6g} d³ |\n"
      "| line | {:.6g} d: Drake's hydroelastic modulus of {:.6g} Pa for a body of extent {:.4g} m "
      "|\n\n"
      "d is measured along the direction of the press. Fitted to the continuum's forces on a {} "
      "({} contact) up to {:.4g} mm; deeper nothing is known.\n\n",
      law.finger, law.stiffness, law.exponent, law.polynomial[0], law.polynomial[1],
      law.polynomial[2], law.line, law.hydroelastic_modulus, law.extent, law.obstacle, law.contact,
      1e3 * law.depth);
  text += "## Force error to expect\nForce of the law over that of the continuum:\n\n" +
          transfer_table(made.transfer) + "\n";
  if (!made.transfer.lost.empty()) {
    text += "## What is lost\n";
    for (const std::string& lost : made.transfer.lost) text += "- " + lost + "\n";
    text += "\n";
  }
  return text +
         "Numbers: `pressure_law.json`, `transfer.json`. Runs they come from: `continuum/`.\n";
}

}  // namespace

double TransferFile::worst(double TransferDepthEntry::*error, bool fitted) const {
  double most = 0.0;
  for (const TransferObstacleEntry& obstacle : obstacles)
    if (obstacle.fitted == fitted)
      for (const TransferDepthEntry& depth : obstacle.depths)
        most = std::max(most, std::abs(depth.*error));
  return most;
}

PressureLawExport pressure_law_export(const LoadedConfig& loaded,
                                      const std::vector<ContactCurve>& curves,
                                      const std::vector<Problem>& lost) {
  const lattice::PressSetup& press = loaded.config.press;
  const double depth = press.protocol.depth;
  const GapField own = gap_field(press.geometry, curves.front().obstacle, depth);
  const ForceCurve& fitted = curves.front().forces;
  const Laws laws{fitted_table(fitted, own), fitted_power(fitted, own),
                  fitted_polynomial(fitted, own), fitted_line(fitted, own)};
  PressureLawExport made;
  PressureLawFile& law = made.law;
  law.finger = press.geometry.shape_name();
  law.obstacle = curves.front().name;
  law.contact = meshes::name(press.protocol.contact);
  law.depth = depth;
  law.stiffness = laws.power.stiffness;
  law.exponent = laws.power.exponent;
  law.polynomial = {laws.polynomial.first, laws.polynomial.second, laws.polynomial.third};
  law.line = laws.line.first;
  law.extent = meshes::shape_of(press.geometry)->pole_radius();
  law.hydroelastic_modulus = law.line * law.extent;
  law.penetration = laws.table.penetration;
  law.pressure = laws.table.pressure;
  made.transfer.format = "pressure-law";
  made.transfer.how =
      "force of each law, integrated over the overlap of the undeformed bodies, over that of the "
      "continuum";
  for (const Problem& problem : lost)
    made.transfer.lost.push_back(problem.key + " = " + problem.value + ": " + problem.rule);
  for (const ContactCurve& curve : curves)
    made.transfer.obstacles.push_back(
        judged(curve, laws, gap_field(press.geometry, curve.obstacle, depth)));
  return made;
}

void write_pressure_law(const PressureLawExport& made, const std::filesystem::path& folder) {
  write_json(json_of(made.law), folder / "pressure_law.json");
  write_json(json_of(made.transfer), folder / "transfer.json");
  meshes::write_atomically(folder / "pressure_table.csv", [&](std::ostream& out) {
    out << "penetration [m],pressure [Pa]\n";
    for (std::size_t i = 0; i < made.law.penetration.size(); ++i)
      out << meshes::to_text(made.law.penetration[i]) << ','
          << meshes::to_text(made.law.pressure[i]) << '\n';
  });
  meshes::write_atomically(folder / "README.md", [&](std::ostream& out) { out << readme(made); });
}

}  // namespace fingertip::studies
