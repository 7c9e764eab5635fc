/// The answer, the verdict table and the criteria, as page and as text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/materials_chapter.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/report.h"
#include "studies/report/report_parts.h"
#include "studies/report/results/grasp_run.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report {
namespace {

double deviation(double value, double target) {
  return value / target - 1.0;
}

/// Index of the depth with the smallest (sign -1) or largest (sign 1) finite force error; the
/// number of depths when there is none.
std::size_t extreme(const ModelData& model, double sign) {
  const std::vector<double>& errors = model.force_error;
  std::size_t found = errors.size();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    if (found == errors.size() || sign * errors[i] > sign * errors[found]) found = i;
  }
  return found;
}

/// Largest |force error|; infinite without one, so that such models come last.
double largest_error(const ModelData& model) {
  double largest = -1.0;
  for (double error : model.force_error) largest = std::fmax(largest, std::abs(error));
  return largest < 0.0 ? std::numeric_limits<double>::infinity() : largest;
}

/// How far a model's force is off: the least and the greatest error, or one at all depths.
Words description_of(const RunData& run, const ModelData& model) {
  Words words;
  words["model"] = model.name;
  for (const char* name : {"error", "least", "least_depth", "most", "most_depth"}) words[name] = "";
  const std::vector<double>& errors = model.force_error;
  const std::size_t least = extreme(model, -1.0), most = extreme(model, 1.0);
  words["unknown"] = least == errors.size();
  if (least == errors.size()) return words;
  if (errors[most] - errors[least] < 5e-4) {
    words["error"] = percent(errors[most]);
    return words;
  }
  words["least"] = percent(errors[least]);
  words["least_depth"] = length(run.depths[least]);
  words["most"] = percent(errors[most]);
  words["most_depth"] = length(run.depths[most]);
  return words;
}

std::string criteria_sentence(const RunData& run) {
  const std::vector<CriterionEntry>& criteria = run.summary.criteria;
  if (criteria.empty()) return "";
  std::vector<std::string> failed;
  for (const CriterionEntry& criterion : criteria)
    if (!criterion.passed) failed.push_back(criterion.name);
  Words words;
  words["criteria"] = std::to_string(criteria.size());
  words["single"] = criteria.size() == 1;
  words["count"] = std::to_string(failed.size());
  words["one"] = failed.size() == 1;
  words["failed"] = enumerate(failed);
  return sentences("answer_criteria", words);
}

struct Constant {
  const char* label;
  const char* ascii;
  double Moduli::*value;
  double Target::*target;
};
constexpr Constant constants_shown[] = {
    {"E₁₀₀", "E_100", &Moduli::E_100, &Target::youngs_modulus},
    {"E₁₁₀", "E_110", &Moduli::E_110, &Target::youngs_modulus},
    {"E₁₁₁", "E_111", &Moduli::E_111, &Target::youngs_modulus},
    {"G", "G", &Moduli::G, &Target::shear_modulus},
    {"ν₁₀₀", "nu_100", &Moduli::nu_100, &Target::poissons_ratio},
    {"K", "K", &Moduli::K, &Target::bulk_modulus},
};

bool is_ratio(const Constant& constant) {
  return constant.value == &Moduli::nu_100;
}

Cell constant_cell(const Constant& constant, double value, double target) {
  const double error = deviation(value, target);
  const double shown = is_ratio(constant) ? value : shown_units().stress(value);
  return {number(shown), percent(error), grade(error)};
}

/// Shown number, and below it what it is in the other system: the paper gives its rubber in gf and
/// cm.
Cell in_both(double value, ShownUnit ShownUnits::*quantity) {
  const bool paper = shown_units().system == UnitSystem::paper;
  const ShownUnits& other = units_of(paper ? UnitSystem::si : UnitSystem::paper);
  return plain(with_unit(value, shown_units().*quantity), with_unit(value, other.*quantity));
}

Cell target_cell(const Constant& constant, double target) {
  if (is_ratio(constant)) return {number(target), "", Grade::none};
  return in_both(target, &ShownUnits::stress);
}

/// A row per model below the target's.
Table model_table(const RunData& run, std::vector<Cell> header, std::vector<Cell> target,
                  const std::function<void(const ModelData&, std::vector<Cell>&)>& fill) {
  Table table;
  table.graded = true;
  table.header = std::move(header);
  table.rows.push_back(std::move(target));
  for (const ModelData& model : run.models) {
    table.rows.push_back(
        {plain(model_label(model.name), model.status == "ok" ? "" : model.status)});
    fill(model, table.rows.back());
  }
  return table;
}

Table constants_table(const RunData& run) {
  std::vector<Cell> header{plain("Model")}, target{plain("Target", "rubber, continuum")};
  for (const Constant& constant : constants_shown) {
    header.push_back(plain(constant.label));
    target.push_back(target_cell(constant, run.target.*constant.target));
  }
  header.push_back(plain("Real time", "factor"));
  target.push_back(plain(""));
  return model_table(
      run, std::move(header), std::move(target), [&](const ModelData& model, auto& row) {
        for (const Constant& constant : constants_shown)
          row.push_back(
              constant_cell(constant, model.moduli.*constant.value, run.target.*constant.target));
        row.push_back(plain(number(model.real_time_factor, 3)));
      });
}

Table force_table(const RunData& run) {
  std::vector<Cell> header{plain("Model")}, target{plain("Continuum")};
  for (const double depth : run.depths) {
    const double f = force_at(run.reference, depth);
    header.push_back(plain("F", shown_units().length.text(depth)));
    target.push_back(std::isfinite(f) ? in_both(f, &ShownUnits::force) : plain("–"));
  }
  header.push_back(plain("F", "rel. L²"));
  target.push_back(plain(""));
  return model_table(
      run, std::move(header), std::move(target), [](const ModelData& model, auto& row) {
        for (const double error : model.force_error)
          row.push_back({percent(error), "", grade(error)});
        row.push_back({percent_magnitude(model.l2_error), "", grade(model.l2_error)});
      });
}

