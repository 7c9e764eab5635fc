#include "studies/report/report.h"

#include <fmt/format.h>

#include "studies/report/bench_page.h"
#include "studies/report/calibration_chapters.h"
#include "studies/report/chapters.h"
#include "studies/report/grasp_run.h"
#include "studies/report/moving_press.h"

namespace fingertip::studies {
namespace reporting {

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
  const std::string started = text_at(run.manifest, "started");
  return subject + (run.case_name.empty() ? "" : ", case " + run.case_name) +
         (started.empty() ? "" : ", " + started);
}

Page core_page(const RunData& run) {
  Page page;
  page.title = run.title.empty() ? "Soft fingertip: lattice against continuum" : run.title;
  page.subtitle = with_case(
      run, "Validation of mass-spring fingertips against a continuum of the same specimen");
  page.chapters = {verdict_chapter(run),   force_chapter(run),        control_chapter(run),
                   snapshots_chapter(run), elasticity_chapter(run),   pictures_chapter(run),
                   published_chapter(run), equilibrium_chapter(run),  reasons_chapter(run),
                   continuum_chapter(run), verification_chapter(run), cost_chapter(run),
                   provenance_chapter(run)};
  page.not_run = missing_parts(run);
  return page;
}

/// A study has its presses to show, and nothing of the core case.
Page study_page(const RunData& run) {
  Page page;
  page.title = run.title.empty() ? "Soft fingertip: a study of lattices at rest" : run.title;
  page.subtitle =
      with_case(run,
                "A study of mass-spring fingertips in equilibrium against a continuum of the same "
                "specimen");
  page.chapters = {verdict_chapter(run), variants_chapter(run), provenance_chapter(run)};
  return page;
}

/// Fits have neither presses of models nor a continuum of their own.
Page calibration_page(const RunData& run) {
  Page page;
  page.title = run.title.empty() ? "Soft fingertip: a lattice fitted to curves" : run.title;
  page.subtitle = with_case(
      run, "Parameters of mass-spring fingertips from curves, and what the curves determine");
  page.chapters = {verdict_chapter(run), provenance_chapter(run)};
  return page;
}

/// Presses with prescribed motion, one integrator beside the other.
Page integrators_page(const RunData& run, const std::vector<MovingPress>& presses) {
  Page page;
  page.title = run.title.empty() ? "Soft fingertip: integrators" : run.title;
  page.subtitle = with_case(run, "What time steps of a mass-spring fingertip cost and err");
  page.chapters = {verdict_chapter(run), integrators_chapter(presses), provenance_chapter(run)};
  return page;
}

/// Presses under controllers.
Page control_page(const RunData& run) {
  const std::vector<MovingPress> presses = read_moving_presses(run);
  if (compares_integrators(presses)) return integrators_page(run, presses);
  Page page;
  page.title = run.title.empty() ? "Soft fingertip: virtual control" : run.title;
  page.subtitle = with_case(
      run, "Presses of mass-spring fingertips under controllers that take them for hardware");
  page.chapters = {verdict_chapter(run), control_chapter(presses), snapshots_chapter(presses),
                   speed_chapter(presses), provenance_chapter(run)};
  return page;
}

/// A block between two fingers; of the verb `grasp` itself, or of a case.
Page grasp_page(const RunData& run, const std::vector<GraspRun>& grasps) {
  Page page;
  page.title = run.title.empty() ? "Soft fingertips: a grasp" : run.title;
  page.subtitle = with_case(run, "Two mass-spring fingertips lift a rigid block");
  page.answer = grasp_answer(grasps);
  page.chapters = {verdict_chapter(run), grasp_chapter(grasps), provenance_chapter(run)};
  return page;
}

/// The run of `press` itself, where it took time.
bool is_moving_press(const RunData& run) {
  return run.models.empty() && std::filesystem::exists(run.folder / "trace.csv");
}

Page press_page(const RunData& run) {
  MovingPress press = read_moving_press(run.folder, "press");
  press.style = numbered_style(0);
  press.style.point = 0;
  press.pictured = true;
  Page page;
  page.title = "Soft fingertip: a press under its controller";
  page.subtitle = with_case(run, "A mass-spring fingertip pressed against a plane");
  page.answer = control_answer({press});
  page.chapters = {control_chapter(std::vector{press}), snapshots_chapter(std::vector{press}),
                   provenance_chapter(run)};
  return page;
}

/// The chapters on fits come before the provenance, the last.
void add_fits(Page& page, const CalibrationData& calibration) {
  std::vector<Chapter> chapters = fit_chapters(calibration);
  chapters.insert(chapters.begin(), transfer_chapter(calibration));
  page.chapters.insert(page.chapters.end() - 1, chapters.begin(), chapters.end());
  for (const NotRun& part : missing_fit_parts(calibration)) page.not_run.push_back(part);
}

Page report_page(const RunData& run) {
  if (is_moving_press(run)) return press_page(run);
  if (std::filesystem::exists(run.folder / "grasp.csv"))
    return grasp_page(run, {read_grasp(run.folder, "", "grasp")});
  const CalibrationData calibration = read_calibration(run);
  const bool fits_alone = !calibration.empty() && run.models.empty() && run.variants.empty();
  Page page = fits_alone             ? calibration_page(run)
              : !run.presses.empty() ? control_page(run)
              : !run.grasps.empty()  ? grasp_page(run, read_grasps(run))
              : run.variants.empty() ? core_page(run)
                                     : study_page(run);
  if (!run.status.empty() && run.status != "ok") page.status = "Status of the run: " + run.status;
  page.answer = (fits_alone ? calibration_answer(calibration) : "") + answer(run);
  if (!calibration.empty()) add_fits(page, calibration);
  return page;
}

}  // namespace
}  // namespace reporting

void write_report(const std::filesystem::path& run_folder) {
  if (std::filesystem::exists(run_folder / "bench.json")) {
    reporting::publish(reporting::bench_page(run_folder), run_folder, "report.html");
    return;
  }
  const reporting::RunData run = reporting::read_run(run_folder);
  reporting::publish(reporting::report_page(run), run_folder, "report.html");
}

}  // namespace fingertip::studies
