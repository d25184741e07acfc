// Rigid bodies that are fast, ropes that break and liquids that overlap: nothing passes, nothing is thrown. All rows
// are of the engine, in float, with its default substeps.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/body.h"
#include "pliant/liquid.h"
#include "pliant/random.h"

namespace pliant::validate {
namespace {

Scene one_thread() {
  Scene scene;
  scene.settings.threads = 1;
  return scene;
}

BodyOptions placed(const Vec3f& position, const Quatf& rotation = {}, const Vec3f& velocity = {}) {
  BodyOptions options;
  options.position = position;
  options.rotation = rotation;
  options.velocity = velocity;
  return options;
}

Object frictionless(Object object) {
  object.static_friction = object.kinetic_friction = 0;
  return object;
}

// ------------------------------------------------------------------------------------------------ nothing passes

constexpr float half_die = 0.05f;

/// A closed mesh of a box of 14 x 1 x 14 m with its upper face at y = 0.
MeshCollider mesh_floor() {
  MeshCollider floor;
  floor.mesh = mesh_of({{Box{{7, 0.5f, 7}}}});
  for (Vec3f& p : floor.mesh.positions) p.y -= 0.5f;
  return floor;
}

/// Dice that tumble 2 m down onto a closed mesh.
Scene dice_on_mesh() {
  Scene scene = one_thread();
  scene.add(mesh_floor());
  pliant::Random random(3);
  Object dice;
  dice.name = "dice";
  for (int i = 0; i < 64; ++i) {
    const Vec3f off{random.between(-0.2f, 0.2f), random.between(-0.02f, 0.02f), random.between(-0.2f, 0.2f)};
    const Vec3f place{static_cast<float>(i % 8) - 3.5f, 2, static_cast<float>(i / 8) - 3.5f};
    add_body(dice, {{Box{{half_die, half_die, half_die}}}}, placed(place + off, random.rotation()));
  }
  scene.add(dice);
  return scene;
}

/// Cubes that hit a mesh with an edge at 9 m/s, each in another phase of the frame.
Scene cubes_on_mesh() {
  Scene scene = one_thread();
  scene.gravity = {};
  MeshCollider ground;
  ground.mesh = grid_mesh(2, 2, 12, 12);
  scene.add(ground);
  Object cubes;
  cubes.name = "cubes";
  for (int i = 0; i < 16; ++i) {
    const Vec3f place{0.3f * static_cast<float>(i) - 2.1f, 1.6f + 9.f / 60 / 16 * static_cast<float>(i), 0.2f};
    add_body(cubes, {{Box{{half_die, half_die, half_die}}}}, placed(place, rotation({0, 0, 1}, 45), {0, -9, 0}));
  }
  scene.add(cubes);
  return scene;
}

/// How many bodies are below y = 0 after some frames.
int lost(Scene scene, int frames) {
  World world(scene);
  for (int i = 0; i < frames; ++i) world.step(frame_time);
  const std::vector<Vec3f> x = world.object(0).positions();
  return static_cast<int>(std::count_if(x.begin(), x.end(), [](const Vec3f& p) { return !(p.y > 0); }));
}

void passing_rows(Result& result) {
  result.rows.push_back(at_most("bodies: engine, tumbling dice that pass a closed mesh", 0, lost(dice_on_mesh(), 100),
                                "", "64 dice of 10 cm, falls by 2 m"));
  result.rows.push_back(at_most("bodies: engine, cubes that pass a mesh edge first", 0, lost(cubes_on_mesh(), 30), "",
                                "16 cubes of 10 cm at 9 m/s, in 16 phases of the frame"));
}

// ------------------------------------------------------------------------------------------------ no ramps

void flush_rows(Result& result) {
  constexpr float radius = 0.1f, speed = 5, above = 1e-4f;
  Scene scene = one_thread();
  for (int i = 0; i < 4; ++i) {
    Collider box;
    box.name = "box " + std::to_string(i);
    box.shape = Box{{1, 1, 1}};
    box.position = {2 * static_cast<float>(i), -1, 0};
    box.static_friction = box.kinetic_friction = 0;
    scene.add(box);
  }
  scene.add(frictionless(make_body({{Sphere{radius}}}, placed({-0.9f, radius + above, 0}, {}, {speed, 0, 0}))));
  World world(scene);
  double rise = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(frame_time);
    rise = std::max(rise, static_cast<double>(world.object(0).positions()[0].y - (radius + above)));
  }
  const double loss = 1 - static_cast<double>(world.object(0).velocities()[0].x / speed);
  const std::string how = "radius 0.1 m, 5 m/s, four boxes side by side, no friction";
  result.rows.push_back(at_most("bodies: engine, rise of a ball over flush boxes", 1e-4, rise, "m", how));
  result.rows.push_back(at_most("bodies: engine, loss of speed of a ball over flush boxes", 1e-3, loss, "", how));
}

// ------------------------------------------------------------------------------------------------ restitution

/// A hull of 162 corners.
Hull many_corners() {
  Hull hull;
  const TriangleMesh ball = sphere_mesh(2);
  hull.points.reserve(ball.positions.size());
  for (const Vec3f& p : ball.positions) hull.points.push_back(p * 0.25f);
  return hull;
}

/// By how much the energy of a body of restitution 1 exceeds that at its start, at most in 10 s, as a share of it. It
/// counts at the tops of bounces: elsewhere velocities are those of half a substep earlier than positions.
double gained(const SolidShape& shape, const Quatf& rotation) {
  Scene scene = one_thread();
  Collider ground;
  ground.static_friction = ground.kinetic_friction = 0;
  scene.add(ground);
  Object body = frictionless(make_body({{shape}}, placed({0, 2.25f, 0}, rotation)));
  body.restitution = 1;
  scene.add(body);
  World world(scene);
  const auto energy = [&] { return world.measure().kinetic_energy() + world.measure().potential_energy(); };
  const double start = energy(), slow = standard_gravity * static_cast<double>(frame_time);
  double most = start;
  for (int i = 0; i < 600; ++i) {
    world.step(frame_time);
    if (std::abs(static_cast<double>(world.object(0).velocities()[0].y)) <= slow) most = std::max(most, energy());
  }
  return most / start - 1;
}

void bounce_energy_rows(Result& result) {
  struct Bouncing {
    std::string name;
    SolidShape shape;
    Quatf rotation{};
  };
  const std::vector<Bouncing> solids{{"a hull of 162 corners", many_corners()},
                                     {"a flat cube", Box{{0.25f, 0.25f, 0.25f}}},
                                     {"a tilted box", Box{{0.3f, 0.1f, 0.2f}}, rotation({1, 2, 3}, 35)}};
  for (const Bouncing& of : solids)
    result.rows.push_back(
        at_most("bodies: engine, energy that " + of.name + " gains by bouncing", 1e-3, gained(of.shape, of.rotation),
                "", "restitution 1, no friction, falls by 2 m; most at the tops in 10 s, as a share of the start"));
}

// ------------------------------------------------------------------------------------------------ ropes

/// A rope of `links` links of 0.05 kg, each breaking at a force, from one place to another.
Object breaking_rope(const Vec3f& from, const Vec3f& to, int links, double force) {
  Object rope;
  rope.name = "rope";
  ConstraintGroup group;
  group.type = "distance";
  rope.positions.reserve(static_cast<std::size_t>(links) + 1);
  for (int i = 0; i <= links; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(links);
    rope.positions.push_back(from + (to - from) * share);
    if (i > 0) group.particles.insert(group.particles.end(), {i - 1, i});
  }
  rope.masses.assign(rope.positions.size(), 0.05f);
  group.stiffness = Stiffness::compliance(1e-6f);
  group.break_force = static_cast<float>(force);
  rope.constraints = {group};
  return rope;
}

/// The number of constraints that break in the first frame in which some do.
int broken_at_once(const Object& object) {
  Scene scene = one_thread();
  scene.add(object);
  World world(scene);
  for (int i = 0; i < 60; ++i) {
    int broken = 0;
    for (const Torn& torn : world.step(frame_time).torn) broken += torn.lost_constraints;
    if (broken > 0) return broken;
  }
  return 0;
}

void rope_rows(Result& result) {
  Object hanging = breaking_rope({}, {0, -1, 0}, 10, 40);
  hanging.masses.back() = 5;
  hanging.pins = {{0}};
  Object bridge = make_body({{Box{{0.15f, 0.15f, 0.15f}}}}, placed({0, -0.16f, 0}));
  const int first = append(bridge, breaking_rope({-2, 0, 0}, {2, 0, 0}, 40, 300));
  bridge.pins = {{first}, {first + 40}};
  attach(bridge, {first + 20}, 0);
  result.rows.push_back(absolute("bodies: engine, links that break at once of a rope with a weight", 1,
                                 broken_at_once(hanging), 0, "", "10 links of 40 N, 5 kg"));
  result.rows.push_back(absolute("bodies: engine, links that break at once of a rope with a body in its middle", 1,
                                 broken_at_once(bridge), 0, "", "40 links of 300 N, 27 kg"));
}

}  // namespace

