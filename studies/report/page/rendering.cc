#include "studies/report/page/rendering.h"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <stdexcept>

namespace fingertip::studies::report::inline page {
namespace {

using MustacheData = kainjow::mustache::data;

MustacheData mustache_data(const TemplateData& words);

MustacheData mustache_data(const TemplateData::Value& value) {
  if (const bool* condition = std::get_if<bool>(&value)) return *condition;
  if (const std::string* text = std::get_if<std::string>(&value))
    return text->empty() ? MustacheData(false) : MustacheData(*text);
  MustacheData list{kainjow::mustache::list()};
  for (const TemplateData& entry : std::get<WordList>(value)) list << mustache_data(entry);
  return list;
}

MustacheData mustache_data(const TemplateData& words) {
  MustacheData object;
  for (const auto& [name, value] : words.values) object.set(name, mustache_data(value));
  return object;
}

/// Where kainjow shows nothing for an unknown name, this one says so.
class StrictNames : public kainjow::mustache::context<std::string> {
 public:
  StrictNames(const MustacheData& root, const std::string& where) : context(&root), where_(where) {}

  const MustacheData* get(const std::string& name) const override {
    if (const MustacheData* found = context::get(name)) return found;
    throw std::logic_error(fmt::format("{}.mustache: no value for {}", where_, name));
  }

 private:
  const std::string& where_;
};

}  // namespace

std::string rendered(std::string_view text, const TemplateData& words, const std::string& name,
                     const std::function<std::string(const std::string&)>& escape) {
  kainjow::mustache::mustache view{std::string(text)};
  if (!view.is_valid())
    throw std::logic_error(fmt::format("{}.mustache: {}", name, view.error_message()));
  if (escape) view.set_custom_escape(escape);
  const MustacheData root = mustache_data(words);
  StrictNames names(root, name);
  return view.render(names);
}

}  // namespace fingertip::studies::report::inline page
