/// Measured curves as those of a fit: their presses, rigs, units and what is wrong with them.
#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include "calibration/statistics/curve_residuals.h"
#include "meshes/base/files.h"
#include "studies/files/shown_units.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/travel.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/measurements/curve_file.h"
#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::Curve;

namespace {

/// What is said of several files alike is said once: "a, b, c: note".
class NotesOnFiles {
 public:
  void add(const std::string& name, const std::string& note) {
    const auto same = std::ranges::find(notes_, note, &Note::text);
    if (same == notes_.end())
      notes_.push_back({note, name});
    else
      same->names += ", " + name;
  }
  void tell(std::vector<std::string>& notes) const {
    for (const Note& note : notes_) notes.push_back(note.names + ": " + note.text);
  }

 private:
  struct Note {
    std::string text, names;
  };
  std::vector<Note> notes_;
};

std::vector<CurveQuantities> quantities_of(CalibrationProblem problem) {
  switch (problem) {
    case CalibrationProblem::damping:
      return {measured::vibration, measured::creep, measured::relaxation};
    default: return {measured::press, measured::travel};
  }
}

CurveKind kind_of(const MeasuredFile& file, const CalibrationSettings& settings) {
  if (file.x_quantity == "frequency") return CurveKind::loss_factor;
  if (file.y_quantity == "creep") return CurveKind::creep;
  if (file.x_quantity == "time") return CurveKind::ramp;
  return press_kind(settings);
}

std::string place_in(const std::filesystem::path& file, std::size_t line) {
  return file.string() + ":" + std::to_string(line);
}

/// What is wrong with a press that a measured file describes stands in that file.
ConfigError placed_in(const std::filesystem::path& path, const MeasuredFile& file,
                      const ConfigError& error) {
  std::vector<meshes::Violation> problems = error.violations();
  for (meshes::Violation& problem : problems) {
    const auto setting = std::ranges::find(file.settings, problem.key, &MeasuredSetting::key);
    if (setting != file.settings.end()) problem.place = place_in(path, setting->line);
    // Increasing indentations: the last one is what goes too deep.
    if (problem.key == "press.samples" || problem.key == "press.depth")
      problem.place = place_in(path, file.lines.back());
    // Nobody has set the rig: it is the file that does not fit.
    if (problem.key == "calibration.rig" && problem.place == "default")
      problem.place = path.string();
  }
  return ConfigError(std::move(problems));
}

/// Where a file has no column time the speed of the press tells it.
Curve with_times(const LoadedConfig& own, Curve curve) {
  if (!curve.time.empty()) return curve;
  if (!own.entries.at("press.speed").given)
    throw own.locate(
        {{"calibration.data", curve.name, "forces of a rubber that relaxes depend on time",
          "give the file its column time, or press.speed, at which it was pressed"}});
  for (const double x : curve.x)
    curve.time.push_back((x - curve.x.front()) / own.config.press.protocol.speed);
  return curve;
}

/// What is pressed through the finger has its length in another unit than the file says.
void check_depth(const std::filesystem::path& path, const MeasuredFile& file, double depth,
                 const meshes::Geometry& finger) {
  if (depth < finger.thickness()) return;
  const ShownUnit& length = shown_units().length;
  FileProblems problems(path);
  problems.add(file.lines.back(), file.x_title, "",
               "the finger is pressed by " + length.text(depth) + ", but its rubber is " +
                   length.text(finger.thickness()) + " thick",
               "where the numbers are mm, say so in place of " + file.x_unit +
                   ", in the title or in a TOML file (unit = \"mm\"); else correct [geometry]");
  problems.throw_if_any();
}

/// Files that were measured, once each, with what tells them apart from another of the name.
void add_provenance(FitSetup& fit, const std::string& what, const std::filesystem::path& path,
                    const std::string& sha256) {
  const std::string file = what + path.filename().string() + " (SHA-256 " + sha256 + ")";
  std::string& all = fit.input.provenance;
  if (all.empty())
    all = "measured data: " + file;
  else if (all.find(file) == std::string::npos)
    all += ", " + file;
}

/// Presses of a rigid blank, by the machine that they tell of.
using Blanks = std::map<std::string, std::vector<CurveSource>>;

FitCurve& add_measured_press(FitSetup& fit, const LoadedConfig& loaded, const CurveSource& source,
                             const MeasuredFile& file, CurveKind kind,
                             const std::vector<std::string>& further, const Blanks& blanks) {
  std::vector<std::string> condition;
  for (const MeasuredSetting& setting : file.settings) condition.push_back(setting.assignment());
  condition.insert(condition.end(), further.begin(), further.end());
  std::vector<double> depths = file.curve.x;
  std::optional<Travel> travel;
  if (kind == CurveKind::press || kind == CurveKind::continuum) {
    Config own = under(loaded, condition, {"press.mode=static"}).config;
    if (file.curve.is_travel) {
      const auto known = blanks.find(own.calibration.machine);
      const auto rigid = blanks_of(
          own.calibration.rig, known == blanks.end() ? std::vector<CurveSource>{} : known->second);
      own.calibration.rig = with_blank(own.calibration.rig, rigid, *fit.files, fit.notes);
      for (const CurveSource& blank : rigid)
        add_provenance(fit, "blank ", blank.path,
                       fit.files->of(blank, {measured::travel}).front().sha256);
      travel = travel_of(file.curve, own.calibration);
    }
    check_depth(source.path, file, travel ? travel->reach : std::ranges::max(depths),
                own.press.geometry);
    if (travel) depths = travel->depths;
  }
  const bool relaxes = !fit.input.branches.empty();
  if (relaxes && !travel) depths = calibration::depths_for_rig(*std::ranges::max_element(depths));
  const bool ramp = kind == CurveKind::ramp;
  const LoadedConfig own =
      ramp ? under(loaded, condition, {"press.mode=static"})
           : under(loaded, condition, {"press.mode=static", samples_setting(depths)});
  FitCurve& added = add_press(fit, own, kind, relaxes ? with_times(own, file.curve) : file.curve);
  added.travel = std::move(travel);
  fit.contact_known = fit.contact_known && own.entries.at("press.contact").given;
  fit.settings.push_back(std::move(condition));
  return added;
}

std::string with_unit(const std::string& quantity) {
  for (const CurveQuantities& pair : {measured::press, measured::travel, measured::vibration,
                                      measured::creep, measured::relaxation})
    for (const Quantity& axis : {pair.x, pair.y})
      if (axis.name == quantity) return quantity + " [" + std::string(axis.unit) + "]";
  return quantity;
}

/// What a fit refuses of its data as a whole is said of the files, before anything is computed.
void check_curves(const LoadedConfig& loaded, const FitInput& input,
                  const std::vector<std::filesystem::path>& files) {
  try {
    calibration::check_curve_fit(curves_of(input), input.options);
  } catch (const meshes::InvalidInput& error) {
    std::vector<meshes::Violation> problems;
    for (const meshes::Violation& violation : error.violations()) {
      std::string places;
      for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string own = "curves[" + std::to_string(i) + "]";
        if (violation.key.starts_with("curves[") && !violation.key.starts_with(own)) continue;
        places += (places.empty() ? "" : ", ") + files[i].string();
      }
      const bool of_data = violation.key.starts_with("curves");
      meshes::Violation problem = loaded.locate({violation}).violations().front();
      if (of_data) {
        problem.place = places;
        problem.key = violation.key.ends_with(".sigma") ? "sigma" : "calibration.data";
      }
      problems.push_back(std::move(problem));
    }
    throw ConfigError(std::move(problems));
  }
}

