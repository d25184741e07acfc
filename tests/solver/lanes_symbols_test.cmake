# The builds of the sweeps for wider machines must not lend a function to anyone: the linker keeps one copy of each inline
# function of a program, and where it keeps the one with AVX-512 in it, an older machine stops at an illegal instruction, no
# matter what was picked at start. So: no weak symbols, and nothing shared but the table.
#   cmake -DNM=nm -DOBJECTS=a.o|b.o -P lanes_symbols_test.cmake
string(REPLACE "|" ";" objects "${OBJECTS}")
if(NOT objects)
  message(FATAL_ERROR "no objects were named")
endif()
foreach(object IN LISTS objects)
  execute_process(COMMAND ${NM} -C --defined-only ${object} OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${NM} can't read ${object}")
  endif()
  if(NOT symbols MATCHES " T pliant::[a-z]+_kernels_(v[234]|generic)\\(\\)")
    message(FATAL_ERROR "${object} has no table of kernels:\n${symbols}")
  endif()
  string(REPLACE "\n" ";" lines "${symbols}")
  foreach(line IN LISTS lines)
    # V DW.ref: a pointer to the runtime's exception handler, the same in every unit.
    if(line MATCHES " [WuV] " AND NOT line MATCHES "DW\\.ref\\.")
      message(SEND_ERROR "${object} shares with the whole program: ${line}")
    endif()
    if(line MATCHES " [TDBRG] " AND NOT line MATCHES " T pliant::[a-z]+_kernels_(v[234]|generic)\\(\\)")
      message(SEND_ERROR "${object} exports more than its table: ${line}")
    endif()
  endforeach()
endforeach()
