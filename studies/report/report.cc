#include "studies/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>

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
  need(!run.reference_contact.empty(), "Contact pressure of the continuum",
       "reference/contact_field.csv");
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
  const ShownUnits& units = shown_units();
  std::vector<std::string> words{
      if_known(constants.k1, "k1 = " + with_unit(constants.k1, units.stiffness)),
      if_known(constants.k2, "k2 = " + with_unit(constants.k2, units.stiffness)),
      if_known(constants.k3, "k3 = " + with_unit(constants.k3, units.stiffness)),
      if_known(constants.kappa, "kappa = " + with_unit(constants.kappa, units.stress))};
  std::erase(words, "");
  return words.empty() ? "" : fmt::format("{}.", fmt::join(words, ", "));
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

  using Makers = std::vector<std::function<Chapter()>>;

  /// A page of these chapters, the verdict before them and the provenance behind.
  Page made(const std::string& title, const std::string& subtitle,
            const std::function<std::string()>& answer, const Makers& chapters) {
    Page page;
    page.title = run_.summary.title.empty() ? title : run_.summary.title;
    page.subtitle = words([&] { return with_case(run_, subtitle); });
    page.answer = words(answer);
    add(page, [&] { return verdict_chapter(run_); });
    for (const auto& chapter : chapters) add(page, chapter);
    add(page, [&] { return provenance_chapter(run_); });
    return page;
  }

  /// Without an answer of its own.
  Page made(const std::string& title, const std::string& subtitle, const Makers& chapters) {
    return made(
        title, subtitle, [] { return std::string(); }, chapters);
  }

  Page core_page() {
    Makers chapters;
    for (Chapter (*const chapter)(const RunData&) :
         {static_cast<Chapter (*)(const RunData&)>(force_chapter),
          static_cast<Chapter (*)(const RunData&)>(contact_chapter),
          static_cast<Chapter (*)(const RunData&)>(marker_chapter), control_chapter,
          snapshots_chapter, elasticity_chapter, pictures_chapter, published_chapter,
          equilibrium_chapter, reasons_chapter, continuum_chapter, verification_chapter,
          cost_chapter})
      chapters.emplace_back([this, chapter] { return chapter(run_); });
    Page page = made(
        "Soft fingertip: lattice against continuum",
        "Validation of mass-spring fingertips against a continuum of the same specimen", chapters);
    page.not_run = missing_parts(run_);
    return page;
  }

  /// A study has its presses to show, and nothing of the core case.
  Page study_page() {
    Makers chapters{[this] { return own_displacements(run_, reader_); },
                    [this] { return variants_chapter(run_); }};
    for (std::size_t i = 0; i < run_.drawn.size(); ++i) {
      const DrawnPress& press = run_.drawn[i];
      const std::vector<RunContact> both{
          {model_label("reference"), model_style("reference"), &press.reference,
           &press.reference_contact, &press.reference_taxels, &press.reference_markers},
          {"lattice", numbered_style(1), &press.response, &press.contact, &press.taxels,
           &press.markers}};
      chapters.emplace_back([both, &press, i] {
        return contact_chapter(compared_contacts(both), press.name, i + 1);
      });
      chapters.emplace_back([both, &press, i] { return skin_chapter(both, press.name, i + 1); });
      chapters.emplace_back(
          [both, &press, i] { return marker_chapter(compared_markers(both), press.name, i + 1); });
    }
    return made("Soft fingertip: a study of lattices",
                "A study of mass-spring fingertips against a continuum of the same specimen",
                chapters);
  }

  /// Fits have neither presses of models nor a continuum of their own.
  Page calibration_page() {
    return made("Soft fingertip: fitted to curves",
                "What curves of force tell of a rubber or of a lattice, and what they leave open",
                {[this] { return own_displacements(run_, reader_); }});
  }

  /// Presses under controllers, or with prescribed motion, one integrator beside the other.
  Page control_page() {
    const std::vector<MovingPress> presses =
        reader_.attempt([&] { return read_moving_presses(run_, reader_); });
    if (compares_integrators(presses))
      return made("Soft fingertip: integrators",
                  "What time steps of a mass-spring fingertip cost and err",
                  {[&] { return integrators_chapter(presses); }});
    return made(
        "Soft fingertip: virtual control",
        "Presses of mass-spring fingertips under controllers that take them for hardware",
        {[&] { return control_chapter(presses); }, [&] { return snapshots_chapter(presses); },
         [&] { return speed_chapter(presses); }});
  }

  std::vector<GraspRun> case_grasps() {
    return reader_.attempt([&] { return read_grasps(run_, reader_); });
  }

  /// A block between two fingers; of the verb `grasp` itself, or of a case.
  Page grasp_page(const std::vector<GraspRun>& grasps) {
    return made("Soft fingertips: a grasp", "Two mass-spring fingertips lift a rigid block",
                [&] { return grasp_answer(grasps); }, {[&] { return grasp_chapter(grasps); }});
  }

  /// The run of `press` itself, where it took time.
  bool is_moving_press() const {
    return run_.models.empty() && std::filesystem::exists(run_.folder / "trace.csv");
  }

  MovingPress own_press() {
    MovingPress press = read_moving_press(run_.folder, "press", reader_);
    press.style = numbered_style(0).as_line();
    press.pictured = true;
    return press;
  }

  Page press_page() {
    const std::vector<MovingPress> presses{own_press()};
    const MovingPress& press = presses.front();
    const std::string forces = words([&] { return press_answer(press.response, press.summary); });
    return made(
        "Soft fingertip: a press under its controller",
        "A mass-spring fingertip pressed against a plane",
        [&] { return joined(forces, control_answer(presses)); },
        {[&] { return press_chapter(press.response, press.trace); }, [&] { return own_contact(); },
         [&] { return own_skin(run_.response); }, [&] { return own_markers(); },
         [&] { return program_chapter(press.response, press); },
         [&] {
           return real_time_chapter(
               reader_.take<RealTimeRecord>(reader_.json(run_.folder / real_time_name)));
         },
         [&] { return control_chapter(presses); }, [&] { return snapshots_chapter(presses); }});
  }

  Chapter own_contact() {
    return contact_chapter(
        compared_contacts({{"", numbered_style(0), &run_.response, &run_.contact}}));
  }

  Chapter own_skin(const meshes::PressResponse& response) {
    return skin_chapter({{"", numbered_style(0), &response, &run_.contact, &run_.taxels}});
  }

  /// Of a press, beside the continuum where that has told its errors.
  Chapter own_markers() {
    const bool alone = run_.beside.empty() || run_.reference_markers.empty();
    return marker_chapter(
        compared_markers({{model_label("reference"), model_style("reference"), &run_.beside,
                           nullptr, nullptr, alone ? nullptr : &run_.reference_markers},
                          {alone ? "" : "lattice", numbered_style(0), &run_.response, nullptr,
                           nullptr, &run_.markers}}));
  }

  /// The run of a static `press`.
  Page static_page() {
    const std::vector<MovingPress> presses{own_press()};
    return made("Soft fingertip: a press at rest",
                "A mass-spring fingertip in equilibrium with what it touches",
                [&] { return press_answer(run_.response, presses.front().summary); },
                {[&] { return press_chapter(run_.response); }, [&] { return own_contact(); },
                 [&] { return own_skin(run_.response); }, [&] { return own_markers(); },
                 [&] { return program_chapter(run_.response, presses.front()); },
                 [&] { return sliding_chapter(run_.response); },
                 [&] { return snapshots_chapter(presses); }});
  }

  /// The run of `reference` itself.
  Page reference_page() {
    return made(
        "Soft fingertip: the continuum", "A deal.II continuum pressed on its obstacle",
        [&] { return press_answer(run_.reference, {}); },
        {[&] { return force_chapter(run_); }, [&] { return contact_chapter(run_); },
         [&] { return own_skin(run_.reference); },
         [&] {
           return marker_chapter(compared_markers({{"", model_style("reference"), &run_.reference,
                                                    nullptr, nullptr, &run_.reference_markers}}));
         },
         [&] { return program_chapter(run_.reference, {}); },
         [&] { return sliding_chapter(run_.reference); }, [&] { return continuum_chapter(run_); },
         [&] { return pictures_chapter(run_); }, [&] { return cost_chapter(run_); }});
  }

  Page modes_page() {
    return made("Soft fingertip: natural vibrations",
                "Frequencies and shapes of the finger bonded to a rod that stands still",
                [&] { return modes_answer(run_.modes); },
                {[&] { return modes_chapter(run_.modes); }});
  }

  /// The run of a `calibrate` that fitted laws to material tests.
  Page law_page() {
    const LawResult laws = reader_.attempt([&] { return read_laws(run_.folder, reader_); });
    Page page = made("Soft fingertip: laws of a rubber",
                     "Laws fitted to material tests, and what they predict",
                     [&] { return law_answer(laws); }, {[&] { return law_chapter(laws); }});
    refuse(page, laws.file.failed);
    page.not_run = missing_law_parts(laws);
    return page;
  }

  /// A case on material tests.
  Page materials_page() {
    const MaterialsData data = reader_.attempt([&] { return read_materials(run_, reader_); });
    Page page = made("Soft fingertip: laws of rubbers",
                     "Laws fitted to material tests, and what they predict",
                     {[&] { return materials_chapter(data); }});
    for (const MaterialsData::Fit& fit : data.fits)
      if (fit.result.empty())
        page.not_run.push_back({"Laws of " + fit.label, fit.folder + "/laws.json"});
    return page;
  }

  /// The run of a `calibrate` that fitted moduli.
  Page moduli_page() {
    return made("Soft fingertip: spring constants for a rubber",
                "The lattice whose elastic constants are the rubber's",
                [&] {
                  return joined(constants_words(run_.moduli_fit.constants),
                                as_shown(run_.moduli_fit.statement));
                },
                {[&] { return elasticity_chapter(run_); }});
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
