#include "studies/run/curve_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "studies/config/units.h"
#include "studies/run/curve_rows.h"
#include "studies/run/curve_text.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;
using std::string_view;

/// A title of the header.
struct Title {
  std::string written;  ///< "Normal force [mN]"
  std::string name;     ///< "normal_force"
  std::optional<std::string> unit;
};

Title title_of(string_view cell) {
  Title title{shown(cell), "", {}};
  for (const char c : trimmed(cell.substr(0, cell.find_first_of("[(/"))))
    title.name += c == ' ' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  const auto open = cell.find('['), close = cell.find(']');
  if (open != cell.npos && close == cell.size() - 1 && open < close)
    title.unit = trimmed(cell.substr(open + 1, close - open - 1));
  return title;
}

/// A column that is read.
struct Column {
  std::size_t index = 0;
  std::string title, unit;
  double factor = 1.0;  ///< SI over `unit`

  /// 1/1000 is no binary number, 1000 is: dividing by it rounds once, so that 0.3 mm is 3e-4 m.
  double si(double value) const {
    const double inverse = std::round(1.0 / factor);
    return factor < 1.0 && 1.0 / inverse == factor ? value / inverse : value * factor;
  }
};

class CurveReader {
 public:
  CurveReader(const fs::path& file, const std::vector<CurveQuantities>& allowed)
      : problems_(file), allowed_(allowed), text_(text_of(file, problems_)) {
    result_.curve.name = file.stem().string();
  }
  MeasuredFile read();

 private:
  void read_header(const Line& line);
  void choose_pair(std::size_t line);
  void choose_sigma(std::size_t line);
  bool is_travel() const { return quantities_.x.name == measured::travel.x.name; }
  void note_unused();
  std::optional<std::size_t> find(string_view name, std::size_t line);
  Column column(std::size_t index, const Quantity& quantity, std::size_t line);
  void read_setting(const Line& line);
  void read_row(const Line& line);
  std::optional<double> read_cell(const Column& column, std::size_t line);
  bool read_sigma(CurveRow& row);
  void keep(const CurveRow& row);
  void check_signs();

  FileProblems problems_;
  const std::vector<CurveQuantities>& allowed_;
  std::string text_;
  char separator_ = ',';
  std::vector<Title> titles_;
  std::vector<string_view> cells_;  ///< of the row at hand
  CurveQuantities quantities_;
  Column x_, y_;
  std::optional<Column> sigma_, time_;
  bool own_error_ = false;  ///< sigma_ is a program's force_error, which may be unknown
  std::vector<CurveRow> rows_;
  std::size_t data_rows_ = 0, before_start_ = 0, without_error_ = 0;
  MeasuredFile result_;
};

void CurveReader::read_setting(const Line& line) {
  string_view comment = trimmed(line.text);
  while (comment.starts_with('#')) comment = trimmed(comment.substr(1));
  const auto equals = comment.find('=');
  const std::string key(trimmed(comment.substr(0, equals)));
  const auto dot = key.find('.');
  const bool is_key = equals != comment.npos && dot != key.npos && dot > 0 &&
                      dot + 1 < key.size() &&
                      key.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789.") == key.npos &&
                      key.find('.', dot + 1) == key.npos;
  if (!is_key) return;
  const std::string value(trimmed(comment.substr(equals + 1)));
  if (value.empty())
    problems_.add(line.number, key, "", "the value is missing", "write '# section.key = value'");
  const auto earlier = std::ranges::find(result_.settings, key, &MeasuredSetting::key);
  if (earlier != result_.settings.end())
    problems_.add(line.number, key, shown(value),
                  fmt::format("is given already in line {}", earlier->line), "keep one of them");
  else
    result_.settings.push_back({key, value, line.number});
}

std::optional<std::size_t> CurveReader::find(string_view name, std::size_t line) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < titles_.size(); ++i) {
    if (titles_[i].name != name && !(name == "force" && titles_[i].name == "normal_force"))
      continue;
    if (found)
      problems_.add(line, titles_[i].written, "",
                    "stands for the same as '" + titles_[*found].written + "'",
                    "leave one of the two columns out");
    else
      found = i;
  }
  return found;
}

