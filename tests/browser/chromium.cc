#include "chromium.h"

#include <civetweb.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace browser {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace std::chrono_literals;

namespace {

constexpr auto patience = 30s;

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> raw;
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  return raw;
}

/// This program's environment with another folder for temporary files.
std::vector<std::string> environment_with(const fs::path& temporary) {
  std::vector<std::string> variables = {"TMPDIR=" + temporary.string()};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!std::string_view(*variable).starts_with("TMPDIR=")) variables.emplace_back(*variable);
  }
  return variables;
}

/// Starts a command whose temporary files go to `temporary`.
pid_t start(std::vector<std::string> command, const fs::path& temporary) {
  std::vector<std::string> environment = environment_with(temporary);
  const std::vector<char*> words = pointers(command), variables = pointers(environment);
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);  // so that all of its processes can be ended together
    const int nowhere = open("/dev/null", O_RDWR);
    for (int stream = 0; stream < 3; ++stream) dup2(nowhere, stream);
    execve(words[0], words.data(), variables.data());
    _exit(127);
  }
  return child;
}

/// Port and path of the browser's own target, once it has written them.
std::pair<int, std::string> wait_for_target(const fs::path& profile) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    std::ifstream in(profile / "DevToolsActivePort");
    int port = 0;
    std::string path;
    if (in >> port >> path && port > 0) return {port, path};
    std::this_thread::sleep_for(50ms);
  }
  throw std::runtime_error("Chromium does not start");
}

std::string decode_base64(const std::string& text) {
  std::string bytes;
  unsigned buffer = 0, bits = 0;
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char c : text) {
    const std::size_t value = digits.find(c);
    if (value == std::string::npos) break;
    buffer = (buffer << 6U) | unsigned(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(char((buffer >> bits) & 0xffU));
  }
  return bytes;
}

}  // namespace

fs::path chromium_program() {
  for (const char* candidate : {"/usr/bin/chromium", "/usr/bin/chromium-browser"}) {
    if (fs::exists(candidate)) return candidate;
  }
  return {};
}

Chromium::Chromium(int width, int height) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // so that end() can wait for all of its processes
  process_ = start(
      {chromium_program(), "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
       "--enable-unsafe-swiftshader", "--no-first-run", "--disable-extensions",
       "--disable-background-networking", "--disable-dev-shm-usage", "--hide-scrollbars",
       "--remote-debugging-port=0", "--user-data-dir=" + profile_.path().string(),
       "--window-size=" + std::to_string(width) + "," + std::to_string(height), "about:blank"},
      profile_.path());
  mg_init_library(0);
  try {
    attach();
    resize(width, height);
  } catch (...) {
    end();
    throw;
  }
}

void Chromium::attach() {
  const auto [port, path] = wait_for_target(profile_.path());
  char error[256] = "";
  connection_ = mg_connect_websocket_client("127.0.0.1", port, 0, error, sizeof error, path.c_str(),
                                            nullptr, &Chromium::on_data, nullptr, this);
  if (connection_ == nullptr) throw std::runtime_error(error);
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}})
                 .at("sessionId");
  for (const char* domain : {"Page", "Runtime", "Log"}) call(domain + std::string(".enable"));
}

Chromium::~Chromium() {
  end();
}

void Chromium::end() {
  if (connection_ != nullptr) mg_close_connection(connection_);
  mg_exit_library();
  kill(-process_, SIGKILL);
  while (waitpid(-process_, nullptr, 0) > 0) continue;  // none may still be writing
}

int Chromium::on_data(mg_connection*, int bits, char* data, std::size_t size, void* self) {
  auto* us = static_cast<Chromium*>(self);
  us->pieces_.append(data, size);
  if ((bits & 0x80) != 0) {
    us->take(us->pieces_);
    us->pieces_.clear();
  }
  return 1;
}

void Chromium::take(const std::string& text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) return;
  const std::lock_guard lock(mutex_);
  if (message.contains("id")) {
    answers_[message["id"].get<int>()] = message;
    answered_.notify_all();
  } else if (message.value("method", "") == "Runtime.exceptionThrown") {
    complaints_.push_back(message["params"]["exceptionDetails"].dump());
  } else if (message.value("method", "") == "Log.entryAdded") {
    const Json& entry = message["params"]["entry"];
    if (entry.value("level", "") == "error") complaints_.push_back(entry.dump());
  }
}

Json Chromium::call(const std::string& method, const Json& parameters) {
  const int id = next_++;
  Json message = {{"id", id}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  mg_websocket_client_write(connection_, MG_WEBSOCKET_OPCODE_TEXT, text.data(), text.size());
  std::unique_lock lock(mutex_);
  if (!answered_.wait_for(lock, patience, [&] { return answers_.contains(id); }))
    throw std::runtime_error(method + ": no answer");
  const Json answer = answers_.at(id);
  answers_.erase(id);
  if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
  return answer.at("result");
}

void Chromium::open(const std::string& url) {
  call("Page.navigate", {{"url", url}});
}

void Chromium::resize(int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Json Chromium::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate",
           {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails"))
    throw std::runtime_error(expression + ": " + answer["exceptionDetails"].dump());
  return answer.at("result").value("value", Json());
}

bool Chromium::wait_for(const std::string& expression, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  // While a page loads its elements do not exist yet.
  const std::string safe =
      "(() => { try { return Boolean(" + expression + "); } catch (error) { return false; } })()";
  while (std::chrono::steady_clock::now() < end) {
    if (evaluate(safe) == true) return true;
    std::this_thread::sleep_for(50ms);
  }
  return false;
}

void Chromium::click(const std::string& selector) {
  drag(selector, 0.0, 0.0);
  release_mouse();
}

void Chromium::mouse(const char* type, double x, double y, int buttons) {
  mouse_x_ = x;
  mouse_y_ = y;
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", x},
                                    {"y", y},
                                    {"button", "left"},
                                    {"buttons", buttons},
                                    {"clickCount", 1}});
}

void Chromium::drag(const std::string& selector, double right, double down) {
  const Json place = evaluate("(() => { const b = document.querySelector('" + selector +
                              "').getBoundingClientRect(); return [b.x + b.width / 2, b.y + "
                              "b.height / 2]; })()");
  const double x = place[0], y = place[1];
  mouse("mouseMoved", x, y, 0);
  mouse("mousePressed", x, y, 1);
  if (right == 0.0 && down == 0.0) return;
  for (int i = 1; i <= 10; ++i) mouse("mouseMoved", x + 0.1 * i * right, y + 0.1 * i * down, 1);
}

void Chromium::release_mouse() {
  mouse("mouseReleased", mouse_x_, mouse_y_, 0);
}

void Chromium::press_key(const std::string& key) {
  // With a text, as from a keyboard: a button that has the focus takes blank and Enter for a click.
  Json event = {{"key", key}, {"code", key}};
  if (key == " ") event.update({{"code", "Space"}, {"text", " "}, {"windowsVirtualKeyCode", 32}});
  if (key == "Enter") event.update({{"text", "\r"}, {"windowsVirtualKeyCode", 13}});
  for (const char* type : {"keyDown", "keyUp"}) {
    event["type"] = type;
    call("Input.dispatchKeyEvent", event);
  }
}

void Chromium::screenshot(const fs::path& file) {
  const Json picture = call("Page.captureScreenshot", {{"format", "png"}});
  std::ofstream(file, std::ios::binary) << decode_base64(picture.at("data"));
}

std::vector<std::string> Chromium::complaints() const {
  const std::lock_guard lock(mutex_);
  return complaints_;
}

}  // namespace browser
