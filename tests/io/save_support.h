// A scene with a value in every member that a file contains, and what tests of damaged files need.
#pragma once

#include <limits>
#include <string>

#include "core/sha256.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "support/scenes.h"

namespace pliant::testing_support {

/// A scene with a value in every member that a file contains.
inline Scene full_scene() {
  Scene scene;
  scene.gravity = {0.5f, -9, 0.25f};
  scene.wind = {{1, 0, 2}, 0.5f, 3, 1.2f};
  ClothOptions options;
  options.name = "sheet";
  options.velocity = {0, -1, 0};
  const int sheet = scene.add_cloth(grid_mesh(9, 9, 1, 1), options);
  scene.objects[sheet].self_collision = scene.objects[sheet].collides = true;
  scene.objects[sheet].colour = {0.1f, 0.2f, 0.3f};
  scene.pin(sheet, {0}, straight({0.1f, 0, 0}, 1));
  scene.objects[sheet].attachments.push_back({8, {0.5f, 0.2f, -0.5f}, {}, Stiffness::compliance(1e-4f, 0.1f)});
  options.name = "balloon";
  options.volume = Volume{1.5f, Stiffness::compliance(1e-3f)};
  const int balloon = scene.add_cloth(sphere_mesh(1), options);
  scene.objects[balloon].collides = true;
  for (Vec3f& x : scene.objects[balloon].positions) x = x * 0.2f + Vec3f{0, 0.3f, 0};
  Object rope = make_rope({{2, 0, 0}, {2.1f, 0, 0}, {2.2f, 0, 0}});
  rope.masses[0] = std::numeric_limits<float>::infinity();
  scene.add(rope);
  Collider capsule;
  capsule.name = "capsule";
  capsule.shape = Capsule{0.1f, 0.3f};
  capsule.position = {0, -0.3f, 0};
  capsule.motion = {{Keyframe{0, {}, {}}, Keyframe{0.5f, {0.1f, 0, 0}, rotation({0, 0, 1}, 40)}}, {0, 1, 0}, true};
  scene.add(capsule);
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  for (Vec3f& x : ball.mesh.positions) x = x * 0.2f + Vec3f{0.3f, -0.3f, 0.2f};
  scene.add(ball);
  ball.name = "grid";
  for (Vec3f& x : ball.mesh.positions) x.x -= 0.7f;
  ball.as = MeshCollider::As::distance_grid;
  ball.field = measure_distances(ball.mesh, 0.05f);
  scene.add(ball);
  scene.pairs.push_back({"sheet", "balloon", 0.01f, std::nullopt, 0.1f, std::nullopt});
  scene.settings.substeps = 5;
  scene.settings.sweep_options.relaxation = 1.1f;
  scene.settings.measure = true;
  return scene;
}

inline std::string reason(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::string hash_of_file(const std::string& bytes) {
  Sha256 sha;
  sha.add(bytes.data(), bytes.size());
  const std::string text = sha.finish();
  std::string digest;
  for (std::size_t i = 0; i < text.size(); i += 2)
    digest += static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16));
  return digest;
}

/// The bytes with a correct checksum: a forged file, not a damaged one.
inline std::string sealed(std::string bytes) {
  bytes.resize(bytes.size() - 32);
  return bytes + hash_of_file(bytes);
}

}  // namespace pliant::testing_support