/// More than a press behind a rig answers at.
bool has_many_rows(const FitCurve& curve) {
  return curve.x.size() > calibration::depths_for_rig(curve.x.back()).size();
}

/// Travels have their rigs. Indentations of the same fit, such of many rows and those of a press
/// whose further rows are held back are travels of a rig that is known.
void add_rigs(FitSetup& fit, const LoadedConfig& loaded) {
  FitInput& input = fit.input;
  const auto travels = [](const FitCurve& curve) { return curve.travel.has_value(); };
  const auto asks_rig = [](const FitCurve& curve) {
    // Of a continuum each row would be a sample that meets the tolerance; a lattice passes them on
    // its way.
    const bool costs = curve.kind == CurveKind::continuum && has_many_rows(curve);
    return curve.zero_is_sought || costs || curve.continues;
  };
  if (std::ranges::none_of(input.curves, travels)) {
    if (loaded.entries.at("calibration.rig").given)
      throw refused(loaded, "calibration.rig", "", "no file has the column position",
                    "name the travel of the machine so, or leave the rig out");
    if (input.branches.empty() && std::ranges::none_of(input.curves, asks_rig)) return;
  }
  CalibrationSettings rigid;
  // An indentation says that all are zero, but for a load cell whose rows tell its own.
  rigid.rig.touch_offset = rigid.rig.compliance = rigid.rig.drift = {.given = true};
  for (FitCurve& curve : input.curves) {
    if (curve.travel) continue;
    rigid.rig.force_offset.given = !curve.zero_is_sought;
    curve.travel = travel_of(curve, rigid);
    // A machine of its own.
    curve.travel->machine = "indentation of " + curve.name;
    if (!curve.zero_is_sought && !has_many_rows(curve) && curve.x.size() > 1)
      curve.travel->depths = curve.x;
  }
  share_depths(input);
  try {
    free_rigs(input);
  } catch (const meshes::InvalidInput& error) {
    throw loaded.locate(error.violations());
  }
}

