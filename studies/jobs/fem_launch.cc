#include "studies/jobs/fem_launch.h"

#include <charconv>
#include <fstream>
#include <iterator>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline jobs {

namespace {

namespace fs = std::filesystem;

/// mpirun, made to work in containers and beside other work.
std::vector<std::string> patient_mpirun(int ranks) {
  std::vector<std::string> words = mpirun_words(ranks);
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
  if (command.under_mpirun) command.words = patient_mpirun(ranks);
  command.words.push_back(fs::absolute(program).string());
  command.words.push_back(folder.string());
  // BLAS and OpenMP would otherwise start a thread per core in every rank.
  const std::string count = std::to_string(command.under_mpirun ? 1 : threads);
  for (const char* name : {"DEAL_II_NUM_THREADS=", "OMP_NUM_THREADS=", "OPENBLAS_NUM_THREADS="}) {
    command.environment.push_back(name + count);
  }
  return command;
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

}  // namespace fingertip::studies::inline jobs
