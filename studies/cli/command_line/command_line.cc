#include "studies/cli/command_line/command_line.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <sstream>

#include "studies/config/keys/key_table.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline cli::inline command_line {

namespace {

/// Which options a verb takes.
enum Options : unsigned {
  config_options = 1U,  ///< --config, --set
  run_options = 2U,     ///< --threads, --progress, --resume
  out_options = 4U,     ///< --out, --force
  units_option = 8U,    ///< --set run.units=...
};

struct Verb {
  const char* name;
  const char* help;
  const char* argument;  ///< name of the positional arguments; empty for none
  const char* argument_help;
  unsigned options;
};

constexpr unsigned everything = config_options | run_options | out_options;

constexpr Verb verbs[] = {
    {"validate", "the whole path for a case: fit, press, continuum, judgement, report", "CASE",
     "cases to validate (default: 01_paper_rubber)", everything},
    {"press", "press the lattice", "", "", everything},
    {"live", "press the lattice in a web page: look, set, drag; on this machine only", "", "",
     config_options},
    {"web", "write the live view as a folder that a browser runs by itself", "", "", everything},
    {"modes", "natural frequencies of the lattice bonded to a fixed rod", "", "", everything},
    {"grasp", "let two fingers grasp and lift a rigid block", "", "", everything},
    {"reference", "press the continuum (finite elements)", "", "", everything},
    {"calibrate", "fit the spring constants of lattice.model to the rubber", "", "", everything},
    {"compare", "compare force curves with the continuum's or the first one's", "RUN",
     "run folders", out_options | units_option},
    {"report", "write report.html anew", "RUN", "run folders", units_option},
    {"limit-surface", "tell the force and the moment that a contact holds by friction", "RUN",
     "run folders of press and reference", units_option},
    {"sweep", "run a verb for all combinations of values, whole or in shards", "VERB",
     "press (default), modes, reference or grasp", everything},
    {"export", "write the finger for other programs", "", "", everything},
    {"check", "check a configuration file, or settings", "FILE", "the file", config_options},
    {"shape", "check the shape of a finger, tell its measures, draw its section", "FILE",
     "meridians (.csv: r [mm],z [mm],surface,curve), solids (.stl, .step, .brep; --set "
     "geometry.bond=...); default: the one of --config",
     config_options | out_options},
    {"explain", "explain a configuration key, or list all", "KEY", "section.key", 0U},
    {"init", "write a configuration: a ready start, or one with every key, commented", "FILE",
     "a start's name (--list), or the file of all keys (default: standard output)", out_options},
    {"bench", "measure speed: kernels, presses against the clock, peers", "", "",
     run_options | out_options},
    {"doctor", "tell versions, programs, folders and cores", "", "", 0U},
};

constexpr int max_ranks = 1024;
constexpr int max_pictures = 2000;

constexpr const char* footer =
    "`./fingertip test` runs the tests; it belongs to the launcher script beside README.md.\n"
    "Exit codes: 0 done, 1 internal error, 2 bad input, 3 not converged, 4 a criterion failed,\n"
    "130 interrupted.";

void add_config(CLI::App& app, CommandLine& line) {
  app.add_option("--config", line.config.file, "TOML file (fingertip init writes one)")
      ->type_name("FILE");
  app.add_option("--set", line.config.sets,
                 "one key, e.g. --set press.depth=\"0.2 cm\"; repeatable")
      ->type_name("section.key=value")
      ->allow_extra_args(false);
}

void add_units(CLI::App& app, CommandLine& line) {
  app.add_option("--set", line.config.sets,
                 "run.units=si or run.units=paper; a page takes no other key")
      ->type_name("run.units=value")
      ->allow_extra_args(false);
}

void add_run(CLI::App& app, CommandLine& line, std::string& progress, std::string& resume) {
  app.add_option("--threads", line.config.threads, "threads to use; 0: what is fastest")
      ->type_name("N");
  app.add_option(
         "--progress", progress,
         "how to show progress on stderr: a bar, a line now and then (without a terminal), JSON")
      ->check(CLI::IsMember({"tty", "lines", "json", "off"}));
  app.add_option("--resume", resume,
                 "auto: keep what is finished in an existing --out and compute the rest")
      ->check(CLI::IsMember({"auto"}));
}

void add_live(CLI::App& sub, CommandLine& line) {
  sub.add_option("--threads", line.config.threads, "threads to use; 0: what is fastest")
      ->type_name("N");
  sub.add_option("--port", line.port, "port on 127.0.0.1; 0 (default): a free one")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  sub.add_option("--reference", line.reference,
                 "run whose force curve, and fields where it has them, are drawn beside it")
      ->type_name("RUN")
      ->check(CLI::ExistingPath);
  sub.add_flag("--running,!--paused", line.running, "start at once; --paused, the default, waits");
  sub.add_option("--rate", line.rate,
                 "wanted real-time factor, 0.01 to 1 (default); 0: as fast as it can")
      ->type_name("X")
      ->check(CLI::Range(0.0, 1.0));
  sub.add_option("--exit-after", line.exit_after, "end after so many seconds")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
}

void add_sweep(CLI::App& sub, CommandLine& line) {
  sub.add_option("--shard", line.shard, "compute the i-th of N parts only")->type_name("i/N");
  sub.add_flag("--collect", line.collect, "write the table of what shards have computed in --out");
  sub.add_flag("--list", line.list, "tell the points instead of computing them");
}

void add_export(CLI::App& sub, CommandLine& line) {
  sub.add_option("--format", line.format,
                 "lammps: an undamped lattice ([exchange]); fitted to the continuum, pressure-law: "
                 "pressure over penetration, newton: the same as its hydroelastic contact takes "
                 "it, mujoco: a "
                 "rigid geom and a flex, drake: a hydroelastic ball, sofa, vtk: a soft body of "
                 "tetrahedra, all: each of them and a table of their errors, "
                 "fmu: "
                 "the lattice as a functional mock-up unit")
      ->check(CLI::IsMember(
          {"lammps", "pressure-law", "newton", "mujoco", "drake", "sofa", "vtk", "all", "fmu"}))
      ->capture_default_str();
  sub.add_flag("--lossy", line.lossy, "go on where the format cannot say all of the model");
}

void add_shape(CLI::App& sub, CommandLine& line) {
  sub.add_option("--stl", line.stl, "write the surface as triangles, too: STL, in mm")
      ->type_name("FILE");
}

void add_bench(CLI::App& sub, CommandLine& line) {
  sub.add_option("--json", line.json, "write what was measured to this file, too")
      ->type_name("FILE");
  sub.add_flag("--quick", line.quick, "coarse lattices, few repeats: below three minutes");
  sub.add_option("--history", line.history,
                 "folder of history.jsonl, which gets a line (default: in the cache)")
      ->type_name("DIR");
  sub.add_option("--finest", line.finest, "press no lattice finer than R/N; default 24")
      ->type_name("N")
      ->check(CLI::Range(6, 24));
  sub.add_option("--isa", line.isa, "measure kernels no wider than this one's")
      ->check(CLI::IsMember({"sse2", "avx2", "avx512"}));
}

void add_verb(CLI::App& app, const Verb& verb, CommandLine& line, std::string& progress,
              std::string& resume) {
  CLI::App& sub = *app.add_subcommand(verb.name, verb.help);
  const std::string name = verb.name;
  if (*verb.argument != '\0') sub.add_option(verb.argument, line.arguments, verb.argument_help);
  if ((verb.options & config_options) != 0U) add_config(sub, line);
  if ((verb.options & units_option) != 0U) add_units(sub, line);
  if ((verb.options & run_options) != 0U) add_run(sub, line, progress, resume);
  if ((verb.options & out_options) != 0U) {
    sub.add_option("--out", line.out, name == "init" ? "file to write" : "folder to write")
        ->type_name(name == "init" ? "FILE" : "DIR");
    sub.add_flag("--force", line.force, "replace what exists");
  }
  if (name == "reference") {
    sub.add_option("--ranks", line.ranks, "MPI processes to share the work (mpirun); default 1")
        ->type_name("N")
        ->check(CLI::Range(1, max_ranks));
  }
  if (name == "press" || name == "live")
    sub.add_flag("--real-time", line.real_time,
                 "choose spacing and step so that this machine keeps up, and tell the force error");
  if (name == "press") {
    sub.add_option("--movie", line.movie,
                   "pictures for ParaView in movie/, evenly spaced in time; 40 without a number")
        ->type_name("N")
        ->expected(0, 1)
        ->default_str("40")
        ->check(CLI::Range(2, max_pictures));
  }
  if (name == "live") add_live(sub, line);
  if (name == "sweep") add_sweep(sub, line);
  if (name == "init")
    sub.add_flag("--list", line.list, "tell the ready starts that init NAME writes");
  if (name == "shape") add_shape(sub, line);
  if (name == "export") add_export(sub, line);
  if (name == "bench") add_bench(sub, line);
  if (name == "calibrate")
    sub.add_flag("--plan", line.plan,
                 "tell what presses would tell before they are made; no measured file is read");
  if (name == "validate") sub.add_flag("--all", line.all, "every case in studies/cases");
  if (name == "explain") {
    sub.add_flag("--schema", line.schema, "JSON Schema of configuration files");
    sub.add_flag("--markdown", line.markdown, "reference page of all keys");
    sub.add_flag("--man", line.man, "manual page: fingertip explain --man | man -l -");
    sub.add_flag("--completion", line.completion, "completion of commands, for bash to source");
  }
  sub.add_flag("--quiet", line.quiet, "print errors only");
  sub.callback([&line, name] { line.verb = name; });
}

bool is_verb(const std::string& word) {
  return word == "test" ||
         std::ranges::any_of(verbs, [&](const Verb& v) { return word == v.name; });
}

/// The nearest verb to a mistyped one, or nothing when the first word is one.
std::optional<std::string> misspelt_verb(const std::vector<std::string>& words) {
  if (words.empty() || words.front().starts_with('-') || is_verb(words.front())) return {};
  std::vector<std::string> names = {"test"};
  for (const Verb& verb : verbs) names.emplace_back(verb.name);
  return nearest_word(words.front(), names);
}

/// Whether some verb has an option of that name that takes a value behind a blank.
bool takes_value(const CLI::App& app, const std::string& word) {
  return std::ranges::any_of(app.get_subcommands({}), [&](const CLI::App* sub) {
    const CLI::Option* option = sub->get_option_no_throw(word);
    return option != nullptr && option->get_items_expected_min() > 0;
  });
}

/// Options may stand before the verb, too: it goes to the front, where the parser wants it.
std::vector<std::string> verb_first(const CLI::App& app, std::vector<std::string> words) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (word->starts_with('-')) {
      if (takes_value(app, *word) && std::next(word) != words.end()) ++word;
      continue;
    }
    if (is_verb(*word)) std::rotate(words.begin(), word, std::next(word));
    break;
  }
  return words;
}