void add_measured_curve(FitSetup& fit, const LoadedConfig& loaded, const CurveSource& source,
                        MeasuredFile file, const std::string& condition, const Blanks& blanks,
                        NotesOnFiles& notes) {
  const CalibrationSettings& settings = loaded.config.calibration;
  const CurveKind kind = kind_of(file, settings);
  const bool press = is_press(kind);
  if (!fit.input.curves.empty() && press != has_presses(fit.input))
    throw refused(loaded, "calibration.data", source.path.string(),
                  "forces of presses and other tests do not go into one fit",
                  "fit them one by one");
  file.curve.x_quantity = with_unit(file.x_quantity);
  file.curve.y_quantity = with_unit(file.y_quantity);
  const RowsOfValues rows{source.path.string(), source.rows ? std::size_t((*source.rows)[0]) : 1,
                          file.rows};
  for (const std::string& note : file.notes) notes.add(file.curve.name, note);
  if (press) {
    std::vector<std::string> sets = settings_in(source.condition);
    std::ranges::copy(settings_in(condition), std::back_inserter(sets));
    try {
      add_measured_press(fit, loaded, source, file, kind, sets, blanks).rows = rows;
    } catch (const meshes::InvalidInput& error) {
      throw placed_in(source.path, file, loaded.locate(error.violations()));
    }
    return;
  }
  if (!condition.empty() || !source.condition.empty())
    throw refused(loaded, "calibration.conditions", "",
                  "conditions are those of presses; a test on a coupon has none", "leave them out");
  add_curve(fit.input, kind, std::move(file.curve), "").rows = rows;
}

/// A table of a file that has become a curve.
struct TableRead {
  const CurveSource* source = nullptr;
  std::size_t table = 0;  ///< of those that are read of it
};

/// Further rows of a table that is fitted are the same press.
bool continues(const TableRead& held, const TableRead& fitted) {
  const CurveSource &rows = *held.source, &before = *fitted.source;
  return !before.predicted && rows.rows && before.rows && rows.path == before.path &&
         rows.block == before.block && rows.condition == before.condition &&
         held.table == fitted.table;
}

void hold_back_last(FitSetup& fit, const LoadedConfig& loaded, const std::vector<TableRead>& read) {
  FitCurve& curve = fit.input.curves.back();
  if (!is_press(curve.kind) || curve.kind == CurveKind::ramp)
    throw refused(loaded, "calibration.data", curve.name, "only presses are held back",
                  "leave use out");
  ++fit.held_back;
  const auto before = std::ranges::find_if(
      read, [&](const TableRead& each) { return continues(read.back(), each); });
  if (before == read.end()) return;
  if (!fit.input.branches.empty())
    throw refused(loaded, "calibration.data", curve.name,
                  "a rubber that relaxes remembers the rows before those that are held back",
                  "hold a whole file back");
  curve.continues = std::size_t(before - read.begin());
}

}  // namespace

void add_measured_curves(FitSetup& fit, const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  if (settings.data.empty())
    throw refused(loaded, "calibration.data", "[]",
                  "the problem " + std::string(name(settings.problem)) + " needs measured data",
                  "name one CSV file per curve");
  if (!settings.conditions.empty() && settings.conditions.size() != settings.data.size())
    throw refused(loaded, "calibration.conditions", "",
                  "there must be one per file of calibration.data, or none", "complete the list");
  std::vector<std::pair<CurveSource, std::string>> sources;
  Blanks blanks;
  for (std::size_t i = 0; i < settings.data.size(); ++i)
    for (CurveSource& source : curve_sources(settings.data[i])) {
      const std::string condition = settings.conditions.empty() ? "" : settings.conditions[i];
      if (!source.rigid) {
        sources.emplace_back(std::move(source), condition);
        continue;
      }
      const auto own = under(loaded, settings_in(source.condition + ";" + condition), {});
      blanks[own.config.calibration.machine].push_back(std::move(source));
    }
  const auto predicted = [](const auto& each) { return each.first.predicted; };
  std::ranges::stable_partition(sources, std::not_fn(predicted));
  if (!sources.empty() && std::ranges::all_of(sources, predicted))
    throw refused(loaded, "calibration.data", "",
                  "every press is held back (use = \"predict\"), and none is left to be fitted",
                  "say use = \"fit\" of one");
  NotesOnFiles notes;
  std::vector<std::filesystem::path> files;
  std::vector<TableRead> read;
  for (const auto& [source, condition] : sources) {
    std::size_t table = 0;
    for (const MeasuredFile& file :
         fit.files->of(source, quantities_of(settings.problem), !fit.input.branches.empty())) {
      add_provenance(fit, source.predicted ? "held back " : "", source.path, file.sha256);
      add_measured_curve(fit, loaded, source, file, condition, blanks, notes);
      files.push_back(source.path);
      read.push_back({&source, table++});
      if (source.predicted) hold_back_last(fit, loaded, read);
    }
  }
  notes.tell(fit.notes);
  add_rigs(fit, loaded);
  check_curves(loaded, fit.input, files);
}

}  // namespace fingertip::studies::inline fits::inline setup
