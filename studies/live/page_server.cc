#include "studies/live/page_server.h"

#include <civetweb.h>
#include <fmt/format.h>

#include <filesystem>

#include "studies/live/page_texts.h"
#include "studies/live/protocol.h"

namespace fingertip::studies::inline live {
namespace {

/// Everything a browser must not do with the page.
std::string security_headers(int port) {
  return fmt::format(
      "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: "
      "no-referrer\r\nX-Frame-Options: DENY\r\nContent-Security-Policy: default-src 'self'; "
      "connect-src 'self' ws://127.0.0.1:{0} ws://localhost:{0}; style-src 'self' "
      "'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; "
      "form-action 'none'\r\n",
      port);
}

std::string_view header(const mg_connection* connection, const char* name) {
  const char* value = mg_get_header(connection, name);
  return value != nullptr ? value : "";
}

std::string type_of(const std::filesystem::path& file) {
  if (file.extension() == ".svg") return "image/svg+xml";
  const std::string kind = file.extension().string().substr(1);
  return "text/" + (kind == "js" ? "javascript" : kind) + "; charset=utf-8";
}

void answer(mg_connection* connection, int port, const Access& access, std::string_view type,
            std::string_view content) {
  const std::string head = fmt::format(
      "HTTP/1.1 200 OK\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}Set-Cookie: "
      "{}={}; Path=/; HttpOnly; SameSite=Strict\r\nConnection: close\r\n\r\n",
      type, content.size(), security_headers(port), access.cookie_name(), access.token());
  mg_write(connection, head.data(), head.size());
  mg_write(connection, content.data(), content.size());
}

}  // namespace

Credentials credentials_of(const mg_connection* connection) {
  const mg_request_info* request = mg_get_request_info(connection);
  return {header(connection, "Host"), header(connection, "Origin"), header(connection, "Cookie"),
          request->query_string != nullptr ? request->query_string : ""};
}

PageServer::PageServer(const Reference& reference) {
  for (const auto& [name, content] : page_texts())
    files_[name == "index.html" ? "/" : "/" + name] = {type_of(name), content};
  for (std::size_t i = 0; i < reference.overlays.size(); ++i) {
    files_[fmt::format("/overlay/{}", i)] = {"application/octet-stream",
                                             encode_overlay(reference.overlays[i])};
  }
}

int PageServer::serve(mg_connection* connection, int port, const Access& access) const {
  const mg_request_info* request = mg_get_request_info(connection);
  if (!access.may_read(credentials_of(connection))) {
    mg_send_http_error(connection, 403, "%s",
                       "wrong host, origin or token: open the address that fingertip printed");
    return 403;
  }
  const std::string_view method = request->request_method;
  const auto file = files_.find(std::string_view(request->local_uri));
  if (method != "GET" && method != "HEAD") {
    mg_send_http_error(connection, 405, "%s", "pages are read, nothing else");
    return 405;
  }
  if (file == files_.end()) {
    mg_send_http_error(connection, 404, "%s", "there is no such page");
    return 404;
  }
  answer(connection, port, access, file->second.first, method == "GET" ? file->second.second : "");
  return 200;
}

}  // namespace fingertip::studies::inline live
