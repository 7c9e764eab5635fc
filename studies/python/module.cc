/// The extension of the Python module: verbs, the key table, tables and a finger to step.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/base/blas.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/places.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/press_setup.h"
#include "studies/python/errors.h"
#include "studies/python/finger.h"
#include "studies/python/keys.h"
#include "studies/python/tables.h"

namespace fingertip::studies::inline python {

namespace py = pybind11;

namespace {

/// Ctrl-C means the run while one is at work, and Python afterwards.
struct Watch {
  Watch() { watch_for_interrupts(); }
  ~Watch() { stop_watching(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
};

/// A verb as on the command line; its exit code.
int run(const std::string& verb, const std::vector<std::string>& arguments,
        const std::filesystem::path& config, const std::vector<std::string>& sets,
        const std::filesystem::path& out, bool force, bool resume, bool quiet, int ranks,
        const std::string& format, bool lossy) {
  CommandLine line;
  line.verb = verb;
  line.arguments = arguments;
  line.config = {config, sets, {}};
  line.out = out;
  line.force = force;
  line.resume = resume;
  line.quiet = quiet;
  line.ranks = ranks;
  line.format = format;
  line.lossy = lossy;
  if (!quiet) line.progress = ProgressStyle::lines;
  line.words = {"fingertip.py", verb};
  for (const std::string& argument : arguments) line.words.push_back(argument);
  if (!config.empty()) line.words.insert(line.words.end(), {"--config", config.string()});
  for (const std::string& set : sets) line.words.insert(line.words.end(), {"--set", set});
  const Watch watch;
  const meshes::OneBlasThread calm;
  return run_verb(line);
}

void check(const std::filesystem::path& config, const std::vector<std::string>& sets) {
  check_all(load_config({config, sets, {}}));
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of fingertip.";
  meshes::leave_oldest_blas_kernels();
  translate_errors();
  add_tables(module);
  add_keys(module);
  add_finger(module);
  module.def("run", run, py::arg("verb"), py::arg("arguments"), py::arg("config"), py::arg("sets"),
             py::arg("out"), py::arg("force"), py::arg("resume"), py::arg("quiet"),
             py::arg("ranks"), py::arg("format") = CommandLine().format, py::arg("lossy") = false,
             py::call_guard<py::gil_scoped_release>());
  module.def("check", check, py::arg("config"), py::arg("sets"));
  module.def("program", [] { return executable_folder() / "fingertip"; });
}

}  // namespace fingertip::studies::inline python
