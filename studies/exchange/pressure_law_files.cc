#include "studies/exchange/pressure_law_files.h"

#include <fmt/format.h>

#include <map>

#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/exchange/texts/texts.h"
#include "studies/files/read_fields.h"

namespace fingertip::studies::inline exchange {

namespace {

using namespace calibration;

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

}  // namespace

ContactExport pressure_law_export(const ContactSource& source) {
  const lattice::PressSetup& press = source.loaded.config.press;
  const double depth = press.protocol.depth;
  std::map<std::string, GapField> fields;
  for (const ContactCurve& curve : source.curves)
    fields.emplace(curve.name, gap_field(press.geometry, curve.obstacle, depth));
  const GapField& own = fields.at(source.curves.front().name);
  const ForceCurve& fitted = source.curves.front().forces;
  const Laws laws{fitted_table(fitted, own), fitted_power(fitted, own),
                  fitted_polynomial(fitted, own), fitted_line(fitted, own)};
  PressureLawFile law;
  law.finger = press.geometry.shape_name();
  law.obstacle = source.curves.front().name;
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
  std::string table = "penetration [m],pressure [Pa]\n";
  for (std::size_t i = 0; i < law.penetration.size(); ++i)
    table += meshes::to_text(law.penetration[i]) + ',' + meshes::to_text(law.pressure[i]) + '\n';
  const auto model = [&fields](const char* name, const auto& fitted_law) {
    return by_law(name, [&fields, fitted_law](const ContactCurve& curve, double at) {
      return force_of(fitted_law, fields.at(curve.name), at);
    });
  };
  ContactExport made;
  made.files = {{"pressure_law.json", json_of(law).dump(2) + "\n"}, {"pressure_table.csv", table}};
  made.readme = readme(law);
  made.said =
      fmt::format("p = {:.4g} d^{:.3f} [Pa, m]; hydroelastic modulus {:.4g} Pa over {:.3g} m\n",
                  law.stiffness, law.exponent, law.hydroelastic_modulus, law.extent);
  made.transfer =
      transfer_of("pressure-law",
                  "Force of a law, integrated over the overlap of the undeformed bodies, over that "
                  "of the continuum",
                  source.lost, source.curves,
                  {model("table", laws.table), model("power", laws.power),
                   model("polynomial", laws.polynomial), model("line", laws.line)});
  return made;
}

}  // namespace fingertip::studies::inline exchange
