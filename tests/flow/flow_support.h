// What the tests of flows share: a nozzle, a jet from it, and sums over frames.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "pliant/flow.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant::testing_support {

inline constexpr float spacing = 0.02f, frame = 1.f / 60;

/// A square nozzle of 5 by 5 particles that points down.
inline Emitter nozzle(float speed) {
  Emitter emitter;
  emitter.position = {0, 1, 0};
  emitter.width = emitter.height = 5 * spacing;
  emitter.speed = speed;
  return emitter;
}

inline Scene jet(const Emitter& emitter, int capacity = 20000, const std::vector<Drain>& drains = {},
                 float lifetime = 0) {
  Scene scene;
  LiquidOptions options;
  options.fluid.spacing = spacing;
  options.flow = {{emitter}, drains, lifetime};
  options.capacity = capacity;
  scene.add(make_liquid({}, options));
  scene.settings.threads = 1;
  return scene;
}

/// Sums over frames.
inline FlowReport run(World& world, int frames) {
  FlowReport sum;
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(frame);
    EXPECT_TRUE(report.ok()) << report.explain();
    sum.add(report.flow);
  }
  return sum;
}

inline std::int64_t living(const World& world) { return static_cast<std::int64_t>(world.object(0).present().size()); }

}  // namespace pliant::testing_support
