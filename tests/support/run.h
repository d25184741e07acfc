// The length of a frame, and a run of a World in which no step may have anything to report.
#pragma once

#include <gtest/gtest.h>

#include "pliant/report.h"
#include "pliant/world.h"

namespace pliant::testing_support {

constexpr float frame_time = 1.f / 60;  // [s]

inline void run(World& world, int frames, float step = frame_time) {
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(step);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
}

}  // namespace pliant::testing_support
