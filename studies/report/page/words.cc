#include "studies/report/page/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim_all.hpp>
#include <cmath>
#include <stdexcept>

#include "studies/report/page/templates.h"

namespace fingertip::studies::report::inline page {
namespace {

/// Stand in the rendered text for a blank line and around the number of a value.
constexpr char block_end = '\x1e', value_mark = '\x1a';

/// A template without line breaks: they are spaces, blank lines end a block.
std::string on_one_line(std::string_view text) {
  std::string flat(text);
  boost::replace_all(flat, "\n\n", std::string(1, block_end));
  boost::replace_all(flat, "\n", " ");
  return flat;
}

/// The part of `text` before `end`, which it loses together with `end`; all of it without one.
std::string_view cut_off(std::string_view& text, std::string_view end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + end.size(), text.size()));
  return part;
}

/// Puts a template's blocks together with what they name.
class Writer {
 public:
  explicit Writer(ChapterData data) : data_(std::move(data)) {
    std::erase_if(data_.figures, [](const Figure& figure) { return figure.panels.empty(); });
    std::erase_if(data_.tables, [](const auto& entry) { return entry.second.rows.empty(); });
    data_["force_unit"] = unit_name(shown_units().force);
    data_["stress_unit"] = unit_name(shown_units().stress);
  }

  Chapter chapter(std::string_view text) {
    chapter_.id = data_.id;
    const std::string all = numbered(text);
    for (std::string_view rest = all; !rest.empty();) {
      const std::string block = boost::trim_all_copy(std::string(cut_off(rest, {&block_end, 1})));
      if (block.starts_with("# "))
        chapter_.title = filled(block.substr(2));
      else if (block.starts_with('['))
        place(block);
      else
        add_paragraph(block);
    }
    if (!data_.figures.empty()) refuse("has no place for figure " + data_.figures.front().name);
    if (!data_.tables.empty()) refuse("has no place for table " + data_.tables.begin()->first);
    if (!data_.listings.empty())
      refuse("has no place for listing " + data_.listings.begin()->first);
    return std::move(chapter_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::logic_error(fmt::format("chapters/{}.mustache: {}", data_.name, what));
  }

  /// The template with numbers in the place of values, which `values_` keeps.
  std::string numbered(std::string_view text) {
    return rendered(on_one_line(text), data_, "chapters/" + data_.name,
                    [this](const std::string& value) {
                      values_.push_back(value);
                      return fmt::format("{}{}{}", value_mark, values_.size() - 1, value_mark);
                    });
  }

  /// With the values in their places.
  std::string filled(std::string_view text) const {
    std::string result;
    while (!text.empty()) {
      result += cut_off(text, {&value_mark, 1});
      if (!text.empty())
        result += values_.at(std::stoul(std::string(cut_off(text, {&value_mark, 1}))));
    }
    return result;
  }

  /// "[kind id] rest"
  void place(std::string_view block) {
    block.remove_prefix(1);
    const std::string_view kind = cut_off(block, " ");
    const std::string id = filled(cut_off(block, "]"));
    if (block.starts_with(' ')) block.remove_prefix(1);
    if (kind == "figure") {
      const auto found = std::ranges::find(data_.figures, id, &Figure::name);
      if (found == data_.figures.end()) return;
      const std::string title = filled(cut_off(block, " |")),
                        caption = filled(block.substr(block.starts_with(' ')));
      chapter_.blocks.push_back(FigureBlock{std::move(*found), title, caption});
      data_.figures.erase(found);
    } else if (kind == "table") {
      auto found = data_.tables.extract(id);
      if (found.empty()) return;
      found.mapped().id = id;
      found.mapped().caption = filled(block);
      chapter_.blocks.push_back(std::move(found.mapped()));
    } else if (kind == "listing") {
      const auto found = data_.listings.extract(id);
      if (!found.empty()) chapter_.blocks.push_back(Listing{filled(block), found.mapped()});
    } else {
      refuse(fmt::format("unknown kind of block: {}", kind));
    }
  }

  void add_paragraph(std::string_view block) {
    Paragraph paragraph;
    paragraph.warning = block.starts_with("! ");
    if (paragraph.warning) block.remove_prefix(2);
    if (block.starts_with("**")) {
      block.remove_prefix(2);
      paragraph.lead = filled(cut_off(block, "**"));
    }
    paragraph.text = filled(block.substr(block.starts_with(' ')));
    if (!paragraph.lead.empty() || !paragraph.text.empty())
      chapter_.blocks.push_back(std::move(paragraph));
  }

  ChapterData data_;
  Chapter chapter_;
  std::vector<std::string> values_;
};

}  // namespace

Chapter written(ChapterData data) {
  const std::string_view text = templates().at(data.name + ".mustache");
  return written(std::move(data), text);
}

Chapter written(ChapterData data, std::string_view text) {
  return Writer(std::move(data)).chapter(text);
}

std::string sentences(const std::string& name, const TemplateData& words) {
  ChapterData data(name);
  data.values = words.values;
  const Chapter chapter = written(std::move(data));
  return chapter.blocks.empty() ? "" : std::get<Paragraph>(chapter.blocks.front()).text;
}

std::string if_known(double value, const std::string& text) {
  return std::isfinite(value) ? text : "";
}

std::string joined(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + ' ' + second;
}

}  // namespace fingertip::studies::report::inline page
