/// Who may look and drive: this machine's own pages that know the token.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fingertip::studies::inline live {

/// 128 random bits in hexadecimal.
std::string random_token();

/// What a request says about itself; empty where it says nothing.
struct Credentials {
  std::string_view host, origin, cookie, query;
};

/// Decides about requests to one server.
class Access {
 public:
  Access(int port, std::string token);

  const std::string& token() const { return token_; }
  /// Of the cookie that holds the token; cookies do not tell ports apart, so its name does.
  std::string cookie_name() const;
  /// Whether Host names this server, 127.0.0.1 or localhost with this port or, as simple clients
  /// do, without any: a page of another name that resolves to this machine does not (DNS
  /// rebinding).
  bool is_here(std::string_view host) const;
  /// Whether Origin is a page of this server.
  bool is_own_page(std::string_view origin) const;
  /// Whether the token is in the query (token=...) or in the cookie.
  bool knows_token(std::string_view query, std::string_view cookie) const;

  /// A page or script: right host and token, and no foreign origin.
  bool may_read(const Credentials& request) const;
  /// A websocket: browsers always tell the origin, and it must be an own page.
  bool may_connect(const Credentials& request) const;

 private:
  int port_;
  std::string token_;
};

/// The value of `name` in a list "name=value" separated by `separator`; empty when it is not there.
std::string_view value_in(std::string_view list, std::string_view name, char separator);

/// Lets `rate` messages a second pass, and `burst` at once.
class RateLimit {
 public:
  RateLimit(double rate, double burst) : rate_(rate), burst_(burst), left_(burst) {}
  /// Whether one more may pass at `now` [s], which never decreases.
  bool pass(double now);

 private:
  double rate_, burst_, left_;
  double last_ = 0.0;
};

}  // namespace fingertip::studies::inline live
