# cmake -DFOLDER=page -DFILES="a.html;b.js" -DOUTPUT=x.cc -P embed_page.cmake: text files as a table.
include(${CMAKE_CURRENT_LIST_DIR}/../raw_literals.cmake)
set(table "")
foreach(name ${FILES})
  file(READ ${FOLDER}/${name} content)
  raw_literals("${content}" page_text "     " pieces)
  set(path "/${name}")
  if(name STREQUAL "index.html")
    set(path "/")
    set(type "text/html; charset=utf-8")
  elseif(name MATCHES "\\.css$")
    set(type "text/css; charset=utf-8")
  elseif(name MATCHES "\\.svg$")
    set(type "image/svg+xml")
  else()
    set(type "text/javascript; charset=utf-8")
  endif()
  string(APPEND table "      {\"${path}\", \"${type}\",${pieces}},\n")
endforeach()
file(WRITE ${OUTPUT}
  "#include \"studies/live/page_files.h\"\n\n"
  "namespace fingertip::studies::inline live {\n\n"
  "const std::vector<PageFile>& page_files() {\n  static const std::vector<PageFile> files = {\n"
  "${table}  };\n  return files;\n}\n\n"
  "}  // namespace fingertip::studies::inline live\n")
