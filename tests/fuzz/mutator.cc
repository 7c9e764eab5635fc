#include "mutator.h"

#include <algorithm>
#include <array>
#include <random>
#include <string_view>

namespace fuzz {

namespace {

using std::string_view;

/// What stands in for a number.
constexpr std::array<string_view, 26> odd_numbers = {"nan",
                                                     "NaN",
                                                     "inf",
                                                     "-inf",
                                                     "Infinity",
                                                     "0",
                                                     "-0",
                                                     "-0.0",
                                                     "-1",
                                                     "1e308",
                                                     "-1e308",
                                                     "1e309",
                                                     "1e-308",
                                                     "4.9e-324",
                                                     "1e-400",
                                                     "2147483648",
                                                     "4294967298",
                                                     "9007199254740993",
                                                     "9223372036854775807",
                                                     "-9223372036854775808",
                                                     "18446744073709551616",
                                                     "0x7fffffff",
                                                     "1_000",
                                                     "1.5.2",
                                                     "1e",
                                                     ""};

constexpr std::array<string_view, 7> no_text = {
    "\xff", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80", "\xe2\x80\xae", "\x1b[2J", "\xef\xbf\xbe"};

bool digit(char c) {
  return c >= '0' && c <= '9';
}

class Surgeon {
 public:
  Surgeon(const Material& material, std::uint64_t number)
      : material_(material), random_(number * 0x9e3779b97f4a7c15U + 1996) {}

  std::string operate() {
    text_ = one_of(material_.seeds);
    for (std::size_t changes = 1 + below(2) * below(6); changes > 0; --changes) change();
    return std::move(text_);
  }

 private:
  /// In 0 ... n - 1, 0 for n = 0.
  std::size_t below(std::size_t n) { return n == 0 ? 0 : std::size_t(random_() % n); }
  std::size_t place() { return below(text_.size() + 1); }
  template <class List>
  typename List::value_type one_of(const List& list) {
    return list[below(list.size())];
  }

  void change() {
    switch (below(20)) {
      case 0: return flip_bit();
      case 1: return void(text_.insert(place(), 1, char(below(256))));
      case 2: return void(text_.erase(std::min(place(), text_.size()), 1 + below(12)));
      case 3: return text_.resize(place());
      case 4: return double_stretch();
      case 5:
      case 6: return change_lines();
      case 7:
      case 8:
      case 9:
      case 10: return replace_number();
      case 11: return decimal_comma();
      case 12:
      case 13: return lose_one_of("\"'[]{}()=:,;#\n");
      case 14: return insert_word();
      case 15: return void(text_.insert(place(), 1, '\0'));
      case 16: return void(text_.insert(place(), one_of(no_text)));
      case 17: return other_encoding();
      case 18: return below(8) == 0 ? grow() : insert_word();
      default: return splice();
    }
  }

  void flip_bit() {
    if (!text_.empty()) text_[below(text_.size())] ^= char(1U << below(8));
  }

  void double_stretch() {
    const std::size_t at = place();
    text_.insert(at, text_.substr(at, 1 + below(40)));
  }

  void change_lines() {
    std::vector<std::string> lines(1);
    for (const char c : text_)
      if (c == '\n')
        lines.emplace_back();
      else
        lines.back() += c;
    const std::size_t a = below(lines.size()), b = below(lines.size());
    switch (below(3)) {
      case 0: std::swap(lines[a], lines[b]); break;
      case 1: lines[a] += '\n' + lines[a]; break;
      default: lines.erase(lines.begin() + std::ptrdiff_t(a));
    }
    text_.clear();
    for (const std::string& line : lines) text_ += (&line == lines.data() ? "" : "\n") + line;
  }

  /// Where a run of digits begins, the first at or after a random place; npos without one.
  std::size_t some_digit() {
    const std::size_t found = text_.find_first_of("0123456789", place());
    return found != text_.npos ? found : text_.find_first_of("0123456789");
  }

  void replace_number() {
    std::size_t begin = some_digit();
    if (begin == text_.npos) return insert_word();
    std::size_t end = begin;
    const auto part = [](char c) { return digit(c) || c == '.' || c == 'e' || c == 'E'; };
    while (begin > 0 && part(text_[begin - 1])) --begin;
    while (end < text_.size() && part(text_[end])) ++end;
    if (begin > 0 && text_[begin - 1] == '-' && below(2) == 0) --begin;
    const std::string_view odd = one_of(odd_numbers);
    text_.replace(begin, end - begin, below(40) == 0 ? std::string(400, '9') : std::string(odd));
  }

  void decimal_comma() {
    for (std::size_t i = 0; i + 1 < text_.size(); ++i)
      if (text_[i] == '.' && digit(text_[i + 1]) && below(3) > 0) text_[i] = ',';
  }

  void lose_one_of(const char* which) {
    std::size_t at = text_.find_first_of(which, place());
    if (at == text_.npos) at = text_.find_first_of(which);
    if (at != text_.npos) text_.erase(at, 1);
  }

  void insert_word() {
    text_.insert(place(), material_.words.empty() ? std::string("0") : one_of(material_.words));
  }

  void other_encoding() {
    switch (below(4)) {
      case 0: return void(text_.insert(0, "\xEF\xBB\xBF"));
      case 1: return void(text_.insert(0, "\xFF\xFE"));
      case 2: return replace_line_ends("\r\n");
      default: return replace_line_ends("\r");
    }
  }

  void replace_line_ends(const char* by) {
    std::string changed;
    for (const char c : text_) c == '\n' ? void(changed += by) : changed.push_back(c);
    text_ = std::move(changed);
  }

  void grow() {
    static const std::vector<std::string> units = {"[", "{\"a\":", "(", "{a=", "a.", " ", "9", "#"};
    const std::string unit = one_of(units);
    const std::size_t count = below(4) == 0 ? 70'000 : 300;
    std::string many;
    for (std::size_t i = 0; i < count; ++i) many += unit;
    text_.insert(place(), many);
  }

  void splice() {
    const std::string other = one_of(material_.seeds);
    const std::size_t from = below(other.size() + 1);
    text_.insert(place(), other.substr(from, 1 + below(60)));
  }

  const Material& material_;
  std::mt19937_64 random_;
  std::string text_;
};

}  // namespace

std::string mutated(const Material& material, std::uint64_t number) {
  return Surgeon(material, number).operate();
}

}  // namespace fuzz
