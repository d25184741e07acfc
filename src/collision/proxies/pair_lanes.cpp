// The kernels of surface contact in sixteen SIMD lanes, compiled per instruction set level under the rules of
// solver/lanes.cpp: everything is inlined or in an inline namespace, and only the table has external linkage.
#include "collision/proxies/pair_kernels.h"
#include "geometry/triangle.h"
#include "math/lane_bits.h"
#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// Upper bound of the error of a float distance, over the largest coordinate relative to the pair's first particle.
/// Largest errors found by search: 6e-4 for edges that cross at 1e-4 rad, 1e-4 for triangles, 1.5e-4 for random pairs.
constexpr float error_over_size = 1e-3f;
/// Particles farther from the origin along an axis have no contact [m].
constexpr float largest_place = 1e14f;

PLIANT_HD Vec3<Wide> places(const Record* records, const std::int32_t* index) {
  return from_registers(load_indexed(records, index)).position;
}

/// Reduces sixteen lanes to four with the operation `join`: lane i joins lanes i + 4 k, folding the upper half onto the
/// lower.
template <class Join>
PLIANT_HD Quad to_four(const Wide& a, Join join) {
#if PLIANT_PART_WIDTH == 16
  const Part& p = a.part[0];
  return join(join(quad_of<0>(p), quad_of<2>(p)), join(quad_of<1>(p), quad_of<3>(p)));
#elif PLIANT_PART_WIDTH == 8
  return join(join(quad_of<0>(a.part[0]), quad_of<0>(a.part[1])), join(quad_of<1>(a.part[0]), quad_of<1>(a.part[1])));
#else
  return join(join(a.part[0], a.part[2]), join(a.part[1], a.part[3]));
#endif
}

PLIANT_HD float least_lane(const Wide& a) {
  const Quad four = to_four(a, [](const Quad& x, const Quad& y) -> Quad { return x < y ? x : y; });
  return pliant::min(pliant::min(four[0], four[2]), pliant::min(four[1], four[3]));
}

// ---------------------------------------------------------------- distances

/// Positions of a pair's particles relative to the first one.
struct Corners {
  Vec3<Wide> x[4];
};

PLIANT_HD Corners corners_of(const PairStencils& pairs, const Record* positions) {
  const Vec3<Wide> origin = places(positions, pairs.vertex[0]);
  const Wide zero(0.f);
  return {{{zero, zero, zero},
           places(positions, pairs.vertex[1]) - origin,
           places(positions, pairs.vertex[2]) - origin,
           places(positions, pairs.vertex[3]) - origin}};
}

PLIANT_HD Wide at_least(const Wide& distance, const Vec3<Wide> (&x)[4]) {
  const Wide size = largest(max(max(abs(x[1]), abs(x[2])), abs(x[3])));
  return max(distance * Wide(1 - 1e-5f) - size * Wide(error_over_size), Wide(0.f));
}

void distances(const PairStencils& pairs, int first_side, const Record* positions, PairBatch& out) {
  const auto [x] = corners_of(pairs, positions);
  Wide weight[4];
  Vec3<Wide> apart;
  if (first_side == 1) {
    const auto near = closest_on_triangle(x[0], x[1], x[2], x[3]);
    weight[0] = Wide(1.f);
    weight[1] = -near.weights.x;
    weight[2] = -near.weights.y;
    weight[3] = -near.weights.z;
    apart = x[0] - near.point;
  } else {
    const auto near = closest_on_segments({x[0], x[1]}, {x[2], x[3]});
    weight[0] = Wide(1.f) - near.s;
    weight[1] = near.s;
    weight[2] = near.t - Wide(1.f);
    weight[3] = -near.t;
    apart = near.first - near.second;
  }
  const Wide distance = sqrt(dot(apart, apart)), scale = Wide(1.f) / max(distance, Wide(1e-30f));
  store_wide(out.distance, distance);
  store_wide(out.at_least, at_least(distance, x));
  for (int slot = 0; slot < 4; ++slot) store_wide(out.weight[slot], weight[slot]);
  store_wide(out.normal[0], apart.x * scale);
  store_wide(out.normal[1], apart.y * scale);
  store_wide(out.normal[2], apart.z * scale);
}

