#include "fem_reference/run.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "fem_reference/job.h"
#include "fem_reference/press.h"
#include "meshes/errors.h"
#include "meshes/files.h"
#include "meshes/press_response.h"
#include "meshes/volume_mesh.h"

namespace fingertip::fem_reference {
namespace {

using Json = nlohmann::ordered_json;
using meshes::to_text;
using Clock = std::chrono::steady_clock;

/// The coarser meshes from whose forces the discretisation error is estimated. Two, because the
/// contact edge jumps from node to node, and one difference may vanish by chance.
struct ErrorMesh {
  double refinement;
  const char* file;
};
constexpr std::array error_meshes{ErrorMesh{0.5, "error_mesh_1.msh"},
                                  ErrorMesh{0.7, "error_mesh_2.msh"}};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

Json to_json(const meshes::MeshQuality& quality) {
  return {{"hexahedra", quality.hexahedra},
          {"nodes", quality.nodes},
          {"min_jacobian", quality.min_jacobian},
          {"min_scaled_jacobian", quality.min_scaled_jacobian},
          {"volume", quality.volume}};
}

Json to_json(const PressState& state) {
  const auto known = [](double value) { return std::isnan(value) ? Json() : Json(value); };
  return {{"indentation", state.sample.indentation},
          {"normal_force", state.sample.normal_force},
          {"contact_radius", known(state.sample.contact_radius)},
          {"max_pressure", known(state.sample.max_pressure)},
          {"force_error", known(state.sample.force_error)},
          {"steps", state.steps},
          {"active_set_iterations", state.active_set_iterations},
          {"cg_iterations", state.cg_iterations},
          {"active_nodes", state.active_nodes},
          {"node_spacing", state.node_spacing},
          {"wall_time", state.wall_time}};
}

std::string field_name(std::size_t sample) {
  char name[32];
  std::snprintf(name, sizeof name, "press_%04zu.vtu", sample + 1);
  return name;
}

class Run {
 public:
  Run(std::filesystem::path folder, ReferenceJob job, std::ostream& progress,
      const std::function<bool()>& stop_requested)
      : folder_(std::move(folder)),
        job_(std::move(job)),
        progress_(progress),
        stop_requested_(stop_requested) {
    summary_ = {{"program", "fingertip-fem"},
                {"status", "interrupted"},
                {"contact", meshes::name(job_.contact)},
                {"degree", job_.degree},
                {"refinement", job_.refinement}};
  }

  RunOutcome carry_out() {
    RunOutcome outcome;
    try {
      press();
      if (job_.estimate_error)
        for (const ErrorMesh& error_mesh : error_meshes) press_on(error_mesh);
    } catch (const meshes::Interrupted& stop) {
      outcome = {RunOutcome::Status::interrupted, stop.what()};
    } catch (const meshes::NotConverged& failure) {
      outcome = {RunOutcome::Status::not_converged, failure.what()};
    }
    summary_["status"] = outcome.status == RunOutcome::Status::ok            ? "ok"
                         : outcome.status == RunOutcome::Status::interrupted ? "interrupted"
                                                                             : "not converged";
    if (!outcome.message.empty()) summary_["message"] = outcome.message;
    write_summary();
    return outcome;
  }

 private:
  void report(const char* stage, std::size_t done, std::size_t total, const std::string& message) {
    progress_ << Json{{"stage", stage}, {"done", done}, {"total", total}, {"message", message}}
              << std::endl;
  }

  void stop_if_requested() const {
    if (stop_requested_ && stop_requested_()) throw meshes::Interrupted("stopped on request");
  }

  meshes::MeshQuality mesh(double refinement, const char* file) const {
    return meshes::write_tip_mesh(job_.geometry, meshes::TipMeshOptions{}.refined(refinement),
                                  folder_ / file);
  }

  ContinuumPress assemble(const char* file) const {
    ContinuumPress::Options options;
    options.degree = job_.degree;
    options.solver = job_.solver;
    options.tolerance = job_.tolerance;
    options.stop_requested = stop_requested_;
    return {job_.geometry, job_.rubber, job_.contact, job_.samples.back(), folder_ / file, options};
  }

