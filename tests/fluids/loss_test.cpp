// No particle of a liquid is lost: through walls that are hit, through thin walls, or to values that are not finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "pliant/body.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float frame = 1.f / 60;

/// PLIANT_LOSS_SECONDS makes runs longer than tests have time for.
float seconds(float usual) {
  const char* given = std::getenv("PLIANT_LOSS_SECONDS");
  return given != nullptr ? std::strtof(given, nullptr) : usual;
}

struct Losses {
  int outside = 0;     ///< most particles that were outside after a frame
  double fastest = 0;  ///< speed of any particle after any frame [m/s]
  bool is_finite = true;
};

/// Runs a scene, and looks after each frame for particles of object 0 that are not where they should be.
Losses run(World& world, float time, const std::function<bool(const Vec3f&, double time)>& is_inside,
           const Vec3f& velocity = {}) {
  Losses losses;
  for (int i = 0; i < static_cast<int>(std::lround(time / frame)); ++i) {
    const Report report = world.step(frame);
    losses.is_finite = losses.is_finite && !report.nonfinite;
    if (!losses.is_finite) return losses;
    int outside = 0;
    for (const Vec3f& p : world.object(0).present_positions()) outside += is_inside(p, world.state().time) ? 0 : 1;
    losses.outside = std::max(losses.outside, outside);
    for (const Vec3f& v : world.object(0).velocities())
      losses.fastest = std::max(losses.fastest, std::sqrt(static_cast<double>(length_squared(v - velocity))));
  }
  return losses;
}

void report(const char* what, const Losses& losses) {
  testing::Test::RecordProperty(std::string(what) + "_fastest_mm_s", static_cast<int>(1000 * losses.fastest));
  if (std::getenv("PLIANT_LOSS_SECONDS") != nullptr)
    std::printf("%s: %d outside, fastest %.2f m/s\n", what, losses.outside, losses.fastest);
}

// ------------------------------------------------------------------------------------------------ a tank that is hit

constexpr Vec3f tank_half{0.4f, 0.3f, 0.3f};

/// Stands for a third of a second, then moves by 0.8 m at 8 m/s, and stops.
Motion hit(const Vec3f& direction) {
  Motion motion;
  motion.keyframes = {{0, {}, {}}, {1.f / 3, {}, {}}, {1.f / 3 + 0.1f, direction * 0.8f, {}}};
  return motion;
}

Vec3f place_at(const Motion& motion, double time) {
  const auto& keys = motion.keyframes;
  const auto share = static_cast<float>(std::clamp((time - keys[1].time) / (keys[2].time - keys[1].time), 0.0, 1.0));
  return keys[2].position * share;
}

/// Six boxes around the inside of the tank.
void add_plates(Scene& scene, float thickness, const Motion& motion) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      Box box{tank_half + Vec3f{thickness, thickness, thickness}};
      Vec3f place{};
      float* half[] = {&box.half_extents.x, &box.half_extents.y, &box.half_extents.z};
      float* at[] = {&place.x, &place.y, &place.z};
      const float inner[] = {tank_half.x, tank_half.y, tank_half.z};
      *half[axis] = thickness / 2;
      *at[axis] = side * (inner[axis] + thickness / 2);
      Collider plate;
      plate.shape = box;
      plate.position = place;
      plate.motion = motion;
      scene.add(plate);
    }
}

/// Adds a box as triangles; inward if `is_hollow`.
void append_box(TriangleMesh& mesh, const Vec3f& low, const Vec3f& high, bool is_hollow) {
  const int first = static_cast<int>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
  const int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : faces) {
    if (is_hollow)
      mesh.triangles.push_back({first + f[0], first + f[2], first + f[1]});
    else
      mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
  }
}

MeshCollider tank_mesh(float thickness, const Motion& motion, MeshCollider::As as) {
  MeshCollider tank;
  tank.as = as;
  tank.grid_spacing = thickness / 2;
  tank.motion = motion;
  append_box(tank.mesh, tank_half * -1.f, tank_half, true);
  if (thickness > 0) {
    const Vec3f outer = tank_half + Vec3f{thickness, thickness, thickness};
    append_box(tank.mesh, outer * -1.f, outer, false);
  }
  return tank;
}

