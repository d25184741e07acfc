// Makes every number of a scene bad in every way, one at a time. A World must reject the scene with an Error that
// says where, or run and stay finite. tests/world/scene_test.cpp tests which values are rejected, and with which
// words.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "pliant/error.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// A scene with everything that a scene can contain.
Scene full_scene() {
  Scene scene;
  scene.settings.substeps = 3;
  scene.settings.iterations = 2;
  scene.settings.threads = 1;
  scene.settings.measure = true;
  scene.wind = {{1, 0, 0}, 0.5f, 1, 1.2f};
  ClothOptions options;
  options.name = "balloon";
  options.volume = Volume{1.2f, Stiffness::compliance(1e-6f, 0.1f)};
  Object balloon = make_cloth(sphere_mesh(1), options);
  balloon.velocities.assign(balloon.positions.size(), Vec3f{0, 0.1f, 0});
  balloon.pins.push_back({3, {{Keyframe{0, {}, {}}, Keyframe{0.1f, {0.1f, 0, 0}, {}}}, {}, true}});
  balloon.attachments.push_back({7, {0, 2, 0}, {}, Stiffness::compliance(1e-3f, 1)});
  balloon.constraints.push_back({"distance", {0, 5, 1, 6}, {0.5f, 0.5f}, Stiffness::compliance(0.1f), {0.1f, 0.2f}});
  balloon.constraints.push_back({"isometric_bending", {0, 1, 2, 3}, {}, Stiffness::pbd(0.5f), {}});
  scene.add(balloon);
  for (const Shape& shape : {Shape{Plane{}}, Shape{Sphere{}}, Shape{Capsule{}}, Shape{Box{}}}) {
    Collider collider;
    collider.shape = shape;
    collider.position = {0, -1.5f, 0};
    collider.motion.keyframes = {Keyframe{0, {}, {}}, Keyframe{1, {0.1f, 0, 0}, {}}};
    scene.add(collider);
  }
  return scene;
}

struct NamedFloat {
  std::string name;
  std::function<float&(Scene&)> of;
};

void add_vector(std::vector<NamedFloat>& all, const std::string& name, const std::function<Vec3f&(Scene&)>& of) {
  all.push_back({name + ".x", [of](Scene& s) -> float& { return of(s).x; }});
  all.push_back({name + ".z", [of](Scene& s) -> float& { return of(s).z; }});
}

std::vector<NamedFloat> every_float() {
  std::vector<NamedFloat> all;
#define PLIANT_FLOAT(member) all.push_back({#member, [](Scene& s) -> float& { return s.member; }})
#define PLIANT_VECTOR(member) add_vector(all, #member, [](Scene& s) -> Vec3f& { return s.member; })
  PLIANT_VECTOR(gravity);
  PLIANT_VECTOR(wind.velocity);
  PLIANT_FLOAT(wind.gust);
  PLIANT_FLOAT(wind.gust_period);
  PLIANT_FLOAT(wind.air_density);
  PLIANT_FLOAT(frame_time);
  PLIANT_VECTOR(objects[0].positions[4]);
  PLIANT_VECTOR(objects[0].velocities[4]);
  PLIANT_FLOAT(objects[0].masses[4]);
  PLIANT_FLOAT(objects[0].thickness);
  PLIANT_FLOAT(objects[0].static_friction);
  PLIANT_FLOAT(objects[0].kinetic_friction);
  PLIANT_FLOAT(objects[0].restitution);
  PLIANT_FLOAT(objects[0].drag);
  PLIANT_FLOAT(objects[0].lift);
  PLIANT_FLOAT(objects[0].damping);
  PLIANT_VECTOR(objects[0].colour);
  PLIANT_FLOAT(objects[0].volume->pressure);
  PLIANT_FLOAT(objects[0].volume->leak);
  PLIANT_FLOAT(objects[0].volume->stiffness.value);
  PLIANT_FLOAT(objects[0].volume->stiffness.damping);
  PLIANT_FLOAT(objects[0].pins[0].motion.keyframes[1].time);
  PLIANT_VECTOR(objects[0].pins[0].motion.keyframes[1].position);
  PLIANT_FLOAT(objects[0].pins[0].motion.keyframes[1].rotation.y);
  PLIANT_VECTOR(objects[0].pins[0].motion.pivot);
  PLIANT_VECTOR(objects[0].attachments[0].target);
  PLIANT_FLOAT(objects[0].attachments[0].stiffness.value);
  PLIANT_FLOAT(objects[0].attachments[0].stiffness.damping);
  PLIANT_FLOAT(objects[0].constraints[0].stiffness.value);
  PLIANT_FLOAT(objects[0].constraints[2].rest[1]);
  PLIANT_FLOAT(objects[0].constraints[2].compliances[1]);
  PLIANT_FLOAT(objects[0].constraints[3].stiffness.value);
  PLIANT_FLOAT(objects[0].constraints[3].stiffness.damping);
  for (std::size_t i = 0; i < 4; ++i) {
    add_vector(all, "collider position", [i](Scene& s) -> Vec3f& { return s.colliders[i].position; });
    all.push_back({"collider rotation", [i](Scene& s) -> float& { return s.colliders[i].rotation.w; }});
  }
  PLIANT_FLOAT(colliders[1].thickness);
  PLIANT_FLOAT(colliders[1].static_friction);
  PLIANT_FLOAT(colliders[1].kinetic_friction);
  PLIANT_FLOAT(colliders[1].restitution);
  PLIANT_FLOAT(colliders[1].motion.keyframes[1].time);
  PLIANT_VECTOR(colliders[1].motion.keyframes[1].position);
#undef PLIANT_FLOAT
#undef PLIANT_VECTOR
  all.push_back({"sphere radius", [](Scene& s) -> float& { return std::get<Sphere>(s.colliders[1].shape).radius; }});
  all.push_back({"capsule radius", [](Scene& s) -> float& { return std::get<Capsule>(s.colliders[2].shape).radius; }});
  all.push_back(
      {"capsule length", [](Scene& s) -> float& { return std::get<Capsule>(s.colliders[2].shape).half_length; }});
  add_vector(all, "box", [](Scene& s) -> Vec3f& { return std::get<Box>(s.colliders[3].shape).half_extents; });
  return all;
}

