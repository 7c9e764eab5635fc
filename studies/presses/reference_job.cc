#include "studies/presses/reference_job.h"

#include <unistd.h>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "source_hash.h"
#include "studies/files/json_entry.h"
#include "studies/files/places.h"
#include "studies/files/process.h"
#include "studies/jobs/fem_launch.h"
#include "studies/jobs/fem_process.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/press_record.h"

namespace fingertip::studies::inline presses {

namespace {

using meshes::json_of;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Neither mass nor damping enters an equilibrium, nor time unless the rubber relaxes; no press
/// enters the natural frequencies, which are those of the moduli after long times.
ordered_json inputs_of(const fem_reference::ReferenceJob& reference) {
  using fem_reference::Analysis;
  ordered_json inputs = json_of(reference);
  inputs["protocol"] = studies::inputs_of(reference.protocol, reference.in_time());
  drop(inputs["protocol"], {"mode"});
  // A program's rises, and with them its falls, are shorter than the clearance.
  if (reference.protocol.program.empty()) drop(inputs["protocol"], {"clearance"});
  if (reference.strain != fem_reference::Strain::finite || reference.analysis == Analysis::modes)
    drop(inputs["rubber"], {"energy"});
  if (reference.analysis != Analysis::modes) drop(inputs, {"modes"});
  if (!reference.axisymmetric() || !reference.write_fields) drop(inputs, {"field_sectors"});
  if (reference.analysis == Analysis::static_press)
    drop(inputs["rubber"], {"density", "retardation_time"});
  if (reference.analysis == Analysis::modes)
    drop(inputs["rubber"], {"retardation_time", "relaxation"});
  if (reference.analysis == Analysis::modes || reference.analysis == Analysis::verification)
    drop(inputs, {"protocol"});
  return inputs;
}

/// Gone with its content when the object is.
struct ScratchFolder {
  ScratchFolder()
      : path(fs::temp_directory_path() / ("fingertip-cost-" + std::to_string(::getpid()))) {
    fs::create_directories(path);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  fs::path path;
};

}  // namespace

Job reference_job(const fem_reference::ReferenceJob& reference) {
  Job job;
  job.kind = "reference";
  job.inputs = inputs_of(reference);
  job.source_hash = source_hash::reference;
  job.weight = reference.axisymmetric() ? meridian_weight : reference_weight;
  job.resumable = true;
  job.run = [reference](const fs::path& folder, const JobContext& context) {
    fem_reference::write_job(reference, folder / "job.json");
    JobContext own = context;
    if (reference.axisymmetric() && own.ranks > 1)
      own.log("a meridian is solved on one process: --ranks is not used");
    // Threads would wait for each other longer than its small fronts take.
    if (reference.axisymmetric()) own.ranks = own.threads = 1;
    run_fem_process(built_reference_program(interrupted), folder, own);
    fs::remove_all(folder / "checkpoint");  // of use to an unfinished job alone
  };
  return job;
}

ReferenceCost expected_cost(const fem_reference::ReferenceJob& reference,
                            const std::function<bool()>& stop) {
  const ScratchFolder scratch;
  fem_reference::write_job(reference, scratch.path / "job.json");
  Command command = fem_command(reference_program(), scratch.path, 1, 1);
  command.words.insert(command.words.end() - 1, "--cost");
  const int code = run_process(command, scratch.path / "words", stop);
  const std::string words = meshes::read_text(scratch.path / "words");
  // MPI may speak before and after.
  const std::size_t begin = words.find("{\""), end = words.find('}', begin);
  if (code != 0 || begin == words.npos || end == words.npos)
    throw meshes::NotConverged(words.substr(0, words.find_last_not_of('\n') + 1));
  const auto cost = ordered_json::parse(words.substr(begin, end + 1 - begin));
  return {number_of(cost["unknowns"]), number_of(cost["time"]), number_of(cost["memory"])};
}

Job verification_job() {
  fem_reference::ReferenceJob reference;
  reference.analysis = fem_reference::Analysis::verification;
  Job job = reference_job(reference);
  job.kind = "verification";
  return job;
}

}  // namespace fingertip::studies::inline presses
