#include "studies/live/reference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"

namespace fingertip::studies::inline live {

namespace {

namespace fs = std::filesystem;

/// Of numbers that went through a file as text.
constexpr double file_rounding = 1e-9;

/// Where the curve of a run is: the file itself, or in its folder.
fs::path curve_of(const fs::path& run) {
  if (fs::is_regular_file(run)) return run;
  for (const fs::path& candidate : {run / "response.csv", run / "reference" / "response.csv"}) {
    if (fs::is_regular_file(candidate)) return candidate;
  }
  throw meshes::InvalidInput({"--reference", run.string(), "there is no response.csv",
                              "give the run folder of press, reference or validate"});
}

/// The attribute's value in the element that starts at `at`.
std::string attribute(const std::string& text, std::size_t at, const std::string& name) {
  const std::size_t end = std::min(text.find('>', at), text.size());
  const std::size_t from = text.find(name + "=\"", at);
  if (from >= end) return {};
  const std::size_t start = from + name.size() + 2;
  return text.substr(start, text.find('"', start) - start);
}

std::vector<Overlay> read_overlays(const fs::path& series) {
  std::vector<Overlay> overlays;
  const std::string text = meshes::read_text(series);
  for (std::size_t at = text.find("<DataSet"); at != std::string::npos;
       at = text.find("<DataSet", at + 1)) {
    const std::string step = attribute(text, at, "timestep"), file = attribute(text, at, "file");
    double indentation = 0.0;
    const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), indentation);
    if (error != std::errc() || end != step.data() + step.size() || !std::isfinite(indentation) ||
        file.empty()) {
      throw meshes::InvalidInput({series.string(), step, "the list of fields is damaged",
                                  "run `fingertip reference` again"});
    }
    const fs::path field = series.parent_path() / fs::path(file).filename();
    overlays.push_back({indentation, completed(outer_surface(read_vtu(field)))});
  }
  std::ranges::sort(overlays, {}, &Overlay::indentation);
  return overlays;
}

template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

}  // namespace

Reference read_reference(const fs::path& file) {
  Reference reference;
  const fs::path curve = curve_of(file);
  reference.response = meshes::PressResponse::read_csv(curve);
  reference.name = fs::weakly_canonical(curve.parent_path()).filename().string();
  FolderReader reader;
  reference.condition = read_condition(curve.parent_path(), reader);
  reader.throw_if_damaged();
  const fs::path series = curve.parent_path() / "fields" / "press.pvd";
  // The outer surface is told by its distance from the dome's core, so there is none of a profile.
  const bool dome = !reference.condition || reference.condition->profile == "dome";
  if (dome && fs::is_regular_file(series)) reference.overlays = read_overlays(series);
  // Of a lateral motion that follows the press there is no picture here.
  const double depth = reference.response.depth() * (1.0 + file_rounding);
  std::erase_if(reference.overlays,
                [depth](const Overlay& overlay) { return overlay.indentation > depth; });
  return reference;
}

std::string encode_overlay(const Overlay& overlay) {
  const SurfaceMesh& surface = overlay.surface;
  std::string bytes;
  append(bytes, std::uint32_t(surface.rest.size()));
  append(bytes, std::uint32_t(surface.edges.size()));
  for (const auto* field : {&surface.rest, &surface.displacement}) {
    for (const meshes::Vector3& v : *field) {
      for (const double coordinate : v) append(bytes, float(coordinate));
    }
  }
  for (const auto& edge : surface.edges) {
    for (const std::uint32_t point : edge) append(bytes, point);
  }
  return bytes;
}

}  // namespace fingertip::studies::inline live
