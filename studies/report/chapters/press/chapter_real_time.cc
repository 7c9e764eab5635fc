/// A press that was to keep up with time: what was chosen on that machine, and what it costs.
#include <fmt/format.h>

#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

Table trial_table(const RealTimeRecord& record) {
  Table table{heads({"Spacing", "Step", "Threads", "Real-time factor"})};
  for (const PaceTrialEntry& trial : record.trials)
    table.rows.push_back({shown_units().length.text(trial.spacing), with_prefix(trial.step, "s"),
                          count(double(trial.threads)), number(trial.real_time_factor, 3)});
  return table;
}

}  // namespace

Chapter real_time_chapter(const RealTimeRecord& record) {
  if (record.trials.empty()) return {};
  ChapterData chapter("real_time");
  chapter["spacing"] = shown_units().length.text(record.spacing);
  chapter["asked"] =
      record.spacing_asked == record.spacing ? "" : shown_units().length.text(record.spacing_asked);
  chapter["integrator"] = record.integrator;
  chapter["step"] = with_prefix(record.step, "s");
  chapter["threads"] = fmt::format("{} thread{}", record.threads, record.threads == 1 ? "" : "s");
  chapter["expected"] = number(record.expected_factor, 3);
  chapter["tried"] = record.tried;
  chapter["slowest"] = number(record.slowest_factor, 3);
  chapter["whole"] = number(record.whole_factor, 3);
  chapter.tables["trials"] = trial_table(record);
  const ForceErrorEntry error = record.force_error.value_or(ForceErrorEntry());
  chapter["error"] = error.statement;
  chapter["largest"] =
      std::isnan(error.largest)
          ? ""
          : fmt::format("{:.2g} % at {}", 100.0 * error.largest, length(error.indentation));
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
