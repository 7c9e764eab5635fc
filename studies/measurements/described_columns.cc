/// The columns of a text table that a description names.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "studies/measurements/text_table.h"

namespace fingertip::studies::inline measurements {

DescribedColumns::DescribedColumns(std::vector<std::string> columns)
    : columns_(std::move(columns)) {}

bool DescribedColumns::all_numbered() const {
  return std::ranges::all_of(columns_, [](const std::string& c) { return c.starts_with('#'); });
}

std::vector<std::size_t> DescribedColumns::operator()(const std::vector<TableTitle>& titles,
                                                      std::size_t line) {
  std::vector<std::size_t> found;
  std::string missing;
  bool twice = false;
  for (const std::string& column : columns_) {
    std::vector<std::size_t> places;
    if (column.starts_with('#')) {
      const std::size_t place = std::stoul(column.substr(1));
      if (place <= titles.size()) places.push_back(place - 1);
    } else {
      const std::string plain = title_of(column).name;
      for (const bool as_written : {true, false})
        for (std::size_t i = 0; i < titles.size() && (as_written || places.size() != 1); ++i)
          if (as_written ? titles[i].written == column : titles[i].name == plain)
            places.push_back(i);
    }
    std::ranges::sort(places);
    const auto same = std::ranges::unique(places);
    places.erase(same.begin(), same.end());
    if (places.size() == 1)
      found.push_back(places.front());
    else if (missing.empty())
      missing = column, twice = places.size() > 1;
  }
  if (missing.empty()) return found;
  const bool closer = found.size() + (twice ? 1 : 0) > most_ || titles_.empty();
  if (!closer) return {};
  most_ = found.size() + (twice ? 1 : 0);
  line_ = line, missing_ = missing, twice_ = twice;
  titles_.clear();
  for (const TableTitle& title : titles) titles_ += (titles_.empty() ? "" : ", ") + title.written;
  return {};
}

void DescribedColumns::refuse(FileProblems& problems, const std::string& remedy) const {
  const bool number = missing_.starts_with('#');
  problems.add(line_, "", "",
               number ? fmt::format("column {} is missing or holds no number", missing_.substr(1))
               : twice_
                   ? fmt::format("the column '{}' is there twice", missing_)
                   : fmt::format("the column '{}' is missing: the line that comes closest "
                                 "is '{}'",
                                 missing_.empty() ? columns_.front() : missing_, shown(titles_)),
               twice_ ? "give its number" : remedy);
}

}  // namespace fingertip::studies::inline measurements
