#include "studies/measurements/curve_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <utility>

#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline measurements {

namespace {

using std::string_view;

/// What people and machines call the same, in the languages that machines speak; in small letters
/// without accents, with _ for blanks, and blanks on either side.
constexpr std::pair<string_view, string_view> other_names[] = {
    {"force",
     " normal_force standard_force compressive_force compression_force load compressive_load "
     "axial_force axial_load tensile_load tensile_force test_force load_cell load_on_sample fz "
     "x_force y_force xforce yforce "
     "kraft standardkraft prufkraft pruefkraft normalkraft druckkraft zugkraft axialkraft "
     "force_standard force_normale force_axiale charge effort effort_normal "
     "fuerza fuerza_estandar fuerza_normal fuerza_axial carga "
     "forza forza_standard forza_normale forza_assiale carico "
     "forca forca_normal forca_padrao forca_axial forca_de_compressao carga_de_compressao "
     "sila sila_standardowa sila_normalna sila_sciskajaca obciazenie nacisk "
     "kuvvet standart_kuvvet normal_kuvvet basma_kuvveti yuk basma_yuku "
     "kracht standaardkracht normaalkracht drukkracht belasting last tryckkraft belastning "
     "力 试验力 载荷 负荷 负载 压缩力 荷重 試験力 圧縮荷重 하중 힘 시험력 "},
    {"position",
     " travel standard_travel extension compressive_extension compression stroke crosshead "
     "crosshead_travel crosshead_position crosshead_displacement machine_extension displacement "
     "compressive_displacement tensile_extension tensile_displacement axial_displacement "
     "axial_disp "
     "axial_position digital_position actuator_position corrected_position "
     "absolute_crosshead_travel "
     "deflection disp disp. displ. xdisplacement ydisplacement distance "
     "standardweg weg traversenweg verfahrweg maschinenweg traversenposition hub verschiebung "
     "verformung deplacement deplacement_standard deplacement_traverse course_traverse allongement "
     "allongement_standard course desplazamiento alargamiento recorrido carrera posicion "
     "spostamento spostamento_traversa allungamento corsa corsa_traversa posizione "
     "deslocamento deslocamento_padrao extensao curso percurso alongamento posicao "
     "przemieszczenie droga droga_standardowa wydluzenie skok polozenie pozycja ugiecie "
     "yer_degistirme deplasman uzama strok hareket konum pozisyon "
     "verplaatsing standaardweg verlenging slag positie forskjutning vag standardvag forlangning "
     "位移 行程 变形 横梁位移 伸长 ストローク 変位 クロスヘッド変位 伸び 변위 스트로크 "},
    {"indentation",
     " indentation_depth penetration penetration_depth displacement_into_surface "
     "eindringtiefe eindruckung eindringweg eindrucktiefe enfoncement profondeur_d'enfoncement "
     "indentacion penetracion profundidad_de_indentacion indentazione penetrazione "
     "indentacao penetracao wglebienie glebokosc_wnikania girinti batma_derinligi "
     "indringdiepte intrangningsdjup 压入深度 押込み深さ 押し込み深さ 압입깊이 "},
    {"time",
     " test_time elapsed_time total_time running_time timestamp "
     "zeit prufzeit pruefzeit testzeit messzeit temps temps_d'essai "
     "tiempo tiempo_de_ensayo tempo tempo_di_prova tempo_de_ensaio czas czas_badania "
     "zaman sure test_suresi tijd tid 时间 试验时间 時間 経過時間 시간 "}};

/// Small letters without accents, of which titles of several languages are made.
std::string folded(string_view name) {
  constexpr std::pair<string_view, string_view> letters[] = {
      {"ÀÁÂÃÄÅàáâãäåĄą", "a"}, {"ÈÉÊËèéêëĘęĚě", "e"}, {"ÌÍÎÏìíîïİı", "i"}, {"ÒÓÔÕÖòóôõöŐő", "o"},
      {"ÙÚÛÜùúûüŮůŰű", "u"},   {"ÑñŃńŇň", "n"},       {"ÇçĆćČč", "c"},     {"Łł", "l"},
      {"ŚśŞşŠš", "s"},         {"ŹźŻżŽž", "z"},       {"Ğğ", "g"},         {"Řř", "r"}};
  std::string text;
  while (!name.empty()) {
    std::size_t length = 1;
    string_view letter = name.substr(0, 1);
    for (const auto& [accented, plain] : letters)
      for (std::size_t at = 0; at < accented.size(); at += 2)  // two bytes each
        if (name.starts_with(accented.substr(at, 2))) letter = plain, length = 2;
    text += letter;
    name.remove_prefix(length);
  }
  return text;
}

/// Whether a title stands for a quantity.
bool is_called(const TableTitle& title, string_view quantity) {
  const std::string name = folded(title.name);
  if (name == quantity) return true;
  const auto known =
      std::ranges::find(other_names, quantity, [](const auto& each) { return each.first; });
  return known != std::end(other_names) &&
         known->second.find(' ' + name + ' ') != string_view::npos;
}

/// The column that a quantity stands in: under its own name, else the first of another; none: npos.
std::size_t place_of(const std::vector<TableTitle>& titles, string_view quantity) {
  auto found = std::ranges::find(titles, quantity, &TableTitle::name);
  if (found == titles.end())
    found = std::ranges::find_if(
        titles, [&](const TableTitle& title) { return is_called(title, quantity); });
  return found == titles.end() ? string_view::npos : std::size_t(found - titles.begin());
}

}  // namespace

