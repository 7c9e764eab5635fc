# Text files built into a library.
#
#   embed_texts(<library> <header> <namespace> <function> <file>...)
#
# defines what <header> declares, `const std::map<std::string, std::string_view>& <function>();`: the
# files' contents by their names without folders. The same file, run by `cmake -P`, writes the source.
if(CMAKE_SCRIPT_MODE_FILE)
  set(entries "")
  foreach(file ${FILES})
    file(READ ${file} content)
    get_filename_component(name ${file} NAME)
    string(APPEND entries "      {\"${name}\",")
    # In pieces, for compilers need not take literals beyond 65536 characters.
    string(LENGTH "${content}" length)
    set(at 0)
    while(at LESS length)
      string(SUBSTRING "${content}" ${at} 8000 piece)
      string(APPEND entries "\n       R\"embedded(${piece})embedded\"")
      math(EXPR at "${at} + 8000")
    endwhile()
    string(APPEND entries "},\n")
  endforeach()
  file(WRITE ${OUTPUT}
    "#include \"${HEADER}\"\n\n"
    "namespace ${NAMESPACE} {\n\n"
    "const std::map<std::string, std::string_view>& ${FUNCTION}() {\n"
    "  static const std::map<std::string, std::string_view> texts = {\n${entries}  };\n"
    "  return texts;\n}\n\n"
    "}  // namespace ${NAMESPACE}\n")
  return()
endif()

function(embed_texts library header namespace function)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cc)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DHEADER=${header} "-DNAMESPACE=${namespace}" -DFUNCTION=${function}
            "-DFILES=${ARGN}" -DOUTPUT=${output} -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
    DEPENDS ${ARGN} ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
    VERBATIM)
  target_sources(${library} PRIVATE ${output})
endfunction()
