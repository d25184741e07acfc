#include "solver/sweeps/multigrid.h"

#include <algorithm>
#include <array>

#include "constraints/all.h"
#include "solver/frame.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Batches of a task: of rows that one thread's cache holds.
constexpr int batches_per_task = 128;
/// Jacobi passes on the coarsest level.
constexpr int coarsest_passes = 8;
/// Times a coarser level is visited on each visit of the one above it, from the second on: a W-cycle. Once where it has more
/// than half of that one's rows: there a W-cycle's work would grow from level to level.
constexpr int visits = 2;

/// Cholesky; what is not held (a piece of no mass) stays.
Record shift_of(const MultigridObject::Piece& piece) {
  const double *a = piece.held, *b = piece.force;
  const double d0 = a[0], l1 = d0 > 0 ? a[3] / d0 : 0, l2 = d0 > 0 ? a[4] / d0 : 0;
  const double d1 = a[1] - l1 * a[3], l12 = d1 > 0 ? (a[5] - l2 * a[3]) / d1 : 0, d2 = a[2] - l2 * a[4] - l12 * l12 * d1;
  if (!(d0 > 0 && d1 > 0 && d2 > 0)) return {};
  const double y1 = b[1] - l1 * b[0], z = (b[2] - l2 * b[0] - l12 * y1) / d2, y = y1 / d1 - l12 * z;
  return {static_cast<float>(b[0] / d0 - l1 * y - l2 * z), static_cast<float>(y), static_cast<float>(z), 0};
}

/// One object's solve in one substep.
class Solve {
 public:
  Solve(Frame& frame, int object)
      : frame_(frame),
        object_(object),
        model_(frame.model().objects[object].multigrid),
        work_(frame.scratch().multigrid[object]),
        kernels_(multigrid_kernels(frame.kernels().isa)) {}

  void linearise(const SweepArguments& a) {
    const LinearisedAt at{a.positions, a.displacements, a.inverse_h2, work_.extra.data(), work_.has_extra.data()};
    for_batches(0, [&](int first, int last) { kernels_.linearise(level(0), at, values(0), first, last); });
    for (int l = 1; l < levels(); ++l)
      for_batches(l, [&](int first, int last) {
        kernels_.coarsen(level(l - 1), values(l - 1), l == 1, level(l), values(l), first, last);
      });
  }

  /// A step of conjugate gradients in parts, for objects that contacts join to make in step: its preconditioned residual,
  /// whose product with the residual is returned; the direction; its image and their product; the step along it.
  double precondition() {
    MultigridValues& top = values(0);
    precondition(0);
    cycle(0);
    return sum(0, [&](int f, int t) { return kernels_.dot(top.right.data(), top.x.data(), f, t); });
  }
  void turn(float beta) {
    for_batches(0, [&](int f, int t) { kernels_.turn(beta, values(0).x.data(), work_.direction.data(), f, t); });
  }
  double apply() {
    return sum(0, [&](int f, int t) {
      return kernels_.apply(level(0), values(0), true, work_.direction.data(), work_.image.data(), f, t);
    });
  }
  void advance(float alpha) {
    for_batches(0, [&](int f, int t) {
      kernels_.advance(alpha, work_.direction.data(), work_.image.data(), work_.change.data(), values(0).right.data(), f,
                       t);
    });
  }
  /// The direction that moves all that can move by `by`.
  void turn_to(const Vec3f& by) {
    for (std::size_t i = 0; i < model_.piece.size(); ++i)
      work_.direction[i] = model_.piece[i] >= 0 ? Record{by.x, by.y, by.z, 0} : Record{};
  }
  void clear_change() { std::fill(work_.change.begin(), work_.change.end(), Record{}); }
  void clear_direction() { std::fill(work_.direction.begin(), work_.direction.end(), Record{}); }

  /// The direction that moves every piece as a whole so that no force on the whole of it is left over: what nothing holds then
  /// keeps its momentum, however few the cycles. `springs` are contacts, of which those of a piece with itself hold it nowhere.
  void turn_to_shifts(const std::vector<const PairSpring*>& springs) {
    clear_direction();
    if (!sum_pieces()) return;
    for (const PairSpring* s : springs) release(*s);
    for (std::size_t i = 0; i < model_.piece.size(); ++i)
      if (model_.piece[i] >= 0) work_.direction[i] = shift_of(work_.pieces[model_.piece[i]]);
  }

