#include "solver/sweeps/multigrid.h"

#include <algorithm>

#include "constraints/all.h"
#include "solver/frame.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Batches of a task: of rows that one thread's cache holds.
constexpr int batches_per_task = 128;
/// Jacobi passes on the coarsest level.
constexpr int coarsest_passes = 8;
/// A contact is this many times as stiff as a spring beside it.
constexpr float contact_stiffness = 10;
/// Times a coarser level is visited on each visit of the one above it, from the second on: a W-cycle.
constexpr int visits = 2;

/// One object's solve in one substep.
class Solve {
 public:
  Solve(Frame& frame, int object)
      : frame_(frame),
        model_(frame.model().objects[object].multigrid),
        work_(frame.scratch().multigrid[object]),
        kernels_(multigrid_kernels(frame.kernels().isa)),
        object_(object) {}

  void linearise(const SweepArguments& a) {
    const LinearisedAt at{a.positions, a.displacements, a.inverse_h2, work_.extra.data(), work_.has_extra.data()};
    for_batches(0, [&](int first, int last) { kernels_.linearise(level(0), at, values(0), first, last); });
    for (int l = 1; l < levels(); ++l)
      for_batches(l, [&](int first, int last) {
        kernels_.coarsen(level(l - 1), values(l - 1), l == 1, level(l), values(l), first, last);
      });
  }

  /// Conjugate gradients on the finest level from zero.
  void solve(int cycles) {
    std::fill(work_.change.begin(), work_.change.end(), Record{});
    MultigridValues& top = values(0);
    double before = 0;
    for (int i = 0; i < cycles; ++i) {
      precondition(0);
      cycle(0);
      const double now = sum(0, [&](int f, int t) { return kernels_.dot(top.right.data(), top.x.data(), f, t); });
      const float beta = i > 0 && before > 0 ? static_cast<float>(now / before) : 0.f;
      before = now;
      if (i == 0) std::fill(work_.direction.begin(), work_.direction.end(), Record{});
      for_batches(0, [&](int f, int t) { kernels_.turn(beta, top.x.data(), work_.direction.data(), f, t); });
      const double curvature = sum(0, [&](int f, int t) {
        return kernels_.apply(level(0), top, true, work_.direction.data(), work_.image.data(), f, t);
      });
      if (!(curvature > 0) || !(now > 0)) return;
      const auto alpha = static_cast<float>(now / curvature);
      for_batches(0, [&](int f, int t) {
        kernels_.advance(alpha, work_.direction.data(), work_.image.data(), work_.change.data(), top.right.data(), f, t);
      });
    }
  }

 private:
  int levels() const { return static_cast<int>(model_.levels.size()); }
  const MultigridLevel& level(int l) const { return model_.levels[l]; }
  MultigridValues& values(int l) { return work_.levels[l]; }

  template <class Body>
  void for_batches(int l, Body body) {
    const int batches = level(l).batches(), tasks = (batches + batches_per_task - 1) / batches_per_task;
    frame_.for_tasks("solve: multigrid", tasks,
                     [&](int task) { body(task * batches_per_task, std::min((task + 1) * batches_per_task, batches)); });
  }

  /// In the tasks' order, whichever thread had them.
  template <class Body>
  double sum(int l, Body body) {
    const int tasks = (level(l).batches() + batches_per_task - 1) / batches_per_task;
    for_batches(l, [&](int first, int last) { work_.sums[first / batches_per_task] = body(first, last); });
    double total = 0;
    for (int task = 0; task < tasks; ++task) total += static_cast<double>(work_.sums[task]);
    return total;
  }

  void precondition(int l) {
    MultigridValues& v = values(l);
    for_batches(l, [&](int f, int t) { kernels_.precondition(v, v.right.data(), v.x.data(), f, t); });
  }

  void smooth(int l) {
    MultigridValues& v = values(l);
    for_batches(l,
                [&](int f, int t) { kernels_.smooth(level(l), v, l == 0, v.right.data(), v.x.data(), v.y.data(), f, t); });
    std::swap(v.x, v.y);
  }

  /// x of level l, already preconditioned, after a cycle with a Jacobi pass on either way.
  void cycle(int l) {
    MultigridValues& v = values(l);
    if (l + 1 == levels()) {
      for (int pass = 0; pass < coarsest_passes; ++pass) smooth(l);
      return;
    }
    for_batches(
        l, [&](int f, int t) { kernels_.residual(level(l), v, l == 0, v.right.data(), v.x.data(), v.y.data(), f, t); });
    for_batches(l + 1, [&](int f, int t) { kernels_.restrict_to(level(l + 1), values(l + 1), v.y.data(), f, t); });
    cycle(l + 1);
    for (int visit = 1; visit < visits && l + 2 < levels(); ++visit) {
      smooth(l + 1);
      cycle(l + 1);
    }
    for_batches(l, [&](int f, int t) { kernels_.prolong(level(l), values(l + 1).x.data(), v.x.data(), f, t); });
    smooth(l);
  }

  Frame& frame_;
  const Multigrid& model_;
  MultigridObject& work_;
  const MultigridKernels& kernels_;
  int object_;
};

// ---------------------------------------------------------------- contacts

