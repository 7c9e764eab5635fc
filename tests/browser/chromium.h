/// A headless Chromium, driven through the DevTools protocol.
#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

struct mg_connection;

namespace browser {

/// Where Chromium is; empty when it is not installed.
std::filesystem::path chromium_program();

/// One Chromium with one page and a profile of its own, gone with this object.
class Chromium {
 public:
  /// Throws std::runtime_error when it does not start within 30 s.
  Chromium(int width, int height);
  ~Chromium();
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  void open(const std::string& url);
  void reload() { call("Page.reload"); }
  /// The size of the window [CSS pixels].
  void resize(int width, int height);
  /// The value of a JavaScript expression. Throws std::runtime_error when it throws.
  nlohmann::json evaluate(const std::string& expression);
  /// Whether the expression becomes true within `seconds`.
  bool wait_for(const std::string& expression, double seconds = 20.0);
  void click(const std::string& selector);
  /// Presses the mouse in the middle of the element, moves it by the pixels given in ten steps, and
  /// keeps the button down; release_mouse() lets go.
  void drag(const std::string& selector, double right, double down);
  void release_mouse();
  void press_key(const std::string& key);
  /// A PNG of the page.
  void screenshot(const std::filesystem::path& file);
  /// Exceptions and console errors of the page so far.
  std::vector<std::string> complaints() const;

 private:
  nlohmann::json call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object());
  void attach();
  void end();
  void take(const std::string& text);
  void mouse(const char* type, double x, double y, int buttons);
  static int on_data(mg_connection* connection, int bits, char* data, std::size_t size, void* self);

  TemporaryFolder profile_;
  pid_t process_ = -1;
  mg_connection* connection_ = nullptr;
  std::string session_;  ///< with the page
  int next_ = 1;
  double mouse_x_ = 0.0, mouse_y_ = 0.0;
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  std::map<int, nlohmann::json> answers_;
  std::vector<std::string> complaints_;
  std::string pieces_;  ///< of a message that comes in several frames
};

}  // namespace browser
