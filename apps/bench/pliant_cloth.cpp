// Pliant through its public interface, as any program would use it.
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
  PliantCloth(const Cloth& cloth, Steps steps, int threads) : world_(scene_of(cloth, steps, threads)) {}
  void step(float dt) override { world_.step(dt); }
  std::vector<Vec3f> positions() const override { return world_.positions(0); }
  int threads() const override { return world_.threads(); }

 private:
  World world_;
};

}  // namespace

std::unique_ptr<Engine> make_pliant(const Cloth& cloth, Steps steps, int threads) {
  return std::make_unique<PliantCloth>(cloth, steps, threads);
}

}  // namespace pliant::bench
