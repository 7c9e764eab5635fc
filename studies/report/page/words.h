/// Chapters from two halves: chapters/NAME.mustache has the words, the code the data.
///
/// A template is plain text with mustache's {{value}}, {{#section}}…{{/section}} and
/// {{^section}}…{{/section}}. Blank lines divide it into blocks:
///
///     # The chapter's title
///
///     **Lead-in.** A paragraph, over as many lines as one likes.
///
///     ! **Lead-in.** A warning.
///
///     [figure id] Title | caption
///
///     [table id] Caption
///
///     [listing id] Title
///
/// A block is left out when its figure, table or listing was not given, or when nothing is left of
/// its text. Values are put in after the blocks were told apart, so none can be mistaken for one.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "studies/report/page/document.h"
#include "studies/report/page/rendering.h"

namespace fingertip::studies::report::inline page {

/// A chapter's data. Its template knows the names of two shown units besides: force_unit and
/// stress_unit.
struct ChapterData : TemplateData {
  explicit ChapterData(std::string template_name) : name(std::move(template_name)), id(name) {}

  std::string name;                             ///< of the template
  std::string id;                               ///< of the chapter on the page
  std::vector<Figure> figures;                  ///< by their names; none without panels
  std::map<std::string, Table> tables;          ///< by id; none without rows
  std::map<std::string, std::string> listings;  ///< by id
};

/// The chapter that template and data make. Throws std::logic_error when the two do not fit: the
/// template asks for a value that is not given, or has no place for a figure, table or listing.
Chapter written(ChapterData data);
/// The same with the text of a template.
Chapter written(ChapterData data, std::string_view text);

/// The text of a template that is one paragraph; "" when nothing is left of it.
std::string sentences(const std::string& name, const TemplateData& words);
/// `text` where `value`, of which it tells, is known; "" of NaN.
std::string if_known(double value, const std::string& text);
/// Both texts, one after the other.
std::string joined(const std::string& first, const std::string& second);

}  // namespace fingertip::studies::report::inline page
