# WebAssembly by Debian's emscripten, run by node: packages of group `wasm` in scripts/packages.txt. scripts/portable sets the
# environment that emscripten needs.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fexceptions")
# -O0 is for the link alone: at -O3 its optimiser takes minutes. node reads the host's files; its `fetch` is hidden, since emscripten 3.1.6 would load the program by it.
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-O0 -fexceptions -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1 -sEXIT_RUNTIME=1 --pre-js ${CMAKE_CURRENT_LIST_DIR}/hide_fetch.js")
set(CMAKE_CROSSCOMPILING_EMULATOR node)
