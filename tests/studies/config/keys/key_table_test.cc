#include "studies/config/keys/key_table.h"

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
        const fingertip::meshes::Violation& problem = error.violations().front();
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
      {"lattice.spacing", "\"auto\""},
      {"lattice.constants", "\"auto\""},
      {"lattice.ligament_stiffness", "1.0"},
      {"press.mode", "\"pid\""},
      {"press.contact", "\"stick\""},
      {"press.depth", "\"0.3 cm\""},
      {"press.speed", "\"1 cm/s\""},
      {"press.clearance", "\"0.05 cm\""},
      {"press.samples", "[]"},
      {"press.program", "[]"},
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
    EXPECT_NO_THROW(read(key, *table.get("v"))) << key.full_name();
  }
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
    EXPECT_EQ(name(with("reference.law=" + word).continuum_law), word);
  for (const std::string& word : words("reference.mode"))
    EXPECT_EQ(name(with("reference.mode=" + word).reference.analysis), word);
  for (const std::string& word : words("reference.volumetric"))
    EXPECT_EQ(name(with("reference.volumetric=" + word).reference.volumetric), word);
  for (const std::string& word : words("reference.solver"))
    EXPECT_EQ(name(with("reference.solver=" + word).reference.solver), word);
  for (const std::string& word : words("press.contact"))
    EXPECT_EQ(name(with("press.contact=" + word).continuum().protocol.contact), word);
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
      Job job = load_config({}).config.continuum();
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
  EXPECT_EQ(nearest_key("shear"), "rubber.shear_modulus");
  EXPECT_TRUE(nearest_key("rubber.colour").starts_with("rubber."));
  EXPECT_EQ(nearest_key("yongs_modulus"), "rubber.youngs_modulus");
  EXPECT_EQ(nearest_key("ruber.retardation_time"), "rubber.retardation_time");
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
