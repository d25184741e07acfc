// Rods of equal shape are solved side by side (solver/bodies/rod_bundle.h). A rod must move to the bit as it does
// alone.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "pliant/random.h"
#include "rods/rod_support.h"
#include "solver/bodies/joint_load.h"
#include "solver/bodies/rod_bundle.h"
#include "solver/workspace.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int segments_each = 6;

/// How rods differ from one another besides length, radius, stiffness, direction and motion.
struct Variety {
  float damping = 0;       ///< of every rod
  bool some_free = false;  ///< every third rod is held nowhere
  float least_modulus = 1e6f;
  bool some_damped = false;  ///< every second rod has damping
  bool held_twice = false;   ///< rods are clamped at both ends
  bool spins = false;        ///< about the z-axis at 20 rad/s or more
};

/// Lets a rod begin to spin about its middle. `first`: its first segment.
void spin(Object& object, int first, float rate) {
  const auto segment = [&](int i) { return object.bodies[static_cast<std::size_t>(first + i)]; };
  const auto place = [&](int i) { return object.positions[static_cast<std::size_t>(segment(i).particle)]; };
  const Vec3f middle = (place(0) + place(segments_each - 1)) * 0.5f;
  for (int i = 0; i < segments_each; ++i) {
    object.velocities[static_cast<std::size_t>(segment(i).particle)] += cross(Vec3f{0, 0, rate}, place(i) - middle);
    object.frames[static_cast<std::size_t>(segment(i).frame)].angular_velocity = {0, 0, rate};
  }
}

/// The same rods as objects of their own, and as one object.
struct Rods {
  std::vector<Object> alone;
  Object together;

  explicit Rods(int count, const Variety& variety = {}) {
    Random random(7);
    together.name = "together";
    for (int i = 0; i < count; ++i) {
      const Vec3f from{0.5f * static_cast<float>(i), 0.3f, 0};
      const Vec3f to =
          from + Vec3f{random.between(0.1f, 0.2f), random.between(-0.1f, 0.1f), random.between(-0.1f, 0.1f)};
      RodMaterial material = material_of(double(random.between(variety.least_modulus, 1e8f)), 1e6, 1200);
      material.damping = variety.some_damped && i % 2 == 0 ? 0.004f : variety.damping;
      RodOptions options = clamped_rod(material, random.between(0.002f, 0.003f));
      if (variety.some_free && i % 3 == 2) options.start = {};
      if (variety.held_twice) options.end.kind = RodEnd::Kind::clamped;
      options.name = "rod " + std::to_string(i);
      options.velocity = {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
      Object one;
      one.name = options.name;
      for (Object* object : {&one, &together}) {
        const int first = add_rod(*object, line(from, to, segments_each), options);
        object->self_collision = false;
        if (!variety.spins) continue;
        object->collides = false;  // as objects of their own they could meet
        spin(*object, first, 20 + static_cast<float>(i));
      }
      alone.push_back(std::move(one));
    }
  }
};

/// Positions and orientations of all objects after so many frames.
struct Outcome {
  std::vector<Vec3f> positions;
  std::vector<Quatf> orientations;

