// Tests scenes as data, and their inspection: exactly what a World rejects is grave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "inspect/inspect_scene.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/scene.h"
#include "support/nonfinite.h"

namespace pliant {
namespace {

using testing_support::infinity;
using testing_support::nan;

Collider solid(const char* name, const Shape& shape, const Vec3f& position) {
  Collider collider;
  collider.name = name;
  collider.shape = shape;
  collider.position = position;
  return collider;
}

Attachment bond(int particle, const Vec3f& target) {
  Attachment attachment;
  attachment.particle = particle;
  attachment.target = target;
  return attachment;
}

/// A scene of a cloth above a ball, in which nothing is doubtful.
Scene good_scene() {
  Scene scene;
  ClothOptions options;
  options.name = "sheet";
  scene.add_cloth(grid_mesh(6, 5, 1, 0.8f), options);
  scene.add(solid("ball", Sphere{0.2f}, {0, -0.5f, 0}));
  scene.pin(0, {0, 5});
  return scene;
}

Scene balloon_scene() {
  Scene scene;
  ClothOptions options;
  options.name = "balloon";
  options.volume = Volume{};
  scene.add_cloth(sphere_mesh(2), options);
  return scene;
}

std::string text_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) text += std::string(f.grave ? "grave: " : "") + f.message + "; " + f.advice + "\n";
  return text;
}

using SceneChange = std::function<void(Scene&)>;

/// Expects that a scene with this change is rejected, that the message contains `words`, and that inspect() says the
/// same.
void expect_grave(const std::string& words, const SceneChange& change, Scene scene = good_scene()) {
  change(scene);
  const std::vector<Finding> findings = inspect(scene);
  ASSERT_FALSE(findings.empty()) << "accepted what should say: " << words;
  EXPECT_TRUE(findings.front().grave) << text_of(findings);
  EXPECT_NE(text_of(findings).find(words), std::string::npos) << text_of(findings) << "should say: " << words;
  for (const Finding& finding : findings) EXPECT_FALSE(finding.advice.empty()) << finding.message;
  EXPECT_THROW(refuse_grave(scene), Error) << words;
}

/// Expects that a scene with this change is accepted with a warning that contains `words`.
void expect_doubt(const std::string& words, const SceneChange& change, Scene scene = good_scene()) {
  change(scene);
  const std::string text = text_of(inspect(scene));
  EXPECT_NE(text.find(words), std::string::npos) << text << "should say: " << words;
  EXPECT_EQ(text.find("grave"), std::string::npos) << text;
  EXPECT_NO_THROW(refuse_grave(scene)) << words;
}

TEST(Scene, AddCountsAndPinChecks) {
  Scene scene;
  EXPECT_EQ(scene.add_cloth(grid_mesh(3, 3, 1, 1)), 0);
  EXPECT_EQ(scene.add(make_rope({{0, 0, 0}, {1, 0, 0}})), 1);
  EXPECT_EQ(scene.add(Collider{}), 0);
  scene.pin(1, {1});
  ASSERT_EQ(scene.objects[1].pins.size(), 1u);
  EXPECT_EQ(scene.objects[1].pins[0].particle, 1);
  EXPECT_THROW(scene.pin(2, {0}), Error);
  EXPECT_THROW(scene.pin(-1, {0}), Error);
  EXPECT_THROW(scene.pin(0, {0, 9}), Error);
  EXPECT_THROW(scene.pin(0, {-1}), Error);
  EXPECT_TRUE(scene.objects[0].pins.empty()) << "a refused call must leave the scene as it was";
}

TEST(InspectScene, FindsNothingInGoodScenes) {
  EXPECT_EQ(text_of(inspect(good_scene())), "");
  EXPECT_EQ(text_of(inspect(balloon_scene())), "");
  EXPECT_NO_THROW(refuse_grave(good_scene()));
  for (const Fabric& material : fabrics()) {
    ClothOptions options;
    options.material = material;
    Scene scene;
    scene.add_cloth(grid_mesh(33, 33, 1, 1), options);
    EXPECT_EQ(text_of(inspect(scene)), "") << material.name;
  }
}

TEST(InspectScene, ErrorNamesObjectAndElement) {
  Scene scene = good_scene();
  scene.objects[0].masses[7] = 0;
  scene.objects[0].masses[9] = -1;
  try {
    refuse_grave(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where().object, "sheet");
    EXPECT_EQ(error.where().element, "particle 7 and 1 more");
    EXPECT_FALSE(error.advice().empty());
  }
}

