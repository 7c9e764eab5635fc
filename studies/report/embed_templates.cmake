# cmake -DFILES="a.mustache;b.mustache" -DOUTPUT=x.cc -P embed_templates.cmake: text files as a
# C++ function from name to text.
include(${CMAKE_CURRENT_LIST_DIR}/../raw_literals.cmake)
set(entries "")
foreach(file ${FILES})
  file(READ ${file} content)
  raw_literals("${content}" mustache "       " pieces)
  get_filename_component(name ${file} NAME_WE)
  string(APPEND entries "      {\"${name}\",${pieces}},\n")
endforeach()
file(WRITE ${OUTPUT}
  "#include \"studies/report/page/templates.h\"\n\n"
  "#include <map>\n#include <stdexcept>\n\n"
  "namespace fingertip::studies::report::inline page {\n\n"
  "std::string_view template_text(const std::string& name) {\n"
  "  static const std::map<std::string, std::string_view> texts = {\n${entries}  };\n"
  "  const auto found = texts.find(name);\n"
  "  if (found == texts.end()) throw std::logic_error(\"there is no template \" + name);\n"
  "  return found->second;\n}\n\n"
  "}  // namespace fingertip::studies::report::inline page\n")
