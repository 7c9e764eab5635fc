/// A model whose answers are kept in a file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "calibration/statistics/forward_model.h"

namespace fingertip::calibration::inline press_fit {

/// Answers of `model`, each computed once, also over several runs: a fit that was interrupted and
/// is started again replays what it has, bit for bit, and goes on from there.
///
/// The file has a line of JSON per answer: first {"model", "values", "parameters"}, what it belongs
/// to; then {"at": [...], "value": [...], "jacobian": [[...], ...]}, rows by values, or
/// {"at": [...], "not_converged": "why"}; a model of no slopes has rows without entries. Numbers
/// read back to the same bits. A line is written at once when its answer is known; a last line
/// without its end, cut by the end of a run, is removed.
class RememberedModel final : public ForwardModel {
 public:
  enum class Slopes { known, none };

  /// Keeps a reference to `model`, which has so many `values` and `parameters`; `what` says
  /// everything that its answers depend on besides; of no slopes its Jacobian has no column. Throws
  /// InvalidInput naming file and line for a file of another model or other sizes and for lines
  /// that are not as above; std::runtime_error where the file cannot be written.
  RememberedModel(ForwardModel& model, std::filesystem::path file, Eigen::Index values,
                  Eigen::Index parameters, const std::string& what, Slopes slopes = Slopes::known);

  /// Throws as the model does; NotConverged is remembered like an answer. Answers that are not
  /// finite are not remembered.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

  /// Answers known from the file or computed since.
  std::size_t known() const { return answers_.size(); }

 private:
  struct Answer {
    CurveSlopes slopes;
    std::string not_converged;  ///< empty: there is an answer
  };
  using Key = std::vector<unsigned char>;  ///< the parameters' bits

  static Key key(const Eigen::VectorXd& parameters);
  void read_answer(const std::string& line, int number);
  void append(const std::string& line) const;
  void keep(const Eigen::VectorXd& parameters, Answer answer);
  [[noreturn]] void refuse(int line, const std::string& value, const std::string& rule) const;

  ForwardModel* model_;
  std::filesystem::path file_;
  Eigen::Index values_, parameters_, columns_;
  std::map<Key, Answer> answers_;
};

}  // namespace fingertip::calibration::inline press_fit