ProgressStyle style(const std::string& word, bool quiet) {
  if (word == "json") return ProgressStyle::json;
  if (word == "tty") return ProgressStyle::tty;
  if (word == "lines") return ProgressStyle::lines;
  if (word == "off" || quiet) return ProgressStyle::off;
  return ::isatty(STDERR_FILENO) == 1 ? ProgressStyle::tty : ProgressStyle::lines;
}

/// The words of "TEXT:{a,b}".
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> found;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == type.npos || end == type.npos) return found;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(list, word, ',');) found.push_back(word);
  return found;
}

}  // namespace

std::vector<VerbWords> verb_words() {
  CommandLine line;
  std::string progress, resume;
  CLI::App app;
  std::vector<VerbWords> all;
  for (const Verb& verb : verbs) {
    add_verb(app, verb, line, progress, resume);
    VerbWords words{verb.name, verb.help, verb.argument, verb.argument_help, {}};
    for (const CLI::Option* option : app.get_subcommand(verb.name)->get_options()) {
      if (option->get_lnames().empty()) continue;
      const std::string type = option->get_type_name();
      const std::vector<std::string> choices = choices_of(type);
      std::string value =
          option->get_items_expected_max() == 0 ? "" : type.substr(0, type.find(':'));
      if (!choices.empty()) value = "WORD";
      words.options.push_back(
          {"--" + option->get_lnames().front(), value, option->get_description(), choices});
    }
    all.push_back(std::move(words));
  }
  return all;
}

