// golden_portable [NAME...]: runs the cases in tests/golden/hashes.txt once each on one thread, and prints which hashes
// are equal. It is a plain program for machines that run neither GoogleTest nor threads: aarch64 under qemu-user,
// WebAssembly under node (scripts/portable).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "golden/cases.h"
#include "golden/golden.h"

namespace {

using namespace pliant::golden;

bool run_case(const std::string& name, const std::string& expected) {
  using clock = std::chrono::steady_clock;
  const auto start = clock::now();
  std::string found;
  try {
    Case one = make_case(name);
    one.scene.settings.threads = 1;
    found = run(one.scene, one.scene.settings, one.frames);
  } catch (const std::exception& error) {
    found = error.what();
  }
  const double seconds = std::chrono::duration<double>(clock::now() - start).count();
  const bool equal = found == expected;
  std::printf("%-32s %s  %6.1f s\n", name.c_str(), equal ? "equal" : ("is " + found + ", was " + expected).c_str(),
              seconds);
  std::fflush(stdout);
  return equal;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = case_names();
  std::map<std::string, std::string> expected = read_hashes();
  const auto differ = std::count_if(names.begin(), names.end(),
                                    [&](const std::string& name) { return !run_case(name, expected[name]); });
  std::printf("%d of %d hashes are equal\n", static_cast<int>(names.size()) - static_cast<int>(differ),
              static_cast<int>(names.size()));
  return differ == 0 && !names.empty() ? 0 : 1;
}
