/// What a browser reads of the live view by GET: the page, three.js, the surfaces laid over it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "studies/live/access.h"
#include "studies/live/reference.h"

struct mg_connection;

namespace fingertip::studies::inline live {

/// What a request shows of who asks.
Credentials credentials_of(const mg_connection* connection);

class PageServer {
 public:
  /// Throws as page_texts.
  explicit PageServer(const Reference& reference);

  /// Answers a request to the server at `port`; returns the status it answered with.
  int serve(mg_connection* connection, int port, const Access& access) const;

 private:
  std::map<std::string, std::pair<std::string, std::string>, std::less<>> files_;  ///< type, text
};

}  // namespace fingertip::studies::inline live
