#include "studies/fits/models/rivals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "calibration/files/words.h"
#include "calibration/press_fit/model_error.h"
#include "meshes/base/errors.h"
#include "studies/fits/models/described_numbers.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/fit_trials.h"
#include "studies/fits/models/omitted_effects.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::CurveFit, calibration::Described, calibration::ForwardModel;
using calibration::RivalEntry;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// Values that a number may have instead, over the one that is told; Poisson's ratios.
constexpr double factors[] = {0.65, 0.8, 0.9, 1.1, 1.25, 1.5};
constexpr double ratios[] = {0.3, 0.4, 0.45, 0.48, 0.495};
constexpr double same_ratio = 0.02;
/// Depths at which a coarse lattice tells what a number does.
constexpr std::size_t depths = 8;

/// How well they tell it, a standard deviation over what it does.
constexpr double coarse = 0.15;

/// A press with so many times its force at every depth.
class MultipliedPress final : public ForwardModel {
 public:
  MultipliedPress(ForwardModel& press, VectorXd factor)
      : press_(press), factor_(std::move(factor)) {}
  calibration::CurveSlopes evaluate(const VectorXd& parameters) override {
    calibration::CurveSlopes slopes = press_.evaluate(parameters);
    slopes.value = slopes.value.cwiseProduct(factor_);
    slopes.jacobian = factor_.asDiagonal() * slopes.jacobian;
    return slopes;
  }
  bool refine(const VectorXd& parameters) override { return press_.refine(parameters); }

 private:
  ForwardModel& press_;
  VectorXd factor_;
};

/// By how much the forces of every curve change at the samples of its press, relative; empty: not.
using Changes = std::vector<std::vector<double>>;

/// What is told, another in its place, and how the forces change then.
struct Rival {
  std::string name, told, instead;
  Changes changes;
};

/// Throws nothing: none where there is no equilibrium, or no such press.
std::optional<Rival> with_changes(
    Rival rival, const FitInput& input,
    const std::function<std::vector<double>(const lattice::PressSetup&)>& change) {
  try {
    for (const FitCurve& curve : input.curves) rival.changes.push_back(change(curve.press));
  } catch (const meshes::NotConverged&) {
    return std::nullopt;
  } catch (const meshes::InvalidInput&) {
    return std::nullopt;
  }
  return rival;
}

std::vector<double> list(const VectorXd& values) {
  return {values.begin(), values.end()};
}

/// Each contact that is told of presses, as a group of one.
std::vector<std::vector<Rival>> contacts(const FitInput& input) {
  using meshes::ContactMode;
  std::vector<std::vector<Rival>> groups;
  std::set<ContactMode> told;
  for (const FitCurve& curve : input.curves) told.insert(curve.press.protocol.contact);
  for (const ContactMode own : {ContactMode::frictionless, ContactMode::stick}) {
    if (!input.contact_told || !told.contains(own)) continue;
    const ContactMode other =
        own == ContactMode::stick ? ContactMode::frictionless : ContactMode::stick;
    auto rival = with_changes({calibration::contact_rival,
                               std::string(meshes::name(own)),
                               std::string(meshes::name(other)),
                               {}},
                              input, [&](const lattice::PressSetup& press) {
                                return press.protocol.contact == own
                                           ? list(calibration::excess_of_other_contact(press))
                                           : std::vector<double>();
                              });
    if (rival) groups.push_back({*std::move(rival)});
  }
  return groups;
}

std::vector<double> values_instead(const KnownError& number) {
  std::vector<double> values;
  if (number.number == Described::poissons_ratio) {
    for (const double ratio : ratios)
      if (std::abs(ratio - number.value) > same_ratio) values.push_back(ratio);
  } else {
    for (const double factor : factors) values.push_back(factor * number.value);
  }
  return values;
}

