/// The program `fingertip`: from the words on the command line to a verb and an exit code.

#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <new>

#include "meshes/base/blas.h"
#include "meshes/base/errors.h"
#include "studies/cli/command_line/standard_streams.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/jobs/ending.h"

namespace {

using namespace fingertip;

/// Messages quote files and command lines: what would steer a terminal is shown as a question mark,
/// and of a very long message the ends.
std::string presentable(std::string message) {
  constexpr std::size_t most = 6000;
  if (message.size() > most) message.replace(most / 2, message.size() - most, " [...] ");
  for (char& c : message) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7f) c = '?';
  }
  return message;
}

void complain(const std::string& message) {
  fmt::print(stderr, "fingertip: error: {}\n", presentable(message));
}

int run(int argc, char** argv) {
  try {
    const auto parsed = studies::parse_command_line(argc, argv);
    if (const int* code = std::get_if<int>(&parsed)) return *code;
    return studies::run_verb(std::get<studies::CommandLine>(parsed));
  } catch (const meshes::InvalidInput& error) {
    for (const meshes::Violation& violation : error.violations()) complain(to_string(violation));
    return 2;
  } catch (const std::bad_alloc&) {
    complain("there is not enough memory; choose a coarser lattice or mesh");
    return 3;
  } catch (const std::exception& error) {
    const int code = studies::ending_of(error).exit_code;
    complain((code == 130 ? "interrupted: " : "") + std::string(error.what()));
    return code;
  }
}

}  // namespace

int main(int argc, char** argv) {
  meshes::leave_oldest_blas_kernels();
  meshes::keep_blas_to_one_thread();
  studies::StandardStreams streams;
  const int code = run(argc, argv);
  if (const int why = streams.lost(); why != 0) {
    complain(std::string("standard output could not be written: ") + std::strerror(why));
    return code == 0 ? 3 : code;
  }
  return code;
}
