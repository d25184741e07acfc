// Writes glTF 2.0 as one file: each object is a mesh, its frames are morph targets, and an animation of weights plays
// them. Rigid bodies are nodes that move (write_glb_bodies.h).
//
// Frame 0 is the mesh itself. Frame k is its k-th morph target, stored as differences; at its time the k-th weight is 1
// and all others are 0, so a viewer blends two neighbouring frames. Normals are written, because viewers shade meshes
// without them flat. The list of frames precedes the vertices in the file, so vertices are stored in a Spool until the
// end.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "glb_document.h"
#include "pliant/error.h"
#include "write_frames.h"
#include "write_glb_bodies.h"
#include "write_spool.h"

namespace pliant::output {

namespace {

std::vector<Vec3f> difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  std::vector<Vec3f> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

/// The vertices of one object: for each frame a block of positions and, for surfaces, of normals.
class Part {
 public:
  Part(const Destination& to, const FrameObject& object) : object_(object), spool_(to) {}

  void add(const std::vector<Vec3f>& positions) {
    if (positions.empty()) return;
    const std::vector<Vec3f> normals = surface() ? vertex_normals(positions, object_.triangles) : std::vector<Vec3f>{};
    if (bounds_.empty()) {
      positions_ = positions;
      normals_ = normals;
      put(positions, normals);
    } else {
      put(difference(positions, positions_), difference(normals, normals_));
    }
  }

  bool surface() const { return !object_.triangles.empty(); }
  Mode mode() const { return surface() ? triangles : object_.lines.empty() ? points : lines; }
  const FrameObject& object() const { return object_; }
  const std::vector<Bounds>& blocks() const { return bounds_; }
  Spool& vertices() { return spool_; }
  std::uint64_t size() const { return spool_.size(); }

  std::vector<std::uint32_t> indices() const {
    std::vector<std::uint32_t> result;
    for (const auto& triangle : object_.triangles) result.insert(result.end(), triangle.begin(), triangle.end());
    if (surface()) return result;
    for (const auto& line : object_.lines) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        result.push_back(static_cast<std::uint32_t>(line[i]));
        result.push_back(static_cast<std::uint32_t>(line[i + 1]));
      }
    }
    return result;
  }

 private:
  void put(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals) {
    bounds_.push_back(bounds(positions));
    spool_.write(positions.data(), positions.size() * sizeof(Vec3f));
    spool_.write(normals.data(), normals.size() * sizeof(Vec3f));
  }

  FrameObject object_;
  Spool spool_;
  std::vector<Vec3f> positions_, normals_;  // positions and normals of frame 0
  std::vector<Bounds> bounds_;              // bounds of each frame's positions
};

/// Adds the mesh and the node of an object. Returns the index of the node.
int add_part(Document& document, const Part& part) {
  const std::uint64_t count = static_cast<std::uint64_t>(part.object().particles);
  const std::uint64_t half = count * sizeof(Vec3f), block = part.surface() ? 2 * half : half;
  const int view = document.add_view(part.size(), array_buffer, true);
  json base, targets = json::array();
  for (std::size_t k = 0; k < part.blocks().size(); ++k) {
    json attributes{{"POSITION", document.add_accessor(view, k * block, float_32, count, "VEC3", &part.blocks()[k])}};
    if (part.surface()) attributes["NORMAL"] = document.add_accessor(view, k * block + half, float_32, count, "VEC3");
    if (k == 0)
      base = std::move(attributes);
    else
      targets.push_back(std::move(attributes));
  }
  const int material = add_material(document, part.object());
  json primitive{{"attributes", std::move(base)}, {"mode", part.mode()}, {"material", material}};
  if (const std::uint64_t indices = part.indices().size(); indices > 0)
    primitive["indices"] = document.add_accessor(document.add_view(indices * 4, element_array_buffer, false), 0,
                                                 unsigned_int, indices, "SCALAR");
  json mesh{{"name", part.object().name}};
  if (!targets.empty()) {
    mesh["weights"] = std::vector<float>(targets.size(), 0.f);
    primitive["targets"] = std::move(targets);
  }
  mesh["primitives"] = json::array({std::move(primitive)});
  return document.push("nodes", {{"name", part.object().name}, {"mesh", document.push("meshes", std::move(mesh))}});
}

