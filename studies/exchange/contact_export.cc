#include "studies/exchange/contact_export.h"

#include <map>
#include <ostream>

#include "meshes/base/files.h"
#include "meshes/tables/fields_json.h"
#include "studies/exchange/drake_files.h"
#include "studies/exchange/mujoco_files.h"
#include "studies/exchange/pressure_law_files.h"
#include "studies/exchange/sofa_files.h"
#include "studies/exchange/texts/texts.h"
#include "studies/files/read_fields.h"

namespace fingertip::studies::inline exchange {

namespace {

using meshes::ObstacleShape;

struct Format {
  ContactExport (*make)(const ContactSource&);
  ContactCurves::Of curves = ContactCurves::Of::contacts;
  bool edge = true;  ///< among its obstacles
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> all = {
      {"pressure-law", {pressure_law_export}},
      {"newton", {newton_export}},
      {"mujoco", {mujoco_export, ContactCurves::Of::contacts, false}},
      {"drake", {drake_export}},
      {"sofa", {sofa_export, ContactCurves::Of::body}},
      {"vtk", {vtk_export, ContactCurves::Of::body}}};
  return all;
}

/// Of the configuration's obstacle; empty where the format can have it.
std::vector<meshes::Violation> beyond(const Format& format, const LoadedConfig& loaded) {
  const ObstacleShape shape = loaded.config.press.protocol.obstacle.shape;
  const Entry& entry = loaded.entries.at("obstacle.shape");
  const auto refused = [&](const char* rule, const char* remedy) -> std::vector<meshes::Violation> {
    return {{"obstacle.shape", entry.literal, rule, remedy, entry.place}};
  };
  if (format.curves == ContactCurves::Of::body && shape != ObstacleShape::plane)
    return refused("the forces of a body of tetrahedra are foretold under a plane",
                   "choose obstacle.shape = \"plane\"");
  if (!format.edge && shape == ObstacleShape::edge)
    return refused("MuJoCo has no rounded edge", "press a cylinder of the same radius");
  return {};
}

/// Which contact model carries this finger: every format, and all models in one table.
ContactExport all_of_them(const ContactSource& source) {
  ContactExport made;
  made.readme = filled("all_readme.txt");
  made.transfer = transfer_of("all", "Force of a model at rest over that of the continuum",
                              source.lost, source.curves, {});
  for (const auto& [name, format] : formats()) {
    ContactExport part;
    std::vector<meshes::Violation> problems = beyond(format, source.loaded);
    try {
      if (problems.empty()) part = format.make(source);
    } catch (const ConfigError& error) {
      problems = error.violations();
    }
    if (!problems.empty()) {
      made.said += name + ": " + problems.front().rule + "\n";
      made.readme += "`" + name + "` is left out: " + problems.front().rule + ".\n\n";
      continue;
    }
    for (std::size_t i = 0; i < source.curves.size(); ++i)
      for (TransferModelEntry model : part.transfer.obstacles[i].models) {
        model.model = name + ": " + model.model;
        made.transfer.obstacles[i].models.push_back(std::move(model));
      }
    made.parts.emplace(name, std::move(part));
  }
  return made;
}

}  // namespace

ContactExport contact_export(const std::string& format, const ContactSource& source) {
  return format == "all" ? all_of_them(source) : formats().at(format).make(source);
}

ContactCurves contact_curves(const std::string& format, const LoadedConfig& loaded) {
  if (format == "all") return ContactCurves(loaded);
  const Format& own = formats().at(format);
  const std::vector<meshes::Violation> problems = beyond(own, loaded);
  if (!problems.empty()) throw ConfigError(problems);
  return ContactCurves(loaded, own.curves);
}

ContactExport lattice_export(const std::string& format, const std::string& readme,
                             const std::vector<ContactCurve>& curves) {
  ContactExport made;
  made.readme = readme;
  made.transfer = transfer_of(
      format, "Force of the lattice at rest, which the other program marches, over the continuum's",
      {}, curves, {lattice_at_rest()});
  return made;
}

void write_contact_export(const ContactExport& made, const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    meshes::write_atomically(folder / name, [&](std::ostream& out) { out << text; });
  };
  for (const auto& [name, part] : made.parts) {
    std::filesystem::create_directories(folder / name);
    write_contact_export(part, folder / name);
  }
  for (const ContactExport::File& file : made.files) write(file.name, file.text);
  meshes::write_json_file(made.transfer, folder / "transfer.json");
  std::string readme = made.readme + transfer_chapters(made.transfer);
  if (!made.transfer.obstacles.empty())
    readme += "\nNumbers: `transfer.json`. Runs they come from: `continuum/`.\n";
  write("README.md", readme);
}

}  // namespace fingertip::studies::inline exchange
