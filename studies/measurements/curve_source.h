/// Where measured curves stand: plain CSV files, or files of any layout that a TOML file describes.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/measurements/description.h"

namespace fingertip::studies::inline measurements {

/// A file and what is known of it.
struct CurveSource {
  std::filesystem::path path = {};
  std::string name = {};  ///< of the curve; empty: the file's without extension
  TableLayout layout = {};
  std::vector<DescribedColumn> columns = {};  ///< none: the file names them itself
  std::optional<std::array<double, 2>> rows =
      {};                      ///< the first and last of a table that count, from 1
  std::size_t block = 0;       ///< the table of the file that counts, from 1; 0: each of them
  std::string condition = {};  ///< settings of the press, "press.contact=stick; ..."
  bool rigid = false;          ///< a blank in place of the finger, which tells the machine alone
  bool predicted = false;      ///< held back from the fit, which foretells it
  double sigma = 0.0;          ///< of every row [N], where no column tells it; 0: unknown

  bool operator==(const CurveSource&) const = default;
};

/// The files that an entry of calibration.data means: itself, or, where it is TOML,
///
///   [data]    what files have in common: any key of a press but `name` and `path`
///   [[press]] path (or a list of paths: repeats), name, condition, block (a number from 1),
///             separator ("comma", "semicolon", "tab", "whitespace"), decimal ("point", "comma"),
///             skip (lines), header (true, false), rows ([first, last]),
///             position or indentation, force = {column, unit, scale, sign, zero},
///             time, sigma = {column, unit, scale, sign}, or sigma = "0.01 N", of every row;
///             finger ("soft", "rigid": a blank in its place), use ("fit" or "predict")
///
/// Columns: DescribedColumn. Separator and decimals are found, units read from the file where they
/// are not said. Paths are relative to the TOML
/// file. Throws InvalidInput naming file, line, key, value, rule and remedy.
std::vector<CurveSource> curve_sources(const std::filesystem::path& entry);

}  // namespace fingertip::studies::inline measurements