  /// Adds what holds all pieces, and what force they are owed.
  void add_pieces(MultigridObject::Piece& sum) {
    if (!sum_pieces()) return;
    for (const MultigridObject::Piece& piece : work_.pieces) {
      for (int c = 0; c < 6; ++c) sum.held[c] += piece.held[c];
      for (int c = 0; c < 3; ++c) sum.force[c] += piece.force[c];
    }
  }

 private:
  int levels() const { return static_cast<int>(model_.levels.size()); }
  const MultigridLevel& level(int l) const { return model_.levels[l]; }
  MultigridValues& values(int l) { return work_.levels[l]; }

  template <class Body>
  void for_batches(int l, Body body) {
    const int batches = level(l).batches(), tasks = (batches + batches_per_task - 1) / batches_per_task;
    frame_.for_each_task("solve: multigrid", tasks, [&](int task) {
      body(task * batches_per_task, std::min((task + 1) * batches_per_task, batches));
    });
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

  /// Takes what a contact holds of a piece away again where both its sides are of that piece.
  void release(const PairSpring& s) {
    int piece = -2;
    for (int i = 0; i < 4; ++i) {
      const int of = s.object[i] == object_ ? model_.piece[s.particle[i]] : -1;
      if (of < 0 || (piece != -2 && of != piece)) return;
      piece = of;
    }
    const std::array<float, 6> block = block_of(s);
    for (int c = 0; c < 6; ++c) work_.pieces[piece].held[c] -= 2 * static_cast<double>(block[c]);  // a side's weights: 1
  }

  /// From what is left of the right-hand side. False where it can't be said: the only level has no anchors in its diagonal.
  bool sum_pieces() {
    if (levels() == 1 && std::count(model_.piece.begin(), model_.piece.end(), -1) > 0) return false;
    const int last = levels() - 1;
    for (int l = 1; l <= last; ++l)
      for_batches(l, [&](int f, int t) { kernels_.restrict_to(level(l), values(l), values(l - 1).right.data(), f, t); });
    const MultigridValues& coarsest = values(last);
    std::fill(work_.pieces.begin(), work_.pieces.end(), MultigridObject::Piece{});
    for (std::size_t row = 0; row < model_.coarsest_piece.size(); ++row) {
      if (model_.coarsest_piece[row] < 0) continue;
      MultigridObject::Piece& piece = work_.pieces[model_.coarsest_piece[row]];
      const int at = lane_place(static_cast<int>(row)), batch = at / batch_width;
      const float* block = coarsest.diagonal.data() + static_cast<std::ptrdiff_t>(batch) * block_floats + at % batch_width;
      for (int c = 0; c < 6; ++c) piece.held[c] += static_cast<double>(block[c * batch_width]);
      const Record& force = coarsest.right[row];
      piece.force[0] += static_cast<double>(force.x);
      piece.force[1] += static_cast<double>(force.y);
      piece.force[2] += static_cast<double>(force.z);
    }
    return true;
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
    const bool again = l + 2 < levels() && visits * level(l + 1).rows <= level(l).rows;
    for (int visit = 1; again && visit < visits; ++visit) {
      smooth(l + 1);
      cycle(l + 1);
    }
    for_batches(l, [&](int f, int t) { kernels_.prolong(level(l), values(l + 1).x.data(), v.x.data(), f, t); });
    smooth(l);
  }

  Frame& frame_;
  int object_;
  const Multigrid& model_;
  MultigridObject& work_;
  const MultigridKernels& kernels_;
};

// ---------------------------------------------------------------- multipliers

/// What the correction has made each distance constraint do, so that the sweeps go on from there: lambda = -K C h^2 after the
/// first of a substep, -K h^2 times what C has changed by after others. C as linearised: what turning lengthens a spring by is
/// no force, and the sweeps' to mend. Rigid ones need none.
void add_multipliers(const CompiledObject& object, const Segment& segment, const SweepArguments& a, const Record* change) {
  const Pool& pool = object.pools[segment.pool];
  float* multipliers = a.multipliers != nullptr ? a.multipliers[segment.pool] : nullptr;
  if (multipliers == nullptr || pool.law == Law::pbd || pool.type != index_of<Distance>(AllConstraints{})) return;
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    const std::int64_t batch = segment.first_batch + b;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      const int i = particle_of(segment, index, 0, lane), j = particle_of(segment, index, 1, lane);
      const Record &p = a.positions[i], &q = a.positions[j], &d = a.displacements[i], &e = a.displacements[j];
      const Vec3f u{(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
      const Record &from = change[i], &to = change[j];
      const Vec3f moved{to.x - from.x, to.y - from.y, to.z - from.z}, before = u - moved;
      const std::vector<float>& limits = object.multigrid.stiffness_limit;
      const float stiffness = spring_stiffness(pool.row(1, batch)[lane], max(limits[i], limits[j]));
      const float was = length(before), error = a.first_pass ? was - pool.row(0, batch)[lane] : 0;
      const float linearised = error + dot(before, moved) / max(was, 1e-30f);
      multipliers[batch * batch_width + lane] -= stiffness * linearised / a.inverse_h2;
    }
  }
}

bool keeps_distance_multipliers(const CompiledObject& object, const SweepArguments& a) {
  if (a.multipliers == nullptr) return false;
  for (std::size_t p = 0; p < object.pools.size(); ++p)
    if (a.multipliers[p] != nullptr && object.pools[p].type == index_of<Distance>(AllConstraints{})) return true;
  return false;
}

void add_multipliers(Frame& frame, int o, bool first) {
  const CompiledObject& object = frame.model().objects[o];
  const SweepArguments a = frame.arguments(o, first);
  if (!keeps_distance_multipliers(object, a)) return;
  const Record* change = frame.scratch().multigrid[o].change.data();
  frame.for_each_task("solve: multigrid", static_cast<int>(object.segments.size()),
                      [&](int s) { add_multipliers(object, object.segments[s], a, change); });
}

void clear_multipliers(Frame& frame) {
  for (auto& object : frame.workspace().multipliers)
    for (auto& values : object) std::fill(values.begin(), values.end(), 0.f);
  std::fill(frame.workspace().volume_multipliers.begin(), frame.workspace().volume_multipliers.end(), 0);
}

/// Objects that contacts join, corrected as one.
class Group {
 public:
  void add(Frame& frame, int object) {
    solves_.emplace_back(frame, object);
    objects_.push_back(object);
  }
  void add(const PairSpring& spring) { springs_.push_back(&spring); }

