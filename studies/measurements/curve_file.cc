#include "studies/measurements/curve_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "studies/measurements/curve_columns.h"
#include "studies/measurements/curve_rows.h"
#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline measurements {

namespace {

using std::string_view;

/// The curves of one file.
class CurveReader {
 public:
  CurveReader(const CurveSource& source, const std::vector<CurveQuantities>& allowed, bool in_time)
      : problems_(source.path),
        source_(source),
        allowed_(allowed),
        columns_(source, allowed, problems_),
        wants_time_(in_time),
        file_(text_of(source.path)) {}
  std::vector<MeasuredFile> read();

 private:
  MeasuredFile read_table(const TextTable& table);
  void choose_pair();
  void choose_sigma();
  bool is_travel() const { return quantities_.x.name == measured::travel.x.name; }
  void note_unused();
  void read_setting(const Line& line);
  void read_row(std::size_t row);
  std::optional<double> read_cell(const CurveColumn& column, std::size_t row);
  bool read_sigma(CurveRow& row, std::size_t place);
  void keep(const CurveRow& row, std::size_t place);
  void check_start();
  void check_direction();
  std::string described(const std::string& of_x, const std::string& of_y) const;

  FileProblems problems_;
  const CurveSource& source_;
  const std::vector<CurveQuantities>& allowed_;
  CurveColumns columns_;
  bool wants_time_ = false;
  FileText file_;
  std::vector<MeasuredSetting> settings_;
  const TextTable* table_ = nullptr;  ///< at hand
  CurveQuantities quantities_;
  CurveColumn x_, y_;
  std::optional<CurveColumn> sigma_, time_;
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
  const auto earlier = std::ranges::find(settings_, key, &MeasuredSetting::key);
  if (earlier != settings_.end())
    problems_.add(line.number, key, shown(value),
                  fmt::format("is given already in line {}", earlier->line), "keep one of them");
  else
    settings_.push_back({key, value, line.number});
}

void CurveReader::choose_pair() {
  for (const CurveQuantities& pair : allowed_) {
    const auto x = columns_.find(*table_, pair.x.name), y = columns_.find(*table_, pair.y.name);
    if (!x || !y) continue;
    quantities_ = pair;
    x_ = columns_.column(*table_, *x, pair.x, result_.notes);
    y_ = columns_.column(*table_, *y, pair.y, result_.notes);
    // An indentation whose zero is sought is a travel.
    if (pair == measured::press && x_.zero.by == ColumnZero::By::fit)
      quantities_ = measured::travel;
    result_.x_quantity = quantities_.x.name;
    result_.y_quantity = pair.y.name;
    return;
  }
  throw std::logic_error("a table without its columns");
}

void CurveReader::choose_sigma() {
  if (source_.sigma > 0.0) return;
  auto index = columns_.find(*table_, "sigma");
  // A lattice's is its distance from the continuum: no scatter.
  const bool of_lattice = std::filesystem::exists(source_.path.parent_path() / "boundary.csv");
  own_error_ = !index && quantities_.y.name == "force" && source_.columns.empty() && !of_lattice;
  if (own_error_) index = columns_.find(*table_, "force_error");
  if (index)
    sigma_ = columns_.column(
        *table_, *index, {own_error_ ? "force_error" : "sigma", quantities_.y.unit}, result_.notes);
}

void CurveReader::note_unused() {
  std::string unused;
  for (std::size_t i = 0; i < table_->titles.size(); ++i)
    if (i != x_.index && i != y_.index && !(sigma_ && i == sigma_->index) &&
        !(time_ && i == time_->index))
      unused += (unused.empty() ? "" : ", ") + table_->titles[i].written;
  if (!unused.empty()) result_.notes.push_back("columns that are not used: " + unused);
}

std::optional<double> CurveReader::read_cell(const CurveColumn& column, std::size_t row) {
  constexpr double largest = 1e60;
  const string_view cell = table_->rows[row][column.index];
  const auto value = table_->number(row, column.index);
  if (value && std::isfinite(*value)) {
    const double si = column.si(*value);
    const double size = std::abs(si);
    if (si == 0.0 ? *value == column.taken_off : size >= 1.0 / largest && size <= largest)
      return si;
  }
  const bool comma = cell.find(',') != cell.npos;
  problems_.add(table_->lines[row], column.title, shown(cell),
                cell.empty() ? "the cell is empty" : "must be a finite number of plausible size",
                comma ? "write decimals with a point" : "correct or delete the row");
  return {};
}

/// False where the row cannot be used.
bool CurveReader::read_sigma(CurveRow& row, std::size_t place) {
  row.sigma = source_.sigma;
  if (!sigma_) return true;
  const string_view cell = table_->rows[place][sigma_->index];
  if (own_error_ && (cell.empty() || table_->number(place, sigma_->index) == 0.0)) {
    ++without_error_;
    return true;
  }
  const auto sigma = read_cell(*sigma_, place);
  if (!sigma) return false;
  row.sigma = *sigma;
  if (row.sigma > 0.0) return true;
  problems_.add(row.line, sigma_->title, shown(cell), "a standard deviation is positive",
                "correct it, or leave the whole column out where it is unknown");
  return false;
}

void CurveReader::read_row(std::size_t place) {
  ++data_rows_;
  CurveRow row;
  row.line = table_->lines[place];
  const auto x = read_cell(x_, place), y = read_cell(y_, place);
  const auto time = time_ ? read_cell(*time_, place) : 0.0;
  const bool known = read_sigma(row, place);
  if (!x || !y || !known || !time) return;
  row.time = *time;
  row.x = *x;
  row.y = *y;
  keep(row, place);
}

void CurveReader::keep(const CurveRow& row, std::size_t place) {
  if (row.x > 0.0 || is_travel()) {
    rows_.push_back(row);
  } else if (quantities_.x.name == "frequency") {
    problems_.add(row.line, x_.title, shown(table_->rows[place][x_.index]), "frequency is positive",
                  "correct or delete the row");
  } else {
    ++before_start_;
  }
}

/// Rows before the start do not count, and some must be left.
void CurveReader::check_start() {
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
}

/// Forces are positive in compression, and positions grow as the finger is pressed: forces are
/// larger at larger ones, on the way back, too. What has to be turned about, or whose zero is to be
/// taken off, is told with the lines to write.
void CurveReader::check_direction() {
  if (quantities_.y.name != "force" || rows_.empty()) return;
  double mean_x = 0.0, mean_y = 0.0, together = 0.0;
  for (const CurveRow& row : rows_)
    mean_x += row.x / double(rows_.size()), mean_y += row.y / double(rows_.size());
  for (const CurveRow& row : rows_) together += (row.x - mean_x) * (row.y - mean_y);
  const bool travel = is_travel(), sought = y_.zero.by == ColumnZero::By::fit;
  const bool rises = !travel || rows_.size() < 2 || !(together < 0.0);
  const bool pulls = !(mean_y > 0.0) && !sought && !(travel && rises && zero_shows(rows_));
  const std::string sum = fmt::format("mean of {} rows {:.3g} N", rows_.size(), mean_y);
  const auto turned = [&](const char* quantity) {
    const DescribedColumn* own = columns_.wish(quantity);
    return fmt::format(", sign = {}", own == nullptr ? -1 : -int(own->sign));
  };
  if (pulls && travel && rises)
    problems_.add(0, y_.title, sum,
                  "forces are positive in compression; these rise with the "
                  "position as a press does, from below zero",
                  described("", ", zero = \"first row\""));
  else if (pulls)
    problems_.add(0, y_.title, sum, "forces are positive in compression",
                  "change their sign: " + described("", turned("force")));
  else if (!rises)
    problems_.add(0, x_.title, "",
                  "falls while the force grows, but a position grows as the finger is pressed",
                  "turn it round: " + described(turned("position"), ""));
  const auto negative =
      std::ranges::count_if(rows_, [](const CurveRow& row) { return row.y < 0.0; });
  if (!pulls && !sought && negative > 0)
    result_.notes.push_back(
        fmt::format("{} of {} forces are negative (adhesion, drift or noise) and count as they are",
                    negative, rows_.size()));
}

/// How to say in a description what has to be added to x and y.
std::string CurveReader::described(const std::string& of_x, const std::string& of_y) const {
  const auto line = [&](const Quantity& quantity, const CurveColumn& column,
                        const std::string& more) {
    return fmt::format("{} = {{column = '{}'{}}}\n", quantity.name, column.title, more);
  };
  const std::string x = line(quantities_.x, x_, of_x), y = line(quantities_.y, y_, of_y);
  if (!source_.columns.empty()) return "write " + (of_x.empty() ? y : x);
  return "name a file press.toml in calibration.data in place of " +
         source_.path.filename().string() + ", and write into it\n[[press]]\npath = '" +
         source_.path.filename().string() + "'\n" + x + y + "(studies/manual/your_press.md)";
}

MeasuredFile CurveReader::read_table(const TextTable& table) {
  table_ = &table;
  result_ = {};
  rows_.clear();
  sigma_.reset(), time_.reset();
  data_rows_ = before_start_ = without_error_ = 0;
  choose_pair();
  problems_.throw_if_any();
  choose_sigma();
  if (const auto time = columns_.find(*table_, "time"); time && (is_travel() || wants_time_))
    time_ = columns_.column(*table_, *time, {"time", "s"}, result_.notes);
  problems_.throw_if_any();
  note_unused();
  std::size_t first = 0, end = table.rows.size();
  if (const auto& chosen = source_.rows) {
    if (!((*chosen)[0] >= 1.0 && (*chosen)[1] <= double(end)))
      problems_.add(table.header_line, "rows", fmt::format("{} to {}", (*chosen)[0], (*chosen)[1]),
                    fmt::format("the table has {} rows", end),
                    "count them from 1, without the header");
    problems_.throw_if_any();
    first = std::size_t((*chosen)[0]) - 1, end = std::size_t((*chosen)[1]);
  }
  for (CurveColumn* column : {&x_, &y_})
    if (first < end)
      column->taken_off = zero_in(column->zero, table.number(first, column->index).value_or(0.0),
                                  {column->unit, column->factor});
  for (std::size_t row = first; row < end; ++row) read_row(row);
  problems_.throw_if_any();
  if (without_error_ > 0) {
    for (CurveRow& row : rows_) row.sigma = 0.0;
    result_.notes.push_back(
        fmt::format("{} is not taken as sigma: it is unknown or 0 in {} of {} "
                    "rows",
                    sigma_->title, without_error_, data_rows_));
  }
  check_start();
  problems_.throw_if_any();
  const Abscissa abscissa{result_.x_quantity, x_.unit, std::abs(x_.factor), is_travel()};
  const bool is_press = is_travel() || quantities_ == measured::press;
  const bool in_time = wants_time_ && time_;
  if (is_press) leave_out_odd(rows_, abscissa, true, result_.notes);
  if (is_press && !in_time) put_in_order(rows_, abscissa, result_.notes);
  check_direction();
  problems_.throw_if_any();
  calibration::LoadingHistory course;
  course.rows = rows_.size();
  const double begin = rows_.front().time;
  if (is_travel() || in_time)
    rows_ = loading(std::move(rows_), abscissa, course, result_.notes,
                    in_time ? Holds::kept : Holds::left_out);
  if (is_press && !in_time) leave_out_clipped(rows_, abscissa, result_.notes);
  if (const double noise = noise_of(rows_); noise > 0.0) course.noise = noise;
  const bool told = y_.zero.by != ColumnZero::By::nothing;
  const bool shows = is_travel() && !told && zero_shows(rows_);
  if (shows)
    result_.notes.emplace_back(
        "the rows before touch tell a force that is not zero: the load cell's zero is fitted, "
        "unless calibration.rig tells it");
  if (in_time) {
    TimedCurve timed = curve_in_time(rows_, abscissa, problems_, result_.notes);
    result_.curve = std::move(timed.curve);
    result_.lines = std::move(timed.lines);
  } else {
    result_.curve = curve_of(rows_, abscissa, problems_, result_.notes);
  }
  // A clock's zero is years away: a drift over it would be told from the force's zero by nothing.
  for (double& time : result_.curve.time) time -= begin;
  result_.curve.is_travel = is_travel();
  result_.curve.zero_is_sought = shows || y_.zero.by == ColumnZero::By::fit;
  result_.x_title = x_.title, result_.x_unit = x_.unit;
  if (!result_.curve.x.empty())
    course.rows_per_value = double(rows_.size()) / double(result_.curve.x.size());
  result_.curve.course = std::move(course);
  problems_.throw_if_any();
  if (!in_time)
    for (const double x : result_.curve.x)
      result_.lines.push_back(
          std::ranges::find_if(rows_, [&](const CurveRow& row) { return row.x >= x; })->line);
  for (const std::size_t line : result_.lines)
    result_.rows.push_back(
        std::size_t(std::ranges::lower_bound(table.lines, line) - table.lines.begin()) + 1);
  return std::move(result_);
}

std::vector<MeasuredFile> CurveReader::read() {
  TextTables found = columns_.tables(file_.text);
  for (const Line& comment : found.comments) read_setting(comment);
  if (found.tables.empty() && source_.columns.empty()) columns_.refuse_header(file_.text);
  problems_.throw_if_any();
  const std::size_t count = found.tables.size();
  if (source_.block > count)
    problems_.add(0, "block", std::to_string(source_.block),
                  fmt::format("the file has {} tables", count), "count them from 1");
  problems_.throw_if_any();
  const std::string name = source_.name.empty() ? source_.path.stem().string() : source_.name;
  std::vector<MeasuredFile> files;
  for (std::size_t i = 0; i < count; ++i) {
    if (source_.block > 0 && source_.block != i + 1) continue;
    MeasuredFile file = read_table(found.tables[i]);
    file.settings = settings_;
    file.sha256 = file_.sha256;
    if (files.empty())
      file.notes.insert(file.notes.begin(), found.notes.begin(), found.notes.end());
    file.curve.name = count > 1 ? fmt::format("{}, test {}", name, i + 1) : name;
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

std::vector<MeasuredFile> read_measured(const CurveSource& source,
                                        const std::vector<CurveQuantities>& allowed, bool in_time) {
  return CurveReader(source, allowed, in_time).read();
}

const std::vector<MeasuredFile>& MeasuredFiles::of(const CurveSource& source,
                                                   const std::vector<CurveQuantities>& allowed,
                                                   bool in_time) {
  const auto known = std::ranges::find_if(read_, [&](const Read& read) {
    return read.source == source && read.allowed == allowed && read.in_time == in_time;
  });
  if (known != read_.end()) return known->files;
  read_.push_back({source, allowed, in_time, read_measured(source, allowed, in_time)});
  return read_.back().files;
}

}  // namespace fingertip::studies::inline measurements
