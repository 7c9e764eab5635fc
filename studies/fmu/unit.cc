/// The entry points of the finger as a functional mock-up unit, FMI 2.0 for co-simulation: a
/// VirtualFinger behind C functions. A master steps it as the project's own loops do.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "lattice/press/press_task.h"
#include "studies/fmu/fmi2.h"
#include "studies/fmu/fmu_variables.h"
#include "studies/presses/press_setup.h"

#define FINGERTIP_FMI extern "C" __attribute__((visibility("default")))

namespace fingertip::studies::inline fmu {

namespace {

class Unit {
 public:
  Unit(const std::filesystem::path& resources, std::string name, fmi2CallbackFunctions callbacks)
      : name_(std::move(name)),
        callbacks_(callbacks),
        setup_(free_press({resources / fmu_settings, {}, {}})),
        way_(setup_.protocol, setup_.geometry),
        finger_(lattice::pressed_finger(setup_, way_)) {}

  /// Runs `work`; what it throws goes to the importer's log and becomes an error.
  template <typename Work>
  fmi2Status guarded(const Work& work) {
    try {
      return work();
    } catch (const std::exception& error) {
      return refuse(error.what());
    }
  }

  fmi2Status refuse(const std::string& message) {
    if (callbacks_.logger != nullptr)
      callbacks_.logger(callbacks_.componentEnvironment, name_.c_str(), fmi2Error, "logStatusError",
                        "%s", message.c_str());
    return fmi2Error;
  }

  fmi2Status get(const fmi2ValueReference* references, std::size_t count, double* values) {
    const std::vector<double> all = outputs();
    for (std::size_t i = 0; i < count; ++i) {
      if (references[i] >= all.size())
        return refuse("there is no real variable " + std::to_string(references[i]));
      values[i] = all[references[i]];
    }
    return fmi2OK;
  }

  fmi2Status set(const fmi2ValueReference* references, std::size_t count, const double* values) {
    for (std::size_t i = 0; i < count; ++i) {
      if (references[i] >= fmu_inputs)
        return refuse("variable " + std::to_string(references[i]) + " is no input");
      if (!std::isfinite(values[i])) return refuse("an input must be a finite number");
      inputs_[references[i]] = values[i];
    }
    return fmi2OK;
  }

  fmi2Status step(double time, double duration) {
    if (!(duration > 0.0)) return refuse("a step must take some time");
    if (std::abs(time - finger_.time()) > 1e-9 * std::max(1.0, std::abs(time)))
      return refuse("the step begins at " + std::to_string(time) + " s, the finger is at " +
                    std::to_string(finger_.time()) + " s");
    const auto& [fx, fy, fz, tx, ty, tz] = inputs_;
    finger_.write(lattice::Wrench{{fx, fy, fz}, {tx, ty, tz}});
    finger_.do_step(duration);
    const lattice::Measurement seen = finger_.read();
    if (!seen.pose.position.allFinite() || !lattice::finite(seen.wrench))
      return refuse("the lattice blew up: export with a smaller run.time_step");
    return fmi2OK;
  }

  void reset() {
    finger_.reset();
    inputs_ = {};
  }

  struct State {
    lattice::VirtualFinger::Snapshot finger;
    std::array<double, fmu_inputs> inputs;
  };
  State save() const { return {finger_.save(), inputs_}; }
  void load(const State& state) {
    finger_.load(state.finger);
    inputs_ = state.inputs;
  }

  double time() const { return finger_.time(); }

 private:
  std::string name_;
  fmi2CallbackFunctions callbacks_;
  lattice::PressSetup setup_;
  lattice::PressWay way_;
  lattice::VirtualFinger finger_;
  std::array<double, fmu_inputs> inputs_{};

