#include "tests/studies/program.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace fs = std::filesystem;

Program::Program(const fs::path& folder, const std::vector<std::string>& arguments,
                 const std::string& other)
    : folder_(folder) {
  const std::string program = other.empty() ? FINGERTIP_PROGRAM : other;
  const std::string out = (folder / "stdout").string();
  const std::string err = (folder / "stderr").string();
  const std::string cache = (folder / "cache").string();
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  process_ = ::fork();
  if (process_ != 0) return;
  ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
  ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
  if (::chdir(folder.c_str()) == 0) ::execv(program.c_str(), words.data());
  ::_exit(127);
}

void Program::send(int signal) const {
  ::kill(process_, signal);
}

ProgramResult Program::wait() {
  int status = 0;
  ::waitpid(process_, &status, 0);
  ProgramResult result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_text(folder_ / "stdout");
  result.err = read_text(folder_ / "stderr");
  return result;
}

ProgramResult run_program(const fs::path& folder, const std::vector<std::string>& arguments,
                          const std::string& program) {
  return Program(folder, arguments, program).wait();
}

std::vector<std::string> with_settings(std::vector<std::string> words,
                                       const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  return words;
}

std::vector<std::string> made_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& item : fs::directory_iterator(folder)) {
    const std::string name = item.path().filename().string();
    if (name != "stdout" && name != "stderr" && name != "cache") names.push_back(name);
  }
  return names;
}
