#include "studies/fits/models/fit_suspects.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>

#include "calibration/press_fit/model_error.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/fit_statistics.h"
#include "studies/fits/models/fit_rig.h"

namespace fingertip::studies {

using calibration::Accusation;
using calibration::Curve;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using calibration::Rig;
using calibration::rig_members;
using calibration::rig_parameters;
using calibration::Suspect;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Another theory is there or not; coarse lattices tell its forces to a half.
constexpr double most_excess = 1.5;

constexpr const char
    *relaxation_name = "relaxation",
    *stiffening_name = "stiffening",
    *stiffening_cause =
        "the force grows faster with depth than the model's, and no machine makes "
        "that: the rubber sticks, its law stiffens, or obstacle or shape are others";

/// Causes of smooth curves resemble each other: such a share of the best one's decrease is as good.
constexpr double nearly_all = 0.9;

/// A misfit that chance makes less often than this is one.
constexpr double by_no_chance = 1e-3;

const char* cause_of(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::touch_offset:
      return "the finger touches earlier or later than the zero of the travel says";
    case MaterialParameter::compliance:
      return "frame, load cell, grips or glue give way beside the finger";
    case MaterialParameter::force_offset:
      return "the load cell was not zeroed with the finger free";
    default: return "the load cell's zero moves, as while it warms up";
  }
}

/// Whether the fit seeks that of `rig_parameters` itself.
bool is_fitted(const FitInput& input, std::size_t i, std::size_t k) {
  return is_travel(input, i) && (input.travels[i]->rig.*rig_members[k]).place;
}

/// The press of a rubber that is found, times a factor, that of a place among the parameters.
class ScaledPress final : public calibration::ForwardModel {
 public:
  ScaledPress(VectorXd forces, Index place) : forces_(std::move(forces)), place_(place) {}
  calibration::CurveSlopes evaluate(const VectorXd& parameters) override {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(forces_.size(), parameters.size());
    slopes.col(place_) = forces_;
    return {parameters(place_) * forces_, slopes};
  }

 private:
  VectorXd forces_;
  Index place_;
};

/// One of `rig_parameters` of a curve, or of the curves of a machine.
struct Freed {
  std::size_t kind = 0;
  std::string of;
  std::vector<std::size_t> curves;
  /// A compliance below zero, which no machine has: what stiffens with the force is something else.
  bool stiffens = false;
};

/// Fits of the forces' scale, of what of the rigs is fitted and of one thing more.
class Trials {
 public:
  Trials(const FitInput& input, const calibration::CurveFit& fit,
         const calibration::CurveFitOptions& options, const FitModels& models, bool scatter)
      : input_(input), options_(options), scales_(scatter ? Index(input.curves.size()) : 1) {
    const std::size_t rubber = material_parameters(input);
    shift_ = Index(rubber) - scales_;
    FreeParameter scale{.parameter = MaterialParameter::modulus, .start = 1.0};
    const auto& first = options.free.front();
    if (rubber == 1 && scales_ == 1 && first.prior)
      scale.prior = calibration::Prior{first.prior->mean / fit.estimates(0),
                                       first.prior->deviation / fit.estimates(0)};
    options_.free.assign(std::size_t(scales_), scale);
    options_.other_starts.clear();
    options_.progress = {};
    options_.max_evaluations = most_trials;
    options_.value_deviation = fit.residual_deviation;  // the same for all that are compared
    for (std::size_t k = rubber; k < options.free.size(); ++k) {
      options_.free.push_back(options.free[k]);
      options_.free.back().start = fit.estimates(Index(k));
    }
    for (std::size_t i = 0; i < input.curves.size(); ++i)
      presses_.emplace_back(models.press_forces(i, fit.estimates.head(Index(rubber))),
                            scatter ? Index(i) : 0);
    before_ = fitted({});
  }

  /// Throws as fits do. A stiffening is told by what c < 0 adds to the deepest force, -c dF/dx of
  /// it with 3/2 of the force over the travel as the slope.
  Accusation of(const Freed& freed) {
    const MaterialParameter parameter = rig_parameters[freed.kind];
    Suspect what{std::string(calibration::name(parameter)),
                 freed.of,
                 cause_of(parameter),
                 std::string(calibration::unit(parameter)),
                 {}};
    if (freed.stiffens)
      what = {stiffening_name, freed.of, stiffening_cause, "1", {}, 0.0, 0.0, "the deepest force"};
    Accusation found = calibration::accusation(before_, fitted({freed}), what);
    if (freed.stiffens) found.amount *= -1.5 / parameter_of(freed).scale;
    return found;
  }

