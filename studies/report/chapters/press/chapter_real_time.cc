/// A press that was to keep up with time: what was chosen on that machine, and what it costs.
#include <fmt/format.h>

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

Table error_table(const TransferObstacleEntry& errors) {
  Table table{{"Force error"}, true};
  for (const double depth : errors.indentation)
    table.header.emplace_back(shown_units().length.text(depth));
  for (const TransferModelEntry& model : errors.models) {
    table.rows.push_back({model.model});
    for (const double error : model.error) table.rows.back().push_back(error_cell(error));
  }
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
  chapter["errors"] = record.force_error_of;
  chapter.tables["trials"] = trial_table(record);
  chapter["unknown_errors"] = !record.force_error;
  if (record.force_error) chapter.tables["errors"] = error_table(*record.force_error);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
