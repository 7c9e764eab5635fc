/// What a configuration key is: name, kind, unit, default, range, meaning and target.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "meshes/base/names.h"
#include "studies/config/keys/config.h"

namespace fingertip::studies::inline config::inline keys {

enum class Kind {
  quantity,     ///< text "number unit"
  quantities,   ///< list of such texts
  number,       ///< TOML number
  terms,        ///< list of pairs of such a text and a TOML number, or the other way round
  stages,       ///< list of pairs of two such texts, or of the word hold and one
  numbers,      ///< list of three TOML numbers
  number_pair,  ///< list of two TOML numbers, the smaller first
  integer,      ///< TOML integer
  boolean,      ///< true or false
  choice,       ///< one of the listed words
  source,       ///< one of the listed words or the path of a file
  text,         ///< any text, also an empty one
  file,         ///< path of a file, or an empty text for none
  texts,        ///< list of texts
  files,        ///< list of paths of files
  fields,       ///< table of Key::fields, or with Key::or_file the path of a file
};

using meshes::name, meshes::values;
constexpr auto names_of(Kind) {
  using enum Kind;
  return meshes::names<Kind>({{quantity, "quantity"},
                              {quantities, "quantities"},
                              {number, "number"},
                              {terms, "terms"},
                              {stages, "stages"},
                              {numbers, "numbers"},
                              {number_pair, "number_pair"},
                              {integer, "integer"},
                              {boolean, "boolean"},
                              {choice, "choice"},
                              {source, "source"},
                              {text, "text"},
                              {file, "file"},
                              {texts, "texts"},
                              {files, "files"},
                              {fields, "fields"}});
}

/// A value read from text, in SI.
struct Value {
  double number = 0.0;          ///< quantity, number, integer, boolean (0 or 1)
  std::vector<double> numbers;  ///< quantities, terms, numbers; six of a stage as in PressStage;
                                ///< three of a field: 1 for "fit", the quantity, its deviation; or
                                ///< 0, the whole number, 0
  std::string word;  ///< choice, source, text, file, also of a field; for a quantity the word given
                     ///< instead of one
  std::vector<std::string> words;  ///< texts, files; of fields the names given
};

/// An entry of a key that is a table: "fit", a quantity, or a quantity with its standard deviation;
/// of unit "1" a whole number from 1 on; without a unit the path of a file, of which a table has
/// one.
struct Field {
  std::string name, unit, example, help;
  /// The example as TOML.
  std::string literal() const { return unit == "1" ? example : '"' + example + '"'; }
};

struct Choice {
  std::string word;
  std::string meaning;
};

struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;
  bool contains(double value) const {
    return (minimum_allowed ? value >= minimum : value > minimum) && value <= maximum;
  }
};

struct Key {
  std::string section;
  std::string name;
  Kind kind = Kind::quantity;
  std::string preset;  ///< default as a TOML literal
  std::string unit;    ///< SI unit; empty for what is no quantity
  Range range;         ///< in SI
  std::vector<Choice> choices;
  std::vector<Field> fields;
  std::size_t length = 0;            ///< of a list of quantities; 0: any
  bool number_first = false;         ///< of terms
  bool or_file = false;              ///< of fields
  std::string word;                  ///< accepted instead of a value: "auto", "touch"
  std::string pattern;               ///< of texts accepted as well: "tip_radius/N", N a number > 0
  std::string help;                  ///< one line
  std::string rule;                  ///< further rule in words, may be empty
  std::vector<std::string> related;  ///< keys its rule also depends on
  /// The key matters only where that one is one of these words; empty: always.
  std::string matters_with;
  std::vector<std::string> matters_words;
  std::function<void(Config&, const Value&)> assign;

  std::string full_name() const { return section + "." + name; }
  /// Of the kind: "list of quantities".
  std::string description() const;
  bool takes_list() const;
  /// A quantity text to quote in advice: the default, or "1 <unit>".
  std::string example() const;
  /// The allowed values in words: range, choices or nothing.
  std::string allowed() const;
};

struct Section {
  std::string name;
  std::string help;
};

}  // namespace fingertip::studies::inline config::inline keys