Table criteria_table(const RunData& run) {
  Table table;
  table.header = {{"Criterion", "", Grade::none},
                  {"Value", "", Grade::none},
                  {"Limit", "", Grade::none},
                  {"Result", "", Grade::none}};
  for (const CriterionEntry& criterion : run.summary.criteria) {
    table.rows.push_back({{criterion.name, "", Grade::none},
                          {number(criterion.value, 3), "", Grade::none},
                          {number(criterion.limit, 3), "", Grade::none},
                          {criterion.passed ? "✓ met" : "✕ not met", "", Grade::none}});
  }
  return table;
}

/// Pads ASCII text on the left to `width`.
std::string cell(const std::string& text, int width) {
  return fmt::format("{:>{}}", text, width);
}

std::string plain_percent(double fraction) {
  return std::isfinite(fraction) ? fmt::format("{:+.1f} %", 100.0 * fraction) : "-";
}

std::string plain_number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string text_table(const RunData& run) {
  std::string text = fmt::format("{:<12}", "model");
  for (const Constant& constant : constants_shown) text += cell(constant.ascii, 8);
  for (double depth : run.depths) text += cell("F " + shown_units().length.text(depth), 11);
  text += cell("real time", 11) + "\n" + fmt::format("{:<12}", "target");
  const auto shown = [](const Constant& constant, double value) {
    return is_ratio(constant) ? plain_number(value, "{:.4f}")
                              : plain_number(shown_units().stress(value), "{:.2f}");
  };
  for (const Constant& constant : constants_shown)
    text += cell(shown(constant, run.target.*constant.target), 8);
  for (double depth : run.depths) {
    text += cell(plain_number(shown_units().force(force_at(run.reference, depth)), "{:.4g} ") +
                     std::string(shown_units().force.ascii),
                 11);
  }
  text += "\n";
  for (const ModelData& model : run.models) {
    text += fmt::format("{:<12}", model.name);
    for (const Constant& constant : constants_shown)
      text += cell(shown(constant, model.moduli.*constant.value), 8);
    for (double error : model.force_error) text += cell(plain_percent(error), 11);
    text += cell(plain_number(model.real_time_factor, "{:.3g}"), 11) + "\n";
  }
  return text + fmt::format("moduli in {}; F: force of the continuum, error of the models\n",
                            shown_units().stress.ascii);
}

std::string models_answer(const RunData& run) {
  const double depth = run.reference.empty() ? meshes::unknown : run.reference.depth();
  std::vector<const ModelData*> models;
  for (const ModelData& model : run.models) models.push_back(&model);
  // Best first; models without a force at the end.
  std::stable_sort(models.begin(), models.end(), [](const ModelData* a, const ModelData* b) {
    return largest_error(*a) < largest_error(*b);
  });
  WordList compared;
  for (const ModelData* model : models) {
    Words words = description_of(run, *model);
    words["next"] = !compared.empty();
    compared.push_back(std::move(words));
  }
  Words words;
  words["depth"] = run.reference.empty() ? "" : length(depth);
  words["force"] = run.reference.empty() ? "" : force(run.reference.normal_force_at(depth));
  words["compared"] = !compared.empty();
  words["models"] = std::move(compared);
  return sentences("answer_models", words);
}

}  // namespace

std::string answer(const RunData& run, FolderReader& reader) {
  const auto result = [&] {
    if (!run.variants.empty()) return variants_answer(run);
    if (!run.summary.presses.empty()) {
      const std::vector<MovingPress> presses = read_moving_presses(run, reader);
      return compares_integrators(presses) ? integrators_answer(presses) : control_answer(presses);
    }
    if (!run.summary.materials.empty()) return materials_answer(read_materials(run, reader));
    return run.summary.grasps.empty() ? models_answer(run) : grasp_answer(read_grasps(run, reader));
  };
  return joined(result(), criteria_sentence(run));
}

Chapter verdict_chapter(const RunData& run) {
  ChapterData chapter("verdict");
  chapter["description"] = run.summary.description;
  if (!run.models.empty()) {
    chapter.tables["forces"] = force_table(run);
    chapter.tables["constants"] = constants_table(run);
  }
  chapter.tables["criteria"] = criteria_table(run);
  return written(std::move(chapter));
}

namespace {

std::string moving_text(const std::vector<MovingPress>& presses) {
  return compares_integrators(presses) ? integrators_text(presses)
                                               : control_text(presses);
}

}  // namespace

std::string verdict_text(const std::filesystem::path& run_folder) {
  FolderReader reader;
  const RunData run = read_run(run_folder, reader);
  const CalibrationData calibration = read_calibration(run, reader);
  const bool fits_alone = !calibration.empty() && run.models.empty();
  std::string text = !run.variants.empty()          ? variants_text(run)
                     : !run.summary.presses.empty() ? moving_text(read_moving_presses(run, reader))
                     : !run.summary.grasps.empty()  ? grasp_text(read_grasps(run, reader))
                     : !run.summary.materials.empty() ? materials_text(read_materials(run, reader))
                     : fits_alone                     ? calibration_text(calibration)
                                                      : text_table(run);
  for (const CriterionEntry& criterion : run.summary.criteria) {
    text += fmt::format("{} {}: {} (limit {})\n", criterion.passed ? "met    " : "NOT MET",
                        criterion.name, plain_number(criterion.value, "{:.3g}"),
                        plain_number(criterion.limit, "{:.3g}"));
  }
  reader.throw_if_damaged();
  return text;
}

}  // namespace fingertip::studies::report
