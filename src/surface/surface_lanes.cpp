// The inner loops of the surface in SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
//
// Sums over neighbours have sixteen partial sums on every level, and these are added in one order, so all levels give
// the same bits.
#include "math/pack_lanes.h"
#include "math/wide.h"
#include "surface/splat_formula.h"
#include "surface/surface_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

using namespace surface;

PLIANT_HD void store_part(float* to, const Part& a) { std::memcpy(to, &a, sizeof a); }
PLIANT_HD Part abs_part(const Part& a) { return (Part)((PartMask)a & 0x7fffffff); }

// ---------------------------------------------------------------- moments

/// The sums of the lanes of four values, as a quad.
PLIANT_HD Quad sums_of(const Wide& first, const Wide& second, const Wide& third, const Wide& fourth) {
  Wide sums;
  PLIANT_EACH_PART({
    Part a = first.part[i], b = second.part[i], c = third.part[i], d = fourth.part[i];
    transpose(a, b, c, d);
    sums.part[i] = (a + b) + (c + d);
  })
  Quad q[4];
  static_assert(sizeof q == sizeof sums);
  std::memcpy(q, &sums, sizeof q);
  return (q[0] + q[1]) + (q[2] + q[3]);
}

PLIANT_HD void add_to(Record& to, const Quad& sum) {
  const Quad all = load_quad(&to) + sum;
  std::memcpy(static_cast<void*>(&to), &all, sizeof all);
}

/// Adds the candidates in the scratch memory to the moments of a particle.
PLIANT_HD void add_moments(const MomentScratch& s, int candidates, const MomentQuery& q, int particle, Moments& to) {
  Wide sum, x, y, z, xx, yy, zz, xy, xz, yz;
  const Part at_x = all_lanes(q.at.x[particle]), at_y = all_lanes(q.at.y[particle]), at_z = all_lanes(q.at.z[particle]);
  const Part one = all_lanes(1), per_squared = all_lanes(1 / (q.radius * q.radius));
  for (int i = 0; i < wide_parts; ++i) {
    Part p0{}, px{}, py{}, pz{}, pxx{}, pyy{}, pzz{}, pxy{}, pxz{}, pyz{};
    for (int k = i * part_width; k < candidates; k += wide_width) {
      const Part dx = load_part(s.x + k) - at_x, dy = load_part(s.y + k) - at_y, dz = load_part(s.z + k) - at_z;
      const Part w = max_part(one - (dx * dx + dy * dy + dz * dz) * per_squared, Part{});
      const Part wx = w * dx, wy = w * dy, wz = w * dz;
      p0 += w, px += wx, py += wy, pz += wz;
      pxx += wx * dx, pyy += wy * dy, pzz += wz * dz;
      pxy += wx * dy, pxz += wx * dz, pyz += wy * dz;
    }
    sum.part[i] = p0, x.part[i] = px, y.part[i] = py, z.part[i] = pz;
    xx.part[i] = pxx, yy.part[i] = pyy, zz.part[i] = pzz;
    xy.part[i] = pxy, xz.part[i] = pxz, yz.part[i] = pyz;
  }
  add_to(to.first, sums_of(x, y, z, sum));
  add_to(to.second, sums_of(xx, yy, zz, xy));
  add_to(to.third, sums_of(xz, yz, Wide(0), Wide(0)));
}

/// Adds the candidates to the moments of all particles of a query.
PLIANT_HD void add_candidates(const MomentQuery& q, int candidates, const MomentScratch& s, Moments* to) {
  for (int particle = q.first; particle < q.last; ++particle)
    add_moments(s, candidates, q, particle, to[particle - q.first]);
}

/// Adds all that there is room for, and moves the rest to the front. How many are added at a time does not depend on
/// the level.
PLIANT_HD int make_room(const MomentQuery& q, int candidates, MomentScratch& s, Moments* to) {
  if (candidates < most_candidates) return candidates;
  add_candidates(q, most_candidates, s, to);
  for (float* const row : {s.x, s.y, s.z}) std::memcpy(row, row + most_candidates, sizeof(Part));
  return candidates - most_candidates;
}

