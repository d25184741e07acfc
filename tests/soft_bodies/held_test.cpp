// Elastic solids that attachments hold, against the same ones that pins hold.
#include <cmath>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A bar of 0.4 m x 0.1 m x 0.1 m along x, held at its end of negative x.
struct HeldBar {
  int cells = 3;  ///< over its thickness
  float poisson_ratio = 0.3f;
  float compliance = -1;  ///< of attachments [m/N]; below zero: it is pinned
  bool swings = false;    ///< its end goes up and down once
  Vec3f gravity{0, -1, 0};
  Settings::Integrator integrator = Settings::Integrator::pbd;

  Scene scene() const {
    SoftBodyOptions options;
    options.material = solid_of(1e6f, poisson_ratio);
    Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {4 * cells, cells, cells}), options);
    bar.damping = swings ? 0.f : 8.f;
    Motion motion;
    if (swings) motion.keyframes = {{0, {}}, {0.1f, {0, 0.05f, 0}}, {0.2f, {}}};
    std::vector<int> held;
    for (int i = 0; i < static_cast<int>(bar.positions.size()); ++i)
      if (bar.positions[static_cast<std::size_t>(i)].x < -0.1999f) held.push_back(i);
    for (const int i : held)
      if (compliance >= 0)
        bar.attachments.push_back(
            {i, bar.positions[static_cast<std::size_t>(i)], motion, Stiffness::compliance(compliance)});
      else
        bar.pins.push_back({i, motion});
    Scene out = scene_of(bar, 0);
    out.settings.integrator = integrator;
    out.gravity = gravity;
    return out;
  }
};

/// The mean height of the free end, relative to that at rest [m].
double sag_of(const World& world, const Scene& scene) {
  const std::vector<Vec3f> positions = positions_of(world);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3f& rest = scene.objects[0].positions[i];
    if (rest.x < 0.1999f) continue;
    sum += static_cast<double>(positions[i].y - rest.y);
    ++count;
  }
  return sum / count;
}

double sag_at_rest(const HeldBar& bar) {
  const Scene scene = bar.scene();
  World world(scene);
  run(world, 120);
  return sag_of(world, scene);
}

// 1.24 and 1.15 times as far when attachments were projected before the solid; with 8 cells it has two tiles.
TEST(HeldSolids, ABarSagsAsFarByAttachmentsAsByPins) {
  for (const int cells : {2, 4, 8})
    for (const float poisson_ratio : {0.3f, 0.45f}) {
      if (cells == 8 && poisson_ratio > 0.4f) continue;
      const double pinned = sag_at_rest({cells, poisson_ratio});
      EXPECT_NEAR(sag_at_rest({cells, poisson_ratio, 0}) / pinned, 1, 0.005) << cells << " cells, " << poisson_ratio;
    }
}

TEST(HeldSolids, AHangingBarToo) {
  HeldBar bar;
  bar.gravity = {4, 0, 0};
  const auto length = [&](float compliance) {
    HeldBar one = bar;
    one.compliance = compliance;
    const Scene scene = one.scene();
    World world(scene);
    run(world, 120);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < scene.objects[0].positions.size(); ++i)
      if (scene.objects[0].positions[i].x > 0.1999f) {
        sum += static_cast<double>(positions_of(world)[i].x) - 0.2;
        ++count;
      }
    return sum / count;
  };
  EXPECT_NEAR(length(0) / length(-1), 1, 0.01);  // 1.05
}

// Springs at both edges of the end turn it, and the bar's own sag comes on top: by what the springs yield, whatever the
// substeps. 1.13 times as far with the default substeps before.
TEST(HeldSolids, SpringsYieldAlikeWithMoreSubsteps) {
  for (const float compliance : {1e-6f, 1e-5f, 1e-4f}) {
    HeldBar bar;
    bar.compliance = compliance;
    Scene scene = bar.scene();
    scene.settings.substeps = 120;
    World world(scene);
    run(world, 120);
    EXPECT_NEAR(sag_at_rest(bar) / sag_of(world, scene), 1, 0.045) << compliance << " m/N";
  }
}

TEST(HeldSolids, AttachmentsThatMoveTakeTheBarAlongAsPinsDo) {
  for (const auto integrator : {Settings::Integrator::pbd, Settings::Integrator::energy}) {
    HeldBar bar{3, 0.3f, -1, true, {0, -9.81f, 0}, integrator};
    const Scene pinned = bar.scene();
    bar.compliance = 0;
    const Scene attached = bar.scene();
    World a(pinned), b(attached);
    for (int frame = 0; frame < 90; ++frame) {
      run(a, 1);
      run(b, 1);
      ASSERT_NEAR(sag_of(a, pinned), sag_of(b, attached), 5e-4) << frame;
    }
  }
}

// The multiplier of an attachment over h^2 is its force: all of them bear the bar.
TEST(HeldSolids, AttachmentsBearTheWeight) {
  for (const float compliance : {0.f, 1e-6f}) {
    HeldBar bar;
    bar.compliance = compliance;
    bar.gravity = {4, 0, 0};
    Scene scene = bar.scene();
    scene.settings.record_multipliers = true;
    World world(scene);
    run(world, 119);
    const Report report = world.step(frame_time);
    const double h = static_cast<double>(frame_time) / report.substeps;
    double force = 0, mass = 0;
    for (const float multiplier : world.object(ObjectId(0)).multipliers("distance"))
      force -= static_cast<double>(multiplier) / (h * h);
    for (const float m : scene.objects[0].masses) mass += static_cast<double>(m);
    EXPECT_GT(force, 0.97 * mass * 4) << compliance;
    EXPECT_LT(force, 1.2 * mass * 4) << compliance << ", some of them hold the bar together";
  }
}

TEST(HeldSolids, AnAttachmentOfAnEditHoldsAsWell) {
  HeldBar bar;
  const double pinned = sag_at_rest(bar);
  bar.compliance = 0;
  const Scene attached = bar.scene();
  Scene scene = attached;
  scene.objects[0].attachments.clear();
  World world(scene);
  world.edit(ObjectId(0), unchanged(attached.objects[0]));
  run(world, 120);
  EXPECT_NEAR(sag_of(world, scene) / pinned, 1, 0.005);
}

}  // namespace
}  // namespace pliant