/// Squared distance from the origin to the segment from `a` to `a` + `along`; `over_length` is 1 / |along|^2.
PLIANT_HD Wide squared_to_segment(const Vec3<Wide>& a, const Vec3<Wide>& along, const Wide& over_length) {
  const Wide share = min(max(-dot(a, along) * over_length, Wide(0.f)), Wide(1.f));
  const Vec3<Wide> point = a + along * share;
  return dot(point, point);
}

PLIANT_HD Wide over(const Wide& divisor) { return Wide(1.f) / max(divisor, Wide(1e-30f)); }
PLIANT_HD Wide squared_to_plane(const Vec3<Wide>& point, const Vec3<Wide>& normal) {
  const Wide along = dot(point, normal);
  return along * along * over(dot(normal, normal));
}

/// Squared distance from the origin to a triangle: to its plane if the origin's projection is inside, else to its
/// sides. A projection wrongly classified as inside still gives a lower bound.
PLIANT_HD Wide least_squared_to_triangle(const Vec3<Wide>& a, const Vec3<Wide>& b, const Vec3<Wide>& c) {
  const Vec3<Wide> ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, bc);
  const Wide sides =
      min(squared_to_segment(a, ab, over(dot(ab, ab))),
          min(squared_to_segment(b, bc, over(dot(bc, bc))), squared_to_segment(c, ca, over(dot(ca, ca)))));
  const Wide least = min(dot(cross(a, b), normal), min(dot(cross(b, c), normal), dot(cross(c, a), normal)));
  return select(least > Wide(0.f), min(squared_to_plane(a, normal), sides), sides);
}

/// Lines at a smaller angle count as parallel [rad].
constexpr float least_angle = 5e-4f;

/// Squared distance of the segments 0-u and a-b: between interior points if those are closest, else from an end.
PLIANT_HD Wide least_squared_of_segments(const Vec3<Wide>& u, const Vec3<Wide>& a, const Vec3<Wide>& b) {
  const Vec3<Wide> v = b - a, normal = cross(u, v);
  const Wide uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ua = dot(u, a), va = dot(v, a), over_u = over(uu),
             over_v = over(vv), squared_sine = dot(normal, normal);
  const Wide ends = min(min(squared_to_segment(a, v, over_v), squared_to_segment(a - u, v, over_v)),
                        min(squared_to_segment(-a, u, over_u), squared_to_segment(-b, u, over_u)));
  const Wide s = vv * ua - uv * va, t = uv * ua - uu * va;
  const Wide least = min(min(s, squared_sine - s), min(t, squared_sine - t));
  const Wide lines = select(least > Wide(0.f), min(squared_to_plane(a, normal), ends), ends);
  return select(squared_sine > uu * vv * Wide(least_angle * least_angle), lines, ends);
}

PLIANT_HD Wide bounds_of(const PairStencils& pairs, int first_side, const Record* positions) {
  const auto [x] = corners_of(pairs, positions);
  const Wide squared =
      first_side == 1 ? least_squared_to_triangle(x[1], x[2], x[3]) : least_squared_of_segments(x[1], x[2], x[3]);
  return at_least(sqrt(squared) * Wide(1 - 1e-6f), x);
}

float least_distance(const PairStencils& pairs, int first_side, const Record* positions) {
  return least_lane(bounds_of(pairs, first_side, positions));
}

void lower_bounds(const PairStencils& pairs, int first_side, const Record* positions, float* out) {
  store_wide(out, bounds_of(pairs, first_side, positions));
}

// ---------------------------------------------------------------- moves

PLIANT_HD float largest_lane(const Wide& a) { return -least_lane(-a); }
PLIANT_HD Vec3f least_lane(const Vec3<Wide>& a) { return {least_lane(a.x), least_lane(a.y), least_lane(a.z)}; }
PLIANT_HD Vec3f largest_lane(const Vec3<Wide>& a) { return {largest_lane(a.x), largest_lane(a.y), largest_lane(a.z)}; }

PLIANT_HD float sum_lanes(const Wide& a) {
  const Quad four = to_four(a, [](const Quad& x, const Quad& y) -> Quad { return x + y; });
  return (four[0] + four[2]) + (four[1] + four[3]);
}
PLIANT_HD Vec3f sum_lanes(const Vec3<Wide>& a) { return {sum_lanes(a.x), sum_lanes(a.y), sum_lanes(a.z)}; }
PLIANT_HD Vec3<Wide> everywhere(const Vec3f& a) { return {Wide(a.x), Wide(a.y), Wide(a.z)}; }