/// Adds a contact that is not free to its particle's row: K (1 - mu) n n^T + mu K I, against depth and slip.
void add_contact(const Contact& contact, const SweepArguments& a, float stiffness, MultigridObject& work) {
  const Record &d = a.displacements[contact.particle], &r = a.remainders[contact.particle];
  const Vec3f moved{d.x, d.y, d.z}, n = contact.normal;
  const float depth = contact.gap + dot(n, moved);
  if (!(depth < 0)) return;
  const float mu = min(contact.kinetic_friction, 1.f), across = mu * stiffness, along = stiffness - across;
  const Vec3f motion = moved - Vec3f{r.x, r.y, r.z} - contact.surface_motion;
  const Vec3f slip = motion - n * dot(n, motion);
  const Vec3f force = n * (-stiffness * depth) - slip * across;
  const int place = lane_place(contact.particle), batch = place / batch_width;
  float* extra = work.extra.data() + static_cast<std::ptrdiff_t>(batch) * 9 * batch_width;
  if (work.has_extra[batch] == 0) std::fill(extra, extra + 9 * batch_width, 0.f);
  work.has_extra[batch] = 1;
  const float add[9] = {along * n.x * n.x + across,
                        along * n.y * n.y + across,
                        along * n.z * n.z + across,
                        along * n.x * n.y,
                        along * n.x * n.z,
                        along * n.y * n.z,
                        force.x,
                        force.y,
                        force.z};
  for (int c = 0; c < 9; ++c) extra[c * batch_width + place % batch_width] += add[c];
}

void add_contacts(Frame& frame) {
  const Model& model = frame.model();
  for (MultigridObject& object : frame.scratch().multigrid) std::fill(object.has_extra.begin(), object.has_extra.end(), 0);
  for (std::size_t task = 0; task < model.tiles.size(); ++task) {
    const int o = model.tiles[task].object;
    if (model.objects[o].multigrid.levels.empty()) continue;
    const std::vector<float>& limits = model.objects[o].multigrid.stiffness_limit;
    const SweepArguments a = frame.arguments(o, false);
    for (const Contact& contact : frame.workspace().tiles[task].contacts)
      add_contact(contact, a, contact_stiffness * limits[contact.particle], frame.scratch().multigrid[o]);
  }
}

// ---------------------------------------------------------------- multipliers

/// What the step has already made each distance constraint do: lambda = -K C h^2, so that the sweeps go on from there. Rigid
/// ones need none.
void set_multipliers(const CompiledObject& object, const Segment& segment, const SweepArguments& a) {
  const Pool& pool = object.pools[segment.pool];
  float* multipliers = a.multipliers != nullptr ? a.multipliers[segment.pool] : nullptr;
  if (multipliers == nullptr || pool.type != index_of<Distance>(AllConstraints{})) return;
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    const std::int64_t batch = segment.first_batch + b;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      const int i = particle_of(segment, index, 0, lane), j = particle_of(segment, index, 1, lane);
      const Record &p = a.positions[i], &q = a.positions[j], &d = a.displacements[i], &e = a.displacements[j];
      const Vec3f u{(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
      const std::vector<float>& limits = object.multigrid.stiffness_limit;
      const float stiffness = spring_stiffness(pool.row(1, batch)[lane], max(limits[i], limits[j]));
      multipliers[batch * batch_width + lane] = -(stiffness * (length(u) - pool.row(0, batch)[lane])) / a.inverse_h2;
    }
  }
}

void begin_multipliers(Frame& frame) {
  const Model& model = frame.model();
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    for (auto& values : frame.workspace().multipliers[o]) std::fill(values.begin(), values.end(), 0.f);
    frame.workspace().volume_multipliers[o] = 0;
    if (model.objects[o].multigrid.levels.empty()) continue;
    const SweepArguments a = frame.arguments(static_cast<int>(o), false);
    for (const Segment& segment : model.objects[o].segments) set_multipliers(model.objects[o], segment, a);
  }
}

void correct(Frame& frame, int o) {
  const SweepArguments a = frame.arguments(o, false);
  MultigridObject& work = frame.scratch().multigrid[o];
  const int particles = frame.model().objects[o].particles;
  Solve solve(frame, o);
  solve.linearise(a);
  solve.solve(frame.options().multigrid_cycles);
  for (int i = 0; i < particles; ++i) {
    Record& d = a.displacements[i];
    const Record& c = work.change[i];
    d = {d.x + c.x, d.y + c.y, d.z + c.z, 0};
  }
}

}  // namespace

void prepare_multigrid(const Model& model, std::vector<MultigridObject>& objects) {
  objects.assign(model.objects.size(), {});
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const std::vector<MultigridLevel>& levels = model.objects[o].multigrid.levels;
    if (levels.empty()) continue;
    MultigridObject& to = objects[o];
    const auto blocks = static_cast<std::size_t>(levels[0].batches());
    for (std::size_t l = 0; l < levels.size(); ++l) {
      MultigridValues& values = to.levels.emplace_back();
      const auto batches = static_cast<std::size_t>(levels[l].batches());
      values.blocks.resize(static_cast<std::size_t>(levels[l].slots()) * (l == 0 ? spring_floats : block_floats));
      values.diagonal.resize(batches * block_floats);
      values.inverse.resize(batches * block_floats);
      for (Records* records : {&values.right, &values.x, &values.y}) records->resize(batches * batch_width + 1);
    }
    for (Records* records : {&to.direction, &to.image, &to.change}) records->resize(blocks * batch_width + 1);
    to.extra.resize(blocks * 9 * batch_width);
    to.has_extra.resize(blocks);
    to.sums.resize(blocks / batches_per_task + 1);
  }
}

void iterate_multigrid(Frame& frame, bool first) {
  if (first) {
    add_contacts(frame);
    for (std::size_t o = 0; o < frame.model().objects.size(); ++o)
      if (!frame.model().objects[o].multigrid.levels.empty()) correct(frame, static_cast<int>(o));
    begin_multipliers(frame);
  }
  // There and back: distances, first of all types, have the last word, and what bending pulls apart is put right again.
  iterate_tiled(frame, false);
  frame.sweep_contacts();
  frame.sweep_straddlers(false, Order::backward);
  frame.sweep_tiles(false, Order::backward);
}

}  // namespace pliant
