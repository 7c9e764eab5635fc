# cmake -DINPUT=... -DOUTPUT=... -P embed_template.cmake: a text file as a C++ function.
file(READ ${INPUT} content)
# A raw string literal per piece: compilers need not take literals beyond 65536 characters.
string(LENGTH "${content}" length)
set(pieces "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${content}" ${at} 8000 piece)
  string(APPEND pieces "\n    R\"mustache(${piece})mustache\"")
  math(EXPR at "${at} + 8000")
endwhile()
file(WRITE ${OUTPUT}
  "#include \"studies/report/page_template.h\"\n\n"
  "namespace fingertip::studies::reporting {\n\n"
  "std::string_view page_template() {\n  return ${pieces};\n}\n\n"
  "}  // namespace fingertip::studies::reporting\n")
