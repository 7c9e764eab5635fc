#include "studies/bench/bench.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "meshes/tables/fields_json.h"
#include "studies/bench/continua.h"
#include "studies/bench/kernels.h"
#include "studies/bench/presses.h"
#include "studies/bench/ratios.h"
#include "studies/files/json_entry.h"
#include "studies/fits/runs/moduli_job.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/pace.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline bench {

namespace {

namespace fs = std::filesystem;
using meshes::PressResponse;
using nlohmann::ordered_json;

std::string isa_of(int width) {
  return width == 8 ? "avx512" : width == 4 ? "avx2" : "sse2";
}

ordered_json machine(const BenchPlan& plan) {
  ordered_json facts = host_description();
  const int able = lattice::kernel::supported_width();
  facts["isa"] = isa_of(able);
  facts["isa_measured"] = isa_of(plan.widest > 0 ? plan.widest : able);
  double load[1] = {meshes::unknown};
  ::getloadavg(load, 1);
  facts["load_average"] = meshes::json_of(load[0]);
  return facts;
}

/// Kernels and peers as one job, so that a resumed run keeps them.
ordered_json kernel_part(Session& session, const BenchPlan& plan) {
  Job job;
  job.kind = "kernels";
  job.inputs = {{"rounds", plan.rounds},
                {"sizes", plan.sizes},
                {"widest", plan.widest},
                {"seconds", plan.seconds},
                {"threads", plan.threads}};
  job.repeatable = false;
  job.weight = 20.0;
  job.run = [plan](const fs::path& folder, const JobContext& context) {
    const KernelRounds rounds = measure_kernels(plan, folder, context);
    const Ratios ratios = ratios_of(rounds);
    meshes::write_json_file({{"kernels", kernels_of(rounds, false)},
                             {"ratios", ratios.values},
                             {"missing_ratios", ratios.missing},
                             {"ratio_rounds", ratios.rounds},
                             {"peers", kernels_of(rounds, true)},
                             {"parts", parts_of(rounds)},
                             {"missing_programs", rounds.missing},
                             {"versions", rounds.versions},
                             {"probes", probes_of(rounds)}},
                            folder / "kernels_all.json");
  };
  const PlannedJob planned{"kernels", job, false};
  session.run(planned);
  return parse_json(session.path_of(planned) / "kernels_all.json");
}

/// What errors are measured against.
struct Truth {
  PressResponse finite;                ///< law A
  std::optional<PressResponse> small;  ///< small strain, where the plan wants it
};

PressResponse run_truth(Session& session, const LoadedConfig& loaded, const BenchPlan& plan,
                        bool finite, ordered_json& times) {
  const PlannedJob planned{finite ? "reference" : "reference_small_strain",
                           truth_job(loaded, plan, finite), false};
  const JobResult result = session.run(planned);
  const auto summary = parse_json(session.path_of(planned) / "summary.json");
  times.push_back(
      {{"what", finite ? "continuum reference, law A" : "continuum reference, small strain"},
       {"seconds", summary.at("wall_time")},
       {"worst_force_error_estimate", summary.value("worst_relative_error", ordered_json())},
       {"from_cache", result.reused}});
  return PressResponse::read_csv(session.path_of(planned) / "response.csv");
}

/// Force error of the same lattice at rest, against law A: what the press would have without
/// viscosity, inertia and steps. Null beyond plan.static_finest, and where no equilibrium is found.
ordered_json static_error(Session& session, const LoadedConfig& loaded, const BenchPlan& plan,
                          const PressedLattice& press, const Truth& truth) {
  if (press.per_radius > plan.static_finest) return {};
  const PlannedJob planned{
      fmt::format("static_{}_R{}", lattice::name(press.model), press.per_radius),
      static_job(loaded, press, error_depths(plan, 9)), true};
  if (!session.run(planned).ok()) return {};
  const auto response = PressResponse::read_csv(session.path_of(planned) / "response.csv");
  return meshes::json_of(worst_force_error(response, truth.finite, plan.error_from, plan.depth));
}

ordered_json press_entry(Session& session, const LoadedConfig& loaded, const BenchPlan& plan,
                         const PressedLattice& press, const Truth& truth) {
  const PlannedJob planned{"press_" + press_name(press), pace_job(loaded, press, plan.depth),
                           false};
  session.run(planned);
  const fs::path folder = session.path_of(planned);
  const auto pace = parse_json(folder / "pace.json");
  const auto response = PressResponse::read_csv(folder / "response.csv");
  const lattice::PressSetup setup = press_setup(press_config(loaded, press, plan.depth));
  const auto error = [&](const std::optional<PressResponse>& against) {
    return against
               ? meshes::json_of(worst_force_error(response, *against, plan.error_from, plan.depth))
               : ordered_json();
  };
  return {{"model", lattice::name(press.model)},
          {"kinematics", lattice::name(setup.lattice.kinematics)},
          {"contact", meshes::name(setup.protocol.contact)},
          {"mode", meshes::name(setup.protocol.mode)},
          {"speed", setup.protocol.speed},
          {"spacing_over_R", setup.lattice.spacing / setup.geometry.tip_radius},
          {"threads", press.threads},
          {"real_time_factor", pace.at("real_time_factor")},
          {"worst_force_error", error(truth.finite)},
          {"integrator", lattice::name(press.integrator)},
          {"time_step", pace.at("step")},
          {"static_error", static_error(session, loaded, plan, press, truth)},
          {"worst_force_error_small_strain", error(truth.small)},
          {"real_time_factor_processor", pace.at("real_time_factor_processor")},
          {"whole_press_factor", pace.at("whole_press_factor")},
          {"runs", pace.at("runs")},
          {"ns_per_mass_step", pace.at("ns_per_mass_step")},
          {"particles", pace.at("particles")},
          {"parts", pace.at("parts")},
          {"whole", press.whole},
          {"steps", pace.at("steps")}};
}

/// A press in equilibrium and a fit, once each.
void add_times(Session& session, const LoadedConfig& loaded, const BenchPlan& plan,
               ordered_json& times) {
  const auto run = [&](const std::string& name, const std::string& what, Job job) {
    job.repeatable = false;
    const JobResult result = session.run({name, std::move(job), false});
    times.push_back({{"what", what}, {"seconds", result.wall_time}, {"from_cache", false}});
  };
  const LoadedConfig network =
      with_sets(loaded, {"press.contact=stick", "lattice.model=network",
                         fmt::format("lattice.spacing=tip_radius/{}", plan.static_finest)});
  run("static_press", fmt::format("static press, network, R/{}, ten depths", plan.static_finest),
      press_job(press_setup(with_sets(network, {"press.mode=static"}))));
  run("calibration", "calibration: central springs to E and G",
      moduli_job(loaded.config.press.rubber, fit_options(loaded, lattice::ModelKind::central)));
}

}  // namespace

