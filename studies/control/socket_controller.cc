#include "studies/control/socket_controller.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/control/c_structs.h"
#include "studies/control/messages.h"

namespace fingertip::studies::inline control {

using lattice::ControllerFailed;

namespace {

using Seconds = std::chrono::duration<double>;

Listener listen_at(const LocalAddress& address) try {
  return Listener(address);
} catch (const std::system_error& error) {
  throw ControllerFailed(error.what());
}

auto after(double seconds) {
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(seconds));
}

}  // namespace

SocketController::SocketController(SocketSettings settings, const lattice::ControlTask& task)
    : settings_(std::move(settings)), task_(task), listener_(listen_at(settings_.address)) {
  settings_.log("waiting for a controller at " + address().text());
}

SocketController::~SocketController() {
  if (client_) client_->send(bye_line("the run has ended"));
}

void SocketController::reset() {
  cycle_ = 0;
  if (client_ && !client_->send(reset_line())) client_.reset();
}

/// Until the client or the listener has something, in slices between which the user may interrupt.
SocketController::News SocketController::wait(Clock::time_point deadline) {
  constexpr std::chrono::milliseconds slice(100);
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return News::late;
    pollfd watched[2] = {{listener_.descriptor(), POLLIN, 0},
                         {client_ ? client_->descriptor() : -1, POLLIN, 0}};
    const int ready = ::poll(watched, 2, int(std::min(left, slice).count()));
    // The client first: one that has gone makes room for the next.
    if (ready > 0) return watched[1].revents != 0 ? News::client : News::listener;
    if (!settings_.go_on()) throw meshes::Interrupted("stopped while waiting for the controller");
  }
}

void SocketController::turn_others_away() {
  while (auto other = listener_.accept()) other->send(bye_line("another controller is connected"));
}

/// The client's next line; nothing when it has gone.
std::optional<std::string> SocketController::receive(Clock::time_point deadline, const char* what) {
  while (true) {
    auto line = client_->next_line();
    if (std::max(line ? line->size() : 0, client_->unread()) > longest_control_line) {
      throw ControllerFailed("the controller sent a line of more than " +
                             std::to_string(longest_control_line) + " bytes");
    }
    if (line) return line;
    switch (wait(deadline)) {
      case News::client:
        if (!client_->receive()) return {};
        break;
      case News::listener: turn_others_away(); break;
      case News::late:
        throw ControllerFailed(std::string("the controller did not send ") + what + " within " +
                               meshes::to_text(settings_.timeout) + " s (controller.timeout)");
    }
  }
}

/// Hellos of both sides. False when the client has gone before its own.
bool SocketController::greet(Clock::time_point deadline) {
  const bool resumed = cycle_ > 0;
  if (!client_->send(hello_line(task_, settings_.timeout, resumed))) return false;
  const auto line = receive(deadline, "its hello");
  if (!line) return false;
  check_hello(*line);
  settings_.log(resumed ? "the controller is back" : "a controller is connected");
  return true;
}

void SocketController::connect(Clock::time_point deadline) {
  while (!client_) {
    if (wait(deadline) == News::late) {
      if (!known_) {
        throw ControllerFailed("no controller connected to " + address().text() + " within " +
                               meshes::to_text(settings_.connect_timeout) +
                               " s (controller.connect_timeout)");
      }
      throw ControllerFailed("the controller closed its connection and did not come back within " +
                             meshes::to_text(settings_.timeout) + " s (controller.timeout)");
    }
    client_ = listener_.accept();
    if (client_ && !greet(known_ ? deadline : after(settings_.timeout))) client_.reset();
  }
  known_ = true;
}

/// An answer to what has not been asked would be taken for the next one's.
void SocketController::check_silence() {
  const bool there = client_->receive();
  if (client_->unread() > 0) {
    throw ControllerFailed("the controller sent more than one answer to a measurement");
  }
  if (!there) client_.reset();
}

lattice::Command SocketController::exchange(const lattice::Measurement& measurement) {
  const std::string line = measurement_line(measurement, task_, cycle_);
  if (client_) check_silence();
  bool lost = known_ && !client_;
  Clock::time_point deadline = after(known_ ? settings_.timeout : settings_.connect_timeout);
  while (true) {
    if (!client_) connect(deadline);
    if (!lost) deadline = after(settings_.timeout);
    if (client_->send(line)) {
      if (const auto answer = receive(deadline, "a command")) {
        const lattice::Command command = parse_command(*answer);
        ++cycle_;
        return command;
      }
    }
    client_.reset();
    settings_.log("the controller has gone; it may come back");
    // Whoever comes back has this long for everything, however often it comes and goes.
    if (!lost) deadline = after(settings_.timeout);
    lost = true;
  }
}

lattice::Command SocketController::command(const lattice::Measurement& measurement) {
  try {
    return exchange(measurement);
  } catch (const std::exception& error) {
    if (client_) client_->send(bye_line(error.what()));
    client_.reset();
    throw;
  }
}

}  // namespace fingertip::studies::inline control