std::variant<CommandLine, int> parse_command_line(int argc, char** argv) {
  CommandLine line;
  line.words.assign(argv, argv + argc);
  std::string progress;
  std::string resume;
  CLI::App app("Mass-spring lattice of a soft fingertip against its continuum.", "fingertip");
  for (const Verb& verb : verbs) add_verb(app, verb, line, progress, resume);
  std::vector<std::string> words =
      verb_first(app, {line.words.begin() + (argc > 0 ? 1 : 0), line.words.end()});
  if (const auto nearest = misspelt_verb(words)) {
    fmt::print(stderr,
               "fingertip: error: {}: there is no such verb; the nearest one is {} "
               "(fingertip --help lists them)\n",
               words.front(), *nearest);
    return 2;
  }
  if (!words.empty() && words.front() == "test") {
    fmt::print(stderr,
               "fingertip: error: test: belongs to the launcher script; run ./fingertip "
               "test in the source folder\n");
    return 2;
  }
  app.set_version_flag("--version", "fingertip " + program_version());
  app.require_subcommand(1);
  app.footer(footer);
  const std::string verb = words.empty() ? "" : words.front() + " ";
  std::ranges::reverse(words);  // as the parser wants them
  try {
    app.parse(words);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // help or version: prints to stdout, 0
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "fingertip: error: {}; see fingertip {}--help\n", error.what(), verb);
    return 2;
  }
  line.resume = !resume.empty();
  line.progress = style(progress, line.quiet);
  return line;
}

}  // namespace fingertip::studies::inline cli::inline command_line
