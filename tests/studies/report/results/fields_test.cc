// Files of a run folder that lack a field: the report must name the file and the field. What the
// fields are is told by their tables alone.

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "lattice/grasp/grasp_table.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "studies/files/grasp_summary.h"
#include "studies/files/plan_file.h"
#include "studies/report/report.h"
#include "studies/report/results/calibration_data.h"
#include "studies/report/results/grasp_run.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_fit.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using namespace studies;
using meshes::Presence;
using nlohmann::json;
using report_testing::write_file;

/// "place: rule" of everything that is wrong with a run, without its page.
std::string damage_of(const fs::path& run) {
  FolderReader reader;
  const report::RunData data = report::read_run(run, reader);
  report::read_calibration(data, reader);
  if (fs::exists(run / "grasp.csv")) report::read_grasp(run, "", "grasp", reader);
  std::string text;
  for (const meshes::Violation& violation : reader.damage()) text += to_string(violation) + "\n";
  return text;
}

/// A file, put back as it was in the end.
class Changed {
 public:
  explicit Changed(const fs::path& file) : file_(file), before_(read_text(file)) {}
  ~Changed() { write_file(file_, before_); }
  const std::string& text() const { return before_; }
  void become(const std::string& text) const { write_file(file_, text); }

 private:
  fs::path file_;
  std::string before_;
};

/// Renames each column that every file has.
template <typename Row>
void expect_columns_missed(const fs::path& run, const fs::path& file) {
  ASSERT_TRUE(fs::exists(run / file)) << file;
  for (const std::string& column : meshes::column_names<Row>(true)) {
    const Changed changed(run / file);
    const std::size_t line = changed.text().find('\n');
    std::string names = "," + changed.text().substr(0, line) + ",";
    const std::size_t at = names.find("," + column + ",");
    ASSERT_NE(at, names.npos) << file << " lacks " << column << ": " << names;
    names.replace(at, column.size() + 2, ",other " + column + ",");
    changed.become(names.substr(1, names.size() - 2) + changed.text().substr(line));
    const std::string damage = damage_of(run);
    EXPECT_TRUE(says(damage, file.string() + ": the column '" + column + "' is missing"))
        << file << column;
  }
}

/// Paths of the entries that an object of this kind must have, of lists the first element's.
template <typename Value>
void required_entries(const json& content, const json::json_pointer& at, const Value& value,
                      std::set<std::string>& found) {
  if constexpr (meshes::HasFields<Value>) {
    meshes::for_each_field<Value>([&](const auto& field) {
      if (!field.is_in(value)) return;
      const json::json_pointer own = at / std::string(field.name);
      if (field.presence == Presence::always) found.insert(own.to_string());
      if (content.contains(own))
        required_entries(content, own, std::invoke(field.member, value), found);
    });
  } else if constexpr (meshes::is_optional<Value>) {
    if (value) required_entries(content, at, *value, found);
  } else if constexpr (meshes::is_list<Value>) {
    if (!value.empty()) required_entries(content, at / std::size_t{0}, value.front(), found);
  } else if constexpr (meshes::is_map<Value>) {
    if (!value.empty())
      required_entries(content, at / value.begin()->first, value.begin()->second, found);
  }
}

/// "samples[0].force" of "/samples/0/force".
std::string spelled(const json::json_pointer& at) {
  std::string text;
  std::stringstream parts(at.to_string().substr(1));
  for (std::string part; std::getline(parts, part, '/');) {
    const bool index = part.find_first_not_of("0123456789") == part.npos;
    text += index ? "[" + part + "]" : (text.empty() ? "" : ".") + part;
  }
  return text;
}

/// Drops each entry that the object must have.
template <typename Struct>
void expect_entries_missed(const fs::path& run, const fs::path& file) {
  const Changed changed(run / file);
  const json whole = json::parse(changed.text());
  std::set<std::string> entries;
  required_entries(whole, json::json_pointer(), struct_of<Struct>(JsonEntry(whole, run / file)),
                   entries);
  EXPECT_GT(entries.size(), 5U);
  for (const std::string& name : entries) {
    const json::json_pointer entry(name);
    json content = whole;
    content[entry.parent_pointer()].erase(entry.back());
    changed.become(content.dump());
    const std::string damage = damage_of(run);
    EXPECT_TRUE(says(damage, file.string() + ", " + spelled(entry) + ": is missing"))
        << file << spelled(entry);
  }
}

/// The file says what the struct read from it does, key by key.
template <typename Struct>
void expect_round_trip(const fs::path& file) {
  const json whole = json::parse(read_text(file));
  const auto written = meshes::json_of(struct_of<Struct>(JsonEntry(whole, file)));
  EXPECT_EQ(struct_of<Struct>(JsonEntry(written, file)).empty(), false);
  EXPECT_EQ(meshes::json_of(struct_of<Struct>(JsonEntry(written, file))), written);
}

