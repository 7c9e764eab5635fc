# raw_literals(<content> <delimiter> <indent> <variable>): a text as C++ raw string literals, piece
# by piece, for compilers need not take literals beyond 65536 characters.
function(raw_literals content delimiter indent variable)
  string(LENGTH "${content}" length)
  set(pieces "")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${content}" ${at} 8000 piece)
    string(APPEND pieces "\n${indent}R\"${delimiter}(${piece})${delimiter}\"")
    math(EXPR at "${at} + 8000")
  endwhile()
  set(${variable} "${pieces}" PARENT_SCOPE)
endfunction()
