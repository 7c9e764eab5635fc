#include "tests/studies/report/synthetic_fit.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "tests/studies/report/synthetic_run.h"

namespace fingertip::report_testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double E = 4000.0, G = 1400.0, sd_E = 80.0, sd_G = 42.0, rho = 0.6;

/// Chi-square over its minimum of the normal distribution with these deviations.
double increase(double e, double g) {
  const double u = (e - E) / sd_E, v = (g - G) / sd_G;
  return (u * u - 2.0 * rho * u * v + v * v) / (1.0 - rho * rho);
}

json profile() {
  json first = json::array(), second = json::array(), rows = json::array();
  for (int i = -4; i <= 4; ++i) {
    first.push_back(E + 0.875 * i * sd_E), second.push_back(G + 0.875 * i * sd_G);
    json row = json::array();
    for (int j = -4; j <= 4; ++j)
      row.push_back(increase(E + 0.875 * i * sd_E, G + 0.875 * j * sd_G));
    rows.push_back(row);
  }
  return {{"first", "youngs_modulus"},
          {"second", "shear_modulus"},
          {"first_values", first},
          {"second_values", second},
          {"increase", rows}};
}

json parameter(const std::string& name, double estimate, double deviation, double start) {
  return {{"name", name},
          {"unit", "Pa"},
          {"estimate", estimate},
          {"standard_error", deviation},
          {"lower", estimate - 1.96 * deviation},
          {"upper", estimate + 1.96 * deviation},
          {"at_bound", false},
          {"start", start},
          {"prior", nullptr},
          {"bias", nullptr}};
}

json curve(const std::string& name, double left_out) {
  return {
      {"name", name},
      {"condition", name == "stick" ? "stick, tilt 20 deg" : ""},
      {"points", 5},
      {"worst_relative_residual", 0.0196},
      {"rms_relative_residual", 0.0123},
      {"structure",
       {{"runs", 1}, {"probability", 0.0042}, {"statement", "One run: the model is too soft."}}},
      {"left_out", {{"estimates", {E, G}}, {"worst_relative_error", left_out}}}};
}

}  // namespace

json fit_result() {
  json youngs = parameter("youngs_modulus", E, sd_E, 3900.0);
  youngs["prior"] = {{"mean", 3922.66}, {"deviation", 98.0665}};
  youngs["bias"] = -120.0;
  return {{"problem", "curve"},
          {"model", "hookean"},
          {"spacing", 0.001},
          {"forward", "lattice"},
          {"constants", {{"k1", 1.4}, {"k2", 1.4}, {"k3", 0.0}, {"kappa", 7700.0}}},
          {"damping", {{"retardation_time", 3e-4}}},
          {"target", nullptr},
          {"achieved", nullptr},
          {"parameters", {youngs, parameter("shear_modulus", G, sd_G, 1350.0)}},
          {"covariance", {{sd_E * sd_E, rho * sd_E * sd_G}, {rho * sd_E * sd_G, sd_G * sd_G}}},
          {"correlation", {{1.0, rho}, {rho, 1.0}}},
          {"singular_values", {250.0, 3.0}},
          {"unidentifiable",
           {{{"direction", {{"youngs_modulus", 1.0}, {"shear_modulus", 0.7}}},
             {"relative_singular_value", 0.012},
             {"interval", 0.35},
             {"statement", "E and G that rise together leave the force as it is."}}}},
          {"only_from_priors", json::array()},
          {"degrees_of_freedom", 8},
          {"chi_square", 40.0},
          {"chi_square_probability", 3.2e-6},
          {"birge_ratio", 1.0},
          {"residual_deviation", 0.002},
          {"residuals", {{0.01}, {0.02}}},
          {"influence", {{1.0}, {1.0}}},
          {"minima",
           {{{"estimates", {2500.0, 1500.0}}, {"loss", 333.0}, {"iterations", 9}},
            {{"estimates", {E, G}}, {"loss", 20.0}, {"iterations", 5}}}},
          {"x_quantity", "indentation [m]"},
          {"y_quantity", "force [N]"},
          {"curves", {curve("frictionless", 0.034), curve("stick", 0.077)}},
          {"profile", profile()},
          {"iterations", 5},
          {"evaluations", 21},
          {"wall_time", 12.0},
          {"validity",
           {{"largest_strain_measure", 0.2},
            {"spacing", nullptr},
            {"poissons_ratio", nullptr},
            {"model", "hookean"},
            {"kinematics", nullptr}}},
          {"statement", "Two presses were fitted."}};
}