Column CurveReader::column(std::size_t index, const Quantity& quantity, std::size_t line) {
  const Title& title = titles_[index];
  const std::string name(quantity.name), si(quantity.unit);
  Column result{index, title.written, title.unit.value_or(""), 1.0};
  const std::string remedy = "name the column for instance '" + name + " [" + si + "]'";
  if (!title.unit) {
    problems_.add(line, title.written, "", "the unit is missing: it stands in brackets at the end",
                  remedy);
  } else if (si == "1") {
    if (result.unit != "1")
      problems_.add(line, title.written, "", "a number without dimension is marked [1]",
                    remedy + " (divide percents by 100)");
  } else {
    try {
      result.factor = parse_quantity("1 " + result.unit, si, si);
    } catch (const UnitError& error) {
      problems_.add(line, title.written, "", error.rule, remedy);
    }
  }
  return result;
}

void CurveReader::choose_pair(std::size_t line) {
  for (const CurveQuantities& pair : allowed_) {
    const auto x = find(pair.x.name, line), y = find(pair.y.name, line);
    if (!x || !y) continue;
    quantities_ = pair;
    x_ = column(*x, pair.x, line);
    y_ = column(*y, pair.y, line);
    result_.x_quantity = pair.x.name;
    result_.y_quantity = pair.y.name;
    return;
  }
  std::string pairs;
  for (const CurveQuantities& pair : allowed_)
    pairs += fmt::format("{}'{} [{}]' and '{} [{}]'", pairs.empty() ? "" : ", or ", pair.x.name,
                         pair.x.unit, pair.y.name, pair.y.unit);
  const bool is_row = number_in(titles_.front().written).has_value();
  constexpr std::size_t enough = 8;
  std::string header;
  for (std::size_t i = 0; i < std::min(enough, titles_.size()); ++i)
    header += (i > 0 ? ", " : "") + shown(titles_[i].written);
  if (titles_.size() > enough) header += fmt::format(" and {} more", titles_.size() - enough);
  problems_.add(line, "", "",
                (is_row ? "the header is missing: the first line is '"
                        : "the header has no pair of columns that can be used here: it is '") +
                    header + "'",
                "name the columns in the first line, separated by comma, semicolon or tab: " +
                    pairs + ", in any unit");
}

void CurveReader::choose_sigma(std::size_t line) {
  auto index = find("sigma", line);
  own_error_ = !index && quantities_.y.name == "force";
  if (own_error_) index = find("force_error", line);
  if (index)
    sigma_ = column(*index, {own_error_ ? "force_error" : "sigma", quantities_.y.unit}, line);
}

void CurveReader::note_unused() {
  std::string unused;
  for (std::size_t i = 0; i < titles_.size(); ++i)
    if (i != x_.index && i != y_.index && !(sigma_ && i == sigma_->index) &&
        !(time_ && i == time_->index))
      unused += (unused.empty() ? "" : ", ") + titles_[i].written;
  if (!unused.empty()) result_.notes.push_back("columns that are not used: " + unused);
}

void CurveReader::read_header(const Line& line) {
  for (const char separator : {'\t', ',', ';'})
    if (line.text.find(separator) != line.text.npos) separator_ = separator;
  split(line.text, separator_, cells_);
  for (const string_view cell : cells_) titles_.push_back(title_of(cell));
  choose_pair(line.number);
  problems_.throw_if_any();
  choose_sigma(line.number);
  if (const auto time = find("time", line.number); time && is_travel())
    time_ = column(*time, {"time", "s"}, line.number);
  problems_.throw_if_any();
  note_unused();
}

std::optional<double> CurveReader::read_cell(const Column& column, std::size_t line) {
  constexpr double largest = 1e60;
  const string_view cell = cells_[column.index];
  const auto value = number_in(cell);
  if (value && std::isfinite(*value)) {
    const double si = column.si(*value);
    const double size = std::abs(si);
    if (si == 0.0 ? *value == 0.0 : size >= 1.0 / largest && size <= largest) return si;
  }
  const bool comma = cell.find(',') != cell.npos;
  problems_.add(line, column.title, shown(cell),
                cell.empty() ? "the cell is empty" : "must be a finite number of plausible size",
                comma ? "write decimals with a point" : "correct or delete the row");
  return {};
}

/// False where the row cannot be used.
bool CurveReader::read_sigma(CurveRow& row) {
  if (!sigma_) return true;
  const string_view cell = cells_[sigma_->index];
  if (own_error_ && (cell.empty() || number_in(cell) == 0.0)) {
    ++without_error_;
    return true;
  }
  const auto sigma = read_cell(*sigma_, row.line);
  if (!sigma) return false;
  row.sigma = *sigma;
  if (row.sigma > 0.0) return true;
  problems_.add(row.line, sigma_->title, shown(cell), "a standard deviation is positive",
                "correct it, or leave the whole column out where it is unknown");
  return false;
}