  std::vector<double> outputs() const {
    const lattice::Measurement seen = finger_.read();
    std::vector<double> all(inputs_.begin(), inputs_.end());
    const auto add = [&](const auto& vector) {
      for (const double component : vector) all.push_back(component);
    };
    const Eigen::Quaterniond& q = seen.pose.orientation;
    add(seen.pose.position);
    add(std::array{q.w(), q.x(), q.y(), q.z()});
    add(seen.twist.velocity);
    add(seen.twist.angular_velocity);
    add(seen.wrench.force);
    add(seen.wrench.torque);
    all.push_back(way_.indentation(finger_.rod_body().endpoint, seen.pose.position,
                                   setup_.protocol.clearance));
    all.push_back(finger_.finger().bond().force.dot(way_.plane.normal));
    for (const meshes::TaxelReading& taxel : seen.taxels)
      add(std::array{taxel.normal_stress, taxel.shear_u, taxel.shear_v});
    return all;
  }
};

Unit& unit_of(fmi2Component component) {
  return *static_cast<Unit*>(component);
}

/// A file URI as importers write it, with or without a host's empty name.
std::filesystem::path path_of(std::string location) {
  for (const char* scheme : {"file://", "file:"})
    if (location.starts_with(scheme)) {
      location.erase(0, std::string(scheme).size());
      break;
    }
  std::string path;
  for (std::size_t i = 0; i < location.size(); ++i) {
    const bool coded = location[i] == '%' && i + 2 < location.size();
    path += coded ? char(std::stoi(location.substr(i + 1, 2), nullptr, 16)) : location[i];
    if (coded) i += 2;
  }
  return path;
}

fmi2Status not_there(fmi2Component component, const char* what) {
  return unit_of(component).refuse(std::string(what) + " is not there");
}

/// All variables are reals: of other types none may be asked for.
fmi2Status none_of(fmi2Component component, std::size_t count, const char* what) {
  return count == 0 ? fmi2OK : not_there(component, what);
}

}  // namespace

FINGERTIP_FMI const char* fmi2GetTypesPlatform() {
  return "default";
}
FINGERTIP_FMI const char* fmi2GetVersion() {
  return "2.0";
}

FINGERTIP_FMI fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, std::size_t,
                                             const fmi2String*) {
  return fmi2OK;
}

FINGERTIP_FMI fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String,
                                            fmi2String resources,
                                            const fmi2CallbackFunctions* callbacks, fmi2Boolean,
                                            fmi2Boolean) {
  const fmi2CallbackFunctions given = callbacks ? *callbacks : fmi2CallbackFunctions{};
  const auto log = [&](const char* message) {
    if (given.logger != nullptr)
      given.logger(given.componentEnvironment, name ? name : "", fmi2Error, "logStatusError", "%s",
                   message);
    return nullptr;
  };
  if (type != fmi2CoSimulation) return log("this unit is for co-simulation");
  if (resources == nullptr) return log("the location of the resources is missing");
  try {
    return new Unit(path_of(resources), name ? name : "", given);
  } catch (const std::exception& error) {
    return log(error.what());
  }
}

FINGERTIP_FMI void fmi2FreeInstance(fmi2Component component) {
  delete static_cast<Unit*>(component);
}

FINGERTIP_FMI fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean, fmi2Real,
                                             fmi2Real start, fmi2Boolean, fmi2Real) {
  return start == 0.0 ? fmi2OK : unit_of(component).refuse("time starts at 0");
}
FINGERTIP_FMI fmi2Status fmi2EnterInitializationMode(fmi2Component) {
  return fmi2OK;
}
FINGERTIP_FMI fmi2Status fmi2ExitInitializationMode(fmi2Component) {
  return fmi2OK;
}
FINGERTIP_FMI fmi2Status fmi2Terminate(fmi2Component) {
  return fmi2OK;
}

FINGERTIP_FMI fmi2Status fmi2Reset(fmi2Component component) {
  return unit_of(component).guarded([&] {
    unit_of(component).reset();
    return fmi2OK;
  });
}

FINGERTIP_FMI fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference* references,
                                     std::size_t count, fmi2Real* values) {
  return unit_of(component).guarded(
      [&] { return unit_of(component).get(references, count, values); });
}
FINGERTIP_FMI fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference* references,
                                     std::size_t count, const fmi2Real* values) {
  return unit_of(component).guarded(
      [&] { return unit_of(component).set(references, count, values); });
}

