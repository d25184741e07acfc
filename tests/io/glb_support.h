// Reads what the tests of writers look at in a .glb file.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "write_support.h"

namespace pliant::test {

/// A .glb divided into its two chunks.
struct Glb {
  nlohmann::json document;
  std::string binary;

  explicit Glb(const std::string& path) {
    const std::string bytes = test::read(path);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(value_at<unsigned>(bytes, 4), 2u);
    EXPECT_EQ(value_at<unsigned>(bytes, 8), bytes.size());
    const unsigned length = value_at<unsigned>(bytes, 12);
    EXPECT_EQ(length % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    document = nlohmann::json::parse(bytes.substr(20, length));
    EXPECT_EQ(value_at<unsigned>(bytes, 20 + length), bytes.size() - 28 - length);
    EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN", 4));
    binary = bytes.substr(28 + length);
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary.size());
  }

  /// All elements of an accessor.
  template <class T>
  std::vector<T> read(std::size_t index) const {
    const nlohmann::json& accessor = document["accessors"][index];
    const nlohmann::json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t first = view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
    const std::size_t count = accessor["count"];
    EXPECT_EQ(first % 4, 0u);
    EXPECT_LE(accessor["byteOffset"].get<std::size_t>() + count * sizeof(T), view["byteLength"].get<std::size_t>());
    std::vector<T> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(value_at<T>(binary, first + i * sizeof(T)));
    return result;
  }
  /// Element i of an accessor, of numbers of 4 bytes.
  template <class T>
  T element(int accessor, std::size_t i) const {
    const nlohmann::json& a = document["accessors"][static_cast<std::size_t>(accessor)];
    const nlohmann::json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    return value_at<T>(binary,
                       view["byteOffset"].get<std::size_t>() + a["byteOffset"].get<std::size_t>() + i * sizeof(T));
  }
  const nlohmann::json& node(const std::string& name) const {
    for (const nlohmann::json& one : document["nodes"])
      if (one["name"] == name) return one;
    ADD_FAILURE() << "no node " << name;
    return document["nodes"][0];
  }
};

}  // namespace pliant::test
