#include "apps/bench/draped_meshes.h"

#include <algorithm>
#include <filesystem>

#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant::bench {

namespace {

constexpr int sheet_side = 100;           ///< particles along a side of the sheet
constexpr float sheet_width = 1;          ///< of the sheet [m]
constexpr float mesh_extent = 0.5f;       ///< longest extent of the mesh [m]
constexpr float start_gap = 0.02f;        ///< between mesh and sheet at the start [m]
constexpr float sheet_thickness = 2e-3f;  ///< of the sheet, a fifth of its edges [m]
constexpr float sheet_damping = 1;        ///< rate at which air slows the sheet [1/s]
constexpr int drape_frames = 240;

/// The mesh, scaled, with its lowest vertex on the ground and its box centred above the origin. `top` is its height
/// [m].
TriangleMesh placed(TriangleMesh mesh, float& top) {
  Vec3f low = mesh.positions.front(), high = low;
  for (const Vec3f& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  const float scale = mesh_extent / std::max({size.x, size.y, size.z});
  const Vec3f foot{(low.x + high.x) / 2, low.y, (low.z + high.z) / 2};
  for (Vec3f& p : mesh.positions) p = (p - foot) * scale;
  top = size.y * scale;
  return mesh;
}

bool is_mesh(const std::filesystem::path& path) {
  const std::string suffix = path.extension().string();
  return suffix == ".obj" || suffix == ".ply" || suffix == ".stl";
}

}  // namespace

Scene draped_mesh(const TriangleMesh& mesh) {
  Scene scene;
  scene.frames = drape_frames;
  float top = 0;
  MeshCollider collider;
  collider.mesh = placed(mesh, top);
  scene.add(std::move(collider));
  scene.add(Collider{});
  TriangleMesh grid = grid_mesh(sheet_side, sheet_side, sheet_width, sheet_width);
  for (Vec3f& p : grid.positions) p.y = top + start_gap;
  ClothOptions options;
  options.material = fabric("cotton");
  Object sheet = make_cloth(grid, options);
  sheet.name = "sheet";
  sheet.thickness = sheet_thickness;
  sheet.self_collision = true;
  sheet.damping = sheet_damping;
  scene.add(std::move(sheet));
  return scene;
}

std::vector<NamedScene> draped_meshes(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error))
    if (is_mesh(entry.path())) paths.push_back(entry.path());
  if (paths.empty())
    throw Error({folder, 0, {}, {}}, "holds no mesh", "name a folder with .obj, .ply or .stl files, at any depth");
  std::sort(paths.begin(), paths.end());
  std::vector<NamedScene> scenes;
  scenes.reserve(paths.size());
  for (const fs::path& path : paths)
    scenes.push_back({path.lexically_relative(folder).string(), draped_mesh(read_mesh(path.string()))});
  return scenes;
}

}  // namespace pliant::bench
