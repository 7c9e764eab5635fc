/// Starts the real `fingertip` in a folder of its own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

struct ProgramResult {
  int code = -1;
  std::string out;
  std::string err;
};

/// A running `fingertip` with `folder` as current folder, `folder`/cache as cache, and its
/// output in files there. `program`: another executable than the one that was built.
class Program {
 public:
  Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
          const std::string& program = {});
  void send(int signal) const;
  pid_t process() const { return process_; }
  ProgramResult wait();

 private:
  std::filesystem::path folder_;
  pid_t process_ = -1;
};

/// Runs it to its end.
ProgramResult run_program(const std::filesystem::path& folder,
                          const std::vector<std::string>& arguments,
                          const std::string& program = {});

/// The words with a `--set` before each of the settings.
std::vector<std::string> with_settings(std::vector<std::string> words,
                                       const std::vector<std::string>& settings);

/// Everything in `folder` apart from the captured output and the cache, as relative names.
std::vector<std::string> made_in(const std::filesystem::path& folder);
