# Run by ctest: the library exports the names of a list and no others, and the program that tests it calls every one of them.

# names(OUT OPTIONS FILE PATTERN): the names of the symbols of a file, without versions, in order.
function(names out file pattern)
  execute_process(COMMAND ${NM} ${ARGN} ${file} OUTPUT_VARIABLE text RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "nm cannot read ${file}")
  endif()
  string(REGEX MATCHALL "${pattern}" lines "${text}")
  set(found "")
  foreach(line ${lines})
    string(REGEX REPLACE "^.* ([^ @\n]+)(@.*)?\n?$" "\\1" name "${line}")
    list(APPEND found ${name})
  endforeach()
  list(SORT found)
  set(${out} "${found}" PARENT_SCOPE)
endfunction()

names(exported ${LIBRARY} " [A-Za-z] [^\n]+\n" -D --defined-only)
list(REMOVE_ITEM exported PLIANT_C_0)  # the version
file(STRINGS ${LIST} listed REGEX "^[^#]")
if(NOT exported STREQUAL listed)
  set(new ${exported})
  list(REMOVE_ITEM new ${listed})
  set(gone ${listed})
  list(REMOVE_ITEM gone ${exported})
  message(FATAL_ERROR "${LIBRARY} exports other names than ${LIST}: new ${new}; gone ${gone}. "
    "A new name is a line in the list. One that is gone breaks programs: bindings/c/CMakeLists.txt then needs another SOVERSION.")
endif()

names(called ${PROGRAM} " U pliant_[^\n]+\n" -D)
list(REMOVE_ITEM listed ${called})
if(listed)
  message(FATAL_ERROR "no test calls ${listed}: add it to tests/c/program")
endif()