  Outcome(Scene scene, const std::vector<Object>& objects, int frames) {
    for (const Object& object : objects) scene.add(object);
    World world(scene);
    for (int frame = 0; frame < frames; ++frame) {
      const Report report = world.step(frame_time);
      EXPECT_TRUE(report.ok()) << report.explain();
    }
    for (int o = 0; o < static_cast<int>(objects.size()); ++o) {
      const std::vector<Vec3f> x = world.object(o).positions();
      const std::vector<Quatf> q = world.object(o).orientations();
      for (const ObjectBody& body : objects[static_cast<std::size_t>(o)].bodies) {
        if (body.name.find("rod") == std::string::npos)
          continue;  // what holds rods in the world is one body of an object
        positions.push_back(x[static_cast<std::size_t>(body.particle)]);
        orientations.push_back(q[static_cast<std::size_t>(body.frame)]);
      }
    }
  }
  bool operator==(const Outcome&) const = default;
};

Scene plain_scene(int iterations = 1) {
  Scene scene;
  scene.settings.substeps = 8;
  scene.settings.iterations = iterations;
  scene.settings.threads = 1;
  return scene;
}

std::vector<int> sizes_of_bundles(const Object& object, const std::vector<int>& broken = {}) {
  const CompiledObject compiled = compile(object, {});
  ObjectJoints joints;
  set_broken(compiled, broken, joints);
  std::vector<int> sizes;
  for (const RodBundle& bundle : joints.bundles) sizes.push_back(bundle.rods);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

void expect_as_alone(const Rods& rods, const Scene& scene, int frames = 40) {
  const Outcome alone(scene, rods.alone, frames), together(scene, {rods.together}, frames);
  ASSERT_EQ(together.positions.size(), rods.alone.size() * segments_each);
  EXPECT_FALSE(sizes_of_bundles(rods.together).empty());
  EXPECT_TRUE(alone == together);
}

TEST(RodBundle, MovesRodsAsAlone) { expect_as_alone(Rods(21), plain_scene()); }

TEST(RodBundle, MovesDampedRodsAsAlone) { expect_as_alone(Rods(21, {0.004f, false, 1e6f}), plain_scene()); }

TEST(RodBundle, MovesRodsThatAreHeldNowhereAsAlone) { expect_as_alone(Rods(33, {0, true, 1e6f}), plain_scene()); }

/// They have constraints in two pools.
TEST(RodBundle, MovesRodsOfWhichSomeAreDampedAsAlone) {
  expect_as_alone(Rods(21, {0, false, 1e6f, true}), plain_scene());
}

TEST(RodBundle, MovesRodsAsAloneOnTwoThreads) {
  Scene scene = plain_scene();
  scene.settings.threads = 2;
  expect_as_alone(Rods(40), scene);
}

TEST(RodBundle, MovesRodsAsAloneInSeveralIterations) {
  expect_as_alone(Rods(20, {0.004f, false, 1e6f}), plain_scene(3));
}

/// Limp rods in few substeps turn faster than these can follow, so joints are solved with their stiffness.
TEST(RodBundle, MovesRodsThatJointsPullHardAsAlone) {
  Scene scene = plain_scene();
  scene.settings.substeps = 2;
  expect_as_alone(Rods(21, {0.004f, true, 1e4f}), scene);
}

/// Free ones are rotated as a whole after such a solve.
TEST(RodBundle, MovesRodsThatSpinFastAsAlone) {
  expect_as_alone(Rods(21, {0, true, 1e6f, false, false, true}), plain_scene());
}

/// Contact opens joints, which are then closed again.
TEST(RodBundle, MovesRodsThatFallToTheGroundAsAlone) {
  Scene scene = plain_scene();
  Collider ground;
  ground.position = {0, 0.25f, 0};
  scene.colliders.push_back(ground);
  expect_as_alone(Rods(21, {0.004f, true, 1e6f}), scene, 60);
}

TEST(RodBundle, GivesTheSameBitsAtAllLevels) {
  const Rods rods(21, {0.004f, true, 1e5f});
  Scene scene = plain_scene();
  const Outcome any(scene, {rods.together}, 40);
  for (const std::string& isa : testing_support::available_code_paths()) {
    scene.settings.isa = isa;
    EXPECT_TRUE(Outcome(scene, {rods.together}, 40) == any) << isa;
  }
}

TEST(RodBundle, HasUpToSixteenRodsAndLeavesOutFewOfAKind) {
  EXPECT_EQ(sizes_of_bundles(Rods(38).together), (std::vector<int>{6, 16, 16}));
  EXPECT_EQ(sizes_of_bundles(Rods(37).together), (std::vector<int>{16, 16}));
  EXPECT_EQ(sizes_of_bundles(Rods(5).together), std::vector<int>{});
}

/// Both ends of such a rod are held, so its joints have a little compliance (JointTree).
TEST(RodBundle, LeavesOutRodsThatAreHeldTwice) {
  EXPECT_EQ(sizes_of_bundles(Rods(16, {0, false, 1e6f, false, true}).together), std::vector<int>{});
}

TEST(RodBundle, LeavesOutARodThatBreaks) {
  const Object object = Rods(22).together;
  const auto joint = std::find_if(object.joints.begin(), object.joints.end(),
                                  [](const ObjectJoint& its) { return its.name == "rod 5 2-3"; });
  ASSERT_NE(joint, object.joints.end());
  EXPECT_EQ(sizes_of_bundles(object), (std::vector<int>{6, 16}));
  EXPECT_EQ(sizes_of_bundles(object, {static_cast<int>(joint - object.joints.begin())}), std::vector<int>{16});
}

}  // namespace
}  // namespace pliant
