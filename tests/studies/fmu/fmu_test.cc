// The functional mock-up unit as an importer meets it: unpacked, loaded with dlopen, stepped.

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lattice/press/press_task.h"
#include "studies/fmu/fmi2.h"
#include "studies/fmu/fmu_variables.h"
#include "studies/presses/press_setup.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using namespace fingertip;

namespace {

const std::vector<std::string> sets = {
    "lattice.spacing=tip_radius/5", "lattice.model=network",
    "press.clearance=0.2 mm",       "press.depth=1.5 mm",
    "reference.tolerance=0.02",     "sensor.taxels={rings=2, per_ring=3}"};
const std::vector<studies::FmuVariable> variables = studies::fmu_variables(6);

std::string logged;  ///< what units told last

void log(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String format, ...) {
  char text[1000];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  logged = text;
}

class Fmu : public ::testing::Test {
 protected:
  Fmu() {
    std::vector<std::string> words = {"export", "--format", "fmu", "--out", "run"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const ProgramResult made = run_program(folder_.path(), words);
    EXPECT_EQ(made.code, 0) << made.err;
    const std::string unpack = "unzip -q '" + (folder_ / "run/finger.fmu").string() + "' -d '" +
                               (folder_ / "unit").string() + "'";
    EXPECT_EQ(std::system(unpack.c_str()), 0);
    library_ =
        dlopen((folder_ / "unit/binaries/linux64/fingertip_fmu.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    EXPECT_NE(library_, nullptr) << dlerror();
  }

  template <typename Function>
  Function* entry(const char* name) const {
    void* found = dlsym(library_, name);
    EXPECT_NE(found, nullptr) << name;
    return reinterpret_cast<Function*>(found);
  }

  fmi2Component instantiate(const std::string& resources) const {
    using Instantiate = fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String,
                                      const fmi2CallbackFunctions*, fmi2Boolean, fmi2Boolean);
    const fmi2CallbackFunctions callbacks{log, std::calloc, std::free, nullptr, nullptr};
    return entry<Instantiate>("fmi2Instantiate")("finger", fmi2CoSimulation, "", resources.c_str(),
                                                 &callbacks, 0, 0);
  }
  fmi2Component instantiate() const {
    return instantiate("file://" + (folder_ / "unit/resources").string());
  }
  void release(fmi2Component unit) const { entry<void(fmi2Component)>("fmi2FreeInstance")(unit); }

  fmi2Status set(fmi2Component unit, const std::vector<unsigned>& which,
                 const std::vector<double>& values) const {
    using Set = fmi2Status(fmi2Component, const unsigned*, std::size_t, const double*);
    return entry<Set>("fmi2SetReal")(unit, which.data(), which.size(), values.data());
  }
  std::vector<double> all(fmi2Component unit) const {
    using Get = fmi2Status(fmi2Component, const unsigned*, std::size_t, double*);
    std::vector<unsigned> which(variables.size());
    for (unsigned i = 0; i < which.size(); ++i) which[i] = i;
    std::vector<double> values(which.size());
    EXPECT_EQ(entry<Get>("fmi2GetReal")(unit, which.data(), which.size(), values.data()), fmi2OK);
    return values;
  }
  fmi2Status step(fmi2Component unit, double time, double duration) const {
    return entry<fmi2Status(fmi2Component, double, double, int)>("fmi2DoStep")(unit, time, duration,
                                                                               1);
  }

  TemporaryFolder folder_;
  void* library_ = nullptr;
};

std::size_t index_of(std::string_view name) {
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].name == name) return i;
  throw std::invalid_argument(std::string(name));
}

/// Down against the plane and sideways, without end.
std::array<double, 3> push(double time) {
  return {1e-3 * std::sin(40.0 * time), 0.0, 0.02 + 0.01 * std::sin(25.0 * time)};
}

}  // namespace

TEST_F(Fmu, StepsAThousandPeriodsToTheSameBitsAsTheFinger) {
  fmi2Component unit = instantiate();
  ASSERT_NE(unit, nullptr) << logged;
  const lattice::PressSetup setup = studies::free_press({{}, sets, {}});
  const lattice::PressWay way(setup.protocol, setup.geometry);
  lattice::VirtualFinger finger(lattice::pressed_finger(setup, way));
  const double period = setup.controller.period, toward = -way.plane.normal.z();
  double deepest = 0.0, pressed = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double time = finger.time();
    auto [x, y, z] = push(time);
    z *= toward;
    ASSERT_EQ(set(unit, {0, 1, 2}, {x, y, z}), fmi2OK) << logged;
    ASSERT_EQ(step(unit, time, period), fmi2OK) << logged;
    finger.write(lattice::Wrench{{x, y, z}, meshes::Vector3::Zero()});
    finger.do_step(period);
    if (i % 100 != 99) continue;
    const lattice::Measurement seen = finger.read();
    const std::vector<double> values = all(unit);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(values[index_of("position_x") + std::size_t(k)], seen.pose.position[k]);
      EXPECT_EQ(values[index_of("velocity_x") + std::size_t(k)], seen.twist.velocity[k]);
      EXPECT_EQ(values[index_of("bond_force_x") + std::size_t(k)], seen.wrench.force[k]);
      EXPECT_EQ(values[index_of("bond_torque_x") + std::size_t(k)], seen.wrench.torque[k]);
    }
    EXPECT_EQ(values[index_of("orientation_w")], seen.pose.orientation.w());
    ASSERT_EQ(seen.taxels.size(), 6u);
    EXPECT_EQ(values[index_of("taxel_1_normal_stress")], seen.taxels[0].normal_stress);
    EXPECT_EQ(values[index_of("taxel_6_shear_v")], seen.taxels[5].shear_v);
    pressed = std::max(pressed, seen.taxels[0].normal_stress);
    deepest = std::max(deepest, values[index_of("indentation")]);
  }
  EXPECT_GT(deepest, 0.1e-3);  // it has touched
  EXPECT_GT(pressed, 10.0);
  release(unit);
}

