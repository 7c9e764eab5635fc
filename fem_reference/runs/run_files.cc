#include "fem_reference/runs/run_files.h"

#include <cstdio>
#include <ostream>

#include "fem_reference/job/run_tables.h"
#include "meshes/base/files.h"
#include "meshes/press/marker_measures.h"
#include "meshes/press/obstacle.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::fem_reference::inline runs {

using meshes::to_text;

void write_samples(const std::vector<PressState>& states, const ReferenceJob& job,
                   const std::filesystem::path& folder) {
  meshes::PressResponse response;
  for (const PressState& state : states) response.append(state);
  response.write_csv(folder / "response.csv");
  std::vector<meshes::ContactPoint> points;
  for (std::size_t i = 0; i < states.size(); ++i)
    meshes::add_sample(states[i].contact, int(i + 1), states[i].indentation, points);
  meshes::write_rows(points, folder / "contact_field.csv");
  const meshes::PressProtocol& protocol = job.protocol;
  if (protocol.markers.empty()) return;
  const meshes::Vector3 touched = touched_first(job.geometry, protocol.tilt, protocol.obstacle);
  std::vector<meshes::MarkerRow> markers;
  for (std::size_t i = 0; i < states.size(); ++i) {
    std::vector<meshes::MarkerRow> own = states[i].markers;
    set_marker_errors(states[i], touched, own);
    meshes::add_sample(own, int(i + 1), states[i].indentation, markers);
  }
  if (!markers.empty()) meshes::write_rows(markers, folder / "markers.csv");
}

void write_convergence(const MeshHistory& history, const std::filesystem::path& folder) {
  std::vector<ConvergenceRow> rows;
  int number = 0;
  for (const MeshRecord& record : history.meshes()) {
    ++number;
    for (const PressState& state : record.states)
      rows.push_back({number, record.mesh.cells, record.mesh.unknowns, state.indentation,
                      state.normal_force, state.contact_radius, state.max_pressure,
                      state.node_spacing, state.energy, state.indicator,
                      state.lateral_displacement});
  }
  meshes::write_rows(rows, folder / "convergence.csv");
}

std::string field_name(std::size_t index, const char* name) {
  char text[32];
  std::snprintf(text, sizeof text, "%s_%04zu.vtu", name, index + 1);
  return text;
}

void write_series(const std::filesystem::path& file,
                  const std::vector<std::pair<std::string, std::string>>& entries) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
           "  <Collection>\n";
    for (const auto& [time, name] : entries)
      out << "    <DataSet timestep=\"" << time << "\" part=\"0\" file=\"" << name << "\"/>\n";
    out << "  </Collection>\n</VTKFile>\n";
  });
}

void write_field_series(const std::vector<double>& steps, const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> entries;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::filesystem::exists(folder / "fields" / field_name(i)))
      entries.emplace_back(to_text(steps[i]), field_name(i));
  write_series(folder / "fields" / "press.pvd", entries);
}

}  // namespace fingertip::fem_reference::inline runs
