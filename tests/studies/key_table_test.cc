#include "studies/config/key_table.h"

#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <nlohmann/json.hpp>
#include <set>

#include "studies/config/documents.h"
#include "studies/config/value_reader.h"

using namespace fingertip::studies;

TEST(KeyTable, NamesAreUniqueAndEverySectionIsDescribed) {
  std::set<std::string> names;
  std::set<std::string> described;
  for (const Section& section : sections()) described.insert(section.name);
  for (const Key& key : key_table()) {
    EXPECT_TRUE(names.insert(key.full_name()).second) << key.full_name();
    EXPECT_TRUE(described.count(key.section)) << key.section;
    EXPECT_FALSE(key.help.empty()) << key.full_name();
    EXPECT_EQ(key.help.find('\n'), std::string::npos) << key.full_name();
    for (const std::string& related : key.related) EXPECT_NE(find_key(related), nullptr) << related;
  }
}

namespace {

/// TOML values that no key of this kind and range takes.
std::vector<std::string> bad_values(const Key& key) {
  std::vector<std::string> bad = {"1979-05-27"};
  switch (key.kind) {
    case Kind::quantity:
      bad.insert(bad.end(), {"17", "\"3\"", "\"3 candela\"", "\"inf m\""});
      break;
    case Kind::choice: bad.insert(bad.end(), {"\"nonsense\"", "17"}); break;
    case Kind::integer: bad.insert(bad.end(), {"1.5", "\"two\"", "1e300"}); break;
    case Kind::number: bad.insert(bad.end(), {"\"3 m\"", "nan", "true"}); break;
    case Kind::boolean: bad.insert(bad.end(), {"2", "\"yes\""}); break;
    case Kind::quantities: bad.insert(bad.end(), {"\"3 m\"", "[17]", "[\"3 candela\"]"}); break;
    case Kind::numbers:
    case Kind::number_pair: bad.insert(bad.end(), {"7", "[7]", "[\"a\", \"b\", \"c\"]"}); break;
    case Kind::texts:
    case Kind::files: bad.insert(bad.end(), {"7", "[7]"}); break;
    default: bad.emplace_back("17");
  }
  if (key.kind == Kind::number || key.kind == Kind::integer) {
    if (key.range.maximum < 1e300) bad.emplace_back("1e301");
    if (key.range.minimum > -1e300) bad.emplace_back("-1e301");
  }
  if (key.kind == Kind::quantity && key.range.minimum == 0.0)
    bad.push_back("\"-3 " + key.unit + "\"");
  return bad;
}

}  // namespace

TEST(KeyTable, EveryRefusalTellsKeyValueRuleAndRemedy) {
  for (const Key& key : key_table()) {
    const std::string name = key.full_name();
    for (const std::string& value : bad_values(key)) {
      try {
        load_config({{}, {name + "=" + value}, {}});
        ADD_FAILURE() << name << " takes " << value;
      } catch (const ConfigError& error) {
        const Problem& problem = error.problems().front();
        EXPECT_EQ(problem.key, name) << error.what();
        // As it was written, but for quotes and the way numbers are spelt.
        EXPECT_FALSE(problem.value.empty()) << error.what();
        if (value.find('e') == value.npos) {
          const bool quoted = value.front() == '"';
          EXPECT_EQ(problem.value, quoted ? value.substr(1, value.size() - 2) : value);
        }
        EXPECT_FALSE(problem.rule.empty()) << error.what();
        EXPECT_FALSE(problem.remedy.empty()) << error.what();
        EXPECT_NE(to_string(problem).find(name + " = "), std::string::npos) << error.what();
      }
    }
  }
}

