#include "calibration/result_io.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <sstream>
#include <string_view>

#include "calibration/fit_statement.h"
#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::calibration {
namespace {

using meshes::InvalidInput;
using meshes::to_text;
using nlohmann::ordered_json;

ordered_json direction_json(const Eigen::Vector4d& direction) {
  return {{"k1", direction(0)},
          {"k2", direction(1)},
          {"k3", direction(2)},
          {"kappa", direction(3)},
          {"meaning", describe_direction(direction)}};
}

ordered_json achieved_json(const ElasticModuli& moduli) {
  return {{"youngs_modulus_100", moduli.youngs_modulus_100},
          {"youngs_modulus_110", moduli.youngs_modulus_110},
          {"youngs_modulus_111", moduli.youngs_modulus_111},
          {"shear_modulus", moduli.shear_modulus},
          {"poissons_ratio_100", moduli.poissons_ratio_100},
          {"bulk_modulus", moduli.bulk_modulus},
          {"anisotropy", moduli.anisotropy}};
}

/// One quantity of material.toml: where it stands, its unit and where its value lives.
struct Quantity {
  std::string_view section, key, unit;
  double* value;
};

std::array<Quantity, 9> quantities(Material& m) {
  return {{{"lattice", "spacing", "m", &m.spacing},
           {"constants", "k1", "N/m", &m.constants.k1},
           {"constants", "k2", "N/m", &m.constants.k2},
           {"constants", "k3", "N/m", &m.constants.k3},
           {"constants", "kappa", "Pa", &m.constants.kappa},
           {"rubber", "youngs_modulus", "Pa", &m.rubber.youngs_modulus},
           {"rubber", "shear_modulus", "Pa", &m.rubber.shear_modulus},
           {"rubber", "density", "kg/m^3", &m.rubber.density},
           {"rubber", "retardation_time", "s", &m.rubber.retardation_time}}};
}

/// A double-quoted TOML string; the texts written here are one line of printable characters.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Reads one material file; knows its name for messages.
class MaterialReader {
 public:
  explicit MaterialReader(std::filesystem::path file) : file_(std::move(file)) {
    const std::ifstream in(file_, std::ios::binary);
    std::ostringstream content;
    // Copying nothing sets the fail bit, so this refuses empty files and folders, too.
    if (!in.is_open() || !(content << in.rdbuf()))
      throw InvalidInput({file_.string(), "", "the file cannot be read or is empty",
                          "check path and rights, or run calibrate again"});
    const std::string text = content.str();
    last_line_ = std::max(1, int(std::count(text.begin(), text.end(), '\n')));
    try {
      table_ = toml::parse(text, file_.string());
    } catch (const toml::parse_error& error) {
      fail(int(error.source().begin.line), "", "", std::string(error.description()),
           "mend the line, or run calibrate again");
    }
  }

  Material read() {
    Material material;
    const auto known = quantities(material);
    for (const Quantity& quantity : known) *quantity.value = number(quantity);
    material.model = model();
    material.provenance = text("about", "provenance");
    material.validity = text("about", "validity");
    refuse_unknown_keys(known);
    check(material);
    return material;
  }

 private:
  [[noreturn]] void fail(int line, const std::string& key, const std::string& value,
                         const std::string& rule, const std::string& remedy) const {
    std::string where = file_.string() + ":" + std::to_string(line);
    if (!key.empty()) where += ": " + key;
    throw InvalidInput({where, value, rule, remedy});
  }

  static std::string dotted(std::string_view section, std::string_view key) {
    return std::string(section) + "." + std::string(key);
  }

  const toml::node& node(std::string_view section, std::string_view key) const {
    const toml::node* found = table_.at_path(dotted(section, key)).node();
    if (found == nullptr)
      fail(last_line_, dotted(section, key), "", "the key is missing; the file may be truncated",
           "run calibrate again");
    return *found;
  }

  int line(std::string_view section, std::string_view key) const {
    return int(node(section, key).source().begin.line);
  }

  std::string text(std::string_view section, std::string_view key) const {
    const toml::node& found = node(section, key);
    const std::optional<std::string> value = found.value_exact<std::string>();
    if (!value)
      fail(line(section, key), dotted(section, key), "", "the value must be a string",
           "put it in quotes, a quantity with its unit");
    return *value;
  }

  double number(const Quantity& quantity) const {
    const std::string written = text(quantity.section, quantity.key);
    double value = 0.0;
    const char* end = written.data() + written.size();
    const auto parsed = std::from_chars(written.data(), end, value);
    const std::string rest(parsed.ptr, end);
    if (parsed.ec != std::errc() || !std::isfinite(value) ||
        rest != " " + std::string(quantity.unit))
      fail(line(quantity.section, quantity.key), dotted(quantity.section, quantity.key), written,
           "must be a finite number and the unit " + std::string(quantity.unit),
           "write for instance \"1.5 " + std::string(quantity.unit) + "\"");
    return value;
  }

  lattice::ModelKind model() const {
    const std::string written = text("lattice", "model");
    for (const lattice::ModelKind kind : {lattice::ModelKind::central, lattice::ModelKind::hookean})
      if (written == lattice::name(kind)) return kind;
    fail(line("lattice", "model"), "lattice.model", written,
         "calibrated models are central and hookean", "give one of them");
  }

