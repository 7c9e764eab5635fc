#include "studies/live/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace fingertip::studies::inline live {

namespace {

/// Takes as long wherever the first difference is.
bool same_secret(std::string_view given, std::string_view secret) {
  if (given.size() != secret.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    difference |= unsigned(given[i]) ^ unsigned(secret[i]);
  }
  return difference == 0;
}

}  // namespace

std::string random_token() {
  std::random_device source;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", source());
  return token;
}

std::string_view value_in(std::string_view list, std::string_view name, char separator) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(separator), list.size());
    std::string_view item = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (item.starts_with(' ')) item.remove_prefix(1);
    if (item.starts_with(name) && item.substr(name.size()).starts_with('=')) {
      return item.substr(name.size() + 1);
    }
  }
  return {};
}

Access::Access(int port, std::string token) : port_(port), token_(std::move(token)) {}

std::string Access::cookie_name() const {
  return fmt::format("fingertip_{}", port_);
}

bool Access::is_here(std::string_view host) const {
  const std::string port = fmt::format(":{}", port_);
  if (host.ends_with(port)) host.remove_suffix(port.size());
  return host == "127.0.0.1" || host == "localhost";
}

bool Access::is_own_page(std::string_view origin) const {
  return origin == fmt::format("http://127.0.0.1:{}", port_) ||
         origin == fmt::format("http://localhost:{}", port_);
}

bool Access::knows_token(std::string_view query, std::string_view cookie) const {
  return same_secret(value_in(query, "token", '&'), token_) ||
         same_secret(value_in(cookie, cookie_name(), ';'), token_);
}

bool Access::may_read(const Credentials& request) const {
  return is_here(request.host) && (request.origin.empty() || is_own_page(request.origin)) &&
         knows_token(request.query, request.cookie);
}

bool Access::may_connect(const Credentials& request) const {
  return is_here(request.host) && is_own_page(request.origin) &&
         knows_token(request.query, request.cookie);
}

bool RateLimit::pass(double now) {
  left_ = std::min(burst_, left_ + rate_ * (now - last_));
  last_ = now;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

}  // namespace fingertip::studies::inline live
