#include "studies/report/report.h"

#include <fmt/format.h>

#include <cmath>

#include "studies/report/chapters/bench/bench_page.h"
#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/law_chapter.h"
#include "studies/report/chapters/fit/materials_chapter.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/report_parts.h"
#include "studies/report/results/grasp_run.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report {

std::vector<NotRun> missing_parts(const RunData& run) {
  std::vector<NotRun> missing;
  const auto need = [&](bool there, const std::string& what, const std::string& files) {
    if (!there) missing.push_back({what, files});
  };
  need(!run.reference.empty(), "Continuum reference", "reference/response.csv");
  need(!run.convergence.empty(), "Forces of the continuum on its sequence of meshes",
       "reference/convergence.csv");
  need(!run.section.empty(), "Picture of the continuum's mesh", "reference/section.csv");
  need(!run.pressure.empty(), "Contact pressure of the continuum", "reference/pressure.csv");
  need(!run.reference_job.empty(), "Hertz's contact beside the continuum's", "reference/job.json");
  need(!run.verification.empty(), "Verification of the continuum's code",
       "verification/verification.json");
  for (const char* name : {"published", "central", "hookean"}) {
    const ModelData* model = run.model(name);
    const std::string folder = name;
    if (!model || (model->response.empty() && model->summary.empty())) {
      missing.push_back({fmt::format("Press of the {} lattice", folder), folder + "/"});
      continue;
    }
    need(!model->response.empty(), "Force curve of " + folder, folder + "/response.csv");
    need(!model->trace.empty(), "Controller trace of " + folder, folder + "/trace.csv");
    need(!model->boundary.empty() && !model->boundary_springs.empty(), "Picture of " + folder,
         folder + "/boundary.csv, " + folder + "/boundary_springs.csv");
  }
  for (const std::string name : {"central", "hookean"}) {
    const ModelData* model = run.model(name);
    need(model && !model->calibration.empty(), "Calibration of " + name,
         "calibration_" + name + "/calibration.json");
  }
  need(!run.cubes.empty(), "Cubes: the surface effect of full springs", "cubes.csv");
  need(!run.published_study.empty(), "The published model's force against grid and ligaments",
       "published_study.csv");
  need(!run.equilibrium_study.empty(), "Lattices in equilibrium, with true surfaces",
       "equilibrium_study.csv");
  need(!run.manifest.empty(), "Provenance", "manifest.json");
  return missing;
}

namespace {

/// What a page is about, with the run's case and time.
std::string with_case(const RunData& run, const std::string& subject) {
  const std::string& started = run.manifest.started;
  const std::string& name = run.summary.case_name;
  return subject + (name.empty() ? "" : ", case " + name) + (started.empty() ? "" : ", " + started);
}

/// "k1 = 12.30 N/m, …." of a calibration.json.
std::string constants_words(const calibration::FitConstants& constants) {
  std::string text;
  for (const auto& [name, value] : {std::pair{"k1", constants.k1},
                                    {"k2", constants.k2},
                                    {"k3", constants.k3},
                                    {"kappa", constants.kappa}}) {
    const bool stress = std::string_view(name) == "kappa";
    const ShownUnit& unit = stress ? shown_units().stress : shown_units().stiffness;
    if (std::isfinite(value))
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, with_unit(value, unit));
  }
  return text.empty() ? text : text + ".";
}

/// Makes the pages of a run, each from the chapters that can be made: damage in one leaves the
/// others.
class PageMaker {
 public:
  PageMaker(const RunData& run, FolderReader& reader) : run_(run), reader_(reader) {}

  Page page() {
    if (is_moving_press()) return press_page();
    if (std::filesystem::exists(run_.folder / "grasp.csv"))
      return grasp_page({read_grasp(run_.folder, "", "grasp", reader_)});
    if (!run_.modes.empty()) return modes_page();
    if (std::filesystem::exists(run_.folder / "laws.json")) return law_page();
    if (is_continuum(run_.folder)) return reference_page();
    if (!run_.moduli_fit.empty()) return moduli_page();
    if (run_.models.empty() && !run_.response.empty()) return static_page();
    const CalibrationData calibration = read_calibration(run_, reader_);
    const bool fits_alone = !calibration.empty() && run_.models.empty() && run_.variants.empty();
    Page page = fits_alone                        ? calibration_page()
                : !run_.summary.presses.empty()   ? control_page()
                : !run_.summary.grasps.empty()    ? grasp_page(case_grasps())
                : !run_.summary.materials.empty() ? materials_page()
                : run_.variants.empty()           ? core_page()
                                                  : study_page();
    if (!run_.status.empty() && run_.status != "ok")
      page.status = "Status of the run: " + run_.status;
    if (fits_alone) refuse(page, fit_failures(calibration));
    page.answer =
        joined(words([&] { return fits_alone ? calibration_answer(calibration) : std::string(); }),
               words([&] { return answer(run_, reader_); }));
    if (!calibration.empty()) add_fits(page, calibration);
    return page;
  }