FINGERTIP_FMI fmi2Status fmi2GetInteger(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t count, fmi2Integer*) {
  return none_of(component, count, "an integer variable");
}
FINGERTIP_FMI fmi2Status fmi2SetInteger(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t count, const fmi2Integer*) {
  return none_of(component, count, "an integer variable");
}
FINGERTIP_FMI fmi2Status fmi2GetBoolean(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t count, fmi2Boolean*) {
  return none_of(component, count, "a boolean variable");
}
FINGERTIP_FMI fmi2Status fmi2SetBoolean(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t count, const fmi2Boolean*) {
  return none_of(component, count, "a boolean variable");
}
FINGERTIP_FMI fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference*,
                                       std::size_t count, fmi2String*) {
  return none_of(component, count, "a text variable");
}
FINGERTIP_FMI fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference*,
                                       std::size_t count, const fmi2String*) {
  return none_of(component, count, "a text variable");
}

FINGERTIP_FMI fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return unit_of(component).guarded([&] {
    if (*state == nullptr) *state = new Unit::State();
    *static_cast<Unit::State*>(*state) = unit_of(component).save();
    return fmi2OK;
  });
}
FINGERTIP_FMI fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
  return unit_of(component).guarded([&] {
    unit_of(component).load(*static_cast<const Unit::State*>(state));
    return fmi2OK;
  });
}
FINGERTIP_FMI fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  delete static_cast<Unit::State*>(*state);
  *state = nullptr;
  return fmi2OK;
}
FINGERTIP_FMI fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate,
                                                    std::size_t*) {
  return not_there(component, "a state as bytes");
}
FINGERTIP_FMI fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate, fmi2Byte*,
                                               std::size_t) {
  return not_there(component, "a state as bytes");
}
FINGERTIP_FMI fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte*,
                                                 std::size_t, fmi2FMUstate*) {
  return not_there(component, "a state as bytes");
}

FINGERTIP_FMI fmi2Status fmi2GetDirectionalDerivative(fmi2Component component,
                                                      const fmi2ValueReference*, std::size_t,
                                                      const fmi2ValueReference*, std::size_t,
                                                      const fmi2Real*, fmi2Real*) {
  return not_there(component, "a derivative");
}
FINGERTIP_FMI fmi2Status fmi2SetRealInputDerivatives(fmi2Component component,
                                                     const fmi2ValueReference*, std::size_t,
                                                     const fmi2Integer*, const fmi2Real*) {
  return not_there(component, "a derivative");
}
FINGERTIP_FMI fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component,
                                                      const fmi2ValueReference*, std::size_t,
                                                      const fmi2Integer*, fmi2Real*) {
  return not_there(component, "a derivative");
}

FINGERTIP_FMI fmi2Status fmi2DoStep(fmi2Component component, fmi2Real time, fmi2Real duration,
                                    fmi2Boolean) {
  return unit_of(component).guarded([&] { return unit_of(component).step(time, duration); });
}
FINGERTIP_FMI fmi2Status fmi2CancelStep(fmi2Component component) {
  return not_there(component, "a step that goes on");
}
FINGERTIP_FMI fmi2Status fmi2GetStatus(fmi2Component, fmi2StatusKind, fmi2Status*) {
  return fmi2Discard;
}
FINGERTIP_FMI fmi2Status fmi2GetRealStatus(fmi2Component component, fmi2StatusKind kind,
                                           fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  *value = unit_of(component).time();
  return fmi2OK;
}
FINGERTIP_FMI fmi2Status fmi2GetIntegerStatus(fmi2Component, fmi2StatusKind, fmi2Integer*) {
  return fmi2Discard;
}
FINGERTIP_FMI fmi2Status fmi2GetBooleanStatus(fmi2Component, fmi2StatusKind, fmi2Boolean*) {
  return fmi2Discard;
}
FINGERTIP_FMI fmi2Status fmi2GetStringStatus(fmi2Component, fmi2StatusKind, fmi2String*) {
  return fmi2Discard;
}

}  // namespace fingertip::studies::inline fmu