/// Sums over positions x and displacements d of a cluster, both relative to one of its vertices.
struct Moments {
  Vec3<Wide> x, d, xx, xy, turning;  ///< xx: squares; xy: products yz, zx, xy; turning: cross products of x and d
};

PLIANT_HD void add(Moments& to, const Vec3<Wide>& x, const Vec3<Wide>& d) {
  to.x += x;
  to.d += d;
  to.xx += Vec3<Wide>{x.x * x.x, x.y * x.y, x.z * x.z};
  to.xy += Vec3<Wide>{x.y * x.z, x.z * x.x, x.x * x.y};
  to.turning += cross(x, d);
}

/// The least-squares rotation of a cluster's displacements: the solution of inertia * spin = angular momentum. It
/// affects only how tight the bounds are. If the rotation is undetermined, the result is small.
PLIANT_HD Vec3f spin_of(const Moments& moments, float count, const Vec3f& x, const Vec3f& d) {
  const Vec3f squares = sum_lanes(moments.xx) - Vec3f{x.x * x.x, x.y * x.y, x.z * x.z} * count,
              products = sum_lanes(moments.xy) - Vec3f{x.y * x.z, x.z * x.x, x.x * x.y} * count,
              momentum = sum_lanes(moments.turning) - cross(x, d) * count;
  const float trace = squares.x + squares.y + squares.z, scale = 1 / pliant::max(trace, 1e-30f);
  const float least = 1e-4f;
  const float xx = (squares.y + squares.z) * scale + least, yy = (squares.z + squares.x) * scale + least,
              zz = (squares.x + squares.y) * scale + least;
  const float yz = -products.x * scale, zx = -products.y * scale, xy = -products.z * scale;
  const float cx = yy * zz - yz * yz, cy = yz * zx - xy * zz, cz = xy * yz - yy * zx;
  const float determinant = xx * cx + xy * cy + zx * cz;
  const Vec3f b = momentum * (scale / pliant::max(determinant, 1e-12f));
  const Vec3f spin{cx * b.x + cy * b.y + cz * b.z, cy * b.x + (xx * zz - zx * zx) * b.y + (xy * zx - xx * yz) * b.z,
                   cz * b.x + (xy * zx - xx * yz) * b.y + (xx * yy - xy * xy) * b.z};
  return largest(spin) < 1e3f ? spin : Vec3f{};
}

void measure_cluster(const std::int32_t* vertices, int count, const PairParticles& particles, ClusterMotion& out) {
  const Record &first = particles.positions[vertices[0]], &moves = particles.displacements[vertices[0]];
  const Vec3f x0{first.x, first.y, first.z},
      d0{(first.x + moves.x) - first.x, (first.y + moves.y) - first.y, (first.z + moves.z) - first.z};
  const Wide huge(3e38f), zero(0.f), one(1.f);
  Vec3<Wide> low[2] = {{huge, huge, huge}, {huge, huge, huge}}, high[2] = {-low[0], -low[1]}, sum{zero, zero, zero};
  const Vec3<Wide> none{zero, zero, zero};
  Moments moments{none, none, none, none, none};
  Wide beyond = zero, movable = zero;
  for (int i = 0; i < count; i += 16) {
    const WideRecords at = from_registers(load_indexed(particles.positions, vertices + i));
    const Vec3<Wide> start = at.position, end = start + places(particles.displacements, vertices + i),
                     move = end - start;
    add(moments, start - everywhere(x0), move - everywhere(d0));
    const WideMask free = at.w > zero;
    sum += Vec3<Wide>{select(free, move.x, zero), select(free, move.y, zero), select(free, move.z, zero)};
    movable += select(free, one, zero);
    // NaN fails this comparison, so it counts as too far.
    beyond = select(abs(end.x) < Wide(largest_place), beyond, one);
    beyond = select(abs(end.y) < Wide(largest_place), beyond, one);
    beyond = select(abs(end.z) < Wide(largest_place), beyond, one);
    low[0] = min(low[0], start);
    high[0] = max(high[0], start);
    low[1] = min(low[1], end);
    high[1] = max(high[1], end);
  }
  for (int side = 0; side < 2; ++side) {
    out.low[side] = least_lane(low[side]);
    out.high[side] = largest_lane(high[side]);
  }
  const float n = static_cast<float>(count);
  const Vec3f x = sum_lanes(moments.x) * (1 / n), d = sum_lanes(moments.d) * (1 / n);
  out.centre = x0 + x;
  out.mean = d0 + d;
  out.spin = spin_of(moments, n, x, d);
  out.sum = sum_lanes(sum);
  out.movable = sum_lanes(movable);
  out.extent = pliant::max(largest(out.low[0]), largest(out.high[0]));
  out.is_bounded = largest_lane(beyond) == 0;
  Wide squared = zero, distance = zero, plain = zero;
  for (int i = 0; i < count; i += 16) {
    const Vec3<Wide> start = places(particles.positions, vertices + i),
                     end = start + places(particles.displacements, vertices + i), arm = start - everywhere(out.centre),
                     move = (end - start) - everywhere(out.mean), departure = move - cross(everywhere(out.spin), arm);
    squared = max(dot(departure, departure), squared);
    distance = max(dot(arm, arm), distance);
    plain = max(dot(move, move), plain);
  }
  out.radius = pliant::sqrt(largest_lane(distance)) * bound_slack;
  // The second term bounds the rounding error of the displacement that was subtracted.
  out.largest = pliant::sqrt(largest_lane(squared)) * bound_slack +
                2e-6f * (pliant::sqrt(largest_lane(plain)) + length(out.spin) * out.radius) + 1e-12f;
}

