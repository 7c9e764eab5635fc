/// The page and its websocket on 127.0.0.1, by CivetWeb.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "studies/live/reference.h"
#include "studies/live/simulation.h"

namespace fingertip::studies::inline live {

struct ServerOptions {
  int port = 0;  ///< 0: a free one
  /// Websockets at a time; another one is refused with 503. Twice as many plain requests are served
  /// beside them.
  int most_clients = 32;
  double messages_per_second = 150.0;  ///< of one client, sustained; twice as many at once
  std::filesystem::path three_folder;  ///< of three.min.js; empty: Debian's libjs-three
};

/// Serves the page at url(), streams frames, and passes messages on to the simulation. A client
/// gets a frame only after it has acknowledged the one before, so a slow one is sent less and never
/// holds up the others or the simulation for longer than a full socket's time-out.
class LiveServer {
 public:
  /// Reads the scene from the simulation's rig. Throws InvalidInput when three.js is missing or the
  /// port is taken. Simulation and reference must outlive it.
  LiveServer(Simulation& simulation, const Reference& reference, const std::string& title,
             const ServerOptions& options);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// To be called after each new frame, from any thread.
  void frame_ready();
  int port() const;
  const std::string& token() const;
  std::string url() const;  ///< with the token
  int clients() const;      ///< connected websockets

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::studies::inline live
