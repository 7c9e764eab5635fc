#include "studies/exchange/pressure_law_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/exchange/texts/texts.h"
#include "studies/files/read_fields.h"

namespace fingertip::studies::inline exchange {

namespace {

using namespace calibration;

/// Of newton's table, of the highest pressure over the depth: where the fit has none.
constexpr double least_slope = 1e-6;
/// What is rigid in newton, over the finger.
constexpr double times_steeper = 1000.0;

struct Laws {
  PressureTable table;
  PowerLaw power;
  PressurePolynomial polynomial, line;
};

std::string readme(const PressureLawFile& law) {
  return filled("pressure_law_readme.txt", fmt::arg("finger", law.finger),
                fmt::arg("stiffness", law.stiffness), fmt::arg("exponent", law.exponent),
                fmt::arg("first", law.polynomial[0]), fmt::arg("second", law.polynomial[1]),
                fmt::arg("third", law.polynomial[2]), fmt::arg("line", law.line),
                fmt::arg("modulus", law.hydroelastic_modulus), fmt::arg("extent", law.extent),
                fmt::arg("obstacle", law.obstacle), fmt::arg("contact", law.contact),
                fmt::arg("depth", 1e3 * law.depth));
}

/// Overlaps with the obstacle of each curve.
class CurveOverlaps {
 public:
  template <typename Make>
  CurveOverlaps(const ContactSource& source, const Make& make)
      : fitted_(source.curves.front().name) {
    const lattice::PressSetup& press = source.loaded.config.press;
    for (const ContactCurve& curve : source.curves)
      of_.emplace(curve.name, make(press.geometry, curve.obstacle, press.protocol.depth));
  }

  const Overlaps& fitted() const { return of_.at(fitted_); }
  template <typename Law>
  ForetoldModel model(const std::string& name, const Law& law) const {
    return by_law(name, [of = of_, law](const ContactCurve& curve, double at) {
      return force_of(law, of.at(curve.name)(at));
    });
  }

 private:
  std::string fitted_;
  std::map<std::string, Overlaps> of_;
};

/// With brackets, as Python has it.
std::string list(const std::vector<double>& numbers) {
  return fmt::format("[{:.9g}]", fmt::join(numbers, ", "));
}

}  // namespace

ContactExport pressure_law_export(const ContactSource& source) {
  const lattice::PressSetup& press = source.loaded.config.press;
  const CurveOverlaps overlaps(source, gap_field);
  const Overlaps& own = overlaps.fitted();
  const ForceCurve& fitted = source.curves.front().forces;
  const Laws laws{fitted_table(fitted, own), fitted_power(fitted, own),
                  fitted_polynomial(fitted, own), fitted_line(fitted, own)};
  PressureLawFile law;
  law.finger = press.geometry.shape_name();
  law.obstacle = source.curves.front().name;
  law.contact = meshes::name(press.protocol.contact);
  law.depth = press.protocol.depth;
  law.stiffness = laws.power.stiffness;
  law.exponent = laws.power.exponent;
  law.polynomial = {laws.polynomial.first, laws.polynomial.second, laws.polynomial.third};
  law.line = laws.line.first;
  law.extent = meshes::shape_of(press.geometry)->pole_radius();
  law.hydroelastic_modulus = law.line * law.extent;
  law.penetration = laws.table.penetration;
  law.pressure = laws.table.pressure;
  std::string table = "penetration [m],pressure [Pa]\n";
  for (std::size_t i = 0; i < law.penetration.size(); ++i)
    table += meshes::to_text(law.penetration[i]) + ',' + meshes::to_text(law.pressure[i]) + '\n';
  ContactExport made;
  made.files = {{"pressure_law.json", json_of(law).dump(2) + "\n"}, {"pressure_table.csv", table}};
  made.readme = readme(law);
  made.said =
      fmt::format("p = {:.4g} d^{:.3f} [Pa, m]; hydroelastic modulus {:.4g} Pa over {:.3g} m\n",
                  law.stiffness, law.exponent, law.hydroelastic_modulus, law.extent);
  made.transfer = transfer_of(
      "pressure-law",
      "Force of a law, integrated over the overlap of the undeformed bodies, over that "
      "of the continuum",
      source.lost, source.curves,
      {overlaps.model("table", laws.table), overlaps.model("power", laws.power),
       overlaps.model("polynomial", laws.polynomial), overlaps.model("line", laws.line)});
  return made;
}

ContactExport newton_export(const ContactSource& source) {
  const lattice::PressSetup& press = source.loaded.config.press;
  const CurveOverlaps overlaps(source, surface_distances);
  const ForceCurve& fitted = source.curves.front().forces;
  PressureTable table = fitted_table(fitted, overlaps.fitted());
  const PressurePolynomial line = fitted_line(fitted, overlaps.fitted());
  // The patch is where two pressures are equal: beyond the surface they must fall, too.
  const double depth = table.penetration.back(), highest = table.pressure.back();
  double steepest = 0.0;
  for (std::size_t i = 1; i < table.pressure.size(); ++i) {
    table.pressure[i] += least_slope * highest * table.penetration[i] / depth;
    steepest = std::max(steepest, (table.pressure[i] - table.pressure[i - 1]) /
                                      (table.penetration[i] - table.penetration[i - 1]));
  }
  const auto file = [&](const char* name) {
    return filled(name, fmt::arg("finger", press.geometry.shape_name()),
                  fmt::arg("obstacle", source.curves.front().name),
                  fmt::arg("contact", meshes::name(press.protocol.contact)),
                  fmt::arg("depth", 1e3 * press.protocol.depth),
                  fmt::arg("penetration", list(table.penetration)),
                  fmt::arg("pressure", list(table.pressure)),
                  fmt::arg("rigid", times_steeper * steepest), fmt::arg("line", line.first));
  };
  ContactExport made;
  made.files = {{"newton_finger.py", file("newton_finger.py")}};
  made.readme = file("newton_readme.txt");
  made.said = fmt::format("newton's kh {:.4g} Pa/m, or a table of {} pressures\n", line.first,
                          table.pressure.size());
  made.transfer = transfer_of("newton",
                              "Force of a law, integrated over the obstacle's surface in the "
                              "finger, over that of the continuum",
                              source.lost, source.curves,
                              {overlaps.model("table", table), overlaps.model("kh", line)});
  return made;
}

}  // namespace fingertip::studies::inline exchange
