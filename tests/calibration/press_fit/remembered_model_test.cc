/// A fit that is interrupted and started again does not evaluate anything twice and ends at the
/// same bits; files that are not its own are refused.
#include "calibration/press_fit/remembered_model.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/calibration/fit_fixtures.h"
#include "tests/temporary_folder.h"

using namespace fit_fixtures;

namespace {

/// Counts.
class CountedModel final : public ForwardModel {
 public:
  explicit CountedModel(ForwardModel& model) : model_(model) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    ++calls;
    return model_.evaluate(parameters);
  }
  int calls = 0;

 private:
  ForwardModel& model_;
};

const std::vector<double> few = {4e-4, 8e-4};

/// A fit to a frictionless and a sticking press; counts evaluations of the lattice.
struct PressFit {
  PressFit()
      : slide(with_samples(press(ContactMode::frictionless), few), {youngs_modulus, shear_modulus}),
        hold(with_samples(press(ContactMode::stick), few), {youngs_modulus, shear_modulus}) {}

  CurveFit run(const CurveFitOptions& options, const TemporaryFolder* folder) {
    const std::vector<Curve> curves = {synthetic(ContactMode::frictionless, few, 0.01, 1, true),
                                       synthetic(ContactMode::stick, few, 0.01, 2, true)};
    if (!folder) return fit_curves(curves, {&counted_slide, &counted_hold}, options);
    RememberedModel first(counted_slide, *folder / "slide.jsonl", 2, 2, "slide");
    RememberedModel second(counted_hold, *folder / "hold.jsonl", 2, 2, "hold");
    return fit_curves(curves, {&first, &second}, options);
  }

  LatticeForwardModel slide, hold;
  CountedModel counted_slide{slide}, counted_hold{hold};
};

/// y = a x², at 1, 2; no answer at a > 9.
FormulaModel square(int& calls) {
  return FormulaModel([&calls](const VectorXd& p) {
    ++calls;
    if (p(0) > 9.0) throw meshes::NotConverged("too stiff");
    const MatrixXd design = Eigen::Vector2d(1.0 / 3.0, 4.0);
    return CurveSlopes{design * p, design};
  });
}

}  // namespace

TEST(RememberedModel, AnInterruptedFitGoesOnAndEndsAtTheSameBits) {
  const TemporaryFolder folder;
  PressFit whole, parts;
  const CurveFit expected = whole.run(e_and_g(), nullptr);
  CurveFitOptions options = e_and_g();
  options.progress = [](int evaluations, double) { return evaluations < 3; };
  EXPECT_THROW(parts.run(options, &folder), meshes::Interrupted);
  EXPECT_EQ(parts.counted_slide.calls, 3);
  const CurveFit fit = parts.run(e_and_g(), &folder);
  EXPECT_EQ(fit.estimates, expected.estimates);
  EXPECT_EQ(fit.covariance, expected.covariance);
  EXPECT_EQ(fit.evaluations, expected.evaluations);
  EXPECT_GT(whole.counted_slide.calls, 3);
  EXPECT_EQ(parts.counted_slide.calls, whole.counted_slide.calls);
  EXPECT_EQ(parts.counted_hold.calls, whole.counted_hold.calls);
  parts.run(e_and_g(), &folder);
  EXPECT_EQ(parts.counted_slide.calls, whole.counted_slide.calls);
}

TEST(RememberedModel, KeepsFailuresAndForgetsACutLine) {
  const TemporaryFolder folder;
  const auto file = folder / "square.jsonl";
  int calls = 0;
  FormulaModel model = square(calls);
  const VectorXd at = VectorXd::Constant(1, 0.1), stiff = VectorXd::Constant(1, 10.0);
  {
    RememberedModel remembered(model, file, 2, 1, "square");
    EXPECT_EQ(remembered.evaluate(at).value(0), 0.1 / 3.0);
    EXPECT_THROW(remembered.evaluate(stiff), meshes::NotConverged);
  }
  const std::string text = read_text(file);
  write_text(file, text + "{\"at\": [3.0], \"val");
  RememberedModel remembered(model, file, 2, 1, "square");
  EXPECT_EQ(read_text(file), text);
  EXPECT_EQ(remembered.known(), 2u);
  EXPECT_EQ(remembered.evaluate(at).value(0), 0.1 / 3.0);
  EXPECT_EQ(remembered.evaluate(at).jacobian(0, 0), 1.0 / 3.0);
  EXPECT_THROW(remembered.evaluate(stiff), meshes::NotConverged);
  EXPECT_EQ(calls, 2);
  // One bit apart is another point.
  remembered.evaluate(VectorXd::Constant(1, std::nextafter(0.1, 1.0)));
  EXPECT_EQ(calls, 3);
}

TEST(RememberedModel, RefusesOtherFilesWithTheirLine) {
  const TemporaryFolder folder;
  const auto file = folder / "square.jsonl";
  int calls = 0;
  FormulaModel model = square(calls);
  const auto said = [&](const std::string& text, Index values = 2) {
    write_text(file, text);
    const std::string message = refusal([&] { RememberedModel(model, file, values, 1, "square"); });
    EXPECT_EQ(read_text(file), text) << "a file that is not ours must stay";
    return message;
  };
  const auto expect = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  { RememberedModel(model, file, 2, 1, "square").evaluate(VectorXd::Constant(1, 2.0)); }
  const std::string good = read_text(file);
  expect(said(good, 3), "square.jsonl:1");
  expect(said("{\"model\":\"cube\",\"values\":2,\"parameters\":1}\n"), "square.jsonl:1");
  expect(said("x,y\n1,2\n"), "square.jsonl:1");
  expect(said("no line at all"), "square.jsonl:1");
  expect(said(good + "{\"at\":[1.0],\"value\":[1.0],\"jacobian\":[[1.0],[1.0]]}\n"),
         "square.jsonl:3");
  expect(said(good + "{\"at\":[1.0],\"value\":[1.0,2.0],\"jacobian\":[[1.0]]}\n"),
         "square.jsonl:3");
  expect(said(good + "{\"at\":[1.0]\n" + good), "square.jsonl:3");
  // A header cut in the middle is our own file, without an answer yet.
  write_text(file, good.substr(0, 10));
  EXPECT_EQ(RememberedModel(model, file, 2, 1, "square").known(), 0u);
}
