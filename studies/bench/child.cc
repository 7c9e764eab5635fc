#include "studies/bench/child.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "meshes/errors.h"
#include "studies/run/fem_launch.h"
#include "studies/run/interrupt.h"

namespace fingertip::studies {

int run_child(const std::vector<std::string>& words, const std::vector<std::string>& environment,
              const std::filesystem::path& output) {
  const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw std::runtime_error("cannot write " + output.string());
  const pid_t child = start_process({words, environment, false}, file, file);
  ::close(file);
  int status = 0;
  bool stopped = false;
  // Polling seldom enough to cost the measured program nothing.
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (interrupted() && !stopped) {
      ::kill(child, SIGTERM);
      stopped = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (stopped) throw meshes::Interrupted("stopped by the user");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace fingertip::studies
