// Skins that follow tetrahedra, and ties of particles to triangles and tetrahedra.
#include <algorithm>
#include <limits>

#include "pliant/body.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Some of it lies inside of the block, some outside.
TriangleMesh ball() {
  TriangleMesh mesh = sphere_mesh(3);
  for (Vec3f& p : mesh.positions) p = 0.12f * p + Vec3f{0.07f, 0, 0};
  return mesh;
}

TEST(Skin, IsTheMeshAtRest) {
  const TriangleMesh mesh = ball();
  const Object body = block();
  const Skin skin = make_skin(body, mesh);
  EXPECT_EQ(skin.triangles, mesh.triangles);
  const std::vector<Vec3f> at_rest = skinned(skin, body.positions);
  ASSERT_EQ(at_rest.size(), mesh.positions.size());
  for (std::size_t i = 0; i < at_rest.size(); ++i) EXPECT_LT(length(at_rest[i] - mesh.positions[i]), 1e-6f);
}

TEST(Skin, FollowsEveryAffineMap) {
  const TriangleMesh mesh = ball();
  const Object body = block();
  const Skin skin = make_skin(body, mesh);
  const auto mapped = [](const Vec3f& p) { return Vec3f{2 * p.x + 0.5f * p.y + 1, p.y - p.z, 0.3f * p.x + p.z - 2}; };
  std::vector<Vec3f> particles;
  for (const Vec3f& p : body.positions) particles.push_back(mapped(p));
  const std::vector<Vec3f> now = skinned(skin, particles);
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT(length(now[i] - mapped(mesh.positions[i])), 2e-6f);
}

TEST(Skin, TakesTheTetrahedronThatHoldsAVertexOrTheNearest) {
  const TriangleMesh mesh = ball();
  const Object body = block();
  const Skin skin = make_skin(body, mesh);
  const auto inside = [&](const std::array<int, 4>& t, const Vec3f& place) {  // the least weight, by volumes
    const auto at = [&](std::size_t i) { return convert<double>(body.positions[static_cast<std::size_t>(t[i])]); };
    const Vec3d p = convert<double>(place);
    const double all = six_volumes(at(0), at(1), at(2), at(3));
    return std::min({six_volumes(p, at(1), at(2), at(3)), six_volumes(at(0), p, at(2), at(3)),
                     six_volumes(at(0), at(1), p, at(3)), six_volumes(at(0), at(1), at(2), p)}) /
           all;
  };
  int outside = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    double best = -std::numeric_limits<double>::infinity();
    for (const auto& t : tetrahedra_of(body)) best = std::max(best, inside(t, mesh.positions[v]));
    const double chosen = inside(skin.vertices[v].particles, mesh.positions[v]);
    EXPECT_GE(chosen, std::min(best, 0.0) < 0 ? -1 : -1e-6) << "vertex " << v;
    outside += best < 0 ? 1 : 0;
  }
  EXPECT_GT(outside, 10);
}

TEST(Skin, RefusesWhatHasNoTetrahedraAndBadVertices) {
  EXPECT_THROW(make_skin(make_cloth(grid_mesh(3, 3, 1, 1)), ball()), Error);
  TriangleMesh bad = ball();
  bad.positions[5].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(make_skin(block(), bad), Error);
  bad = ball();
  bad.triangles[0] = {0, 1, 100000};
  EXPECT_THROW(make_skin(block(), bad), Error);
}

TEST(Ties, HoldAParticleAtItsPlaceInFlesh) {
  Object body = block();
  std::vector<int> fixed;
  for (int i = 0; i < static_cast<int>(body.positions.size()); ++i)
    if (body.positions[static_cast<std::size_t>(i)].x < -0.19f) body.pins.push_back({i, {}});
  const Vec3f place{0.13f, 0.02f, -0.03f};
  const int bead = append(body, make_rope({place, place + Vec3f{0, -0.3f, 0}}));
  body.masses[static_cast<std::size_t>(bead) + 1] = 0.1f;
  attach_inside(body, {bead});
  TriangleMesh probe;  // a skin says where the place in the flesh is
  probe.positions = {place};
  const Skin at = make_skin(body, probe);
  World world(scene_of(body, 40));
  run(world, 60);
  const std::vector<Vec3f> now = positions_of(world);
  const Vec3f there = skinned(at, now)[0];
  EXPECT_LT(length(now[static_cast<std::size_t>(bead)] - there), 2e-4f);
  EXPECT_LT(there.y, place.y - 0.002f) << "the weight pulls the flesh down";
}