TEST(KeyTable, HasTheContractsKeysWithItsDefaults) {
  const std::pair<const char*, const char*> contract[] = {
      {"geometry.tip_radius", "\"1 cm\""},
      {"geometry.rod_radius", "\"0.5 cm\""},
      {"geometry.sleeve_length", "\"1.5 cm\""},
      {"geometry.rod_length", "\"3 cm\""},
      {"rubber.youngs_modulus", "\"40 gf/cm^2\""},
      {"rubber.shear_modulus", "\"14 gf/cm^2\""},
      {"rubber.density", "\"0.5 g/cm^3\""},
      {"rubber.retardation_time", "\"0.3 ms\""},
      {"rod.density", "\"2.7 g/cm^3\""},
      {"lattice.model", "\"hookean\""},
      {"lattice.spacing", "\"tip_radius/12\""},
      {"lattice.constants", "\"auto\""},
      {"lattice.ligament_stiffness", "1.0"},
      {"press.mode", "\"pid\""},
      {"press.contact", "\"stick\""},
      {"press.depth", "\"0.3 cm\""},
      {"press.speed", "\"1 cm/s\""},
      {"press.clearance", "\"0.05 cm\""},
      {"press.samples", "[]"},
      {"press.friction", "0.5"},
      {"press.tilt", "\"0 deg\""},
      {"press.lateral", "\"0 cm\""},
      {"press.lateral_path", "\"diagonal\""},
      {"press.lateral_samples", "10"},
      {"reference.strain", "\"linear\""},
      {"reference.law", "\"A\""},
      {"reference.mode", "\"static\""},
      {"reference.degree", "2"},
      {"reference.refinement", "0.5"},
      {"reference.tolerance", "0.005"},
      {"controller.period", "\"1 ms\""}};
  for (const auto& [name, preset] : contract) {
    const Key* key = find_key(name);
    ASSERT_NE(key, nullptr) << name;
    EXPECT_EQ(key->preset, preset) << name;
  }
}

TEST(KeyTable, EveryDefaultIsAValidValueOfItsKey) {
  for (const Key& key : key_table()) {
    const toml::table table = toml::parse("v = " + key.preset);
    EXPECT_NO_THROW(read_value(key, *table.get("v"))) << key.full_name();
  }
}

