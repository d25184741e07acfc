# WebAssembly by Debian's emscripten, run by node: packages of group `wasm` in scripts/packages.txt. scripts/portable sets the
# environment that emscripten needs.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fwasm-exceptions")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fwasm-exceptions -sALLOW_MEMORY_GROWTH=1")
set(CMAKE_CROSSCOMPILING_EMULATOR node)
