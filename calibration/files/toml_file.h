/// Files of TOML that this project writes and reads back strictly.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace fingertip::calibration::inline files {

/// A double-quoted TOML string.
std::string toml_text(std::string_view text);

/// The file as TOML. `again` is what to do about a damaged one. Throws InvalidInput naming file and
/// line for what cannot be read or parsed.
toml::table parsed_toml(const std::filesystem::path& file, const std::string& again);

/// A file of sections; every refusal is an InvalidInput that names file, line and key.
class TomlFile {
 public:
  TomlFile(std::filesystem::path file, std::string again);

 protected:
  const toml::table& table() const { return table_; }
  const std::filesystem::path& file() const { return file_; }

  [[noreturn]] void fail(int line, const std::string& key, const std::string& value,
                         const std::string& rule, const std::string& remedy) const;

  static std::string dotted(std::string_view section, std::string_view key) {
    return std::string(section) + "." + std::string(key);
  }
  const toml::node* find(std::string_view section, std::string_view key) const;
  const toml::node& node(std::string_view section, std::string_view key) const;
  /// Of the key, else the last one.
  int line(std::string_view section, std::string_view key) const;

  std::string text(std::string_view section, std::string_view key) const;
  /// A number without quotes.
  double bare_number(std::string_view section, std::string_view key) const;
  /// "1.5 Pa"
  double number(std::string_view section, std::string_view key, std::string_view unit) const;
  /// The same, of a text that stands there.
  double number_in(const std::string& written, std::string_view unit, std::string_view section,
                   std::string_view key) const;

  /// The choice whose name is written.
  template <typename Choice, std::size_t n>
  Choice chosen(const std::string& written, std::string_view section, std::string_view key,
                const std::array<Choice, n>& choices) const {
    std::string names;
    for (const Choice choice : choices) {
      if (written == name(choice)) return choice;
      names += (names.empty() ? "" : ", ") + std::string(name(choice));
    }
    fail(line(section, key), dotted(section, key), written, "must be one of " + names,
         "give one of them");
  }
  template <typename Choice, std::size_t n>
  Choice word(std::string_view section, std::string_view key,
              const std::array<Choice, n>& choices) const {
    return chosen(text(section, key), section, key, choices);
  }

 private:
  std::filesystem::path file_;
  std::string again_;
  toml::table table_;
};

/// Writes what tells of a material, atomically; throws InvalidInput where a text in it is not
/// UTF-8. Why its fit was not accepted: where that is not empty, the first line says so.
void write_toml(const std::string& text, const std::string& rejected,
                const std::filesystem::path& file);

}  // namespace fingertip::calibration::inline files