/// Converts bits to a mask: lane i is true if bit i is set.
PLIANT_HD WideMask lanes_of(unsigned bits) {
  constexpr std::int32_t bit_of_lane[wide_width] = {1,       1 << 1,  1 << 2,  1 << 3, 1 << 4,  1 << 5,
                                                    1 << 6,  1 << 7,  1 << 8,  1 << 9, 1 << 10, 1 << 11,
                                                    1 << 12, 1 << 13, 1 << 14, 1 << 15};
  PartMask bit;
  std::memcpy(&bit, bit_of_lane, sizeof bit);
  WideMask mask;
  for (int part = 0; part < wide_parts; ++part)
    mask.part[part] = ((PartMask{} + static_cast<std::int32_t>(bits >> (part * part_width))) & bit) != 0;
  return mask;
}

/// The motions of a pair's clusters, broadcast to all lanes.
struct Motions {
  Vec3<Wide> mean, centre, spin;
};
PLIANT_HD Motions everywhere(const ClusterMotion& m) {
  return {everywhere(m.mean), everywhere(m.centre), everywhere(m.spin)};
}
PLIANT_HD Vec3<Wide> select(const WideMask& mask, const Vec3<Wide>& a, const Vec3<Wide>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
PLIANT_HD Motions select(const WideMask& mask, const Motions& a, const Motions& b) {
  return {select(mask, a.mean, b.mean), select(mask, a.centre, b.centre), select(mask, a.spin, b.spin)};
}

/// Upper bound of a vertex's residual motion, relative to the rigid motion of its cluster [m].
PLIANT_HD Wide departure_of(const Vec3<Wide>& start, const Vec3<Wide>& end, const Motions& of) {
  const Vec3<Wide> move = (end - start) - of.mean, turn = cross(of.spin, start - of.centre);
  return length(move - turn) * Wide(bound_slack) + Wide(2e-6f) * (length(move) + length(turn)) + Wide(1e-12f);
}

void paths(const PairStencils& pairs, int first_side, const PairParticles& particles, const PairMotion& motion,
           PairPaths& out) {
  Motions of[2] = {everywhere(*motion.first), everywhere(*motion.second)};
  if (motion.swapped != 0) {
    const WideMask swapped = lanes_of(motion.swapped);
    const Motions first = of[0];
    of[0] = select(swapped, of[1], first);
    of[1] = select(swapped, first, of[1]);
  }
  const Vec3<Wide> drift = everywhere(motion.drift);
  Vec3<Wide> low[2], high[2];
  Wide departs[2] = {Wide(0.f), Wide(0.f)};
  for (int i = 0; i < 4; ++i) {
    const int side = i < first_side ? 0 : 1;
    const Vec3<Wide> start = places(particles.positions, pairs.vertex[i]),
                     end = start + places(particles.displacements, pairs.vertex[i]), seen = end - drift;
    departs[side] = max(departure_of(start, end, of[side]), departs[side]);
    const bool begins = i == 0 || i == first_side;
    low[side] = begins ? min(start, seen) : min(low[side], min(start, seen));
    high[side] = begins ? max(start, seen) : max(high[side], max(start, seen));
  }
  store_wide(out.falls, departs[0] + departs[1]);
  const Vec3<Wide> apart = max(low[0] - high[1], low[1] - high[0]);
  store_wide(out.apart, max(max(apart.x, apart.y), apart.z));
}

// ---------------------------------------------------------------- boxes

void fit_boxes(const ElementCorners& elements, int first, int last, const PairParticles& particles, const Vec3f& drift,
               const BoxRows& out) {
  const Vec3<Wide> drifted{Wide(drift.x), Wide(drift.y), Wide(drift.z)};
  for (int i = first; i < last; i += 16) {
    Vec3<Wide> low, high;
    for (int corner = 0; corner < elements.rows; ++corner) {
      const std::int32_t* index = elements.row[corner] + i;
      const Vec3<Wide> start = places(particles.positions, index),
                       end = start + places(particles.displacements, index) - drifted;
      low = corner == 0 ? min(start, end) : min(low, min(start, end));
      high = corner == 0 ? max(start, end) : max(high, max(start, end));
    }
    const Wide* const sides[6] = {&low.x, &low.y, &low.z, &high.x, &high.y, &high.z};
    for (int k = 0; k < 6; ++k) store_wide(out.row[k] + i, *sides[k]);
  }
}

/// Bit i is set if `box` overlaps box number at + i, for i < 16.
PLIANT_HD unsigned overlaps(const float* box, const BoxRows& boxes, int at) {
#if PLIANT_X86_BITS == 512
  // Two chains of three comparisons wait half as long as one of six.
  const auto from = [&](int row) { return _mm512_loadu_ps(boxes.row[row] + at); };
  __mmask16 below = _mm512_cmp_ps_mask(from(0), _mm512_set1_ps(box[3]), _CMP_LE_OQ);
  __mmask16 above = _mm512_cmp_ps_mask(from(3), _mm512_set1_ps(box[0]), _CMP_GE_OQ);
  below = _mm512_mask_cmp_ps_mask(below, from(1), _mm512_set1_ps(box[4]), _CMP_LE_OQ);
  above = _mm512_mask_cmp_ps_mask(above, from(4), _mm512_set1_ps(box[1]), _CMP_GE_OQ);
  below = _mm512_mask_cmp_ps_mask(below, from(2), _mm512_set1_ps(box[5]), _CMP_LE_OQ);
  above = _mm512_mask_cmp_ps_mask(above, from(5), _mm512_set1_ps(box[2]), _CMP_GE_OQ);
  return _kand_mask16(below, above);
#else
  unsigned bits = 0;
  for (int part = 0; part < wide_parts; ++part) {
    const auto from = [&](int row) {
      Part values;
      std::memcpy(&values, boxes.row[row] + at + part * part_width, sizeof values);
      return values;
    };
    const PartMask inside = (from(0) <= Part{} + box[3]) & (from(1) <= Part{} + box[4]) & (from(2) <= Part{} + box[5]) &
                            (from(3) >= Part{} + box[0]) & (from(4) >= Part{} + box[1]) & (from(5) >= Part{} + box[2]);
    bits |= part_bits(inside) << (part * part_width);
  }
  return bits;
#endif
}

/// Writes the hits of a row in the sixteen columns from `first` on, and returns their number. `hits` has room for
/// sixteen.
PLIANT_HD int write_hits(std::int32_t row, std::int32_t first, unsigned bits, BoxHit* hits) {
#if PLIANT_X86_BITS == 512
  // The number of hits is unpredictable, so all sixteen entries are written.
  const __m512i lane = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0),
                column = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits),
                                                     _mm512_add_epi32(lane, _mm512_set1_epi32(first))),
                rows = _mm512_set1_epi32(row);
  const __m512i low = _mm512_set_epi32(7, 0, 6, 0, 5, 0, 4, 0, 3, 0, 2, 0, 1, 0, 0, 0),
                high = _mm512_set_epi32(15, 0, 14, 0, 13, 0, 12, 0, 11, 0, 10, 0, 9, 0, 8, 0);
  constexpr __mmask16 of_columns = 0xaaaa;
  _mm512_storeu_si512(hits, _mm512_mask_permutexvar_epi32(rows, of_columns, low, column));
  _mm512_storeu_si512(hits + 8, _mm512_mask_permutexvar_epi32(rows, of_columns, high, column));
  return __builtin_popcount(bits);
