#include "calibration/press_fit/remembered_model.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::json;

namespace {

json to_json(const VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// Throws json::exception for what is not a list of `count` numbers.
VectorXd to_vector(const json& list, Index count) {
  const auto values = list.get<std::vector<double>>();
  if (Index(values.size()) != count)
    throw json::other_error::create(
        500, std::to_string(values.size()) + " numbers, not " + std::to_string(count), &list);
  return Eigen::Map<const VectorXd>(values.data(), count);
}

}  // namespace

RememberedModel::Key RememberedModel::key(const VectorXd& parameters) {
  Key key(std::size_t(parameters.size()) * sizeof(double));
  std::memcpy(key.data(), parameters.data(), key.size());
  return key;
}

void RememberedModel::refuse(int line, const std::string& value, const std::string& rule) const {
  throw meshes::InvalidInput({file_.string() + ":" + std::to_string(line), value, rule,
                              "remove the file to compute its answers anew"});
}

/// Reads lines up to the last end of a line; the rest is cut off once they have proved to be ours.
RememberedModel::RememberedModel(ForwardModel& model, std::filesystem::path file, Index values,
                                 Index parameters, const std::string& what, Slopes slopes)
    : model_(&model),
      file_(std::move(file)),
      values_(values),
      parameters_(parameters),
      columns_(slopes == Slopes::known ? parameters : 0) {
  const std::string header =
      json{{"model", what}, {"values", values}, {"parameters", parameters}}.dump();
  std::ifstream in(file_, std::ios::binary);
  std::stringstream content;
  if (in) content << in.rdbuf();
  in.close();
  const std::string text = content.str();
  const std::size_t complete = text.rfind('\n') + 1;
  if (complete == 0 ? !header.starts_with(text) : !text.starts_with(header + '\n'))
    refuse(1, text.substr(0, std::min<std::size_t>(text.find('\n'), 200)),
           "the file must be that of " + header);
  std::istringstream lines(text.substr(0, complete));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (number > 1) read_answer(line, number);
  if (complete < text.size()) std::filesystem::resize_file(file_, complete);
  if (complete == 0) append(header);
}

void RememberedModel::read_answer(const std::string& line, int number) {
  try {
    const json found = json::parse(line);
    const VectorXd at = to_vector(found.at("at"), parameters_);
    Answer answer;
    if (found.contains("not_converged")) {
      answer.not_converged = found.at("not_converged").get<std::string>();
    } else {
      answer.slopes.value = to_vector(found.at("value"), values_);
      answer.slopes.jacobian.resize(values_, columns_);
      const json& rows = found.at("jacobian");
      if (Index(rows.size()) != values_) refuse(number, "jacobian", "it has a row per value");
      for (Index i = 0; i < values_; ++i)
        answer.slopes.jacobian.row(i) = to_vector(rows.at(std::size_t(i)), columns_);
    }
    answers_[key(at)] = std::move(answer);
  } catch (const json::exception& error) {
    refuse(number, line.substr(0, 60), std::string("a line is an answer: ") + error.what());
  }
}

void RememberedModel::append(const std::string& line) const {
  // Not through write_atomically: that would copy all answers for every new one.
  std::ofstream out(file_, std::ios::binary | std::ios::app);
  out << line << '\n' << std::flush;
  if (!out) throw meshes::CannotWrite("cannot write " + file_.string());
}

void RememberedModel::keep(const VectorXd& parameters, Answer answer) {
  json line = {{"at", to_json(parameters)}};
  if (answer.not_converged.empty()) {
    line["value"] = to_json(answer.slopes.value);
    line["jacobian"] = json::array();
    for (Index i = 0; i < values_; ++i)
      line["jacobian"].push_back(to_json(answer.slopes.jacobian.row(i)));
  } else {
    line["not_converged"] = answer.not_converged;
  }
  append(line.dump());
  answers_[key(parameters)] = std::move(answer);
}

CurveSlopes RememberedModel::evaluate(const VectorXd& parameters) {
  const auto found = answers_.find(key(parameters));
  if (found != answers_.end()) {
    if (found->second.not_converged.empty()) return found->second.slopes;
    throw meshes::NotConverged(found->second.not_converged);
  }
  Answer answer;
  try {
    answer.slopes = model_->evaluate(parameters);
  } catch (const meshes::NotConverged& error) {
    answer.not_converged = error.what();
    if (answer.not_converged.empty()) answer.not_converged = "not converged";
    keep(parameters, answer);
    throw;
  }
  const CurveSlopes& slopes = answer.slopes;
  if (slopes.value.size() != values_ || slopes.jacobian.rows() != values_ ||
      slopes.jacobian.cols() != columns_)
    throw meshes::InvalidInput({file_.string(), std::to_string(slopes.value.size()) + " values",
                                "the model must have the sizes it was announced with",
                                "announce its own"});
  if (slopes.value.allFinite() && slopes.jacobian.allFinite()) keep(parameters, answer);
  return answer.slopes;
}

}  // namespace fingertip::calibration::inline press_fit