ordered_json run_bench(Session& session, const LoadedConfig& loaded, const BenchPlan& plan) {
  ordered_json bench = {{"schema", 1},
                        {"date", utc_now()},
                        {"version", program_version()},
                        {"quick", plan.quick},
                        {"machine", machine(plan)}};
  bench.update(kernel_part(session, plan));
  bench["press"] = ordered_json::array();
  bench["continua"] = ordered_json::array();
  ordered_json times = ordered_json::array();
  Truth truth{run_truth(session, loaded, plan, true, times), {}};
  if (plan.small_strain) truth.small = run_truth(session, loaded, plan, false, times);
  for (const PressedLattice& press : plan.presses)
    bench["press"].push_back(press_entry(session, loaded, plan, press, truth));
  const double period = loaded.config.press.controller.period;
  for (const ContinuumMesh& mesh : plan.continua) {
    const PlannedJob planned{"continuum_" + continuum_name(mesh), continuum_job(loaded, plan, mesh),
                             false};
    session.run(planned);
    bench["continua"].push_back(
        continuum_entry(session.path_of(planned), mesh, truth.finite, plan, period));
  }
  if (plan.times) add_times(session, loaded, plan, times);
  bench["times"] = times;
  return bench;
}

}  // namespace fingertip::studies::inline bench
