#include "studies/presses/controller_choice.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calibration/surrogate/surrogate.h"
#include "lattice/control/adaptive_pid.h"
#include "lattice/control/force_controller.h"
#include "lattice/control/hybrid_controller.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/press_motion.h"
#include "meshes/tables/fields_json.h"
#include "studies/control/shared_object_controller.h"
#include "studies/control/socket_controller.h"
#include "studies/jobs/digest.h"
#include "studies/jobs/interrupt.h"

namespace fingertip::studies::inline presses {

namespace {

using lattice::ControlTask;
using nlohmann::ordered_json;

constexpr const char* socket_identity = R"({"type":"socket"})";

/// A schedule and what tells it from another.
struct Schedule {
  lattice::StiffnessSchedule stiffness;
  ordered_json identity;
};

Schedule read_schedule(const LoadedConfig& loaded) {
  const std::filesystem::path& file = loaded.config.controller.schedule;
  if (file.empty()) return {};
  try {
    const auto surrogate =
        std::make_shared<const calibration::Surrogate>(calibration::read_surrogate_json(file));
    const calibration::SurrogateTable& table = surrogate->table();
    return {[surrogate](double indentation) { return surrogate->stiffness(indentation); },
            {{"knots", table.knots}, {"force", table.force}, {"stiffness", table.stiffness}}};
  } catch (const meshes::InvalidInput& error) {
    throw refused_file(loaded, "controller.schedule", error);
  }
}

std::string identity_of(const char* type, const auto& settings, const Schedule& schedule) {
  return ordered_json{
      {"type", type}, {"settings", meshes::json_of(settings)}, {"schedule", schedule.identity}}
      .dump();
}

void choose_adaptive(const LoadedConfig& loaded, lattice::PressSetup& setup) {
  lattice::AdaptiveSettings settings = loaded.config.controller.adaptive;
  const Schedule schedule = read_schedule(loaded);
  settings.stiffness = schedule.stiffness;
  setup.controller_identity = identity_of("adaptive", settings, schedule);
  setup.make_controller = [pid = setup.controller, settings](const ControlTask& task) {
    return std::make_unique<lattice::AdaptivePid>(pid, settings, task);
  };
}

template <typename ForceLaw>
void choose_force(const LoadedConfig& loaded, const char* type, lattice::PressSetup& setup) {
  if (!setup.protocol.program.empty())
    throw loaded.locate({{"press.program", "given",
                          std::string("controller.type = ") + type +
                              " holds a force once it touches, and a program says where to be",
                          "take controller.type = pid or adaptive, or leave one of the two out"}});
  lattice::ForceSettings settings = loaded.config.controller.force;
  try {
    lattice::check(settings, setup.controller);
  } catch (const meshes::InvalidInput& error) {
    throw loaded.locate(error.violations());
  }
  const Schedule schedule = read_schedule(loaded);
  settings.stiffness = schedule.stiffness;
  setup.controller_identity = identity_of(type, settings, schedule);
  setup.make_controller = [pid = setup.controller, settings](const ControlTask& task) {
    return std::make_unique<ForceLaw>(pid, settings, task);
  };
  setup.follows_path = false;
  if (!setup.duration) {
    setup.duration = meshes::PressMotion(setup.protocol).duration() +
                     10.0 / (2.0 * std::numbers::pi * settings.bandwidth);
  }
}

/// People's controllers may go their own way.
void choose_library(const LoadedConfig& loaded, lattice::PressSetup& setup) {
  const std::filesystem::path& file = loaded.config.controller.library;
  std::string content;
  if (std::filesystem::is_regular_file(file)) {  // reading a folder throws
    std::ifstream in(file, std::ios::binary);
    content.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  if (content.empty()) {
    throw loaded.locate({{"controller.library", file.empty() ? "none" : file.string(),
                          "controller.type = library needs a shared object that can be read",
                          "give its path, or choose another type"}});
  }
  setup.controller_identity = ordered_json{{"type", "library"}, {"sha256", sha256(content)}}.dump();
  setup.make_controller = [file](const ControlTask& task) {
    return std::make_unique<SharedObjectController>(file, task);
  };
  setup.follows_path = false;
}

void choose_socket(const LoadedConfig& loaded, lattice::PressSetup& setup) {
  const ControllerSettings& chosen = loaded.config.controller;
  SocketSettings settings;
  try {
    settings.address = LocalAddress::parse(chosen.address);
  } catch (const meshes::InvalidInput& error) {
    throw loaded.locate(error.violations());
  }
  settings.timeout = chosen.timeout;
  settings.connect_timeout = chosen.connect_timeout;
  settings.go_on = [] { return !interrupted(); };
  settings.log = [](const std::string& line) { fmt::print(stderr, "fingertip: note: {}\n", line); };
  setup.controller_identity = socket_identity;
  setup.make_controller = [settings](const ControlTask& task) {
    return std::make_unique<SocketController>(settings, task);
  };
  setup.follows_path = false;
}

}  // namespace

bool repeatable(const lattice::PressSetup& setup) {
  return setup.controller_identity != socket_identity;
}

void choose_controller(const LoadedConfig& loaded, lattice::PressSetup& setup) {
  if (setup.protocol.mode != meshes::DriveMode::pid) return;
  switch (loaded.config.controller.kind) {
    case ControllerKind::pid: return;
    case ControllerKind::adaptive: return choose_adaptive(loaded, setup);
    case ControllerKind::force:
      return choose_force<lattice::ForceController>(loaded, "force", setup);
    case ControllerKind::hybrid:
      return choose_force<lattice::HybridController>(loaded, "hybrid", setup);
    case ControllerKind::library: return choose_library(loaded, setup);
    case ControllerKind::socket: return choose_socket(loaded, setup);
  }
}

}  // namespace fingertip::studies::inline presses
