// Compares the pair kernels in lanes with plain double precision, and with each other: all levels give the same bits.
#include "collision/proxies/pair_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "collision/kernel_support.h"
#include "collision/random_support.h"
#include "math/vector.h"

namespace pliant {
namespace {

using namespace testing_support;

struct Particles {
  std::vector<Record> positions, displacements, remainders;
  std::vector<std::int32_t> vertices;

  PairParticles in_substep() { return {positions.data(), remainders.data(), displacements.data(), 1e-3f}; }
  Vec3d start(std::int32_t v) const {
    const Record& x = positions[static_cast<std::size_t>(v)];
    return {double(x.x), double(x.y), double(x.z)};
  }
  Vec3d end(std::int32_t v) const {
    const Record &x = positions[static_cast<std::size_t>(v)], &d = displacements[static_cast<std::size_t>(v)];
    return {double(x.x + d.x), double(x.y + d.y), double(x.z + d.z)};
  }
};

/// Random particles about `at` that move together, rotate by `angle` about an axis, and are displaced randomly by up to
/// `noise`.
Particles heap(Random& random, const Vec3d& at, double angle, double noise, int count = 48) {
  Particles p;
  const Vec3d axis = random_place(random, 1), along = random_place(random, 0.02);
  for (int i = 0; i < count; ++i) {
    const Vec3d arm = random_place(random, 0.05), x = at + arm;
    const Vec3d d = along + cross(axis * (angle / length(axis)), arm) + random_place(random, noise);
    p.positions.push_back({float(x.x), float(x.y), float(x.z), i % 3 == 0 ? 0.f : 1.f});
    p.displacements.push_back({float(d.x), float(d.y), float(d.z), 0});
    p.vertices.push_back(i);
  }
  p.remainders.resize(p.positions.size());
  return p;
}

ClusterMotion motion_of(const PairKernels& kernels, Particles& p) {
  ClusterMotion motion;
  kernels.measure_cluster(p.vertices.data(), static_cast<int>(p.vertices.size()), p.in_substep(), motion);
  return motion;
}

TEST(PairKernels, BoundHowFarDistancesFallInACluster) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3d at = random_place(random, trial % 2 == 0 ? 0.1 : 100);
    Particles p = heap(random, at, uniform(random, 0, 0.5), trial % 5 == 0 ? 0 : 1e-3);
    const ClusterMotion motion = motion_of(*all_kernels().front(), p);
    for (const std::int32_t a : p.vertices) {
      EXPECT_LE(length(p.start(a) - convert<double>(motion.centre)), double(motion.radius));
      // The residual motion of the vertex, in double.
      const Vec3d move = p.end(a) - p.start(a),
                  turn = cross(convert<double>(motion.spin), p.start(a) - convert<double>(motion.centre));
      EXPECT_LE(length(move - convert<double>(motion.mean) - turn), double(motion.largest));
      for (const std::int32_t b : p.vertices) {
        const double before = length(p.start(a) - p.start(b));
        for (const double t : {0.3, 1.0}) {
          const Vec3d now = p.start(a) + (p.end(a) - p.start(a)) * t - p.start(b) - (p.end(b) - p.start(b)) * t;
          ASSERT_GE(length(now), before - 2 * double(motion.largest)) << "trial " << trial;
        }
      }
    }
  }
}

TEST(PairKernels, SeeThroughATurn) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    Particles turning = heap(random, {}, 0.2, 0), crumpling = heap(random, {}, 0.2, 1e-3);
    // 0.2 rad at 0.05 m and more are a centimetre, of which next to nothing may remain as residual motion.
    EXPECT_LT(double(motion_of(*all_kernels().front(), turning).largest), 1e-4);
    EXPECT_GT(double(motion_of(*all_kernels().front(), crumpling).largest), 3e-4);
  }
}

TEST(PairKernels, NoticeWhatIsNotFinite) {
  Random random(3);
  for (const PairKernels* kernels : all_kernels())
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e14f})
      for (const int where : {0, 17, 47}) {
        Particles p = heap(random, {}, 0.1, 1e-3);
        EXPECT_TRUE(motion_of(*kernels, p).is_bounded);
        p.displacements[static_cast<std::size_t>(where)].y = bad;
        EXPECT_FALSE(motion_of(*kernels, p).is_bounded) << bad << " at " << where;
      }
}

TEST(PairKernels, SumWhatCanBePushed) {
  Random random(4);
  Particles p = heap(random, {1, 2, 3}, 0.1, 1e-3);
  const ClusterMotion motion = motion_of(*all_kernels().front(), p);
  EXPECT_EQ(motion.movable, 32.f);
  Vec3d sum{};
  for (const std::int32_t v : p.vertices)
    if (v % 3 != 0) sum += p.end(v) - p.start(v);
  EXPECT_LT(length(sum - convert<double>(motion.sum)), 1e-6);
}

