#include "apps/bench/chains.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "apps/bench/timing.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/joint.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

constexpr float half_link = 0.25f, end_mass = 100;

/// Processor time of this thread [ms].
double thread_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Joints that are PBD constraints of stiffness 1 are projected one after another; others that form trees are solved
/// directly.
Object chain_of(int links, bool by_sweeps) {
  Object chain;
  chain.name = "chain";
  for (int i = 0; i < links; ++i) {
    BodyOptions options;
    options.position = {half_link * static_cast<float>(2 * i + 1), 0, 0};
    options.mass = i + 1 == links ? end_mass : 1;
    add_body(chain, {{Box{{half_link, 0.05f, 0.05f}}}}, options);
  }
  for (int i = 0; i < links; ++i)
    add_joint(chain, BallJoint{.a = i - 1, .b = i, .anchor = {half_link * static_cast<float>(2 * i), 0, 0}});
  if (by_sweeps)
    for (ConstraintGroup& group : chain.constraints) group.stiffness = Stiffness::pbd(1);
  chain.collides = chain.self_collision = false;
  return chain;
}

/// One chain, and how it is solved.
class Chain {
 public:
  Chain(int links, const std::string& solver, int substeps)
      : object_(chain_of(links, solver == "sweeps")), world_(scene_of(object_, substeps)) {
    row_.links = links;
    row_.solver = solver;
    row_.substeps = substeps;
  }

  void step() {
    const double start = thread_ms();
    world_.step(frame_time);
    times_.push_back(thread_ms() - start);
    row_.drift = std::max(row_.drift, drift());
  }

  ChainRow row() {
    std::nth_element(times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(times_.size() / 2), times_.end());
    row_.ms_per_frame = times_[times_.size() / 2];
    return row_;
  }

 private:
  static Scene scene_of(const Object& object, int substeps) {
    Scene scene;
    scene.settings.threads = 1;
    scene.settings.substeps = substeps;
    scene.settings.sweep = Sweep::tiled;
    scene.add(object);
    return scene;
  }

  /// The end of a link: its centre, and half a link along its x-axis, which is where the description has it.
  Vec3d end(std::size_t link, double side) const {
    const Quatf& q = orientations_[link];
    const double x = q.x, y = q.y, z = q.z, w = q.w, half = side * static_cast<double>(half_link);
    const Vec3f& at = positions_[link];
    return {static_cast<double>(at.x) + half * (1 - 2 * (y * y + z * z)),
            static_cast<double>(at.y) + half * 2 * (x * y + w * z),
            static_cast<double>(at.z) + half * 2 * (x * z - w * y)};
  }

  double drift() {
    const ObjectView view = world_.object(0);
    positions_ = view.positions();
    orientations_ = view.orientations();
    Vec3d before{};
    double most = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(row_.links); ++i) {
      most = std::max(most, std::sqrt(length_squared(end(i, -1) - before)));
      before = end(i, 1);
    }
    return most;
  }

  Object object_;
  World world_;
  ChainRow row_;
  std::vector<double> times_;
  std::vector<Vec3f> positions_;
  std::vector<Quatf> orientations_;
};

}  // namespace

std::vector<ChainRow> measure_chains(const ChainOptions& options) {
  std::vector<ChainRow> rows;
  for (const int links : options.sizes) {
    if (links < 2) throw Error({}, "a chain has " + std::to_string(links) + " links", "give at least 2");
    std::vector<Chain> chains;
    chains.emplace_back(links, "sweeps", 40);
    for (const int substeps : {8, 4, 2}) chains.emplace_back(links, "direct", substeps);
    for (int frame = 0; frame < options.frames; ++frame)
      for (Chain& chain : chains) chain.step();
    double of_sweeps = 0;
    for (Chain& chain : chains) {
      ChainRow row = chain.row();
      if (of_sweeps == 0) of_sweeps = row.ms_per_frame;
      row.ratio = row.ms_per_frame / of_sweeps;
      rows.push_back(row);
      if (options.on_row) options.on_row(row);
    }
  }
  return rows;
}

}  // namespace pliant::bench
