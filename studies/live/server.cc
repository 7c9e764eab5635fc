#include "studies/live/server.h"

#include <civetweb.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <pthread.h>

#include <future>

#include "meshes/base/errors.h"

/// CivetWeb asks for stacks of 100 kB. glibc takes the thread-local variables of all libraries out
/// of a thread's stack (OpenBLAS, METIS and glog together have 120 kB), so pthread_create() would
/// refuse. This stands in front of the C library's function, in the whole program, and lets nobody
/// have less than a megabyte, which costs addresses, not memory.
extern "C" int pthread_attr_setstacksize(pthread_attr_t* attributes, std::size_t size) noexcept {
  using Function = int (*)(pthread_attr_t*, std::size_t);
  static const auto original =
      reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_attr_setstacksize"));
  constexpr std::size_t least = 1UL << 20U;
  return original(attributes, size < least ? least : size);
}

namespace fingertip::studies::inline live {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double messages_per_second = 150.0;  ///< of one client, sustained

double seconds_now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

struct LiveServer::Client {
  std::mutex mutex;  ///< held while writing; guards what follows
  bool open = true;
  Viewer viewer;
  std::shared_ptr<const Reference> reference;  ///< that it was told
  RateLimit rate{messages_per_second, 2.0 * messages_per_second};
};

LiveServer::LiveServer(Simulation& simulation, const Reference& reference, int port)
    : simulation_(simulation),
      page_(reference),
      reference_(std::make_shared<const Reference>(reference)) {
  start(port);
  sender_ = std::thread([this] { stream(); });
}

std::shared_ptr<const Reference> LiveServer::reference() const {
  const std::lock_guard lock(mutex_);
  return reference_;
}

void LiveServer::show_continuum(const meshes::PressResponse& response) {
  {
    const std::lock_guard lock(mutex_);
    Reference beside;
    beside.response = response;
    beside.name = "continuum";
    reference_ = std::make_shared<const Reference>(std::move(beside));
  }
  simulation_.watched_by(clients());
}

std::string LiveServer::scene_text(const LiveFrame& frame, const Reference& reference) const {
  LiveScene scene = *frame.scene;
  if (reference.remark) {
    scene.remark = reference.remark->text;
    scene.comparable = !reference.remark->meaningless;
  }
  scene.units = shown_units().system;
  scene.reference_name = reference.name;
  for (const meshes::PressSample& sample : reference.response.pressing())
    scene.reference.push_back({sample.indentation, sample.normal_force, sample.force_error});
  for (const Overlay& overlay : reference.overlays) scene.overlays.push_back(overlay.indentation);
  return encode_scene(scene);
}

LiveServer::~LiveServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  sender_.join();
  say_goodbye();
  stop();
  mg_exit_library();
}

/// So that a page knows at once, and its thread here ends with its answer.
void LiveServer::say_goodbye() {
  ClientMap clients;
  {
    const std::lock_guard lock(mutex_);
    clients = clients_;
  }
  for (auto& [connection, client] : clients) {
    const std::lock_guard lock(client->mutex);
    if (!client->open) continue;
    mg_websocket_write(const_cast<mg_connection*>(connection), MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE,
                       "", 0);
  }
}

/// CivetWeb's threads look up from their sockets every two seconds, and no option changes that
/// (before its version 1.17). A visitor wakes the one that waits for visitors, which ends the rest.
void LiveServer::stop() {
  using namespace std::chrono_literals;
  const std::future<void> stopped = std::async(std::launch::async, [this] { mg_stop(context_); });
  for (int visits = 0; visits < 10 && stopped.wait_for(20ms) != std::future_status::ready;
       ++visits) {
    char error[128] = "";
    mg_close_connection(mg_connect_client("127.0.0.1", port_, 0, error, sizeof error));
  }
}

void LiveServer::start(int port) {
  mg_init_library(0);
  const std::string where = fmt::format("127.0.0.1:{}", port);
  const std::string threads = std::to_string(3 * max_clients);
  const char* options[] = {"listening_ports",
                           where.c_str(),
                           "num_threads",
                           threads.c_str(),
                           "request_timeout_ms",
                           "2000",
                           "websocket_timeout_ms",
                           "10000",
                           "enable_websocket_ping_pong",
                           "yes",
                           "enable_keep_alive",
                           "no",
                           "tcp_nodelay",
                           "1",
                           nullptr};
  mg_callbacks callbacks{};
  callbacks.log_message = [](const mg_connection*, const char*) { return 1; };  // not on stderr
  context_ = mg_start(&callbacks, this, options);
  mg_server_port ports[1];
  if (context_ == nullptr || mg_get_server_ports(context_, 1, ports) != 1) {
    if (context_ != nullptr) mg_stop(context_);
    mg_exit_library();
    throw meshes::InvalidInput({"--port", std::to_string(port), "127.0.0.1 does not give this port",
                                "choose another one, or 0 for a free one"});
  }
  port_ = ports[0].port;
  access_ = std::make_unique<Access>(port_, random_token());
  route();
}

