#include "studies/control/local_socket.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <system_error>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline control {

namespace {

constexpr int waiting_clients = 16;

[[noreturn]] void fail(const LocalAddress& address, int error) {
  throw std::system_error(error, std::generic_category(), "cannot listen at " + address.text());
}

sockaddr_un unix_address(const std::string& path) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  path.copy(place.sun_path, sizeof place.sun_path - 1);
  return place;
}

template <typename Address>
const sockaddr* generic(const Address& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

/// Whether nobody listens at a socket file any more: what a killed program leaves behind.
bool is_abandoned(const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode)) return false;
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_un place = unix_address(path);
  return ::connect(probe.number(), generic(place), sizeof place) != 0 && errno == ECONNREFUSED;
}

}  // namespace

LocalAddress LocalAddress::parse(const std::string& text) {
  constexpr std::string_view unix_prefix = "unix:", tcp_prefix = "tcp:127.0.0.1:";
  LocalAddress address;
  if (text.starts_with(unix_prefix)) {
    address.path = text.substr(unix_prefix.size());
    if (!address.path.empty() && address.path.size() < sizeof(sockaddr_un::sun_path))
      return address;
  } else if (text.starts_with(tcp_prefix)) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + tcp_prefix.size(), end, address.port);
    if (error == std::errc() && rest == end && address.port >= 0 && address.port <= 65535)
      return address;
  }
  throw meshes::InvalidInput(
      {"controller.address", text,
       "must be unix:PATH with a path of at most 107 bytes, or tcp:127.0.0.1:PORT",
       "choose e.g. unix:/tmp/fingertip.socket or tcp:127.0.0.1:5555"});
}

std::string LocalAddress::text() const {
  return path.empty() ? "tcp:127.0.0.1:" + std::to_string(port) : "unix:" + path;
}

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

bool LineConnection::send(std::string_view line) {
  const std::string text = std::string(line) + '\n';
  // One message at a time is under way, far less than a socket's buffer holds.
  const ssize_t sent = ::send(descriptor(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == ssize_t(text.size());
}

bool LineConnection::receive() {
  char buffer[4096];  // more waits for the next call, so that a flood cannot fill the memory
  const ssize_t count = ::recv(descriptor(), buffer, sizeof buffer, MSG_DONTWAIT);
  if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  received_.append(buffer, std::size_t(count));
  return count > 0;
}

std::optional<std::string> LineConnection::next_line() {
  const std::size_t end = received_.find('\n');
  if (end == received_.npos) return {};
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  return line;
}

Listener::Listener(LocalAddress address)
    : address_(std::move(address)),
      socket_(::socket(address_.path.empty() ? AF_INET : AF_UNIX,
                       SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (!socket_) fail(address_, errno);
  if (address_.path.empty()) {
    bind_port();
  } else {
    bind_path();
  }
  if (::listen(descriptor(), waiting_clients) != 0) fail(address_, errno);
}

Listener::~Listener() {
  if (made_) ::unlink(address_.path.c_str());
}

void Listener::bind_path() {
  if (is_abandoned(address_.path)) ::unlink(address_.path.c_str());
  const sockaddr_un place = unix_address(address_.path);
  // The file must never be open to others, not even for a moment.
  const mode_t before = ::umask(0177);
  const int failed = ::bind(descriptor(), generic(place), sizeof place) != 0 ? errno : 0;
  ::umask(before);
  if (failed != 0) fail(address_, failed);
  made_ = true;
}

void Listener::bind_port() {
  const int on = 1;
  ::setsockopt(descriptor(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  place.sin_port = htons(std::uint16_t(address_.port));
  if (::bind(descriptor(), generic(place), sizeof place) != 0) fail(address_, errno);
  socklen_t size = sizeof place;
  ::getsockname(descriptor(), reinterpret_cast<sockaddr*>(&place), &size);
  address_.port = ntohs(place.sin_port);
}

std::optional<LineConnection> Listener::accept() {
  Descriptor client(::accept4(descriptor(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!client) return {};
  const int on = 1;  // an answer waits for nothing; of no effect on unix sockets
  ::setsockopt(client.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return LineConnection(std::move(client));
}

}  // namespace fingertip::studies::inline control
