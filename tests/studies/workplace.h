/// The real `fingertip` in a temporary folder of its own, and what it leaves there.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "tests/expectations.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using Words = std::vector<std::string>;

/// Both, as a list of settings or words.
Words operator+(Words first, const Words& second);

/// In place of an exit code: a fit is accepted (0) or not (4).
constexpr int judged = -1;
/// In place of an exit code: whatever it is.
constexpr int any_code = -2;

/// All names are relative to the folder.
class Workplace : public TemporaryFolder {
 public:
  Workplace() = default;
  /// Of another executable than the one that was built.
  explicit Workplace(std::string program) : program_(std::move(program)) {}

  /// Runs a command, parted at blanks, with a --set before each of the settings, and expects its
  /// exit code.
  ProgramResult run(const std::string& command, const Words& settings = {}, int code = 0) const;
  /// Goes on while the test does.
  Program start(const std::string& command, const Words& settings = {}) const;
  /// Expects that the command ends with 2, says all of the parts, and writes nothing.
  void expect_refused(const std::string& command, const Words& settings, const Parts& parts) const;

  bool has(const std::string& name) const { return std::filesystem::exists(path() / name); }
  /// Waits for a file of a program that runs, at most for a minute or two; whether it has come.
  bool comes(const std::string& name) const;
  /// Waits for words of a program that runs, on either of its outputs; whether they have come.
  bool hears(const std::string& words) const;
  void expect_files(const std::string& in, const Words& names) const;
  void put(const std::string& name, const std::string& text) const {
    write_text(path() / name, text);
  }
  std::string text(const std::string& name) const { return read_text(path() / name); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
  /// Of a run's response.csv.
  fingertip::meshes::PressResponse response(const std::string& run) const {
    return fingertip::meshes::PressResponse::read_csv(path() / run / "response.csv");
  }
  std::vector<fingertip::meshes::PressSample> samples(const std::string& run) const {
    return response(run).samples();
  }
  void forget_cache() const { std::filesystem::remove_all(path() / "cache"); }

 private:
  std::string program_;
};
