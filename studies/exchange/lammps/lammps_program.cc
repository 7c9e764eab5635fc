#include "studies/exchange/lammps/lammps_program.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "meshes/base/errors.h"
#include "studies/exchange/lammps/lammps_files.h"
#include "studies/files/process.h"

namespace fingertip::studies::inline exchange::inline lammps {

namespace {

std::string required(const std::string& program, const std::string& package) {
  const std::filesystem::path found = program_on_path(program);
  if (!found.empty()) return std::filesystem::absolute(found).string();
  throw meshes::InvalidInput(
      {program, "", "the program is not on the PATH", "install the Debian package " + package});
}

}  // namespace

LammpsTiming read_lammps_log(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw meshes::InvalidInput({file.string(), "", "the log of LAMMPS cannot be read",
                                "run lmp -in lattice.in in this folder first"});
  }
  LammpsTiming timing;
  bool found = false;
  std::string error, version;
  double percent = 100.0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("ERROR")) error = line;
    if (line.starts_with("LAMMPS (")) version = line.substr(8, line.rfind(')') - 8);
    LammpsTiming loop;
    if (std::sscanf(line.c_str(), "Loop time of %lf on %d procs for %ld steps with %zu atoms",
                    &loop.loop_time, &loop.ranks, &loop.steps, &loop.atoms) == 4) {
      timing = loop;
      found = true;
    }
    if (found && std::sscanf(line.c_str(), "%lf%% CPU use", &percent) == 1)
      timing.processor_share = std::min(1.0, 0.01 * percent);
  }
  timing.version = version;
  const bool sound = std::isfinite(timing.loop_time) && timing.loop_time >= 0.0 &&
                     timing.ranks >= 1 && timing.steps >= 0 && timing.processor_share >= 0.0;
  if (found && error.empty() && !sound) {
    throw meshes::InvalidInput(
        {file.string(), "", "the log's times or numbers make no sense", "run LAMMPS again"});
  }
  if (!found || !error.empty()) {
    throw meshes::InvalidInput({file.string(), error, "LAMMPS did not come to the end of its run",
                                "let it run to its end, or see the log for the reason"});
  }
  return timing;
}

LammpsTiming run_lammps(const std::filesystem::path& folder, int ranks,
                        const std::string& program) {
  Command command{{}, {"OMP_NUM_THREADS=1"}, folder};
  if (ranks > 1) command.words = mpirun_words(ranks);
  for (const std::string& word :
       {required(program, "lammps"), std::string("-in"), std::string(lammps_script),
        std::string("-log"), std::string(lammps_log)})
    command.words.push_back(word);
  const std::filesystem::path words = folder / "lammps.txt";
  const int code = run_process(command, words);
  if (code == 0) return read_lammps_log(folder / lammps_log);
  std::ifstream in(words);
  const std::string said{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto error = said.find("ERROR");
  throw std::runtime_error("LAMMPS ended with code " + std::to_string(code) + ": " +
                           (error == said.npos ? said : said.substr(error)));
}

}  // namespace fingertip::studies::inline exchange::inline lammps
