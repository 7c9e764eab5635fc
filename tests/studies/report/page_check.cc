#include "tests/studies/report/page_check.h"

#include <map>
#include <regex>
#include <set>

namespace fingertip::report_testing {
namespace {

struct Tag {
  std::string name, attributes;
  bool closing = false, self_closing = false;
};

/// The tags of a page in order; comments, the doctype and the content of <style> and <script> are
/// skipped.
std::vector<Tag> tags(const std::string& html, std::vector<std::string>& faults) {
  std::vector<Tag> result;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    if (html.compare(at, 2, "<!") == 0) {
      at = html.find('>', at);
      continue;
    }
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos || html.find('<', at + 1) < end) {
      faults.push_back("a < that opens no tag: " + html.substr(at, 40));
      ++at;
      continue;
    }
    Tag tag;
    std::string inner = html.substr(at + 1, end - at - 1);
    tag.closing = inner.front() == '/';
    tag.self_closing = inner.back() == '/';
    if (tag.closing) inner.erase(0, 1);
    if (tag.self_closing) inner.pop_back();
    const std::size_t space = inner.find_first_of(" \n\t");
    tag.name = inner.substr(0, space);
    if (space != std::string::npos) tag.attributes = inner.substr(space);
    result.push_back(tag);
    const bool raw = (tag.name == "style" || tag.name == "script") && !tag.closing;
    at = raw ? html.find("</" + tag.name, end) : end;
  }
  return result;
}

}  // namespace

std::vector<std::string> structure_faults(const std::string& html) {
  static const std::set<std::string> empty_elements{"meta", "br", "hr", "img", "link", "input"};
  static const std::regex attribute(R"rx(\s+[-:A-Za-z_]+(\s*=\s*("[^"]*"|'[^']*'))?)rx");
  static const std::regex id(R"rx(\sid\s*=\s*["']([^"']*)["'])rx");
  std::vector<std::string> faults, open;
  std::map<std::string, int> ids;
  for (const Tag& tag : tags(html, faults)) {
    if (tag.closing) {
      if (open.empty() || open.back() != tag.name) {
        faults.push_back("</" + tag.name + "> closes " +
                         (open.empty() ? "nothing" : "<" + open.back() + ">"));
      } else {
        open.pop_back();
      }
      continue;
    }
    // Path data is long and of no interest here.
    const std::string attributes = tag.attributes.substr(0, 2000);
    std::smatch match;
    if (std::regex_search(attributes, match, id) && ++ids[match[1]] == 2) {
      faults.push_back("id used twice: " + match[1].str());
    }
    if (tag.attributes.size() < 2000) {
      const std::string rest = std::regex_replace(attributes, attribute, "");
      if (rest.find_first_not_of(" \n\t") != std::string::npos) {
        faults.push_back("strange attributes in <" + tag.name + ">: " + rest);
      }
    }
    if (!tag.self_closing && !empty_elements.count(tag.name)) open.push_back(tag.name);
  }
  for (const std::string& name : open) faults.push_back("<" + name + "> is never closed");
  return faults;
}

std::string without_own_scripts(std::string html) {
  for (const char* opening :
       {"<script type=\"application/json\">", "<script>\n// Figures answer:"}) {
    const std::string closing = "</script>";
    for (std::size_t at; (at = html.find(opening)) != std::string::npos;)
      html.erase(at, html.find(closing, at) + closing.size() - at);
  }
  return html;
}

std::vector<std::string> outside_references(const std::string& html) {
  static const std::regex outside(
      R"rx(https?:|\bsrc\s*=|<link|<iframe|@import|url\((?!#)|javascript:|\son\w+\s*=)rx",
      std::regex::icase);
  std::vector<std::string> found;
  for (std::sregex_iterator it(html.begin(), html.end(), outside), end; it != end; ++it) {
    found.push_back(html.substr(std::size_t(it->position()), 60));
  }
  const std::string rest = without_own_scripts(html);
  for (std::size_t at = 0; (at = rest.find("<script", at)) != std::string::npos; ++at)
    found.push_back(rest.substr(at, 60));
  return found;
}

std::string visible_text(const std::string& page) {
  const std::string html = without_own_scripts(page);
  std::string text;
  bool inside_tag = false;
  for (char c : html) {
    if (c == '<') inside_tag = true;
    if (!inside_tag) text += c;
    if (c == '>') inside_tag = false, text += ' ';
  }
  for (const auto& [entity, character] : std::map<std::string, std::string>{{"\u00a0", " "},
                                                                            {"&lt;", "<"},
                                                                            {"&gt;", ">"},
                                                                            {"&quot;", "\""},
                                                                            {"&apos;", "'"},
                                                                            {"&amp;", "&"}}) {
    for (std::size_t at; (at = text.find(entity)) != std::string::npos;)
      text.replace(at, entity.size(), character);
  }
  return text;
}

}  // namespace fingertip::report_testing