  void press() {
    report("mesh", 0, 1, "meshing the tip");
    const meshes::MeshQuality quality = mesh(job_.refinement, "tip.msh");
    report("mesh", 1, 1, std::to_string(quality.hexahedra) + " hexahedra");
    stop_if_requested();
    report("assemble", 0, 1, "assembling and factorising");
    ContinuumPress model = assemble("tip.msh");
    report("assemble", 1, 1,
           std::to_string(model.tip().dofs()) + " unknowns, " + std::string(name(model.solver())) +
               " solver");
    summary_["solver"] = name(model.solver());
    summary_["cells"] = model.tip().cells();
    summary_["dofs"] = model.tip().dofs();
    summary_["contact_unknowns"] = model.contact_unknowns();
    summary_["mesh"] = to_json(quality);

    for (std::size_t i = 0; i < job_.samples.size(); ++i) {
      states_.push_back(model.advance(job_.samples[i]));
      write_sample(model);
      report("press", i + 1, job_.samples.size(),
             "F = " + to_text(states_.back().sample.normal_force) + " N at " +
                 to_text(job_.samples[i]) + " m");
    }
  }

  void press_on(const ErrorMesh& coarser) {
    const std::size_t total = states_.size();
    report("error mesh", 0, total,
           "pressing on a mesh " + to_text(coarser.refinement) + " times as fine");
    const meshes::MeshQuality quality = mesh(coarser.refinement * job_.refinement, coarser.file);
    ContinuumPress model = assemble(coarser.file);
    Json description = to_json(quality);
    description["dofs"] = model.tip().dofs();
    summary_["error_meshes"].push_back(description);
    for (std::size_t i = 0; i < total; ++i) {
      meshes::PressSample& sample = states_[i].sample;
      const double difference =
          std::abs(model.advance(sample.indentation).sample.normal_force - sample.normal_force);
      sample.force_error = std::fmax(sample.force_error, difference);  // ignores an unknown one
      write_tables();
      report("error mesh", i + 1, total, "");
    }
  }

  void write_sample(const ContinuumPress& model) {
    write_tables();
    write_section(model);
    if (!job_.write_fields) return;
    std::filesystem::create_directories(folder_ / "fields");
    model.tip().write_fields(model.displacement(), model.plane_force(),
                             folder_ / "fields" / field_name(states_.size() - 1));
    write_field_series();
    report("fields", states_.size(), job_.samples.size(), field_name(states_.size() - 1));
  }

  void write_tables() {
    meshes::PressResponse response;
    for (const PressState& state : states_) response.append(state.sample);
    response.write_csv(folder_ / "response.csv");
    meshes::write_atomically(folder_ / "pressure.csv", [&](std::ostream& out) {
      out << "indentation [m],radius [m],pressure [Pa]\n";
      for (const PressState& state : states_)
        for (const ContactPoint& point : state.contact)
          out << to_text(state.sample.indentation) << ',' << to_text(point.radius) << ','
              << to_text(point.pressure) << '\n';
    });
    write_summary();
  }

  void write_section(const ContinuumPress& model) const {
    meshes::write_atomically(folder_ / "section.csv", [&](std::ostream& out) {
      out << "x1 [m],z1 [m],x2 [m],z2 [m],"
             "deformed_x1 [m],deformed_z1 [m],deformed_x2 [m],deformed_z2 [m]\n";
      for (const SectionEdge& edge : model.tip().section(model.displacement())) {
        for (std::size_t k = 0; k < 4; ++k) out << (k ? "," : "") << to_text(edge.undeformed[k]);
        for (std::size_t k = 0; k < 4; ++k) out << ',' << to_text(edge.deformed[k]);
        out << '\n';
      }
    });
  }

  /// ParaView's list of the VTU files, with the indentation [m] in the place of time.
  void write_field_series() const {
    meshes::write_atomically(folder_ / "fields" / "press.pvd", [&](std::ostream& out) {
      out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
             "  <Collection>\n";
      for (std::size_t i = 0; i < states_.size(); ++i)
        out << "    <DataSet timestep=\"" << to_text(states_[i].sample.indentation)
            << "\" part=\"0\" file=\"" << field_name(i) << "\"/>\n";
      out << "  </Collection>\n</VTKFile>\n";
    });
  }

  void write_summary() {
    summary_["contact_node_spacing"] = states_.empty() ? Json() : Json(states_.back().node_spacing);
    summary_["samples"] = Json::array();
    for (const PressState& state : states_) summary_["samples"].push_back(to_json(state));
    summary_["wall_time"] = seconds_since(start_);
    summary_["peak_memory"] = peak_memory();
    meshes::write_atomically(folder_ / "summary.json",
                             [&](std::ostream& out) { out << summary_.dump(2) << '\n'; });
  }

  std::filesystem::path folder_;
  ReferenceJob job_;
  std::ostream& progress_;
  std::function<bool()> stop_requested_;
  Clock::time_point start_ = Clock::now();
  Json summary_;
  std::vector<PressState> states_;
};

}  // namespace

RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested) {
  ReferenceJob job = read_job(folder / "job.json");
  return Run(folder, std::move(job), progress, stop_requested).carry_out();
}

}  // namespace fingertip::fem_reference
