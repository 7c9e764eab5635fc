#include "studies/exchange/lammps_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>

#include "meshes/errors.h"
#include "studies/exchange/lammps_files.h"
#include "studies/run/fem_launch.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

namespace {

void require(const std::string& program, const std::string& package) {
  if (!program_on_path(program).empty()) return;
  throw meshes::InvalidInput(
      {program, "", "the program is not on the PATH", "install the Debian package " + package});
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

LammpsTiming run_lammps(const std::filesystem::path& folder, int ranks,
                        const std::string& program) {
  require(program, "lammps");
  FemCommand command{{"/usr/bin/env", "-C", folder.string()}, {"OMP_NUM_THREADS=1"}, ranks > 1};
  const auto add = [&](std::initializer_list<const char*> words) {
    command.words.insert(command.words.end(), words.begin(), words.end());
  };
  if (ranks > 1) {
    require("mpirun", "openmpi-bin");
    add({"mpirun", "-n"});
    command.words.push_back(std::to_string(ranks));
    add({"--oversubscribe", "--bind-to", "none", "--stdin", "none", "--quiet"});
    if (::geteuid() == 0) add({"--allow-run-as-root"});
  }
  add({program.c_str(), "-in", lammps_script, "-log", lammps_log});
  const std::filesystem::path words = folder / "lammps.txt";
  const int out = ::open(words.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0) throw std::runtime_error("cannot write " + words.string());
  const int code = wait_for(start_process(command, out, out));
  ::close(out);
  if (code == 0) return read_lammps_log(folder / lammps_log);
  std::ifstream in(words);
  const std::string said{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto error = said.find("ERROR");
  throw std::runtime_error("LAMMPS ended with code " + std::to_string(code) + ": " +
                           (error == said.npos ? said : said.substr(error)));
}

}  // namespace fingertip::studies
