/// TOML files that describe the tables of machines: their keys, layouts and columns.
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

/// What is taken off a column's numbers before they count.
struct ColumnZero {
  enum class By { nothing, first_row, number, quantity, fit };
  By by = By::nothing;
  double value = 0.0;  ///< a number as it stands in the file, or a quantity [SI]

  bool operator==(const ColumnZero&) const = default;
};

/// A column of a file, as a description names it.
struct DescribedColumn {
  std::string quantity;  ///< its key: "position", "indentation", "force", "time", "sigma", "strain"
  std::string column;    ///< a name of the header, or "#3": the third
  std::string unit;      ///< "mm", or of counts "10 um"; empty: the file's own
  double scale = 1.0;    ///< units of a count, > 0
  double sign = 1.0;
  ColumnZero zero = {};

  bool operator==(const DescribedColumn&) const = default;
};

/// The keys column, unit, scale and sign of a table, and what else is in `further`, perhaps zero.
/// `si`: of the quantity, which has an `example`; "1" without dimension.
DescribedColumn described_column(const TestTable& table, const std::string& quantity,
                                 const std::string& si, const std::string& example,
                                 const std::set<std::string_view>& further = {});

/// What a number of a column is.
struct ColumnUnit {
  std::string unit;     ///< for people, "mm"
  double factor = 1.0;  ///< SI over the number, with scale and sign
};

/// By the title and what is described, which may be null, of a quantity in `si`. A unit that only
/// one of both names counts; two that differ are refused, unless the description has a factor of
/// its own: scale, or a number before the unit, "1 N". A mass is the force of its weight where one
/// of both says so (gf). None where neither names a unit, and what is wrong goes into `problems`:
/// another dimension, contradictions. `remedy`: how to name a unit.
std::optional<ColumnUnit> unit_of(const DescribedColumn* described, const TableTitle& title,
                                  const std::string& si, std::size_t line,
                                  const std::string& remedy, FileProblems& problems,
                                  std::vector<std::string>& notes);

/// What is to be taken off the numbers of a column, the first of which is `first`; 0 for `fit`.
double zero_in(const ColumnZero& zero, double first, const ColumnUnit& unit);

}  // namespace fingertip::studies::inline measurements