class Fields : public testing::Test {
 protected:
  Fields() { report_testing::write_synthetic_run(run_); }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

/// Rows whose values are all different, and what is read back of them.
template <typename Row>
class Table : public testing::Test {};
using Rows =
    testing::Types<meshes::PressSample, lattice::TraceRow, BoundaryRow, BoundarySpringRow,
                   SnapshotRow, SnapshotPointRow, LatticeModeRow, CubeRow, PublishedStudyRow,
                   EquilibriumStudyRow, VariantRow, TransferRow, fem_reference::ConvergenceRow,
                   meshes::ContactPoint, meshes::MarkerRow, fem_reference::SectionRow,
                   fem_reference::TransientStep, fem_reference::ModeRow, calibration::FitDataRow,
                   calibration::SurrogateRow, lattice::GraspRow>;
TYPED_TEST_SUITE(Table, Rows);

TYPED_TEST(Table, ReadsBackWhatIsWritten) {
  const TemporaryFolder folder;
  std::vector<TypeParam> rows(2);
  int number = 0;
  meshes::for_each_column<TypeParam>([&](const auto&, std::size_t, const auto& value_of) {
    using Value = std::remove_cvref_t<decltype(value_of(rows.front()))>;
    ++number;
    if constexpr (std::is_base_of_v<std::string, Value>)
      value_of(rows[0]) = "it's \"" + std::to_string(number) + "\", quoted";
    else if constexpr (std::is_enum_v<Value>)
      value_of(rows[0]) = values(Value{}).back();
    else
      value_of(rows[0]) = Value(number + 0.1);
  });
  meshes::write_rows(rows, folder / "table.csv");
  const std::vector<TypeParam> back = meshes::read_rows<TypeParam>(folder / "table.csv");
  ASSERT_EQ(back.size(), rows.size());
  meshes::for_each_column<TypeParam>([&](const auto& field, std::size_t, const auto& value_of) {
    EXPECT_EQ(value_of(back[0]), value_of(rows[0])) << field.name;
    EXPECT_EQ(meshes::cell_of(value_of(back[1])), meshes::cell_of(value_of(rows[1]))) << field.name;
  });
}

}  // namespace

TEST_F(Fields, ACompleteRunMissesNothing) {
  EXPECT_EQ(damage_of(run_), "");
}

TEST_F(Fields, MissingColumnsAreNamed) {
  expect_columns_missed<meshes::PressSample>(run_, "reference/response.csv");
  expect_columns_missed<meshes::PressSample>(run_, "hookean/response.csv");
  expect_columns_missed<lattice::TraceRow>(run_, "hookean/trace.csv");
  expect_columns_missed<BoundaryRow>(run_, "hookean/boundary.csv");
  expect_columns_missed<BoundarySpringRow>(run_, "hookean/boundary_springs.csv");
  expect_columns_missed<CubeRow>(run_, "cubes.csv");
  expect_columns_missed<PublishedStudyRow>(run_, "published_study.csv");
  expect_columns_missed<EquilibriumStudyRow>(run_, "equilibrium_study.csv");
  expect_columns_missed<fem_reference::ConvergenceRow>(run_, "reference/convergence.csv");
  expect_columns_missed<fem_reference::SectionRow>(run_, "reference/section.csv");
  expect_columns_missed<meshes::ContactPoint>(run_, "reference/contact_field.csv");
}

/// Tables that the synthetic run has not, with a row each.
TEST_F(Fields, MissingColumnsOfFurtherTablesAreNamed) {
  const auto expect = [&]<typename Row>(const Row& row, const fs::path& file) {
    meshes::write_rows(std::vector<Row>{row}, run_ / file);
    expect_columns_missed<Row>(run_, file);
    fs::remove(run_ / file);
  };
  expect(SnapshotRow{}, "hookean/snapshots.csv");
  expect(SnapshotPointRow{}, "hookean/snapshot_points.csv");
  expect(meshes::ContactPoint{}, "contact_field.csv");
  expect(VariantRow{}, "variants.csv");
  expect(LaterRow{}, "later.csv");
  expect(LatticeModeRow{}, "modes.csv");
  expect(fem_reference::ModeRow{}, "modes.csv");
  expect(TransferRow{}, "transfer.csv");
  expect(lattice::GraspRow{}, "grasp.csv");
}

