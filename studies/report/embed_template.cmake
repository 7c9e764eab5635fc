# cmake -DINPUT=... -DOUTPUT=... -P embed_template.cmake: a text file as a C++ function.
include(${CMAKE_CURRENT_LIST_DIR}/../raw_literals.cmake)
file(READ ${INPUT} content)
raw_literals("${content}" mustache "    " pieces)
file(WRITE ${OUTPUT}
  "#include \"studies/report/page_template.h\"\n\n"
  "namespace fingertip::studies::reporting {\n\n"
  "std::string_view page_template() {\n  return ${pieces};\n}\n\n"
  "}  // namespace fingertip::studies::reporting\n")
