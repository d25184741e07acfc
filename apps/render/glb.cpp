#include "glb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry.h"
#include "glb_bytes.h"
#include "matrix.h"

namespace pliant::render {

namespace glb {  // not anonymous, since parts of GlbFile have these types

using Json = GlbBytes::Json;

constexpr std::size_t no_index = static_cast<std::size_t>(-1);
enum GlbMode : std::size_t { glb_points = 0, glb_lines = 1, glb_line_strip = 3, glb_triangles = 4 };

/// A point (x, y, z) is at origin + x * axes[0] + ...
struct Affine {
  std::array<Vec3f, 3> axes{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
  Vec3f origin{};

  Vec3f turned(const Vec3f& v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
  Vec3f of(const Vec3f& point) const { return origin + turned(point); }
  Affine of(const Affine& inner) const {
    return {{turned(inner.axes[0]), turned(inner.axes[1]), turned(inner.axes[2])}, of(inner.origin)};
  }
  /// By how much it lengthens, in the mean of all directions.
  float scale() const { return std::cbrt(std::abs(dot(axes[0], cross(axes[1], axes[2])))); }
};

/// The values of a channel at a time: those of the keys around it, mixed.
struct Keys {
  std::vector<float> times, values;
  bool steps = false;

  std::vector<float> at(float time) const {
    const std::size_t parts = values.size() / times.size();
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const std::size_t next = static_cast<std::size_t>(after - times.begin());
    const std::size_t low = next == 0 ? 0 : next - 1, high = std::min(next, times.size() - 1);
    const float gap = times[high] - times[low];
    const float share = steps || !(gap > 0) ? 0 : (time - times[low]) / gap;
    std::vector<float> result(parts);
    for (std::size_t i = 0; i < parts; ++i)
      result[i] = values[low * parts + i] + share * (values[high * parts + i] - values[low * parts + i]);
    return result;
  }

  /// q and -q are one rotation: of each key the one is taken that is nearer to the key before, the short way round.
  void take_shorter_rotations() {
    for (std::size_t i = 4; i + 3 < values.size(); i += 4) {
      float product = 0;
      for (std::size_t k = i; k < i + 4; ++k) product += values[k] * values[k - 4];
      for (std::size_t k = i; k < i + 4 && product < 0; ++k) values[k] = -values[k];
    }
  }
};

/// A part of a mesh.
struct Primitive {
  std::size_t mode = glb_triangles;
  std::vector<Vec3f> positions;
  std::vector<std::size_t> targets;  ///< accessors of differences of positions
  std::vector<int> indices;
  Vec3f colour{0.7f, 0.7f, 0.7f};
};

struct Mesh {
  std::vector<Primitive> primitives;
  std::vector<float> weights;  ///< of nodes that have none of their own
};

/// Pairs of points as polylines: a pair that begins where the last one ended goes on with it.
static std::vector<std::vector<int>> lines_of(const Primitive& primitive) {
  std::vector<std::vector<int>> lines;
  if (primitive.mode == glb_line_strip) return {primitive.indices};
  for (std::size_t i = 0; i + 1 < primitive.indices.size(); i += 2) {
    const int from = primitive.indices[i], to = primitive.indices[i + 1];
    if (lines.empty() || lines.back().back() != from) lines.push_back({from});
    lines.back().push_back(to);
  }
  return lines;
}

/// Half of the distance of neighbours, if points fill the box around them.
static float radius_of_points(const std::vector<Vec3f>& points) {
  const Bounds box = bounds(points);
  const Vec3f size = box.high - box.low;
  const float least = 0.05f * box.radius();
  const float volume = std::max(size.x, least) * std::max(size.y, least) * std::max(size.z, least);
  return 0.5f * std::cbrt(volume / static_cast<float>(points.size()));
}

}  // namespace glb

using namespace glb;

/// What an animation changes of a node: "translation", "rotation", "scale" or "weights".
struct GlbFile::Channel {
  std::string path;
  Keys keys;
};

struct GlbFile::Implementation {
  GlbBytes bytes;
  std::vector<Mesh> meshes{};
  std::map<std::size_t, std::vector<Channel>> channels{};  // by node
  std::vector<float> times{};                              // of the frames