TEST_F(Fields, MissingEntriesAreNamed) {
  expect_entries_missed<Manifest>(run_, "manifest.json");
  expect_entries_missed<CaseSummary>(run_, "summary.json");
  expect_entries_missed<PressSummary>(run_, "hookean/summary.json");
  expect_entries_missed<fem_reference::RunSummary>(run_, "reference/summary.json");
  expect_entries_missed<calibration::ModuliFile>(run_, "calibration_hookean/calibration.json");
  expect_entries_missed<fem_reference::VerificationFile>(run_, "verification/verification.json");
}

TEST_F(Fields, MissingFieldsOfFitsAreNamed) {
  const fs::path run = folder_.path() / "fit";
  report_testing::write_fit(run, report_testing::fit_result());
  report_testing::write_surrogate(run);
  EXPECT_EQ(damage_of(run), "");
  expect_columns_missed<calibration::FitDataRow>(run, "fit_data.csv");
  expect_columns_missed<calibration::SurrogateRow>(run, "surrogate.csv");
  expect_entries_missed<calibration::SurrogateFile>(run, "surrogate.json");
  const fs::path study = folder_.path() / "study";
  report_testing::write_transfer_study(study);
  EXPECT_EQ(damage_of(study), "");
  expect_entries_missed<CaseSummary>(study, "summary.json");
}

TEST_F(Fields, ThePageListsThem) {
  const Changed changed(run_ / "manifest.json");
  json manifest = json::parse(changed.text());
  manifest.erase("started");
  changed.become(manifest.dump());
  report::write_report(run_);
  const std::string page = report_testing::visible_text(read_text(run_ / "report.html"));
  EXPECT_TRUE(says(page, {"manifest.json, started", "is missing"}));
}

TEST_F(Fields, StructsAreWrittenAsTheyAreRead) {
  expect_round_trip<Manifest>(run_ / "manifest.json");
  expect_round_trip<PressSummary>(run_ / "hookean/summary.json");
  expect_round_trip<fem_reference::RunSummary>(run_ / "reference/summary.json");
  expect_round_trip<calibration::ModuliFile>(run_ / "calibration_hookean/calibration.json");
  expect_round_trip<fem_reference::VerificationFile>(run_ / "verification/verification.json");
}

namespace {

/// What stands between backquotes in a page.
std::set<std::string> between_backquotes(const std::string& text) {
  std::set<std::string> found;
  for (std::size_t from = text.find('`'); from != text.npos; from = text.find('`', from)) {
    const std::size_t to = text.find('`', from + 1);
    if (to == text.npos) break;
    const std::string span = text.substr(from + 1, to - from - 1);
    found.insert(span);
    std::stringstream words(span);
    for (std::string word; words >> word;) found.insert(word);
    std::stringstream cells(span);
    for (std::string cell; std::getline(cells, cell, ',');) found.insert(cell);
    from = to + 1;
  }
  return found;
}

/// Names of a struct's fields and of those inside.
template <typename Value>
void field_names(std::set<std::string>& names) {
  if constexpr (meshes::HasFields<Value>) {
    meshes::for_each_field<Value>([&]<typename Own>(const Own& field) {
      names.insert(std::string(field.name));
      field_names<std::remove_cvref_t<std::invoke_result_t<decltype(field.member), Value&>>>(names);
    });
  } else if constexpr (meshes::is_optional<Value> || meshes::is_list<Value>) {
    field_names<typename Value::value_type>(names);
  } else if constexpr (meshes::is_map<Value>) {
    field_names<typename Value::mapped_type>(names);
  }
}

}  // namespace

/// The reference of fields knows them all: the manual, and the READMEs of folders it points to.
TEST(FieldReference, NamesEveryField) {
  std::string text;
  for (const char* page :
       {"studies/manual/files.md", "lattice/press/README.md", "fem_reference/README.md",
        "fem_reference/FORMATS.md", "calibration/material/README.md", "calibration/FORMATS.md"})
    text += read_text(fs::path(FINGERTIP_SOURCES) / page);
  const std::set<std::string> told = between_backquotes(text);
  std::set<std::string> names;
  const auto add_columns = [&]<typename... Row>(testing::Types<Row...>) {
    for (const auto& columns : {meshes::column_names<Row>()...})
      names.insert(columns.begin(), columns.end());
  };
  add_columns(Rows{});
  field_names<Manifest>(names);
  field_names<PressSummary>(names);
  field_names<GraspSummary>(names);
  field_names<CaseSummary>(names);
  field_names<fem_reference::RunSummary>(names);
  field_names<fem_reference::VerificationFile>(names);
  field_names<calibration::ModuliFile>(names);
  field_names<calibration::FitFile>(names);
  field_names<calibration::SurrogateFile>(names);
  field_names<PlanFile>(names);
  for (const std::string& name : names) {
    const std::string bare = name.substr(0, name.find(" ["));
    EXPECT_TRUE(told.contains(name) || told.contains(bare)) << name;
  }
}
