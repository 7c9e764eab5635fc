#include "studies/files/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline files {

namespace {

namespace fs = std::filesystem;

/// The environment plus `further`. Built before fork: afterwards a process with threads may only
/// make async-signal-safe calls.
std::vector<char*> environment_with(std::vector<std::string>& further) {
  std::vector<char*> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    bool replaced = false;
    for (const std::string& own : further) {
      replaced |= std::string_view(*entry).starts_with(own.substr(0, own.find('=') + 1));
    }
    if (!replaced) all.push_back(*entry);
  }
  for (std::string& own : further) all.push_back(own.data());
  all.push_back(nullptr);
  return all;
}

int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Waits, looking now and then whether to stop: seldom enough to cost a measured program nothing.
int wait_or_stop(pid_t child, const std::function<bool()>& stop) {
  int status = 0;
  bool stopped = false;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (!stopped && stop()) {
      ::kill(-child, SIGTERM);  // and what it has started
      stopped = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (stopped) throw meshes::Interrupted("stopped by the user");
  return exit_code(status);
}

/// Of this process, removed afterwards.
struct ScratchFile {
  fs::path path =
      fs::temp_directory_path() / ("fingertip-words-" + std::to_string(::getpid()) + ".txt");

  ScratchFile() = default;
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

fs::path program_on_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::string rest = passed_on("bin").string();
  if (path != nullptr) rest += std::string(":") + path;
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    const auto candidate = fs::path(rest.substr(0, colon)) / program;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
    rest = colon == rest.npos ? "" : rest.substr(colon + 1);
  }
  return {};
}

std::vector<std::string> mpirun_words(int ranks) {
  const fs::path mpirun = program_on_path("mpirun");
  if (mpirun.empty()) {
    throw meshes::InvalidInput({"--ranks", std::to_string(ranks),
                                "more than one process needs mpirun on the PATH",
                                "install the package openmpi-bin, or leave --ranks at 1"});
  }
  std::vector<std::string> words = {mpirun.string(), "-n", std::to_string(ranks)};
  if (::geteuid() == 0) words.emplace_back("--allow-run-as-root");
  // mpirun counts cores without their hardware threads and refuses more ranks; the option changes
  // nothing while they suffice. Binding would pile the ranks of two runs onto the same cores.
  words.insert(words.end(), {"--oversubscribe", "--bind-to", "none"});
  // mpirun 4.1 crashes at times when it forwards standard input to a rank that has just ended.
  words.insert(words.end(), {"--stdin", "none"});
  // Without its own explanations of an exit code: ours are in the program's words.
  words.emplace_back("--quiet");
  return words;
}

pid_t start_process(const Command& command, int out, int err) {
  std::vector<std::string> further = command.environment;
  const std::vector<char*> environment = environment_with(further);
  std::vector<std::string> words = command.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start another process");
  if (child == 0) {
    ::setpgid(0, 0);                                      // Ctrl-C reaches it through us, once
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);                   // and it does not outlive us
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);  // mpirun would read the terminal
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    if (command.folder.empty() || ::chdir(command.folder.c_str()) == 0)
      ::execve(arguments[0], arguments.data(), environment.data());
    ::_exit(127);
  }
  return child;
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("lost sight of another process");
  }
  return exit_code(status);
}

int run_process(const Command& command, const fs::path& output, const std::function<bool()>& stop) {
  const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw std::runtime_error("cannot write " + output.string());
  const pid_t child = start_process(command, file, file);
  ::close(file);
  return stop ? wait_or_stop(child, stop) : wait_for(child);
}

fs::path built_reference_program(const std::function<bool()>& stop) {
  const fs::path program = reference_program();
  if (fs::exists(program)) return program;
  static std::mutex one_by_one;
  static std::string failure;  // it is tried once
  const std::lock_guard<std::mutex> lock(one_by_one);
  if (fs::exists(program)) return program;
  const auto refuse = [&](const std::string& remedy) {
    throw meshes::InvalidInput(
        {"fingertip-fem", program.string(), "the continuum's program is not there", remedy});
  };
  const char* const launcher = std::getenv("FINGERTIP_LAUNCHER");
  if (launcher == nullptr || *launcher == '\0')
    refuse("build with FINGERTIP_FEM=ON (./fingertip does, when it is asked for)");
  if (failure.empty()) {
    std::fputs(
        "fingertip: this needs the continuum: installing deal.II and gmsh and building it, once, "
        "some 10 minutes\n",
        stderr);
    const ScratchFile words;
    const int code = run_process({{launcher, "--continuum"}, {}}, words.path, stop);
    if (code == 0 && fs::exists(program)) return program;
    std::string said = meshes::read_text(words.path);
    said.erase(said.find_last_not_of('\n') + 1);
    failure = "`./fingertip reference` builds it; here that failed: " +
              said.substr(said.find_last_of('\n') + 1);
  }
  refuse(failure);
  return {};
}

}  // namespace fingertip::studies::inline files
