// The multigrid correction in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp. Each
// lane is a matrix row; no row writes what another reads, so batches may run in any order.
#include "math/vector.h"
#include "math/wide.h"
#include "solver/sweeps/multigrid_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// Damping factor of Jacobi passes.
constexpr float damping = 0.65f;
/// Factor of coarse blocks. Summed springs are too stiff by the width of a group: two particles in each of two
/// directions.
constexpr float coarse_stiffness = 0.5f;
/// Regularisation of a diagonal block's inverse against rounding, as a share of its trace.
constexpr float least_share = 1e-6f;
/// Lower limit of the determinant of a block divided by its trace. Below it the determinant is rounding error.
constexpr float least_determinant = 1e-20f;

/// A symmetric 3 x 3 block in each lane.
struct Block {
  Wide xx, yy, zz, xy, xz, yz;
};

PLIANT_HD Block operator+(const Block& a, const Block& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

PLIANT_HD Vec3<Wide> operator*(const Block& b, const Vec3<Wide>& v) {
  return {b.xx * v.x + b.xy * v.y + b.xz * v.z, b.xy * v.x + b.yy * v.y + b.yz * v.z,
          b.xz * v.x + b.yz * v.y + b.zz * v.z};
}

PLIANT_HD Block load_block(const float* from) {
  return {load_wide(from),      load_wide(from + 16), load_wide(from + 32),
          load_wide(from + 48), load_wide(from + 64), load_wide(from + 80)};
}

PLIANT_HD void store_block(float* to, const Block& b) {
  store_wide(to, b.xx);
  store_wide(to + 16, b.yy);
  store_wide(to + 32, b.zz);
  store_wide(to + 48, b.xy);
  store_wide(to + 64, b.xz);
  store_wide(to + 80, b.yz);
}

PLIANT_HD Block block_of(const Vec3<Wide>& g, const Wide& k) {
  return {g.x * g.x + k, g.y * g.y + k, g.z * g.z + k, g.x * g.y, g.x * g.z, g.y * g.z};
}

PLIANT_HD Block operator*(const Block& b, const Wide& s) {
  return {b.xx * s, b.yy * s, b.zz * s, b.xy * s, b.xz * s, b.yz * s};
}

/// The damped inverse of a block by cofactors; zero in lanes of fixed rows. The block is first divided by its trace, so
/// that no product overflows in any system of units.
PLIANT_HD Block damped_inverse(const Block& block, const WideMask& moves) {
  const Wide scale = Wide(1.f) / max(block.xx + block.yy + block.zz, Wide(1e-30f));
  const Block b = block * scale;
  const Wide xx = b.xx + Wide(least_share), yy = b.yy + Wide(least_share), zz = b.zz + Wide(least_share);
  const Wide c0 = yy * zz - b.yz * b.yz, c1 = b.xz * b.yz - b.xy * zz, c2 = b.xy * b.yz - b.xz * yy;
  const Wide determinant = xx * c0 + b.xy * c1 + b.xz * c2;
  const WideMask regular = determinant > Wide(least_determinant);
  const Wide zero(0.f), inverse = Wide(damping) / max(determinant, Wide(least_determinant)) * scale;
  const Wide s = select(moves, select(regular, inverse, zero), zero);
  return {c0 * s, (xx * zz - b.xz * b.xz) * s,  (xx * yy - b.xy * b.xy) * s, c1 * s,
          c2 * s, (b.xy * b.xz - xx * b.yz) * s};
}

PLIANT_HD Registers load_rows(const Record* from, int batch) {
  const std::int32_t runs[4] = {16 * batch, 16 * batch + 4, 16 * batch + 8, 16 * batch + 12};
  return load_runs(from, runs);
}
PLIANT_HD void store_records(Record* to, int batch, const WideRecords& v) {
  const std::int32_t runs[4] = {16 * batch, 16 * batch + 4, 16 * batch + 8, 16 * batch + 12};
  store_runs(to, runs, to_registers(v), 4);
}
PLIANT_HD void store_rows(Record* to, int batch, const Vec3<Wide>& v) { store_records(to, batch, {v, Wide(0.f)}); }
PLIANT_HD Vec3<Wide> load_vectors(const Record* from, int batch) {
  return from_registers(load_rows(from, batch)).position;
}

// ---------------------------------------------------------------- the matrix

/// For each row of a batch: the sum over its slots of block times (x of the row - x of the neighbour).
template <bool springs>
PLIANT_HD Vec3<Wide> couple(const MultigridLevel& level, const MultigridValues& values, int batch, const Record* x) {
  const Registers own = load_rows(x, batch);
  const Wide zero(0.f);
  Vec3<Wide> sum{zero, zero, zero};
  for (int slot = level.first_slot.data()[batch]; slot < level.first_slot.data()[batch + 1]; ++slot) {
    const std::ptrdiff_t s = slot;
    const Vec3<Wide> u = from_registers(own - load_indexed(x, level.column.data() + s * batch_width)).position;
    if constexpr (springs) {
      const float* from = values.blocks.data() + s * spring_floats;
      const Vec3<Wide> g{load_wide(from), load_wide(from + 16), load_wide(from + 32)};
      sum += g * dot(g, u) + u * load_wide(from + 48);
    } else {
      sum += load_block(values.blocks.data() + s * block_floats) * u;
    }
  }
  return sum;
}

template <bool springs>
PLIANT_HD Vec3<Wide> image(const MultigridLevel& level, const MultigridValues& values, int batch, const Record* x) {
  const std::ptrdiff_t b = batch;
  return couple<springs>(level, values, batch, x) +
         load_block(values.diagonal.data() + b * block_floats) * load_vectors(x, batch);
}

template <bool springs>
PLIANT_HD void residuals(const MultigridLevel& level, const MultigridValues& values, const Record* right,
                         const Record* x, Record* out, int first, int last) {
  for (int b = first; b < last; ++b) store_rows(out, b, load_vectors(right, b) - image<springs>(level, values, b, x));
}

template <bool springs>
PLIANT_HD void smooths(const MultigridLevel& level, const MultigridValues& values, const Record* right, const Record* x,
                       Record* out, int first, int last) {
  for (int b = first; b < last; ++b) {
    const Vec3<Wide> rest = load_vectors(right, b) - image<springs>(level, values, b, x);
    const Block inverse = load_block(values.inverse.data() + static_cast<std::ptrdiff_t>(b) * block_floats);
    store_rows(out, b, load_vectors(x, b) + inverse * rest);
  }
}

PLIANT_HD float sum_lanes(const Wide& a) {
  float lane[wide_width], sum = 0;
  store_wide(lane, a);
  for (const float value : lane) sum += value;
  return sum;
}

template <bool springs>
PLIANT_HD float applies(const MultigridLevel& level, const MultigridValues& values, const Record* x, Record* out,
                        int first, int last) {
  Wide sum(0.f);
  for (int b = first; b < last; ++b) {
    const Vec3<Wide> y = image<springs>(level, values, b, x);
    sum += dot(load_vectors(x, b), y);
    store_rows(out, b, y);
  }
  return sum_lanes(sum);
}

void residual(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
              const Record* x, Record* out, int first, int last) {
  springs ? residuals<true>(level, values, right, x, out, first, last)
          : residuals<false>(level, values, right, x, out, first, last);
}

void smooth(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
            const Record* x, Record* out, int first, int last) {
  springs ? smooths<true>(level, values, right, x, out, first, last)
          : smooths<false>(level, values, right, x, out, first, last);
}

float apply(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* x, Record* out,
            int first, int last) {
  return springs ? applies<true>(level, values, x, out, first, last)
                 : applies<false>(level, values, x, out, first, last);
}

void apply_diagonal(const MultigridValues& values, const Record* x, Record* out, int first, int last) {
  const Wide zero(0.f);
  for (int b = first; b < last; ++b) {
    const Block diagonal = load_block(values.diagonal.data() + static_cast<std::ptrdiff_t>(b) * block_floats);
    store_rows(out, b, Vec3<Wide>{zero, zero, zero} + diagonal * load_vectors(x, b));
  }
}

// ---------------------------------------------------------------- assembly

struct Linearised {
  Block diagonal, whole;
  Vec3<Wide> force;
  WideMask moves;
};

/// Starts the rows of a batch with inertia and contacts.
PLIANT_HD Linearised begin_rows(const WideRecords& position, int batch, const LinearisedAt& at) {
  const Wide zero(0.f);
  Linearised row;
  row.moves = position.w > zero;
  const Wide inertia = select(row.moves, Wide(at.inverse_h2) / max(position.w, Wide(1e-30f)), Wide(1.f));
  row.diagonal = {inertia, inertia, inertia, zero, zero, zero};
  row.force = {zero, zero, zero};
  if (at.has_extra[batch] != 0) {
    const float* extra = at.extra + static_cast<std::ptrdiff_t>(batch) * 9 * batch_width;
    row.diagonal = row.diagonal + load_block(extra);
    row.force += Vec3<Wide>{load_wide(extra + 96), load_wide(extra + 112), load_wide(extra + 128)};
  }
  row.whole = row.diagonal;
  return row;
}

/// Adds a spring of energy K C^2 / 2, and returns its g and k: its stiffness matrix is (K - k) n n^T + k I, with k = K
/// C / length if stretched, else 0. k is the geometric stiffness, without which a taut sheet has no resistance normal
/// to its plane.
PLIANT_HD WideRecords add_spring(const Vec3<Wide>& u, const Wide& stiffness, const Wide& rest, float* block,
                                 Linearised& row) {
  const Wide zero(0.f), length = sqrt(dot(u, u)), inverse = Wide(1.f) / max(length, Wide(1e-20f));
  const Wide tension = stiffness * (length - rest);
  const Vec3<Wide> n = u * inverse;
  const Wide across = max(tension, zero) * inverse;
  const Vec3<Wide> g = n * sqrt(max(stiffness - across, zero));
  store_wide(block, g.x);
  store_wide(block + 16, g.y);
  store_wide(block + 32, g.z);
  store_wide(block + 48, across);
  row.whole = row.whole + block_of(g, across);
  row.force -= n * tension;
  return {g, across};
}

void linearise(const MultigridLevel& level, const LinearisedAt& at, MultigridValues& values, int first, int last) {
  for (int b = first; b < last; ++b) {
    const std::ptrdiff_t batch = b;
    std::int32_t self[wide_width];
    for (int lane = 0; lane < wide_width; ++lane) {
      const int row = row_of(b, lane);
      self[lane] = row < level.rows ? row : level.rows - 1;
    }
    const Registers own = load_indexed(at.positions, self), moved = load_indexed(at.displacements, self);
    Linearised row = begin_rows(from_registers(own), b, at);
    for (std::ptrdiff_t s = level.first_slot.data()[b]; s < level.first_slot.data()[b + 1]; ++s) {
      const std::int32_t* column = level.column.data() + s * batch_width;
      const Registers across =
          without_w(own - load_indexed(at.positions, column)) + (moved - load_indexed(at.displacements, column));
      const WideRecords spring = add_spring(
          from_registers(across).position, load_wide(level.stiffness.data() + s * batch_width),
          load_wide(level.rest_length.data() + s * batch_width), values.blocks.data() + s * spring_floats, row);
      if (!values.terms.empty()) store_records(values.terms.data(), static_cast<int>(s), spring);
    }
    // Lanes beyond the last row repeat its position and have no springs, so their force is zero.
    const Wide zero(0.f);
    store_block(values.diagonal.data() + batch * block_floats, row.diagonal);
    store_block(values.inverse.data() + batch * block_floats, damped_inverse(row.whole, row.moves));
    store_rows(values.right.data(), b,
               {select(row.moves, row.force.x, zero), select(row.moves, row.force.y, zero),
                select(row.moves, row.force.z, zero)});
  }
}

/// Adds one block of a finer level to `sum` (xx yy zz xy xz yz); `at` is 16 x slot + lane.
PLIANT_HD void add_source(const MultigridValues& from, bool from_springs, std::int32_t at, float (&sum)[6]) {
  const std::ptrdiff_t slot = at / wide_width, lane = at % wide_width;
  if (!from_springs) {
    const float* block = from.blocks.data() + slot * block_floats + lane;
    for (int c = 0; c < 6; ++c) sum[c] += block[c * wide_width];
    return;
  }
  const float* spring = from.blocks.data() + slot * spring_floats + lane;
  const float x = spring[0], y = spring[16], z = spring[32], k = spring[48];
  sum[0] += x * x + k;
  sum[1] += y * y + k;
  sum[2] += z * z + k;
  sum[3] += x * y;
  sum[4] += x * z;
  sum[5] += y * z;
}

/// The diagonal block of a coarse row: the sum of the diagonal blocks and anchors of its members.
PLIANT_HD void add_members(const MultigridLevel& fine, const MultigridValues& from, bool from_springs,
                           const MultigridLevel& level, std::ptrdiff_t batch, int lane, float* diagonal) {
  float sum[6] = {};
  for (std::ptrdiff_t member = 0; member < largest_group; ++member) {
    const std::int32_t row = level.children.data()[(batch * largest_group + member) * wide_width + lane];
    if (row == fine.nothing()) continue;
    const int at = lane_place(row);
    const float* block =
        from.diagonal.data() + static_cast<std::ptrdiff_t>(at / wide_width) * block_floats + at % wide_width;
    for (int c = 0; c < 6; ++c) sum[c] += block[c * wide_width];
  }
  const std::ptrdiff_t key = batch * wide_width + lane;
  for (std::int32_t i = level.anchor_begin.data()[key]; i < level.anchor_begin.data()[key + 1]; ++i)
    add_source(from, from_springs, level.anchors.data()[i], sum);
  for (int c = 0; c < 6; ++c) diagonal[c * wide_width + lane] = sum[c];
}

/// Sums the blocks of a finer level that form the blocks of a slot.
template <bool springs>
PLIANT_HD Block sum_slot(const MultigridValues& from, const MultigridLevel& level, std::ptrdiff_t slot) {
  const Wide zero(0.f);
  const Record* terms = from.terms.data();
  const std::ptrdiff_t half = static_cast<std::ptrdiff_t>(from.terms.size()) / 2;
  Block sum{zero, zero, zero, zero, zero, zero};
  for (std::ptrdiff_t r = level.first_round.data()[slot]; r < level.first_round.data()[slot + 1]; ++r) {
    const std::int32_t* at = level.sources.data() + r * batch_width;
    const WideRecords first = from_registers(load_indexed(terms, at));
    if constexpr (springs) {
      sum = sum + block_of(first.position, first.w);
    } else {
      const Vec3<Wide> second = from_registers(load_indexed(terms + half, at)).position;
      sum = sum + Block{first.position.x, first.position.y, first.position.z, first.w, second.x, second.y};
    }
  }
  return sum;
}

/// Stores the block of a slot, for products and for sums of the next level.
PLIANT_HD void store_slot(const Block& block, std::ptrdiff_t slot, MultigridValues& values) {
  store_block(values.blocks.data() + slot * block_floats, block);
  if (values.terms.empty()) return;
  const Wide zero(0.f);
  const int at = static_cast<int>(slot);
  store_records(values.terms.data(), at, {{block.xx, block.yy, block.zz}, block.xy});
  store_rows(values.terms.data() + values.terms.size() / 2, at, Vec3<Wide>{block.xz, block.yz, zero});
}

void coarsen(const MultigridLevel& fine, const MultigridValues& from, bool from_springs, const MultigridLevel& level,
             MultigridValues& values, int first, int last) {
  for (std::ptrdiff_t b = first; b < last; ++b) {
    float* diagonal = values.diagonal.data() + b * block_floats;
    for (int lane = 0; lane < wide_width; ++lane) add_members(fine, from, from_springs, level, b, lane, diagonal);
    Block whole = load_block(diagonal);
    for (std::ptrdiff_t s = level.first_slot.data()[b]; s < level.first_slot.data()[b + 1]; ++s) {
      const Block block =
          (from_springs ? sum_slot<true>(from, level, s) : sum_slot<false>(from, level, s)) * Wide(coarse_stiffness);
      store_slot(block, s, values);
      whole = whole + block;
    }
    store_block(values.inverse.data() + b * block_floats, damped_inverse(whole, whole.xx > Wide(0.f)));
  }
}

// ---------------------------------------------------------------- between levels

PLIANT_HD Vec3<Wide> precondition_batch(const MultigridValues& values, const Vec3<Wide>& right, int b) {
  return load_block(values.inverse.data() + static_cast<std::ptrdiff_t>(b) * block_floats) * right;
}

void precondition(const MultigridValues& values, const Record* right, Record* out, int first, int last) {
  for (int b = first; b < last; ++b) store_rows(out, b, precondition_batch(values, load_vectors(right, b), b));
}

void restrict_to(const MultigridLevel& level, MultigridValues& values, const Record* residual, int first, int last) {
  for (int b = first; b < last; ++b) {
    const std::int32_t* child = level.children.data() + static_cast<std::ptrdiff_t>(b) * largest_group * wide_width;
    const Registers sum = (load_indexed(residual, child) + load_indexed(residual, child + 16)) +
                          (load_indexed(residual, child + 32) + load_indexed(residual, child + 48));
    const Vec3<Wide> right = from_registers(sum).position;
    store_rows(values.right.data(), b, right);
    store_rows(values.x.data(), b, precondition_batch(values, right, b));
  }
}

void prolong(const MultigridLevel& level, const Record* coarse, Record* x, int first, int last) {
  for (int b = first; b < last; ++b) {
    const std::int32_t runs[4] = {16 * b, 16 * b + 4, 16 * b + 8, 16 * b + 12};
    const std::int32_t* parent = level.parent.data() + static_cast<std::ptrdiff_t>(b) * wide_width;
    store_runs(x, runs, load_runs(x, runs) + load_indexed(coarse, parent), 4);
  }
}

// ---------------------------------------------------------------- vectors

float dot_records(const Record* a, const Record* b, int first, int last) {
  Wide sum(0.f);
  for (int i = first; i < last; ++i) sum += dot(load_vectors(a, i), load_vectors(b, i));
  return sum_lanes(sum);
}

PLIANT_HD Wide load_flat(const Record* from, int at) {
  Wide r;
  std::memcpy(&r, from + at, sizeof r);
  return r;
}
PLIANT_HD void store_flat(Record* to, int at, const Wide& a) { std::memcpy(static_cast<void*>(to + at), &a, sizeof a); }

void turn(float beta, const Record* z, Record* direction, int first, int last) {
  for (int i = 16 * first; i < 16 * last; i += 4)
    store_flat(direction, i, load_flat(z, i) + Wide(beta) * load_flat(direction, i));
}

void advance(float alpha, const Record* direction, const Record* image, Record* solution, Record* right, int first,
             int last) {
  for (int i = 16 * first; i < 16 * last; i += 4) {
    store_flat(solution, i, load_flat(solution, i) + Wide(alpha) * load_flat(direction, i));
    store_flat(right, i, load_flat(right, i) - Wide(alpha) * load_flat(image, i));
  }
}

}  // namespace
}  // namespace PLIANT_ISA

const MultigridKernels& PLIANT_OF_LEVEL(multigrid_kernels)() {
  static constexpr MultigridKernels table{&linearise, &coarsen,     &precondition,   &residual,
                                          &smooth,    &apply,       &apply_diagonal, &restrict_to,
                                          &prolong,   &dot_records, &turn,           &advance};
  return table;
}

}  // namespace pliant
