// material.toml, written for people and read strictly.
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string_view>

#include "calibration/files/toml_file.h"
#include "calibration/material/material.h"
#include "calibration/material/material_parameter.h"
#include "lattice/press/setup_fields.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline material {
namespace {

using lattice::Kinematics;
using lattice::ModelKind;
using meshes::ContactMode;
using meshes::InvalidInput;
using meshes::to_text;

/// One number of material.toml: where it stands, its unit ("": a bare number) and where it lives.
struct Quantity {
  std::string_view section, key, unit;
  double* value = nullptr;                 ///< of what every material has
  std::optional<double>* maybe = nullptr;  ///< of what may be unknown
  bool required = true;
  std::string_view note = {};  ///< for people
};

/// In the order of the file. The network's stiffness is its rubber's: no constants.
std::vector<Quantity> quantities(Material& m) {
  std::vector<Quantity> all = {{"lattice", "spacing", "m", &m.spacing}};
  const auto factor = [&](std::string_view key, double& value, std::string_view note) {
    all.push_back({"lattice", key, "", &value, nullptr, false, note});
  };
  factor("ligament_stiffness", m.ligament_stiffness, "factor on the bond to the rod");
  factor("contact_stiffness", m.contact_stiffness, "factor on the ties to the plane");
  if (m.model != ModelKind::network)
    all.insert(all.end(), {{"constants", "k1", "N/m", &m.constants.k1},
                           {"constants", "k2", "N/m", &m.constants.k2},
                           {"constants", "k3", "N/m", &m.constants.k3},
                           {"constants", "kappa", "Pa", &m.constants.kappa}});
  all.insert(all.end(),
             {{"rubber", "youngs_modulus", "Pa", &m.rubber.youngs_modulus},
              {"rubber", "shear_modulus", "Pa", &m.rubber.shear_modulus},
              {"rubber", "density", "kg/m^3", &m.rubber.density, nullptr, false},
              {"rubber", "retardation_time", "s", &m.rubber.retardation_time, nullptr, false}});
  for (std::size_t i = 0; i < m.rubber.relaxation.branches.size(); ++i) {
    meshes::RelaxationBranch& branch = m.rubber.relaxation.branches[i];
    all.push_back({"rubber", name(relaxation_parameters[2 * i]), "", &branch.share, nullptr, true,
                   "of the modulus at once; E and G are those after long times"});
    all.push_back({"rubber", name(relaxation_parameters[2 * i + 1]), "s", &branch.time});
  }
  if (m.geometry)
    all.insert(all.end(), {{"geometry", "tip_radius", "m", &m.geometry->tip_radius},
                           {"geometry", "rod_radius", "m", &m.geometry->rod_radius},
                           {"geometry", "sleeve_length", "m", &m.geometry->sleeve_length},
                           {"geometry", "rod_length", "m", &m.geometry->rod_length}});
  const auto bound = [&](std::string_view key, std::string_view unit, std::optional<double>& value,
                         std::string_view note) {
    all.push_back({"validity", key, unit, nullptr, &value, false, note});
  };
  Validity& v = m.validity;
  bound("largest_indentation", "m", v.largest_indentation, "deepest force fitted or checked");
  bound("thickness", "m", v.thickness, "of the rubber between pole and bond");
  bound("rod_ratio", "", v.rod_ratio, "r/R of that finger");
  bound("smallest_spacing", "m", v.smallest_spacing, "");
  bound("largest_spacing", "m", v.largest_spacing, "");
  bound("smallest_poissons_ratio", "", v.smallest_poissons_ratio, "");
  bound("largest_poissons_ratio", "", v.largest_poissons_ratio, "");
  bound("model_error", "", v.model_error, "largest relative error of a force there");
  return all;
}

/// Reads one material file; knows its name for messages.
class MaterialReader : TomlFile {
 public:
  explicit MaterialReader(std::filesystem::path file)
      : TomlFile(std::move(file), "run calibrate again") {}

  Material read() {
    if (table().contains("law"))
      fail(1, "law", "", "the file holds a law of rubber, no constants of a lattice",
           "use it by rubber.card instead of lattice.constants");
    Material material;
    material.model = word("lattice", "model",
                          std::array{ModelKind::central, ModelKind::hookean, ModelKind::network});
    if (find("lattice", "kinematics"))
      material.kinematics = word("lattice", "kinematics", values(Kinematics()));
    if (table().contains("geometry")) material.geometry.emplace();
    std::size_t branches = 0;
    while (2 * branches < relaxation_parameters.size() &&
           find("rubber", name(relaxation_parameters[2 * branches])) != nullptr)
      ++branches;
    material.rubber.relaxation.branches.resize(branches);
    const std::vector<Quantity> known = quantities(material);
    for (const Quantity& quantity : known) read(quantity);
    material.density_known = find("rubber", "density") != nullptr;
    material.retardation_time_known = find("rubber", "retardation_time") != nullptr;
    if (find("validity", "contacts")) material.validity.contacts = contacts();
    material.provenance = text("about", "provenance");
    if (find("about", "program")) material.program = text("about", "program");
    if (find("about", "date")) material.date = text("about", "date");
    if (find("about", "rejected")) material.rejected = text("about", "rejected");
    // Its name in files without [validity].
    statement_ =
        find("about", "statement") || !find("about", "validity") ? "statement" : "validity";
    material.statement = text("about", statement_);
    refuse_unknown_keys(known);
    check(material);
    if (material.model == ModelKind::network)
      material.constants = lattice::hookean_constants(material.rubber, material.spacing);
    return material;
  }

