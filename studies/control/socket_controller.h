/// A controller in another process, in lock step over a local socket (README: the protocol).
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "lattice/control/controller.h"
#include "lattice/control/task.h"
#include "studies/control/local_socket.h"

namespace fingertip::studies::inline control {

struct SocketSettings {
  LocalAddress address;
  double timeout = 5.0;           ///< for every answer, and to come back [s]
  double connect_timeout = 60.0;  ///< for the first client [s]
  /// Asked ten times a second while waiting; false: command() throws Interrupted.
  std::function<bool()> go_on = [] { return true; };
  std::function<void(const std::string&)> log = [](const std::string&) {};
};

/// Listens from its construction on and serves one client. The first command() waits for it.
class SocketController final : public lattice::Controller {
 public:
  /// Throws ControllerFailed when it cannot listen.
  SocketController(SocketSettings settings, const lattice::ControlTask& task);
  ~SocketController() override;  ///< says bye

  const LocalAddress& address() const { return listener_.address(); }

  /// Throws ControllerFailed for a client that is late, gone for longer than the time-out, of
  /// another version, or says what the protocol does not know; Interrupted.
  lattice::Command command(const lattice::Measurement& measurement) override;
  void reset() override;

 private:
  using Clock = std::chrono::steady_clock;
  enum class News { client, listener, late };

  lattice::Command exchange(const lattice::Measurement& measurement);
  void connect(Clock::time_point deadline);
  bool greet(Clock::time_point deadline);
  void check_silence();
  std::optional<std::string> receive(Clock::time_point deadline, const char* what);
  News wait(Clock::time_point deadline);
  void turn_others_away();

  SocketSettings settings_;
  lattice::ControlTask task_;
  Listener listener_;
  std::optional<LineConnection> client_;
  bool known_ = false;  ///< a client has been here
  long cycle_ = 0;      ///< of the next measurement, since the start or reset
};

}  // namespace fingertip::studies::inline control
