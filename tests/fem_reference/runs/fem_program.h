/// The program fingertip-fem as its users start it: in a folder, under mpirun if wanted, and
/// stopped by signals. Needs FINGERTIP_FEM_PROGRAM and MPIRUN as macros.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "fem_reference/job/job.h"
#include "tests/temporary_folder.h"

/// One run. A process that waits for another yields its core, which tests share with others.
/// Standard output goes to `folder`.out, standard error to `folder`.err.
class FemProgram {
 public:
  /// Starts it with these arguments; `ranks` > 1 under mpirun.
  FemProgram(const std::filesystem::path& folder, std::vector<std::string> arguments, int ranks = 1)
      : output_(folder.string() + ".out"), errors_(folder.string() + ".err") {
    std::vector<std::string> words;
    if (ranks > 1)
      words = {MPIRUN,
               "--allow-run-as-root",
               "--oversubscribe",
               "--bind-to",
               "none",
               "--mca",
               "mpi_yield_when_idle",
               "1",
               "-n",
               std::to_string(ranks)};
    words.emplace_back(FINGERTIP_FEM_PROGRAM);
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> raw;
    for (std::string& word : words) raw.push_back(word.data());
    raw.push_back(nullptr);
    child_ = ::fork();
    if (child_ != 0) return;
    redirect(output_, STDOUT_FILENO);
    redirect(errors_, STDERR_FILENO);
    ::setenv("OMP_NUM_THREADS", "1", 1);
    ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
    ::execv(raw[0], raw.data());
    ::_exit(127);
  }
  ~FemProgram() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    wait();
  }
  FemProgram(const FemProgram&) = delete;
  FemProgram& operator=(const FemProgram&) = delete;

  void send(int signal) const { ::kill(child_, signal); }

  /// Exit code; minus the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  /// Waits until `condition` holds or the program has ended; says whether it still runs.
  bool runs_until(const std::function<bool()>& condition) {
    while (!condition()) {
      siginfo_t info{};
      ::waitid(P_PID, id_t(child_), &info, WEXITED | WNOHANG | WNOWAIT);
      if (info.si_pid != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  std::string output() const { return read_text(output_); }
  std::string errors() const { return read_text(errors_); }

 private:
  static void redirect(const std::filesystem::path& file, int descriptor) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(opened, descriptor);
    ::close(opened);
  }

  std::filesystem::path output_, errors_;
  pid_t child_ = 0;
};

/// A run folder `name` with the job in it.
inline std::filesystem::path run_folder(const TemporaryFolder& parent, const std::string& name,
                                        const fingertip::fem_reference::ReferenceJob& job) {
  std::filesystem::create_directories(parent / name);
  write_job(job, parent / (name + "/job.json"));
  return parent / name;
}

/// Carries out the job in `folder` to its end; the exit code.
inline int carry_out(const std::filesystem::path& folder, int ranks = 1) {
  return FemProgram(folder, {folder.string()}, ranks).wait();
}