 private:
  void read(const Quantity& quantity) const {
    if (!quantity.required && find(quantity.section, quantity.key) == nullptr) return;
    const double value = quantity.unit.empty()
                             ? bare_number(quantity.section, quantity.key)
                             : number(quantity.section, quantity.key, quantity.unit);
    if (quantity.value != nullptr)
      *quantity.value = value;
    else
      *quantity.maybe = value;
  }

  std::vector<ContactMode> contacts() const {
    const toml::array* list = node("validity", "contacts").as_array();
    std::vector<ContactMode> found;
    const auto refuse = [&] {
      fail(line("validity", "contacts"), "validity.contacts", "", "must be a list of words",
           "write for instance [\"stick\", \"frictionless\"]");
    };
    if (list == nullptr) refuse();
    for (const toml::node& item : *list) {
      const std::optional<std::string> written = item.value_exact<std::string>();
      if (!written) refuse();
      found.push_back(chosen(*written, "validity", "contacts", values(ContactMode())));
    }
    return found;
  }

  void refuse_unknown_keys(const std::vector<Quantity>& known) const {
    constexpr std::array<std::string_view, 7> words = {
        "lattice.model", "lattice.kinematics", "validity.contacts", "about.provenance",
        "about.program", "about.date",         "about.rejected"};
    const auto expected = [&](std::string_view section, std::string_view key) {
      const std::string full = dotted(section, key);
      return std::ranges::find(words, full) != words.end() || full == dotted("about", statement_) ||
             std::ranges::any_of(known, [&](const Quantity& quantity) {
               return quantity.section == section && quantity.key == key;
             });
    };
    const auto refuse = [&](const toml::node& at, const std::string& key) {
      const bool network = key.starts_with("constants.");
      fail(int(at.source().begin.line), key, "",
           network ? "no such key: the network's stiffness is E and G in [rubber]" : "no such key",
           "remove it");
    };
    for (const auto& [section, content] : table()) {
      if (!content.is_table()) refuse(content, std::string(section.str()));
      for (const auto& [key, value] : *content.as_table())
        if (!expected(section.str(), key.str())) refuse(value, dotted(section.str(), key.str()));
    }
  }

  void check(const Material& material) const {
    std::vector<meshes::Violation> found = material.violations();
    for (meshes::Violation& violation : found) {
      const std::size_t dot = violation.key.find('.');
      const int at = line(violation.key.substr(0, dot), violation.key.substr(dot + 1));
      violation.key = file().string() + ":" + std::to_string(at) + ": " + violation.key;
    }
    if (!found.empty()) throw InvalidInput(found);
  }

  std::string_view statement_ = "statement";
};

/// What stands in a section besides quantities.
std::string words_of(const Material& material, std::string_view section) {
  std::string text;
  if (section == "lattice") {
    text = "model = " + toml_text(name(material.model)) + '\n';
    if (material.kinematics) text += "kinematics = " + toml_text(name(*material.kinematics)) + '\n';
  }
  if (section == "validity" && !material.validity.contacts.empty()) {
    for (const ContactMode mode : material.validity.contacts)
      text += (text.empty() ? "" : ", ") + toml_text(name(mode));
    text = "contacts = [" + text + "]\n";
  }
  return text;
}

std::string material_toml(Material material) {
  std::string text =
      "# Calibrated lattice constants, SI. Use: lattice.constants = \"<path of this file>\"\n";
  const std::vector<Quantity> all = quantities(material);
  const auto unknown = [&](const Quantity& quantity) {
    return (quantity.maybe != nullptr && !*quantity.maybe) ||
           (quantity.value == &material.rubber.density && !material.density_known) ||
           (quantity.value == &material.rubber.retardation_time &&
            !material.retardation_time_known);
  };
  for (const std::string_view section :
       {"lattice", "constants", "rubber", "geometry", "validity"}) {
    std::string lines = words_of(material, section);
    for (const Quantity& quantity : all) {
      if (quantity.section != section || unknown(quantity)) continue;
      const double value = quantity.value != nullptr ? *quantity.value : **quantity.maybe;
      lines +=
          std::string(quantity.key) + " = " +
          (quantity.unit.empty() ? to_text(value)
                                 : toml_text(to_text(value) + " " + std::string(quantity.unit)));
      lines += quantity.note.empty() ? "\n" : "  # " + std::string(quantity.note) + "\n";
    }
    if (!lines.empty()) text += "\n[" + std::string(section) + "]\n" + lines;
  }
  text += "\n[about]\nprovenance = " + toml_text(material.provenance) + '\n';
  if (!material.program.empty()) text += "program = " + toml_text(material.program) + '\n';
  if (!material.date.empty()) text += "date = " + toml_text(material.date) + '\n';
  if (!material.rejected.empty()) text += "rejected = " + toml_text(material.rejected) + '\n';
  // Last, so that a file cut short is noticed.
  return text + "statement = " + toml_text(material.statement) + '\n';
}

}  // namespace

void write_material_toml(const Material& material, const std::filesystem::path& file) {
  const std::vector<meshes::Violation> broken = material.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  write_toml(material_toml(material), material.rejected, file);
}

Material read_material_toml(const std::filesystem::path& file) {
  return MaterialReader(file).read();
}

}  // namespace fingertip::calibration::inline material
