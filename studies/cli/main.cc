/// The program `fingertip`: from the words on the command line to a verb and an exit code.

#include <fmt/format.h>

#include <exception>
#include <map>

#include "lattice/control/controller.h"
#include "meshes/errors.h"
#include "studies/cli/verbs.h"
#include "studies/run/blas_threads.h"

namespace {

using namespace fingertip;

int dispatch(const studies::CommandLine& line) {
  static const std::map<std::string, int (*)(const studies::CommandLine&)> verbs = {
      {"validate", studies::run_validate},   {"press", studies::run_press},
      {"live", studies::run_live},           {"modes", studies::run_modes},
      {"grasp", studies::run_grasp},         {"reference", studies::run_reference},
      {"calibrate", studies::run_calibrate}, {"compare", studies::run_compare},
      {"export", studies::run_export},       {"import", studies::run_import},
      {"report", studies::run_report},       {"check", studies::run_check},
      {"explain", studies::run_explain},     {"init", studies::run_init},
      {"doctor", studies::run_doctor},       {"bench", studies::run_bench},
      {"sweep", studies::run_sweep}};
  return verbs.at(line.verb)(line);
}

void complain(const std::string& message) {
  fmt::print(stderr, "fingertip: error: {}\n", message);
}

}  // namespace

int main(int argc, char** argv) {
  studies::keep_blas_to_one_thread();
  try {
    const auto parsed = studies::parse_command_line(argc, argv);
    if (const int* code = std::get_if<int>(&parsed)) return *code;
    return dispatch(std::get<studies::CommandLine>(parsed));
  } catch (const studies::ConfigError& error) {
    for (const studies::Problem& problem : error.problems()) complain(to_string(problem));
    return 2;
  } catch (const meshes::InvalidInput& error) {
    for (const meshes::Violation& violation : error.violations()) complain(to_string(violation));
    return 2;
  } catch (const meshes::NotConverged& error) {
    complain(error.what());
    return 3;
  } catch (const lattice::ControllerFailed& error) {
    complain(error.what());
    return 3;
  } catch (const meshes::Interrupted& error) {
    complain(std::string("interrupted: ") + error.what());
    return 130;
  } catch (const std::exception& error) {
    complain(error.what());
    return 1;
  }
}
