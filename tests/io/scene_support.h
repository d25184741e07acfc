// What the tests of scenes share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>

#include "pliant/error.h"
#include "pliant/io.h"
#include "support/paths.h"

namespace pliant {

inline void PrintTo(const Vec3f& v, std::ostream* out) { *out << "(" << v.x << ", " << v.y << ", " << v.z << ")"; }

}  // namespace pliant

namespace pliant::test {

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The Error that reading a scene throws; one without text if it throws none.
inline Error scene_error(const std::string& text, const std::string& folder = ".", bool allow_outside = true) {
  try {
    parse_scene(text, "x.json", folder, allow_outside);
  } catch (const Error& error) {
    return error;
  }
  return Error({}, "");
}

inline std::string scene_message(const std::string& text) { return scene_error(text).what(); }

/// A scene in which every field of the format occurs, except mesh files.
inline std::string full_scene() { return text_of(test::in_tree("tests/io/every_field.json")); }

/// The object of a name, which must be there.
inline const Object& named(const Scene& scene, const std::string& name) {
  return *std::find_if(scene.objects.begin(), scene.objects.end(), [&](const Object& one) { return one.name == name; });
}

class FullScene : public testing::Test {
 protected:
  const Scene scene = parse_scene(full_scene(), "every_field.json", ".");
};

}  // namespace pliant::test
