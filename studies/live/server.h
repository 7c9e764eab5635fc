/// The page and its websocket on 127.0.0.1, by CivetWeb.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "studies/live/access.h"
#include "studies/live/page_server.h"
#include "studies/live/reference.h"
#include "studies/live/simulation.h"
#include "studies/live/viewer.h"

struct mg_context;

namespace fingertip::studies::inline live {

/// Websockets at a time; another one is refused with 503. Twice as many plain requests are served
/// beside them.
inline constexpr int max_clients = 32;

/// Serves the page at url(), streams frames, and passes messages on to the simulation. A client
/// gets a frame only after it has acknowledged the one before, so a slow one is sent less and never
/// holds up the others or the simulation for longer than a full socket's time-out.
class LiveServer {
 public:
  /// `port` 0: a free one. Throws InvalidInput when
  /// three.js is missing or the port is taken. The simulation must outlive it.
  LiveServer(Simulation& simulation, const Reference& reference, int port);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// The continuum's press beside this one, which was not known before; of use without a reference.
  void show_continuum(const meshes::PressResponse& response);
  /// To be called after each new frame, from any thread.
  void frame_ready();
  int port() const { return port_; }
  const std::string& token() const { return access_->token(); }
  std::string url() const;  ///< with the token
  int clients() const;      ///< connected websockets

 private:
  struct Client;
  using ClientMap = std::map<const mg_connection*, std::shared_ptr<Client>>;

  void start(int port);
  void route();
  bool refuse(mg_connection* connection);
  void greet(mg_connection* connection);
  bool take(mg_connection* connection, int bits, std::string_view text);
  void forget(const mg_connection* connection);
  std::shared_ptr<Client> client(const mg_connection* connection) const;
  void stream();
  std::shared_ptr<const Reference> reference() const;
  std::string scene_text(const LiveFrame& frame, const Reference& reference) const;
  void send_scene(mg_connection* connection, Client& client, const LiveFrame& frame);
  void send_frame(mg_connection* connection, Client& client, const LiveFrame& frame);
  void say_goodbye();
  void stop();

  Simulation& simulation_;
  PageServer page_;
  mg_context* context_ = nullptr;
  int port_ = 0;
  std::unique_ptr<Access> access_;

  mutable std::mutex mutex_;  ///< guards reference_, clients_, work_, stopping_
  std::shared_ptr<const Reference> reference_;
  std::condition_variable wake_;
  ClientMap clients_;
  bool work_ = false, stopping_ = false;
  std::thread sender_;
};

}  // namespace fingertip::studies::inline live
