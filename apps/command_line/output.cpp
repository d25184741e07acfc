#include "apps/command_line/output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <set>
#include <system_error>

#include "apps/command_line/figure.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

/// The real path of a file, which is the same for "a", "./a" and a link to it.
std::string file_itself(const std::string& path) {
  std::error_code unknown;
  const std::filesystem::path place = std::filesystem::absolute(path, unknown);
  const std::filesystem::path resolved = unknown ? place : std::filesystem::weakly_canonical(place, unknown);
  return unknown ? path : resolved.string();
}

std::string size_in_words(std::uint64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
  double size = static_cast<double>(bytes) / 1000;
  const char* const units[] = {" kB", " MB", " GB", " TB"};
  std::size_t unit = 0;
  for (; size >= 999.5 && unit < 3; ++unit) size /= 1000;
  return figure(size, 2) + units[unit];
}

constexpr const char* elsewhere = "choose a path with write permission";

[[noreturn]] void fail(const std::string& path, const std::string& problem, const std::string& advice) {
  Location where;
  where.file = path;
  throw Error(where, problem, advice);
}

std::string cannot_write(int code) { return "cannot write: " + std::generic_category().message(code); }

}  // namespace

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void print_written(const std::vector<WrittenFile>& files) {
  std::uint64_t bytes = 0;
  for (const WrittenFile& file : files) {
    bytes += file.bytes;
    if (files.size() <= 2) print("wrote " + one_line(file.path) + " (" + size_in_words(file.bytes) + ")\n");
  }
  if (files.size() > 2)
    print("wrote " + std::to_string(files.size()) + " files, " + one_line(files.front().path) + " to " +
          one_line(files.back().path) + " (" + size_in_words(bytes) + ")\n");
}

void refuse_same_file_twice(const std::vector<std::string>& read, const std::vector<std::string>& written) {
  std::set<std::string> seen;
  for (const std::string& file : read) seen.insert(file_itself(file));
  for (const std::string& file : written) {
    if (file == "/dev/null") continue;
    if (seen.insert(file_itself(file)).second) continue;
    Location where;
    where.file = file;
    throw Error(where, "is named twice", "give every file a different name");
  }
}

void refuse_unwritable(const std::string& path) {
  std::error_code unknown;
  std::filesystem::path place = std::filesystem::absolute(path, unknown);
  if (unknown || path.empty()) fail(path, "is not a path of a file", "name another");
  if (std::filesystem::is_directory(place, unknown)) fail(path, "cannot write: it is a folder", "name a file");
  if (std::filesystem::exists(place, unknown)) {
    if (::access(place.c_str(), W_OK) != 0) fail(path, cannot_write(errno), elsewhere);
    if (!std::filesystem::is_regular_file(place, unknown)) return;  // devices and pipes need no folder
  }
  do place = place.parent_path();
  while (!std::filesystem::exists(place, unknown) && place.has_relative_path());
  if (!std::filesystem::is_directory(place, unknown))
    fail(path, "cannot write: '" + place.string() + "' is not a folder", elsewhere);
  if (::access(place.c_str(), W_OK | X_OK) != 0) fail(path, cannot_write(errno), elsewhere);
}

void make_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) return;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) fail(path, "cannot create its folder: " + failed.message(), elsewhere);
}

void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written) {
    Location where;
    where.file = "standard output";
    throw Error(where, "could not be written",
                "check whether the disk is full or the other end of the pipe was closed");
  }
}

bool is_of_robot(const std::string& repair) { return repair.rfind("robot '", 0) == 0; }

void print_repairs(const std::vector<std::string>& repairs) {
  for (const std::string& repair : repairs)
    print((is_of_robot(repair) ? "doubtful: " : "repaired: ") + one_line(repair) + "\n");
}

void print_left_out(const std::vector<std::string>& left_out) {
  for (const std::string& one : left_out) print("left out: " + one_line(one) + "\n");
}

std::string one_line(const std::string& text) {
  std::string line;
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (character == '\n') {
      line += "\\n";
    } else if (character == '\t') {
      line += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned>(byte));
      line += escaped;
    } else {
      line += character;
    }
  }
  return line;
}

}  // namespace pliant::command