#else
  int found = 0;
  for (; bits != 0; bits &= bits - 1) hits[found++] = {row, first + __builtin_ctz(bits)};
  return found;
#endif
}

int find_overlaps(const BoxComparison& of, BoxHit* hits) {
  float side[6][16];
  for (int k = 0; k < 6; ++k)
    store_wide(side[k], load_wide(of.rows.row[k] + of.first_row) + Wide(k < 3 ? -of.reach : of.reach));
  int found = 0;
  for (unsigned rows = overlaps(of.far, of.rows, of.first_row); rows != 0; rows &= rows - 1) {
    const int lane = __builtin_ctz(rows), row = of.first_row + lane;
    const float box[6] = {side[0][lane], side[1][lane], side[2][lane], side[3][lane], side[4][lane], side[5][lane]};
    const LeftOut* left_out = of.left_out + of.left_out_start[row];
    for (int k = 0; k < of.batches; ++k) {
      const std::int32_t batch = of.batch[k];
      unsigned bits = overlaps(box, of.columns, 16 * batch);
      while (left_out->batch < batch) ++left_out;
      if (left_out->batch == batch) bits &= ~left_out->bits;
      if (bits != 0) found += write_hits(row, 16 * batch, bits, hits + found);
    }
  }
  return found;
}

// ---------------------------------------------------------------- vertices