Scene filled(float spacing) {
  Scene scene;
  const Vec3f high{tank_half.x, 0.2f, tank_half.z};
  scene.add(make_liquid(fill_box(tank_half * -1.f, high, spacing), {.fluid = {.spacing = spacing}}));
  scene.settings.threads = 1;
  return scene;
}

struct HitTank {
  const char* name;
  std::function<void(Scene&, const Motion&)> add;
};

void PrintTo(const HitTank& tank, std::ostream* out) { *out << tank.name; }

class HitTanks : public testing::TestWithParam<HitTank> {};

TEST_P(HitTanks, LoseNothing) {
  for (const Vec3f& direction : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0.577f, 0.577f, 0.577f}}) {
    const Motion motion = hit(direction);
    Scene scene = filled(0.05f);
    GetParam().add(scene, motion);
    World world(scene);
    const auto is_inside = [&](const Vec3f& p, double time) {
      const Vec3f local = p - place_at(motion, time);
      return std::abs(local.x) < tank_half.x && std::abs(local.y) < tank_half.y && std::abs(local.z) < tank_half.z;
    };
    const Losses at_rest = run(world, 20 * frame, is_inside);
    const Losses moving = run(world, 6 * frame, is_inside, direction * 8.f);
    const Losses stopped = run(world, seconds(1), is_inside);
    report(GetParam().name, moving);
    report(GetParam().name, stopped);
    EXPECT_TRUE(at_rest.is_finite && moving.is_finite && stopped.is_finite);
    EXPECT_EQ(at_rest.outside + moving.outside + stopped.outside, 0);
  }
}

const HitTank hit_tanks[] = {
    {"plates_20_mm", [](Scene& scene, const Motion& motion) { add_plates(scene, 0.02f, motion); }},
    {"plates_1_mm", [](Scene& scene, const Motion& motion) { add_plates(scene, 0.001f, motion); }},
    {"mesh", [](Scene& scene, const Motion& motion) { scene.add(tank_mesh(0, motion, MeshCollider::As::triangles)); }},
    {"mesh_of_two_skins",
     [](Scene& scene, const Motion& motion) { scene.add(tank_mesh(0.001f, motion, MeshCollider::As::triangles)); }},
    {"grid_20_mm",
     [](Scene& scene, const Motion& motion) { scene.add(tank_mesh(0.02f, motion, MeshCollider::As::distance_grid)); }},
};

INSTANTIATE_TEST_SUITE_P(Liquids, HitTanks, testing::ValuesIn(hit_tanks),
                         [](const auto& given) { return given.param.name; });

// ------------------------------------------------------------------------------------------------ vessels with thin walls

/// A surface of revolution about y: radii and heights of its profile.
TriangleMesh turned(const std::vector<std::array<float, 2>>& profile, int segments, bool is_closed) {
  TriangleMesh mesh;
  const int rows = static_cast<int>(profile.size());
  for (const auto& [radius, height] : profile)
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      mesh.positions.push_back(
          {radius * static_cast<float>(std::cos(angle)), height, radius * static_cast<float>(std::sin(angle))});
    }
  const auto at = [&](int row, int i) { return row % rows * segments + i % segments; };
  for (int row = 0; row + (is_closed ? 0 : 1) < rows; ++row)
    for (int i = 0; i < segments; ++i) {
      mesh.triangles.push_back({at(row, i), at(row + 1, i), at(row, i + 1)});
      mesh.triangles.push_back({at(row, i + 1), at(row + 1, i), at(row + 1, i + 1)});
    }
  return mesh;
}

/// Closes a turned surface whose first or last row is a small circle.
void add_disc(TriangleMesh& mesh, int first, int segments, bool is_flipped) {
  Vec3f middle{};
  for (int i = 0; i < segments; ++i)
    middle += mesh.positions[static_cast<std::size_t>(first + i)] * (1 / static_cast<float>(segments));
  const int centre = static_cast<int>(mesh.positions.size());
  mesh.positions.push_back(middle);
  for (int i = 0; i < segments; ++i) {
    const int a = first + i, b = first + (i + 1) % segments;
    if (is_flipped)
      mesh.triangles.push_back({centre, b, a});
    else
      mesh.triangles.push_back({centre, a, b});
  }
}

constexpr float cup_radius = 0.04f, cup_height = 0.1f;

