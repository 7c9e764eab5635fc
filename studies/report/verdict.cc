/// The answer, the verdict table and the criteria, as page and as text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/materials_chapter.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/terminal.h"
#include "studies/report/page/words.h"
#include "studies/report/report.h"
#include "studies/report/report_parts.h"
#include "studies/report/results/grasp_run.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report {
namespace {

/// Largest |force error|; infinite without one, so that such models come last.
double largest_error(const ModelData& model) {
  const double largest = largest_magnitude(model.force_error);
  return std::isnan(largest) ? std::numeric_limits<double>::infinity() : largest;
}

/// How far a model's force is off: the least and the greatest error, or one at all depths.
TemplateData description_of(const RunData& run, const ModelData& model) {
  TemplateData words;
  words["model"] = model.name;
  for (const char* name : {"error", "least", "least_depth", "most", "most_depth"}) words[name] = "";
  const std::vector<double>& errors = model.force_error;
  const double* most = largest_in(errors, [](double error) { return error; });
  const double* least = largest_in(errors, [](double error) { return -error; });
  words["unknown"] = most == nullptr;
  if (most == nullptr) return words;
  if (*most - *least < 5e-4) {
    words["error"] = percent(*most);
    return words;
  }
  words["least"] = percent(*least);
  words["least_depth"] = length(run.depths[std::size_t(least - errors.data())]);
  words["most"] = percent(*most);
  words["most_depth"] = length(run.depths[std::size_t(most - errors.data())]);
  return words;
}

std::string criteria_sentence(const RunData& run) {
  const std::vector<CriterionEntry>& criteria = run.summary.criteria;
  if (criteria.empty()) return "";
  std::vector<std::string> failed;
  for (const CriterionEntry& criterion : criteria)
    if (!criterion.passed) failed.push_back(criterion.name);
  TemplateData words;
  words["criteria"] = std::to_string(criteria.size());
  words["single"] = criteria.size() == 1;
  words["count"] = std::to_string(failed.size());
  words["one"] = failed.size() == 1;
  words["failed"] = enumerate(failed);
  return sentences("answer_criteria", words);
}

struct Constant {
  const char* label;
  double ModuliEntry::*value;
  double TargetEntry::*target;

