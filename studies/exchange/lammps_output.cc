#include "studies/exchange/lammps_output.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "meshes/base/errors.h"

namespace fingertip::studies {

namespace {

constexpr std::array<std::string_view, 7> wanted = {"id", "x", "y", "z", "vx", "vy", "vz"};

/// Finite numbers of a row by column; false when there are fewer than columns.
bool numbers_of(std::string_view row, std::size_t count, std::vector<double>& values) {
  values.clear();
  const char* at = row.data();
  const char* const end = at + row.size();
  while (values.size() < count) {
    while (at != end && *at == ' ') ++at;
    double value = 0.0;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc()) return false;
    if (!std::isfinite(value)) return false;
    values.push_back(value);
    at = read.ptr;
  }
  return true;
}

/// Whether all of `line` but blanks around it is one number, then in `value`.
template <typename Integer>
bool whole_number(std::string_view line, Integer& value) {
  constexpr const char* blank = " \t\r";
  const auto first = line.find_first_not_of(blank);
  if (first == line.npos) return false;
  line = line.substr(first, line.find_last_not_of(blank) - first + 1);
  const char* const end = line.data() + line.size();
  const auto read = std::from_chars(line.data(), end, value);
  return read.ec == std::errc() && read.ptr == end;
}

}  // namespace

LammpsTiming read_lammps_log(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw meshes::InvalidInput({file.string(), "", "the log of LAMMPS cannot be read",
                                "run lmp -in lattice.in in this folder first"});
  }
  LammpsTiming timing;
  bool found = false;
  std::string error, version;
  double percent = 100.0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("ERROR")) error = line;
    if (line.starts_with("LAMMPS (")) version = line.substr(8, line.rfind(')') - 8);
    LammpsTiming loop;
    if (std::sscanf(line.c_str(), "Loop time of %lf on %d procs for %ld steps with %zu atoms",
                    &loop.loop_time, &loop.ranks, &loop.steps, &loop.atoms) == 4) {
      timing = loop;
      found = true;
    }
    if (found && std::sscanf(line.c_str(), "%lf%% CPU use", &percent) == 1)
      timing.processor_share = std::min(1.0, 0.01 * percent);
  }
  timing.version = version;
  const bool sound = std::isfinite(timing.loop_time) && timing.loop_time >= 0.0 &&
                     timing.ranks >= 1 && timing.steps >= 0 && timing.processor_share >= 0.0;
  if (found && error.empty() && !sound) {
    throw meshes::InvalidInput(
        {file.string(), "", "the log's times or numbers make no sense", "run LAMMPS again"});
  }
  if (!found || !error.empty()) {
    throw meshes::InvalidInput({file.string(), error, "LAMMPS did not come to the end of its run",
                                "let it run to its end, or see the log for the reason"});
  }
  return timing;
}

LammpsDump::LammpsDump(const std::filesystem::path& file, std::size_t masses)
    : file_(file), in_(file), masses_(masses) {
  if (!in_) refuse("the dump of LAMMPS cannot be read");
}

void LammpsDump::refuse(const std::string& rule) const {
  throw meshes::InvalidInput(
      {file_.string(), line_.substr(0, 60), rule,
       "run lmp -in lattice.in in the folder that fingertip export wrote, unchanged"});
}

bool LammpsDump::line() {
  return bool(std::getline(in_, line_));
}

void LammpsDump::read_columns() {
  std::istringstream words(line_.substr(std::string_view("ITEM: ATOMS").size()));
  columns_.clear();
  for (std::string word; words >> word;) {
    const auto* place = std::ranges::find(wanted, word);
    columns_.push_back(place == wanted.end() ? -1 : int(place - wanted.begin()));
  }
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    if (std::ranges::find(columns_, int(w)) == columns_.end()) {
      refuse("the dump must have the columns id x y z vx vy vz");
    }
  }
}

bool LammpsDump::read_head(LammpsFrame& frame) {
  std::size_t atoms = 0;
  while (line()) {
    if (line_.starts_with("ITEM: TIMESTEP")) {
      if (!line()) return false;
      if (!whole_number(line_, frame.step) || frame.step <= last_step_)
        refuse("steps must be numbers that increase from frame to frame");
    } else if (line_.starts_with("ITEM: NUMBER OF ATOMS")) {
      if (!line()) return false;
      if (!whole_number(line_, atoms)) refuse("this is no number of atoms");
    } else if (line_.starts_with("ITEM: ATOMS")) {
      if (atoms != masses_) {
        refuse("the dump has " + std::to_string(atoms) + " atoms, the lattice " +
               std::to_string(masses_) + " masses");
      }
      read_columns();
      return true;
    } else if (line_.starts_with("ITEM: BOX")) {
      for (int axis = 0; axis < 3; ++axis) line();
    } else if (!line_.starts_with("ITEM: UNITS") && !line_.starts_with("ITEM: TIME")) {
      refuse("this is no dump of LAMMPS");
    }
  }
  return false;
}

bool LammpsDump::read_rows(LammpsFrame& frame) {
  frame.position.assign(masses_, meshes::Vector3::Zero());
  frame.velocity = frame.position;
  std::vector<double> values;
  std::vector<bool> seen(masses_, false);
  for (std::size_t row = 0; row < masses_; ++row) {
    // A row without its line end may lack digits.
    if (!line() || in_.eof()) return false;
    if (!numbers_of(line_, columns_.size(), values)) refuse("a row lacks finite numbers");
    std::array<double, wanted.size()> of{};
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c] >= 0) of[std::size_t(columns_[c])] = values[c];
    }
    const bool known = of[0] >= 1.0 && of[0] <= double(masses_) && std::floor(of[0]) == of[0];
    const auto id = known ? std::size_t(of[0]) : 0;
    if (!known || seen[id - 1]) refuse("every mass must occur once in a frame");
    seen[id - 1] = true;
    frame.position[id - 1] = {of[1], of[2], of[3]};
    frame.velocity[id - 1] = {of[4], of[5], of[6]};
  }
  return true;
}

std::optional<LammpsFrame> LammpsDump::next() {
  if (in_.peek() == std::ifstream::traits_type::eof()) return {};
  LammpsFrame frame;
  if (read_head(frame) && read_rows(frame)) {
    last_step_ = frame.step;
    return frame;
  }
  broke_off_ = true;
  return {};
}

}  // namespace fingertip::studies
