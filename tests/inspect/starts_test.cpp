// Tests warnings about what starts inside of bodies and soft bodies, or of one another.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/grains.h"
#include "pliant/joint.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/soft_body.h"

namespace pliant {
namespace {

/// All findings, a line each.
std::string findings_of(const Scene& scene) {
  std::string text;
  for (const Finding& found : inspect(scene)) text += found.message + "; " + found.advice + "\n";
  return text;
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

Object crate(const std::string& name, const Vec3f& position, float half, float mass = 1) {
  BodyOptions options;
  options.position = position;
  options.mass = mass;
  Object object = make_body({{Box{{half, half, half}}}}, options);
  object.name = name;
  return object;
}

Object patch_at(float height) {
  TriangleMesh mesh = grid_mesh(5, 5, 0.1f, 0.1f);
  for (Vec3f& p : mesh.positions) p = {p.x - mesh.positions.back().x / 2, height, p.z};
  Object patch = make_cloth(mesh, {});
  patch.name = "patch";
  patch.collides = true;
  return patch;
}

Object jelly(const std::string& name, float side) {
  SoftBodyOptions options;
  options.name = name;
  return make_soft_body(box_tetrahedra({side, side, side}, {2, 2, 2}), options);
}

TEST(InspectStarts, NamesWhatIsInsideOfABody) {
  Scene scene;
  scene.add(crate("crate", {}, 0.5f));
  scene.add(patch_at(0.3f));
  scene.add(jelly("jelly", 0.1f));
  const std::string text = findings_of(scene);
  EXPECT_TRUE(has(text, "object 'patch', particle 0 and 24 more: starts inside of body 0 of 'crate'")) << text;
  EXPECT_TRUE(has(text, "object 'jelly', particle 0 and 26 more: starts inside of body 0 of 'crate'")) << text;
  EXPECT_FALSE(has(text, "inside of 'jelly'")) << text;
  scene.objects[1] = patch_at(0.51f);
  scene.objects[1].mask = 2;
  scene.objects[2].mask = 2;
  EXPECT_FALSE(has(findings_of(scene), "starts inside of")) << findings_of(scene);
}

TEST(InspectStarts, LeavesOutWhatIsPinnedThere) {
  Scene scene;
  scene.add(crate("crate", {}, 0.5f, INFINITY));
  scene.add(patch_at(0.3f));
  for (int i = 0; i < 25; ++i) scene.objects[1].pins.push_back({i, {}});
  EXPECT_FALSE(has(findings_of(scene), "starts inside of")) << findings_of(scene);
}

TEST(InspectStarts, NamesBodiesInsideOfBodies) {
  Scene scene;
  scene.add(crate("outer", {}, 0.5f));
  scene.add(crate("inner", {0.1f, 0, 0}, 0.1f));
  const std::string text = findings_of(scene);
  EXPECT_TRUE(has(text, "object 'inner', body 0: starts inside of body 0 of 'outer'; they are moved apart")) << text;
  scene.objects[1] = crate("inner", {0.6f, 0, 0}, 0.1f);
  EXPECT_FALSE(has(findings_of(scene), "starts inside of")) << findings_of(scene);
}

TEST(InspectStarts, LeavesOutBodiesThatAJointConnects) {
  Scene scene;
  scene.add(crate("two", {}, 0.5f));
  BodyOptions options;
  options.position = {0.1f, 0, 0};
  add_body(scene.objects[0], {{Box{{0.1f, 0.1f, 0.1f}}}}, options);
  EXPECT_TRUE(has(findings_of(scene), "starts inside of body 0 of 'two'")) << findings_of(scene);
  add_joint(scene.objects[0], BallJoint{.a = 0, .b = 1});
  EXPECT_FALSE(has(findings_of(scene), "starts inside of")) << findings_of(scene);
}

TEST(InspectStarts, NamesWhatIsWhollyInsideOfASoftBody) {
  Scene scene;
  scene.add(jelly("jelly", 0.4f));
  scene.add(crate("crate", {0.05f, 0.05f, 0.05f}, 0.02f));
  scene.add(jelly("core", 0.1f));
  const std::string text = findings_of(scene);
  EXPECT_TRUE(has(text, "object 'crate': starts inside of 'jelly'")) << text;
  EXPECT_TRUE(has(text, "object 'core': starts inside of 'jelly'")) << text;
  EXPECT_FALSE(has(text, "object 'jelly': starts inside of")) << text;
}

TEST(InspectStarts, NamesGrainsThatOverlap) {
  const auto text_of = [](float apart) {
    Scene scene;
    scene.add(make_grains({{0, 0, 0}, {apart, 0, 0}}, {.grains = {.radius = 0.01f}}));
    return findings_of(scene);
  };
  EXPECT_TRUE(
      has(text_of(0.017f), "particle 1: starts nearer to another grain than they touch, particle 0 of 'grains'"))
      << text_of(0.017f);
  EXPECT_FALSE(has(text_of(0.0195f), "another grain")) << text_of(0.0195f);
}

TEST(InspectStarts, SaysThatRestitutionHardlyActsOnSoftBodies) {
  Scene scene;
  scene.add(jelly("jelly", 0.1f));
  EXPECT_FALSE(has(findings_of(scene), "restitution")) << findings_of(scene);
  scene.objects[0].restitution = 0.5f;
  EXPECT_TRUE(has(findings_of(scene), "object 'jelly', restitution: hardly acts")) << findings_of(scene);
}

}  // namespace
}  // namespace pliant
