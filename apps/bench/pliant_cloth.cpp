// Pliant through its public interface, as a user's program would use it.
#include <algorithm>

#include "apps/bench/cloth.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

Scene scene_of(const Cloth& cloth, Steps steps, int threads) {
  Scene scene;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.substeps = steps.substeps;
  scene.settings.iterations = steps.iterations;
  scene.settings.threads = threads;
  scene.add(cloth.object);
  return scene;
}

class PliantCloth final : public Engine {
 public:
  PliantCloth(const Cloth& cloth, Steps steps, int threads) : scene_(scene_of(cloth, steps, threads)), world_(scene_) {}
  void step(float dt) override { world_.step(dt); }
  std::vector<Vec3f> positions() const override { return world_.object(0).positions(); }
  int threads() const override { return world_.threads(); }

  /// Simulates a second World from this one's State, with phases timed separately.
  std::vector<PhaseTime> phases(float dt, int frames) override {
    Scene scene = scene_;
    scene.settings.separate_phases = true;
    World world(scene);
    world.restore(world_.state());
    std::vector<PhaseTime> sums;
    for (int frame = 0; frame < frames; ++frame) {
      for (const PhaseTime& phase : world.step(dt).phases) {
        const auto same = [&](const PhaseTime& sum) { return sum.name == phase.name; };
        const auto sum = std::find_if(sums.begin(), sums.end(), same);
        if (sum == sums.end())
          sums.push_back({phase.name, phase.milliseconds / frames});
        else
          sum->milliseconds += phase.milliseconds / frames;
      }
    }
    return sums;
  }

 private:
  Scene scene_;
  World world_;
};

}  // namespace

std::unique_ptr<Engine> make_pliant(const Cloth& cloth, Steps steps, int threads) {
  return std::make_unique<PliantCloth>(cloth, steps, threads);
}

}  // namespace pliant::bench
