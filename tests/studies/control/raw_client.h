/// A client of the lock-step protocol that says what a test wants, right or wrong.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <utility>

#include "studies/control/local_socket.h"

/// Connected to a unix socket.
class RawClient {
 public:
  explicit RawClient(const std::string& path)
      : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    path.copy(place.sun_path, sizeof place.sun_path - 1);
    connected_ =
        ::connect(socket_.number(), reinterpret_cast<sockaddr*>(&place), sizeof place) == 0;
  }

  bool connected() const { return connected_; }
  void send_bytes(const std::string& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t sent =
          ::send(socket_.number(), bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;
      at += std::size_t(sent);
    }
  }
  void send(const std::string& line) const { send_bytes(line + "\n"); }
  /// The next line; nothing after two seconds or the end of the connection.
  std::optional<std::string> line() {
    while (true) {
      const std::size_t end = received_.find('\n');
      if (end != received_.npos) {
        std::string first = received_.substr(0, end);
        received_.erase(0, end + 1);
        return first;
      }
      pollfd news{socket_.number(), POLLIN, 0};
      char buffer[4096];
      if (::poll(&news, 1, 2000) <= 0) return {};
      const ssize_t count = ::recv(socket_.number(), buffer, sizeof buffer, 0);
      if (count <= 0) return {};
      received_.append(buffer, std::size_t(count));
    }
  }
  /// Reads the program's hello and answers.
  void greet() {
    line();
    send(R"({"protocol":"fingertip-control","version":1})");
  }

 private:
  fingertip::studies::Descriptor socket_;
  bool connected_ = false;
  std::string received_;
};