  explicit Implementation(const std::string& path) : bytes(path) {
    for (std::size_t m = 0; m < bytes.count("meshes"); ++m) meshes.push_back(read_mesh(bytes.item("meshes", m)));
    if (bytes.count("animations") > 0) read_animation(bytes.item("animations", 0));
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    if (times.empty()) times = {0};
  }

  Vec3f colour_of(const Json& primitive) const {
    const std::size_t material = bytes.index_of(primitive, "material", no_index);
    if (material == no_index) return Primitive{}.colour;
    const Json pbr = bytes.item("materials", material).value("pbrMetallicRoughness", Json::object());
    if (!pbr.is_object()) bytes.refuse("has a material that is none");
    const std::vector<float> factor = bytes.numbers_of(pbr, "baseColorFactor", {1, 1, 1, 1});
    return {factor[0], factor[1], factor[2]};
  }

  Primitive read_primitive(const Json& from) const {
    Primitive primitive;
    primitive.mode = bytes.index_of(from, "mode", glb_triangles);
    const Json attributes = from.value("attributes", Json::object());
    if (!attributes.is_object()) bytes.refuse("has attributes that are none");
    primitive.positions = bytes.points(bytes.index_of(attributes, "POSITION", no_index));
    const std::size_t count = primitive.positions.size(), indices = bytes.index_of(from, "indices", no_index);
    if (indices != no_index) primitive.indices = bytes.indices(indices, count);
    for (std::size_t i = 0; indices == no_index && i < count; ++i) primitive.indices.push_back(static_cast<int>(i));
    if (const Json targets = from.value("targets", Json::array()); targets.is_array())
      for (const Json& target : targets)
        primitive.targets.push_back(target.is_object() ? bytes.index_of(target, "POSITION", no_index) : no_index);
    primitive.colour = colour_of(from);
    return primitive;
  }

  /// The weights of a node or mesh; none if it says none.
  std::vector<float> weights_of(const Json& of) const {
    const auto found = of.find("weights");
    return bytes.numbers_of(of, "weights", std::vector<float>(found == of.end() ? 0 : found->size()));
  }

  Mesh read_mesh(const Json& mesh) const {
    Mesh result{.primitives = {}, .weights = weights_of(mesh)};
    const Json primitives = mesh.value("primitives", Json::array());
    if (!primitives.is_array()) bytes.refuse("has a mesh without primitives");
    for (const Json& from : primitives) {
      if (!from.is_object()) bytes.refuse("has a primitive that is none");
      result.primitives.push_back(read_primitive(from));
    }
    return result;
  }

  void read_animation(const Json& animation) {
    const Json list = animation.value("channels", Json::array()), samplers = animation.value("samplers", Json::array());
    if (!list.is_array() || !samplers.is_array()) bytes.refuse("has an animation without channels");
    for (const Json& from : list) {
      const Json target = from.is_object() ? from.value("target", Json::object()) : Json();
      const std::size_t sampler = from.is_object() ? bytes.index_of(from, "sampler", no_index) : no_index;
      if (!target.is_object() || sampler >= samplers.size() || !samplers[sampler].is_object())
        bytes.refuse("has an animation with a damaged channel");
      const std::size_t node = bytes.index_of(target, "node", no_index);
      if (node == no_index) continue;
      const Json path = target.value("path", Json());
      add_channel(node, path.is_string() ? path.get<std::string>() : "", samplers[sampler]);
    }
  }

