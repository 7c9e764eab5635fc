#include "studies/exchange/contact_export.h"

#include <map>
#include <ostream>

#include "meshes/files.h"
#include "studies/exchange/drake_files.h"
#include "studies/exchange/mujoco_files.h"
#include "studies/exchange/pressure_law_files.h"
#include "studies/exchange/sofa_files.h"
#include "studies/files/read_fields.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using Make = ContactExport (*)(const ContactSource&);

const std::map<std::string, Make>& formats() {
  static const std::map<std::string, Make> all = {{"pressure-law", pressure_law_export},
                                                  {"mujoco", mujoco_export},
                                                  {"drake", drake_export},
                                                  {"sofa", sofa_export},
                                                  {"vtk", vtk_export}};
  return all;
}

/// Which contact model carries this finger: every format, and all models in one table.
ContactExport all_of_them(const ContactSource& source) {
  ContactExport made;
  made.readme =
      "# Which contact model carries this finger\n\n"
      "A folder per program, each with a README how to use it. The table tells how far the contact "
      "models of these programs follow the\nfinger where they are fitted to it, and on other "
      "obstacles.\n\n";
  made.transfer = transfer_of("all", "Force of a model at rest over that of the continuum",
                              source.lost, source.curves, {});
  for (const auto& [format, make] : formats()) {
    ContactExport part;
    try {
      part = make(source);
    } catch (const ConfigError& error) {
      made.said += format + ": " + error.problems().front().rule + "\n";
      made.readme += "`" + format + "` is left out: " + error.problems().front().rule + ".\n\n";
      continue;
    }
    for (std::size_t i = 0; i < source.curves.size(); ++i)
      for (TransferModelEntry model : part.transfer.obstacles[i].models) {
        model.model = format + ": " + model.model;
        made.transfer.obstacles[i].models.push_back(std::move(model));
      }
    made.parts.emplace(format, std::move(part));
  }
  return made;
}

}  // namespace

const SoftBody& ContactSource::soft() const {
  if (!soft_) soft_ = fitted_soft_body(loaded, curves.front());
  return *soft_;
}

ContactExport contact_export(const std::string& format, const ContactSource& source) {
  const Make make = format == "all" ? all_of_them : formats().at(format);
  return make(source);
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
  write_json(json_of(made.transfer), folder / "transfer.json");
  std::string readme = made.readme + transfer_chapters(made.transfer);
  if (!made.transfer.obstacles.empty())
    readme += "\nNumbers: `transfer.json`. Runs they come from: `continuum/`.\n";
  write("README.md", readme);
}

}  // namespace fingertip::studies
