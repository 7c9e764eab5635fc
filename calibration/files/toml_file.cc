#include "calibration/files/toml_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <ostream>
#include <sstream>
#include <utility>

#include "calibration/files/toml_depth.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline files {

using meshes::InvalidInput;

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      constexpr std::string_view digits = "0123456789abcdef";
      out += std::string("\\u00") + digits[std::size_t(c) / 16] + digits[std::size_t(c) % 16];
    } else {
      out += c;
    }
  }
  return out + '"';
}

toml::table parsed_toml(const std::filesystem::path& file, const std::string& again) {
  const auto refuse = [&](int line, const std::string& rule, const std::string& remedy) {
    throw InvalidInput(
        {"", "", rule, remedy, file.string() + (line > 0 ? ":" + std::to_string(line) : "")});
  };
  const std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  // Copying nothing sets the fail bit, so this refuses empty files and folders, too.
  if (!in.is_open() || !(content << in.rdbuf()))
    refuse(0, "the file cannot be read or is empty", "check path and rights, or " + again);
  const std::string text = content.str();
  if (nests_too_deep(text)) refuse(0, "a key has hundreds of dotted parts", again);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    refuse(int(error.source().begin.line), "not valid TOML: " + std::string(error.description()),
           "mend the line, or " + again);
  }
  return {};
}

TomlFile::TomlFile(std::filesystem::path file, std::string again)
    : file_(std::move(file)), again_(std::move(again)), table_(parsed_toml(file_, again_)) {}

void TomlFile::fail(int line, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy) const {
  throw InvalidInput({key, value, rule, remedy, file_.string() + ":" + std::to_string(line)});
}

const toml::node* TomlFile::find(std::string_view section, std::string_view key) const {
  return table_.at_path(dotted(section, key)).node();
}

const toml::node& TomlFile::node(std::string_view section, std::string_view key) const {
  const toml::node* found = find(section, key);
  if (found == nullptr)
    fail(line(section, key), dotted(section, key), "",
         "the key is missing; the file may be truncated", again_);
  return *found;
}

int TomlFile::line(std::string_view section, std::string_view key) const {
  const toml::node* found = find(section, key);
  return int(found != nullptr ? found->source().begin.line : table_.source().end.line);
}

std::string TomlFile::text(std::string_view section, std::string_view key) const {
  const std::optional<std::string> value = node(section, key).value_exact<std::string>();
  if (!value)
    fail(line(section, key), dotted(section, key), "", "the value must be a string",
         "put it in quotes, a quantity with its unit");
  return *value;
}

double TomlFile::bare_number(std::string_view section, std::string_view key) const {
  const std::optional<double> value = node(section, key).value<double>();
  if (!value || !std::isfinite(*value))
    fail(line(section, key), dotted(section, key), "", "must be a finite number without quotes",
         "write for instance 1.5");
  return *value;
}

double TomlFile::number(std::string_view section, std::string_view key,
                        std::string_view unit) const {
  return number_in(text(section, key), unit, section, key);
}

double TomlFile::number_in(const std::string& written, std::string_view unit,
                           std::string_view section, std::string_view key) const {
  double value = 0.0;
  const char* end = written.data() + written.size();
  const auto parsed = std::from_chars(written.data(), end, value);
  const std::string rest(parsed.ptr, end);
  if (parsed.ec != std::errc() || !std::isfinite(value) || rest != " " + std::string(unit))
    fail(line(section, key), dotted(section, key), written,
         "must be a finite number and the unit " + std::string(unit),
         "write for instance \"1.5 " + std::string(unit) + "\"");
  return value;
}

void write_toml(const std::string& text, const std::string& rejected,
                const std::filesystem::path& file) {
  try {
    static_cast<void>(toml::parse(text));
  } catch (const toml::parse_error& error) {
    throw meshes::InvalidInput(
        {"about", "", "the texts on a material must be UTF-8: " + std::string(error.description()),
         "rename the files it names"});
  }
  meshes::write_atomically(file, [&](std::ostream& out) {
    if (!rejected.empty()) out << "# NOT ACCEPTED: the fit failed its own tests, see rejected.\n";
    out << text;
  });
}

}  // namespace fingertip::calibration::inline files
