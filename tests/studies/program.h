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
/// output in files there.
class Program {
 public:
  Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments);
  void send(int signal) const;
  ProgramResult wait();

 private:
  std::filesystem::path folder_;
  pid_t process_ = -1;
};

/// Runs it to its end.
ProgramResult run_program(const std::filesystem::path& folder,
                          const std::vector<std::string>& arguments);

/// Everything in `folder` apart from the captured output and the cache, as relative names.
std::vector<std::string> made_in(const std::filesystem::path& folder);
