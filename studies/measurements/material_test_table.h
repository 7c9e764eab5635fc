/// The tables of a file that describes material tests, and what its columns mean.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "calibration/material_tests/material_test.h"
#include "calibration/statistics/curve.h"
#include "studies/measurements/text_table.h"

namespace fingertip::studies::inline measurements {

/// One table of the file, with what it has in common with others; says where things stand. All
/// refusals are InvalidInput with file, line and key.
class TestTable {
 public:
  /// Keeps references.
  TestTable(const std::filesystem::path& file, const toml::table& own, std::string place,
            const toml::table* common = nullptr)
      : file_(file), own_(own), place_(std::move(place)), common_(common) {}

  [[noreturn]] void refuse(std::string_view key, const std::string& value, const std::string& rule,
                           const std::string& remedy) const;
  void check_keys(const std::set<std::string_view>& known) const;

  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Not in common with others.
  bool has_own(std::string_view key) const { return own_.get(key) != nullptr; }

  std::optional<std::string> text(std::string_view key) const;
  bool is_text(std::string_view key) const { return has(key) && find(key)->is_string(); }
  long whole(std::string_view key, long usual, long least, long most) const;
  bool flag(std::string_view key, bool usual) const;
  /// Its own keys.
  std::vector<std::string> keys() const;
  /// Finite.
  std::optional<double> number(std::string_view key) const;
  /// Positive, in the SI unit.
  std::optional<double> quantity(std::string_view key, const std::string& unit,
                                 const std::string& example) const;
  double number_of(std::string_view key, const std::string& written, const std::string& unit,
                   const std::string& example) const;
  /// Two numbers in order.
  std::optional<std::array<double, 2>> pair(std::string_view key) const;

  /// The choice of that name.
  template <typename Choice>
  Choice word(std::string_view key, const std::vector<std::pair<std::string_view, Choice>>& choices,
              std::optional<Choice> usual = std::nullopt) const {
    const auto written = text(key);
    if (!written && usual) return *usual;
    std::string names;
    for (const auto& [name, choice] : choices) {
      if (written == name) return choice;
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
    refuse(key, written.value_or(""), "must be one of " + names, "give one of them");
  }

  std::optional<TestTable> table(std::string_view key) const;
  /// Files, relative to the description; "$NAME/..." is below the folder that the environment
  /// variable NAME names.
  std::vector<std::filesystem::path> paths(std::string_view key) const;
  /// The name of the column in the header, or its number.
  std::string column() const;

 private:
  const toml::node* find(std::string_view key) const {
    const toml::node* node = own_.get(key);
    return node == nullptr && common_ != nullptr ? common_->get(key) : node;
  }
  std::filesystem::path located(std::string_view key, const std::string& written) const;

  const std::filesystem::path& file_;
  const toml::table& own_;
  std::string place_;
  const toml::table* common_;
};

/// Calls `take` with every [[name]] of a description, in which [data] has what they have in common:
/// the `shared` keys; each has name and path, too. `needs`: "path and kind".
void each_table(const std::filesystem::path& file, const toml::table& root, const std::string& name,
                const std::string& needs, const std::set<std::string_view>& shared,
                const std::function<void(const TestTable&)>& take);

/// The keys separator, decimal, skip and header of a table.
TableLayout layout_of(const TestTable& table);

/// The key sign: 1 or -1; 1 where there is none.
double sign_of(const TestTable& table);

/// `test` must have the table.
TestTable needed(const TestTable& test, std::string_view key, const char* example);

enum class StrainMeasure { stretch, engineering, logarithmic, displacement, shear, ratio, change };

/// What the numbers of a column mean, or one number that is held.
struct StrainColumn {
  std::string column;           ///< empty where a value is given
  std::optional<double> value;  ///< as it stands in the file
  StrainMeasure measure = StrainMeasure::stretch;
  double factor = 1.0, length = 1.0;

  double deformation(calibration::TestKind kind, double value) const;
};
/// `may_hold`: whether a value may stand in place of the column.
StrainColumn strain_column(const TestTable& test, calibration::TestKind kind,
                           std::optional<double> length, bool may_hold);

struct StressColumn {
  std::string column;
  calibration::StressMeasure measure = calibration::StressMeasure::nominal;
  double factor = 1.0;  ///< Pa over the file's unit, with the sign
};
StressColumn stress_column(const TestTable& test, std::optional<double> area);

/// Columns by name or number, "#3"; empty: none.
struct TestColumns {
  std::string strain, stress, sigma, time;
};

/// The rows of the file's table, which must be the only one; x is the strain, y the stress. Numbers
/// as they stand there, NaN for an empty cell. `notes` tell what was found and passed over. Throws
/// InvalidInput with file and line.
std::vector<calibration::CurveRow> described_rows(const FileText& text,
                                                  const std::filesystem::path& file,
                                                  TableLayout layout, const TestColumns& columns,
                                                  std::vector<std::string>& notes);

}  // namespace fingertip::studies::inline measurements
