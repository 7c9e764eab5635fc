/// A computation with files as its result, recognisable by its inputs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

namespace fingertip::studies {

/// What a job may use while it runs.
struct JobContext {
  /// Tells how far the job is (0 ... 1); false: stop, keep what is finished, throw Interrupted.
  std::function<bool(double fraction, const std::string& stage)> report;
  std::function<void(const std::string& line)> log;
  int threads = 1;
};

/// `inputs` holds only what the result depends on, so that equal inputs mean equal results.
struct Job {
  std::string kind;               ///< "press", "reference", "moduli", "cubes"
  nlohmann::ordered_json inputs;  ///< SI
  std::string source_hash;        ///< of the rooms whose code makes the result
  std::function<void(const std::filesystem::path& folder, const JobContext& context)> run;
  double weight = 1.0;  ///< expected share of the work, for the progress bar

  /// SHA-256 over kind, inputs and source hash.
  std::string key() const;
};

}  // namespace fingertip::studies
