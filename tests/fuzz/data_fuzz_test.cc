// Damaged measurements, materials and what runs have left behind.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/material/material.h"
#include "calibration/material_tests/law_model.h"
#include "calibration/press_fit/remembered_model.h"
#include "calibration/surrogate/surrogate.h"
#include "campaign.h"
#include "fem_reference/job/job.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/csv_table.h"
#include "studies/config/loader.h"
#include "studies/files/json_entry.h"
#include "studies/jobs/cache.h"
#include "studies/jobs/result_files.h"
#include "studies/measurements/curve_file.h"
#include "studies/measurements/material_test_file.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using meshes::InvalidInput;

namespace {

const std::vector<std::string> json_words = {"{",    "}",    "[",     "]",       ",",   ":",
                                             "\"\"", "null", "true",  "1e999",   "{}",  "[]",
                                             "-",    "[[]]", "\"a\"", "\\ud800", "NaN", "//"};

bool all_finite(const std::vector<double>& values) {
  for (const double value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

bool increasing(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1])) return false;
  return true;
}

calibration::Material material(lattice::ModelKind model) {
  calibration::Material result;
  result.model = model;
  result.spacing = 1e-3;
  result.rubber = {3.4e5, 1.2e5, 1070.0, 1e-4, {}, {}};
  result.constants = lattice::hookean_constants(result.rubber, result.spacing);
  result.kinematics = lattice::Kinematics::finite;
  result.validity.largest_indentation = 2e-3;
  result.validity.thickness = 5e-3;
  result.validity.contacts = {meshes::ContactMode::stick, meshes::ContactMode::frictionless};
  result.provenance = "moduli";
  result.program = "fingertip";
  result.statement = "Both moduli are met.";
  return result;
}

}  // namespace

TEST(FuzzData, Materials) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "material.toml", again = folder / "again.toml";
  std::vector<std::string> seeds;
  for (const auto model : {lattice::ModelKind::hookean, lattice::ModelKind::network}) {
    calibration::write_material_toml(material(model), file);
    seeds.push_back(read_text(file));
  }
  const std::vector<std::string> words = {"[constants]\n",
                                          "k1 = \"1 N/m\"\n",
                                          "kappa = \"-3 Pa\"\n",
                                          "[validity]\n",
                                          " N/m",
                                          "\"stick\"",
                                          "contacts = []\n",
                                          "\"small\"",
                                          "model_error = -1\n",
                                          "nan",
                                          "rod_ratio = 2\n",
                                          "[",
                                          "]",
                                          "\"",
                                          "=",
                                          "[[lattice]]\n",
                                          "{}",
                                          "smallest_spacing = \"1 m\"\n"};
  fuzz::attack(
      {seeds, words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
        write_text(file, input);
        const calibration::Material material = calibration::read_material_toml(file);
        EXPECT_TRUE(material.violations().empty());
        const double nu = material.rubber.poissons_ratio();
        EXPECT_TRUE(nu > -1.0 && nu < 0.5) << nu;
        EXPECT_TRUE(material.spacing > 0.0 && std::isfinite(material.spacing));
        for (const double k : {material.constants.k1, material.constants.k2, material.constants.k3})
          EXPECT_TRUE(std::isfinite(k) && k >= 0.0) << k;
        EXPECT_TRUE(std::isfinite(material.constants.kappa));
        calibration::write_material_toml(material, again);
        const std::string text = read_text(again);
        calibration::write_material_toml(calibration::read_material_toml(again), again);
        EXPECT_EQ(read_text(again), text);
      }));
}

TEST(FuzzData, MeasuredCurves) {
  using namespace studies;
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "curve.csv";
  std::string dense = "time [s]; creep [1]; sigma [1]\n";
  for (int i = 1; i < 260; ++i)
    dense += std::to_string(0.01 * i) + ";" + std::to_string(1.0 + 0.001 * i) + ";0.01\n";
  const std::vector<std::string> seeds = {
      "# press.contact = \"stick\"\nindentation [mm], force [mN], sigma [mN]\n0.1, 3.5, 0.2\n"
      "0.2, 9.7, 0.2\n\n0.5, 41, 0.3\n",
      "\xEF\xBB\xBFindentation [cm];normal_force [gf];force_error "
      "[gf]\r\n0;0;\r\n1e-2;0.12;0.01\r\n",
      "frequency [Hz], loss_factor [1]\n1, 0.01\n10, 0.09\n", dense};
  const std::vector<std::string> words = {"[mm]",
                                          "[",
                                          "]",
                                          ";",
                                          ",",
                                          "\t",
                                          "# press.depth=1 cm\n",
                                          "#",
                                          "\"",
                                          "sigma [N]",
                                          "force [N]",
                                          "\n-1;-1\n",
                                          "stretch [1]",
                                          "time [s]",
                                          "[1]",
                                          "1e61",
                                          "1e-61",
                                          "indentation [kg]",
                                          "\r"};
  const std::vector<CurveQuantities> allowed = {measured::press, measured::vibration,
                                                measured::creep, measured::relaxation};
  fuzz::attack({seeds, words}, fuzz::refusing<ConfigError>([&](const std::string& input) {
                 write_text(file, input);
                 const MeasuredFile measured = read_measured({file}, allowed).at(0);
                 const calibration::Curve& curve = measured.curve;
                 EXPECT_FALSE(curve.x.empty());
                 EXPECT_LE(curve.x.size(), 200U);
                 EXPECT_EQ(curve.y.size(), curve.x.size());
                 EXPECT_TRUE(curve.sigma.empty() || curve.sigma.size() == curve.x.size());
                 EXPECT_TRUE(all_finite(curve.x) && all_finite(curve.y) && all_finite(curve.sigma));
                 EXPECT_TRUE(increasing(curve.x) && curve.x.front() > 0.0);
                 for (const double sigma : curve.sigma) EXPECT_GT(sigma, 0.0);
               }));
}

