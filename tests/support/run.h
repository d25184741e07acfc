// Runs a World of which no step may have anything to report.
#pragma once

#include <gtest/gtest.h>

#include "pliant/report.h"
#include "pliant/world.h"

namespace pliant::testing_support {

inline void run(World& world, int frames, float frame_time = 1.f / 60) {
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
}

}  // namespace pliant::testing_support
