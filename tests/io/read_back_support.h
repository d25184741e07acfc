// Readers of .obj text and of the arrays of .vtp files, for the tests of writers.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "write_support.h"

namespace pliant::test {

struct Obj {
  std::vector<Vec3f> vertices;
  std::vector<std::vector<int>> faces, lines, points;
  std::vector<std::string> objects, groups;
};

inline Obj read_obj(const std::string& path) {
  Obj obj;
  std::istringstream file(read(path));
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3f v;
      words >> v.x >> v.y >> v.z;
      obj.vertices.push_back(v);
    } else if (kind == "o" || kind == "g") {
      (kind == "o" ? obj.objects : obj.groups).push_back(line.substr(2));
    } else if (kind != "#") {
      std::vector<int> indices;
      for (int i; words >> i;) indices.push_back(i);
      (kind == "f" ? obj.faces : kind == "l" ? obj.lines : obj.points).push_back(indices);
    }
  }
  return obj;
}

inline std::string decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, value = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    value = value << 6 | static_cast<unsigned>(digit);
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(value >> bits & 255);
  }
  return bytes;
}

/// The bytes of the array `name`, after its header was checked and removed.
inline std::string array(const std::string& text, const std::string& name) {
  const std::size_t tag = text.find("Name=\"" + name + "\"");
  if (tag == std::string::npos) return "no such array";
  const std::size_t first = text.find('>', tag) + 1;
  const std::string bytes = decode(text.substr(first, text.find('<', first) - first));
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 0), bytes.size() - 8);
  return bytes.substr(8);
}

}  // namespace pliant::test