void write_fit(const fs::path& folder, const json& result) {
  write_file(folder / "calibration.json", result.dump(1));
  std::string rows = "curve,x,measured,sigma,fitted,left_out\n";
  for (const auto& [name, factor] : {std::pair{"frictionless", 1.0}, {"stick", 1.1}}) {
    for (int i = 1; i <= 5; ++i) {
      const double x = 4e-4 * i, fitted = factor * 1000.0 * std::pow(x, 1.5);
      rows += fmt::format("{},{},{},{},{},{}\n", name, x, 1.02 * fitted, 0.01 * fitted, fitted,
                          0.97 * fitted);
    }
  }
  write_file(folder / "fit_data.csv", rows);
}

void write_surrogate(const fs::path& folder) {
  std::string rows = "indentation [m],force [N],stiffness [N/m],force_lower [N],force_upper [N]\n";
  for (int i = 0; i <= 20; ++i) {
    const double x = 1e-4 * i;
    rows += fmt::format("{},{},100,{},{}\n", x, 100.0 * x, 96.0 * x, 104.0 * x);
  }
  write_file(folder / "surrogate.csv", rows);
  const json notes = {{"knots", {0.0, 0.001, 0.002}},
                      {"force", {0.0, 0.1, 0.2}},
                      {"stiffness", {100.0, 100.0, 100.0}},
                      {"band", {0.0, 0.004, 0.008}},
                      {"statement", "Three knots."},
                      {"condition", "frictionless"},
                      {"units", json::object()}};
  write_file(folder / "surrogate.json", notes.dump());
}

void write_transfer_study(const fs::path& folder) {
  std::string rows =
      "fit,prediction,model,indentation [m],normal_force [N],reference_force [N],reference_error,"
      "relative_error,status\n";
  struct Prediction {
    const char *fit, *asked;
    double worst;
  };
  for (const Prediction& prediction : {Prediction{"alone", "stick", 0.03},
                                       {"alone", "tilted", 0.25},
                                       {"both", "stick", -0.01},
                                       {"both", "tilted", 0.04}}) {
    for (const double depth : {0.001, 0.002}) {
      const double error = prediction.worst * depth / 0.002, force = 50.0 * depth;
      rows += fmt::format("{},{},hookean,{},{},{},0.004,{},finished\n", prediction.fit,
                          prediction.asked, depth, force * (1.0 + error), force, error);
    }
  }
  write_file(folder / "transfer.csv", rows);
  json fits = json::array();
  for (const char* name : {"alone", "both"}) {
    const std::string place = std::string("fits/") + name;
    fits.push_back({{"name", name}, {"folder", place}, {"model", "hookean"}, {"problem", "curve"}});
    write_fit(folder / place, fit_result());
  }
  const json truth = {{"youngs_modulus", 4100.0}, {"shear_modulus", 1300.0}};
  const json summary = {
      {"case", "07_transfer"},
      {"title", "Transfer"},
      {"description", ""},
      {"status", "ok"},
      {"criteria", {{{"name", "carries"}, {"value", 0.04}, {"limit", 0.1}, {"passed", true}}}},
      {"calibration",
       {{"fits", fits},
        {"predictions", {{{"name", "stick"}}, {{"name", "tilted"}}}},
        {"worst_error", {{0.03, 0.25}, {0.01, 0.04}}},
        {"truth", {{"parameters", truth}}}}}};
  write_file(folder / "summary.json", summary.dump());
}

}  // namespace fingertip::report_testing
