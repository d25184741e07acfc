// Fuzzes load_state: any bytes must give a State, or an Error with the file's name and a reason. CMakeLists.txt says
// how to run it.
//
// The checksum in the bytes is corrected first, so that the search reaches the code behind the checksum test.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/sha256.h"
#include "pliant/error.h"
#include "pliant/save.h"

namespace {

std::string sealed(const std::uint8_t* data, std::size_t size) {
  pliant::Sha256 sha;
  sha.add(data, size);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::string digits = sha.finish();
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::strtol(digits.substr(i, 2).c_str(), nullptr, 16));
  return bytes;
}

/// The path of the input in memory, since load_state reads files.
const std::string& path() {
  static const std::string at = "/dev/shm/pliant_fuzz_saved_" + std::to_string(getpid());
  return at;
}

void read(const std::string& bytes) {
  std::FILE* file = std::fopen(path().c_str(), "wb");
  if (file == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fclose(file) != 0)
    std::abort();
  try {
    (void)hash(pliant::load_state(path()));
  } catch (const pliant::Error& error) {
    if (error.problem().empty()) std::abort();
  }
  try {
    (void)pliant::load_world(path());
  } catch (const pliant::Error& error) {
    if (error.problem().empty()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read(sealed(data, size));
  return 0;
}
