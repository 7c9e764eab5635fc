#include "studies/live/live_view.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "studies/live/server.h"

namespace fingertip::studies {

namespace {

/// "hookean lattice, R/12, stick"
std::string title_of(const lattice::PressSetup& setup) {
  const double divisor = setup.geometry.tip_radius / setup.lattice.spacing;
  return fmt::format("{} lattice, R/{:.3g}, {} contact", lattice::name(setup.lattice.model),
                     divisor, meshes::name(setup.protocol.contact));
}

}  // namespace

void run_live_view(const lattice::PressSetup& setup, const LiveOptions& options,
                   const std::function<void(const std::string& url)>& ready) {
  const Reference reference =
      options.reference.empty() ? Reference{} : read_reference(options.reference);
  std::atomic<LiveServer*> listener = nullptr;
  Simulation simulation(setup, options.paused, options.rate, [&listener] {
    if (LiveServer* server = listener) server->frame_ready();
  });
  ServerOptions server_options;
  server_options.port = options.port;
  LiveServer server(simulation, reference, title_of(setup), server_options);
  listener = &server;
  ready(server.url());
  const auto started = std::chrono::steady_clock::now();
  while (!options.interrupted || !options.interrupted()) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    if (options.exit_after && elapsed.count() >= *options.exit_after) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  simulation.stop();  // before the server that its thread wakes is taken down
}

}  // namespace fingertip::studies
