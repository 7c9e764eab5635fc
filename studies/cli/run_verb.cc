#include "studies/cli/run_verb.h"

#include <fmt/format.h>

#include <thread>

#include "meshes/errors.h"
#include "studies/run/interrupt.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

int cores_for(const LoadedConfig& loaded) {
  const int wanted = loaded.config.press.threads;
  return wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency()));
}

}  // namespace

LoadedConfig load_checked(const CommandLine& line) {
  LoadedConfig loaded = load_config(line.config);
  check_all(loaded);
  return loaded;
}

int run_in_folder(const CommandLine& line, const LoadedConfig& loaded, const std::string& case_text,
                  const std::function<int(Session&)>& body) {
  watch_for_interrupts();
  RunFolder folder({line.verb, line.out, line.force, line.resume, line.words}, loaded, case_text);
  if (!line.quiet) {
    for (const std::string& note : loaded.notes) fmt::print(stderr, "fingertip: note: {}\n", note);
  }
  Progress progress(line.progress);
  Session session(folder, progress, Cache(Cache::default_folder()), cores_for(loaded));
  const auto end = [&](const std::string& status, int code, const std::string& why) {
    progress.clear();
    folder.finish(status, code, {{"error", why}});
  };
  try {
    const int code = body(session);
    folder.finish(code == 0 ? "finished" : "criteria failed", code);
    return code;
  } catch (const meshes::NotConverged& error) {
    end("not converged", 3, error.what());
    throw;
  } catch (const meshes::Interrupted& error) {
    end("interrupted", 130, error.what());
    throw;
  } catch (const meshes::InvalidInput& error) {
    if (folder.resumed()) {
      end("bad input", 2, error.what());
    } else {
      progress.clear();
      folder.discard();
    }
    throw loaded.locate(error.violations());
  } catch (const std::exception& error) {
    end("failed", 1, error.what());
    throw;
  }
}

}  // namespace fingertip::studies
