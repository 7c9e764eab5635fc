#include "studies/cli/command_line/run_verb.h"

#include <fmt/format.h>

#include "lattice/control/controller.h"
#include "lattice/dynamics/thread_choice.h"
#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"
#include "studies/config/asked_units.h"
#include "studies/jobs/cache.h"
#include "studies/jobs/interrupt.h"
#include "studies/jobs/result_files.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline command_line {

namespace {

/// What to do with a run that ended early. What did not converge would not do so again.
std::string kept_in(const std::filesystem::path& folder, bool computes_on) {
  if (!computes_on)
    return fmt::format(
        "\nfingertip: {} is kept; run it with other settings, the same ones end the same way",
        folder.string());
  return fmt::format(
      "\nfingertip: {} is kept; the same command with --out {} --resume auto computes the "
      "rest",
      folder.string(), folder.string());
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
  const Cache cache(Cache::default_folder());
  cache.tidy();
  Session session(folder, progress, cache, cores_for(loaded), line.ranks);
  const auto end = [&](const std::string& status, int code, const std::exception& why,
                       bool computes_on = true) {
    progress.clear();
    try {
      folder.finish(status, code, why.what());
    } catch (const meshes::CannotWrite&) {
      // The reason why the run ended is what counts.
    }
    return why.what() + kept_in(folder.path(), computes_on);
  };
  const auto refuse = [&](const std::exception& why) {
    progress.clear();
    if (folder.resumed() || holds_results(folder.path())) {
      folder.finish("bad input", 2, why.what());
    } else {
      folder.discard();
    }
  };
  try {
    const int code = body(session);
    folder.finish(code == 0 ? "finished" : code == 3 ? "not converged" : "criteria failed", code);
    return code;
  } catch (const ProcessLost& error) {
    throw ProcessLost(end("process lost", 3, error));
  } catch (const lattice::ControllerFailed& error) {
    throw lattice::ControllerFailed(end("controller failed", 3, error));
  } catch (const meshes::NotConverged& error) {
    throw meshes::NotConverged(end("not converged", 3, error, false));
  } catch (const meshes::Interrupted& error) {
    throw meshes::Interrupted(end("interrupted", 130, error));
  } catch (const meshes::InvalidInput& error) {
    refuse(error);
    throw loaded.locate(error.violations());
  } catch (const ConfigError& error) {
    refuse(error);
    throw;
  } catch (const meshes::CannotWrite& error) {
    throw meshes::CannotWrite(end("could not write", 3, error));
  } catch (const std::filesystem::filesystem_error& error) {
    throw meshes::CannotWrite(end("could not write", 3, error));
  } catch (const std::exception& error) {
    throw std::runtime_error(end("failed", 1, error));
  }
}

}  // namespace fingertip::studies::inline cli::inline command_line
