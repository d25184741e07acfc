// A load up to 100 000 times as heavy as a link of the chain on which it hangs: iterations do not converge, an exact
// solve does.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr int heavy_chain_frames = 600;
constexpr float heavy_link = 0.01f;

struct Case {
  int links;
  float load;   ///< mass of the load [kg]; a particle of the chain has 1 kg
  float slope;  ///< 0: the chain hangs at rest; 1: it is released at 45 degrees
  int substeps, iterations;
};

Object chain_of(const Case& of) {
  Object line = hanging_line(of.links + 1, heavy_link, 1, of.load, Stiffness::rigid());
  const float across = of.slope == 0 ? 0.f : 0.70710678f, down = of.slope == 0 ? 1.f : 0.70710678f;
  for (Vec3f& p : line.positions) p = {-p.y * across, p.y * down, 0};
  return line;
}

/// The largest deviation of the load's distance from the fixed end, over the length of the chain.
double error_of(const Case& of, Sweep sweep) {
  Scene scene = scene_with(chain_of(of), 10, of.substeps, of.iterations);
  scene.settings.sweep = sweep;
  World world(scene);
  const double length = static_cast<double>(heavy_link) * of.links;
  double worst = 0;
  for (int frame = 0; frame < heavy_chain_frames; ++frame) {
    if (!world.step(1.f / 60).ok()) return std::numeric_limits<double>::infinity();
    const Vec3f end = world.object(0).positions().back();
    worst = std::max(worst, std::fabs(std::sqrt(static_cast<double>(length_squared(end))) - length) / length);
  }
  return worst;
}

}  // namespace

void heavy_chain_rows(Result& result, bool) {
  // An exact solve of the linearised chain carries a load at rest. A swinging load moves its light links by much of
  // their length in a substep, so that the linearisation fails: it needs short substeps and a second solve.
  for (const Case& of : {Case{20, 1e5f, 0, 10, 1}, Case{50, 5e4f, 0, 10, 1}, Case{20, 1e5f, 1, 200, 2}}) {
    const std::string name = "heavy_chain: " + brief(of.links) + " links, load of " + brief(of.load) + " of them, " +
                             (of.slope == 0 ? "hanging" : "swinging") + ", error of length";
    const std::string plain = brief(100 * error_of(of, Sweep::tiled));
    result.rows.push_back(at_most(name, 0.01, error_of(of, Sweep::chains), "",
                                  "chains, " + brief(of.substeps) + " x " + brief(of.iterations) +
                                      ", 10 s, float; the tiled sweep: " + plain + " %"));
  }
}

}  // namespace pliant::validate
