#include "solver/sweeps/multigrid_solve.h"

#include <array>

namespace pliant {

namespace {

/// Jacobi passes on the coarsest level.
constexpr int coarsest_passes = 8;
/// Visits of a coarser level per visit of the next finer one, from the second level on: a W-cycle. If a level has more
/// than half of the finer rows it is visited once, because the work of a W-cycle would grow from level to level.
constexpr int visits = 2;

}  // namespace

// Solves by Cholesky's method. A piece without stiffness does not move.
Record shift_of(const MultigridObject::Piece& piece) {
  const double *a = piece.held, *b = piece.force;
  const double d0 = a[0], l1 = d0 > 0 ? a[3] / d0 : 0, l2 = d0 > 0 ? a[4] / d0 : 0;
  const double d1 = a[1] - l1 * a[3], l12 = d1 > 0 ? (a[5] - l2 * a[3]) / d1 : 0,
               d2 = a[2] - l2 * a[4] - l12 * l12 * d1;
  if (!(d0 > 0 && d1 > 0 && d2 > 0)) return {};
  const double y1 = b[1] - l1 * b[0], z = (b[2] - l2 * b[0] - l12 * y1) / d2, y = y1 / d1 - l12 * z;
  return {static_cast<float>(b[0] / d0 - l1 * y - l2 * z), static_cast<float>(y), static_cast<float>(z), 0};
}

template <class Body>
void MultigridSolve::for_batches(int l, Body body) {
  const int batches = level(l).batches(), tasks = (batches + batches_per_task - 1) / batches_per_task;
  for_tasks(s_, nullptr, tasks,
            [&](int task) { body(task * batches_per_task, std::min((task + 1) * batches_per_task, batches)); });
}

/// Sums over the batches of a level, in the order of tasks, so that the number of threads does not matter.
template <class Body>
double MultigridSolve::sum(int l, Body body) {
  const int tasks = (level(l).batches() + batches_per_task - 1) / batches_per_task;
  for_batches(
      l, [&](int first, int last) { work_.sums[first / batches_per_task] = static_cast<double>(body(first, last)); });
  double total = 0;
  for (int task = 0; task < tasks; ++task) total += work_.sums[task];
  return total;
}

void MultigridSolve::linearise(const SweepArguments& a) {
  const LinearisedAt at{a.positions, a.displacements, a.inverse_h2, work_.extra.data(), work_.has_extra.data()};
  for_batches(0, [&](int first, int last) { kernels_.linearise(level(0), at, values(0), first, last); });
  for (int l = 1; l < levels(); ++l)
    for_batches(l, [&](int first, int last) {
      kernels_.coarsen(level(l - 1), values(l - 1), l == 1, level(l), values(l), first, last);
    });
}

double MultigridSolve::precondition() {
  MultigridValues& top = values(0);
  precondition(0);
  cycle(0);
  return sum(0, [&](int f, int t) { return kernels_.dot(top.right.data(), top.x.data(), f, t); });
}

void MultigridSolve::turn(float beta) {
  for_batches(0, [&](int f, int t) { kernels_.turn(beta, values(0).x.data(), work_.direction.data(), f, t); });
}

double MultigridSolve::apply() {
  return sum(0, [&](int f, int t) {
    return kernels_.apply(level(0), values(0), true, work_.direction.data(), work_.image().data(), f, t);
  });
}

/// Batches at borders overwrite what the parallel loop wrote for them. They follow it on one thread, so where pieces
/// are so small that most batches have a border this does not scale with threads.
void MultigridSolve::apply_to_shifts() {
  const Record* direction = work_.direction.data();
  Record* image = work_.image().data();
  for_batches(0, [&](int f, int t) { kernels_.apply_diagonal(values(0), direction, image, f, t); });
  for (const int b : model_.border_batches) kernels_.apply(level(0), values(0), true, direction, image, b, b + 1);
}

void MultigridSolve::advance(float alpha) {
  for_batches(0, [&](int f, int t) {
    kernels_.advance(alpha, work_.direction.data(), work_.image().data(), work_.change.data(), values(0).right.data(),
                     f, t);
  });
}

void MultigridSolve::turn_to(const Vec3f& by) {
  for (std::size_t i = 0; i < model_.piece.size(); ++i)
    work_.direction[i] = model_.piece[i] >= 0 ? Record{by.x, by.y, by.z, 0} : Record{};
}

void MultigridSolve::turn_to_shifts(const std::vector<const PairSpring*>& springs) {
  clear_direction();
  if (!sum_pieces()) return;
  for (const PairSpring* s : springs) release(*s);
  for (MultigridObject::Piece& piece : work_.pieces) piece.shift = shift_of(piece);
  for (std::size_t i = 0; i < model_.piece.size(); ++i)
    if (model_.piece[i] >= 0) work_.direction[i] = work_.pieces[model_.piece[i]].shift;
}

void MultigridSolve::turn_to_motion(const Record* displacements) {
  clear_direction();
  for (MultigridObject::Piece& piece : work_.pieces) piece.moment = {}, piece.mass = 0;
  const Record* positions = arguments(s_, object_, false).positions;
  const std::vector<std::int32_t>& pieces = model_.piece;
  for (std::size_t i = 0; i < pieces.size();) {
    const std::int32_t number = pieces[i];
    if (number < 0) {
      ++i;
      continue;
    }
    // Sums in registers: neighbouring particles mostly belong to one piece.
    MultigridObject::Piece& piece = work_.pieces[number];
    Vec3d moment = piece.moment;
    double sum = piece.mass;
    for (; i < pieces.size() && pieces[i] == number; ++i) {
      const Record &d = displacements[i], &c = work_.change[i];
      const Record moved{d.x + c.x, d.y + c.y, d.z + c.z, 0};
      const double mass = static_cast<double>(1 / positions[i].w);
      moment += Vec3d{static_cast<double>(moved.x), static_cast<double>(moved.y), static_cast<double>(moved.z)} * mass;
      sum += mass;
      work_.direction[i] = moved;
    }
    piece.moment = moment, piece.mass = sum;
  }
  for (MultigridObject::Piece& piece : work_.pieces) {
    const Vec3f mean = convert<float>(piece.moment * (1 / std::max(piece.mass, 1e-300)));
    piece.shift = {mean.x, mean.y, mean.z, 0};
  }
  for (std::size_t i = 0; i < model_.piece.size(); ++i) {
    if (model_.piece[i] < 0) continue;
    const Record& mean = work_.pieces[model_.piece[i]].shift;
    Record& p = work_.direction[i];
    p = {p.x - mean.x, p.y - mean.y, p.z - mean.z, 0};
  }
}

double MultigridSolve::residual_along() {
  return sum(0, [&](int f, int t) { return kernels_.dot(values(0).right.data(), work_.direction.data(), f, t); });
}

void MultigridSolve::add_pieces(MultigridObject::Piece& sum) {
  if (!sum_pieces()) return;
  for (const MultigridObject::Piece& piece : work_.pieces) {
    for (int c = 0; c < 6; ++c) sum.held[c] += piece.held[c];
    for (int c = 0; c < 3; ++c) sum.force[c] += piece.force[c];
  }
}

// Subtracts a contact's stiffness from the stiffness of a piece if both sides belong to that piece.
void MultigridSolve::release(const PairSpring& s) {
  int piece = -2;
  for (int i = 0; i < 4; ++i) {
    const int of = s.object[i] == object_ ? model_.piece[s.particle[i]] : -1;
    if (of < 0 || (piece != -2 && of != piece)) return;
    piece = of;
  }
  const std::array<float, 6> block = block_of(s);
  for (int c = 0; c < 6; ++c)
    work_.pieces[piece].held[c] -= 2 * static_cast<double>(block[c]);  // weights sum to 1 a side
}

// Sums stiffness and residual of each piece. Returns false if undefined: the only level has no anchors in its diagonal.
bool MultigridSolve::sum_pieces() {
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
    const float* block =
        coarsest.diagonal.data() + static_cast<std::ptrdiff_t>(batch) * block_floats + at % batch_width;
    for (int c = 0; c < 6; ++c) piece.held[c] += static_cast<double>(block[c * batch_width]);
    const Record& force = coarsest.right[row];
    piece.force[0] += static_cast<double>(force.x);
    piece.force[1] += static_cast<double>(force.y);
    piece.force[2] += static_cast<double>(force.z);
  }
  return true;
}

void MultigridSolve::precondition(int l) {
  MultigridValues& v = values(l);
  for_batches(l, [&](int f, int t) { kernels_.precondition(v, v.right.data(), v.x.data(), f, t); });
}

void MultigridSolve::smooth(int l) {
  MultigridValues& v = values(l);
  for_batches(
      l, [&](int f, int t) { kernels_.smooth(level(l), v, l == 0, v.right.data(), v.x.data(), v.y.data(), f, t); });
  std::swap(v.x, v.y);
}

// One multigrid cycle from level l on, with a Jacobi pass before and after. x must hold the preconditioned right-hand
// side.
void MultigridSolve::cycle(int l) {
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

}  // namespace pliant