bool names_a_length(const TableTitle& title) {
  constexpr string_view or_a_strain =
      " extension compressive_extension compression tensile_extension deflection verformung "
      "allongement allongement_standard alargamiento allungamento extensao alongamento wydluzenie "
      "uzama verlenging forlangning 变形 伸长 伸び ";
  return is_called(title, "position") &&
         or_a_strain.find(' ' + folded(title.name) + ' ') == string_view::npos;
}

const DescribedColumn* CurveColumns::wish(string_view quantity) const {
  const auto found = std::ranges::find(source_.columns, quantity, &DescribedColumn::quantity);
  return found == source_.columns.end() ? nullptr : &*found;
}

std::optional<std::size_t> CurveColumns::find(const TextTable& table, string_view name) {
  const auto& titles = table.titles;
  if (!source_.columns.empty()) {
    const DescribedColumn* own = wish(name);
    if (own == nullptr) return {};
    return table.needed[std::size_t(own - source_.columns.data())];
  }
  const std::size_t first = place_of(titles, name);
  if (first == string_view::npos) return {};
  // Which of two positions is taken is told with those that are not; of two forces one may be
  // another cell's.
  for (std::size_t next = 0; next < titles.size(); ++next) {
    const bool same =
        name == "force" ? is_called(titles[next], name) : titles[next].name == titles[first].name;
    if (next == first || !same) continue;
    problems_.add(table.header_line, titles[next].written, "",
                  "stands for the same as '" + titles[first].written + "', column " +
                      std::to_string(first + 1),
                  fmt::format("leave one of the two out, or choose by a TOML file in place of this "
                              "one: [[press]], {} = {{column = {}}} or {{column = {}}}",
                              name, first + 1, next + 1));
    break;
  }
  return first;
}

CurveColumn CurveColumns::column(const TextTable& table, std::size_t index,
                                 const Quantity& quantity, std::vector<std::string>& notes) {
  const TableTitle& title = table.titles[index];
  const std::string name(quantity.name), si(quantity.unit);
  const DescribedColumn* own = wish(quantity.name);
  CurveColumn result{index, title.written, "", 1.0, si == "s"};
  if (own != nullptr) result.zero = own->zero;
  const std::string remedy = "name the column for instance '" + name + " [" + si + "]'";
  const bool told = own != nullptr && !own->unit.empty();
  const bool clock =
      result.is_clock && !told && !table.rows.empty() &&
      (!title.unit || title.unit->find(':') != std::string::npos || title.unit->empty());
  if (clock) {
    result.unit = "s";  // as h:min:s it was read
    return result;
  }
  const DescribedColumn undescribed{name, title.written, ""};
  if (const auto unit = unit_of(own != nullptr ? own : &undescribed, title, si, table.header_line,
                                remedy, problems_, notes)) {
    result.unit = unit->unit;
    result.factor = unit->factor;
  } else if (!title.unit || title.unit->empty() || si == "1") {
    problems_.add(table.header_line, title.written, "",
                  si == "1" ? "a number without dimension is marked [1] or [%]"
                            : "the unit is missing: it stands in brackets at the end",
                  remedy);
  }
  return result;
}