void LiveServer::route() {
  mg_set_request_handler(
      context_, "**",
      [](mg_connection* connection, void* self) {
        const auto& us = *static_cast<const LiveServer*>(self);
        return us.page_.serve(connection, us.port_, *us.access_);
      },
      this);
  // Here, not in the connect handler: it may answer.
  mg_set_auth_handler(
      context_, "/stream$",
      [](mg_connection* connection, void* self) {
        return static_cast<LiveServer*>(self)->refuse(connection) ? 0 : 1;
      },
      this);
  mg_set_websocket_handler(
      context_, "/stream$", [](const mg_connection*, void*) { return 0; },
      [](mg_connection* connection, void* self) {
        static_cast<LiveServer*>(self)->greet(connection);
      },
      [](mg_connection* connection, int bits, char* data, std::size_t size, void* self) {
        return static_cast<LiveServer*>(self)->take(connection, bits, {data, size}) ? 1 : 0;
      },
      [](const mg_connection* connection, void* self) {
        static_cast<LiveServer*>(self)->forget(connection);
      },
      this);
}

/// Whether the websocket was refused.
bool LiveServer::refuse(mg_connection* connection) {
  if (!access_->may_connect(credentials_of(connection))) {
    mg_send_http_error(connection, 403, "%s", "wrong host, origin or token");
    return true;
  }
  const std::lock_guard lock(mutex_);
  if (stopping_ || int(clients_.size()) >= max_clients) {
    mg_send_http_error(connection, 503, "%s", "too many pages are connected");
    return true;
  }
  return false;
}

std::shared_ptr<LiveServer::Client> LiveServer::client(const mg_connection* connection) const {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(connection);
  return found == clients_.end() ? nullptr : found->second;
}

void LiveServer::greet(mg_connection* connection) {
  const auto us = std::make_shared<Client>();
  // The present frame may be old, for nobody may have watched: only newer ones are for it.
  const std::shared_ptr<const LiveFrame> last = simulation_.frame();
  us->viewer = Viewer(last->number);
  const std::lock_guard writing(us->mutex);
  bool full = false;
  {
    const std::lock_guard lock(mutex_);
    // A crowd that comes at once may find the last place free together.
    full = int(clients_.size()) >= max_clients;
    if (!full) clients_.emplace(connection, us);
  }
  if (full) {
    mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE, "", 0);
    return;
  }
  send_scene(connection, *us, *last);
  simulation_.watched_by(clients());
  frame_ready();
}

/// Whether the connection may stay.
bool LiveServer::take(mg_connection* connection, int bits, std::string_view text) {
  const std::shared_ptr<Client> us = client(connection);
  if (!us) return false;
  const int opcode = bits & 0x0f;
  if (opcode == MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE) return false;
  if (opcode == MG_WEBSOCKET_OPCODE_PING || opcode == MG_WEBSOCKET_OPCODE_PONG) return true;
  const auto complain = [&](const std::string& why) {
    const std::string error = encode_error(why);
    const std::lock_guard lock(us->mutex);
    mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_TEXT, error.data(), error.size());
  };
  {
    const std::unique_lock lock(us->mutex);
    if (!us->rate.pass(seconds_now())) return false;
  }
  const bool whole = (bits & 0x80) != 0 && opcode == MG_WEBSOCKET_OPCODE_TEXT;
  if (!whole || text.size() > longest_message) {
    complain("messages are short texts in one piece");
    return false;
  }
  const auto parsed = parse_message(text);
  if (const std::string* why = std::get_if<std::string>(&parsed)) {
    complain(*why);
    return true;
  }
  const LiveMessage& message = std::get<LiveMessage>(parsed);
  if (const Acknowledge* seen = std::get_if<Acknowledge>(&message)) {
    {
      const std::lock_guard lock(us->mutex);
      us->viewer.acknowledge(seen->number);
    }
    frame_ready();
  } else if (!simulation_.post(message)) {
    complain("too many orders at once");
  }
  return true;
}

void LiveServer::forget(const mg_connection* connection) {
  std::shared_ptr<Client> us;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(connection);
    if (found == clients_.end()) return;
    us = found->second;
    clients_.erase(found);
  }
  {
    // The sender may be writing to it; afterwards it will not.
    const std::lock_guard lock(us->mutex);
    us->open = false;
  }
  simulation_.watched_by(clients());
}

void LiveServer::frame_ready() {
  {
    const std::lock_guard lock(mutex_);
    work_ = true;
  }
  wake_.notify_all();
}

void LiveServer::stream() {
  while (true) {
    ClientMap clients;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return work_ || stopping_; });
      if (stopping_) return;
      work_ = false;
      clients = clients_;
    }
    const std::shared_ptr<const LiveFrame> frame = simulation_.frame();
    for (auto& [connection, client] : clients) {
      const std::lock_guard lock(client->mutex);
      if (!client->open || !client->viewer.waits_for(*frame)) continue;
      // The connection outlives this: forget() waits for the client's mutex.
      send_frame(const_cast<mg_connection*>(connection), *client, *frame);
    }
  }
}

void LiveServer::send_scene(mg_connection* connection, Client& client, const LiveFrame& frame) {
  client.reference = reference();
  const std::string text = scene_text(frame, *client.reference);
  client.viewer.shown(frame.scene);
  mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_TEXT, text.data(), text.size());
}

void LiveServer::send_frame(mg_connection* connection, Client& client, const LiveFrame& frame) {
  if (!client.viewer.knows(frame.scene) || client.reference != reference())
    send_scene(connection, client, frame);
  const std::string bytes = client.viewer.send(frame, simulation_.rows());
  const int written =
      mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_BINARY, bytes.data(), bytes.size());
  if (written <= 0) client.open = false;
}

std::string LiveServer::url() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port(), token());
}

int LiveServer::clients() const {
  const std::lock_guard lock(mutex_);
  return int(clients_.size());
}

}  // namespace fingertip::studies::inline live