class GlbWriter final : public FormatWriter {
 public:
  GlbWriter(const Destination& to, const Objects& objects)
      : path_(to.path), objects_(objects), file_(to.open(to.path)) {
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (objects_[o].has_matter()) {
        parts_.emplace_back(to, objects_[o]);
        part_objects_.push_back(o);
      }
      if (!objects_[o].bodies.empty()) {
        bodies_.emplace_back(objects_[o]);
        body_objects_.push_back(o);
      }
    }
  }

  void add(const Frame& frame) override {
    check_frame(path_, objects_, frame, last_time_);
    // Times must increase as floats too, because the file stores floats.
    if (!times_.empty() && !(static_cast<float>(frame.time) > times_.back()))
      refuse("has frames too close in time for float precision");
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].add(frame.positions[part_objects_[p]]);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].add(frame.bodies[body_objects_[b]]);
    times_.push_back(static_cast<float>(frame.time));
    last_time_ = frame.time;
    if (estimated_size() > largest_file) refuse("grows beyond the 4 GiB that the format allows");
  }

  void finish() override {
    if (std::exchange(finished_, true)) return;
    if (times_.empty())
      throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, "there are no frames to write",
                  "add one before finishing");
    Document document;
    json nodes = json::array();
    std::vector<int> moving;
    for (const Part& part : parts_) {
      if (part.blocks().empty()) continue;  // the format has no empty mesh
      nodes.push_back(add_part(document, part));
      moving.push_back(nodes.back());
    }
    for (GlbBodies& bodies : bodies_) nodes.push_back(bodies.add_nodes(document));
    if (times_.size() > 1) add_animation(document, moving);
    json scene{{"name", "Pliant"}};
    if (!nodes.empty()) scene["nodes"] = std::move(nodes);
    document.push("scenes", std::move(scene));
    if (document.binary_size() > 0) document.push("buffers", {{"byteLength", document.binary_size()}});
    write(document, times_.size() > 1 && !moving.empty());
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, problem,
                "write fewer frames, or .usda or .pvd");
  }

  std::uint64_t weight_count() const { return times_.size() * (times_.size() - 1); }

  std::uint64_t estimated_size() const {
    std::uint64_t size = 4 * (weight_count() + times_.size());
    for (const Part& part : parts_)
      size += part.size() + 12 * part.object().triangles.size() + 600 * times_.size() + 4096;
    for (const GlbBodies& bodies : bodies_) size += bodies.estimated_size();
    return size;
  }

  void add_animation(Document& document, const std::vector<int>& morphed) {
    json samplers = json::array(), channels = json::array();
    const int time_view = document.add_view(4 * times_.size(), 0, false);
    const int input = document.add_accessor(time_view, 0, float_32, times_.size(), "SCALAR");
    document.root()["accessors"][static_cast<std::size_t>(input)]["min"] = json::array({times_.front()});
    document.root()["accessors"][static_cast<std::size_t>(input)]["max"] = json::array({times_.back()});
    if (!morphed.empty()) {
      const int weight_view = document.add_view(4 * weight_count(), 0, false);
      const int output = document.add_accessor(weight_view, 0, float_32, weight_count(), "SCALAR");
      samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
    }
    for (const int node : morphed)
      channels.push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
    for (GlbBodies& bodies : bodies_) bodies.add_channels(document, input, samplers, channels);
    if (channels.empty()) return;  // nothing moves: the times alone are in the file
    document.push("animations",
                  {{"name", "simulation"}, {"channels", std::move(channels)}, {"samplers", std::move(samplers)}});
  }

  void write(Document& document, bool morphs) {
    std::string text = document.root().dump(-1, ' ', false, json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::uint64_t binary = document.binary_size();
    const std::uint64_t size = 12 + 8 + text.size() + (binary > 0 ? 8 + binary : 0);
    if (size > largest_file) refuse("grows beyond the 4 GiB that the format allows");
    file_->write("glTF");
    for (const std::uint64_t word : {std::uint64_t{2}, size, std::uint64_t{text.size()}})
      file_->write_value(static_cast<std::uint32_t>(word));
    file_->write("JSON");
    file_->write(text);
    if (binary > 0) {
      file_->write_value(static_cast<std::uint32_t>(binary));
      file_->write("BIN", 4);
      write_binary(morphs);
    }
    commit(*file_);
  }

  /// Writes the buffers in the order of the document's buffer views.
  void write_binary(bool morphs) {
    for (Part& part : parts_) {
      if (part.blocks().empty()) continue;
      part.vertices().copy_to(*file_);
      const std::vector<std::uint32_t> indices = part.indices();
      file_->write(indices.data(), indices.size() * 4);
    }
    for (const GlbBodies& bodies : bodies_) bodies.write_meshes(*file_);
    if (times_.size() < 2) return;
    file_->write(times_.data(), times_.size() * 4);
    if (morphs) write_weights();
    for (const GlbBodies& bodies : bodies_) bodies.write_tracks(*file_);
  }

  void write_weights() {
    std::vector<float> row(times_.size() - 1, 0.f);
    for (std::size_t frame = 0; frame < times_.size(); ++frame) {
      std::fill(row.begin(), row.end(), 0.f);
      if (frame > 0) row[frame - 1] = 1;
      file_->write(row.data(), row.size() * 4);
    }
  }

  std::string path_;
  Objects objects_;
  std::unique_ptr<OutputFile> file_;
  std::vector<Part> parts_;
  std::vector<GlbBodies> bodies_;
  std::vector<std::size_t> part_objects_, body_objects_;  // indices of their objects
  std::vector<float> times_;
  bool finished_ = false;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<FormatWriter> make_glb_writer(const Destination& to, const Objects& objects) {
  return std::make_unique<GlbWriter>(to, objects);
}

}  // namespace pliant::output
