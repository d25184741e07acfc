#include "write_glb_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pliant::output {

namespace {

template <class T>
void write_all(OutputFile& file, const std::vector<T>& values) {
  file.write(values.data(), values.size() * sizeof(T));
}

template <class T>
bool changes(const std::vector<T>& values) {
  return std::any_of(values.begin(), values.end(), [&](const T& value) { return !(value == values.front()); });
}

/// A unit quaternion on the same half of the 4-sphere as the one before, because q and -q are one rotation.
std::array<float, 4> continued(const Quatf& q, const std::vector<std::array<float, 4>>& before) {
  const float norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  float scale = norm > 0 ? 1 / norm : 1;
  if (!before.empty()) {
    const std::array<float, 4>& b = before.back();
    if (b[0] * q.x + b[1] * q.y + b[2] * q.z + b[3] * q.w < 0) scale = -scale;
  }
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

}  // namespace

bool GlbBodies::Track::moves() const { return changes(translations); }
bool GlbBodies::Track::turns() const { return changes(rotations); }

GlbBodies::GlbBodies(const FrameObject& object) : object_(object), tracks_(object.bodies.size()) {
  for (const TriangleMesh& solid : object.solids) meshes_.push_back(shaded(solid));
}

void GlbBodies::add(const std::vector<BodyMotion>& frame) {
  for (std::size_t b = 0; b < tracks_.size(); ++b) {
    tracks_[b].translations.push_back(frame[b].pose.position);
    tracks_[b].rotations.push_back(continued(frame[b].pose.rotation, tracks_[b].rotations));
  }
}

std::uint64_t GlbBodies::estimated_size() const {
  std::uint64_t size = 4096;
  for (const ShadedMesh& mesh : meshes_) size += 24 * mesh.positions.size() + 12 * mesh.triangles.size() + 2048;
  for (const Track& track : tracks_) size += 28 * track.translations.size() + 1024;
  return size;
}

int GlbBodies::add_mesh(Document& document, const ShadedMesh& mesh, int material) const {
  const std::uint64_t count = mesh.positions.size();
  const Bounds box = bounds(mesh.positions);
  const int view = document.add_view(2 * count * sizeof(Vec3f), array_buffer, true);
  const json attributes{{"POSITION", document.add_accessor(view, 0, float_32, count, "VEC3", &box)},
                        {"NORMAL", document.add_accessor(view, count * sizeof(Vec3f), float_32, count, "VEC3")}};
  const std::uint64_t indices = 3 * mesh.triangles.size();
  const int index_view = document.add_view(4 * indices, element_array_buffer, false);
  const json primitive{{"attributes", attributes},
                       {"mode", static_cast<int>(triangles)},
                       {"material", material},
                       {"indices", document.add_accessor(index_view, 0, unsigned_int, indices, "SCALAR")}};
  return document.push("meshes", {{"name", object_.name}, {"primitives", json::array({primitive})}});
}

int GlbBodies::add_nodes(Document& document) {
  const int material = add_material(document, object_);
  std::vector<int> meshes;
  for (const ShadedMesh& mesh : meshes_)
    meshes.push_back(mesh.triangles.empty() ? -1 : add_mesh(document, mesh, material));  // the format has no empty mesh
  json children = json::array();
  for (std::size_t b = 0; b < tracks_.size(); ++b) {
    const FrameBody& body = object_.bodies[b];
    json node{{"name", body.name},
              {"translation", as_json(tracks_[b].translations.front())},
              {"rotation", tracks_[b].rotations.front()}};
    if (meshes[body.solid] >= 0) node["mesh"] = meshes[body.solid];
    tracks_[b].node = document.push("nodes", std::move(node));
    children.push_back(tracks_[b].node);
  }
  return document.push("nodes", {{"name", object_.name}, {"children", std::move(children)}});
}

void GlbBodies::add_channels(Document& document, int input, json& samplers, json& channels) const {
  const auto add = [&](const Track& track, const char* path, int parts, const char* type) {
    const std::uint64_t count = track.translations.size();
    const int view = document.add_view(4 * static_cast<std::uint64_t>(parts) * count, 0, false);
    const int output = document.add_accessor(view, 0, float_32, count, type);
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", track.node}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  };
  for (const Track& track : tracks_) {
    if (track.moves()) add(track, "translation", 3, "VEC3");
    if (track.turns()) add(track, "rotation", 4, "VEC4");
  }
}

void GlbBodies::write_meshes(OutputFile& file) const {
  for (const ShadedMesh& mesh : meshes_) {
    if (mesh.triangles.empty()) continue;
    write_all(file, mesh.positions);
    write_all(file, mesh.normals);
    write_all(file, mesh.triangles);
  }
}

void GlbBodies::write_tracks(OutputFile& file) const {
  for (const Track& track : tracks_) {
    if (track.moves()) write_all(file, track.translations);
    if (track.turns()) write_all(file, track.rotations);
  }
}

}  // namespace pliant::output
