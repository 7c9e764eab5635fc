#include "studies/jobs/fem_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <set>

#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"
#include "meshes/tables/file_fields.h"
#include "studies/files/json_entry.h"
#include "studies/jobs/fem_launch.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline jobs {

namespace {

using Clock = std::chrono::steady_clock;

/// Above it an exit code tells the signal that ended a process, as in shells and mpirun.
constexpr int signal_base = 128;
constexpr auto patience = std::chrono::seconds(10);       ///< from SIGINT to the end by force
constexpr auto more_patience = std::chrono::seconds(15);  ///< the same for mpirun itself

/// The reading end of a pipe whose writing end a child holds.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  }
  ~Pipe() {
    close_writing_end();
    ::close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading_end() const { return ends_[0]; }
  int writing_end() const { return ends_[1]; }
  void close_writing_end() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

  /// Reads what is there and hands over complete lines; false at the end of the stream.
  template <typename Take>
  bool drain(const Take& take) {
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(ends_[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) {
      if (!rest_.empty()) take(std::exchange(rest_, {}));
      return false;
    }
    rest_.append(buffer.data(), std::size_t(count));
    for (auto end = rest_.find('\n'); end != rest_.npos; end = rest_.find('\n')) {
      take(rest_.substr(0, end));
      rest_.erase(0, end + 1);
    }
    return true;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
  std::string rest_;
};

/// How far a run is that presses on one mesh after the other, until an error is small enough. Where
/// it tells the time left, by that; else each mesh counts half of what was left.
class FemProgress {
 public:
  void take(const std::string& stage, double done, double time_left) {
    told_ = Clock::now();
    time_left_ = time_left;
    const double within = stage == "mesh"       ? 0.05 * done
                          : stage == "assemble" ? 0.05 + 0.15 * done
                                                : 0.2 + 0.8 * done;
    if (within < within_) left_ *= 0.5;  // from the start again: the next mesh
    within_ = within;
  }
  double fraction() const {
    if (std::isnan(time_left_)) return 1.0 - left_ * (1.0 - 0.5 * within_);
    constexpr double least = 0.1;  // of an estimate that time has overtaken
    const auto now = Clock::now();
    const double left = std::max(time_left_ - seconds(now - told_), least * time_left_);
    const double past = seconds(now - start_);
    return left > 0.0 ? past / (past + left) : 1.0 - 0.5 * least;
  }

 private:
  static double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  }

  Clock::time_point start_ = Clock::now(), told_ = start_;
  double time_left_ = meshes::unknown;  ///< when it was told [s]
  double within_ = 0.0;                 ///< done of this mesh
  double left_ = 1.0;                   ///< share of this mesh and all later ones
};

/// Watches the child until it ends; asks it to stop when the user wants to.
class Watch {
 public:
  Watch(pid_t child, bool under_mpirun, const JobContext& context)
      : child_(child), under_mpirun_(under_mpirun), context_(context) {}

  void take_output(const std::string& line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("stage")) {
      if (!line.empty()) context_.log("fem: " + line);
      return;
    }
    stage_ = json.value("stage", "");
    const double total = json.value("total", 1.0);
    const double done = total > 0.0 ? json.value("done", 0.0) / total : 0.0;
    progress_.take(stage_, done, json.value("left", meshes::unknown));
    const std::string message = json.value("message", "");
    if (!message.empty()) context_.log("fem: " + stage_ + ": " + message);
    const double memory = json.value("memory", 0.0);
    if (memory > shown_memory) stage_ += fmt::format(", some {:.2g} GB", 1e-9 * memory);
    if (memory > memory_of_machine())
      stage_ += fmt::format(" of the {:.2g} GB here", 1e-9 * memory_of_machine());
  }

  void take_error(const std::string& line) {
    context_.log("fem: " + line);
    last_words_ += (last_words_.empty() ? "" : "\n") + line;
    constexpr std::size_t enough = 4000;
    if (last_words_.size() > enough) last_words_.erase(0, last_words_.size() - enough);
  }

  /// Called about ten times a second.
  void tick() {
    const bool go_on = context_.report(progress_.fraction(), stage_);
    if (!go_on && !asked_) {
      asked_ = true;
      asked_at_ = Clock::now();
    }
    if (asked_) ask_to_stop(Clock::now() - asked_at_);
  }

  bool asked_to_stop() const { return asked_; }
  const std::string& last_words() const { return last_words_; }

 private:
  /// SIGINT once to each worker, wherever it has come from by now. mpirun would answer it, and
  /// SIGTERM, by killing the ranks within a second; so it is left alone, and ends after them.
  void ask_to_stop(Clock::duration since) {
    const std::vector<pid_t> workers =
        under_mpirun_ ? children_of(child_) : std::vector<pid_t>{child_};
    for (const pid_t worker : workers) {
      if (asked_workers_.insert(worker).second) ::kill(worker, SIGINT);
    }
    if (since > patience) ::kill(child_, under_mpirun_ ? SIGTERM : SIGKILL);
    if (since > more_patience) ::kill(child_, SIGKILL);
  }

  pid_t child_;
  bool under_mpirun_;
  const JobContext& context_;
  FemProgress progress_;
  std::string stage_ = "continuum";
  std::string last_words_;
  bool asked_ = false;
  std::set<pid_t> asked_workers_;
  Clock::time_point asked_at_;
};

std::string lost_message(int signal, const std::filesystem::path& folder,
                         const std::string& last_words) {
  std::string text = fmt::format("a process of the continuum was lost: signal {} ({})", signal,
                                 ::strsignal(signal));
  if (signal == SIGKILL) {
    text += "; when nobody killed it, memory ran out: lower reference.max_unknowns";
  }
  text += std::filesystem::exists(folder / "response.csv")
              ? "; the finished samples are in " + (folder / "response.csv").string()
              : "; no sample had been finished";
  return last_words.empty() ? text : text + "\n" + last_words;
}

[[noreturn]] void raise(int code, const Watch& watch, const std::filesystem::path& program,
                        const std::filesystem::path& folder) {
  const std::string words = watch.last_words();
  if (code == 130 || watch.asked_to_stop()) throw meshes::Interrupted("the continuum was stopped");
  if (code > signal_base) throw ProcessLost(lost_message(code - signal_base, folder, words));
  if (code == 3) {
    const std::string text = words.empty() ? "the continuum did not converge" : words;
    const auto file = folder / "summary.json";
    const double reached =
        std::filesystem::exists(file) ? number_of(parse_json(file)["reached"]) : meshes::unknown;
    if (!std::isnan(reached)) throw meshes::NoEquilibrium(text, reached);
    throw meshes::NotConverged(text);
  }
  if (code == 2) {
    throw meshes::InvalidInput({"reference", "", words.empty() ? "refused by fingertip-fem" : words,
                                "correct the configuration"});
  }
  if (code == 127) {
    throw meshes::InvalidInput({"fingertip-fem", program.string(), "the program cannot be executed",
                                "build it with ./fingertip doctor"});
  }
  throw std::runtime_error(fmt::format("fingertip-fem ended with code {}: {}", code, words));
}

}  // namespace

void run_fem_process(const std::filesystem::path& program, const std::filesystem::path& folder,
                     const JobContext& context) {
  const FemCommand command = fem_command(program, folder, context.threads, context.ranks);
  Pipe out;
  Pipe err;
  const pid_t child = start_process(command, out.writing_end(), err.writing_end());
  out.close_writing_end();
  err.close_writing_end();
  Watch watch(child, command.under_mpirun, context);
  std::array<pollfd, 2> streams = {pollfd{out.reading_end(), POLLIN, 0},
                                   pollfd{err.reading_end(), POLLIN, 0}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    ::poll(streams.data(), streams.size(), 100);
    const auto ready = [](const pollfd& stream) { return stream.fd >= 0 && stream.revents != 0; };
    if (ready(streams[0]) && !out.drain([&](const std::string& l) { watch.take_output(l); })) {
      streams[0].fd = -1;
    }
    if (ready(streams[1]) && !err.drain([&](const std::string& l) { watch.take_error(l); })) {
      streams[1].fd = -1;
    }
    watch.tick();
  }
  const int code = wait_for(child);
  if (code != 0) raise(code, watch, program, folder);
}

}  // namespace fingertip::studies::inline jobs