TEST(KeyTable, DefaultsAreThoseOfTheRooms) {
  // The rooms' structs have defaults of their own: one truth only.
  const Config resolved = load_config({}).config;
  const fingertip::lattice::PressSetup rooms;
  const fingertip::fem_reference::ReferenceJob job;
  EXPECT_EQ(resolved.press.geometry.tip_radius, rooms.geometry.tip_radius);
  EXPECT_EQ(resolved.press.geometry.rod_radius, rooms.geometry.rod_radius);
  EXPECT_EQ(resolved.press.geometry.sleeve_length, rooms.geometry.sleeve_length);
  EXPECT_EQ(resolved.press.geometry.rod_length, rooms.geometry.rod_length);
  EXPECT_EQ(resolved.press.rubber.youngs_modulus, rooms.rubber.youngs_modulus);
  EXPECT_EQ(resolved.press.rubber.shear_modulus, rooms.rubber.shear_modulus);
  EXPECT_EQ(resolved.press.rubber.density, rooms.rubber.density);
  EXPECT_EQ(resolved.press.rubber.retardation_time, rooms.rubber.retardation_time);
  EXPECT_EQ(resolved.press.rod.density, rooms.rod.density);
  EXPECT_EQ(resolved.press.protocol.depth, rooms.protocol.depth);
  EXPECT_EQ(resolved.press.protocol.speed, rooms.protocol.speed);
  EXPECT_EQ(resolved.press.protocol.clearance, rooms.protocol.clearance);
  EXPECT_EQ(resolved.press.protocol.contact, rooms.protocol.contact);
  EXPECT_EQ(resolved.press.protocol.mode, rooms.protocol.mode);
  EXPECT_EQ(resolved.press.lattice.model, rooms.lattice.model);
  EXPECT_EQ(resolved.press.lattice.kinematics, rooms.lattice.kinematics);
  EXPECT_EQ(resolved.press.lattice.ligament_stiffness, rooms.lattice.ligament_stiffness);
  EXPECT_EQ(resolved.press.controller.period, rooms.controller.period);
  EXPECT_EQ(resolved.press.controller.natural_frequency, rooms.controller.natural_frequency);
  EXPECT_EQ(resolved.press.controller.derivative_filter, rooms.controller.derivative_filter);
  EXPECT_EQ(resolved.press.controller.setpoint_weight, rooms.controller.setpoint_weight);
  const ControllerOrder order;
  EXPECT_EQ(resolved.controller.adaptive.sensitivity, order.adaptive.sensitivity);
  EXPECT_EQ(resolved.controller.adaptive.memory, order.adaptive.memory);
  EXPECT_EQ(resolved.controller.force.force, order.force.force);
  EXPECT_EQ(resolved.controller.force.bandwidth, order.force.bandwidth);
  EXPECT_EQ(resolved.controller.force.touch_force, order.force.touch_force);
  EXPECT_EQ(resolved.controller.force.release_force, order.force.release_force);
  EXPECT_EQ(resolved.controller.force.confirmation, order.force.confirmation);
  EXPECT_EQ(resolved.controller.force.dwell, order.force.dwell);
  EXPECT_EQ(resolved.press.controller.bond_compensation, rooms.controller.bond_compensation);
  EXPECT_EQ(resolved.press.controller.force_limit, rooms.controller.force_limit);
  EXPECT_EQ(resolved.press.controller.torque_limit, rooms.controller.torque_limit);
  EXPECT_EQ(resolved.press.integrator, rooms.integrator);
  EXPECT_EQ(resolved.press.time_step, rooms.time_step);
  EXPECT_EQ(resolved.reference.degree, job.degree);
  EXPECT_EQ(resolved.reference.refinement, job.refinement);
  EXPECT_EQ(resolved.reference.tolerance, job.tolerance);
  EXPECT_EQ(resolved.reference.solver, job.solver);
  EXPECT_EQ(resolved.reference.solver_tolerance, job.solver_tolerance);
  EXPECT_EQ(resolved.reference.max_unknowns, job.max_unknowns);
  EXPECT_EQ(resolved.reference.analysis, job.analysis);
  EXPECT_EQ(resolved.reference.strain, job.strain);
  EXPECT_EQ(resolved.reference.law, job.law);
  EXPECT_EQ(resolved.reference.volumetric, job.volumetric);
  EXPECT_EQ(resolved.reference.modes, job.modes);
  EXPECT_EQ(resolved.reference.contact, job.contact);
  EXPECT_EQ(resolved.reference.friction, job.friction);
  EXPECT_EQ(resolved.reference.tilt, job.tilt);
  EXPECT_EQ(resolved.reference.lateral, job.lateral);
  EXPECT_EQ(resolved.reference.lateral_path, job.lateral_path);
  EXPECT_EQ(resolved.reference.lateral_samples, job.lateral_samples);
  EXPECT_EQ(resolved.reference.speed, job.speed);
  EXPECT_EQ(resolved.press.protocol.friction, rooms.protocol.friction);
  EXPECT_EQ(resolved.press.protocol.tilt, rooms.protocol.tilt);
  EXPECT_EQ(resolved.press.protocol.lateral, rooms.protocol.lateral);
  EXPECT_EQ(resolved.press.protocol.lateral_path, rooms.protocol.lateral_path);
  EXPECT_EQ(resolved.press.protocol.lateral_samples, rooms.protocol.lateral_samples);
  EXPECT_EQ(resolved.reference.write_fields, job.write_fields);
  EXPECT_EQ(resolved.reference.estimate_error, job.estimate_error);
}

TEST(KeyTable, EveryWordOfAContinuumKeyReachesTheJob) {
  using fingertip::fem_reference::name;
  const auto with = [](const std::string& set) { return load_config({{}, {set}, {}}).config; };
  const auto words = [](const char* key) {
    std::vector<std::string> all;
    for (const Choice& choice : find_key(key)->choices) all.push_back(choice.word);
    return all;
  };
  for (const std::string& word : words("reference.strain"))
    EXPECT_EQ(name(with("reference.strain=" + word).reference.strain), word);
  for (const std::string& word : words("reference.law"))
    EXPECT_EQ(name(with("reference.law=" + word).reference.law), word);
  for (const std::string& word : words("reference.mode"))
    EXPECT_EQ(name(with("reference.mode=" + word).reference.analysis), word);
  for (const std::string& word : words("reference.volumetric"))
    EXPECT_EQ(name(with("reference.volumetric=" + word).reference.volumetric), word);
  for (const std::string& word : words("reference.solver"))
    EXPECT_EQ(name(with("reference.solver=" + word).reference.solver), word);
  for (const std::string& word : words("press.contact"))
    EXPECT_EQ(name(with("press.contact=" + word).reference.contact), word);
}