/// Boxes of random elements; the last batch is padded.
struct Boxes {
  std::vector<float> row[6];
  explicit Boxes(Random& random, int count) {
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) {
        const double low = uniform(random, 0, 1), size = uniform(random, 0, 0.4);
        row[k].push_back(i % 16 == 15 ? 3e38f : float(low));
        row[k + 3].push_back(i % 16 == 15 ? -3e38f : float(low + size));
      }
  }
  BoxRows rows() {
    return {{row[0].data(), row[1].data(), row[2].data(), row[3].data(), row[4].data(), row[5].data()}};
  }
  bool overlaps(int i, const float* box, float reach) const {
    for (int k = 0; k < 3; ++k)
      if (!(row[k][i] - reach <= box[k + 3] && row[k + 3][i] + reach >= box[k])) return false;
    return true;
  }
};

TEST(PairKernels, FindTheBoxesOfBruteForce) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Boxes rows(random, 32), columns(random, 64);
    const float far[6] = {0.1f, 0.1f, 0.1f, 0.9f, 0.9f, 0.9f}, reach = 0.05f;
    std::vector<LeftOut> left_out;
    std::vector<std::int32_t> start;
    const std::vector<std::int32_t> batches{0, 2, 3};
    for (int i = 0; i < 32; ++i) {
      start.push_back(static_cast<std::int32_t>(left_out.size()));
      for (const int batch : {1, 2}) left_out.push_back({batch, static_cast<std::uint32_t>(random() & 0xffff)});
      left_out.push_back({std::numeric_limits<std::int32_t>::max(), 0});
    }
    std::vector<std::pair<int, int>> wanted;
    for (int i = 16; i < 32; ++i)
      for (const int batch : batches)
        for (int j = 16 * batch; j < 16 * batch + 16; ++j) {
          const float box[6] = {columns.row[0][j], columns.row[1][j], columns.row[2][j],
                                columns.row[3][j], columns.row[4][j], columns.row[5][j]};
          const bool out = batch == 2 && ((left_out[start[i] + 1].bits >> (j % 16)) & 1) != 0;
          if (rows.overlaps(i, far, 0) && rows.overlaps(i, box, reach) && !out) wanted.emplace_back(i, j);
        }
    ASSERT_GT(wanted.size(), 5u);
    for (const PairKernels* kernels : all_kernels()) {
      std::vector<BoxHit> hits(16 * 48);
      const int count = kernels->find_overlaps(
          {rows.rows(), 16, reach, far, columns.rows(), batches.data(), 3, left_out.data(), start.data()}, hits.data());
      std::vector<std::pair<int, int>> found;
      for (int k = 0; k < count; ++k) found.emplace_back(hits[k].row, hits[k].column);
      EXPECT_EQ(found, wanted);
    }
  }
}

TEST(PairKernels, HoldPathsInBoxes) {
  Random random(6);
  Particles p = heap(random, {3, -2, 1}, 0.3, 1e-2);
  const Vec3f drift{0.01f, -0.02f, 0.03f};
  std::vector<std::int32_t> a, b;
  for (int i = 0; i < 16; ++i) {
    a.push_back(i);
    b.push_back(47 - i);
  }
  for (const PairKernels* kernels : all_kernels()) {
    std::vector<float> row[6];
    for (auto& r : row) r.resize(16);
    const BoxRows out{{row[0].data(), row[1].data(), row[2].data(), row[3].data(), row[4].data(), row[5].data()}};
    kernels->fit_boxes({{a.data(), b.data(), nullptr}, 2}, 0, 16, p.in_substep(), drift, out);
    for (int i = 0; i < 16; ++i) {
      const Vec3d drifted = convert<double>(drift),
                  at[4] = {p.start(a[i]), p.end(a[i]) - drifted, p.start(b[i]), p.end(b[i]) - drifted};
      Vec3d low = at[0], high = at[0];
      for (const Vec3d& x : at) {
        low = min(low, x);
        high = max(high, x);
      }
      const double found[6] = {row[0][i], row[1][i], row[2][i], row[3][i], row[4][i], row[5][i]},
                   wanted[6] = {low.x, low.y, low.z, high.x, high.y, high.z};
      for (int k = 0; k < 6; ++k) EXPECT_NEAR(found[k], wanted[k], 1e-6);
    }
  }
}

TEST(PairKernels, GiveALeastDistanceThatIsNone) {
  Random random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const int first_side = 1 + trial % 2;
    Particles p = heap(random, random_place(random, 1), 0, 0, 64);
    PairStencils pairs;
    for (int lane = 0; lane < 16; ++lane)
      for (int k = 0; k < 4; ++k) pairs.vertex[k][lane] = 4 * lane + k;
    double least = 1e30;
    for (int lane = 0; lane < 16; ++lane)
      least = std::min(
          least, pair_distance({{4 * lane, 4 * lane + 1, 4 * lane + 2, 4 * lane + 3}, first_side}, p.positions.data())
                     .distance);
    float same = 0;
    for (const PairKernels* kernels : all_kernels()) {
      const float found = kernels->least_distance(pairs, first_side, p.positions.data());
      EXPECT_LE(double(found), least);
      EXPECT_GT(double(found), least - 2e-4);
      if (kernels == all_kernels().front()) same = found;
      EXPECT_EQ(found, same);
    }
  }
}

