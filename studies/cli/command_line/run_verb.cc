#include "studies/cli/command_line/run_verb.h"

#include <fmt/format.h>

#include "lattice/dynamics/thread_choice.h"
#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"
#include "studies/config/asked_units.h"
#include "studies/files/places.h"
#include "studies/jobs/cache.h"
#include "studies/jobs/ending.h"
#include "studies/jobs/interrupt.h"
#include "studies/jobs/result_files.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline command_line {

namespace {

/// What to do with a run that ended early. What did not converge would not do so again.
std::string kept_in(const std::string& folder, const std::string& status) {
  if (status == "not converged")
    return fmt::format(
        "\nfingertip: {} is kept; run it with other settings, the same ones end the same way",
        folder);
  return fmt::format(
      "\nfingertip: {} is kept; the same command with --out {} --resume auto computes the rest",
      folder, folder);
}

/// The error as one of the kinds that it is, the special ones first, or else as a runtime_error,
/// with more to say.
template <typename... Kinds>
[[noreturn]] void throw_with(const std::exception& error, const std::string& more) {
  const std::string words = error.what() + more;
  const auto throw_if = [&]<typename Kind>(const Kind* kind) {
    if (kind != nullptr) throw Kind(words);
  };
  (throw_if(dynamic_cast<const Kinds*>(&error)), ...);
  throw std::runtime_error(words);
}

/// A calibration may find bad input late, when continua and fits are there already.
bool holds_results(const std::filesystem::path& folder) {
  using Walk = std::filesystem::recursive_directory_iterator;
  for (Walk item(folder); item != Walk(); ++item) {
    if (item->path().filename() == marker_name) return true;
    // What --force has moved out of the way is hidden.
    if (item->path().filename().string().starts_with('.')) item.disable_recursion_pending();
  }
  return false;
}

}  // namespace

std::string failure_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const meshes::Interrupted&) {
    throw;
  } catch (const meshes::CannotWrite&) {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

int cores_for(const LoadedConfig& loaded) {
  const int wanted = loaded.config.press.threads;
  return wanted > 0 ? wanted : lattice::machine_cores();
}

LoadedConfig load_checked(const CommandLine& line) {
  LoadedConfig loaded = load_config(line.config);
  check_all(loaded);
  return loaded;
}

int run_in_folder(const CommandLine& line, const LoadedConfig& loaded, const std::string& case_text,
                  const std::function<int(Session&)>& body) {
  const ShowIn units(asked_units(loaded));
  watch_for_interrupts();
  RunFolder folder({line.verb, line.out, line.force, line.resume, line.words, line.folder_stem},
                   loaded, case_text);
  if (!line.quiet) {
    for (const std::string& note : loaded.notes) fmt::print(stderr, "fingertip: note: {}\n", note);
  }
  Progress progress(line.progress);
  const Cache cache(cache_folder());
  cache.tidy();
  Session session(folder, progress, cache, cores_for(loaded), line.ranks);
  try {
    const int code = body(session);
    folder.finish(code == 0 ? "finished" : code == 3 ? "not converged" : "criteria failed", code);
    return code;
  } catch (const std::exception& error) {
    progress.clear();
    const auto [status, exit_code] = ending_of(error);
    if (exit_code == 2 && !folder.resumed() && !holds_results(folder.path())) {
      folder.discard();
    } else {
      try {
        folder.finish(status, exit_code, error.what());
      } catch (const meshes::CannotWrite&) {
        // The reason why the run ended is what counts.
      }
    }
    if (const auto* invalid = dynamic_cast<const meshes::InvalidInput*>(&error))
      throw loaded.locate(invalid->violations());
    if (exit_code == 2) throw;
    const std::string kept = kept_in(folder.path().string(), status);
    if (status == std::string_view("could not write"))
      throw meshes::CannotWrite(error.what() + kept);
    throw_with<ProcessLost, lattice::ControllerFailed, meshes::NotConverged, meshes::Interrupted>(
        error, kept);
  }
}

void print_folder(const Session& session, const JobResult& result) {
  if (result.reused)
    fmt::print("(result from an earlier run with the same input)\n");
  else
    fmt::print("computed in {:.2f} s\n", result.wall_time);
  fmt::print("run folder: {}\n", session.path_of({}).string());
}

}  // namespace fingertip::studies::inline cli::inline command_line
