// A user's game loop: steps of a fixed length, drawing between them, and a worker that steps while the game draws.
#include <pliant/pliant.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr float step_time = 1.f / 60;
constexpr int most_steps = 4;  // in a drawn frame: after a stall the world runs slower instead of falling behind

/// A world that is stepped in the background, and the positions of its last two steps.
class Simulation {
 public:
  explicit Simulation(const pliant::Scene& scene) : world_(scene), flag_(world_.find("flag").value()) {
    now_.resize(static_cast<std::size_t>(world_.object(flag_).particle_count()));
    world_.object(flag_).read_positions(now_);
    before_ = now_;
  }

  /// Starts the steps that fit into the time that has passed. Until finish() nothing else may use the world.
  void start(double passed) {
    owed_ += passed;
    const int steps = std::min(static_cast<int>(owed_ / step_time), most_steps);
    owed_ = std::min(owed_ - steps * step_time, double(step_time));
    work_ = std::async(std::launch::async, [this, steps] {
      for (int i = 0; i < steps; ++i) {
        before_ = now_;
        const pliant::Report report = world_.step(step_time);
        if (!report.ok()) return report.explain();
        world_.object(flag_).read_positions(now_);
      }
      return std::string();
    });
  }

  /// Waits for the steps. Returns what went wrong; usually nothing.
  std::string finish() { return work_.get(); }

  /// Positions between the last two steps, for the time that no step covers yet.
  void interpolate(std::vector<pliant::Vec3f>& into) const {
    const auto share = static_cast<float>(owed_ / step_time);
    into.resize(now_.size());
    for (std::size_t i = 0; i < now_.size(); ++i) into[i] = before_[i] + (now_[i] - before_[i]) * share;
  }

  pliant::World& world() { return world_; }

 private:
  pliant::World world_;
  pliant::ObjectId flag_;
  std::vector<pliant::Vec3f> before_, now_;
  double owed_ = 0;  ///< time that no step covers yet [s]
  std::future<std::string> work_;
};

pliant::Scene flag_in_the_wind() {
  pliant::Scene scene;
  pliant::ClothOptions options;
  options.name = "flag";
  const int flag = scene.add_cloth(pliant::grid_mesh(24, 16, 1.5f, 1.f), options);
  scene.pin(flag, {0, 15});
  scene.wind = {{6, 0, 1}, 0.3f, 2, 1.2f};
  scene.settings.threads = 1;  // leave the other processors to the game
  return scene;
}

}  // namespace

int main() {
  Simulation simulation(flag_in_the_wind());
  std::vector<pliant::Vec3f> drawn, last;
  float greatest_jump = 0;
  for (int frame = 0; frame < 200; ++frame) {
    const double passed = frame % 50 == 49 ? 0.05 : 1 / 144.;  // a screen of 144 Hz, which stalls at times
    simulation.start(passed);
    // ... draw `drawn` here, play sounds, ask for input ...
    if (const std::string problem = simulation.finish(); !problem.empty()) {
      std::cerr << problem << "\n";
      return 1;
    }
    simulation.interpolate(drawn);
    for (std::size_t i = 0; i < last.size(); ++i) {
      const pliant::Vec3f d = drawn[i] - last[i];
      greatest_jump = std::max(greatest_jump, std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z));
    }
    last = drawn;
  }
  std::cout << "after " << simulation.world().state().time
            << " s, the farthest that anything moved between two pictures is " << greatest_jump << " m\n";
  return simulation.world().state().time > 1.4 && greatest_jump < 0.5f ? 0 : 1;
}