struct NamedInt {
  std::string name;
  std::function<int&(Scene&)> of;
};

std::vector<NamedInt> every_int() {
  std::vector<NamedInt> all;
#define PLIANT_INT(member) all.push_back({#member, [](Scene& s) -> int& { return s.member; }})
  PLIANT_INT(settings.substeps);
  PLIANT_INT(settings.iterations);
  PLIANT_INT(settings.threads);
  PLIANT_INT(frames);
  PLIANT_INT(objects[0].constraints[0].particles[3]);
  PLIANT_INT(objects[0].constraints[1].particles[3]);
  PLIANT_INT(objects[0].triangles[5][1]);
  PLIANT_INT(objects[0].pins[0].particle);
  PLIANT_INT(objects[0].attachments[0].particle);
#undef PLIANT_INT
  return all;
}

bool is_finite(const State& state) {
  for (const auto* records : {&state.positions, &state.remainders, &state.velocities}) {
    for (const Record& r : *records) {
      if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z)) return false;
    }
  }
  return true;
}

enum class Outcome { refused, ran, stopped };

/// Makes a World and steps it. The result must be an Error with a text, or a finite State.
Outcome try_out(const Scene& scene) {
  try {
    World world(scene);
    for (int frame = 0; frame < 4; ++frame) {
      const Report report = world.step(scene.frame_time);
      EXPECT_TRUE(is_finite(world.state()));
      if (report.ok()) continue;
      EXPECT_FALSE(report.nonfinite->element.empty());
      return Outcome::stopped;
    }
    return Outcome::ran;
  } catch (const Error& error) {
    EXPECT_GT(std::string(error.what()).size(), 10u);
    EXPECT_FALSE(error.problem().empty());
  }
  return Outcome::refused;
}

TEST(Misuse, TheSceneItselfRuns) { EXPECT_EQ(try_out(full_scene()), Outcome::ran); }

TEST(Misuse, NoNumberThatIsNotANumberGetsIn) {
  for (const NamedFloat& number : every_float()) {
    Scene scene = full_scene();
    number.of(scene) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(try_out(scene), Outcome::refused) << number.name;
  }
}