// Files of machines with their descriptions. What is refused is refused with file and line.
TEST(FuzzData, PressFiles) {
  using namespace studies;
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "press.toml", data = folder / "press.csv";
  const std::string cut = "\n====\n";  // between description and data
  const std::string path = "[[press]]\npath = \"press.csv\"\n";
  std::string loop = "Zeit;Weg;Kraft\ns;mm;N\n";
  for (int i = 0; i < 240; ++i)
    loop += fmt::format("00:00:{:02d},5;{};{}\n", i % 60,
                        i < 120   ? i
                        : i < 180 ? 120
                                  : 299 - i,
                        i < 120 ? i * i : 13000 - i * i / 10);
  const std::vector<std::string> seeds = {
      path + cut + "remark\nposition [mm], force (N)\n0.1, 0\n0.2, 1.5\n0.4, 4\nMean, 2\n",
      path + cut +
          "Probe 1\nWeg [mm];Kraft [N]\n0,1;0\n0,2;1.234,5\n\nProbe 2\n"
          "Weg [mm];Kraft [N]\n0,1;0\n0,2;1,5\n",
      "[data]\nseparator = \"whitespace\"\nposition = {column = 2, unit = \"um\", sign = -1}\n"
      "force = {column = \"fz\", unit = \"gf\"}\n" +
          path + "rows = [1, 2]\n" + cut + "t z fz\n0 -10 0\n1 -20 1\n2 -30 3\n",
      path + "decimal = \"comma\"\ncondition = \"press.contact = stick\"\n" + cut + loop,
      path +
          "header = false\nposition = {column = 1, unit = \"mm\"}\n"
          "force = {column = 2, unit = \"N\"}\nsigma = {column = 3, unit = \"N\"}\n" +
          cut + "ready\n\"0.1\",\"1,234.5\",1\n0.2,2000,1\n"};
  const std::vector<std::string> words = {"[[press]]\n",
                                          "path = \"press.csv\"\n",
                                          "block = 2\n",
                                          "skip = 1\n",
                                          "header = false\n",
                                          "sign = -1",
                                          "column = 3",
                                          "unit = \"mm\"",
                                          "rows = [1, 2]\n",
                                          "condition = \"\"\n",
                                          "\"",
                                          ";",
                                          "\t",
                                          ",",
                                          "\xFF\xFE",
                                          "\xB5m",
                                          "sep=;\n",
                                          "nan",
                                          "1e61",
                                          "12:00:00",
                                          "Mean;1\n",
                                          "Weg [mm];Kraft [N]\n",
                                          "\xC2\xA0",
                                          "1.234.567,8"};
  fuzz::attack({seeds, words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 const std::size_t at = input.find(cut);
                 write_text(file, input.substr(0, at));
                 write_text(data, at == input.npos ? loop : input.substr(at + cut.size()));
                 try {
                   for (const CurveSource& source : curve_sources(file))
                     for (const MeasuredFile& measured :
                          read_measured(source, {measured::press, measured::travel})) {
                       const calibration::Curve& curve = measured.curve;
                       EXPECT_FALSE(curve.x.empty());
                       EXPECT_LE(curve.x.size(), 200U);
                       EXPECT_EQ(curve.y.size(), curve.x.size());
                       EXPECT_EQ(measured.lines.size(), curve.x.size());
                       EXPECT_TRUE(all_finite(curve.x) && all_finite(curve.y));
                       EXPECT_TRUE(all_finite(curve.sigma) && all_finite(curve.time));
                       EXPECT_TRUE(increasing(curve.x));
                     }
                 } catch (const ConfigError& error) {
                   for (const meshes::Violation& problem : error.violations())
                     EXPECT_NE(problem.place.find(folder.path().string()), std::string::npos)
                         << problem.place;
                   throw;
                 }
               }));
}