/// A cup of one skin, or with walls of a thickness.
MeshCollider cup(float thickness, MeshCollider::As as, float grid_spacing) {
  constexpr int segments = 48;
  MeshCollider cup;
  cup.as = as;
  cup.grid_spacing = grid_spacing;
  if (thickness == 0) {
    cup.mesh = turned({{cup_radius, 0}, {cup_radius, cup_height}}, segments, false);
    add_disc(cup.mesh, 0, segments, false);
    return cup;
  }
  const float outer = cup_radius + thickness;
  cup.mesh =
      turned({{outer, -thickness}, {outer, cup_height}, {cup_radius, cup_height}, {cup_radius, 0}}, segments, false);
  add_disc(cup.mesh, 0, segments, false);
  add_disc(cup.mesh, 3 * segments, segments, true);
  return cup;
}

struct Cup {
  const char* name;
  MeshCollider collider;
};

void PrintTo(const Cup& cup, std::ostream* out) { *out << cup.name; }

class Cups : public testing::TestWithParam<Cup> {};

TEST_P(Cups, HoldWhatIsFilledIn) {
  constexpr float spacing = 0.006f;
  Scene scene;
  std::vector<Vec3f> places = fill_box({-cup_radius, 0, -cup_radius}, {cup_radius, 0.08f, cup_radius}, spacing);
  std::erase_if(places, [](const Vec3f& p) { return std::hypot(p.x, p.z) > cup_radius - spacing / 2; });
  scene.add(make_liquid(places, {.fluid = {.spacing = spacing}}));
  scene.add(GetParam().collider);
  scene.settings.threads = 1;
  World world(scene);
  const Losses losses = run(world, seconds(1.f), [](const Vec3f& p, double) {
    return p.y > 0 && (p.y > cup_height || std::hypot(p.x, p.z) < cup_radius);
  });
  report(GetParam().name, losses);
  EXPECT_TRUE(losses.is_finite);
  EXPECT_EQ(losses.outside, 0);
  EXPECT_LT(losses.fastest, 1) << "water at rest";
}

INSTANTIATE_TEST_SUITE_P(
    Liquids, Cups,
    testing::Values(Cup{"of_one_skin", cup(0, MeshCollider::As::triangles, 0)},
                    Cup{"of_two_skins", cup(0.001f, MeshCollider::As::triangles, 0)},
                    Cup{"grid_of_default_spacing", cup(0.001f, MeshCollider::As::distance_grid, 0)},
                    Cup{"grid_of_a_millimetre", cup(0.001f, MeshCollider::As::distance_grid, 0.001f)}),
    [](const auto& given) { return given.param.name; });

/// The radius of the funnel's inside at a height; its throat ends at 0.
float funnel_radius(float y) { return y < 0.12f ? 0.025f : 0.025f + (y - 0.12f) * 1.25f; }

TEST(Funnel, LosesNothingThroughItsWall) {
  constexpr float spacing = 0.012f;
  Scene scene;
  Emitter tap;
  tap.position = {0.02f, 0.34f, 0};
  tap.radius = 0.03f;
  tap.flow = 0.0015f;
  Drain sink;
  sink.shape = Plane{};
  sink.position = {0, -0.3f, 0};
  LiquidOptions options{.fluid = {.spacing = spacing}};
  options.flow = {{tap}, {sink}};
  options.capacity = 6000;
  scene.add(make_liquid({}, options));
  MeshCollider funnel;
  funnel.mesh = turned({{0.025f, 0}, {0.025f, 0.12f}, {0.2f, 0.26f}, {0.2f, 0.3f}}, 48, false);
  scene.add(funnel);
  scene.settings.threads = 1;
  World world(scene);
  const Losses losses = run(world, seconds(3.f), [](const Vec3f& p, double) {
    return p.y < 0 || p.y > 0.25f || std::hypot(p.x, p.z) < funnel_radius(p.y);
  });
  report("funnel", losses);
  EXPECT_TRUE(losses.is_finite);
  EXPECT_EQ(losses.outside, 0);
  EXPECT_LT(losses.fastest, 2 * std::sqrt(2 * 9.81 * 0.64)) << "falls by 0.64 m to the drain";
}

// ------------------------------------------------------------------------------------------------ what is moved or immersed

