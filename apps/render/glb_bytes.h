// A .glb file in memory: its JSON, and the arrays in its binary part. Everything that the file says is checked.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::render {

class GlbBytes {
 public:
  using Json = nlohmann::json;

  /// Reads the file. Throws an Error that names it if it is no .glb of version 2.
  explicit GlbBytes(const std::string& path);

  const Json& root() const { return root_; }
  /// Item `index` of a list of the root: "nodes", "meshes". Throws an Error if there is none.
  const Json& item(const char* list, std::size_t index) const;
  /// The number of items of a list of the root.
  std::size_t count(const char* list) const;

  /// A member that is an index; `otherwise` if it is absent.
  std::size_t index_of(const Json& of, const char* name, std::size_t otherwise) const;
  /// A list of as many numbers; `otherwise` if it is absent.
  std::vector<float> numbers_of(const Json& of, const char* name, std::vector<float> otherwise) const;

  /// All numbers of an accessor of floats, with as many for each element ("SCALAR" 1, "VEC3" 3, "VEC4" 4).
  std::vector<float> floats(std::size_t accessor, std::size_t parts) const;
  /// The same, as points.
  std::vector<Vec3f> points(std::size_t accessor) const;
  /// All numbers of an accessor of whole numbers, each below `limit`.
  std::vector<int> indices(std::size_t accessor, std::size_t limit) const;

  [[noreturn]] void refuse(const std::string& problem, const std::string& advice = {}) const;

 private:
  /// Where the elements of an accessor are.
  struct Elements {
    const char* first = nullptr;
    std::size_t count = 0, stride = 0;
    int component = 0;
  };
  Elements elements(std::size_t accessor, const std::string& type) const;

  std::string path_, bytes_;
  Json root_;
  std::size_t binary_ = 0, binary_size_ = 0;  ///< the binary part of the bytes
};

}  // namespace pliant::render
