/// What a template is filled with, and the text that becomes of it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fingertip::studies::report::inline page {

/// What the names in a template stand for: a text, a condition, or a list whose section is repeated
/// for each of its entries. As the condition of a section an empty text is false.
struct TemplateData {
  using Value = std::variant<std::string, bool, std::vector<TemplateData>>;
  std::map<std::string, Value> values;

  Value& operator[](const std::string& name) { return values[name]; }
};
using WordList = std::vector<TemplateData>;

/// The template with its values, each as `escape` gives it; for HTML without one. Throws
/// std::logic_error naming the template `name` when it is none, and for a value that is not given.
std::string rendered(std::string_view text, const TemplateData& words, const std::string& name,
                     const std::function<std::string(const std::string&)>& escape = {});

}  // namespace fingertip::studies::report::inline page