  void refuse_unknown_keys(const std::array<Quantity, 9>& known) const {
    const auto expected = [&](std::string_view section, std::string_view key) {
      return dotted(section, key) == "lattice.model" ||
             dotted(section, key) == "about.provenance" ||
             dotted(section, key) == "about.validity" ||
             std::any_of(known.begin(), known.end(), [&](const Quantity& quantity) {
               return quantity.section == section && quantity.key == key;
             });
    };
    for (const auto& [section, content] : table_) {
      if (!content.is_table())
        fail(int(content.source().begin.line), std::string(section.str()), "", "no such key",
             "remove it");
      for (const auto& [key, value] : *content.as_table())
        if (!expected(section.str(), key.str()))
          fail(int(value.source().begin.line), dotted(section.str(), key.str()), "", "no such key",
               "remove it");
    }
  }

  void check(const Material& material) const {
    const auto require = [&](bool holds, std::string_view section, std::string_view key,
                             double value, const std::string& rule) {
      if (!holds)
        fail(line(section, key), dotted(section, key), to_text(value), rule, "run calibrate again");
    };
    const lattice::SpringConstants& c = material.constants;
    require(material.spacing > 0.0, "lattice", "spacing", material.spacing,
            "the spacing must be positive");
    require(c.k1 >= 0.0, "constants", "k1", c.k1, "a spring constant must not be negative");
    require(c.k2 >= 0.0, "constants", "k2", c.k2, "a spring constant must not be negative");
    require(c.k3 >= 0.0, "constants", "k3", c.k3, "a spring constant must not be negative");
    require(material.model == lattice::ModelKind::hookean || c.kappa == 0.0, "constants", "kappa",
            c.kappa, "the central model has no volume constant, kappa must be 0");
    const ElasticModuli moduli = homogenised_moduli(c, material.spacing);
    require(moduli.shear_modulus > 0.0 && moduli.c11 > moduli.c12 && moduli.bulk_modulus > 0.0,
            "constants", "k1", c.k1,
            "the lattice must resist every deformation: G > 0, C11 > C12, K > 0");
    std::vector<meshes::Violation> found = material.rubber.violations();
    for (meshes::Violation& violation : found) {
      const std::string key = violation.key.substr(violation.key.find('.') + 1);
      violation.key =
          file_.string() + ":" + std::to_string(line("rubber", key)) + ": " + violation.key;
    }
    if (!found.empty()) throw InvalidInput(found);
  }

  std::filesystem::path file_;
  toml::table table_;
  int last_line_ = 1;
};

}  // namespace

lattice::SpringConstants at_spacing(const Material& material, double spacing) {
  const double ratio = spacing / material.spacing;
  const lattice::SpringConstants& c = material.constants;
  return {c.k1 * ratio, c.k2 * ratio, c.k3 * ratio, c.kappa};
}

Material material_from(const ModuliFit& fit) {
  Material material;
  material.model = fit.model;
  material.spacing = fit.spacing;
  material.constants = fit.constants;
  material.rubber = fit.target;
  material.provenance = "least-squares fit of the homogenised lattice to E and G of the rubber, " +
                        std::to_string(fit.starts) + " random starts. " + fit.statement;
  material.validity =
      "small strain, lattices weighted per cell; for another spacing k1, k2, k3 scale with it and "
      "kappa stays";
  return material;
}

void write_calibration_json(const ModuliFit& fit, const std::filesystem::path& file) {
  ordered_json json;
  json["model"] = lattice::name(fit.model);
  json["spacing"] = fit.spacing;
  json["constants"] = {{"k1", fit.constants.k1},
                       {"k2", fit.constants.k2},
                       {"k3", fit.constants.k3},
                       {"kappa", fit.constants.kappa}};
  json["damping"] = {{"retardation_time", fit.target.retardation_time}};
  json["target"] = {{"youngs_modulus", fit.target.youngs_modulus},
                    {"shear_modulus", fit.target.shear_modulus},
                    {"poissons_ratio", fit.target.poissons_ratio()},
                    {"bulk_modulus", fit.target.bulk_modulus()}};
  json["achieved"] = achieved_json(fit.achieved);
  json["covariance"] = nullptr;
  json["unidentifiable"] = ordered_json::array();
  for (const Eigen::Vector4d& direction : fit.unidentifiable)
    json["unidentifiable"].push_back(direction_json(direction));
  json["residuals"] = ordered_json::object();
  for (std::size_t i = 0; i < fit.residual_names.size(); ++i)
    json["residuals"][fit.residual_names[i]] = fit.residuals(Eigen::Index(i));
  json["statement"] = fit.statement;
  meshes::write_atomically(file, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

void write_material_toml(const ModuliFit& fit, const std::filesystem::path& file) {
  Material material = material_from(fit);
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "# Calibrated lattice constants, SI. Use: lattice.constants = \"<path of this file>\"\n";
    std::string_view section;
    for (const Quantity& quantity : quantities(material)) {
      if (quantity.section != section) {
        section = quantity.section;
        out << "\n[" << section << "]\n";
        if (section == "lattice")
          out << "model = " << quoted(lattice::name(material.model)) << '\n';
      }
      out << quantity.key << " = "
          << quoted(to_text(*quantity.value) + " " + std::string(quantity.unit)) << '\n';
    }
    out << "\n[about]\nprovenance = " << quoted(material.provenance)
        << "\nvalidity = " << quoted(material.validity) << '\n';
  });
}

Material read_material_toml(const std::filesystem::path& file) {
  return MaterialReader(file).read();
}

}  // namespace fingertip::calibration