  void linearise(Frame& frame) {
    for (std::size_t i = 0; i < solves_.size(); ++i) solves_[i].linearise(frame.arguments(objects_[i], true));
  }

  /// Conjugate gradients; the right-hand side becomes what is left of it.
  void solve(Frame& frame, int cycles) {
    for (Solve& s : solves_) s.clear_change();
    double before = 0;
    for (int i = 0; i < cycles; ++i) {
      double now = 0;
      for (Solve& s : solves_) now += s.precondition();
      const float beta = i > 0 && before > 0 ? static_cast<float>(now / before) : 0.f;
      before = now;
      for (Solve& s : solves_) {
        if (i == 0) s.clear_direction();
        s.turn(beta);
      }
      const double curvature = apply(frame);
      if (!(curvature > 0) || !(now > 0)) break;
      for (Solve& s : solves_) s.advance(static_cast<float>(now / curvature));
    }
    for (Solve& s : solves_) s.turn_to_shifts(springs_);
    apply(frame);
    for (Solve& s : solves_) s.advance(1);
    if (solves_.size() > 1) shift_together(frame);
  }

 private:
  /// What contacts join, as one: each piece was shifted as if the others stood still.
  void shift_together(Frame& frame) {
    MultigridObject::Piece sum{};
    for (Solve& s : solves_) s.add_pieces(sum);
    for (const PairSpring* s : springs_) {
      const std::array<float, 6> block = block_of(*s);
      float side[2] = {0, 0};  // what of each moves; the rows hold both, moving together feels their difference alone
      for (int i = 0; i < 4; ++i)
        if (s->object[i] >= 0) side[s->weight[i] > 0 ? 0 : 1] += abs(s->weight[i]);
      const float free = side[0] + side[1] - (side[0] - side[1]) * (side[0] - side[1]);
      for (int c = 0; c < 6; ++c) sum.held[c] -= static_cast<double>(free * block[c]);
    }
    const Record shift = shift_of(sum);
    for (Solve& s : solves_) s.turn_to({shift.x, shift.y, shift.z});
    apply(frame);
    for (Solve& s : solves_) s.advance(1);
  }

