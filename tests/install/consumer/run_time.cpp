// A user's program that uses only installed headers: objects of a running World are added, removed, cut, moved and
// pushed; it reads contact events, has a constraint type of its own, and continues from a file.
#include <pliant/constraint.h>
#include <pliant/pliant.h>

#include <array>
#include <iostream>
#include <limits>
#include <span>
#include <vector>

/// A constraint that keeps a weight on a line that cannot grow longer than a tether.
struct Tether {
  static constexpr const char* name = "tether";
  using slots = pliant::Points<2>;
  static constexpr int rows = 1;
  template <class R>
  struct Params {
    R longest;  // length [m]
  };
  static constexpr std::array<const char*, 1> fields{"longest"};

  template <class R>
  static void evaluate(const pliant::SlotValues<slots, R>& at, const Params<R>& p, pliant::Rows<slots, rows, R>& out) {
    using pliant::max, pliant::select, pliant::sqrt;
    const pliant::Vec3<R> d = at.point[1] - at.point[0];
    const R length = sqrt(dot(d, d));
    const auto slack = length < p.longest;
    const R scale = select(slack, R(0), R(1) / max(length, R(1e-20f)));
    out.c[0] = select(slack, R(0), length - p.longest);
    out.gradient[0][1] = d * scale;
    out.gradient[0][0] = -out.gradient[0][1];
  }
};

namespace {

constexpr float dt = 1.f / 60;
int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::cerr << "not so: " << what << "\n";
  ++failures;
}

pliant::Object weight_on_a_tether() {
  pliant::Object weight;
  weight.name = "weight";
  weight.positions = {{3, 2, 0}, {3.5f, 2, 0}};
  weight.masses = {std::numeric_limits<float>::infinity(), 1};
  pliant::ConstraintGroup group;
  group.type = "tether";
  group.particles = {0, 1};
  group.rest = {1};
  weight.constraints = {group};
  weight.damping = 4;
  return weight;
}

/// Expects that a World saved with this scene and loaded again has the same ids and gives the same bits.
void expect_to_go_on_from_a_file(pliant::World& world, const pliant::Scene& now) {
  pliant::save("run_time.world", world, now);
  pliant::LoadedWorld loaded = pliant::load_world("run_time.world");
  expect(loaded.world.objects() == world.objects(), "a loaded world has the same ids");
  for (int frame = 0; frame < 10; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
  }
  expect(loaded.world.state_hash() == world.state_hash(), "a loaded world goes on in the same bits");
  pliant::save("run_time.state", world.state());
  const std::string before = world.state_hash();
  world.step(dt);
  world.restore(pliant::load_state("run_time.state"));
  expect(world.state_hash() == before, "a state is put back");
}

}  // namespace

int main() {
  pliant::register_constraint<Tether>();
  pliant::Scene scene;
  scene.settings.sweep = pliant::Sweep::tiled;
  scene.settings.substeps = 10;
  pliant::World world(scene);
  world.record_contact_events(true);

  pliant::Collider ground;
  ground.position = {0, -0.3f, 0};
  const pliant::ColliderId floor = world.add(ground);
  pliant::Object sheet = pliant::make_cloth(pliant::grid_mesh(9, 9, 1, 1));
  const pliant::ObjectId other = world.add(sheet), cloth = world.add(sheet);
  world.remove(other);
  expect(!world.has(other), "a removed object is gone");
  try {
    world.object(other).positions();
    expect(false, "a stale id is refused");
  } catch (const pliant::Error&) {
  }
  const pliant::Object weight = weight_on_a_tether();
  const pliant::ObjectId hanging = world.add(weight);

  std::vector<pliant::Vec3f> impulses(81, pliant::Vec3f{0, 0.0001f, 0});
  world.object(cloth).add_impulses(impulses);
  int begun = 0;
  for (int frame = 0; frame < 60; ++frame) {
    if (!world.step(dt).ok()) return 1;
    for (const pliant::ContactEvent& event : world.contact_events())
      begun += event.change == pliant::ContactEvent::Change::begin ? 1 : 0;
  }
  expect(begun >= 1, "the cloth began to touch the ground");

  const std::vector<int> path{4, 13, 22, 31, 40, 49, 58, 67, 76};
  const pliant::Edit edit = pliant::cut(sheet, path);
  world.edit(cloth, edit);
  expect(world.object(cloth).info().particles == 90, "a cut splits nine particles");

  const pliant::RigidPose lifted{{0, 0.2f, 0}, {}};
  world.collider(floor).set_pose(lifted);
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  std::vector<pliant::Vec3f> positions(90);
  world.object(cloth).read_positions(positions);
  for (const pliant::Vec3f& p : positions) expect(p.y > 0.19f, "the ground carries the cloth");
  expect(world.object(cloth).storage_order().size() == world.object(cloth).positions_in_storage_order().size(),
         "one number a record");

  pliant::Scene now = scene;
  for (const pliant::ObjectId id : world.objects()) now.objects.push_back(id == cloth ? edit.object : weight);
  now.colliders = {ground};
  expect_to_go_on_from_a_file(world, now);
  for (int frame = 0; frame < 300; ++frame) world.step(dt);
  const pliant::Vec3f end = world.object(hanging).positions()[1];
  expect(end.y > 0.999f && end.y < 1.001f, "the program's own constraint holds the weight");
  return failures == 0 ? 0 : 1;
}
