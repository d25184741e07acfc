// The JSON and the layout of a .glb file, for its writers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "write_frames.h"

namespace pliant::output {

using nlohmann::json;

enum Component : int { unsigned_int = 5125, float_32 = 5126 };
enum Target : int { array_buffer = 34962, element_array_buffer = 34963 };
enum Mode : int { points = 0, lines = 1, triangles = 4 };
constexpr std::uint64_t largest_file = 0xFFFFFFFFu;  // the format has 32-bit sizes

/// A bounding box of positions.
struct Bounds {
  Vec3f low, high;
};

inline Bounds bounds(const std::vector<Vec3f>& positions) {
  Bounds b{positions[0], positions[0]};
  for (const Vec3f& p : positions) {
    b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
    b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
  }
  return b;
}

inline json as_json(const Vec3f& v) { return json::array({v.x, v.y, v.z}); }

/// The JSON of the file and the layout of its binary part.
class Document {
 public:
  Document() : root_{{"asset", {{"version", "2.0"}, {"generator", "Pliant"}}}, {"scene", 0}} {}

  /// Reserves `size` bytes of the binary part. Returns the index of the buffer view.
  int add_view(std::uint64_t size, int target, bool vertices) {
    json view{{"buffer", 0}, {"byteOffset", binary_size_}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    if (vertices) view["byteStride"] = sizeof(Vec3f);
    binary_size_ += size;
    return push("bufferViews", std::move(view));
  }

  int add_accessor(int view, std::uint64_t offset, int component, std::uint64_t count, const char* type,
                   const Bounds* range = nullptr) {
    json accessor{
        {"bufferView", view}, {"byteOffset", offset}, {"componentType", component}, {"count", count}, {"type", type}};
    if (range != nullptr) {
      accessor["min"] = as_json(range->low);
      accessor["max"] = as_json(range->high);
    }
    return push("accessors", std::move(accessor));
  }

  int push(const char* list, json value) {
    root_[list].push_back(std::move(value));
    return static_cast<int>(root_[list].size()) - 1;
  }

  json& root() { return root_; }
  std::uint64_t binary_size() const { return binary_size_; }

 private:
  json root_;
  std::uint64_t binary_size_ = 0;
};

/// Adds a material of the object's colour. Returns its index.
inline int add_material(Document& document, const FrameObject& object) {
  const auto share = [](float c) { return std::clamp(c, 0.f, 1.f); };
  const Vec3f& colour = object.colour;
  return document.push("materials", {{"name", object.name},
                                     {"doubleSided", true},
                                     {"pbrMetallicRoughness",
                                      {{"baseColorFactor", {share(colour.x), share(colour.y), share(colour.z), 1.f}},
                                       {"metallicFactor", 0.f},
                                       {"roughnessFactor", 0.8f}}}});
}

}  // namespace pliant::output
