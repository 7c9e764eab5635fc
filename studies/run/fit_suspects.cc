#include "studies/run/fit_suspects.h"

#include <algorithm>
#include <set>

namespace fingertip::studies {

using calibration::Curve;
using calibration::MaterialParameter;
using calibration::Suspect;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr MaterialParameter of_rigs[] = {MaterialParameter::touch_offset,
                                         MaterialParameter::compliance,
                                         MaterialParameter::force_offset, MaterialParameter::drift};

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

/// Derivative by straight lines on either side.
VectorXd slope_of(const std::vector<double>& x, const VectorXd& y) {
  const Index last = y.size() - 1;
  VectorXd slope(y.size());
  for (Index i = 0; i <= last; ++i) {
    const Index a = std::max<Index>(i - 1, 0), b = std::min(i + 1, last);
    slope(i) = b > a ? (y(b) - y(a)) / (x[std::size_t(b)] - x[std::size_t(a)]) : 0.0;
  }
  return slope;
}

/// Derivatives of a curve's forces by what its rig adds, a column for each of `of_rigs`.
MatrixXd by_rig(const FitInput& input, std::size_t i, const VectorXd& fitted,
                const calibration::CurveFit& fit, const FitModels& models) {
  const Curve& curve = input.curves[i];
  if (!is_travel(input, i)) {
    MatrixXd columns = MatrixXd::Zero(fitted.size(), 4);
    columns.col(0) = -slope_of(curve.x, fitted);
    columns.col(1) = columns.col(0).cwiseProduct(fitted);
    columns.col(2).setOnes();
    return columns;
  }
  const Index material = Index(material_parameters(input));
  calibration::Rig rig = input.travels[i]->rig;
  VectorXd at(material + 4);
  at.head(material) = fit.estimates.head(material);
  Index next = material;
  for (calibration::RigQuantity* each :
       {&rig.touch_offset, &rig.compliance, &rig.force_offset, &rig.drift}) {
    at(next) = each->in(fit.estimates);
    each->place = next++;
  }
  return models.behind_rig(input, i, rig, curve, at.size())->evaluate(at).jacobian.rightCols(4);
}

/// Whether the fit seeks that of `of_rigs` itself.
bool is_fitted(const FitInput& input, std::size_t i, Index k) {
  if (!is_travel(input, i)) return false;
  const calibration::Rig& rig = input.travels[i]->rig;
  const calibration::RigQuantity* own[] = {&rig.touch_offset, &rig.compliance, &rig.force_offset,
                                           &rig.drift};
  return own[k]->place.has_value();
}

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

}  // namespace

std::vector<Suspect> suspects_of(const FitInput& input, const calibration::CurveFit& fit,
                                 const FitModels& models) {
  std::vector<Suspect> suspects;
  if (input.problem != CalibrationProblem::experiment || input.presses.empty()) return suspects;
  const Stack stack = stacked(input, fit);
  const std::size_t curves = input.curves.size();
  const auto suspect = [&](const std::string& name, const std::string& of, const char* cause,
                           const std::string& unit) -> Suspect& {
    const auto same = [&](const Suspect& each) { return each.name == name && each.of == of; };
    const auto known = std::ranges::find_if(suspects, same);
    if (known != suspects.end()) return *known;
    return suspects.emplace_back(Suspect{name, of, cause, unit, VectorXd::Zero(stack.values)});
  };
  std::set<std::string> machines;
  for (std::size_t i = 0; i < curves; ++i)
    machines.insert(is_travel(input, i) ? input.travels[i]->machine : "");
  for (std::size_t i = 0; i < curves; ++i) {
    const Curve& curve = input.curves[i];
    const std::string machine = is_travel(input, i) ? input.travels[i]->machine : "";
    const MatrixXd columns = by_rig(input, i, stack.fitted[i], fit, models);
    for (Index k = 0; k < 4; ++k) {
      const MaterialParameter parameter = of_rigs[k];
      const bool compliance = parameter == MaterialParameter::compliance;
      const std::string of = compliance ? machine : curve.name;
      const bool no_times = parameter == MaterialParameter::drift && curve.time.empty();
      if (no_times || is_fitted(input, i, k)) continue;
      const bool one = compliance ? machines.size() == 1 : curves == 1;
      suspect(std::string(calibration::name(parameter)), one ? "" : of, cause_of(parameter),
              std::string(calibration::unit(parameter)))
          .change.segment(stack.first[i], columns.rows()) = columns.col(k);
    }
    for (const Excess& excess : input.excesses) {
      const std::vector<double> relative = at_values(input, i, excess.at_samples[i]);
      suspect(excess.name, "", excess.cause, "1")
          .change.segment(stack.first[i], Index(relative.size())) =
          stack.fitted[i].cwiseProduct(VectorXd::Map(relative.data(), Index(relative.size())));
    }
  }
  return suspects;
}

}  // namespace fingertip::studies
