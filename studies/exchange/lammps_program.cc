#include "studies/exchange/lammps_program.h"

#include <fstream>
#include <iterator>

#include "meshes/base/errors.h"
#include "studies/exchange/lammps_files.h"
#include "studies/files/process.h"

namespace fingertip::studies {

namespace {

std::string required(const std::string& program, const std::string& package) {
  const std::filesystem::path found = program_on_path(program);
  if (!found.empty()) return std::filesystem::absolute(found).string();
  throw meshes::InvalidInput(
      {program, "", "the program is not on the PATH", "install the Debian package " + package});
}

}  // namespace

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

}  // namespace fingertip::studies