  bool is_ratio() const { return value == &ModuliEntry::nu_100; }
};
constexpr Constant constants_shown[] = {
    {"E₁₀₀", &ModuliEntry::E_100, &TargetEntry::youngs_modulus},
    {"E₁₁₀", &ModuliEntry::E_110, &TargetEntry::youngs_modulus},
    {"E₁₁₁", &ModuliEntry::E_111, &TargetEntry::youngs_modulus},
    {"G", &ModuliEntry::G, &TargetEntry::shear_modulus},
    {"ν₁₀₀", &ModuliEntry::nu_100, &TargetEntry::poissons_ratio},
    {"K", &ModuliEntry::K, &TargetEntry::bulk_modulus},
};

/// Shown number, and below it what it is in the other system: the paper gives its rubber in gf and
/// cm.
Cell in_both(double value, ShownUnit ShownUnits::*quantity) {
  const bool paper = shown_units().system == UnitSystem::paper;
  const ShownUnits& other = units_of(paper ? UnitSystem::si : UnitSystem::paper);
  return {with_unit(value, shown_units().*quantity), with_unit(value, other.*quantity)};
}

Cell model_cell(const ModelData& model) {
  return {model_label(model.name), trouble(model.status)};
}

Table constants_table(const RunData& run) {
  Table table{{"Model"}, true};
  std::vector<Cell> target{{"Target", "rubber, continuum"}};
  for (const Constant& constant : constants_shown) {
    const double value = run.target.*constant.target;
    table.header.emplace_back(constant.label);
    target.push_back(constant.is_ratio() ? number(value) : in_both(value, &ShownUnits::stress));
  }
  table.header.emplace_back("Real time", "factor");
  table.rows.push_back(std::move(target));
  table.rows.back().emplace_back();
  for (const ModelData& model : run.models) {
    std::vector<Cell> row{model_cell(model)};
    for (const Constant& constant : constants_shown) {
      const double value = model.moduli.*constant.value;
      const double error = value / (run.target.*constant.target) - 1.0;
      row.emplace_back(number(constant.is_ratio() ? value : shown_units().stress(value)),
                       percent(error), grade(error));
    }
    row.emplace_back(number(model.real_time_factor, 3));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table force_table(const RunData& run) {
  Table table{{"Model"}, true};
  std::vector<Cell> target{"Continuum"};
  for (const double depth : run.depths) {
    const double f = force_at(run.reference, depth);
    table.header.emplace_back("F", shown_units().length.text(depth));
    target.push_back(std::isfinite(f) ? in_both(f, &ShownUnits::force) : "–");
  }
  table.header.emplace_back("F", "rel. L²");
  table.rows.push_back(std::move(target));
  table.rows.back().emplace_back();
  for (const ModelData& model : run.models) {
    std::vector<Cell> row{model_cell(model)};
    for (const double error : model.force_error) row.push_back(error_cell(error));
    row.push_back(magnitude_cell(model.l2_error));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table criteria_table(const RunData& run) {
  Table table{heads({"Criterion", "Value", "Limit", "Result"})};
  for (const CriterionEntry& criterion : run.summary.criteria)
    table.rows.push_back({criterion.name, number(criterion.value, 3), number(criterion.limit, 3),
                          criterion.passed ? "✓ met" : "✕ not met"});
  return table;
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
    TemplateData words = description_of(run, *model);
    words["next"] = !compared.empty();
    compared.push_back(std::move(words));
  }
  TemplateData words;
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
  if (!run.models.empty() && run.moduli_fit.empty()) {
    chapter.tables["forces"] = force_table(run);
    chapter.tables["constants"] = constants_table(run);
  }
  chapter.tables["criteria"] = criteria_table(run);
  return written(std::move(chapter));
}

Chapter own_displacements(const RunData& run, FolderReader& reader) {
  return displacements_chapter(
      reader.take<DisplacementStudy>(reader.json(run.folder / "distances.json")),
      reader.rows<DisplacementRow>(run.folder / "displacements.csv"));
}

std::string verdict_text(const std::filesystem::path& run_folder) {
  FolderReader reader;
  const RunData run = read_run(run_folder, reader);
  const CalibrationData calibration = read_calibration(run, reader);
  std::string text;
  if (!run.variants.empty()) {
    text = tables_text(variants_chapter(run), {"presses"});
  } else if (!run.summary.presses.empty()) {
    const std::vector<MovingPress> presses = read_moving_presses(run, reader);
    text = compares_integrators(presses)
               ? tables_text(integrators_chapter(presses), {"costs"})
               : tables_text(control_chapter(presses), {"tracking"}) +
                     tables_text(speed_chapter(presses), {"errors", "changes"});
  } else if (!run.summary.grasps.empty()) {
    text = tables_text(grasp_chapter(read_grasps(run, reader)), {"grasps"});
  } else if (!run.summary.materials.empty()) {
    text = tables_text(materials_chapter(read_materials(run, reader)), {"materials"});
  } else if (!calibration.empty() && run.models.empty()) {
    text = tables_text(own_displacements(run, reader), {"ratios", "distances"});
    for (const Chapter& chapter : fit_chapters(calibration))
      text += tables_text(chapter, {"parameters", "predicted", "next"});
    text += tables_text(transfer_chapter(calibration), {"transfer"});
  } else if (!run.moduli_fit.empty()) {
    text = tables_text(elasticity_chapter(run), {"achieved"});
  } else {
    text = tables_text(verdict_chapter(run), {"forces", "constants"});
  }
  for (const CriterionEntry& criterion : run.summary.criteria)
    text += fmt::format("{} {}: {} (limit {})\n", criterion.passed ? "met    " : "NOT MET",
                        criterion.name, terminal(number(criterion.value, 3)),
                        terminal(number(criterion.limit, 3)));
  reader.throw_if_damaged();
  return text;
}

}  // namespace fingertip::studies::report
