#include "source_rules.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace architecture {
namespace {

namespace fs = std::filesystem;
using Findings = std::vector<Finding>;
using Names = std::set<std::string>;

const char* const table_file = "tests/architecture/rooms.txt";

/// The outermost room: folder, namespace, library.
std::string library_of(const std::string& room) {
  return room.substr(0, room.find('/'));
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The table of rooms: libraries and the rooms within them, each with what it may use.
class Rooms {
 public:
  explicit Rooms(const fs::path& source) {
    static const std::regex entry(R"(^( *)([\w./]+): *(.*))");
    const std::vector<std::string> lines = lines_of(source / table_file);
    std::smatch match;
    std::string library;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!std::regex_match(lines[i], match, entry)) continue;
      const bool inner = match[1].length() > 0;
      if (!inner) library = match[2];
      const auto full = [&](const std::string& name) {
        return !inner ? name : name == "." ? library : library + '/' + name;
      };
      std::map<std::string, Names>& above = inner ? rooms_ : libraries_;
      Names& uses = above[full(match[2])];
      std::istringstream words(match[3]);
      for (std::string word; words >> word; uses.insert(full(word)))
        if (word == match[2] || above.count(full(word)) == 0)
          findings_.push_back({table_file, int(i) + 1, word + " is not above " + full(match[2])});
      if (inner) names_.push_back(full(match[2]));
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::map<std::string, Names>& libraries() const { return libraries_; }
  /// Lines that use what is not above them.
  const Findings& findings() const { return findings_; }

  /// The innermost room, or else library, in whose folder `path` stands; empty for packages.
  std::string room_of(const std::string& path) const {
    std::string found = libraries_.count(library_of(path)) != 0 ? library_of(path) : "";
    for (const std::string& room : names_)
      if (path.starts_with(room + '/') && room.size() > found.size()) found = room;
    return found;
  }

  bool may_use(const std::string& from, const std::string& to) const {
    const std::string library = library_of(from), other = library_of(to);
    if (library != other) return libraries_.at(library).contains(other);
    const auto uses = rooms_.find(from);
    return from == to || (uses != rooms_.end() && uses->second.contains(to));
  }

 private:
  std::map<std::string, Names> libraries_, rooms_;
  std::vector<std::string> names_;  ///< of rooms, lowest first
  Findings findings_;
};

/// A source text, with its includes.
struct SourceFile {
  struct Include {
    int line;
    std::string target;  ///< what stands between the quotes or brackets
  };
  std::string path;  ///< relative to the source folder, with '/'
  std::string room;
  std::vector<std::string> lines;
  std::vector<Include> includes;

  bool is_header() const { return path.ends_with(".h"); }
};

std::string unit_of(const std::string& path) {
  return path.substr(0, path.rfind('.'));
}

SourceFile read_source(const fs::path& source, const Rooms& rooms, const fs::path& file) {
  static const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  const std::string path = fs::relative(file, source).generic_string();
  SourceFile text{path, rooms.room_of(path), lines_of(file), {}};
  std::smatch match;
  for (std::size_t i = 0; i < text.lines.size(); ++i)
    if (text.lines[i].find("include") != std::string::npos &&
        std::regex_search(text.lines[i], match, include))
      text.includes.push_back({int(i) + 1, match[1]});
  return text;
}

/// All files of the libraries that are `wanted`, in a fixed order.
std::vector<fs::path> library_files(const fs::path& source, const Rooms& rooms,
                                    const std::function<bool(const fs::path&)>& wanted) {
  std::vector<fs::path> files;
  for (const auto& [library, uses] : rooms.libraries()) {
    if (!fs::is_directory(source / library)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(source / library))
      if (entry.is_regular_file() && wanted(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<SourceFile> sources(const fs::path& source, const Rooms& rooms) {
  std::vector<SourceFile> all;
  const auto wanted = [](const fs::path& file) {
    return file.extension() == ".h" || file.extension() == ".cc";
  };
  for (const fs::path& file : library_files(source, rooms, wanted))
    all.push_back(read_source(source, rooms, file));
  return all;
}

/// Headers of a library that files of others include, and headers those include in turn.
Names public_headers(const std::vector<SourceFile>& files, const std::string& library) {
  Names reached;
  for (bool grown = true; grown;) {
    grown = false;
    for (const SourceFile& file : files)
      if (library_of(file.room) != library || reached.count(file.path) != 0)
        for (const auto& include : file.includes)
          if (library_of(include.target) == library) grown |= reached.insert(include.target).second;
  }
  return reached;
}

/// Unit → units that its files include.
std::map<std::string, Names> unit_graph(const std::vector<SourceFile>& files) {
  std::map<std::string, Names> graph;
  for (const SourceFile& file : files) graph[unit_of(file.path)];
  for (const SourceFile& file : files)
    for (const auto& include : file.includes) {
      const std::string unit = unit_of(file.path), target = unit_of(include.target);
      if (target != unit && graph.count(target) != 0) graph[unit].insert(target);
    }
  return graph;
}

/// Units to which one gets from `unit` by at least one include.
Names reached_from(const std::map<std::string, Names>& graph, const std::string& unit) {
  Names reached;
  std::vector<std::string> open{unit};
  while (!open.empty()) {
    const Names& next = graph.at(open.back());
    open.pop_back();
    for (const std::string& target : next)
      if (reached.insert(target).second) open.push_back(target);
  }
  return reached;
}

/// Where alone an include may stand: both as regular expressions on whole paths.
struct Place {
  std::regex include, file;
  std::string rule;
};

const std::vector<Place>& places() {
  static const std::vector<Place> all = [] {
    const auto place = [](const char* include, const char* file, const char* rule) {
      return Place{std::regex(include), std::regex(file), rule};
    };
    return std::vector<Place>{
        place("deal\\.II/.*", "fem_reference/.*",
              "deal.II belongs into fem_reference, out of the headers the application reaches"),
        // version.h is macros only; a manifest may quote it.
        place("ceres/(?!version\\.h).*", "calibration/.*\\.cc",
              "Ceres belongs into calibration's sources"),
        place("gmsh.*", "meshes/volume_mesh/.*\\.cc",
              "gmsh belongs into the sources of meshes/volume_mesh"),
        place("CGAL/.*", "meshes/(shape/triangle_tree|volume_mesh/(cut_surface|tetrahedra))\\.cc",
              "CGAL belongs into meshes/shape/triangle_tree.cc, cut_surface.cc and tetrahedra.cc"),
        place(
            "meshes/volume_mesh/boundary_parts\\.h",
            "(fem_reference|meshes/volume_mesh)/.*|calibration/contact_laws/tetrahedral_body\\.cc",
            "the mesher belongs to fem_reference, and to tetrahedra for other programs"),
        place("meshes/volume_mesh/(?!boundary_parts|tetrahedra).*",
              "(fem_reference|meshes/volume_mesh)/.*", "the mesher belongs to fem_reference")};
  }();
  return all;
}

}  // namespace

std::string to_string(const Finding& finding) {
  return finding.file + ":" + std::to_string(finding.line) + ": " + finding.what;
}

std::vector<std::string> room_names(const fs::path& source) {
  return Rooms(source).names();
}

Findings check_table(const fs::path& source) {
  const Rooms rooms(source);
  Findings findings = rooms.findings();
  const auto require = [&](const std::string& folder) {
    if (!fs::is_regular_file(source / folder / "README.md"))
      findings.push_back({folder, 0, "lacks a README.md"});
  };
  for (const std::string& room : rooms.names()) require(room);
  for (const auto& [library, uses] : rooms.libraries())
    if (std::ranges::count(rooms.names(), library) == 0) require(library);
  require("tests");
  for (const SourceFile& file : sources(source, rooms))
    if (std::ranges::count(rooms.names(), fs::path(file.path).parent_path().generic_string()) == 0)
      findings.push_back({file.path, 0, "stands in no room of the table"});
  return findings;
}

Findings check_include_arrows(const fs::path& source) {
  const Rooms rooms(source);
  Findings findings;
  for (const SourceFile& file : sources(source, rooms))
    for (const auto& include : file.includes) {
      // A relative path would lead around the arrows.
      if (include.target.find("..") != std::string::npos)
        findings.push_back({file.path, include.line, "must include from the repository's root"});
      const std::string target = rooms.room_of(include.target);
      if (!target.empty() && !rooms.may_use(file.room, target))
        findings.push_back({file.path, include.line, file.room + " must not include " + target});
    }
  return findings;
}

Findings check_circles(const fs::path& source) {
  const std::map<std::string, Names> graph = unit_graph(sources(source, Rooms(source)));
  std::map<std::string, Names> reached;
  for (const auto& [unit, targets] : graph) reached[unit] = reached_from(graph, unit);
  Findings findings;
  Names told;
  for (const auto& [unit, targets] : reached) {
    std::string others;
    if (!targets.contains(unit) || told.contains(unit)) continue;
    for (const std::string& other : targets)
      if (reached.at(other).contains(unit) && told.insert(other).second && other != unit)
        others += ' ' + other;
    findings.push_back({unit, 0, "in a circle with" + others});
  }
  return findings;
}

Findings check_namespaces(const fs::path& source) {
  static const std::regex opening(
      R"(^\s*(inline\s+)?namespace\s+(fingertip(?:\w|::(?:inline )?)*))");
  static const std::regex program_or_interface(R"(^int main\(|^extern "C" \{)");
  Findings findings;
  std::set<std::pair<std::string, std::string>> told;
  for (const SourceFile& file : sources(source, Rooms(source))) {
    const std::string own =
        "fingertip::" + std::regex_replace(file.room, std::regex("/"), std::string("::"));
    bool opens_any = false;
    std::smatch match;
    for (const std::string& line : file.lines) {
      opens_any = opens_any || std::regex_search(line, program_or_interface);
      if (line.find("namespace") == std::string::npos || !std::regex_search(line, match, opening))
        continue;
      opens_any = true;
      const std::string name = std::regex_replace(match[2].str(), std::regex("inline "), "");
      if (name != own && !name.starts_with(own + "::") && told.emplace(file.room, name).second)
        findings.push_back({file.room, 0, "opens " + name});
    }
    if (!opens_any) findings.push_back({file.path, 0, "lacks namespace " + own});
  }
  return findings;
}

Findings check_link_arrows(const fs::path& source) {
  static const std::regex library(R"(fingertip::(\w+))");
  const Rooms rooms(source);
  Findings findings;
  const auto wanted = [](const fs::path& file) { return file.filename() == "CMakeLists.txt"; };
  for (const fs::path& path : library_files(source, rooms, wanted)) {
    const std::string file = fs::relative(path, source).generic_string();
    const std::string room = library_of(file);
    const std::vector<std::string> lines = lines_of(path);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string code = lines[i].substr(0, lines[i].find('#'));
      for (std::sregex_iterator it(code.begin(), code.end(), library), end; it != end; ++it) {
        const std::string name = (*it)[1];
        const bool mesher = name == "volume_mesh";
        const std::string target = mesher || name == "specimen" ? "meshes" : name;
        if (rooms.libraries().count(target) != 0 && !rooms.may_use(room, target))
          findings.push_back({file, int(i) + 1, room + " must not link " + target});
        if (mesher && room != "meshes" && room != "fem_reference")
          findings.push_back({file, int(i) + 1, room + " must not link the gmsh mesher"});
      }
    }
  }
  return findings;
}

Findings check_packages(const fs::path& source) {
  Findings findings;
  const std::vector<SourceFile> files = sources(source, Rooms(source));
  const Names shown = public_headers(files, "fem_reference");
  for (const SourceFile& file : files)
    for (const auto& include : file.includes)
      for (const Place& place : places())
        if (std::regex_match(include.target, place.include) &&
            (!std::regex_match(file.path, place.file) ||
             (include.target.starts_with("deal.II/") && shown.contains(file.path))))
          findings.push_back({file.path, include.line, place.rule});
  return findings;
}

Findings check_form(const fs::path& source) {
  constexpr std::size_t longest = 600;
  Findings findings;
  for (const SourceFile& file : sources(source, Rooms(source))) {
    if (file.lines.size() > longest)
      findings.push_back({file.path, int(file.lines.size()), "is longer than 600 lines"});
    if (!file.is_header()) continue;
    if (file.lines.empty() || !file.lines.front().starts_with("///"))
      findings.push_back({file.path, 1, "does not begin with a /// comment"});
    if (std::ranges::count(file.lines, "#pragma once") == 0)
      findings.push_back({file.path, 0, "lacks #pragma once"});
  }
  return findings;
}

}  // namespace architecture
