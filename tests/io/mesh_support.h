// What the tests of mesh files share: meshes from text, error texts, and bytes of binary files.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "io/mesh_polygons.h"
#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant::test {

inline constexpr MeshReadOptions as_it_is{false, false, false};

inline TriangleMesh mesh_of(std::string_view bytes, const std::string& name) {
  return parse_mesh(bytes, name, as_it_is).mesh;
}

/// The text of the Error that reading `bytes` throws; empty if it throws none.
inline std::string error_of(std::string_view bytes, const std::string& name, const MeshReadOptions& options = {}) {
  try {
    parse_mesh(bytes, name, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Joins all lines to one text.
inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' does not contain '" << part << "'";
}

/// Expects what every mesh that was read must be, whatever the file was.
inline void expect_sound(const TriangleMesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const auto& t : mesh.triangles)
    for (const int corner : t) ASSERT_TRUE(corner >= 0 && static_cast<std::size_t>(corner) < mesh.positions.size());
}

/// The bytes of a number in the given order.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) bytes.assign(bytes.rbegin(), bytes.rend());
  return bytes;
}

}  // namespace pliant::test
