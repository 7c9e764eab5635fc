# Writes OUTPUT, a header with one SHA-256 per group of rooms, so that cached results are tied to
# the code that made them, and DEPFILE, which tells Ninja what to watch: every file that was hashed and
# every folder (its time changes when a file is added or removed). The header is only touched when
# a hash changes, STAMP always.
#   cmake -D ROOT=<source folder> -D OUTPUT=<header> -D STAMP=<file> -D DEPFILE=<file>
#         -P source_hash.cmake

set(watched "")

function(hash_rooms variable)
  set(text "")
  foreach(room ${ARGN})
    file(GLOB_RECURSE files LIST_DIRECTORIES true ${ROOT}/${room}/*)
    list(SORT files)
    list(APPEND watched ${ROOT}/${room})
    foreach(file ${files})
      if(IS_DIRECTORY ${file})
        list(APPEND watched ${file})
      elseif(file MATCHES "\\.(h|cc)$|/CMakeLists\\.txt$")
        list(APPEND watched ${file})
        file(SHA256 ${file} hash)
        file(RELATIVE_PATH name ${ROOT} ${file})
        string(APPEND text "${name} ${hash}\n")
      endif()
    endforeach()
  endforeach()
  string(SHA256 hash "${text}")
  set(${variable} ${hash} PARENT_SCOPE)
  set(watched ${watched} PARENT_SCOPE)
endfunction()

hash_rooms(reference meshes fem_reference)
hash_rooms(lattice meshes lattice)
# A fit is what its models, their search and the reading of its files make of it.
hash_rooms(calibration meshes lattice calibration studies/fits studies/measurements)
hash_rooms(everything meshes lattice fem_reference calibration studies)

set(header "#pragma once
namespace fingertip::studies::inline jobs::source_hash {
inline constexpr const char* reference = \"${reference}\";
inline constexpr const char* lattice = \"${lattice}\";
inline constexpr const char* calibration = \"${calibration}\";
inline constexpr const char* everything = \"${everything}\";
}  // namespace fingertip::studies::inline jobs::source_hash
")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} existing)
endif()
if(NOT "${existing}" STREQUAL "${header}")
  file(WRITE ${OUTPUT} "${header}")
endif()

list(REMOVE_DUPLICATES watched)
list(JOIN watched " \\\n  " prerequisites)
file(WRITE ${DEPFILE} "${STAMP}: ${prerequisites}\n")
file(TOUCH ${STAMP})
