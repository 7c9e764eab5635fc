/// JSON files, read with messages that name the file and the place in it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace fingertip::studies::inline files {

/// The JSON object in a file. Throws InvalidInput naming file, line and column when it cannot be
/// read, is no JSON, or holds something else than an object.
nlohmann::ordered_json parse_json(const std::filesystem::path& file);

/// The number, NaN for null.
double number_of(const nlohmann::ordered_json& value);

/// A value in a JSON file that knows its place there. Entries that are absent count as null, and
/// null stands for what a program did not know. A value of another type than is asked for is
/// damage: InvalidInput with file, path ("samples[2].force"), value and the type that belongs
/// there.
class JsonEntry {
 public:
  /// An empty object.
  JsonEntry() : JsonEntry(nlohmann::json::object()) {}
  /// `file` is for messages.
  JsonEntry(nlohmann::json content, const std::filesystem::path& file = {});

  bool is_null() const { return value_->is_null(); }
  bool is_object() const { return value_->is_object(); }
  bool is_list() const { return value_->is_array(); }
  bool is_number() const { return value_->is_number(); }
  /// Null, or without entries.
  bool empty() const { return value_->empty(); }
  /// Whether it is an object with this entry, and that is not null.
  bool contains(const std::string& key) const;
  /// An entry of an object.
  JsonEntry at(const std::string& key) const;
  /// An entry that the object must have; it may be null. Throws InvalidInput naming file and entry.
  JsonEntry need(const std::string& key) const;
  /// False for what at() gives for an entry that the object does not have.
  bool is_there() const { return there_; }
  /// The entries of an object or null, by name.
  std::vector<std::pair<std::string, JsonEntry>> members() const;
  /// The entries of a list or null.
  std::vector<JsonEntry> elements() const;
  /// NaN for null. A number's magnitude is at most meshes::largest_plausible.
  double number() const;
  /// A number without a fraction.
  long long whole_number() const;
  /// numbers() of a list, number by number.
  std::vector<double> numbers() const;
  /// "" for null; numbers, true and false as JSON writes them.
  std::string text() const;
  /// False for null.
  bool flag() const;
  const nlohmann::json& content() const { return *value_; }
  /// Itself, an object; an empty one for null.
  JsonEntry object() const;

  /// Throws InvalidInput that names the place.
  [[noreturn]] void refuse(const std::string& rule) const;

 private:
  struct Document {
    nlohmann::json content;
    std::filesystem::path file;
  };
  JsonEntry(std::shared_ptr<const Document> document, const nlohmann::json& value,
            std::string path);

  std::shared_ptr<const Document> document_;
  const nlohmann::json* value_;
  std::string path_;
  bool there_ = true;
};

using JsonList = std::vector<JsonEntry>;

/// The object in a file, which must be there. Throws like parse_json.
JsonEntry read_entry(const std::filesystem::path& file);

/// An entry that must be there, null or not.
double number_at(const JsonEntry& entry, const std::string& key);
std::string text_at(const JsonEntry& entry, const std::string& key);
JsonEntry object_at(const JsonEntry& entry, const std::string& key);
JsonList array_at(const JsonEntry& entry, const std::string& key);

/// An entry that may be absent: as null.
double number_if_any(const JsonEntry& entry, const std::string& key);
std::vector<double> numbers_if_any(const JsonEntry& entry, const std::string& key);
std::string text_if_any(const JsonEntry& entry, const std::string& key);
JsonEntry object_if_any(const JsonEntry& entry, const std::string& key);
JsonList array_if_any(const JsonEntry& entry, const std::string& key);

}  // namespace fingertip::studies::inline files