  void add_channel(std::size_t node, const std::string& path, const Json& sampler) {
    const std::size_t parts = path == "rotation" ? 4 : path == "translation" || path == "scale" ? 3 : 1;
    Keys keys;
    keys.times = bytes.floats(bytes.index_of(sampler, "input", no_index), 1);
    keys.values = bytes.floats(bytes.index_of(sampler, "output", no_index), parts);
    const Json way = sampler.value("interpolation", Json("LINEAR"));
    if (way == Json("CUBICSPLINE"))
      bytes.refuse("has keys with tangents, which this reader does not know", "export it with linear interpolation");
    keys.steps = way == Json("STEP");
    const bool fits = !keys.times.empty() && !keys.values.empty() && keys.values.size() % keys.times.size() == 0 &&
                      (path == "weights" || keys.values.size() == parts * keys.times.size());
    if (!fits || !std::is_sorted(keys.times.begin(), keys.times.end()))
      bytes.refuse("has an animation whose keys do not fit their times");
    if (path == "rotation") keys.take_shorter_rotations();
    times.insert(times.end(), keys.times.begin(), keys.times.end());
    channels[node].push_back({path, std::move(keys)});
  }

  /// What is animated of a node at a time; `otherwise` if it is not.
  std::vector<float> value_of(std::size_t node, const char* path, float time, std::vector<float> otherwise) const {
    const auto found = channels.find(node);
    if (found == channels.end()) return otherwise;
    for (const Channel& channel : found->second)
      if (channel.path == path) return channel.keys.at(time);
    return otherwise;
  }