void gather_places(const std::int32_t* vertices, int first, int last, const Record* positions, const PlaceRows& out) {
  for (int i = first; i < last; i += 16) {
    const Vec3<Wide> at = places(positions, vertices + i);
    store_wide(out.row[0] + i, at.x);
    store_wide(out.row[1] + i, at.y);
    store_wide(out.row[2] + i, at.z);
  }
}

float longest_squared(const ElementCorners& lines, int first, int last, const Record* positions) {
  Wide longest(0.f);
  for (int i = first; i < last; i += 16) {
    const Vec3<Wide> along = places(positions, lines.row[0] + i) - places(positions, lines.row[1] + i);
    longest = max(dot(along, along), longest);
  }
  return largest_lane(longest);
}

float least_squared(const VertexComparison& of, float beyond) {
  float* const* row = of.rows.row;
  const BoxRows points{{row[0], row[1], row[2], row[0], row[1], row[2]}};
  Wide least(beyond);
  for (unsigned rows = overlaps(of.far, points, of.first_row); rows != 0; rows &= rows - 1) {
    const int at = of.first_row + __builtin_ctz(rows);
    const Vec3<Wide> place{Wide(row[0][at]), Wide(row[1][at]), Wide(row[2][at])};
    const LeftOut* left_out = of.left_out + of.left_out_start[at];
    for (int k = 0; k < of.batches; ++k) {
      const std::int32_t batch = of.batch[k];
      const Vec3<Wide> apart =
          Vec3<Wide>{load_wide(of.columns.row[0] + 16 * batch), load_wide(of.columns.row[1] + 16 * batch),
                     load_wide(of.columns.row[2] + 16 * batch)} -
          place;
      Wide squared = dot(apart, apart);
      while (left_out->batch < batch) ++left_out;
      if (left_out->batch == batch) squared = select(lanes_of(left_out->bits), Wide(beyond), squared);
      least = min(squared, least);
    }
  }
  return least_lane(least);
}

}  // namespace
}  // namespace PLIANT_ISA

const PairKernels& PLIANT_OF_LEVEL(pair_kernels)() {
  static constexpr PairKernels kernels{measure_cluster, fit_boxes,      find_overlaps, gather_places, longest_squared,
                                       least_squared,   least_distance, lower_bounds,  distances,     paths};
  return kernels;
}

}  // namespace pliant