namespace {

/// Where the numbers of a file begin, and the line that stands for their titles.
struct Beginning {
  std::optional<Line> titles, row;
};

/// How many cells of a line are numbers, with any separator and any decimals.
std::ptrdiff_t numbers_in(string_view line) {
  std::ptrdiff_t most = 0;
  std::vector<string_view> cells;
  for (const char separator : {';', '\t', ',', ' '}) {
    split(line, separator, cells);
    most = std::max(most, std::ranges::count_if(cells, [](string_view cell) {
                      std::string text(cell);
                      std::ranges::replace(text, ',', '.');
                      return number_in(text).has_value() || time_in(cell).has_value();
                    }));
  }
  return most;
}

/// The last line above the first row that has a word; a row of units leaves the one above.
Beginning beginning_of(string_view text) {
  Beginning found;
  Lines lines(text);
  const auto has_word = [](string_view line) {
    std::size_t letters = 0;
    for (const char c : line) {
      letters =
          std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0 ? letters + 1 : 0;
      if (letters >= 4) return true;
    }
    return false;
  };
  while (const auto line = lines.next()) {
    if (trimmed(line->text).front() == '#') continue;
    if (numbers_in(line->text) >= 2) {
      found.row = line;
      break;
    }
    if (!found.titles || has_word(line->text)) found.titles = line;
  }
  return found;
}

}  // namespace

void CurveColumns::refuse_header(string_view text) {
  const Beginning found = beginning_of(text);
  const std::optional<Line> first = found.titles ? found.titles : found.row;
  if (!first) {
    problems_.add(0, "", "", "the file holds no table",
                  "write a header such as 'indentation [mm], force [mN]' and rows of numbers");
    return;
  }
  std::string pairs;
  for (const CurveQuantities& pair : allowed_)
    pairs += fmt::format("{}'{} [{}]' and '{} [{}]'", pairs.empty() ? "" : ", or ", pair.x.name,
                         pair.x.unit, pair.y.name, pair.y.unit);
  char separator = ',';
  for (const char known : {'\t', ',', ';'})
    if (first->text.find(known) != first->text.npos) separator = known;
  std::vector<string_view> cells;
  split(first->text, separator, cells);
  constexpr std::size_t enough = 8;
  std::string header;
  for (std::size_t i = 0; i < std::min(enough, cells.size()); ++i)
    header += (i > 0 ? ", " : "") + shown(cells[i]);
  if (cells.size() > enough) header += fmt::format(" and {} more", cells.size() - enough);
  problems_.add(
      first->number, "", "",
      (!found.titles ? "the header is missing: the first line is '"
                     : "the header has no pair of columns that can be used here, nor has any other "
                       "line: " +
                           (found.row ? fmt::format("above the numbers, which begin in line {}, "
                                                    "stands '",
                                                    found.row->number)
                                      : "no numbers follow, it is '")) +
          header + "'",
      "name the columns in the first line, separated by comma, semicolon or tab: " + pairs +
          ", in any unit, or say which they are in a TOML file in place of this "
          "one: [[press]], force = {column = 3, unit = \"N\"} (studies/manual/files.md)");
}

TextTables CurveColumns::tables(string_view text) {
  TableLayout layout = source_.layout;
  if (!source_.columns.empty()) {
    std::vector<std::string> columns;
    for (const DescribedColumn& each : source_.columns) columns.push_back(each.column);
    DescribedColumns choose(columns);
    if (choose.all_numbered()) layout.has_names = false;
    TextTables found = tables_in(text, layout, std::ref(choose), problems_);
    if (found.tables.empty()) choose.refuse(problems_, "compare the file with its description");
    return found;
  }
  const auto choose = [this](const std::vector<TableTitle>& titles, std::size_t) {
    std::vector<std::size_t> needed;
    const auto place = [&](string_view quantity) {
      return std::min(place_of(titles, quantity), titles.size());
    };
    for (const CurveQuantities& pair : allowed_) {
      needed = {place(pair.x.name), place(pair.y.name)};
      if (std::ranges::max(needed) < titles.size()) break;
      needed.clear();
    }
    if (needed.empty()) return needed;
    for (const char* further : {"sigma", "force_error", "time"})
      if (const std::size_t at = place(further); at < titles.size()) needed.push_back(at);
    return needed;
  };
  return tables_in(text, layout, choose, problems_);
}

}  // namespace fingertip::studies::inline measurements
