# The shared library exports exactly the functions listed: removing one breaks hosts, and a C++
# symbol that leaks clashes with theirs.  Needs NM, LIBRARY, EXPECTED: files that
# list them.
execute_process(COMMAND ${NM} -D --defined-only --format=posix ${LIBRARY}
                OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${output}")
set(found "")
foreach(line IN LISTS lines)
    string(REGEX REPLACE " .*" "" name "${line}")
    list(APPEND found ${name})
endforeach()
list(SORT found)
set(expected "")
foreach(file IN LISTS EXPECTED)
    file(STRINGS ${file} lines)
    list(APPEND expected ${lines})
endforeach()
list(SORT expected)
if(NOT found STREQUAL expected)
    message(FATAL_ERROR "exported symbols\n  found:    ${found}\n  expected: ${expected}")
endif()
