// The ledger of momentum: what the filter, the guards and sleep take, as the Report says it, is what is missing.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <utility>

#include "pliant/body.h"
#include "pliant/world.h"
#include "world/filter_momentum_support.h"

namespace pliant {
namespace {

struct Ledger {
  LostMomentum lost;
  double changed = 0;    ///< of the momentum of all [kg m/s]
  double exchanged = 0;  ///< change of the first object's [kg m/s]
  std::int64_t truncated = 0;
};

Ledger ledger_of(Scene scene, int frames) {
  scene.gravity = {};
  World world(scene);
  const std::size_t first = scene.objects[0].positions.size(), all = world.state().positions.size();
  const Vec3d before = testing_support::momentum_of(world, 0, all).linear,
              of_first = testing_support::momentum_of(world, 0, first).linear;
  Ledger ledger;
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(testing_support::dt);
    ledger.lost += report.lost_momentum;
    ledger.truncated += report.pairs.truncated;
  }
  ledger.changed = length(testing_support::momentum_of(world, 0, all).linear - before);
  ledger.exchanged = length(testing_support::momentum_of(world, 0, first).linear - of_first);
  return ledger;
}

Scene two_sheets(bool is_pinned) {
  Scene scene;
  Object lower = testing_support::free_sheet(16, 0.8f, 0.2f, {});
  if (is_pinned) lower.pins = {{0}, {15}, {240}, {255}};
  scene.add(std::move(lower));
  scene.add(testing_support::moving(testing_support::free_sheet(16, 0.8f, 0.2f, {0.05f, 0.35f, 0}, 1.f), {0, -5, 0}));
  return scene;
}

TEST(LostMomentumLedger, OfFreeSheetsIsEmpty) {
  const Ledger ledger = ledger_of(two_sheets(false), 20);
  EXPECT_GT(ledger.truncated, 0);
  EXPECT_GT(ledger.exchanged, 0.1);
  EXPECT_LT(ledger.changed, 1e-4 * ledger.exchanged);
  EXPECT_LT(ledger.lost.filter, 1e-4 * ledger.exchanged);
  EXPECT_LT(ledger.lost.guards, 1e-4 * ledger.exchanged);
  EXPECT_EQ(ledger.lost.sleep, 0);
}

/// The filter takes part of what pins would take anyway.
TEST(LostMomentumLedger, SaysWhatTheFilterTakesWherePinsAct) {
  const Ledger ledger = ledger_of(two_sheets(true), 20);
  EXPECT_GT(ledger.truncated, 0);
  EXPECT_GT(ledger.lost.filter, 1e-3);
}

TEST(LostMomentumLedger, SaysWhatSleepTakes) {
  Scene scene;
  scene.settings.sleep.on = true;
  scene.add(make_body({{Sphere{0.1f}}}, {.velocity = {0.004f, 0, 0.003f}, .mass = 2}));
  const Ledger ledger = ledger_of(scene, 90);
  EXPECT_NEAR(ledger.changed, 0.01, 1e-6) << "it sleeps";
  EXPECT_NEAR(ledger.lost.sleep, ledger.changed, 1e-6);
  EXPECT_EQ(ledger.lost.filter + ledger.lost.guards, 0);
}

}  // namespace
}  // namespace pliant
