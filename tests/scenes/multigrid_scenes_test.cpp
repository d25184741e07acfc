// Simulates scenes of contact that multigrid once tore apart: with pushes and friction that nothing had exerted, and
// with a residual that did work.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "pliant/pliant.h"
#include "support/paths.h"

namespace pliant {
namespace {

/// Cloth is pulled over the edge of a box until it slides off.
/// The largest p99 of overstretch in any frame.
double pull_over_edge(int substeps) {
  Scene scene = read_scene(test::in_tree("scenes/contact/box_edge.json"));
  scene.settings.sweep = Sweep::multigrid;
  scene.settings.substeps = substeps;
  scene.settings.record_multipliers = true;
  World world(scene);
  double mass = 0, p99 = 0, largest = 0, gain = 0,
         least = world.measure().kinetic_energy() + world.measure().potential_energy();
  for (const float m : scene.objects[0].masses) mass += static_cast<double>(m);
  for (int frame = 0; frame < scene.frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    EXPECT_TRUE(report.ok()) << report.explain();
    p99 = std::max(p99, world.measure().overstretch().p99);
    largest = std::max(largest, world.measure().overstretch().largest);
    const double energy = world.measure().kinetic_energy() + world.measure().potential_energy();
    least = std::min(least, energy);
    gain = std::max(gain, energy - least);
  }
  EXPECT_LT(largest, 0.15) << "where the last row leaves the edge; 2.2 with forces handed over";
  EXPECT_LT(gain / mass, 0.1) << "J/kg; the pins do work";
  return p99;
}

/// The last row snaps off the edge in one frame, by chance more or less gently: the largest p99 with 8 to 14 substeps is
/// 1.1 to 5.4 %. So the median of all.
TEST(MultigridScenes, PullClothOverAnEdgeWithoutTearingIt) {
  std::array<double, 7> p99{};
  for (int i = 0; i < 7; ++i) p99[static_cast<std::size_t>(i)] = pull_over_edge(8 + i);
  std::sort(p99.begin(), p99.end());
  EXPECT_LT(p99[3], 0.03);
}

}  // namespace
}  // namespace pliant
