#include "golden/cases.h"
#include "support/paths.h"

#include <algorithm>
#include <filesystem>

namespace pliant::golden {

namespace {

using validate::sweep_ways;
using validate::SweepWay;

constexpr const char* sweep_prefix = "sweep_";

Object cloth() {
  constexpr int n = 70;  // 4900 particles, more than a tile can have
  ClothOptions options;
  options.name = "cloth";
  options.material = fabric("cotton");
  options.material.bending_stiffness = 8e-6f;  // fixed, so that no preset decides the hashes of sweeps
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(grid_mesh(n, n, 1, 1), options);
  object.pins = {{0, {}}, {n - 1, Motion{{Keyframe{0, {}, {}}, Keyframe{0.1f, {-0.05f, 0.02f, 0}, {}}}, {}, false}}};
  return object;
}

Object balloon() {
  ClothOptions options;
  options.name = "balloon";
  options.bending_model = ClothOptions::Bending::isometric;
  options.volume = Volume{1.2f, Stiffness::compliance(1e-7f)};
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = {1.2f + 0.2f * p.x, 0.2f * p.y, 0.2f * p.z};
  return make_cloth(mesh, options);
}

Object rope() {
  std::vector<Vec3f> points;
  for (int i = 0; i < 18; ++i) points.push_back({-1.5f + 0.05f * static_cast<float>(i), 0, 0});
  RopeOptions options;
  options.stretch = Stiffness::compliance(1e-5f);
  options.bends = true;
  Object object = make_rope(points, options);
  object.pins = {{0, {}}};
  return object;
}

}  // namespace

Scene scene_of(const SweepWay& way) {
  Scene scene;
  for (const Object& object : {cloth(), balloon(), rope()}) scene.add(object);
  Collider ball, floor;
  ball.shape = Sphere{0.2f};
  ball.position = {0, -0.206f, 0};
  floor.position = {0, -0.22f, 0};
  scene.add(ball);
  scene.add(floor);
  scene.settings.substeps = 2;
  scene.settings.iterations = 4;
  scene.settings.sweep = way.sweep;
  scene.settings.sweep_options = way.options;
  return scene;
}

namespace {

/// Scenes in folders of scenes/ that run code of their own: rigid bodies on meshes, on cloth, in piles and with joints,
/// edges on primitives, heightfields, a deforming collider, distance grids, untangling, liquids, grains, cloth that
/// holds both, soft bodies, rods, and tears.
const char* const contact_scenes[] = {
    "bodies/bowl",        "bodies/hammock",      "bodies/pyramid",     "bodies/ragdoll",
    "contact/corners",    "contact/heightfield", "contact/sleeve",     "contact/solids",
    "contact/untangle",   "liquids/dam_break",   "liquids/floating",   "liquids/drops",
    "liquids/funnel",     "liquids/honey",       "liquids/ducks",      "liquids/flood",
    "bags/water",         "grains/heap",         "grains/hammock",     "bags/gravel",
    "grains/sand_clock",  "grains/sand_castle",  "liquids/wetting",    "soft_bodies/cantilevers",
    "soft_bodies/stairs", "soft_bodies/squeeze", "soft_bodies/finger", "soft_bodies/mattress",
    "soft_bodies/bumper", "soft_bodies/muscle",  "bodies/turntable",   "gas/pump",
    "bodies/belt",        "rods/springs",        "rods/stalks",        "rods/hair",
    "rods/winch",         "rods/mown",           "rods/bent_wire",     "soft_bodies/dancer",
    "tears/block",        "tears/sheet",         "bags/seeping",       "contact/woven",
    "clusters/clay",      "soft_bodies/models"};
constexpr int contact_frames = 16, tearing_frames = 40;

/// Upper limit of grid nodes along a side: grids as fine as those of the scenes would take seconds to make.
constexpr float nodes_a_side = 12;

void coarsen(MeshCollider& collider) {
  if (collider.as != MeshCollider::As::distance_grid) return;
  Vec3f low = collider.mesh.positions[0], high = low;
  for (const Vec3f& p : collider.mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  collider.grid_spacing = std::max({size.x, size.y, size.z}) / nodes_a_side;
}

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names(std::begin(contact_scenes), std::end(contact_scenes));
  for (const auto& entry : std::filesystem::directory_iterator(test::in_tree("scenes"))) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> sweep_names() {
  std::vector<std::string> names;
  for (const SweepWay& way : sweep_ways()) names.push_back(sweep_prefix + way.name);
  return names;
}

std::vector<std::string> case_names() {
  std::vector<std::string> names = scene_names();
  for (const std::string& name : sweep_names()) names.push_back(name);
  return names;
}

Case make_case(const std::string& name) {
  for (const SweepWay& way : sweep_ways())
    if (name == sweep_prefix + way.name) return {name, scene_of(way), sweep_frames};
  Case found{name, read_scene(test::in_tree("scenes/" + name + ".json")), scene_frames};
  if (name.find('/') != std::string::npos) found.frames = contact_frames;
  if (name.rfind("tears/", 0) == 0 || name == "bags/seeping") found.frames = tearing_frames;
  for (MeshCollider& collider : found.scene.mesh_colliders) coarsen(collider);
  return found;
}

}  // namespace pliant::golden