  /// Chi-square, or squares over their variance, that is left with all of these freed.
  double left(const std::vector<Freed>& freed) {
    return squares_of(before_) - calibration::accusation(before_, fitted(freed), {}).decrease;
  }
  double before() const { return squares_of(before_); }
  int freedom() const { return before_.degrees_of_freedom; }

 private:
  static constexpr int most_trials = 200;
  static constexpr double most_stiffening = 0.1, highest_compliance = 0.9;

  static double squares_of(const calibration::CurveFit& fit) {
    return fit.chi_square.value_or(double(fit.degrees_of_freedom));
  }

  FreeParameter parameter_of(const Freed& freed) const {
    FreeParameter free{.parameter = rig_parameters[freed.kind]};
    double reach = 0.0, force = 0.0, span = 0.0;
    for (const std::size_t i : freed.curves) {
      const Curve& curve = input_.curves[i];
      reach = std::max(reach, curve.x.back() - curve.x.front());
      force = std::max(force, *std::ranges::max_element(curve.y));
      if (!curve.time.empty()) span = std::max(span, curve.time.back() - curve.time.front());
      if (is_travel(input_, i))
        free.start = (input_.travels[i]->rig.*rig_members[freed.kind]).value;
    }
    const double scales[] = {reach, reach / force, force, force / std::max(span, 1e-9)};
    free.scale = scales[freed.kind];
    free.of = freed.of;
    if (rig_parameters[freed.kind] == MaterialParameter::compliance) {
      free.lower = freed.stiffens ? -most_stiffening * free.scale : 0.0;
      free.upper = freed.stiffens ? 0.0 : free.start + highest_compliance * free.scale;
      free.start = std::clamp(free.start, free.lower, free.upper);
    }
    return free;
  }

  calibration::CurveFit fitted(const std::vector<Freed>& freed) {
    calibration::CurveFitOptions options = options_;
    for (const Freed& each : freed) options.free.push_back(parameter_of(each));
    const Index count = Index(options.free.size()), own = Index(options_.free.size());
    std::vector<std::unique_ptr<calibration::RigModel>> models;
    std::vector<calibration::ForwardModel*> list;
    std::vector<calibration::FitBranch> branches = input_.branches;
    for (calibration::FitBranch& branch : branches)
      for (auto* place : {&branch.share.place, &branch.time.place})
        if (*place) **place -= shift_;
    for (std::size_t i = 0; i < input_.curves.size(); ++i) {
      const bool travel = is_travel(input_, i);
      Rig rig = travel ? input_.travels[i]->rig : Rig{};
      for (const auto member : rig_members)
        if (auto& place = (rig.*member).place) place = *place - shift_;
      for (std::size_t f = 0; f < freed.size(); ++f)
        if (std::ranges::find(freed[f].curves, i) != freed[f].curves.end())
          (rig.*rig_members[freed[f].kind]).place = own + Index(f);
      models.push_back(std::make_unique<calibration::RigModel>(
          presses_[i], travel ? input_.travels[i]->depths : input_.presses[i].protocol.samples,
          scales_, rig, input_.curves[i].x, input_.curves[i].time, count, branches));
      list.push_back(models.back().get());
    }
    return calibration::fit_curves(input_.curves, list, options);
  }

  const FitInput& input_;
  calibration::CurveFitOptions options_;
  Index scales_ = 1;  ///< of the forces: one, or one of each curve
  Index shift_ = 0;
  std::deque<ScaledPress> presses_;
  calibration::CurveFit before_;
};

/// Curves one below the other.
struct Stack {
  std::vector<VectorXd> fitted;
  std::vector<Index> first;
  Index values = 0;
};

Stack stacked(const FitInput& input, const calibration::CurveFit& fit) {
  Stack stack;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const auto& y = input.curves[i].y;
    stack.first.push_back(stack.values);
    stack.fitted.push_back(VectorXd::Map(y.data(), Index(y.size())) - fit.residuals[i]);
    stack.values += Index(y.size());
  }
  return stack;
}