 private:
  /// What failed its own tests is not "finished".
  static void refuse(Page& page, const std::vector<std::string>& reasons) {
    for (const std::string& reason : reasons) page.rejected.push_back(as_shown(reason));
    if (!reasons.empty()) page.status.clear();
  }

  /// A text, empty where its data are damaged.
  template <typename Make>
  std::string words(const Make& make) {
    return reader_.attempt([&]() -> std::string { return make(); });
  }

  template <typename Make>
  void add(Page& page, const Make& make) {
    page.chapters.push_back(reader_.attempt([&]() -> Chapter { return make(); }));
  }

  Page headed(const std::string& title, const std::string& subtitle) {
    Page page;
    page.title = run_.summary.title.empty() ? title : run_.summary.title;
    page.subtitle = words([&] { return with_case(run_, subtitle); });
    add(page, [&] { return verdict_chapter(run_); });
    return page;
  }

  void end(Page& page) {
    add(page, [&] { return provenance_chapter(run_); });
  }

  Page core_page() {
    Page page = headed("Soft fingertip: lattice against continuum",
                       "Validation of mass-spring fingertips against a continuum of the same "
                       "specimen");
    constexpr Chapter (*chapters[])(const RunData&) = {
        force_chapter,     control_chapter,      snapshots_chapter,   elasticity_chapter,
        pictures_chapter,  published_chapter,    equilibrium_chapter, reasons_chapter,
        continuum_chapter, verification_chapter, cost_chapter};
    for (const auto chapter : chapters) add(page, [&] { return chapter(run_); });
    end(page);
    page.not_run = missing_parts(run_);
    return page;
  }

  /// A study has its presses to show, and nothing of the core case.
  Page study_page() {
    Page page = headed("Soft fingertip: a study of lattices",
                       "A study of mass-spring fingertips against a continuum of "
                       "the same specimen");
    add(page, [&] { return variants_chapter(run_); });
    end(page);
    return page;
  }

  /// Fits have neither presses of models nor a continuum of their own.
  Page calibration_page() {
    Page page = headed("Soft fingertip: fitted to curves",
                       "What curves of force tell of a rubber or of a lattice, and what they leave "
                       "open");
    end(page);
    return page;
  }

  /// Presses under controllers, or with prescribed motion, one integrator beside the other.
  Page control_page() {
    const std::vector<MovingPress> presses =
        reader_.attempt([&] { return read_moving_presses(run_, reader_); });
    const bool integrators = compares_integrators(presses);
    Page page = integrators ? headed("Soft fingertip: integrators",
                                     "What time steps of a mass-spring fingertip cost and err")
                            : headed("Soft fingertip: virtual control",
                                     "Presses of mass-spring fingertips under controllers that "
                                     "take them for hardware");
    if (integrators) {
      add(page, [&] { return integrators_chapter(presses); });
    } else {
      for (const auto chapter :
           {static_cast<Chapter (*)(const std::vector<MovingPress>&)>(control_chapter),
            static_cast<Chapter (*)(const std::vector<MovingPress>&)>(snapshots_chapter),
            speed_chapter})
        add(page, [&] { return chapter(presses); });
    }
    end(page);
    return page;
  }

  std::vector<GraspRun> case_grasps() {
    return reader_.attempt([&] { return read_grasps(run_, reader_); });
  }

  /// A block between two fingers; of the verb `grasp` itself, or of a case.
  Page grasp_page(const std::vector<GraspRun>& grasps) {
    Page page = headed("Soft fingertips: a grasp", "Two mass-spring fingertips lift a rigid block");
    page.answer = words([&] { return grasp_answer(grasps); });
    add(page, [&] { return grasp_chapter(grasps); });
    end(page);
    return page;
  }

  /// The run of `press` itself, where it took time.
  bool is_moving_press() const {
    return run_.models.empty() && std::filesystem::exists(run_.folder / "trace.csv");
  }

  Page press_page() {
    MovingPress press = read_moving_press(run_.folder, "press", reader_);
    press.style = numbered_style(0);
    press.style.point = 0;
    press.pictured = true;
    Page page = headed("Soft fingertip: a press under its controller",
                       "A mass-spring fingertip pressed against a plane");
    page.answer = joined(words([&] { return press_answer(press.response); }),
                         words([&] { return control_answer({press}); }));
    add(page, [&] { return press_chapter(press.response, {}, press.trace); });
    add(page, [&] { return program_chapter(press.response, press); });
    add(page, [&] {
      return real_time_chapter(
          reader_.take<RealTimeRecord>(reader_.json(run_.folder / real_time_name)));
    });
    add(page, [&] { return control_chapter(std::vector{press}); });
    add(page, [&] { return snapshots_chapter(std::vector{press}); });
    end(page);
    return page;
  }

