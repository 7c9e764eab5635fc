#include "source_rules.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>

namespace architecture {
namespace {

namespace fs = std::filesystem;
using Findings = std::vector<Finding>;

/// Room → rooms it may use besides itself. A room within a room may also use what that one may.
const std::map<std::string, std::set<std::string>>& arrows() {
  static const std::map<std::string, std::set<std::string>> allowed{
      {"meshes", {}},
      {"lattice", {"meshes"}},
      {"lattice/kernels", {}},
      {"lattice/model", {"lattice/kernels"}},
      {"lattice/forces", {"lattice/model", "lattice/kernels"}},
      {"lattice/contact", {"lattice/model", "lattice/kernels"}},
      {"lattice/dynamics",
       {"lattice/contact", "lattice/forces", "lattice/model", "lattice/kernels"}},
      {"lattice/control", {"lattice/dynamics", "lattice/model"}},
      {"lattice/statics", {"lattice/contact", "lattice/model"}},
      {"lattice/press",
       {"lattice/control", "lattice/statics", "lattice/dynamics", "lattice/contact",
        "lattice/model", "lattice/kernels"}},
      {"lattice/grasp", {"lattice/control", "lattice/forces", "lattice/model"}},
      {"fem_reference", {"meshes"}},
      {"calibration", {"lattice", "meshes"}},
      {"studies", {"meshes", "lattice", "fem_reference", "calibration"}}};
  return allowed;
}

/// The outermost room: folder, namespace, library.
std::string library_of(const std::string& room) {
  return room.substr(0, room.find('/'));
}

/// The innermost room in which `path` stands; empty for packages and the standard library.
std::string room_of(const std::string& path) {
  std::string found;
  for (const auto& [room, uses] : arrows())
    if (path.starts_with(room + '/') && room.size() > found.size()) found = room;
  return found;
}

bool has_inner_rooms(const std::string& room) {
  return std::ranges::any_of(
      arrows(), [&](const auto& entry) { return entry.first.starts_with(room + '/'); });
}

bool may_use(const std::string& from, const std::string& to) {
  const auto leads = [&](const std::string& allowed) {
    return to == allowed || to.starts_with(allowed + '/');
  };
  const std::string library = library_of(from);
  return from == to || std::ranges::any_of(arrows().at(from), leads) ||
         (library != library_of(to) && std::ranges::any_of(arrows().at(library), leads));
}

/// A source text of one room, with its includes.
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

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

SourceFile read_source(const fs::path& source, const fs::path& file) {
  static const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  const std::string path = fs::relative(file, source).generic_string();
  SourceFile text{path, room_of(path), lines_of(file), {}};
  std::smatch match;
  for (std::size_t i = 0; i < text.lines.size(); ++i)
    if (std::regex_search(text.lines[i], match, include))
      text.includes.push_back({int(i) + 1, match[1]});
  return text;
}

/// All files below the rooms with one of the given names or extensions, in a fixed order.
std::vector<fs::path> room_files(const fs::path& source,
                                 const std::function<bool(const fs::path&)>& wanted) {
  std::vector<fs::path> files;
  for (const auto& [room, uses] : arrows()) {
    if (room != library_of(room) || !fs::is_directory(source / room)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(source / room))
      if (entry.is_regular_file() && wanted(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<SourceFile> sources(const fs::path& source) {
  std::vector<SourceFile> all;
  const auto wanted = [](const fs::path& file) {
    return file.extension() == ".h" || file.extension() == ".cc";
  };
  for (const fs::path& file : room_files(source, wanted)) all.push_back(read_source(source, file));
  return all;
}

/// Headers of a room that files of other rooms include, and headers those include in turn.
std::set<std::string> public_headers(const std::vector<SourceFile>& files,
                                     const std::string& room) {
  std::set<std::string> reached;
  for (bool grown = true; grown;) {
    grown = false;
    for (const SourceFile& file : files)
      if (file.room != room || reached.count(file.path) != 0)
        for (const auto& include : file.includes)
          if (library_of(room_of(include.target)) == room)
            grown |= reached.insert(include.target).second;
  }
  return reached;
}

/// Depth-first search for circles among `includes`; each circle is found once.
class CycleSearch {
 public:
  explicit CycleSearch(const std::map<std::string, std::vector<std::string>>& includes)
      : includes_(includes) {
    for (const auto& [header, targets] : includes_) visit(header);
  }
  const Findings& findings() const { return findings_; }

 private:
  void visit(const std::string& header) {
    const auto seen = std::find(trail_.begin(), trail_.end(), header);
    if (seen != trail_.end()) {
      std::string circle;
      for (auto it = seen; it != trail_.end(); ++it) circle += *it + " → ";
      findings_.push_back({header, 0, "headers include each other: " + circle + header});
      return;
    }
    const auto node = includes_.find(header);
    if (node == includes_.end() || !done_.insert(header).second) return;
    trail_.push_back(header);
    for (const std::string& target : node->second) visit(target);
    trail_.pop_back();
  }

  const std::map<std::string, std::vector<std::string>>& includes_;
  std::vector<std::string> trail_;
  std::set<std::string> done_;
  Findings findings_;
};

void check_namespaces(const SourceFile& file, Findings& findings) {
  static const std::regex opening(R"(^\s*namespace\s+fingertip::(\w+))");
  static const std::regex program(R"(^int main\()");
  static const std::regex interface(R"(^extern "C" \{)");
  bool own = false, has_none = false;  // programs and C headers are not in any namespace
  std::smatch match;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    has_none = has_none || std::regex_search(file.lines[i], program) ||
               std::regex_search(file.lines[i], interface);
    if (!std::regex_search(file.lines[i], match, opening)) continue;
    if (match[1] == library_of(file.room))
      own = true;
    else
      findings.push_back({file.path, int(i) + 1, "opens the namespace of room " + match[1].str()});
  }
  if (!own && !has_none)
    findings.push_back({file.path, 0, "lacks namespace fingertip::" + library_of(file.room)});
}

}  // namespace

std::string to_string(const Finding& finding) {
  return finding.file + ":" + std::to_string(finding.line) + ": " + finding.what;
}

Findings check_include_arrows(const fs::path& source) {
  Findings findings;
  for (const SourceFile& file : sources(source))
    for (const auto& include : file.includes) {
      // A relative path would lead around the arrows.
      if (include.target.find("..") != std::string::npos)
        findings.push_back({file.path, include.line, "must include from the repository's root"});
      const std::string target = room_of(include.target);
      if (!target.empty() && !may_use(file.room, target))
        findings.push_back({file.path, include.line, file.room + " must not include " + target});
    }
  return findings;
}

Findings check_link_arrows(const fs::path& source) {
  static const std::regex library(R"(fingertip::(\w+))");
  Findings findings;
  const auto wanted = [](const fs::path& file) { return file.filename() == "CMakeLists.txt"; };
  for (const fs::path& path : room_files(source, wanted)) {
    const std::string file = fs::relative(path, source).generic_string(), room = room_of(file);
    const std::vector<std::string> lines = lines_of(path);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string code = lines[i].substr(0, lines[i].find('#'));
      for (std::sregex_iterator it(code.begin(), code.end(), library), end; it != end; ++it) {
        const std::string name = (*it)[1];
        const bool mesher = name == "volume_mesh";
        const std::string target = mesher || name == "specimen" ? "meshes" : name;
        if (arrows().count(target) != 0 && !may_use(room, target))
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
  const std::vector<SourceFile> files = sources(source);
  const std::set<std::string> shown = public_headers(files, "fem_reference");
  for (const SourceFile& file : files)
    for (const auto& include : file.includes) {
      const auto refuse = [&](bool broken, const std::string& what) {
        if (broken) findings.push_back({file.path, include.line, what});
      };
      if (include.target.starts_with("deal.II/"))
        refuse(file.room != "fem_reference" || shown.count(file.path) != 0,
               "deal.II belongs into fem_reference, out of the headers the application reaches");
      // version.h is macros only; a manifest may quote it.
      if (include.target.starts_with("ceres/") && include.target != "ceres/version.h")
        refuse(file.room != "calibration" || file.is_header(),
               "Ceres belongs into calibration's sources");
      if (include.target.starts_with("gmsh"))
        refuse(file.path != "meshes/volume_mesh.cc" && file.path != "meshes/dome_mesh.cc" &&
                   file.path != "meshes/meridian_mesh.cc" && file.path != "meshes/split_mesh.cc" &&
                   file.path != "meshes/cad_surface.cc",
               "gmsh belongs into meshes/volume_mesh.cc, dome_mesh.cc, meridian_mesh.cc, "
               "split_mesh.cc and cad_surface.cc");
      if (include.target.starts_with("CGAL/"))
        refuse(file.path != "meshes/triangle_tree.cc" && file.path != "meshes/tetrahedra.cc",
               "CGAL belongs into meshes/triangle_tree.cc and tetrahedra.cc");
      if (include.target == "meshes/boundary_parts.h")
        refuse(file.room != "fem_reference" && file.room != "meshes" &&
                   file.path != "calibration/contact_laws/tetrahedral_body.cc",
               "the mesher belongs to fem_reference, and to tetrahedra for other programs");
      if (include.target == "meshes/cad_surface.h")
        refuse(file.room != "fem_reference" && file.path != "meshes/cad_surface.cc",
               "the mesher belongs to fem_reference");
      if (include.target == "meshes/volume_mesh.h")
        refuse(file.room != "fem_reference" && file.path != "meshes/volume_mesh.cc" &&
                   file.path != "meshes/dome_mesh.h" && file.path != "meshes/meridian_mesh.h" &&
                   file.path != "meshes/split_mesh.h" && file.path != "meshes/boundary_parts.h",
               "the mesher belongs to fem_reference");
    }
  return findings;
}

Findings check_header_cycles(const fs::path& source) {
  std::map<std::string, std::vector<std::string>> includes;
  for (const SourceFile& file : sources(source))
    if (file.is_header())
      for (const auto& include : file.includes) includes[file.path].push_back(include.target);
  return CycleSearch(includes).findings();
}

Findings check_form(const fs::path& source) {
  constexpr std::size_t longest = 600;
  Findings findings;
  for (const SourceFile& file : sources(source)) {
    if (file.lines.size() > longest)
      findings.push_back({file.path, int(file.lines.size()), "is longer than 600 lines"});
    if (file.is_header()) {
      if (file.lines.empty() || !file.lines.front().starts_with("///"))
        findings.push_back({file.path, 1, "does not begin with a /// comment"});
      if (std::find(file.lines.begin(), file.lines.end(), "#pragma once") == file.lines.end())
        findings.push_back({file.path, 0, "lacks #pragma once"});
    }
    check_namespaces(file, findings);
    if (has_inner_rooms(file.room))
      findings.push_back({file.path, 0, "stands in none of the rooms of " + file.room});
  }
  return findings;
}

Findings check_readmes(const fs::path& source) {
  Findings findings;
  const auto require = [&](const std::string& folder) {
    if (!fs::is_regular_file(source / folder / "README.md"))
      findings.push_back({folder, 0, "lacks a README.md"});
  };
  for (const auto& [room, uses] : arrows()) require(room);
  require("tests");
  return findings;
}

}  // namespace architecture
