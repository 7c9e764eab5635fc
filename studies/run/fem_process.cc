#include "studies/run/fem_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <vector>

#include "meshes/errors.h"

namespace fingertip::studies {

namespace {

using Clock = std::chrono::steady_clock;

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

pid_t start(const std::string& program, const std::string& folder, int threads, const Pipe& out,
            const Pipe& err) {
  // BLAS and OpenMP would otherwise start a thread per core beside the lattice jobs.
  const std::string count = std::to_string(threads);
  std::vector<std::string> limits = {"DEAL_II_NUM_THREADS=" + count, "OMP_NUM_THREADS=" + count,
                                     "OPENBLAS_NUM_THREADS=1"};
  const std::vector<char*> environment = environment_with(limits);
  std::string program_text = program;
  std::string folder_text = folder;
  std::array<char*, 3> arguments = {program_text.data(), folder_text.data(), nullptr};
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start another process");
  if (child == 0) {
    ::setpgid(0, 0);                     // Ctrl-C reaches it through us, once
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // and it does not outlive us
    ::dup2(out.writing_end(), STDOUT_FILENO);
    ::dup2(err.writing_end(), STDERR_FILENO);
    ::execve(arguments[0], arguments.data(), environment.data());
    ::_exit(127);
  }
  return child;
}

/// The share of a stage in the whole.
struct Stage {
  std::string_view name;
  double begin, end;
};
constexpr Stage stages[] = {
    {"mesh", 0.0, 0.05}, {"assemble", 0.05, 0.35}, {"press", 0.35, 0.8}, {"error mesh", 0.8, 1.0}};

/// Watches the child until it ends; asks it to stop when the user wants to.
class Watch {
 public:
  Watch(pid_t child, const JobContext& context) : child_(child), context_(context) {}

  void take_output(const std::string& line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("stage")) {
      if (!line.empty()) context_.log("fem: " + line);
      return;
    }
    stage_ = json.value("stage", stage_);
    const double total = json.value("total", 1.0);
    const double done = total > 0.0 ? json.value("done", 0.0) / total : 0.0;
    for (const Stage& stage : stages) {
      if (stage_ == stage.name) fraction_ = stage.begin + (stage.end - stage.begin) * done;
    }
    const std::string message = json.value("message", "");
    if (!message.empty()) context_.log("fem: " + stage_ + ": " + message);
  }

  void take_error(const std::string& line) {
    context_.log("fem: " + line);
    last_words_ += (last_words_.empty() ? "" : "\n") + line;
    constexpr std::size_t enough = 4000;
    if (last_words_.size() > enough) last_words_.erase(0, last_words_.size() - enough);
  }

  /// Called about ten times a second.
  void tick() {
    const bool go_on = context_.report(fraction_, stage_);
    if (!go_on && !asked_) {
      asked_ = true;
      asked_at_ = Clock::now();
      ::kill(child_, SIGINT);
    }
    if (asked_ && Clock::now() - asked_at_ > std::chrono::seconds(10)) ::kill(child_, SIGKILL);
  }

  bool asked_to_stop() const { return asked_; }
  const std::string& last_words() const { return last_words_; }

 private:
  pid_t child_;
  const JobContext& context_;
  double fraction_ = 0.0;
  std::string stage_ = "continuum";
  std::string last_words_;
  bool asked_ = false;
  Clock::time_point asked_at_;
};

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

[[noreturn]] void raise(int code, const Watch& watch, const std::filesystem::path& program) {
  const std::string words = watch.last_words();
  if (code == 130 || watch.asked_to_stop()) throw meshes::Interrupted("the continuum was stopped");
  if (code == 3)
    throw meshes::NotConverged(words.empty() ? "the continuum did not converge" : words);
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
  if (!std::filesystem::exists(program)) {
    throw meshes::InvalidInput({"fingertip-fem", program.string(),
                                "the continuum's program must stand beside fingertip",
                                "build with FINGERTIP_FEM=ON (./fingertip does)"});
  }
  Pipe out;
  Pipe err;
  const pid_t child = start(program.string(), folder.string(), context.threads, out, err);
  out.close_writing_end();
  err.close_writing_end();
  Watch watch(child, context);
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
  if (code != 0) raise(code, watch, program);
}

}  // namespace fingertip::studies
