/// What the user typed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "studies/config/loader.h"
#include "studies/jobs/progress.h"

namespace fingertip::studies::inline cli::inline command_line {

struct CommandLine {
  std::string verb;
  std::vector<std::string> arguments;  ///< positional ones: cases, runs, a file, a key
  ConfigSource config;                 ///< --config, --set, --threads
  std::filesystem::path out;
  std::string folder_stem;  ///< where out is empty: runs/<stem>-<time>; empty: the verb
  bool force = false;
  bool resume = false;
  bool quiet = false;
  int ranks = 1;                     ///< MPI processes of reference
  int movie = 0;                     ///< pictures of press --movie, 0: none
  bool all = false;                  ///< validate --all
  bool real_time = false;            ///< press, live --real-time
  bool plan = false;                 ///< calibrate --plan
  int port = 0;                      ///< of live; 0: a free one
  std::filesystem::path reference;   ///< of live: run folder or response.csv
  bool running = false;              ///< live: at the start
  double rate = 1.0;                 ///< live: wanted real-time factor, 0: any
  std::optional<double> exit_after;  ///< live: wall time [s]
  std::filesystem::path stl;         ///< of shape: the surface goes to this file, too
  std::string format = "lammps";     ///< of export
  bool lossy = false;                ///< export --lossy
  bool quick = false;                ///< bench --quick
  std::filesystem::path json;        ///< of bench: where its document goes, too
  std::filesystem::path history;     ///< of bench: folder of the history; empty: in the cache
  int finest = 24;                   ///< of bench: no press on a lattice finer than R/finest
  std::string isa;                   ///< of bench: the widest to measure; empty: all there is
  std::string shard;                 ///< sweep --shard, "i/N"; empty: all
  bool collect = false;              ///< sweep --collect
  bool list = false;                 ///< sweep --list, init --list
  bool schema = false;               ///< explain --schema
  bool markdown = false;             ///< explain --markdown
  bool man = false;                  ///< explain --man
  bool completion = false;           ///< explain --completion
  ProgressStyle progress = ProgressStyle::off;
  std::vector<std::string> words;  ///< everything as typed, for the manifest
};

/// A verb as the parser knows it.
struct VerbWords {
  struct Option {
    std::string name, value, help;     ///< "--out", "DIR"; no value of a flag
    std::vector<std::string> choices;  ///< of the value; empty: any
  };
  std::string name, help, argument, argument_help;
  std::vector<Option> options;
};
std::vector<VerbWords> verb_words();

/// Either what to do or, after help, version or a refusal (already printed), the exit code.
std::variant<CommandLine, int> parse_command_line(int argc, char** argv);

}  // namespace fingertip::studies::inline cli::inline command_line
