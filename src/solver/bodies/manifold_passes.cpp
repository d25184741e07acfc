#include "solver/bodies/manifold_passes.h"

#include <cstddef>
#include <cstring>

#include "solver/bodies/manifold_formulas.h"
#include "solver/bodies/manifold_kernels.h"

namespace pliant {

namespace formulas = manifold_formulas;

namespace {

using ManifoldRow = ManifoldRows<1>;

/// Two bodies, as formulas need them.
struct Pair {
  formulas::Motion<float> a, b;
  formulas::Moved<float> moved_a, moved_b;
};

formulas::Motion<float> motion_of(const BodyMotion& body) {
  formulas::Motion<float> out{body.velocity, body.spin, body.inverse_mass, {}};
  std::memcpy(out.inverse_inertia, body.inverse_inertia.data(), sizeof out.inverse_inertia);
  return out;
}

Pair pair_of(const BodyMotion& a, const BodyMotion& b) {
  return {motion_of(a), motion_of(b), {a.displacement, a.rotation}, {b.displacement, b.rotation}};
}

void store(const formulas::Motion<float>& from, BodyMotion& body) {
  body.velocity = from.velocity;
  body.spin = from.spin;
}

// ---------------------------------------------------------------- passes over one row

struct Prepare {
  void operator()(ManifoldRow& row, Pair& p) const { formulas::prepare(row, p.a, p.b); }
};
struct WarmStart {
  void operator()(ManifoldRow& row, Pair& p) const {
    formulas::warm_start(row, p.a, p.b);
    if (row.rolling[0] > 0) formulas::warm_start_rolling(row, p.a, p.b);
  }
};
struct Bounce {
  float h;
  Vec3f fall;
  bool* bounced;
  void operator()(ManifoldRow& row, Pair& p) const {
    if (formulas::bounce(row, p.a, p.b, p.moved_a, p.moved_b, h, fall)) *bounced = true;
  }
};
struct PositionPass {
  PassNumbers numbers;
  void operator()(ManifoldRow& row, Pair& p) const {
    if (row.rolling[0] > 0) formulas::resist_rolling(row, p.a, p.b);
    formulas::position_pass(row, p.a, p.b, p.moved_a, p.moved_b, numbers);
  }
};
struct VelocityPass {
  PassNumbers numbers;
  void operator()(ManifoldRow& row, Pair& p) const {
    if (row.rolling[0] > 0) formulas::resist_rolling(row, p.a, p.b);
    formulas::velocity_pass(row, p.a, p.b, numbers);
    if (row.settles[0] > 0) formulas::settle(row, p.a, p.b, numbers);
  }
};

// ---------------------------------------------------------------- one manifold

ManifoldRow gather_row(const Manifold& m) {
  ManifoldRow row;
  put_manifold(m, row, 0);
  std::memcpy(row.mobility, m.mobility.data(), sizeof row.mobility);
  std::memcpy(row.mass, m.mass.data(), sizeof row.mass);
  std::memcpy(row.slide, m.slide.data(), sizeof row.slide);
  row.twist_mass[0] = m.twist_mass;
  row.twist_arm[0] = m.twist_arm;
  return row;
}

template <class Pass>
ManifoldRow run(const Manifold& m, BodyMotion& a, BodyMotion& b, const Pass& pass) {
  ManifoldRow row = gather_row(m);
  Pair pair = pair_of(a, b);
  pass(row, pair);
  store(pair.a, a);
  store(pair.b, b);
  return row;
}

// ---------------------------------------------------------------- blocks, lane after lane

constexpr std::size_t row_count = sizeof(ManifoldRow) / sizeof(float);
static_assert(sizeof(ManifoldRows<16>) == 16 * sizeof(ManifoldRow), "a lane of a block is every sixteenth float");

template <class Pass>
void run_lane(ManifoldBlock& block, int lane, BodyMotion* motions, const Pass& pass) {
  float* const first = reinterpret_cast<float*>(&block.rows) + lane;
  float values[row_count];
  ManifoldRow row;
  for (std::size_t i = 0; i < row_count; ++i) values[i] = first[16 * i];
  std::memcpy(&row, values, sizeof row);
  BodyMotion &a = motions[block.a[lane] / records_a_motion], &b = motions[block.b[lane] / records_a_motion];
  Pair pair = pair_of(a, b);
  pass(row, pair);
  if ((block.moves_a >> lane & 1) != 0) store(pair.a, a);
  if ((block.moves_b >> lane & 1) != 0) store(pair.b, b);
  std::memcpy(values, &row, sizeof row);
  for (std::size_t i = 0; i < row_count; ++i) first[16 * i] = values[i];
}

template <class Pass>
void run(const BlockRange& range, const Pass& pass) {
  for (ManifoldBlock* block = range.first; block != range.last; ++block)
    for (int lane = 0; lane < block->lanes; ++lane) run_lane(*block, lane, range.motions, pass);
}

void prepare_blocks(const BlockRange& range) { run(range, Prepare{}); }
void warm_start_blocks(const BlockRange& range) { run(range, WarmStart{}); }
bool bounce_blocks(const BlockRange& range, float h, const Vec3f& fall) {
  bool bounced = false;
  run(range, Bounce{h, fall, &bounced});
  return bounced;
}
void position_pass_blocks(const BlockRange& range, const PassNumbers& numbers) { run(range, PositionPass{numbers}); }
void velocity_pass_blocks(const BlockRange& range, const PassNumbers& numbers) { run(range, VelocityPass{numbers}); }

}  // namespace

void prepare(Manifold& m, const BodyMotion& a, const BodyMotion& b) {
  BodyMotion of_a = a, of_b = b;
  const ManifoldRow row = run(m, of_a, of_b, Prepare{});
  std::memcpy(m.mobility.data(), row.mobility, sizeof row.mobility);
  std::memcpy(m.mass.data(), row.mass, sizeof row.mass);
  std::memcpy(m.slide.data(), row.slide, sizeof row.slide);
  m.twist_mass = row.twist_mass[0];
  m.twist_arm = row.twist_arm[0];
}

void warm_start(const Manifold& m, BodyMotion& a, BodyMotion& b) { run(m, a, b, WarmStart{}); }

bool bounce(Manifold& m, BodyMotion& a, BodyMotion& b, float h, const Vec3f& fall) {
  bool bounced = false;
  if (m.restitution > 0) take_impulses(run(m, a, b, Bounce{h, fall, &bounced}), 0, m);
  return bounced;
}

void position_pass(Manifold& m, BodyMotion& a, BodyMotion& b, float h, const ContactSoftness& softness) {
  take_impulses(run(m, a, b, PositionPass{pass_numbers(h, softness)}), 0, m);
}

void velocity_pass(Manifold& m, BodyMotion& a, BodyMotion& b, float h) {
  take_impulses(run(m, a, b, VelocityPass{pass_numbers(h, {})}), 0, m);
}

const ManifoldKernels& manifold_kernels_sequential() {
  static constexpr ManifoldKernels table{&prepare_blocks, &warm_start_blocks, &bounce_blocks, &position_pass_blocks,
                                         &velocity_pass_blocks};
  return table;
}

}  // namespace pliant
