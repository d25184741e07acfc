// Sleep of grains (SleepOptions): one that has hardly moved for some time stays where it is, until something near it
// moves.
//
// A grain that sleeps has no inverse mass and no velocity in the State, so no stage moves it. What lasts are two
// channels of the State: "rest_time", for how long a grain has been slow [s], or `asleep`; and "rest_shift", how far
// what is near has moved since it sleeps [m].
#pragma once

#include <vector>

#include "world/world_data.h"

namespace pliant {

inline constexpr const char *rest_time_channel = "rest_time", *rest_shift_channel = "rest_shift";

/// For each particle of a State the time for which it has been slow [s], or `asleep`; null if nothing has slept yet.
const float* grain_rest_times(const State& state);

/// Wakes the grains of an object, or all: what is set, added or removed acts in the next step.
void wake_grains(WorldData& world, int number);
void wake_all_grains(WorldData& world);

/// Wakes the grains that touch one that is gone. Call it before these contacts are forgotten.
void wake_beside_gone(WorldData& world);

/// Contacts of grains that sleep while a step begins: those among themselves, which the step does not know, and those
/// with others.
struct Resting {
  std::vector<GrainContact> kept, touched;
};

/// Wakes the grains that something may touch in a step of `dt` seconds that begins now.
Resting begin_rest(WorldData& world, double dt);

/// Ends that step, after `elapsed` seconds of it: puts the contacts back, wakes what a grain pushes or leaves, and lets
/// grains fall asleep. Returns how many sleep.
int end_rest(WorldData& world, double elapsed, const Resting& resting);

}  // namespace pliant