/// Adds the last candidates. The last registers are filled with places that are near to none.
PLIANT_HD void add_rest(const MomentQuery& q, int candidates, MomentScratch& s, Moments* to) {
  const Part nowhere = all_lanes(1e18f);
  for (int i = 0; i < wide_width; i += part_width)
    for (float* const row : {s.x, s.y, s.z}) store_part(row + candidates + i, nowhere);
  add_candidates(q, candidates, s, to);
}

PLIANT_HD Box box_of(const MomentQuery& q) {
  Box box{{q.at.x[q.first], q.at.y[q.first], q.at.z[q.first]}, {q.at.x[q.first], q.at.y[q.first], q.at.z[q.first]}};
  for (int i = q.first + 1; i < q.last; ++i) {
    const Vec3f at{q.at.x[i], q.at.y[i], q.at.z[i]};
    box = {min(box.low, at), max(box.high, at)};
  }
  return box;
}

/// Packs the particles near the box of the query's, and compares these with them. The reach is a little larger, for
/// rounding.
void find_moments(const MomentQuery& q, MomentScratch& s, Moments* to) {
  std::memset(static_cast<void*>(to), 0, static_cast<std::size_t>(q.last - q.first) * sizeof(Moments));
  const Box box = box_of(q);
  const Part low_x = all_lanes(box.low.x), low_y = all_lanes(box.low.y), low_z = all_lanes(box.low.z);
  const Part high_x = all_lanes(box.high.x), high_y = all_lanes(box.high.y), high_z = all_lanes(box.high.z);
  const Part reach2 = all_lanes(q.radius * q.radius * 1.0001f);
  int count = 0;
  for (int r = 0; r < q.range_count; ++r) {
    const int last = q.around[r].last;
    for (int i = q.around[r].first; i < last; i += part_width) {
      const Part x = load_part(q.at.x + i), y = load_part(q.at.y + i), z = load_part(q.at.z + i);
      const Part dx = beyond(x, low_x, high_x), dy = beyond(y, low_y, high_y), dz = beyond(z, low_z, high_z);
      const std::uint32_t bits = bits_at_most(dx * dx + dy * dy + dz * dz, reach2) & first_bits(last - i);
      const Packing packing(bits);
      packing.store(s.x + count, (PartMask)x);
      packing.store(s.y + count, (PartMask)y);
      packing.store(s.z + count, (PartMask)z);
      count = make_room(q, count + count_bits(bits), s, to);
    }
  }
  add_rest(q, count, s, to);
}

// ---------------------------------------------------------------- kernels

/// The first `lanes` lanes of a value.
PLIANT_HD void store_some(float* to, const Wide& a, int lanes) {
  std::memcpy(to, &a, static_cast<std::size_t>(lanes) * sizeof(float));
}

/// The rows of a quarter of sixteen kernels.
PLIANT_HD void store_quarter(Splat* to, int quarter, const Wide& a, const Wide& b, const Wide& c, const Wide& d) {
  Record records[4][4];
  const Registers r = to_registers({{a, b, c}, d});
  static_assert(sizeof records == sizeof r);
  std::memcpy(static_cast<void*>(records), &r, sizeof r);
  for (int lane = 0; lane < wide_width; ++lane)
    std::memcpy(reinterpret_cast<char*>(to + lane) + 16 * quarter, &records[lane % 4][lane / 4], 16);
}

PLIANT_HD void store_splats(Splat* to, const PlaceRows<const float>& at, int first, int lanes, const Kernel<Wide>& k) {
  Splat splats[wide_width];
  const Wide zero(0);
  store_quarter(splats, 0, load_wide(at.x + first), load_wide(at.y + first), load_wide(at.z + first), k.weight);
  store_quarter(splats, 1, k.a.xx, k.a.yy, k.a.zz, k.a.xy);
  store_quarter(splats, 2, k.a.xz, k.a.yz, zero, zero);
  store_quarter(splats, 3, k.reach.x, k.reach.y, k.reach.z, zero);
  std::memcpy(static_cast<void*>(to + first), splats, static_cast<std::size_t>(lanes) * sizeof(Splat));
}