void CurveReader::read_row(const Line& line) {
  split(line.text, separator_, cells_);
  ++data_rows_;
  if (cells_.size() != titles_.size()) {
    const bool comma = separator_ == ',' && cells_.size() == 2 * titles_.size();
    problems_.add(line.number, "", "",
                  fmt::format("has {} cells, the header {} titles", cells_.size(), titles_.size()),
                  comma ? "write decimals with a point, or separate cells by semicolons"
                        : "give every row a cell per title; the file may be truncated");
    return;
  }
  CurveRow row;
  row.line = line.number;
  const auto x = read_cell(x_, line.number), y = read_cell(y_, line.number);
  const auto time = time_ ? read_cell(*time_, line.number) : 0.0;
  const bool known = read_sigma(row);
  if (!x || !y || !known || !time) return;
  row.time = *time;
  row.x = *x;
  row.y = *y;
  keep(row);
}

void CurveReader::keep(const CurveRow& row) {
  if (row.x > 0.0 || is_travel()) {
    rows_.push_back(row);
  } else if (quantities_.x.name == "stretch" || quantities_.x.name == "frequency") {
    problems_.add(row.line, x_.title, shown(cells_[x_.index]),
                  std::string(quantities_.x.name) + " is positive", "correct or delete the row");
  } else {
    ++before_start_;
  }
}

void CurveReader::check_signs() {
  if (before_start_ > 0)
    result_.notes.push_back(fmt::format("{} rows with {} <= 0, before the start, are left out",
                                        before_start_, quantities_.x.name));
  if (rows_.empty()) {
    problems_.add(0, x_.title, "",
                  data_rows_ == 0 ? "there are no rows below the header"
                                  : "is positive in no row, and rows before the start do not count",
                  quantities_.x.name == "indentation"
                      ? "indentation is positive when pressed: change its sign, or write the data"
                      : "write the data");
  }
  if (quantities_.y.name != "force" || rows_.empty()) return;
  double sum = 0.0;
  for (const CurveRow& row : rows_) sum += row.y;
  const auto negative =
      std::ranges::count_if(rows_, [](const CurveRow& row) { return row.y < 0.0; });
  if (!(sum > 0.0))
    problems_.add(0, y_.title, fmt::format("sum of {} rows {:.3g} N", rows_.size(), sum),
                  "forces are positive in compression", "change their sign");
  else if (negative > 0)
    result_.notes.push_back(
        fmt::format("{} of {} forces are negative (adhesion, drift or noise) and count as they are",
                    negative, rows_.size()));
}

MeasuredFile CurveReader::read() {
  Lines lines(text_);
  while (const auto line = lines.next()) {
    if (trimmed(line->text).front() == '#')
      read_setting(*line);
    else if (titles_.empty())
      read_header(*line);
    else
      read_row(*line);
  }
  if (titles_.empty())
    problems_.add(0, "", "", "the file holds no table",
                  "write a header such as 'indentation [mm], force [mN]' and rows of numbers");
  problems_.throw_if_any();
  if (without_error_ > 0) {
    for (CurveRow& row : rows_) row.sigma = 0.0;
    result_.notes.push_back(
        fmt::format("{} is not taken as sigma: it is unknown or 0 in {} of {} "
                    "rows",
                    sigma_->title, without_error_, data_rows_));
  }
  check_signs();
  problems_.throw_if_any();
  std::string name = std::move(result_.curve.name);
  if (is_travel()) rows_ = loading(std::move(rows_), result_.notes);
  result_.curve = curve_of(rows_, {result_.x_quantity, x_.unit, x_.factor, is_travel()}, problems_,
                           result_.notes);
  result_.curve.is_travel = is_travel();
  result_.curve.name = std::move(name);
  problems_.throw_if_any();
  for (const double x : result_.curve.x)
    result_.lines.push_back(
        std::ranges::find_if(rows_, [&](const CurveRow& row) { return row.x >= x; })->line);
  return std::move(result_);
}

}  // namespace

MeasuredFile read_measured(const fs::path& file, const std::vector<CurveQuantities>& allowed) {
  return CurveReader(file, allowed).read();
}

}  // namespace fingertip::studies