  /// The run of a static `press`.
  Page static_page() {
    Page page = headed("Soft fingertip: a press at rest",
                       "A mass-spring fingertip in equilibrium with what it touches");
    page.answer = words([&] { return press_answer(run_.response); });
    MovingPress press = read_moving_press(run_.folder, "press", reader_);
    press.pictured = true;
    add(page, [&] { return press_chapter(run_.response, run_.contact); });
    add(page, [&] { return program_chapter(run_.response, press); });
    add(page, [&] { return sliding_chapter(run_.response); });
    add(page, [&] { return snapshots_chapter(std::vector{press}); });
    end(page);
    return page;
  }

  /// The run of `reference` itself.
  Page reference_page() {
    Page page =
        headed("Soft fingertip: the continuum", "A deal.II continuum pressed on its obstacle");
    page.answer = words([&] { return press_answer(run_.reference); });
    add(page, [&] { return force_chapter(run_); });
    add(page, [&] { return program_chapter(run_.reference, {}); });
    add(page, [&] { return sliding_chapter(run_.reference); });
    for (const auto chapter : {continuum_chapter, pictures_chapter, cost_chapter})
      add(page, [&] { return chapter(run_); });
    end(page);
    return page;
  }

  Page modes_page() {
    Page page = headed("Soft fingertip: natural vibrations",
                       "Frequencies and shapes of the finger bonded to a rod that stands still");
    page.answer = words([&] { return modes_answer(run_.modes); });
    add(page, [&] { return modes_chapter(run_.modes); });
    end(page);
    return page;
  }

  /// The run of a `calibrate` that fitted laws to material tests.
  Page law_page() {
    const LawResult laws = reader_.attempt([&] { return read_laws(run_.folder, reader_); });
    Page page;
    page.title = "Soft fingertip: laws of a rubber";
    page.subtitle = words(
        [&] { return with_case(run_, "Laws fitted to material tests, and what they predict"); });
    refuse(page, laws.file.failed);
    page.answer = words([&] { return law_answer(laws); });
    add(page, [&] { return law_chapter(laws); });
    end(page);
    page.not_run = missing_law_parts(laws);
    return page;
  }

  /// A case on material tests.
  Page materials_page() {
    Page page = headed("Soft fingertip: laws of rubbers",
                       "Laws fitted to material tests, and what they predict");
    const MaterialsData data = reader_.attempt([&] { return read_materials(run_, reader_); });
    add(page, [&] { return materials_chapter(data); });
    end(page);
    for (const MaterialsData::Fit& fit : data.fits)
      if (fit.result.empty())
        page.not_run.push_back({"Laws of " + fit.label, fit.folder + "/laws.json"});
    return page;
  }

  /// The run of a `calibrate` that fitted moduli.
  Page moduli_page() {
    Page page;
    page.title = "Soft fingertip: spring constants for a rubber";
    page.subtitle = words(
        [&] { return with_case(run_, "The lattice whose elastic constants are the rubber's"); });
    page.answer = joined(words([&] { return constants_words(run_.moduli_fit.constants); }),
                         words([&] { return as_shown(run_.moduli_fit.statement); }));
    add(page, [&] { return elasticity_chapter(run_); });
    end(page);
    return page;
  }

  /// The chapters on fits come before the provenance, the last.
  void add_fits(Page& page, const CalibrationData& calibration) {
    std::vector<Chapter> chapters = reader_.attempt([&] { return fit_chapters(calibration); });
    chapters.insert(chapters.begin(),
                    reader_.attempt([&] { return transfer_chapter(calibration); }));
    page.chapters.insert(page.chapters.end() - 1, chapters.begin(), chapters.end());
    for (const NotRun& part : missing_fit_parts(calibration)) page.not_run.push_back(part);
  }

  const RunData& run_;
  FolderReader& reader_;
};

}  // namespace

std::vector<Damaged> damaged_parts(const FolderReader& reader) {
  std::vector<Damaged> parts;
  for (const meshes::Violation& violation : reader.damage())
    parts.push_back({violation.key, violation.value.empty()
                                        ? violation.rule
                                        : violation.value + ": " + violation.rule});
  return parts;
}

Damages write_report(const std::filesystem::path& run_folder, std::optional<UnitSystem> units) {
  FolderReader reader;
  const auto own = [&] {
    return unit_system(text_if_any(reader.json(run_folder / "manifest.json"), "units"));
  };
  const ShowIn shown(units ? *units : reader.attempt(own));
  Page page;
  if (std::filesystem::exists(run_folder / "bench.json")) {
    page = bench_page(run_folder, reader);
  } else {
    const RunData run = read_run(run_folder, reader);
    page = PageMaker(run, reader).page();
  }
  page.damaged = damaged_parts(reader);
  publish(page, run_folder, "report.html");
  return reader.damage();
}

}  // namespace fingertip::studies::report