TEST(InspectScene, GraveSettings) {
  for (int bad : {-1, 10001}) expect_grave("substeps", [&](Scene& s) { s.settings.substeps = bad; });
  for (int bad : {0, -1, 10001}) {
    expect_grave("iterations", [&](Scene& s) { s.settings.iterations = bad; });
  }
  expect_grave("threads", [](Scene& s) { s.settings.threads = -1; });
  expect_grave("frames", [](Scene& s) { s.frames = -1; });
  for (float bad : {0.f, -1.f, nan, infinity, 1e-12f})
    expect_grave("frame_time", [&](Scene& s) { s.frame_time = bad; });
  expect_grave("isa", [](Scene& s) { s.settings.isa = "pentium"; });
  expect_grave("gravity", [](Scene& s) { s.gravity.y = nan; });
  expect_grave("wind, velocity", [](Scene& s) { s.wind.velocity.x = infinity; });
  expect_grave("gust", [](Scene& s) { s.wind.gust = 1.5f; });
  expect_grave("gust_period", [](Scene& s) { s.wind.gust = 0.5f, s.wind.gust_period = 0; });
  expect_grave("air_density", [](Scene& s) { s.wind.air_density = -1; });
  expect_grave("force 0", [](Scene& s) { s.forces.emplace_back(); });
}

TEST(InspectScene, GraveParticles) {
  expect_grave("no particles", [](Scene& s) { s.add(Object{}); });
  for (float bad : {nan, infinity, 1e20f}) {
    expect_grave("particle 3", [&](Scene& s) { s.objects[0].positions[3].z = bad; });
    expect_grave("particle 3", [&](Scene& s) {
      s.objects[0].velocities.assign(30, {});
      s.objects[0].velocities[3].z = bad;
    });
  }
  expect_grave("velocities", [](Scene& s) { s.objects[0].velocities.resize(5); });
  expect_grave("masses", [](Scene& s) { s.objects[0].masses.pop_back(); });
  for (float bad : {0.f, -1.f, nan, 1e-30f, 1e30f})
    expect_grave("particle 3", [&](Scene& s) { s.objects[0].masses[3] = bad; });
  for (float bad : {-1.f, nan, infinity}) {
    expect_grave("thickness", [&](Scene& s) { s.objects[0].thickness = bad; });
    expect_grave("drag", [&](Scene& s) { s.objects[0].drag = bad; });
    expect_grave("lift", [&](Scene& s) { s.objects[0].lift = bad; });
    expect_grave("damping", [&](Scene& s) { s.objects[0].damping = bad; });
    expect_grave("restitution", [&](Scene& s) { s.objects[0].restitution = bad; });
    expect_grave("static_friction", [&](Scene& s) { s.objects[0].static_friction = bad; });
    expect_grave("kinetic_friction", [&](Scene& s) { s.objects[0].kinetic_friction = bad; });
  }
  expect_grave("kinetic_friction", [](Scene& s) { s.objects[0].kinetic_friction = 0.9f; });
  expect_grave("colour", [](Scene& s) { s.objects[0].colour.x = nan; });
}

ConstraintGroup& stretch(Scene& scene) { return scene.objects[0].constraints[0]; }

TEST(InspectScene, GraveConstraints) {
  expect_grave("there is no type 'glue'", [](Scene& s) { stretch(s).type = "glue"; });
  expect_grave("do not divide", [](Scene& s) { stretch(s).particles.pop_back(); });
  expect_grave("distance constraint 2", [](Scene& s) { stretch(s).particles[4] = 30; });
  expect_grave("distance constraint 2", [](Scene& s) { stretch(s).particles[5] = -1; });
  expect_grave("twice", [](Scene& s) { stretch(s).particles[4] = stretch(s).particles[5]; });
  expect_grave("rest", [](Scene& s) { stretch(s).rest.pop_back(); });
  for (float bad : {-1.f, nan, infinity}) expect_grave("rest", [&](Scene& s) { stretch(s).rest[1] = bad; });
  expect_grave("compliances", [](Scene& s) { stretch(s).compliances.pop_back(); });
  expect_grave("compliances", [](Scene& s) { stretch(s).stiffness = Stiffness::pbd(1); });
  for (float bad : {-1.f, nan, infinity}) {
    expect_grave("distance constraint 1", [&](Scene& s) { stretch(s).compliances[1] = bad; });
    expect_grave("compliance", [&](Scene& s) { stretch(s).stiffness.value = bad; });
    expect_grave("damping", [&](Scene& s) { stretch(s).stiffness.damping = bad; });
    expect_grave("stiffness k", [&](Scene& s) { stretch(s).stiffness = Stiffness::pbd(bad); });
  }
  expect_grave("PBD", [](Scene& s) {
    stretch(s).compliances.clear();
    stretch(s).stiffness = {Stiffness::Kind::pbd, 0.5f, 1};
  });
}

