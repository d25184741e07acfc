// Fuzzes the STL reader: any bytes must give a valid mesh or an Error. Start it with a folder of small STL files as its
// corpus.
#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pliant::fuzz::read_as("fuzz.stl", data, size);
}