PLIANT_HD void store_sizes(const SizeRows<float>& to, int first, int lanes, const Kernel<Wide>& k) {
  const Wide one(1);
  store_some(to.per_x + first, one / k.reach.x, lanes);
  store_some(to.per_y + first, one / k.reach.y, lanes);
  store_some(to.per_z + first, one / k.reach.z, lanes);
  store_some(to.widest + first, k.widest, lanes);
}

void make_splats(const SplatRule& rule, const Moments* moments, int count, const PlaceRows<const float>& places,
                 const SizeRows<float>& sizes, Splat* to) {
  const auto* const records = reinterpret_cast<const Record*>(moments);
  for (int first = 0; first < count; first += wide_width) {
    const int lanes = count - first < wide_width ? count - first : wide_width;
    std::int32_t at[3][wide_width];
    for (int lane = 0; lane < wide_width; ++lane)
      for (int part = 0; part < 3; ++part) at[part][lane] = 3 * (first + (lane < lanes ? lane : lanes - 1)) + part;
    const WideRecords a = from_registers(load_indexed(records, at[0]));
    const WideRecords b = from_registers(load_indexed(records, at[1])),
                      c = from_registers(load_indexed(records, at[2]));
    const Symmetric<Wide> products{b.position.x, b.position.y, b.position.z, b.w, c.position.x, c.position.y};
    const Symmetric<Wide> spread = covariance(a.w, a.position, products, rule.spacing);
    const Wide trace = trace_of(spread);
    const Symmetric<Wide> radii = squared_radii(spread, trace, rule.anisotropic);
    const Kernel<Wide> kernel = make_kernel(radii, gain_of(trace), rule.spacing);
    store_splats(to, places, first, lanes, kernel);
    store_sizes(sizes, first, lanes, kernel);
  }
}

// ---------------------------------------------------------------- which kernels reach a box

/// A box by its middle, and half its size a little larger, for rounding far from the origin.
struct WideBox {
  Part x, y, z, half_x, half_y, half_z;
};

PLIANT_HD Part half_of(float low, float high) {
  return all_lanes(0.5f * (high - low) + 1e-6f * pliant::max(pliant::abs(low), pliant::abs(high)));
}

PLIANT_HD WideBox widen(const Box& b) {
  return {all_lanes(0.5f * (b.low.x + b.high.x)),
          all_lanes(0.5f * (b.low.y + b.high.y)),
          all_lanes(0.5f * (b.low.z + b.high.z)),
          half_of(b.low.x, b.high.x),
          half_of(b.low.y, b.high.y),
          half_of(b.low.z, b.high.z)};
}

/// Bit l is set where kernel i + l may reach the box: its own box does, and so does the ellipsoid around it.
PLIANT_HD std::uint32_t bits_that_reach(const SplatRows<const float>& s, int i, const WideBox& box) {
  const Part zero{};
  const Part x = max_part(abs_part(load_part(s.at.x + i) - box.x) - box.half_x, zero) * load_part(s.size.per_x + i);
  const Part y = max_part(abs_part(load_part(s.at.y + i) - box.y) - box.half_y, zero) * load_part(s.size.per_y + i);
  const Part z = max_part(abs_part(load_part(s.at.z + i) - box.z) - box.half_z, zero) * load_part(s.size.per_z + i);
  return bits_at_most(max_part(max_part(x, y), z), all_lanes(1)) &
         bits_at_most(x * x + y * y + z * z, load_part(s.size.widest + i));
}

int gather(const SplatRows<const float>& from, const ParticleRange& range, const Box& box, int count,
           const SplatRows<float>& to, int* numbers) {
  const WideBox wide = widen(box);
  const float* const sources[] = {from.at.x,       from.at.y,       from.at.z,       from.size.per_x,
                                  from.size.per_y, from.size.per_z, from.size.widest};
  float* const targets[] = {to.at.x, to.at.y, to.at.z, to.size.per_x, to.size.per_y, to.size.per_z, to.size.widest};
  for (int i = range.first; i < range.last; i += part_width) {
    const std::uint32_t bits = bits_that_reach(from, i, wide) & first_bits(range.last - i);
    const Packing packing(bits);
    packing.store(numbers + count, lane_numbers() + i);
    for (int row = 0; row < 7; ++row) packing.store(targets[row] + count, (PartMask)load_part(sources[row] + i));
    count += count_bits(bits);
  }
  return count;
}

