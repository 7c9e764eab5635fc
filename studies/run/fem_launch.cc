#include "studies/run/fem_launch.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string_view>

#include "meshes/errors.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

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

/// mpirun with what makes it work on any one machine.
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
  // Containers often forbid reading another process's memory, on which Open MPI relies by default
  // (its issue 4948).
  words.insert(words.end(), {"--mca", "btl_vader_single_copy_mechanism", "none"});
  // Waiting ranks otherwise spin; on a machine with other work that made a run five times as long.
  words.insert(words.end(), {"--mca", "mpi_yield_when_idle", "1"});
  return words;
}

/// The parent of a process by its line in /proc, whose second entry is a name in parentheses that
/// may hold anything; 0 when the process has ended.
pid_t parent_of(const fs::path& process) {
  std::ifstream in(process / "stat");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto name_end = text.rfind(')');
  constexpr std::size_t to_parent = 4;  // ") S "
  if (name_end == text.npos || name_end + to_parent >= text.size()) return 0;
  pid_t parent = 0;
  std::from_chars(text.data() + name_end + to_parent, text.data() + text.size(), parent);
  return parent;
}

}  // namespace

FemCommand fem_command(const fs::path& program, const fs::path& folder, int threads, int ranks) {
  if (!fs::exists(program)) {
    throw meshes::InvalidInput({"fingertip-fem", program.string(),
                                "the continuum's program must stand beside fingertip",
                                "build with FINGERTIP_FEM=ON (./fingertip does)"});
  }
  FemCommand command;
  command.under_mpirun = ranks > 1;
  if (command.under_mpirun) command.words = mpirun_words(ranks);
  command.words.push_back(fs::absolute(program).string());
  command.words.push_back(folder.string());
  // BLAS and OpenMP would otherwise start a thread per core in every rank.
  const std::string count = std::to_string(command.under_mpirun ? 1 : threads);
  for (const char* name : {"DEAL_II_NUM_THREADS=", "OMP_NUM_THREADS=", "OPENBLAS_NUM_THREADS="}) {
    command.environment.push_back(name + count);
  }
  return command;
}

pid_t start_process(const FemCommand& command, int out, int err) {
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
    ::execve(arguments[0], arguments.data(), environment.data());
    ::_exit(127);
  }
  return child;
}

std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code failed;
  for (const auto& item : fs::directory_iterator("/proc", failed)) {
    const std::string name = item.path().filename().string();
    pid_t process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    const bool is_process = error == std::errc() && end == name.data() + name.size();
    if (is_process && parent_of(item.path()) == parent) children.push_back(process);
  }
  return children;
}

}  // namespace fingertip::studies
