# The builds of the sweeps for wider machines must not lend a function to anyone: the linker keeps one copy of each inline
# function of a program, and where it keeps the one with AVX-512 in it, an older machine stops at an illegal instruction, no
# matter what was picked at start. So: no weak symbols, and nothing shared but the table.
#   cmake -DNM=nm -DOBJECTS=a.o|b.o -P lanes_symbols_test.cmake
string(REPLACE "|" ";" objects "${OBJECTS}")
# A table of kernels, or the sweep of one type that the table of sweeps calls: both have the level in their name.
set(exported "(pliant::[a-z]+_kernels_(v[234]|generic)\\(\\)|pliant::isa_(v[234]|generic)::SweepOf<[^>]*>::sweep\\()")
if(NOT objects)
  message(FATAL_ERROR "no objects were named")
endif()
foreach(object IN LISTS objects)
  execute_process(COMMAND ${NM} -C --defined-only ${object} OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${NM} can't read ${object}")
  endif()
  if(NOT symbols MATCHES " T ${exported}")
    message(FATAL_ERROR "${object} has no table of kernels and no sweep:\n${symbols}")
  endif()
  string(REPLACE "\n" ";" lines "${symbols}")
  foreach(line IN LISTS lines)
    # V DW.ref: a pointer to the runtime's exception handler, the same in every unit.
    if(line MATCHES " [WuV] " AND NOT line MATCHES "DW\\.ref\\.")
      message(SEND_ERROR "${object} shares with the whole program: ${line}")
    endif()
    if(line MATCHES " [TDBRG] " AND NOT line MATCHES " T ${exported}")
      message(SEND_ERROR "${object} exports more than these: ${line}")
    endif()
  endforeach()
endforeach()
