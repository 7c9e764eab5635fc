#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>

namespace fingertip::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int cannot_start = 127;

double seconds(const timeval& time) {
  return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// This program's environment, `further` before it: the first entry of a name counts.
std::vector<std::string> environment_with(const std::vector<std::string>& further) {
  std::vector<std::string> all = further;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const auto same_name = [&](const std::string& own) {
      return text.starts_with(own.substr(0, own.find('=') + 1));
    };
    if (std::ranges::none_of(further, same_name)) all.push_back(text);
  }
  return all;
}

pid_t start(std::vector<std::string> command, const std::filesystem::path& folder,
            std::vector<std::string> environment, const std::filesystem::path& log) {
  const std::vector<char*> arguments = pointers(command), entries = pointers(environment);
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (output < 0) throw std::runtime_error("cannot write " + log.string());
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it does not outlive this program
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execve(arguments[0], arguments.data(), entries.data());
    ::_exit(cannot_start);
  }
  ::close(output);
  if (child < 0) throw std::runtime_error("cannot start another process");
  return child;
}

/// True when `child` ended within `limit` seconds.
bool ends_within(pid_t child, double limit) {
  // The header of Debian 12 declares pidfd_open without C linkage; hence the system call itself.
  const int handle = int(::syscall(SYS_pidfd_open, child, 0));
  if (handle < 0) throw std::runtime_error("cannot watch the process");
  const auto until = Clock::now() + std::chrono::duration<double>(limit);
  int ready = -1;
  do {
    const auto left = std::chrono::duration<double, std::milli>(until - Clock::now()).count();
    pollfd watched{handle, POLLIN, 0};
    ready = ::poll(&watched, 1, int(std::clamp(left, 0.0, 1e9)));
  } while (ready < 0 && errno == EINTR);
  ::close(handle);
  return ready > 0;
}

}  // namespace

Cost run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::vector<std::string>& environment, double limit,
               const std::filesystem::path& log) {
  const auto begin = Clock::now();
  const pid_t child = start(command, folder, environment_with(environment), log);
  Cost cost;
  cost.timed_out = !ends_within(child, limit);
  if (cost.timed_out) ::kill(child, SIGKILL);
  int status = 0;
  rusage used{};
  while (::wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
  }
  cost.wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  cost.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  cost.peak_memory = std::size_t(used.ru_maxrss) * 1024;
  cost.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  cost.finished = cost.exit_code == 0;
  if (cost.exit_code == cannot_start)
    throw std::runtime_error("cannot start " + command.front() + " in " + folder.string());
  return cost;
}

}  // namespace fingertip::benchmarks