int choose(const SplatRows<const float>& from, const int* numbers, int count, const Box& box, int* to) {
  const WideBox wide = widen(box);
  int chosen = 0;
  for (int i = 0; i < count; i += part_width) {
    const std::uint32_t bits = bits_that_reach(from, i, wide) & first_bits(count - i);
    Packing(bits).store(to + chosen, load_part(numbers + i));
    chosen += count_bits(bits);
  }
  return chosen;
}

// ---------------------------------------------------------------- sums

/// Adds weight * max(inside, 0)^3.
PLIANT_HD void add_cube(Part& sum, const Part& inside, const Part& weight) {
  const Part t = max_part(inside, Part{});
  sum += (t * t) * (t * weight);
}

/// Places in cells of the nodes of a layer of a brick that are in part i: x + 4 y.
struct LayerPlaces {
  Part x, y;
};

PLIANT_HD LayerPlaces layer_places(int i) {
  constexpr float along_x[wide_width] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  constexpr float along_y[wide_width] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  return {load_part(along_x + i * part_width), load_part(along_y + i * part_width)};
}

/// Sums part i of each of the four layers of a brick. In a layer 1 - q is p - z (g + zz z); from one to the next its
/// differences change by the same amount.
PLIANT_HD void sum_part(const Splat* splats, const int* numbers, int count, const BrickPlace& at, int i, Part* sums) {
  const LayerPlaces places = layer_places(i);
  const Part cell = all_lanes(at.cell), twice_squared = all_lanes(2 * at.cell * at.cell), one = all_lanes(1);
  const Part node_x = (places.x + at.first_node.x) * at.cell, node_y = (places.y + at.first_node.y) * at.cell;
  const Part node_z = all_lanes(at.first_node.z * at.cell);
  const Part origin_x = all_lanes(at.origin.x), origin_y = all_lanes(at.origin.y), origin_z = all_lanes(at.origin.z);
  Part s0{}, s1{}, s2{}, s3{};
  for (int n = 0; n < count; ++n) {
    const Splat& k = splats[numbers[n]];
    const Part weight = all_lanes(k.weight), zz = all_lanes(k.zz);
    const Part x = node_x - (all_lanes(k.centre.x) - origin_x), y = node_y - (all_lanes(k.centre.y) - origin_y);
    const Part z = node_z - (all_lanes(k.centre.z) - origin_z);
    const Part half_g = k.xz * x + k.yz * y, g = half_g + half_g;
    const Part xy = k.xy * y;
    const Part p = one - (x * (k.xx * x + (xy + xy)) + (k.yy * y) * y);
    const Part first = p - z * (g + zz * z);
    const Part second = zz * twice_squared;
    const Part step_0 = cell * (g + zz * (z + z + cell)), step_1 = step_0 + second, step_2 = step_1 + second;
    const Part at_1 = first - step_0, at_2 = at_1 - step_1, at_3 = at_2 - step_2;
    add_cube(s0, first, weight);
    add_cube(s1, at_1, weight);
    add_cube(s2, at_2, weight);
    add_cube(s3, at_3, weight);
  }
  sums[0] = s0, sums[1] = s1, sums[2] = s2, sums[3] = s3;
}

std::uint64_t sum(const Splat* splats, const int* numbers, int count, const BrickPlace& at, float* to) {
  const Part level = all_lanes(at.level);
  std::uint64_t inside = 0;
  for (int i = 0; i < wide_parts; ++i) {
    Part sums[brick_side];
    sum_part(splats, numbers, count, at, i, sums);
    for (int layer = 0; layer < brick_side; ++layer) {
      const int node = layer * wide_width + i * part_width;
      store_part(to + node, sums[layer]);
      inside |= std::uint64_t{bits_at_most(sums[layer], level) ^ first_bits(part_width)} << node;
    }
  }
  return inside;
}

}  // namespace
}  // namespace PLIANT_ISA

const surface::SurfaceKernels& PLIANT_OF_LEVEL(surface_kernels)() {
  static const surface::SurfaceKernels table{find_moments, make_splats, gather, choose, sum};
  return table;
}

}  // namespace pliant
