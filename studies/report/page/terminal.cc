#include "studies/report/page/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <utility>

namespace fingertip::studies::report::inline page {
namespace {

constexpr std::size_t screen_width = 100;

/// The longest first where one begins like another.
constexpr std::pair<std::string_view, std::string_view> spellings[] = {
    {"×10", "e"},    {"−", "-"},  {"–", "-"},   {"⁻", "-"},     {"\u00a0", " "}, {"\u202f", ""},
    {"×", "x"},      {"·", " "},  {"…", "..."}, {"≈", "~"},     {"±", "+/-"},    {"µ", "u"},
    {"²", "^2"},     {"³", "^3"}, {"₀", "0"},   {"₁", "1"},     {"₂", "2"},      {"κ", "kappa"},
    {"λ", "lambda"}, {"ν", "nu"}, {"τ", "tau"}, {"δ", "delta"}, {"ρ", "rho"},    {"ω", "omega"},
    {"√", "sqrt"},   {"✓ ", ""},  {"✕ ", ""}};
constexpr std::string_view digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

/// The spelling of what `text` begins with, which it loses; digits above the line are an exponent's
/// where `exponent`.
std::string taken_from(std::string_view& text, bool exponent) {
  const auto take = [&](std::string_view what) {
    if (!text.starts_with(what)) return false;
    text.remove_prefix(what.size());
    return true;
  };
  for (int digit = 0; digit < 10 && exponent; ++digit)
    if (take(digits[digit])) return std::to_string(digit);
  for (const auto& [what, spelling] : spellings)
    if (take(what)) return std::string(spelling);
  const char c = text.front();
  text.remove_prefix(1);
  if (c >= ' ' && c <= '~') return {c};
  // The first byte of a sign stands for all of them.
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80 ? "" : "?";
}

using Lines = std::vector<std::vector<std::string>>;

/// A line per row, the head first; with notes `below` one more where a row has any.
Lines lines_of(const Table& table, bool below) {
  Lines lines;
  const auto add = [&](const std::vector<Cell>& row, const char* before, const char* behind) {
    std::vector<std::string> texts, notes;
    for (const Cell& cell : row) {
      const bool joined = !below && !cell.note.empty();
      texts.push_back(terminal(joined ? cell.text + before + cell.note + behind : cell.text));
      notes.push_back(terminal(cell.note));
    }
    lines.push_back(texts);
    const bool any = std::ranges::any_of(row, [](const Cell& cell) { return !cell.note.empty(); });
    if (below && any) lines.push_back(notes);
  };
  add(table.header, ", ", "");
  for (const std::vector<Cell>& row : table.rows) add(row, " (", ")");
  return lines;
}

/// Of each column.
std::vector<std::size_t> widths_of(const Lines& lines) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()), 0);
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

/// TemplateData in lines that fit the screen.
std::string wrapped(const std::string& text) {
  std::string lines;
  std::size_t width = 0;
  std::istringstream words(text);
  for (std::string word; words >> word; width += word.size() + 1) {
    const bool fits = width + word.size() <= screen_width;
    if (!lines.empty()) lines += fits ? ' ' : '\n';
    if (!fits) width = 0;
    lines += word;
  }
  return lines + "\n";
}

}  // namespace

std::string terminal(std::string_view text) {
  std::string result;
  bool exponent = false;
  while (!text.empty()) {
    exponent = text.starts_with("×10") || (exponent && static_cast<signed char>(text.front()) < 0);
    result += taken_from(text, exponent);
  }
  return result;
}

std::string table_text(const Table& table) {
  constexpr std::size_t between = 2;
  Lines lines = lines_of(table, false);
  std::vector<std::size_t> widths = widths_of(lines);
  if (std::reduce(widths.begin(), widths.end(), between * widths.size()) > screen_width) {
    lines = lines_of(table, true);
    widths = widths_of(lines);
  }
  std::string text;
  for (const auto& line : lines) {
    std::string shown;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (i > 0) shown += std::string(between, ' ');
      const bool left = i == 0 || (i < table.header.size() && table.header[i].words);
      shown += left ? fmt::format("{:<{}}", line[i], widths[i])
                    : fmt::format("{:>{}}", line[i], widths[i]);
    }
    text += shown.erase(shown.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string tables_text(const Chapter& chapter, std::initializer_list<std::string_view> ids) {
  std::string text;
  for (const Block& block : chapter.blocks) {
    const Table* table = std::get_if<Table>(&block);
    if (table == nullptr || std::ranges::find(ids, table->id) == ids.end()) continue;
    text += wrapped(terminal(table->caption)) + table_text(*table) + "\n";
  }
  return text;
}

}  // namespace fingertip::studies::report::inline page
