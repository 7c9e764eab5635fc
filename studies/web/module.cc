// The module's face: what page/connection.js calls, with texts and bytes in the module's memory.
#include <deque>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "studies/web/page_session.h"

namespace {

using fingertip::studies::PageSession;
using fingertip::studies::WebMessage;
using fingertip::studies::WebPress;

std::unique_ptr<PageSession> session;
std::deque<WebMessage> answers;
std::string failure;

WebPress press_of(const char* json) {
  WebPress press;
  fingertip::meshes::read_json(nlohmann::json::parse(json), press);
  return press;
}

/// What `work` returns, or -1 and why in `failure`.
template <typename Work>
double attempt(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    failure = error.what();
    return -1.0;
  }
}

}  // namespace

extern "C" {

/// Why the last call failed.
[[gnu::used]] const char* lattice_failure() {
  return failure.c_str();
}

/// Begins with the press of this text (web_press.h). 0, or -1.
[[gnu::used]] double lattice_open(const char* json) {
  return attempt([&] {
    session.reset();
    session = std::make_unique<PageSession>(press_of(json));
    return 0.0;
  });
}

/// Of a press the real-time factor here, measured for `wall` seconds; or -1.
[[gnu::used]] double lattice_pace(const char* json, double wall) {
  return attempt([&] {
    return fingertip::studies::pace_of(press_of(json), std::chrono::duration<double>(wall));
  });
}

/// A message from the page. 0, or -1.
[[gnu::used]] double lattice_take(const char* text) {
  return attempt([&] {
    session->take(text);
    return 0.0;
  });
}

/// Advances for about `budget` seconds; returns how many there is nothing to do, or -1.
[[gnu::used]] double lattice_run(double budget) {
  return attempt([&] {
    const double rest = session->run(PageSession::Seconds(budget)).count();
    for (WebMessage& answer : session->answers()) answers.push_back(std::move(answer));
    return rest;
  });
}

/// The bytes of the first message to the page, null without one; they stay until the next call of
/// lattice_drop.
[[gnu::used]] const char* lattice_answer() {
  return answers.empty() ? nullptr : answers.front().bytes.data();
}
[[gnu::used]] int lattice_answer_size() {
  return int(answers.front().bytes.size());
}
[[gnu::used]] int lattice_answer_is_text() {
  return answers.front().is_text ? 1 : 0;
}
[[gnu::used]] void lattice_drop() {
  answers.pop_front();
}

}  // extern "C"