// Descriptions of material tests, in time and not, with the data that belong to them.
TEST(FuzzData, MaterialTests) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "tests.toml", data = folder / "data.csv";
  const std::string rows = "t,l,s\n0,1,0\n0.1,1.2,5\n0.2,1.5,9\n1,1.5,8\n2,1.501,7\n";
  const std::string cut = "\n====\n";  // between description and data
  const std::string common =
      "path = \"data.csv\"\nstress = {column = \"s\", is = \"nominal\", unit = \"kPa\"}\n";
  const std::string column = "strain = {column = \"l\", is = \"stretch\"}\n",
                    time = "time = {column = \"t\", unit = \"s\"}\n";
  const std::vector<std::string> seeds = {
      "[[test]]\nkind = \"relaxation\"\n" + common + column + time + cut + rows,
      "[[test]]\nkind = \"relaxation\"\nrate = \"5 1/s\"\n" + common + time +
          "strain = {value = 50, is = \"engineering\", unit = \"%\"}\n" + cut + rows,
      "[[test]]\nkind = \"cycles\"\ndeformation = \"planar\"\npoints = 3\n" + common + column +
          time + cut + rows,
      "[about]\nmaterial = \"m\"\n[data]\n" + column +
          "[[test]]\nkind = \"uniaxial\"\nrate = \"1 1/s\"\nrows = [1, 3]\n" + common + cut + rows};
  const std::vector<std::string> words = {"[[test]]\n",
                                          "kind = \"cycles\"\n",
                                          "from = \"hold\"",
                                          "value = -1",
                                          "deformation = \"simple-shear\"\n",
                                          "use = \"predict\"\n",
                                          "rate = \"1e300 1/s\"\n",
                                          "unit = \"ms\"",
                                          "rows = [1, 2]\n",
                                          "1e59",
                                          "-1e-300",
                                          "nan",
                                          "0,1,1\n",
                                          "points = 2\n",
                                          "sign = -1",
                                          "{",
                                          "}",
                                          "\"",
                                          "=",
                                          "is = \"logarithmic\"",
                                          "length = \"1 mm\"\n"};
  fuzz::attack({seeds, words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 const std::size_t at = input.find(cut);
                 write_text(file, input.substr(0, at));
                 write_text(data, at == input.npos ? rows : input.substr(at + cut.size()));
                 const studies::MaterialTestFile found = studies::read_material_tests(file);
                 EXPECT_FALSE(found.fitted.empty());
                 for (const calibration::MaterialTest& test : found.fitted) {
                   EXPECT_TRUE(test.violations().empty());
                   EXPECT_TRUE(all_finite(test.stress) && all_finite(test.all_deformations()));
                   EXPECT_TRUE(increasing(test.time));
                   if (test.kind == calibration::TestKind::volumetric) continue;
                   const calibration::LawChoice law{meshes::RubberLaw::neo_hookean, 1, 1};
                   calibration::LawModel model(test, std::vector<double>(test.stress.size(), 1.0),
                                               law, coefficients(law));
                   const auto answer = model.evaluate(Eigen::Vector3d(1e4, 0.3, 0.5));
                   EXPECT_TRUE(answer.value.allFinite() && answer.jacobian.allFinite());
                 }
               }));
}

TEST(FuzzData, StiffnessSchedules) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "surrogate.json";
  std::vector<calibration::SurrogateSample> samples;
  for (int i = 1; i <= 8; ++i) {
    const double depth = 4e-4 * i;
    samples.push_back({depth, 900.0 * std::pow(depth, 1.5), 1e-4});
  }
  write_surrogate_json(calibration::fit_surrogate(samples), file);
  fuzz::attack({{read_text(file)}, json_words},
               fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const calibration::Surrogate surrogate = calibration::read_surrogate_json(file);
                 EXPECT_TRUE(surrogate.table().violations().empty());
                 const double round_off = 1e-8 * surrogate.table().force.back();
                 double before = 0.0;
                 for (const double part : {-1.0, 0.0, 0.3, 0.7, 1.0, 1.5}) {
                   const double at = part * surrogate.depth(), force = surrogate.force(at);
                   EXPECT_TRUE(std::isfinite(force) && force >= before - round_off) << force;
                   EXPECT_TRUE(surrogate.stiffness(at) >= 0.0 && surrogate.band(at) >= 0.0);
                   before = force;
                 }
               }));
}