/// Slivers and nearly parallel edges, with angles and heights down to a millionth, for which floats are inaccurate.
TEST(PairKernels, GiveALeastDistanceThatIsNoneOfSlivers) {
  Random random(17);
  for (int trial = 0; trial < 4000; ++trial) {
    const int first_side = 1 + trial % 2;
    const double flat = std::pow(10., uniform(random, -7, 0));
    std::vector<Record> positions(64);
    PairStencils pairs;
    double least = 1e30;
    for (int lane = 0; lane < 16; ++lane) {
      const Vec3d at = random_place(random, 1), along = random_place(random, 0.05), off = random_place(random, 0.02);
      for (int k = 0; k < 4; ++k) {
        const Vec3d x = at + along * uniform(random, -1, 1) + random_place(random, 0.05 * flat) +
                        off * (k < first_side ? uniform(random, 0.9, 1.1) : 0);
        positions[static_cast<std::size_t>(4 * lane + k)] = {float(x.x), float(x.y), float(x.z), 1};
        pairs.vertex[k][lane] = 4 * lane + k;
      }
      const int v = 4 * lane;
      least = std::min(least, pair_distance({{v, v + 1, v + 2, v + 3}, first_side}, positions.data()).distance);
    }
    for (const PairKernels* kernels : all_kernels()) {
      const double found = double(kernels->least_distance(pairs, first_side, positions.data()));
      EXPECT_LE(found, least) << "flat " << flat;
      EXPECT_GT(found, least - 4e-4) << "flat " << flat;
    }
  }
}

/// Random edges are far from the worst cases: edges that cross in their middles at so small an angle that floats, or
/// least_distance on purpose, take them for parallel. Along (1, 1, 1) they are longest for their coordinates. The first
/// two were found by hill climbing.
TEST(PairKernels, GiveALeastDistanceThatIsNoneOfEdgesThatCrossAtSmallAngles) {
  std::vector<std::array<Record, 4>> all{{{{0.0520643033f, 0.0519618057f, 0.0519606583f, 1},
                                           {-0.999916792f, -1.00050592f, -0.99964267f, 1},
                                           {-0.999281824f, -1.00059807f, -0.999807179f, 1},
                                           {0.101533897f, 0.102207147f, 0.102247775f, 1}}},
                                         {{{1.00021136f, 0.999258578f, 0.999536335f, 1},
                                           {-1.00201762f, -1.00074434f, -1.00164783f, 1},
                                           {-0.999369562f, -0.999092877f, -1.00043845f, 1},
                                           {0.999474764f, 0.999688983f, 1.00048161f, 1}}}};
  for (int i = 1; i < 200; ++i) {
    const float off = 1e-5f * static_cast<float>(i);
    all.push_back({{{1, 1, 1, 1}, {-1, -1, -1, 1}, {1 + off, 1 - off, 1, 1}, {-1 - off, -1 + off, -1, 1}}});
  }
  for (const std::array<Record, 4>& four : all) {
    PairStencils pairs;
    for (int k = 0; k < 4; ++k) std::fill(pairs.vertex[k], pairs.vertex[k] + 16, k);
    const double distance = pair_distance({{0, 1, 2, 3}, 2}, four.data()).distance;
    for (const PairKernels* kernels : all_kernels()) {
      PairBatch batch;
      kernels->distances(pairs, 2, four.data(), batch);
      EXPECT_LE(double(batch.at_least[0]), distance) << "by distances, " << four[2].x;
      EXPECT_LE(double(kernels->least_distance(pairs, 2, four.data())), distance) << "by least_distance, " << four[2].x;
    }
  }
}

TEST(PairKernels, GiveTheSameBitsOnAnyLevel) {
  Random random(8);
  for (int trial = 0; trial < 100; ++trial) {
    Particles p = heap(random, random_place(random, 2), uniform(random, 0, 0.3), 1e-3);
    const ClusterMotion first = motion_of(*all_kernels().front(), p);
    for (const PairKernels* kernels : all_kernels()) {
      const ClusterMotion other = motion_of(*kernels, p);
      const auto same = [](const Vec3f& x, const Vec3f& y) { return x.x == y.x && x.y == y.y && x.z == y.z; };
      EXPECT_TRUE(same(first.mean, other.mean) && same(first.centre, other.centre) && same(first.spin, other.spin) &&
                  same(first.sum, other.sum) && first.radius == other.radius && first.largest == other.largest &&
                  first.extent == other.extent);
      for (int side = 0; side < 2; ++side)
        EXPECT_TRUE(same(first.low[side], other.low[side]) && same(first.high[side], other.high[side]));
    }
  }
}

}  // namespace
}  // namespace pliant