/// Every number that no tolerance tells, as a group of its values.
std::vector<std::vector<Rival>> numbers(const FitInput& input) {
  std::vector<std::vector<Rival>> groups;
  for (const KnownError& number : untold_numbers(input)) {
    const Described what = *number.number;
    const auto text = [&](double value) {
      return calibration::quantity_text(value, calibration::unit_of(what), 4);
    };
    std::vector<Rival> group;
    for (const double value : values_instead(number)) {
      auto rival = with_changes(
          {number.name, text(number.value), text(value), {}}, input,
          [&](const lattice::PressSetup& press) {
            return has_value(press, what, number.value)
                       ? list(calibration::change_between(press, what, number.value, value,
                                                          press.lattice.kinematics, depths))
                       : std::vector<double>();
          });
      if (rival) group.push_back(*std::move(rival));
    }
    if (!group.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

/// The posterior with the rival in place of what is told. What coarse lattices tell of its forces
/// is uncertain for every kind of press by itself.
calibration::Posterior posterior_with(const Rival& rival, const FitInput& input,
                                      const FitModels& models, const CurveFit& first) {
  const auto groups = sharing(input);
  MatrixXd errors =
      MatrixXd::Zero(first_value(input.curves, input.curves.size()), Index(groups.size()));
  std::vector<std::unique_ptr<ForwardModel>> kept;
  std::vector<ForwardModel*> list;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const FitCurve& curve = input.curves[i];
    std::vector<double> relative = rival.changes[i];
    if (relative.empty()) relative.assign(curve.press.protocol.samples.size(), 0.0);
    kept.push_back(std::make_unique<MultipliedPress>(
        models.press(i),
        (1.0 + VectorXd::Map(relative.data(), Index(relative.size())).array()).max(1e-3)));
    if (curve.travel)
      kept.push_back(std::make_unique<calibration::RigModel>(
          *kept.back(), curve.press.protocol.samples, Index(material_parameters(input)),
          curve.travel->rig, curve.x, curve.time, Index(input.options.free.size()),
          input.branches));
    list.push_back(kept.back().get());
    const auto group = std::ranges::find_if(
        groups, [&](const auto& curves) { return std::ranges::find(curves, i) != curves.end(); });
    const VectorXd forces = values_of(curve) - first.residuals[i];
    const std::vector<double> at = at_values(curve, start_of(input.options), relative);
    errors.col(group - groups.begin()).segment(first_value(input.curves, i), forces.size()) =
        coarse * forces.cwiseProduct(VectorXd::Map(at.data(), Index(at.size())));
  }
  FitInput order = input;
  MatrixXd& covariance = order.options.model_covariance;
  if (covariance.size() == 0) covariance = MatrixXd::Zero(errors.rows(), errors.rows());
  covariance += errors * errors.transpose();
  return posterior_of(order, list, first);
}

RivalEntry entry_of(const Rival& rival, const calibration::Posterior& by, const FitInput& input) {
  RivalEntry entry{rival.name, rival.told, rival.instead, by.errors.log_evidence, {}};
  CurveFit fit = by.fit;
  calibration::put_posterior(by.errors, input.options.free, fit);
  for (std::size_t i = 0; i < material_parameters(input); ++i)
    entry.parameters.push_back(
        {fit.labels[i], fit.estimates(Index(i)), fit.lower(Index(i)), fit.upper(Index(i))});
  return entry;
}

/// Of a number the likeliest value, and how likely it is to have another at all: the mean over its
/// values. None: there is no answer.
std::optional<RivalEntry> likeliest(const std::vector<Rival>& group, const FitInput& input,
                                    const FitModels& models, const CurveFit& first,
                                    double log_evidence) {
  std::optional<RivalEntry> best;
  double sum = 0.0;  // of likelihoods over that of the best
  for (const Rival& rival : group) {
    try {
      RivalEntry entry = entry_of(rival, posterior_with(rival, input, models, first), input);
      entry.likelier -= log_evidence;
      if (!std::isfinite(entry.likelier)) continue;
      const double more = best ? entry.likelier - best->likelier : 0.0;
      sum = more > 0.0 ? sum * std::exp(-more) + 1.0 : sum + std::exp(more);
      if (!best || more > 0.0) best = std::move(entry);
    } catch (const meshes::NotConverged&) {
    }
  }
  if (best) best->likelier += std::log(sum / double(group.size()));
  return best;
}

/// The log of how many times likelier the data could become at most: what the smooth misfit takes
/// away, and what it costs that etas are off their priors.
double room(const FitInput& input, const calibration::FitRecord& record) {
  double room = 0.5 * record.errors->misfit_seen;
  for (std::size_t j = 0; j < input.options.free.size(); ++j) {
    const auto& prior = input.options.free[j].prior;
    if (!prior || !calibration::is_of_the_rig(input.options.free[j].parameter)) continue;
    const double widths = (record.fit.estimates(Index(j)) - prior->mean) / prior->deviation;
    room += prior->heavy_tails ? std::log1p(widths * widths) : 0.5 * widths * widths;
  }
  return room;
}

}  // namespace

std::vector<RivalEntry> rivals_of(const FitInput& input, const FitModels& models,
                                  const CurveFit& first, const calibration::FitRecord& record,
                                  const std::function<void(const std::string&)>& log) {
  std::vector<RivalEntry> found;
  if (!record.errors || !record.fit.converged) return found;
  RivalEntry at_most;
  at_most.likelier = room(input, record);
  if (!at_most.counts()) return found;
  auto groups = contacts(input);
  std::ranges::move(numbers(input), std::back_inserter(groups));
  for (const std::vector<Rival>& group : groups) {
    auto entry = likeliest(group, input, models, first, record.errors->log_evidence);
    if (!entry) continue;
    log(fmt::format("with {} = {} in place of {} the data are exp({:.2g}) times as likely",
                    entry->name, entry->instead, entry->told, entry->likelier));
    if (entry->counts()) found.push_back(*std::move(entry));
  }
  std::ranges::stable_sort(found, std::greater<>(), &RivalEntry::likelier);
  return found;
}

void take_rivals(calibration::FitRecord& record) {
  for (const RivalEntry& rival : record.rivals)
    for (std::size_t i = 0; i < rival.parameters.size(); ++i) {
      const calibration::OtherEstimate& other = rival.parameters[i];
      double &lower = record.fit.lower(Index(i)), &upper = record.fit.upper(Index(i));
      lower = std::min(lower, other.lower);  // NaN, no interval at all, stays
      upper = std::max(upper, other.upper);
    }
}

void accuse_rival(calibration::FitRecord& record) {
  if (record.rivals.empty() || !record.rivals.front().contradicts()) return;
  const RivalEntry& rival = record.rivals.front();
  std::vector<calibration::ScoreTest>& causes = record.lack_of_fit;
  // Presses that differ by a factor alone: no radius explains that better.
  constexpr double nearly_all = 0.9;
  const bool differ = !causes.empty() && causes.front().name == other_rubber_name &&
                      causes.front().share > nearly_all;
  const auto place = causes.begin() + (differ ? 1 : 0);
  if (rival.name == calibration::contact_rival) {
    const auto known = std::ranges::find_if(causes, [](const auto& each) {
      return each.name == sticking_name || each.name == slip_name;
    });
    if (known > place && known != causes.end()) std::rotate(place, known, known + 1);
    return;
  }
  calibration::ScoreTest cause;
  cause.name = rival.name;
  cause.cause = "it is not " + rival.told + ", as told, but rather " + rival.instead;
  cause.unit = "1", cause.share_of = "it", cause.amount = 1.0;
  cause.decrease = 2.0 * rival.likelier, cause.probability = std::exp(-rival.likelier);
  causes.insert(place, cause);
}

}  // namespace fingertip::studies::inline fits::inline models
