// A cache of signed distance grids on disk. A file's name is the hash of what the grid is made from, and its first
// bytes are the hash of its content. So no grid is used for another mesh, and damaged files are ignored.
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "core/sha256.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant {

namespace {

constexpr std::string_view magic = "pliant distances 1\n";
constexpr std::size_t hash_digits = 64;
constexpr std::int64_t most_nodes = std::int64_t{1} << 27;

/// The header of a cache file, before the distances.
struct Head {
  float low[3], spacing;
  std::int32_t nodes[3];
};

std::string hash_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.finish();
}

std::string name_of(const TriangleMesh& mesh, float spacing) {
  Sha256 hash;
  hash.add(magic.data(), magic.size());
  hash.add(&spacing, sizeof spacing);
  const auto add = [&](const auto& list) {
    const std::uint64_t count = list.size();
    hash.add(&count, sizeof count);
    if (count > 0) hash.add(list.data(), list.size() * sizeof list[0]);
  };
  add(mesh.positions);
  add(mesh.triangles);
  return hash.finish() + ".distances";
}

/// Reads a grid from the bytes of a cache file; null if they are incomplete or damaged.
std::shared_ptr<const DistanceField> parse(std::string_view bytes) {
  if (bytes.substr(0, magic.size()) != magic || bytes.size() < magic.size() + hash_digits + sizeof(Head))
    return nullptr;
  const std::string_view body = bytes.substr(magic.size() + hash_digits);
  if (hash_of(body) != bytes.substr(magic.size(), hash_digits)) return nullptr;
  Head head;
  std::memcpy(&head, body.data(), sizeof head);
  std::int64_t nodes = 1;
  for (const std::int32_t along : head.nodes) {
    if (along < 2 || along > most_nodes / nodes) return nullptr;
    nodes *= along;
  }
  if (body.size() != sizeof head + static_cast<std::size_t>(nodes) * sizeof(float)) return nullptr;
  auto field = std::make_shared<DistanceField>();
  field->low = {head.low[0], head.low[1], head.low[2]};
  field->spacing = head.spacing;
  field->nodes = {head.nodes[0], head.nodes[1], head.nodes[2]};
  field->distances.resize(static_cast<std::size_t>(nodes));
  std::memcpy(field->distances.data(), body.data() + sizeof head, body.size() - sizeof head);
  return field;
}

void write(const std::string& path, const DistanceField& field) {
  const Head head{
      {field.low.x, field.low.y, field.low.z}, field.spacing, {field.nodes[0], field.nodes[1], field.nodes[2]}};
  const std::size_t size = field.distances.size() * sizeof(float);
  Sha256 hash;
  hash.add(&head, sizeof head);
  hash.add(field.distances.data(), size);
  AtomicFile file(path);
  file.write(magic);
  file.write(hash.finish());
  file.write_value(head);
  file.write(field.distances.data(), size);
  file.commit();
}

/// Reads a cache file; null if it does not exist or is damaged.
std::shared_ptr<const DistanceField> read(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return nullptr;
  return parse(read_file_bytes(path));
}

}  // namespace

std::shared_ptr<const DistanceField> cached_distances(const TriangleMesh& mesh, float spacing,
                                                      const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error({folder}, "cannot be created as a folder for distance grids: " + failed.message(),
                "name a writable folder");
  const std::string path = (std::filesystem::path(folder) / name_of(mesh, spacing)).string();
  if (auto kept = read(path)) return kept;
  auto measured = measure_distances(mesh, spacing);
  write(path, *measured);
  return measured;
}

void use_cached_distances(Scene& scene, const std::string& folder) {
  for (MeshCollider& collider : scene.mesh_colliders)
    if (collider.as == MeshCollider::As::distance_grid && !collider.field)
      collider.field = cached_distances(collider.mesh, collider.grid_spacing, folder);
}

}  // namespace pliant