TEST(FuzzData, Responses) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "response.csv";
  meshes::PressResponse response;
  for (int i = 1; i < 6; ++i) {
    meshes::PressSample sample;
    sample.indentation = 5e-4 * i;
    sample.normal_force = 0.1 * i;
    if (i > 2) sample.time = 0.01 * i;
    response.append(sample);
  }
  response.write_csv(file);
  const std::vector<std::string> words = {
      ",",        "\n", "normal_force [N]", "indentation [m]", "[", "#", " ", "\"", "nan",
      "time [s]", ";"};
  fuzz::attack({{read_text(file), "normal_force [N], indentation [m]\r\n0.5, 1e-3\r\n"}, words},
               fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const meshes::PressResponse found = meshes::PressResponse::read_csv(file);
                 double before = -INFINITY;
                 for (const meshes::PressSample& sample : found.samples()) {
                   EXPECT_TRUE(std::isfinite(sample.indentation));
                   EXPECT_TRUE(std::isfinite(sample.normal_force));
                   EXPECT_GT(sample.indentation, before);
                   before = sample.indentation;
                 }
               }));
}

namespace {

/// Two answers for two parameters.
class Plain final : public calibration::ForwardModel {
 public:
  calibration::CurveSlopes evaluate(const Eigen::VectorXd& at) override {
    return {at, Eigen::MatrixXd::Identity(2, 2)};
  }
};

}  // namespace

TEST(FuzzData, AnswersKeptByACalibration) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "evaluations.jsonl";
  Plain plain;
  {
    calibration::RememberedModel model(plain, file, 2, 2, "a press");
    for (const double value : {1.0, 0.1, 1e-300}) model.evaluate(Eigen::Vector2d(value, -value));
  }
  fuzz::attack({{read_text(file)}, json_words},
               fuzz::refusing<InvalidInput, meshes::NotConverged>([&](const std::string& input) {
                 write_text(file, input);
                 calibration::RememberedModel model(plain, file, 2, 2, "a press");
                 const calibration::CurveSlopes slopes = model.evaluate(Eigen::Vector2d(0.5, 0.5));
                 EXPECT_EQ(slopes.value.size(), 2);
                 EXPECT_TRUE(slopes.value.allFinite() && slopes.jacobian.allFinite());
               }));
}

TEST(FuzzData, OrdersForTheContinuum) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "job.json";
  std::vector<std::string> seeds;
  fem_reference::ReferenceJob job;
  job.press_to({1e-3, 2e-3});
  write_job(job, file);
  seeds.push_back(read_text(file));
  job.analysis = fem_reference::Analysis::modes;
  write_job(job, file);
  seeds.push_back(read_text(file));
  std::vector<std::string> words = json_words;
  words.insert(words.end(), {"\"finite\"", "\"degree\": 4294967298,", "\"modes\": 1e99,",
                             "\"samples\": [],", "\"verification\""});
  fuzz::attack({seeds, words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const fem_reference::ReferenceJob found = fem_reference::read_job(file);
                 EXPECT_TRUE(found.violations().empty());
                 EXPECT_TRUE(all_finite(found.protocol.samples));
                 write_job(found, file);
                 const std::string text = read_text(file);
                 write_job(fem_reference::read_job(file), file);
                 EXPECT_EQ(read_text(file), text);
               }));
}

TEST(FuzzData, JsonAndTablesOfRunFolders) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "summary.json";
  const std::string summary = R"({"status": "finished", "depths": [0.001, 0.002], "models":
  {"hookean": {"E_100": 4000.5, "status": "ok", "force_error": [0.01, null]}}})";
  fuzz::attack({{summary}, json_words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const studies::JsonEntry entry = studies::read_entry(file);
                 EXPECT_TRUE(entry.is_object());
                 for (const double depth : studies::numbers_if_any(entry, "depths"))
                   EXPECT_FALSE(std::isinf(depth));
                 studies::object_at(entry, "models");
               }));
  fuzz::attack({{summary}, json_words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 EXPECT_FALSE(studies::parse_json(file).is_discarded());
               }));
  fuzz::attack({{"time [s],speed [m/s]\n0,0.1\n# a remark\n1,\"0.2\"\n", "a\n1\n2\n"},
                {",", "\"", "\"\"", "\n", "#", "[m]", "\r"}},
               fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const auto table = meshes::read_csv(file);
                 for (const std::string& name : table.names)
                   EXPECT_EQ(table.numbers(name).size(), table.rows.size());
               }));
}

// A marker speaks for a job when it is whole and names it, and never ends the program.
TEST(FuzzData, MarkersOfFinishedJobs) {
  const TemporaryFolder folder;
  studies::Job job;
  job.kind = "test";
  job.inputs = {{"depth", 0.003}};
  studies::mark(job, folder.path(), studies::finished, 1.0);
  fuzz::attack({{read_text(folder / studies::marker_name)}, json_words},
               [&](const std::string& input) {
                 write_text(folder / studies::marker_name, input);
                 const bool marked = !studies::marked_status(job, folder.path()).empty();
                 EXPECT_TRUE(!marked || input.find(job.key()) != input.npos);
                 return marked;
               });
}
