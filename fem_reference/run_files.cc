#include "fem_reference/run_files.h"

#include <cstdio>
#include <ostream>

#include "meshes/files.h"

namespace fingertip::fem_reference {

using meshes::to_text;

void write_samples(const std::vector<PressState>& states, const std::filesystem::path& folder) {
  meshes::PressResponse response;
  for (const PressState& state : states) response.append(state.sample);
  response.write_csv(folder / "response.csv");
  meshes::write_atomically(folder / "pressure.csv", [&](std::ostream& out) {
    out << "indentation [m],radius [m],pressure [Pa],lateral_displacement [m]\n";
    for (const PressState& state : states)
      for (const ContactPoint& point : state.contact)
        out << to_text(state.sample.indentation) << ',' << to_text(point.radius) << ','
            << to_text(point.pressure) << ',' << to_text(state.sample.lateral_displacement) << '\n';
  });
}

void write_convergence(const MeshHistory& history, const std::filesystem::path& folder) {
  meshes::write_atomically(folder / "convergence.csv", [&](std::ostream& out) {
    out << "mesh,cells,unknowns,indentation [m],normal_force [N],contact_radius [m],"
           "max_pressure [Pa],node_spacing [m],energy [J],indicator [J],lateral_displacement [m]\n";
    int number = 0;
    for (const MeshRecord& record : history.meshes()) {
      ++number;
      for (const PressState& state : record.states)
        out << number << ',' << record.mesh.cells << ',' << record.mesh.unknowns << ','
            << to_text(state.sample.indentation) << ',' << to_text(state.sample.normal_force) << ','
            << to_text(state.sample.contact_radius) << ',' << to_text(state.sample.max_pressure)
            << ',' << to_text(state.node_spacing) << ',' << to_text(state.energy) << ','
            << to_text(state.indicator) << ',' << to_text(state.sample.lateral_displacement)
            << '\n';
    }
  });
}

void write_section(const std::vector<SectionEdge>& edges, const std::filesystem::path& folder) {
  meshes::write_atomically(folder / "section.csv", [&](std::ostream& out) {
    out << "x1 [m],z1 [m],x2 [m],z2 [m],"
           "deformed_x1 [m],deformed_z1 [m],deformed_x2 [m],deformed_z2 [m]\n";
    for (const SectionEdge& edge : edges) {
      for (std::size_t k = 0; k < 4; ++k) out << (k ? "," : "") << to_text(edge.undeformed[k]);
      for (std::size_t k = 0; k < 4; ++k) out << ',' << to_text(edge.deformed[k]);
      out << '\n';
    }
  });
}

std::string field_name(std::size_t index) {
  char name[32];
  std::snprintf(name, sizeof name, "press_%04zu.vtu", index + 1);
  return name;
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

}  // namespace fingertip::fem_reference