TEST(InspectScene, GraveSurfacesAndVolumes) {
  expect_grave("triangle 2", [](Scene& s) { s.objects[0].triangles[2][1] = 99; });
  expect_grave("triangle 2", [](Scene& s) { s.objects[0].triangles[2][1] = s.objects[0].triangles[2][0]; });
  expect_grave("edge 0-1", [](Scene& s) { s.objects[0].volume = Volume{}; });
  expect_grave("needs triangles", [](Scene& s) {
    s.objects[0].volume = Volume{};
    s.objects[0].triangles.clear();
  });
  const auto turn = [](Scene& s) { std::swap(s.objects[0].triangles[4][0], s.objects[0].triangles[4][1]); };
  expect_grave("opposite winding", turn, balloon_scene());
  const auto flatten = [](Scene& s) {
    for (Vec3f& p : s.objects[0].positions) p.y = 0;
  };
  expect_grave("is 0 at rest", flatten, balloon_scene());
  for (float bad : {-1.f, nan, infinity}) {
    expect_grave(
        "pressure", [&](Scene& s) { s.objects[0].volume->pressure = bad; }, balloon_scene());
    expect_grave(
        "volume, compliance", [&](Scene& s) { s.objects[0].volume->stiffness.value = bad; }, balloon_scene());
  }
}

TEST(InspectScene, GraveControl) {
  expect_grave("pin 1", [](Scene& s) { s.objects[0].pins[1].particle = 30; });
  expect_grave("attachment 0", [](Scene& s) { s.objects[0].attachments.push_back(bond(-1, {})); });
  expect_grave("attachment 0, target", [](Scene& s) { s.objects[0].attachments.push_back(bond(1, {nan, 0, 0})); });
  expect_grave("attachment 0, stiffness k", [](Scene& s) {
    s.objects[0].attachments.push_back({1, {}, {}, Stiffness::pbd(2)});
  });
  const auto keyframes = [](std::vector<Keyframe> given) {
    return [=](Scene& s) { s.objects[0].pins[0].motion.keyframes = given; };
  };
  expect_grave("keyframe 1", keyframes({{1}, {1}}));
  expect_grave("keyframe 1", keyframes({{1}, {0.5f}}));
  expect_grave("keyframe 0, time", keyframes({{nan}}));
  expect_grave("keyframe 0, position", keyframes({{0, {0, infinity, 0}}}));
  expect_grave("keyframe 0, rotation", keyframes({{0, {}, {0, 0, 0, 2}}}));
  expect_grave("keyframe 0, rotation", keyframes({{0, {}, {0, 0, 0, nan}}}));
  expect_grave("pivot", [](Scene& s) { s.objects[0].pins[0].motion.pivot.x = nan; });
}

TEST(InspectScene, GraveColliders) {
  for (float bad : {0.f, -1.f, nan, infinity}) {
    expect_grave("'ball', radius", [&](Scene& s) { s.colliders[0].shape = Sphere{bad}; });
    expect_grave("'ball', radius", [&](Scene& s) { s.colliders[0].shape = Capsule{bad, 1}; });
    expect_grave("half_extents, y", [&](Scene& s) { s.colliders[0].shape = Box{{1, bad, 1}}; });
  }
  expect_grave("half_length", [](Scene& s) { s.colliders[0].shape = Capsule{1, -1}; });
  expect_grave("position", [](Scene& s) { s.colliders[0].position.x = nan; });
  expect_grave("rotation", [](Scene& s) { s.colliders[0].rotation = {1, 1, 1, 1}; });
  expect_grave("thickness", [](Scene& s) { s.colliders[0].thickness = -1; });
  expect_grave("kinetic_friction", [](Scene& s) { s.colliders[0].kinetic_friction = 2; });
  expect_grave("motion, keyframe 0", [](Scene& s) { s.colliders[0].motion.keyframes = {{nan}}; });
}