TEST(Ties, HoldAParticleOnASurfaceAndKeepMomentum) {
  Object shirt = make_cloth(grid_mesh(5, 5, 1, 1));
  Object button;
  button.name = "button";
  button.positions = {{0.13f, 0, 0.21f}};
  button.masses = {0.5f};
  button.velocities = {{0, 2, 0}};
  const int at = append(shirt, button);
  attach_to_surface(shirt, {at});
  const ConstraintGroup& ties = shirt.constraints.back();
  EXPECT_EQ(ties.type, "point_on_triangle");
  Scene scene = scene_of(shirt, 20);
  scene.gravity = {};
  World world(scene);
  run(world, 30);
  const std::vector<Vec3f> now = positions_of(world), speeds = world.object(ObjectId(0)).velocities();
  Vec3d momentum{};
  for (std::size_t i = 0; i < speeds.size(); ++i)
    momentum = momentum + convert<double>(speeds[i]) * static_cast<double>(shirt.masses[i]);
  EXPECT_NEAR(momentum.y, 1, 1e-4);
  EXPECT_NEAR(momentum.x, 0, 1e-4);
  const float b = ties.rest[0], c = ties.rest[1];
  const auto corner = [&](std::size_t i) { return now[static_cast<std::size_t>(ties.particles[i])]; };
  const Vec3f place = (1 - b - c) * corner(1) + b * corner(2) + c * corner(3);
  EXPECT_LT(length(place - now[static_cast<std::size_t>(at)]), 1e-4f);
  EXPECT_GT(now[static_cast<std::size_t>(at)].y, 0.1f) << "it carries the cloth along";
}

TEST(Ties, StretchByTheirCompliance) {
  Object shirt = make_cloth(grid_mesh(3, 3, 1, 1));
  for (int i = 0; i < 9; ++i) shirt.pins.push_back({i, {}});
  Object weight;
  weight.positions = {{0.1f, 0, 0.2f}};
  weight.masses = {0.5f};
  const int at = append(shirt, weight);
  attach_to_surface(shirt, {at}, Stiffness::compliance(0.01f));
  shirt.damping = 5;
  World world(scene_of(shirt, 20));
  run(world, 240);
  EXPECT_NEAR(positions_of(world)[static_cast<std::size_t>(at)].y, -0.5 * 9.81 * 0.01, 2e-4) << "m g alpha";
}

TEST(Ties, OnTheSurfaceOfABodyFollowItsCut) {
  Object body = block();
  std::vector<int> buttons;
  for (int i = 0; i < 8; ++i) {
    Object button;
    button.positions = {{-0.19f + 0.05f * static_cast<float>(i), 0.1f, 0.03f}};
    button.masses = {0.01f};
    buttons.push_back(append(body, button));
  }
  attach_to_surface(body, buttons);
  std::vector<int> side;
  for (const auto& t : tetrahedra_of(body)) {
    float x = 0;
    for (const int corner : t) x += body.positions[static_cast<std::size_t>(corner)].x;
    side.push_back(x > 0 ? 1 : 0);
  }
  const Object after = part_tetrahedra(body, side).object;
  const ConstraintGroup& ties = after.constraints.back();
  ASSERT_EQ(ties.particles.size(), 32u);
  for (std::size_t tie = 0; tie < 8; ++tie) {
    std::array<int, 3> wanted{ties.particles[4 * tie + 1], ties.particles[4 * tie + 2], ties.particles[4 * tie + 3]};
    std::sort(wanted.begin(), wanted.end());
    EXPECT_TRUE(std::any_of(after.triangles.begin(), after.triangles.end(),
                            [&](std::array<int, 3> triangle) {
                              std::sort(triangle.begin(), triangle.end());
                              return triangle == wanted;
                            }))
        << "tie " << tie << " is of a triangle that exists";
  }
}

TEST(Ties, RefuseWhatIsNotThere) {
  Object body = block();
  EXPECT_THROW(attach_inside(body, {}), Error);
  EXPECT_THROW(attach_inside(body, {-1}), Error);
  EXPECT_THROW(attach_inside(body, {0}), Error) << "a corner of a tetrahedron itself";
  Object rope = make_rope({{0, 0, 0}, {1, 0, 0}});
  EXPECT_THROW(attach_to_surface(rope, {0}), Error);
  EXPECT_THROW(attach_inside(rope, {0}), Error);
  Object lost = block();
  Object nowhere;
  nowhere.positions = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  nowhere.masses = {1};
  const int at = append(lost, nowhere);
  EXPECT_THROW(attach_inside(lost, {at}), Error);
  EXPECT_THROW(attach_to_surface(lost, {at}), Error);
  EXPECT_THROW(skinned(make_skin(block(), ball()), {{0, 0, 0}}), Error);
}

}  // namespace
}  // namespace pliant
