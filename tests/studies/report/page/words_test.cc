// Chapters from templates and data: the grammar, what it refuses, and that the two halves agree.
#include "studies/report/page/words.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <stdexcept>

#include "studies/report/report.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip::studies::report;

/// Everything by which a text could pass for a part of the template.
const std::string hostile =
    "one\n\n# No title\n\n! **Not bold** {{name}} [table x] no table | no caption \x1a"
    "0\x1a \x1e";

ChapterData data_with(const std::string& name, const std::string& value) {
  ChapterData data("test");
  data[name] = value;
  return data;
}

Figure line(const std::string& name) {
  return {name, 760, 430, 1, {Panel{}}};
}

Table one_row() {
  Table table;
  table.rows.push_back({"row"});
  return table;
}

TEST(TemplateData, MakeTheBlocksOfATemplate) {
  ChapterData data("test");
  data.id = "place";
  data["who"] = "central";
  data["none"] = "";
  data["warn"] = true;
  data["models"] = WordList(2, data);
  data.figures = {line("second"), line("first"), {"without_panels", 760, 430, 1, {}}};
  data.tables["rows"] = one_row();
  data.tables["without_rows"] = {};
  data.listings["text"] = "as it is";
  const Chapter chapter =
      written(data,
              "# The {{who}} title\n\n**Lead.** Over two\nlines.\n\n"
              "{{none}}{{#none}}not shown{{/none}}\n\n"
              "{{#warn}}\n! **Beware.** {{who}}\n{{/warn}}\n\n"
              "[figure first] One\ntitle | a caption\n\n[figure absent] X | x\n\n"
              "[figure second] Two |\n{{none}}\n\n"
              "[table rows] In {{force_unit}}.\n\n[listing text] Text\n\n"
              "{{#models}}\n\nOf {{who}}.\n\n{{/models}}\n");
  EXPECT_EQ(chapter.id, "place");
  EXPECT_EQ(chapter.title, "The central title");
  ASSERT_EQ(chapter.blocks.size(), 8U);
  const auto paragraph = [&](std::size_t i) { return std::get<Paragraph>(chapter.blocks[i]); };
  EXPECT_EQ(paragraph(0).lead, "Lead.");
  EXPECT_EQ(paragraph(0).text, "Over two lines.");
  EXPECT_FALSE(paragraph(0).warning);
  EXPECT_EQ(paragraph(1).lead, "Beware.");
  EXPECT_EQ(paragraph(1).text, "central");
  EXPECT_TRUE(paragraph(1).warning);
  const auto figure = [&](std::size_t i) { return std::get<FigureBlock>(chapter.blocks[i]); };
  EXPECT_EQ(figure(2).figure.name, "first");
  EXPECT_EQ(figure(2).title, "One title");
  EXPECT_EQ(figure(2).caption, "a caption");
  EXPECT_EQ(figure(3).title, "Two");
  EXPECT_EQ(figure(3).caption, "");
  EXPECT_EQ(std::get<Table>(chapter.blocks[4]).caption, "In mN.");
  EXPECT_EQ(std::get<Listing>(chapter.blocks[5]).text, "as it is");
  EXPECT_EQ(paragraph(7).text, "Of central.");
}

TEST(TemplateData, TakeNoValueForTheirGrammar) {
  for (const char* text : {"{{value}}", "{{#value}}\n{{value}}\n{{/value}}", "[table x] {{value}}",
                           "[figure x] {{value}} | {{value}}", "# {{value}}"}) {
    ChapterData data = data_with("value", hostile);
    data.figures = {line("x")};
    data.tables["x"] = one_row();
    const Chapter chapter =
        written(data, std::string(text) + "\n\n[table x] y\n\n[figure x] y | y");
    EXPECT_EQ(chapter.blocks.size(), std::string_view(text).starts_with('{') ? 3U : 2U) << text;
    if (std::string_view(text).starts_with('{')) {
      EXPECT_EQ(std::get<Paragraph>(chapter.blocks[0]).text, hostile);
    }
  }
  const Chapter lead = written(data_with("value", hostile), "! **{{value}}** {{value}}");
  ASSERT_EQ(lead.blocks.size(), 1U);
  EXPECT_EQ(std::get<Paragraph>(lead.blocks[0]).lead, hostile);
  EXPECT_EQ(std::get<Paragraph>(lead.blocks[0]).text, hostile);
  EXPECT_EQ(written(data_with("value", hostile), "# {{value}}").title, hostile);
}

TEST(TemplateData, SaySoWhenTemplateAndDataDoNotFit) {
  const auto refuses = [](const std::string& text, ChapterData data = data_with("a", "x")) {
    EXPECT_THROW(written(std::move(data), text), std::logic_error) << text;
  };
  for (const char* text : {"{{b}}", "{{#b}}x{{/b}}", "{{^b}}x{{/b}}", "{{#a}}{{b}}{{/a}}",
                           "{{#a}}never closed", "[figur x] y | z"})
    refuses(text);
  ChapterData data("test");
  data.figures = {line("one")};
  refuses("[figure other] x | y", data);
  data = ChapterData("test");
  data.tables["one"] = one_row();
  refuses("[table other] x", data);
  data = ChapterData("test");
  data.listings["one"] = "x";
  refuses("TemplateData.", data);
  EXPECT_THROW(written(ChapterData("no such template")), std::logic_error);
}

/// What `pattern` catches in `text`.
std::set<std::string> caught(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> all;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    all.insert(it->str(1));
  return all;
}

// The branches that no run of the tests takes are checked, too: by their names alone.
TEST(TemplateData, EveryNameInATemplateIsInTheCode) {
  const fs::path folder = fs::path(FINGERTIP_SOURCES) / "studies/report";
  std::string code;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".cc") code += read_text(entry.path());
  const auto in_code = [&](const std::string& name) {
    return code.find('"' + name + '"') != std::string::npos;
  };
  int templates = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".mustache" || name == "report.html") continue;
    ++templates;
    const std::string text = read_text(entry.path());
    EXPECT_TRUE(in_code(name)) << "nothing uses " << entry.path();
    for (const std::string& variable : caught(text, R"(\{\{[#^/]?([^}]*)\}\})"))
      EXPECT_TRUE(std::regex_match(variable, std::regex("[a-z_0-9]+")) && in_code(variable))
          << entry.path() << ": " << variable;
    for (const std::string& id : caught(text, R"((?:^|\n)\[[a-z]+ ([^\]]*)\])"))
      EXPECT_TRUE(id.starts_with("{{") || in_code(id)) << entry.path() << ": " << id;
  }
  EXPECT_GT(templates, 30);
}

TEST(Report, ShowsHostileTextsAsTheyAre) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run";
  fingertip::report_testing::write_synthetic_run(run);
  auto summary = nlohmann::json::parse(read_text(run / "summary.json"));
  summary["description"] = hostile.substr(0, hostile.find('\x1a'));
  write_text(run / "summary.json", summary.dump());
  fingertip::studies::report::write_report(run);
  const std::string html = read_text(run / "report.html");
  EXPECT_NE(html.find("<h2>Verdict</h2>"), std::string::npos);
  EXPECT_EQ(html.find("<h2>No title</h2>"), std::string::npos);
  EXPECT_NE(html.find("! **Not bold** {{name}} [table x] no table | no caption"),
            std::string::npos);
  const auto faults = fingertip::report_testing::structure_faults(html);
  EXPECT_TRUE(faults.empty()) << faults.front();
}

}  // namespace
