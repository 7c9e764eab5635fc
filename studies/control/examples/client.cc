/// A controller in a process of its own: the paper's task over the local socket.
///
///   fingertip press --set controller.type=socket --set controller.address=unix:/tmp/finger &
///   fingertip_example_client unix:/tmp/finger
///
/// The protocol is in studies/control/README.md, the control law in shared_object/pid_law.h.

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "studies/control/examples/shared_object/pid_law.h"

namespace {

using nlohmann::json;

/// Connects to "unix:PATH" or "tcp:127.0.0.1:PORT"; tries for ten seconds, since the program may
/// just be starting.
int connect_to(const std::string& address) {
  sockaddr_un path{.sun_family = AF_UNIX, .sun_path = {}};
  sockaddr_in port{};
  const bool is_unix = address.starts_with("unix:");
  if (is_unix) {
    address.substr(5).copy(path.sun_path, sizeof path.sun_path - 1);
  } else {
    port.sin_family = AF_INET;
    port.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    port.sin_port = htons(std::uint16_t(std::stoi(address.substr(address.rfind(':') + 1))));
  }
  for (int attempt = 0; attempt < 200; ++attempt) {
    const int link = ::socket(is_unix ? AF_UNIX : AF_INET, SOCK_STREAM, 0);
    const int failed = is_unix ? ::connect(link, reinterpret_cast<sockaddr*>(&path), sizeof path)
                               : ::connect(link, reinterpret_cast<sockaddr*>(&port), sizeof port);
    const int on = 1;
    if (!is_unix) ::setsockopt(link, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (failed == 0) return link;
    ::close(link);
    ::usleep(50'000);
  }
  throw std::runtime_error("nobody listens at " + address);
}

/// Lines in both directions.
class Connection {
 public:
  explicit Connection(int link) : in_(::fdopen(link, "r")), out_(::fdopen(::dup(link), "w")) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    std::free(line_);
    std::fclose(in_);
    std::fclose(out_);
  }
  json receive() {
    if (::getline(&line_, &space_, in_) < 0) throw std::runtime_error("the connection has ended");
    return json::parse(line_);
  }
  void send(const json& message) {
    std::fprintf(out_, "%s\n", message.dump().c_str());
    std::fflush(out_);
  }

 private:
  FILE* in_;
  FILE* out_;
  char* line_ = nullptr;
  std::size_t space_ = 0;
};

template <std::size_t N>
void take(const json& list, double (&to)[N]) {
  for (std::size_t i = 0; i < N; ++i) to[i] = list.at(i);
}

fingertip_task task_of(const json& message) {
  fingertip_task task{};
  task.period = message["period"];
  task.force_limit = message["force_limit"];
  task.torque_limit = message["torque_limit"];
  for (std::size_t i = 0; i < 36; ++i) task.inertia[i] = message["inertia"].at(i / 6).at(i % 6);
  return task;
}

fingertip_measurement measurement_of(const json& message) {
  fingertip_measurement m{};
  m.time = message["time"];
  take(message["position"], m.pose.position);
  take(message["orientation"], m.pose.orientation);
  take(message["velocity"], m.twist.velocity);
  take(message["angular_velocity"], m.twist.angular_velocity);
  take(message["force"], m.wrench.force);
  take(message["torque"], m.wrench.torque);
  const json& set_point = message.at("set_point");
  take(set_point["position"], m.set_point.pose.position);
  take(set_point["orientation"], m.set_point.pose.orientation);
  take(set_point["velocity"], m.set_point.twist.velocity);
  take(set_point["angular_velocity"], m.set_point.twist.angular_velocity);
  take(set_point["acceleration"], m.set_point.acceleration.velocity);
  take(set_point["angular_acceleration"], m.set_point.acceleration.angular_velocity);
  return m;
}

/// Serves one run until its bye; returns the reason that came with it.
std::string serve(Connection& connection) {
  pid_law pid{};
  while (true) {
    const json message = connection.receive();
    const std::string kind = message.at("message");
    if (kind == "bye") return message.at("reason");
    if (kind == "reset") pid_reset(&pid);
    if (kind == "hello") {
      const fingertip_task task = task_of(message["task"]);
      pid_start(&pid, &task);
      connection.send({{"protocol", "fingertip-control"}, {"version", 1}});
    }
    if (kind == "measurement") {
      const fingertip_measurement measurement = measurement_of(message);
      fingertip_wrench wrench{};
      pid_follow(&pid, &measurement, &wrench);
      const auto& [f, t] = wrench;
      connection.send({{"wrench", {f[0], f[1], f[2], t[0], t[1], t[2]}}});
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: fingertip_example_client ADDRESS");
  Connection connection(connect_to(argv[1]));
  std::printf("%s\n", serve(connection).c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "fingertip_example_client: %s\n", error.what());
  return 1;
}
