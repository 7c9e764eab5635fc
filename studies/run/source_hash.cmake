# Writes OUTPUT, a header with one SHA-256 per group of rooms, so that cached results are tied to
# the code that made them. Run at build time; the header is only touched when a hash changes.
#   cmake -D ROOT=<source folder> -D OUTPUT=<header> -P source_hash.cmake

function(hash_rooms variable)
  set(text "")
  foreach(room ${ARGN})
    file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${room}/*.h ${ROOT}/${room}/*.cc
         ${ROOT}/${room}/CMakeLists.txt)
    list(SORT files)
    foreach(file ${files})
      file(SHA256 ${ROOT}/${file} hash)
      string(APPEND text "${file} ${hash}\n")
    endforeach()
  endforeach()
  string(SHA256 hash "${text}")
  set(${variable} ${hash} PARENT_SCOPE)
endfunction()

hash_rooms(reference meshes fem_reference)
hash_rooms(lattice meshes lattice)
hash_rooms(calibration meshes lattice calibration)
hash_rooms(everything meshes lattice fem_reference calibration studies)

set(header "#pragma once
namespace fingertip::studies::source_hash {
inline constexpr const char* reference = \"${reference}\";
inline constexpr const char* lattice = \"${lattice}\";
inline constexpr const char* calibration = \"${calibration}\";
inline constexpr const char* everything = \"${everything}\";
}  // namespace fingertip::studies::source_hash
")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} existing)
endif()
if(NOT "${existing}" STREQUAL "${header}")
  file(WRITE ${OUTPUT} "${header}")
endif()
