/// Sockets of this machine only: an address, a listener, and a connection that carries lines.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace fingertip::studies::inline control {

/// "unix:PATH" (a socket in the file system, for this user only) or "tcp:127.0.0.1:PORT" (0: any
/// free port). Other machines have no way in.
struct LocalAddress {
  std::string path;  ///< empty for TCP
  int port = 0;

  /// Throws InvalidInput about the key controller.address.
  static LocalAddress parse(const std::string& text);
  std::string text() const;
};

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

/// A connected socket, never waited for: what is not there yet is asked for again.
class LineConnection {
 public:
  explicit LineConnection(Descriptor socket) : socket_(std::move(socket)) {}

  int descriptor() const { return socket_.number(); }
  /// Sends `line` and a line feed. False when the other side has gone, or has stopped reading.
  bool send(std::string_view line);
  /// Takes what has arrived. False when the other side has closed.
  bool receive();
  /// The next complete line, without its line feed.
  std::optional<std::string> next_line();
  std::size_t unread() const { return received_.size(); }  ///< [bytes]

 private:
  Descriptor socket_;
  std::string received_;
};

/// Listens at an address; the socket in the file system goes with it.
class Listener {
 public:
  /// Throws std::system_error when the address is in use, not allowed, or too long.
  explicit Listener(LocalAddress address);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  const LocalAddress& address() const { return address_; }  ///< with the port that was free
  int descriptor() const { return socket_.number(); }
  /// The next client that is waiting, if any.
  std::optional<LineConnection> accept();

 private:
  void bind_path();
  void bind_port();

  LocalAddress address_;
  Descriptor socket_;
  bool made_ = false;  ///< the file at address_.path
};

}  // namespace fingertip::studies::inline control