/// The rig's quantities that the fit holds.
std::vector<Freed> held_by(const FitInput& input) {
  std::vector<Freed> held;
  const std::size_t curves = input.curves.size();
  std::map<std::string, std::vector<std::size_t>> machines;
  for (std::size_t i = 0; i < curves; ++i)
    machines[is_travel(input, i) ? input.travels[i]->machine : ""].push_back(i);
  for (std::size_t k = 0; k < rig_members.size(); ++k) {
    if (rig_parameters[k] == MaterialParameter::compliance) {
      for (const auto& [machine, which] : machines)
        for (const bool stiffens : {false, true})
          if (!is_fitted(input, which.front(), k))
            held.push_back({k, machines.size() == 1 ? "" : machine, which, stiffens});
      continue;
    }
    for (std::size_t i = 0; i < curves; ++i) {
      const bool no_times =
          rig_parameters[k] == MaterialParameter::drift && input.curves[i].time.empty();
      if (!no_times && !is_fitted(input, i, k))
        held.push_back({k, curves == 1 ? "" : input.curves[i].name, {i}});
    }
  }
  return held;
}

template <typename Do>
void if_it_can_be(const Do& act) {
  try {
    act();
  } catch (const meshes::NotConverged&) {
  } catch (const meshes::InvalidInput&) {
  }
}

/// Of every press; empty where one of them finds no equilibrium.
std::vector<std::vector<double>> excess_of(const FitInput& input,
                                           Eigen::VectorXd (*theory)(lattice::PressSetup)) {
  std::vector<std::vector<double>> excess;
  if_it_can_be([&] {
    for (const lattice::PressSetup& press : input.presses) {
      const VectorXd own = theory(press);
      excess.emplace_back(own.begin(), own.end());
    }
  });
  if (excess.size() != input.presses.size()) excess.clear();
  return excess;
}

/// By how much another theory's forces exceed the model's, relative, at every sample of every
/// press.
struct Excess {
  std::string name;        ///< "finite strain"
  const char* cause = "";  ///< for people
  std::vector<std::vector<double>> at_samples;
};

/// What a small-strain fit leaves out, and what the other contact would change.
std::vector<Excess> excesses_of(const FitInput& input) {
  std::vector<Excess> excesses;
  const auto& finite = input.finite_excess;
  if (!finite.empty() && input.theory_error != finite)
    excesses.push_back({"finite strain",
                        "the data go beyond small strain (leave lattice.kinematics out)", finite});
  const bool slips = input.presses.front().protocol.contact != meshes::ContactMode::stick;
  auto other = excess_of(input, calibration::excess_of_other_contact);
  if (!other.empty())
    excesses.push_back({slips ? "sticking" : "slip",
                        slips
                            ? "the rubber sticks to the obstacle (press.contact = \"stick\")"
                            : "the rubber slips on the obstacle (press.contact = \"frictionless\")",
                        std::move(other)});
  return excesses;
}

/// Of files that show a loop or a hold: a branch of the rubber that fades as long as their loading
/// takes, which is where it bends the loading most. Without times the speed counts as constant.
std::optional<Suspect> relaxation(const FitInput& input, const Stack& stack) {
  Suspect suspect;
  suspect.name = relaxation_name, suspect.share_of = "the force at once";
  suspect.cause =
      "the rubber's force falls with time, as its loop or hold shows; give its branches in "
      "rubber.relaxation, or fit them: calibration.parameters with \"relaxation\"";
  suspect.change = VectorXd::Zero(stack.values);
  suspect.least = suspect.most = 0.0;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const Curve& curve = input.curves[i];
    const VectorXd& forces = stack.fitted[i];
    const std::vector<double>& times = curve.time.empty() ? curve.x : curve.time;
    const double constant = times.back() - times.front();
    if (!(constant > 0.0) || !(forces(forces.size() - 1) > 0.0)) continue;
    const double shown = calibration::fading_of(curve.course, forces, curve.x, times, constant);
    if (!(shown > 0.0)) continue;
    suspect.most = std::max(suspect.most, std::min(1.0, most_excess * shown));
    suspect.change.segment(stack.first[i], forces.size()) =
        calibration::fading(forces, times, constant);
  }
  if (suspect.most == 0.0) return std::nullopt;
  return suspect;
}

