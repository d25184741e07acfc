// A small scene for the tests of all writers, and a folder that is removed after the test.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "io/write_frames.h"

namespace pliant::test {

/// A temporary folder for one test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "pliant-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

  /// The names of the files in the folder, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      result.push_back(entry.path().filename().string());
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  std::string path_;
};

inline std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// How often `part` occurs in `text`.
inline int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The value of type T at an offset in a file.
template <class T>
T value_at(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof value > bytes.size()) std::abort();
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A sheet of two triangles, a rope of three particles out of order, and two loose particles. No format can use their
/// names as they are.
inline output::Objects sample_objects() {
  return {{"a <sheet> & \"more\"", {0.5f, 0.25f, 1}, 0.002f, 4, {{0, 1, 2}, {1, 3, 2}}, {}},
          {"rope", {1, 0, 0}, 0.02f, 3, {}, {{0, 2, 1}}},
          {"rope", {0, 1, 0}, 0.1f, 2, {}, {}}};
}

/// Frame k of these objects: the sheet rises by k, the rope swings.
inline output::Frame sample_frame(int k) {
  const auto f = static_cast<float>(k);
  return {k / 60.,
          {{{0, f, 0}, {1, f, 0}, {0, f, 1}, {1, f + 0.1f, 1}},
           {{0, 2, 0}, {f, 1, 0}, {2 * f, 0, 0}},
           {{5, 5, f}, {6, 6, f}}},
          {{{0, 60, 0}, {0, 60, 0}, {0, 60, 0}, {0, 60, 0}},
           {{0, 0, 0}, {60, 0, 0}, {120, 0, 0}},
           {{0, 0, 60}, {0, 0, 60}}},
          k};
}

/// Writes `frames` frames of these objects to `path`.
inline void write_sample(const std::string& path, int frames) {
  const auto writer = output::make_format_writer(path, sample_objects(), 1. / 60);
  for (int k = 0; k < frames; ++k) writer->add(sample_frame(k));
  writer->finish();
}

}  // namespace pliant::test
