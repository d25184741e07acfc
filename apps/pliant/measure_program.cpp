#include "measure_program.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace pliant::command {

namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "pliant-measure";

/// The folder of this program, symbolic links followed. Where /proc is not mounted it is that of argv[0], and empty if
/// the program was found by PATH.
fs::path own_folder(const char* invoked_as) {
  std::error_code unknown;
  const fs::path self = fs::read_symlink("/proc/self/exe", unknown);
  return (unknown && invoked_as != nullptr ? fs::path(invoked_as) : self).parent_path();
}

/// How to get the program: by one command where `pliant` is still in the build folder, as bin/pliant.
std::string advice(const fs::path& folder) {
  const fs::path build = folder.parent_path();
  std::error_code unknown;
  if (fs::exists(build / "CMakeCache.txt", unknown))
    return "which is not built; build it with: cmake --build " + build.string() + " --target pliant_measure";
  return "which is not installed; build it where pliant was built, with cmake --build FOLDER --target pliant_measure, "
         "and "
         "install again";
}

}  // namespace

std::string replace_by_measure_program(const std::string& subcommand, char** argv) {
  const fs::path folder = own_folder(argv[0]), program = folder / file_name;
  int reason = ENOENT;
  if (!folder.empty()) {
    ::execv(program.c_str(), argv);
    reason = errno;
  }
  if (reason == ENOENT) return "'" + subcommand + "' is in the program " + file_name + ", " + advice(folder);
  return program.string() + ": cannot run it for '" + subcommand + "': " + std::generic_category().message(reason);
}

}  // namespace pliant::command
