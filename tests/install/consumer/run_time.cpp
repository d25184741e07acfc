// A running world changed from outside, by the installed headers alone: add, remove, cut, move, push, read, contact events.
#include <pliant/pliant.h>

#include <iostream>
#include <span>
#include <vector>

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::cerr << "not so: " << what << "\n";
  ++failures;
}

}  // namespace

int main() {
  pliant::Scene scene;
  scene.settings.sweep = pliant::Sweep::tiled;
  scene.settings.substeps = 10;
  pliant::World world(scene);
  world.record_contact_events(true);

  pliant::Collider ground;
  ground.position = {0, -0.3f, 0};
  const pliant::ColliderId floor = world.add(ground);
  pliant::Object sheet = pliant::make_cloth(pliant::grid_mesh(9, 9, 1, 1));
  const pliant::ObjectId cloth = world.add(sheet);
  const pliant::ObjectId other = world.add(sheet);
  world.remove(other);
  expect(!world.has(other), "a removed object is gone");
  try {
    world.positions(other);
    expect(false, "a stale id is refused");
  } catch (const pliant::Error&) {
  }

  std::vector<pliant::Vec3f> impulses(81, pliant::Vec3f{0, 0.0001f, 0});
  world.add_impulses(cloth, impulses);
  int begun = 0;
  for (int frame = 0; frame < 60; ++frame) {
    if (!world.step(1.f / 60).ok()) return 1;
    for (const pliant::ContactEvent& event : world.contact_events())
      begun += event.change == pliant::ContactEvent::Change::begin ? 1 : 0;
  }
  expect(begun >= 1, "the cloth began to touch the ground");

  const std::vector<int> path{4, 13, 22, 31, 40, 49, 58, 67, 76};
  const pliant::Edit edit = pliant::cut(sheet, path);
  world.edit(cloth, edit);
  expect(world.info(cloth).particles == 90, "a cut splits nine particles");

  const pliant::RigidPose lifted{{0, 0.2f, 0}, {}};
  world.set_poses(std::span<const pliant::ColliderId>(&floor, 1), {&lifted, 1});
  for (int frame = 0; frame < 30; ++frame) world.step(1.f / 60);
  std::vector<pliant::Vec3f> positions(90);
  world.read_positions(cloth, positions);
  for (const pliant::Vec3f& p : positions) expect(p.y > 0.19f, "the ground carries the cloth");
  expect(world.storage_order(cloth).size() == world.positions_in_storage_order(cloth).size(), "one number a record");
  return failures == 0 ? 0 : 1;
}