Scene open_tank(float length, float depth, float spacing) {
  Scene scene;
  scene.add(make_liquid(fill_box({0, 0, 0}, {length, depth, 0.4f}, spacing), {.fluid = {.spacing = spacing}}));
  scene.settings.threads = 1;
  const auto wall = [&](const Vec3f& position, const Vec3f& axis, float degrees) {
    Collider plane;
    plane.position = position;
    plane.rotation = rotation(axis, degrees);
    return scene.add(plane);
  };
  wall({}, {1, 0, 0}, 0);
  wall({}, {0, 0, 1}, -90);
  wall({}, {1, 0, 0}, 90);
  wall({0, 0, 0.4f}, {1, 0, 0}, -90);
  wall({length, 0, 0}, {0, 0, 1}, 90);  // the end: collider 4
  return scene;
}

TEST(Tank, MayChangeItsLength) {
  Scene scene = open_tank(0.8f, 0.3f, 0.05f);
  Motion& end = scene.colliders[4].motion;
  end.keyframes = {{0, {}, {}}, {0.5f, {-0.3f, 0, 0}, {}}, {0.55f, {0.2f, 0, 0}, {}}, {1, {-0.2f, 0, 0}, {}}};
  World world(scene);
  const Losses losses =
      run(world, seconds(2), [](const Vec3f& p, double) { return p.x > 0 && p.y > 0 && p.z > 0 && p.z < 0.4f; });
  report("length", losses);
  EXPECT_TRUE(losses.is_finite);
  EXPECT_EQ(losses.outside, 0);
  EXPECT_LT(losses.fastest, 10);
}

/// The user sets the end of the tank elsewhere from one frame to the next: 0.3 m in a sixtieth of a second.
TEST(Tank, MayChangeItsLengthAtOnce) {
  Scene scene = open_tank(0.8f, 0.3f, 0.05f);
  World world(scene);
  run(world, 0.25f, [](const Vec3f&, double) { return true; });
  RigidPose pose = world.collider(4).pose();
  pose.position.x -= 0.3f;
  world.collider(4).set_pose(pose);
  const Losses losses = run(world, seconds(2), [](const Vec3f& p, double) {
    return p.x > 0 && p.x < 0.5f && p.y > 0 && p.z > 0 && p.z < 0.4f;
  });
  report("at_once", losses);
  EXPECT_TRUE(losses.is_finite);
  EXPECT_EQ(losses.outside, 0);
  EXPECT_LT(losses.fastest, 3 * 18) << "the end moves at 18 m/s";
}

/// A body that starts among particles, some of which are inside it.
TEST(Tank, MayHaveABodyImmersedAtTheStart) {
  for (const float density : {300.f, 1000.f, 5000.f}) {
    Scene scene = open_tank(0.8f, 0.4f, 0.04f);
    scene.add(make_body({{.shape = Box{{0.12f, 0.12f, 0.12f}}, .density = density}}, {.position = {0.4f, 0.2f, 0.2f}}));
    World world(scene);
    const Losses losses = run(world, seconds(1.5f), [](const Vec3f& p, double) {
      return p.x > 0 && p.x < 0.8f && p.y > 0 && p.z > 0 && p.z < 0.4f;
    });
    report("immersed", losses);
    EXPECT_TRUE(losses.is_finite);
    EXPECT_EQ(losses.outside, 0);
    EXPECT_LT(losses.fastest, 10);
    for (const Vec3f& v : world.object(1).velocities()) EXPECT_LT(std::sqrt(length_squared(v)), 3);
  }
}

/// A dam that breaks on the opposite wall, whose jet falls back.
TEST(DamBreak, HasNoJetFasterThanTwiceWhatEnergyAllows) {
  for (const float spacing : {0.05f, 0.035f}) {
    Scene scene = open_tank(1.6f, 0.05f, 0.05f);
    scene.objects[0] = make_liquid(fill_box({0, 0, 0}, {0.4f, 0.8f, 0.4f}, spacing), {.fluid = {.spacing = spacing}});
    World world(scene);
    const Losses losses =
        run(world, seconds(3), [](const Vec3f& p, double) { return p.x > 0 && p.x < 1.6f && p.y > 0; });
    report("dam", losses);
    EXPECT_TRUE(losses.is_finite);
    EXPECT_EQ(losses.outside, 0);
    EXPECT_LT(losses.fastest, 2 * std::sqrt(2 * 9.81 * 0.8));
  }
}

}  // namespace
}  // namespace pliant