  Affine place_of(std::size_t index, float time) const {
    const Json& node = bytes.item("nodes", index);
    if (node.contains("matrix")) {
      const std::vector<float> m = bytes.numbers_of(node, "matrix", std::vector<float>(16));
      return {{Vec3f{m[0], m[1], m[2]}, Vec3f{m[4], m[5], m[6]}, Vec3f{m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
    }
    const auto part = [&](const char* path, std::vector<float> otherwise) {
      return value_of(index, path, time, bytes.numbers_of(node, path, std::move(otherwise)));
    };
    const std::vector<float> t = part("translation", {0, 0, 0}), r = part("rotation", {0, 0, 0, 1});
    const std::vector<float> s = part("scale", {1, 1, 1});
    const float norm = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    const Quatf turn = norm > 0 ? Quatf{r[0] / norm, r[1] / norm, r[2] / norm, r[3] / norm} : Quatf{};
    return {{rotate(turn, Vec3f{s[0], 0, 0}), rotate(turn, Vec3f{0, s[1], 0}), rotate(turn, Vec3f{0, 0, s[2]})},
            {t[0], t[1], t[2]}};
  }

  std::vector<Vec3f> shape_of(const Primitive& primitive, const std::vector<float>& weights) const {
    std::vector<Vec3f> positions = primitive.positions;
    for (std::size_t k = 0; k < std::min(weights.size(), primitive.targets.size()); ++k) {
      if (weights[k] == 0 || primitive.targets[k] == no_index) continue;
      const std::vector<Vec3f> difference = bytes.points(primitive.targets[k]);
      if (difference.size() != positions.size()) bytes.refuse("has a morph target of another size than its mesh");
      for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += difference[i] * weights[k];
    }
    return positions;
  }

  /// `scale`: of what the node shows, at rest.
  void draw(const Primitive& primitive, std::vector<Vec3f> positions, float scale, RenderScene& into) const {
    if (positions.empty()) return;
    if (primitive.mode == glb_points) {
      const float radius = scale * radius_of_points(primitive.positions);
      into.balls.push_back({.centres = std::move(positions), .radius = radius, .colour = primitive.colour});
    } else if (primitive.mode == glb_lines || primitive.mode == glb_line_strip) {
      const float radius = 0.004f * scale * bounds(primitive.positions).radius();
      for (const std::vector<int>& line : lines_of(primitive)) {
        RenderTube tube{.points = {}, .radius = radius, .colour = primitive.colour};
        for (const int i : line) tube.points.push_back(positions[static_cast<std::size_t>(i)]);
        into.tubes.push_back(std::move(tube));
      }
    } else if (primitive.mode == glb_triangles) {
      RenderMesh mesh{.positions = std::move(positions), .triangles = {}, .colour = primitive.colour};
      for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
        mesh.triangles.push_back({primitive.indices[i], primitive.indices[i + 1], primitive.indices[i + 2]});
      into.meshes.push_back(std::move(mesh));
    } else {
      bytes.refuse("has a mesh of mode " + std::to_string(primitive.mode) + ", which this reader does not know",
                   "export it as triangles, lines or points");
    }
  }

  /// A picture in the making.
  struct Drawing {
    float time = 0;
    std::vector<char> seen{};  ///< by node: 1 if it is drawn
    RenderScene scene{};
  };

  /// Refuses nodes with two parents: by a few of them a small file would ask for billions of meshes.
  void add_node(std::size_t index, const Affine& around, int depth, Drawing& into) const {
    constexpr int deepest = 200;
    if (depth > deepest) bytes.refuse("has nodes nested deeper than " + std::to_string(deepest));
    const Json& node = bytes.item("nodes", index);
    if (into.seen[index]++ != 0) bytes.refuse("has node " + std::to_string(index) + " in two places");
    const Affine place = around.of(place_of(index, into.time));
    if (const std::size_t number = bytes.index_of(node, "mesh", no_index); number != no_index) {
      if (number >= meshes.size()) bytes.refuse("has a node with a mesh that is not there");
      const Mesh& mesh = meshes[number];
      const std::vector<float> at_rest = node.contains("weights") ? weights_of(node) : mesh.weights;
      for (const Primitive& primitive : mesh.primitives) {
        std::vector<Vec3f> positions = shape_of(primitive, value_of(index, "weights", into.time, at_rest));
        for (Vec3f& p : positions) p = place.of(p);
        draw(primitive, std::move(positions), place.scale(), into.scene);
      }
    }
    add_nodes(node.value("children", Json::array()), place, depth + 1, into);
  }

  void add_nodes(const Json& list, const Affine& around, int depth, Drawing& into) const {
    if (!list.is_array()) bytes.refuse("has a list of nodes that is none");
    for (const Json& index : list) {
      if (!index.is_number_unsigned()) bytes.refuse("has a list of nodes that is none");
      add_node(index.get<std::size_t>(), around, depth, into);
    }
  }
};

GlbFile::GlbFile(const std::string& path) : self_(std::make_unique<Implementation>(path)) {}
GlbFile::~GlbFile() = default;
GlbFile::GlbFile(GlbFile&&) noexcept = default;
GlbFile& GlbFile::operator=(GlbFile&&) noexcept = default;

int GlbFile::last_frame() const { return static_cast<int>(self_->times.size()) - 1; }

double GlbFile::frame_time() const {
  const std::vector<float>& times = self_->times;
  const double whole = static_cast<double>(times.back()) - static_cast<double>(times.front());
  return whole > 0 ? whole / static_cast<double>(times.size() - 1) : 1.0 / 24;
}

RenderScene GlbFile::frame(int number) const {
  Implementation::Drawing drawing{.time = self_->times[static_cast<std::size_t>(number)]};
  drawing.seen.resize(self_->bytes.count("nodes"));
  const std::size_t shown = self_->bytes.index_of(self_->bytes.root(), "scene", 0);
  const Json& nodes = self_->bytes.item("scenes", shown);
  self_->add_nodes(nodes.value("nodes", Json::array()), {}, 0, drawing);
  RenderScene scene = std::move(drawing.scene);
  // Colliders are not in the file. What reaches below 0 is not drawn through a ground there.
  const Bounds box = bounds(points_of_interest(scene));
  if (!box.empty() && box.low.y < -0.02f * box.radius()) scene.ground.reset();
  return scene;
}

}  // namespace pliant::render