  double apply(Frame& frame) {
    double curvature = 0;
    for (Solve& s : solves_) curvature += s.apply();
    for (const PairSpring* s : springs_) curvature += couple_pair(*s, frame.scratch().multigrid);
    return curvature;
  }

  std::vector<Solve> solves_;
  std::vector<int> objects_;
  std::vector<const PairSpring*> springs_;
};

/// Objects with levels, those that contacts join together, in the order of each group's first.
std::vector<Group> groups_of(Frame& frame) {
  const int objects = static_cast<int>(frame.model().objects.size());
  std::vector<int> root(objects), number(objects, -1);
  for (int o = 0; o < objects; ++o) root[o] = o;
  const auto find = [&](int o) {
    while (root[o] != o) o = root[o] = root[root[o]];
    return o;
  };
  const std::vector<PairSpring>& springs = frame.scratch().pair_springs;
  const auto first_of = [](const PairSpring& s) { return *std::max_element(s.object.begin(), s.object.end()); };
  for (const PairSpring& s : springs)
    for (const int o : s.object)
      if (o >= 0) root[std::max(find(o), find(first_of(s)))] = std::min(find(o), find(first_of(s)));
  std::vector<Group> groups;
  for (int o = 0; o < objects; ++o) {
    if (frame.model().objects[o].multigrid.levels.empty()) continue;
    int& group = number[find(o)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group].add(frame, o);
  }
  for (const PairSpring& s : springs) groups[number[find(first_of(s))]].add(s);
  return groups;
}

void move(Frame& frame, int o, bool first) {
  const SweepArguments a = frame.arguments(o, first);
  Records& change = frame.scratch().multigrid[o].change;
  // What is beyond the range of floats is left to the sweeps, which may cope with it or name what does not.
  const int batches = frame.model().objects[o].multigrid.levels[0].batches();
  if (!frame.kernels().all_finite(change.data(), 0, batches * batch_width))
    std::fill(change.begin(), change.end(), Record{});
  for (int i = 0; i < frame.model().objects[o].particles; ++i) {
    Record& d = a.displacements[i];
    const Record& c = change[i];
    d = {d.x + c.x, d.y + c.y, d.z + c.z, 0};
  }
  add_multipliers(frame, o, first);
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
    to.pieces.resize(static_cast<std::size_t>(model.objects[o].multigrid.pieces));
  }
}

void correct_multigrid(Frame& frame, bool first) {
  if (first) {
    clear_multipliers(frame);
    add_multigrid_contacts(frame);
    add_multigrid_pairs(frame);
  }
  for (Group& group : groups_of(frame)) {
    if (first) group.linearise(frame);
    group.solve(frame, frame.options().multigrid_cycles);
  }
  for (std::size_t o = 0; o < frame.model().objects.size(); ++o)
    if (!frame.model().objects[o].multigrid.levels.empty()) move(frame, static_cast<int>(o), first);
  if (!first) return;
  keep_multigrid_pushes(frame);
  keep_multigrid_pair_pushes(frame);
}

void iterate_multigrid(Frame& frame, bool first) {
  correct_multigrid(frame, first);
  // There and back: distances, first of all types, have the last word, and what bending pulls apart is put right again.
  iterate_tiled(frame, false);
  if (frame.has_pairs()) frame.sweep_pairs();
  frame.sweep_contacts();
  frame.sweep_straddlers(false, Order::backward);
  frame.sweep_tiles(false, Order::backward);
}

}  // namespace pliant
