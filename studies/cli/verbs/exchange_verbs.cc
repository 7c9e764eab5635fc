#include <fmt/format.h>

#include <optional>

#include "meshes/tables/fields_json.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/exchange/contact_export.h"
#include "studies/exchange/fmu_files.h"
#include "studies/exchange/lammps/lammps_files.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json summary_of(const UndampedBody& body, const LammpsCensus& census) {
  return {{"format", "lammps"},
          {"model", lattice::name(body.model.kind)},
          {"spacing", body.model.spacing()},
          {"masses", census.masses},
          {"anchors", census.anchors},
          {"springs", census.springs},
          {"bond_types", census.bond_types},
          {"step", body.step},
          {"left_out", {"dampers"}}};
}

/// With the frictionless contact where none is given: the default sticks, and no law can say that.
LoadedConfig load_for_law(const CommandLine& line) {
  LoadedConfig loaded = load_checked(line);
  if (loaded.entries.at("press.contact").given) return loaded;
  ConfigSource slips = line.config;
  slips.sets.push_back("press.contact=frictionless");
  loaded = load_config(slips);
  loaded.notes.push_back(
      "press.contact is not given: frictionless is taken, since a contact law of another program "
      "knows no rubber that sticks");
  return loaded;
}

/// Laws of contact, fitted to the continuum.
int export_contact(const CommandLine& line) {
  const LoadedConfig loaded = with_material(load_for_law(line), LatticeUse::none);
  const std::vector<meshes::Violation> lost = lost_in_contact(loaded);
  if (!lost.empty() && !line.lossy) throw ConfigError(lost);
  const ContactCurves curves = contact_curves(line.format, loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const fs::path& folder = session.folder().path();
    session.run_all(curves.jobs());
    const std::vector<ContactCurve> found = curves.read(folder);
    const ContactExport made = contact_export(line.format, {loaded, found, lost});
    write_contact_export(made, folder);
    if (line.quiet) return 0;
    fmt::print("{}{}how to use it: {}\n", transfer_lines(made.transfer), made.said,
               (folder / "README.md").string());
    return 0;
  });
}

/// Forces of a lattice that another program marches, where its press is straight, and the README.
void foretell(Session& session, const std::string& format, const std::string& readme,
              const std::optional<ContactCurves>& curves, bool quiet) {
  const fs::path& folder = session.folder().path();
  ContactExport made{{}, readme, "", {format, "", {}, {}}, {}};
  if (curves) {
    session.run_all(curves->jobs());
    made = lattice_export(format, readme, curves->read(folder));
  }
  write_contact_export(made, folder);
  if (curves && !quiet) fmt::print("{}", transfer_lines(made.transfer));
}

/// Of a lattice that is pressed straight, and is a finger.
std::optional<ContactCurves> lattice_curves(const LoadedConfig& loaded) {
  if (loaded.config.exchange.cube || !not_straight(loaded.config.press.protocol).empty())
    return std::nullopt;
  return ContactCurves(loaded, ContactCurves::Of::lattice);
}

int export_fmu(const CommandLine& line) {
  const LoadedConfig loaded = with_material(at_pace(load_checked(line)), LatticeUse::press);
  const FmuExport unit = fmu_export(loaded);
  const auto curves = lattice_curves(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const fs::path& folder = session.folder().path();
    write_fmu(unit, folder);
    foretell(session, "fmu", fmu_readme(unit), curves, line.quiet);
    if (line.quiet) return 0;
    fmt::print("finger.fmu: FMI 2.0 for co-simulation, step {:.4g} s\nhow to use it: {}\n",
               unit.period, (folder / "README.md").string());
    return 0;
  });
}

int export_lammps(const CommandLine& line) {
  const LoadedConfig loaded = with_material(load_checked(line), LatticeUse::modes);
  const UndampedBody body = undamped_body(loaded);
  const std::vector<meshes::Violation> beyond = beyond_lammps(body.model);
  if (!beyond.empty()) throw loaded.locate(beyond);
  const ExchangeSettings& settings = loaded.config.exchange;
  const auto curves = lattice_curves(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const fs::path& folder = session.folder().path();
    const LammpsCensus census = write_lammps(body, {settings.steps, settings.every}, folder);
    meshes::write_json_file(summary_of(body, census), folder / "summary.json");
    session.folder().log("dampers are left out: LAMMPS has none along bonds");
    foretell(session, "lammps",
             fmt::format("# A finger for LAMMPS\n\n`lattice.data`, `lattice.in`: {} masses, {} "
                         "springs, without dampers, steps of {:.4g} s.\n\n    lmp -in {}\n\n",
                         census.masses, census.springs, body.step, lammps_script),
             curves, line.quiet);
    if (line.quiet) return 0;
    fmt::print("{} masses, {} springs, {} anchors, without dampers; step {:.3g} s\n", census.masses,
               census.springs, census.anchors, body.step);
    fmt::print("run it: cd {} && lmp -in {}\n", folder.string(), lammps_script);
    return 0;
  });
}

}  // namespace

int run_export(const CommandLine& line) {
  return line.format == "lammps" ? export_lammps(line)
         : line.format == "fmu"  ? export_fmu(line)
                                 : export_contact(line);
}

}  // namespace fingertip::studies::inline cli::inline verbs