/// The two kinds of a rig's quantities that explain most together, where none does alone.
std::vector<std::string> best_pair(Trials& trials, const std::vector<Freed>& held,
                                   const std::vector<Accusation>& found) {
  double least = trials.before();
  for (const Accusation& each : found) least = std::min(least, trials.before() - each.decrease);
  if (trials.freedom() < 3 ||
      calibration::chi_square_above(std::max(0.0, least), trials.freedom() - 1) > by_no_chance)
    return {};
  std::vector<std::string> pair;
  for (std::size_t a = 0; a < rig_members.size(); ++a)
    for (std::size_t b = a + 1; b < rig_members.size(); ++b) {
      std::vector<Freed> both;
      for (const Freed& each : held)
        if (!each.stiffens && (each.kind == a || each.kind == b)) both.push_back(each);
      const auto is = [&](std::size_t kind) {
        return std::ranges::find(both, kind, &Freed::kind) != both.end();
      };
      if (!is(a) || !is(b)) continue;
      if_it_can_be([&] {
        const double left = trials.left(both);
        if (left >= least) return;
        least = left;
        pair = {std::string(calibration::name(rig_parameters[a])),
                std::string(calibration::name(rig_parameters[b]))};
      });
    }
  return pair;
}

}  // namespace

std::vector<std::vector<double>> excess_of_finite_strain(const FitInput& input) {
  if (input.problem != CalibrationProblem::experiment ||
      input.base.lattice.kinematics == lattice::Kinematics::finite)
    return {};
  return excess_of(input, calibration::excess_of_finite_strain);
}

std::vector<Accusation> accusations_of(const FitInput& input, const calibration::CurveFit& fit,
                                       const calibration::CurveFitOptions& options,
                                       const FitModels& models, bool scatter) {
  std::vector<Accusation> found;
  if (input.problem != CalibrationProblem::experiment || input.presses.empty()) return found;
  const Stack stack = stacked(input, fit);
  std::vector<Suspect> suspects;
  for (const Excess& excess : excesses_of(input)) {
    Suspect& suspect = suspects.emplace_back(Suspect{excess.name, "", excess.cause, "1",
                                                     VectorXd::Zero(stack.values), 0.0, most_excess,
                                                     "what coarse lattices compute for it"});
    for (std::size_t i = 0; i < input.curves.size(); ++i) {
      const std::vector<double> relative = at_values(input, i, excess.at_samples[i]);
      suspect.change.segment(stack.first[i], Index(relative.size())) =
          stack.fitted[i].cwiseProduct(VectorXd::Map(relative.data(), Index(relative.size())));
    }
  }
  if (input.branches.empty())  // else it is in the model
    if (auto fades = relaxation(input, stack)) suspects.push_back(*std::move(fades));
  found = calibration::accusations(fit, options, suspects);
  const auto gravest_first = [&] {
    std::ranges::stable_sort(found, std::greater<>(), &Accusation::decrease);
    // What explains as much and shows itself besides goes first: no other cause makes a loop.
    // A stiffening has no cause of its own: those that are named go before it.
    const bool unnamed = !found.empty() && found.front().name == stiffening_name;
    const auto better = std::ranges::find_if(found, [&](const Accusation& each) {
      return each.decrease > nearly_all * found.front().decrease &&
             (each.name == relaxation_name || (unnamed && each.name != stiffening_name));
    });
    if (better != found.end()) std::rotate(found.begin(), better, better + 1);
  };
  gravest_first();
  if_it_can_be([&] {  // a press without forces has no rig
    Trials trials(input, fit, options, models, scatter);
    const std::vector<Freed> held = held_by(input);
    for (const Freed& each : held) if_it_can_be([&] { found.push_back(trials.of(each)); });
    gravest_first();
    const std::vector<std::string> pair = best_pair(trials, held, found);
    std::ranges::stable_partition(found, [&](const Accusation& each) {
      return std::ranges::find(pair, each.name) != pair.end();
    });
  });
  return found;
}

}  // namespace fingertip::studies