void impact_of_body_rows(Result& result) {
  passing_rows(result);
  flush_rows(result);
  bounce_energy_rows(result);
  rope_rows(result);
}

void overlapping_liquid_rows(Result& result) {
  constexpr float spacing = 0.05f;
  std::vector<Vec3f> places;
  places.reserve(216);
  for (int i = 0; i < 216; ++i)
    places.push_back({0.001f * static_cast<float>(i % 6), 0.001f * static_cast<float>(i / 6 % 6),
                      0.001f * static_cast<float>(i / 36)});
  Scene scene = one_thread();
  scene.gravity = {};
  scene.add(make_liquid(places, {.name = "water", .fluid = {.spacing = spacing}}));
  World world(scene);
  const auto overlaps = [&] {
    const std::vector<Channel>& channels = world.state().channels;
    return std::any_of(channels.begin(), channels.end(), [](const Channel& one) { return one.name == "overlap"; });
  };
  double fastest = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(frame_time);
    if (!overlaps()) break;
    for (const Vec3f& v : world.object(0).velocities()) fastest = std::max(fastest, static_cast<double>(length(v)));
  }
  result.rows.push_back(absolute("liquids: speed at which particles part that overlap", 0.5, fastest, 1e-3, "m/s",
                                 "216 particles of 0.05 m within 5 mm, no gravity; fastest while some overlap"));
}

}  // namespace pliant::validate