TEST(KeyTable, RangesOfTheContinuumAreThoseOfItsJob) {
  // A key just inside its range must pass the job's own rules, one just outside must not.
  using Job = fingertip::fem_reference::ReferenceJob;
  const std::pair<const char*, void (*)(Job&, double)> numbers[] = {
      {"reference.degree", [](Job& job, double value) { job.degree = int(value); }},
      {"reference.modes", [](Job& job, double value) { job.modes = int(value); }},
      {"reference.refinement", [](Job& job, double value) { job.refinement = value; }},
      {"reference.tolerance", [](Job& job, double value) { job.tolerance = value; }},
      {"reference.max_unknowns", [](Job& job, double value) { job.max_unknowns = value; }},
      {"reference.solver_tolerance", [](Job& job, double value) { job.solver_tolerance = value; }}};
  for (const auto& [name, set] : numbers) {
    const Key& key = *find_key(name);
    const double step = key.kind == Kind::integer ? 1.0 : 0.01 * key.range.minimum;
    const auto violations = [&](double value) {
      Job job = load_config({}).config.reference;
      set(job, value);
      return job.violations().size();
    };
    EXPECT_EQ(violations(key.range.minimum), 0U) << name;
    EXPECT_EQ(violations(key.range.maximum), 0U) << name;
    EXPECT_EQ(violations(key.range.minimum - step), 1U) << name;
    EXPECT_EQ(violations(key.range.maximum + std::max(step, 0.01 * key.range.maximum)), 1U) << name;
  }
}

TEST(KeyTable, NearestKeyFindsSlips) {
  EXPECT_EQ(nearest_key("rubber.yongs_modulus"), "rubber.youngs_modulus");
  EXPECT_EQ(nearest_key("rubber.densty"), "rubber.density");
  EXPECT_EQ(nearest_key("rubber.young"), "rubber.youngs_modulus");
  EXPECT_EQ(nearest_key("rubber.poisson"), "rubber.poissons_ratio");
  EXPECT_EQ(nearest_key("press.contct"), "press.contact");
  EXPECT_EQ(nearest_key("geometry.spacing"), "lattice.spacing");
  EXPECT_EQ(nearest_key("press.detph"), "press.depth");
}

TEST(Documents, SchemaDescribesEveryKeyAndItsDefault) {
  const auto schema = nlohmann::json::parse(json_schema());
  EXPECT_FALSE(schema["additionalProperties"]);
  for (const Key& key : key_table()) {
    const auto& entry = schema["properties"][key.section]["properties"][key.name];
    ASSERT_TRUE(entry.contains("default")) << key.full_name();
    if (entry.contains("enum")) {
      EXPECT_NE(std::find(entry["enum"].begin(), entry["enum"].end(), entry["default"]),
                entry["enum"].end())
          << key.full_name();
    }
  }
}

TEST(Documents, ExplanationsAndReferenceNameEveryKey) {
  const std::string overview = key_overview();
  const std::string page = markdown_reference();
  for (const Key& key : key_table()) {
    EXPECT_NE(overview.find(key.full_name()), std::string::npos);
    EXPECT_NE(page.find("| `" + key.name + "` |"), std::string::npos);
    const std::string text = explanation(key);
    EXPECT_NE(text.find(key.help), std::string::npos);
    EXPECT_NE(text.find(key.preset), std::string::npos);
    for (const Choice& choice : key.choices) {
      EXPECT_NE(text.find(choice.meaning), std::string::npos) << key.full_name();
    }
  }
}