TEST_F(Fmu, StatesComeBackAndResetsBegin) {
  fmi2Component unit = instantiate();
  ASSERT_NE(unit, nullptr) << logged;
  const std::vector<double> start = all(unit);
  using GetState = fmi2Status(fmi2Component, fmi2FMUstate*);
  using SetState = fmi2Status(fmi2Component, fmi2FMUstate);
  ASSERT_EQ(set(unit, {2}, {-0.02}), fmi2OK);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(step(unit, i * 1e-3, 1e-3), fmi2OK) << logged;
  fmi2FMUstate state = nullptr;
  ASSERT_EQ(entry<GetState>("fmi2GetFMUstate")(unit, &state), fmi2OK);
  const auto go_on = [&] {
    for (int i = 20; i < 40; ++i) EXPECT_EQ(step(unit, i * 1e-3, 1e-3), fmi2OK) << logged;
    return all(unit);
  };
  const std::vector<double> once = go_on();
  ASSERT_EQ(entry<SetState>("fmi2SetFMUstate")(unit, state), fmi2OK);
  EXPECT_EQ(go_on(), once);
  ASSERT_EQ(entry<GetState>("fmi2FreeFMUstate")(unit, &state), fmi2OK);
  EXPECT_EQ(state, nullptr);
  ASSERT_EQ(entry<fmi2Status(fmi2Component)>("fmi2Reset")(unit), fmi2OK);
  EXPECT_EQ(all(unit), start);
  release(unit);
}

TEST_F(Fmu, WhatIsWrongIsToldToTheImporter) {
  EXPECT_EQ(instantiate("file:///nowhere"), nullptr);
  EXPECT_NE(logged.find("parameters.toml"), std::string::npos) << logged;
  fmi2Component unit = instantiate();
  ASSERT_NE(unit, nullptr) << logged;
  EXPECT_EQ(set(unit, {6}, {0.0}), fmi2Error);
  EXPECT_NE(logged.find("no input"), std::string::npos) << logged;
  EXPECT_EQ(set(unit, {0}, {std::nan("")}), fmi2Error);
  EXPECT_EQ(step(unit, 1.0, 1e-3), fmi2Error);
  EXPECT_NE(logged.find("begins at"), std::string::npos) << logged;
  EXPECT_EQ(step(unit, 0.0, 0.0), fmi2Error);
  release(unit);
}

TEST_F(Fmu, ItsForceErrorIsForetold) {
  const auto transfer = nlohmann::json::parse(read_text(folder_ / "run/transfer.json"));
  const auto& model = transfer["obstacles"][0]["models"][0];
  EXPECT_EQ(model["model"], "lattice at rest");
  // So coarse a lattice has no contact of a few cells before the second half of the press.
  for (std::size_t i = 2; i < 5; ++i)
    EXPECT_LT(std::abs(model["error"][i].get<double>()), 0.1) << i;
  EXPECT_NE(read_text(folder_ / "run/README.md").find("Force error to expect"), std::string::npos);
}

TEST_F(Fmu, DescriptionListsTheVariables) {
  namespace tree = boost::property_tree;
  tree::ptree description;
  tree::read_xml((folder_ / "unit/modelDescription.xml").string(), description);
  const tree::ptree& model = description.get_child("fmiModelDescription");
  EXPECT_EQ(model.get<std::string>("<xmlattr>.fmiVersion"), "2.0");
  EXPECT_EQ(model.get<std::string>("CoSimulation.<xmlattr>.modelIdentifier"), "fingertip_fmu");
  std::size_t count = 0;
  for (const auto& [name, variable] : model.get_child("ModelVariables")) {
    if (name != "ScalarVariable") continue;
    EXPECT_EQ(variable.get<std::string>("<xmlattr>.name"), variables[count].name);
    EXPECT_EQ(variable.get<std::size_t>("<xmlattr>.valueReference"), count);
    EXPECT_EQ(variable.get<std::string>("<xmlattr>.causality") == "input", variables[count].input);
    ++count;
  }
  EXPECT_EQ(count, variables.size());
}
