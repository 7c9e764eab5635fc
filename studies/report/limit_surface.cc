/// What the contact of a press holds by friction.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "meshes/press/limit_surface.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/press_condition.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/terminal.h"
#include "studies/report/page/words.h"
#include "studies/report/report.h"

namespace fingertip::studies::report {
namespace {

namespace fs = std::filesystem;

/// limit_surface.csv: per unit of the coefficient of friction.
struct LimitRow {
  int sample = 0;  ///< row of response.csv, from 1
  double indentation = meshes::unknown;
  double centre = meshes::unknown;  ///< of the turn, from that of pressure; empty: none
  double force = meshes::unknown;
  double moment = meshes::unknown;
};
consteval auto fields_of(const LimitRow*) {
  return FINGERTIP_ALL_MEMBERS(LimitRow, sample, indentation, centre, force, moment)
      .in("m", "indentation centre")
      .in("N", "force")
      .in("N m", "moment");
}

/// A sample's contact and what it holds.
struct HeldSample {
  int sample = 0;
  double indentation = meshes::unknown;
  meshes::LimitSurface surface;
};

std::vector<HeldSample> held_samples(const std::vector<meshes::ContactPoint>& contact) {
  std::vector<HeldSample> samples;
  for (const auto field : meshes::samples_of(contact)) {
    HeldSample held{field.front().sample, field.front().indentation, limit_surface(field)};
    if (!std::isnan(held.surface.normal_force)) samples.push_back(std::move(held));
  }
  return samples;
}

/// By friction there must be something to hold with, and a field that says where.
void require_friction(const fs::path& run, FolderReader& reader) {
  if (!fs::exists(run / "contact_field.csv"))
    throw meshes::InvalidInput({run.string(), "",
                                "holds no contact_field.csv, which every press but that of the "
                                "published model in motion writes",
                                "name the run folder of a press or of a reference"});
  const auto condition = read_condition(run, reader);
  if (condition && condition->contact == "frictionless")
    throw meshes::InvalidInput({run.string(), "press.contact = frictionless",
                                "without friction a contact holds neither force nor moment",
                                "press with press.contact = \"coulomb\" or \"stick\""});
}

Table limit_table(const std::vector<HeldSample>& samples) {
  const ShownUnits& units = shown_units();
  Table table{
      heads({"Indentation\n" + unit_name(units.length), "Normal force N\n" + unit_name(units.force),
             "Contact radius a\n" + unit_name(units.length),
             "Greatest moment/mu\n" + unit_name(units.torque), "over N a", "Ellipse outside\n%",
             "Exponent k"})};
  for (const HeldSample& held : samples) {
    const meshes::LimitSurface& s = held.surface;
    table.rows.push_back(
        {fmt::format("{:.4g}", units.length(held.indentation)),
         amount_cell(s.normal_force, units.force), amount_cell(s.radius, units.length),
         amount_cell(s.greatest_moment, units.torque), fmt::format("{:.4f}", s.moment_share()),
         fmt::format("{:.1f}", 100.0 * s.ellipse_error), fmt::format("{:.2f}", s.exponent)});
  }
  return table;
}

/// "a = 5.75 mm (N/N)^0.30"
std::string law_text(const std::vector<HeldSample>& samples) {
  std::vector<meshes::LimitSurface> surfaces;
  for (const HeldSample& held : samples) surfaces.push_back(held.surface);
  const meshes::RadiusLaw law = meshes::radius_law(surfaces);
  if (std::isnan(law.gamma)) return "";
  return fmt::format("contact radius: a = c N^gamma, c = {} at N = 1 N, gamma = {:.3f}\n",
                     length(law.factor), law.gamma);
}

void write_rows(const std::vector<HeldSample>& samples, const fs::path& file) {
  std::vector<LimitRow> rows;
  for (const HeldSample& held : samples)
    for (const meshes::LimitPoint& point : held.surface.points)
      rows.push_back({held.sample, held.indentation,
                      std::isinf(point.away) ? meshes::unknown : point.away, point.force,
                      point.moment});
  meshes::write_rows(rows, file);
}

}  // namespace

std::string write_limit_surface(const fs::path& run) {
  FolderReader reader;
  require_friction(run, reader);
  const auto samples = held_samples(reader.rows<meshes::ContactPoint>(run / "contact_field.csv"));
  reader.throw_if_damaged();
  if (samples.empty())
    throw meshes::InvalidInput({(run / "contact_field.csv").string(), "",
                                "has no point that the obstacle pushes", "press deeper"});
  write_rows(samples, run / "limit_surface.csv");
  return table_text(limit_table(samples)) + law_text(samples);
}

}  // namespace fingertip::studies::report
