#include "glb_bytes.h"

#include <cmath>
#include <cstring>

#include "io/file_bytes.h"
#include "pliant/error.h"

namespace pliant::render {

namespace {

constexpr std::size_t header = 12, chunk_header = 8;
constexpr int deepest_json = 64;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

std::size_t size_of_component(int component) {
  switch (component) {
    case 5121:
      return 1;
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

GlbBytes::GlbBytes(const std::string& path) : path_(path), bytes_(read_file_bytes(path)) {
  if (bytes_.size() < header + chunk_header || bytes_.compare(0, 4, "glTF") != 0) refuse("is no .glb file");
  if (word_at(bytes_, 4) != 2) refuse("is glTF of another version than 2");
  const std::size_t size = word_at(bytes_, header), text = header + chunk_header;
  if (bytes_.compare(header + 4, 4, "JSON") != 0 || size > bytes_.size() - text) refuse("is damaged or cut off");
  // Values of Json are copied by recursion, which a hostile text would let overflow the stack.
  const auto limit_depth = [&](int depth, Json::parse_event_t /*event*/, const Json& /*parsed*/) {
    if (depth >= deepest_json) refuse("has JSON nested deeper than " + std::to_string(deepest_json));
    return true;
  };
  const auto first = bytes_.begin() + text;
  root_ = Json::parse(first, first + static_cast<std::ptrdiff_t>(size), limit_depth, false);
  if (!root_.is_object()) refuse("has JSON that is not valid");
  const std::size_t next = text + size;
  if (next + chunk_header > bytes_.size()) return;  // no binary part
  binary_ = next + chunk_header;
  binary_size_ = word_at(bytes_, next);
  if (binary_size_ > bytes_.size() - binary_) refuse("is damaged or cut off");
}

void GlbBytes::refuse(const std::string& problem, const std::string& advice) const {
  throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, problem, advice);
}

std::size_t GlbBytes::count(const char* list) const {
  const auto found = root_.find(list);
  return found != root_.end() && found->is_array() ? found->size() : 0;
}

const GlbBytes::Json& GlbBytes::item(const char* list, std::size_t index) const {
  if (index >= count(list) || !root_[list][index].is_object())
    refuse("refers to " + std::string(list) + "/" + std::to_string(index) + ", which is not there");
  return root_[list][index];
}

std::size_t GlbBytes::index_of(const Json& of, const char* name, std::size_t otherwise) const {
  const auto found = of.find(name);
  if (found == of.end()) return otherwise;
  if (!found->is_number_unsigned()) refuse("has a '" + std::string(name) + "' that is no index");
  return found->get<std::size_t>();
}

std::vector<float> GlbBytes::numbers_of(const Json& of, const char* name, std::vector<float> otherwise) const {
  const auto found = of.find(name);
  if (found == of.end()) return otherwise;
  const auto wrong = [&] { refuse("has a '" + std::string(name) + "' that is no list of numbers as it should be"); };
  if (!found->is_array() || found->size() != otherwise.size()) wrong();
  for (std::size_t i = 0; i < otherwise.size(); ++i) {
    if (!(*found)[i].is_number()) wrong();
    otherwise[i] = (*found)[i].get<float>();
    if (!std::isfinite(otherwise[i])) wrong();
  }
  return otherwise;
}

GlbBytes::Elements GlbBytes::elements(std::size_t accessor, const std::string& type) const {
  const Json& of = item("accessors", accessor);
  const std::string name = "accessors/" + std::to_string(accessor);
  if (of.contains("sparse") || !of.contains("bufferView"))
    refuse(name + " is sparse, which this reader does not know", "export it without sparse accessors");
  if (of.value("type", Json()) != Json(type)) refuse(name + " is no " + type);
  const Json& view = item("bufferViews", index_of(of, "bufferView", 0));
  if (index_of(view, "buffer", 0) != 0 || count("buffers") != 1 || root_["buffers"][0].contains("uri"))
    refuse("has buffers in other files", "export it as one .glb");
  Elements result;
  result.component = static_cast<int>(index_of(of, "componentType", 0) & 0xFFFF);
  result.count = index_of(of, "count", 0);
  const std::size_t parts = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
  const std::size_t size = parts * size_of_component(result.component);
  result.stride = index_of(view, "byteStride", size);
  if (size == 0 || result.stride < size) refuse(name + " has elements of no size");
  const std::size_t begin = index_of(view, "byteOffset", 0), length = index_of(view, "byteLength", 0);
  const std::size_t offset = index_of(of, "byteOffset", 0);
  if (begin > binary_size_ || length > binary_size_ - begin || offset > length)
    refuse(name + " is outside of the file");
  const std::size_t room = length - offset;
  if (result.count > 0 && (room < size || (result.count - 1) > (room - size) / result.stride))
    refuse(name + " is outside of the file");
  result.first = bytes_.data() + binary_ + begin + offset;
  return result;
}

std::vector<float> GlbBytes::floats(std::size_t accessor, std::size_t parts) const {
  const Elements from = elements(accessor, parts == 1 ? "SCALAR" : parts == 3 ? "VEC3" : "VEC4");
  if (from.component != 5126)
    refuse("accessors/" + std::to_string(accessor) + " is packed, which this reader does not know",
           "export it with floats");
  std::vector<float> result(parts * from.count);
  for (std::size_t i = 0; i < from.count; ++i)
    std::memcpy(&result[parts * i], from.first + i * from.stride, parts * sizeof(float));
  for (const float x : result)
    if (!std::isfinite(x)) refuse("accessors/" + std::to_string(accessor) + " has a number that is not finite");
  return result;
}

std::vector<Vec3f> GlbBytes::points(std::size_t accessor) const {
  const std::vector<float> from = floats(accessor, 3);
  std::vector<Vec3f> result(from.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
  return result;
}

std::vector<int> GlbBytes::indices(std::size_t accessor, std::size_t limit) const {
  const Elements from = elements(accessor, "SCALAR");
  const std::size_t size = size_of_component(from.component);
  if (from.component == 5126) refuse("accessors/" + std::to_string(accessor) + " has no whole numbers");
  std::vector<int> result(from.count);
  for (std::size_t i = 0; i < from.count; ++i) {
    std::uint32_t index = 0;
    std::memcpy(&index, from.first + i * from.stride, size);
    if (index >= limit)
      refuse("has vertex " + std::to_string(index) + " of " + std::to_string(limit) + " in accessors/" +
             std::to_string(accessor));
    result[i] = static_cast<int>(index);
  }
  return result;
}

}  // namespace pliant::render