TEST(InspectScene, DoubtfulSettings) {
  expect_doubt("no objects", [](Scene& s) { s.objects.clear(); });
  expect_doubt("gravity", [](Scene& s) { s.gravity.y = -9810; });
  for (float odd : {1.f, 1e-5f}) expect_doubt("frame_time", [&](Scene& s) { s.frame_time = odd; });
  expect_doubt("substeps of", [](Scene& s) { s.frame_time = 0.001f, s.settings.substeps = 10000; });
  expect_doubt("rubber", [](Scene& s) { s.settings.substeps = 2, s.settings.sweep = Sweep::tiled; });
  expect_doubt("converge far better", [](Scene& s) { s.settings.substeps = 1, s.settings.iterations = 40; });
  expect_doubt("are called 'sheet'", [](Scene& s) { s.add(s.objects[0]); });
  expect_doubt("have no name", [](Scene& s) { s.objects[0].name.clear(); });
  expect_doubt("no effect from wind", [](Scene& s) { s.wind.velocity = {3, 0, 0}; });
}

TEST(InspectScene, DoubtfulParticles) {
  expect_doubt("as heavy as", [](Scene& s) { s.objects[0].masses[7] = 1000; });
  expect_doubt("only moves with its pins", [](Scene& s) {
    for (int i = 0; i < 30; ++i) s.objects[0].pins.push_back({i, {}});
  });
  expect_doubt("pinned more than once", [](Scene& s) { s.pin(0, {5}); });
  expect_doubt("particle 30: is in no", [](Scene& s) {
    s.objects[0].positions.push_back({5, 0, 0}), s.objects[0].masses.push_back(1);
  });
  expect_doubt("10 km", [](Scene& s) {
    for (Vec3f& p : s.objects[0].positions) p.x += 1e5f;
  });
  expect_doubt("faster than sound", [](Scene& s) { s.objects[0].velocities.assign(30, {0, 500, 0}); });
}

TEST(InspectScene, DoubtfulConstraintsAndSurfaces) {
  expect_doubt("shortest edge", [](Scene& s) { s.objects[0].thickness = 1; });
  expect_doubt("so compliant",
               [](Scene& s) { std::fill(stretch(s).compliances.begin(), stretch(s).compliances.end(), 1e6f); });
  expect_doubt("differs from its rest length by more than half", [](Scene& s) { stretch(s).rest[3] *= 3; });
  const auto isometric = [](Scene& s) { s.objects[0].constraints[1].type = "isometric_bending"; };
  expect_doubt("will flatten", isometric, balloon_scene());
  expect_doubt("degenerate triangle", [](Scene& s) {
    ConstraintGroup& bending = s.objects[0].constraints[1];
    const int* v = bending.particles.data();
    s.objects[0].positions[static_cast<std::size_t>(v[2])] = s.objects[0].positions[static_cast<std::size_t>(v[0])];
  });
  expect_doubt("opposite winding",
               [](Scene& s) { std::swap(s.objects[0].triangles[3][0], s.objects[0].triangles[3][1]); });
  expect_doubt("not a manifold", [](Scene& s) { s.objects[0].triangles.push_back({0, 7, 20}); });
  const auto inside_out = [](Scene& s) {
    for (auto& t : s.objects[0].triangles) std::swap(t[0], t[1]);
  };
  expect_doubt("inside out", inside_out, balloon_scene());
  const auto inflate = [](Scene& s) {
    s.objects[0].volume->pressure = 1.4f;
    stretch(s).compliances.assign(stretch(s).compliances.size(), 0);
  };
  expect_doubt("edges must become 11.9 % longer", inflate, balloon_scene());
  Scene within_bounds = balloon_scene();
  inflate(within_bounds);
  within_bounds.objects[0].volume->pressure = 1.06f;  // 2.0 % longer
  EXPECT_EQ(text_of(inspect(within_bounds)), "");
}

TEST(InspectScene, DoubtfulOverlaps) {
  expect_doubt("inside of collider 'ball'", [](Scene& s) { s.colliders[0].position.y = 0; });
  expect_doubt("inside of collider 'ball'", [](Scene& s) {  // at time 0 only its motion takes it there
    s.colliders[0].motion.keyframes = {{0, {0, 0.5f, 0}}, {1}};
  });
  expect_doubt("inside of collider 'ground'", [](Scene& s) { s.add(solid("ground", Plane{}, {0, 0.1f, 0})); });
}

}  // namespace
}  // namespace pliant
