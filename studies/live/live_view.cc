#include "studies/live/live_view.h"

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "meshes/press/fields.h"
#include "meshes/shape/solid.h"
#include "meshes/tables/fields_json.h"
#include "studies/live/server.h"

namespace fingertip::studies::inline live {

namespace {

/// Speed is the person's to set, so that it does not count.
PressCondition condition_of(const lattice::PressSetup& setup) {
  PressCondition condition;
  condition.contact = meshes::name(setup.protocol.contact);
  if (setup.protocol.contact == meshes::ContactMode::coulomb)
    condition.friction = setup.protocol.friction;
  condition.strain = lattice::name(setup.lattice.kinematics);
  condition.tip_radius = setup.geometry.tip_radius;
  condition.rod_radius = setup.geometry.rod_radius;
  condition.sleeve_length = setup.geometry.sleeve_length;
  condition.rod_length = setup.geometry.rod_length;
  if (setup.geometry.solid)
    condition.profile = setup.geometry.solid->content();
  else if (!setup.geometry.is_dome())
    condition.profile = meshes::json_of<nlohmann::json>(setup.geometry.profile).dump();
  condition.youngs_modulus = setup.rubber.youngs_modulus;
  condition.shear_modulus = setup.rubber.shear_modulus;
  condition.tilt = setup.protocol.tilt;
  condition.lateral = setup.protocol.lateral;
  if (!setup.protocol.obstacle.is_plane())
    condition.obstacle = meshes::json_of<nlohmann::json>(setup.protocol.obstacle).dump();
  condition.speed = meshes::unknown;
  return condition;
}

/// Of this thread and what it starts: the simulation goes first.
void give_way() {
  constexpr int this_thread = 0, nice = 10;
  ::setpriority(PRIO_PROCESS, this_thread, nice);
}

}  // namespace

double run_live_view(
    const lattice::PressSetup& setup, const LiveOptions& options,
    const std::function<void(const std::string& url, const std::string& remark)>& ready) {
  Reference reference;
  if (!options.reference.empty()) {
    reference = read_reference(options.reference);
    reference.remark = remark_on("this press", condition_of(setup),
                                 "the reference " + reference.name, reference.condition);
  }
  std::atomic<LiveServer*> listener = nullptr;
  Simulation simulation(setup, options.pace, [&listener] {
    if (LiveServer* server = listener) server->frame_ready();
  });
  LiveServer server(simulation, reference, options.port);
  listener = &server;
  ready(server.url(), reference.remark ? reference.remark->text : "");
  std::atomic<bool> over = false;
  std::future<void> beside;
  if (options.continuum && options.reference.empty())
    beside = std::async(std::launch::async, [&] {
      give_way();
      const meshes::PressResponse curve = options.continuum([&over] { return over.load(); });
      if (!curve.empty()) server.show_continuum(curve);
    });
  const auto started = std::chrono::steady_clock::now();
  while (!options.interrupted || !options.interrupted()) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    if (options.exit_after && elapsed.count() >= *options.exit_after) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  over = true;
  if (beside.valid()) beside.get();
  simulation.stop();  // before the server that its thread wakes is taken down
  return simulation.slowest_factor();
}

}  // namespace fingertip::studies::inline live