TEST(Misuse, NoBadNumberBreaksAnything) {
  int refused = 0, tried = 0;
  for (const NamedFloat& number : every_float()) {
    for (float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), -1.f, 0.f, -0.f,
                      1e-45f, 1e-30f, 1e8f, 1e30f, -1e30f, 3.4e38f}) {
      SCOPED_TRACE(number.name + " = " + std::to_string(bad));
      Scene scene = full_scene();
      number.of(scene) = bad;
      const Outcome outcome = try_out(scene);
      refused += outcome == Outcome::refused ? 1 : 0;
      // A World can simulate what it accepts. Only a mass or position at the very end of the allowed range may stop it.
      EXPECT_TRUE(outcome != Outcome::stopped || std::fabs(bad) >= 1e8f);
      ++tried;
    }
  }
  EXPECT_GT(refused, tried / 3);
}

TEST(Misuse, NoBadIndexOrCountBreaksAnything) {
  for (const NamedInt& number : every_int()) {
    for (int bad : {-1, std::numeric_limits<int>::min(), std::numeric_limits<int>::max(), 42, 1000000}) {
      if (number.name == "frames" && bad > 0) continue;
      SCOPED_TRACE(number.name + " = " + std::to_string(bad));
      Scene scene = full_scene();
      number.of(scene) = bad;
      const bool may_run = bad == 42 && number.name.find("settings") == 0;
      EXPECT_EQ(try_out(scene), may_run ? Outcome::ran : Outcome::refused);
    }
  }
}

TEST(Misuse, ListsOfTheWrongLengthAreRefused) {
  const std::function<void(Object&)> spoil[] = {
      [](Object& o) { o.masses.pop_back(); },
      [](Object& o) { o.masses.clear(); },
      [](Object& o) { o.velocities.pop_back(); },
      [](Object& o) { o.positions.pop_back(); },
      [](Object& o) { o.positions.clear(); },
      [](Object& o) { o.constraints[0].particles.pop_back(); },
      [](Object& o) { o.constraints[2].rest.pop_back(); },
      [](Object& o) { o.constraints[2].compliances.push_back(1); },
      [](Object& o) { o.constraints[0].type = ""; },
      [](Object& o) { o.constraints[0].type = "dihedral_bending"; },
      [](Object& o) { o.constraints[1].particles[1] = o.constraints[1].particles[0]; },
      [](Object& o) { o.triangles.pop_back(); },
      [](Object& o) { o.triangles.clear(); },
      [](Object& o) { o.triangles[2][0] = o.triangles[2][1]; },
  };
  for (const auto& change : spoil) {
    Scene scene = full_scene();
    change(scene.objects[0]);
    EXPECT_EQ(try_out(scene), Outcome::refused) << &change - spoil;
  }
}

TEST(Misuse, EmptyGroupsAreNoMisuse) {
  Scene scene = full_scene();
  for (const ConstraintType& type : constraint_types())
    scene.objects[0].constraints.push_back({type.name, {}, {}, Stiffness::compliance(1, 1), {}});
  EXPECT_EQ(try_out(scene), Outcome::ran);
  scene.objects[0].constraints.clear();
  scene.objects[0].constraints.push_back({"distance", {}, {}, {}, {}});
  scene.objects[0].attachments.clear();
  EXPECT_EQ(try_out(scene), Outcome::ran);
}

TEST(Misuse, EmptyFunctionsAndUnknownPathsAreRefused) {
  Scene scene = full_scene();
  scene.forces.emplace_back();
  EXPECT_EQ(try_out(scene), Outcome::refused);
  scene = full_scene();
  scene.settings.isa = "pentium";
  EXPECT_EQ(try_out(scene), Outcome::refused);
  EXPECT_THROW(scene.pin(5, {0}), Error);
  EXPECT_THROW(scene.pin(-1, {0}), Error);
  EXPECT_THROW(scene.pin(0, {1000000}), Error);
  EXPECT_THROW(scene.pin(0, {-1}), Error);
}

TEST(Misuse, AForceThatThrowsLeavesTheWorldUsable) {
  bool throws = false;
  Scene scene = full_scene();
  scene.forces.push_back([&throws](const Vec3f&, const Vec3f&, float, float) {
    if (throws) throw std::runtime_error("no force today");
    return Vec3f{};
  });
  World world(scene);
  world.step(0.01f);
  const State before = world.state();
  throws = true;
  EXPECT_THROW(world.step(0.01f), std::runtime_error);
  throws = false;
  world.restore(before);
  EXPECT_TRUE(world.step(0.01f).ok());
}

}  // namespace
}  // namespace pliant
