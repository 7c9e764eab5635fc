/// Other programs: finding, starting and waiting for them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fingertip::studies::inline files {

/// A program with its arguments and where it is to work.
struct Command {
  std::vector<std::string> words;        ///< the program's path first
  std::vector<std::string> environment;  ///< "NAME=value", beside or instead of what there is
  std::filesystem::path folder = {};     ///< it starts in; empty: the present one
};

/// Where `program` is: among those that came along, else on the PATH; empty when it is nowhere.
std::filesystem::path program_on_path(const std::string& program);

/// mpirun for `ranks` processes on any one machine; the program follows. Throws InvalidInput
/// without mpirun.
std::vector<std::string> mpirun_words(int ranks);

/// Starts it in a process group of its own, without standard input, its output going to the two
/// file descriptors. It gets SIGTERM when the calling thread ends; its exit code is 127 when it
/// cannot be executed. Throws std::runtime_error when there can be no further process.
pid_t start_process(const Command& command, int out, int err);

/// Waits; the exit code, 128 and the signal when one ended it.
int wait_for(pid_t child);

/// Runs it with everything it prints in the file `output`, and waits. Once `stop` says so it gets
/// SIGTERM, and Interrupted is thrown when it has ended. Returns as wait_for does; throws
/// std::runtime_error when the file cannot be written.
int run_process(const Command& command, const std::filesystem::path& output,
                const std::function<bool()>& stop = {});

/// fingertip-fem (reference_program). Where it is not there and `./fingertip` started this program,
/// it is built first, with a word on stderr and the build's own in `build.log`; `stop` as in
/// run_process. Throws InvalidInput where it cannot be had.
std::filesystem::path built_reference_program(const std::function<bool()>& stop = {});

}  // namespace fingertip::studies::inline files
