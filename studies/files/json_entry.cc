#include "studies/files/json_entry.h"

#include <algorithm>
#include <cmath>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/csv_table.h"

namespace fingertip::studies::inline files {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* run_again = "the file is truncated or damaged: run again what writes it";

/// Takes every value; remembers where a text stops being JSON.
class FaultFinder : public nlohmann::json_sax<json> {
 public:
  std::size_t position = 0;
  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*elements*/) override { return true; }
  bool key(string_t& /*value*/) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t /*elements*/) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t at, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    position = at;
    return false;
  }
};

/// "file:line:column" of the character at which `text` stops being JSON.
std::string fault_place(const fs::path& file, const std::string& text) {
  FaultFinder finder;
  json::sax_parse(text, &finder);
  const std::size_t at = std::min(text.size(), finder.position > 0 ? finder.position - 1 : 0);
  const auto start = text.begin(), here = start + std::ptrdiff_t(at);
  const auto line = 1 + std::count(start, here, '\n');
  const std::size_t before = at == 0 ? text.npos : text.rfind('\n', at - 1);
  const std::size_t column = at - (before == text.npos ? 0 : before + 1) + 1;
  return file.string() + ":" + std::to_string(line) + ":" + std::to_string(column);
}

template <typename Json>
Json parse(const fs::path& file) {
  const std::string text = meshes::read_text(file);
  if (text.empty()) throw meshes::InvalidInput({file.string(), "", "the file is empty", run_again});
  Json content = Json::parse(text, nullptr, false);
  if (content.is_discarded()) {
    throw meshes::InvalidInput(
        {fault_place(file, text), "", "from here on it is no JSON", run_again});
  }
  if (!content.is_object())
    throw meshes::InvalidInput({file.string(), "", "must hold a JSON object", run_again});
  return content;
}

}  // namespace

nlohmann::ordered_json parse_json(const fs::path& file) {
  return parse<nlohmann::ordered_json>(file);
}

double number_of(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>() : meshes::unknown;
}

JsonEntry read_entry(const fs::path& file) {
  return {parse<json>(file), file};
}

JsonEntry::JsonEntry(json content, const fs::path& file)
    : document_(std::make_shared<const Document>(Document{std::move(content), file})),
      value_(&document_->content) {}

JsonEntry::JsonEntry(std::shared_ptr<const Document> document, const json& value, std::string path)
    : document_(std::move(document)), value_(&value), path_(std::move(path)) {}

void JsonEntry::refuse(const std::string& rule) const {
  constexpr std::size_t enough = 40;
  std::string value = value_->dump();
  if (value.size() > enough) value = value.substr(0, enough) + "...";
  const std::string file = document_->file.string();
  throw meshes::InvalidInput({path_.empty() ? file : file + ", " + path_, value, rule, run_again});
}

bool JsonEntry::contains(const std::string& key) const {
  const auto found = value_->is_object() ? value_->find(key) : value_->end();
  return found != value_->end() && !found->is_null();
}

JsonEntry JsonEntry::at(const std::string& key) const {
  static const json nothing;
  if (!value_->is_object() && !value_->is_null()) refuse("must be an object");
  const std::string path = path_.empty() ? key : path_ + "." + key;
  const auto found = value_->find(key);
  const bool there = found != value_->end();
  JsonEntry entry(document_, there ? *found : nothing, path);
  entry.there_ = there;
  return entry;
}

JsonEntry JsonEntry::need(const std::string& key) const {
  JsonEntry entry = at(key);
  if (!entry.there_)
    throw meshes::InvalidInput({document_->file.string() + ", " + entry.path_, "", "is missing",
                                "run again what writes the file"});
  return entry;
}

std::vector<std::pair<std::string, JsonEntry>> JsonEntry::members() const {
  if (!value_->is_object() && !value_->is_null()) refuse("must be an object");
  std::vector<std::pair<std::string, JsonEntry>> all;
  for (const auto& [key, value] : value_->items()) all.emplace_back(key, at(key));
  return all;
}

JsonList JsonEntry::elements() const {
  if (!value_->is_array() && !value_->is_null()) refuse("must be a list");
  JsonList all;
  for (const json& value : *value_) {
    all.push_back(JsonEntry(document_, value, path_ + "[" + std::to_string(all.size()) + "]"));
  }
  return all;
}

double JsonEntry::number() const {
  if (value_->is_null()) return meshes::unknown;
  if (!value_->is_number()) refuse("must be a number");
  const double value = value_->get<double>();
  if (!(std::abs(value) <= meshes::largest_plausible)) refuse("must be a number of sensible size");
  return value;
}

long long JsonEntry::whole_number() const {
  const double value = number();
  if (!(value == std::floor(value) && std::abs(value) < 1e15)) refuse("must be a whole number");
  return static_cast<long long>(value);
}

std::vector<double> JsonEntry::numbers() const {
  std::vector<double> values;
  for (const JsonEntry& element : elements()) values.push_back(element.number());
  return values;
}

std::string JsonEntry::text() const {
  if (value_->is_null()) return "";
  if (value_->is_structured()) refuse("must be a text");
  return value_->is_string() ? value_->get<std::string>() : value_->dump();
}

bool JsonEntry::flag() const {
  if (value_->is_null()) return false;
  if (!value_->is_boolean()) refuse("must be true or false");
  return value_->get<bool>();
}

JsonEntry JsonEntry::object() const {
  if (value_->is_null()) return {};
  if (!value_->is_object()) refuse("must be an object");
  return *this;
}

double number_at(const JsonEntry& entry, const std::string& key) {
  return entry.need(key).number();
}

std::string text_at(const JsonEntry& entry, const std::string& key) {
  return entry.need(key).text();
}

JsonEntry object_at(const JsonEntry& entry, const std::string& key) {
  return entry.need(key).object();
}

JsonList array_at(const JsonEntry& entry, const std::string& key) {
  return entry.need(key).elements();
}

double number_if_any(const JsonEntry& entry, const std::string& key) {
  return entry.at(key).number();
}

std::vector<double> numbers_if_any(const JsonEntry& entry, const std::string& key) {
  return entry.at(key).numbers();
}

std::string text_if_any(const JsonEntry& entry, const std::string& key) {
  return entry.at(key).text();
}

JsonEntry object_if_any(const JsonEntry& entry, const std::string& key) {
  return entry.at(key).object();
}

JsonList array_if_any(const JsonEntry& entry, const std::string& key) {
  return entry.at(key).elements();
}

}  // namespace fingertip::studies::inline files
