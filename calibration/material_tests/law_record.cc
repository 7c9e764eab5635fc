#include "calibration/material_tests/law_record.h"

#include <cmath>
#include <optional>

#include "calibration/files/words.h"
#include "calibration/material_tests/relaxation_starts.h"
#include "calibration/statistics/fit_entries.h"

namespace fingertip::calibration::inline material_tests {

using meshes::unknown;

namespace {

LawTestEntry law_test(const LawChoice& law, const MaterialTest& test, const TestMisfit& misfit,
                      const char* use) {
  LawTestEntry entry{misfit, std::string(name(test.kind)), use, std::string(name(test.course)),
                     test.rate};
  entry.specimens = test.specimens;
  if (const auto found = test.published.find(calibration::name(law)); found != test.published.end())
    entry.published = found->second;
  return entry;
}

std::optional<InstabilityEntry> instability_entry(const std::optional<meshes::Instability>& at) {
  if (!at) return std::nullopt;
  return InstabilityEntry{std::string(name(at->test)), at->stretch};
}

LawEntry law_entry(const LawFit& fit, const std::vector<MaterialTest>& tests,
                   const std::vector<MaterialTest>& validation) {
  LawEntry entry;
  entry.law = name(fit.choice);
  entry.failure = fit.failure;
  if (!fit.failure.empty()) return entry;
  for (std::size_t i = 0; i < fit.fit.parameters.size(); ++i)
    entry.parameters.push_back(parameter_entry(fit.fit, i));
  entry.shear_modulus = fit.law.shear_modulus;
  entry.aicc = fit.aicc;
  entry.covariance = rows(fit.fit.covariance);
  for (std::size_t i = 0; i < tests.size(); ++i)
    entry.tests.push_back(law_test(fit.choice, tests[i], fit.fitted[i], "fit"));
  for (std::size_t i = 0; i < validation.size(); ++i)
    entry.tests.push_back(law_test(fit.choice, validation[i], fit.predicted[i], "predict"));
  entry.unstable_in_tests = instability_entry(fit.unstable_in_tests);
  entry.unstable_in_use = instability_entry(fit.unstable_in_use);
  entry.unstable_in_press = instability_entry(fit.unstable_in_press);
  entry.minima = minimum_entries(fit.fit);
  entry.contradictions = fit.contradictions;
  return entry;
}

/// Why a law of a lower AICc than `best` is not taken.
std::string why_passed_over(const LawFit& fit, const LawFit& best,
                            const std::vector<LawFit>& ranking) {
  if (!fit.failure.empty()) return "";
  if (!fit.failed.empty()) return fit.failed.front();
  const std::vector<const LawFit*> chosen_among = equals(ranking);
  if (std::ranges::find(chosen_among, &fit) == chosen_among.end())
    return "misses the tests by more than others that repeat as specimens do";
  if (best.aicc <= fit.aicc + as_good_aicc && best.fit.estimates.size() < fit.fit.estimates.size())
    return name(best.choice) + " is as good with fewer coefficients";
  for (const TestMisfit& misfit : fit.predicted)
    if (!(misfit.rms_relative <= supporting_error))
      return "misses " + misfit.name + ", which was held back, by " + percent(misfit.rms_relative);
  for (std::size_t i = 0; i < fit.untested.size() && i < best.untested.size(); ++i)
    if (fit.untested[i].share > best.untested[i].share)
      return "asks in " + std::string(name(fit.untested[i].mode)) +
             ", which no test tells of, for " +
             rounded(fit.untested[i].share / best.untested[i].share, 2) + " times the stress of " +
             name(best.choice);
  return "errs more over all tests than " + name(best.choice);
}

/// Why it is taken, as far as AICc does not tell.
std::string reason_of_choice(const LawFit& best, const std::vector<LawFit>& ranking) {
  const std::size_t count = equals(ranking).size();
  const LawFit& first = ranking.front();
  const bool simpler = best.aicc <= first.aicc + as_good_aicc &&
                       best.fit.estimates.size() < first.fit.estimates.size();
  const std::string as_good = simpler ? ", as good with fewer coefficients" : "";
  if (best.predicted.empty() && !best.untested.empty() && count > 1)
    return as_good +
           ", which asks for little stress in other ways of deforming: tests of one way do not "
           "choose among the " +
           std::to_string(count) + " laws that meet them alike. Measure another way.";
  const bool missed = std::ranges::any_of(best.predicted, [](const TestMisfit& misfit) {
    return !(misfit.rms_relative <= supporting_error);
  });
  if (missed)
    return ": none predicts what was held back within " + percent(supporting_error) +
           ", and it errs least.";
  if (&best == &first || simpler) return as_good + ".";
  return best.predicted.empty() ? ", which passes its own tests."
                                : ", which passes its own tests and predicts what was held back.";
}

/// G at rest, which goes into the file, in words.
std::string modulus_statement(const std::vector<LawFit>& ranking, const LawFit& best,
                              LawsFile& file) {
  const ModulusOfLaws modulus = modulus_of_laws(ranking, best);
  file.shear_modulus = modulus.value;
  file.shear_modulus_lower = modulus.lower;
  file.shear_modulus_upper = modulus.upper;
  for (const LawFit* law : modulus.laws) file.supported.push_back(name(law->choice));
  const bool several = modulus.laws.size() > 1;
  return " At rest G = " + quantity_text(modulus.value, "Pa", 4) +
         " (95 %: " + quantity_text(modulus.lower, "Pa", 4) + " to " +
         quantity_text(modulus.upper, "Pa", 4) +
         (several ? ", over " + std::to_string(modulus.laws.size()) +
                        " laws that the tests support alike)"
                  : ")") +
         (best.bulk_modulus
              ? "."
              : ", and E = 3 G = " + quantity_text(3.0 * modulus.value, "Pa", 4) + ".") +
         " Areas count as told: 1 % of them all is 1 % of G.";
}

}  // namespace

LawsFile laws_file(const std::vector<LawFit>& ranking, const std::vector<MaterialTest>& tests,
                   const std::vector<MaterialTest>& validation, TestWeights weights) {
  LawsFile file;
  file.problem = "material";
  file.weights = name(weights);
  const auto range = stretch_range(tests);
  file.smallest_stretch = range[0];
  file.largest_stretch = range[1];
  if (const auto times = observed_times(tests)) {
    file.shortest_time = (*times)[0];
    file.longest_time = (*times)[1];
  }
  for (const LawFit& fit : ranking) file.laws.push_back(law_entry(fit, tests, validation));
  const LawFit* best = recommended(ranking);
  if (best == nullptr) {
    file.statement = "No law could be fitted: " + ranking.front().failure;
    file.failed = {file.statement};
    return file;
  }
  file.recommended = name(best->choice);
  for (std::size_t i = 0; &ranking[i] != best; ++i)
    file.laws[i].passed_over = why_passed_over(ranking[i], *best, ranking);
  file.failed = best->failed;
  const bool first = best == &ranking.front();
  file.statement = "Of " + std::to_string(ranking.size()) + " laws " +
                   name(ranking.front().choice) + " has the least AICc";
  if (file.failed.empty())
    file.statement += (first ? " and is taken" : "; " + file.recommended + " is taken") +
                      reason_of_choice(*best, ranking);
  else
    file.statement = "Not accepted: no law passes its own tests. " + file.statement +
                     (first ? "." : "; " + file.recommended + " is shown.");
  file.statement += modulus_statement(ranking, *best, file);
  for (std::size_t i = 0; i < validation.size(); ++i)
    file.statement += " It predicts " + validation[i].name + " within " +
                      rounded(100.0 * best->predicted[i].rms_relative, 3) + " % (rms), " +
                      rounded(100.0 * best->predicted[i].largest_relative, 3) + " % at most.";
  return file;
}

std::vector<LawDataRow> law_data(const std::vector<LawFit>& ranking,
                                 const std::vector<MaterialTest>& tests,
                                 const std::vector<MaterialTest>& validation) {
  std::vector<LawDataRow> rows;
  for (const LawFit& fit : ranking) {
    if (!fit.failure.empty()) continue;
    const auto add = [&](const std::vector<MaterialTest>& from,
                         const std::vector<TestMisfit>& misfits, const char* use) {
      for (std::size_t t = 0; t < from.size(); ++t)
        for (std::size_t i = 0; i < from[t].stress.size(); ++i) {
          const double computed = misfits[t].stress[i] + misfits[t].stress_zero;
          rows.push_back({name(fit.choice), from[t].name, use, from[t].deformation[i],
                          from[t].stress[i], std::isfinite(computed) ? computed : unknown,
                          from[t].time.empty() ? unknown : from[t].time[i]});
        }
    };
    add(tests, fit.fitted, "fit");
    add(validation, fit.predicted, "predict");
  }
  return rows;
}

}  // namespace fingertip::calibration::inline material_tests
