// Chains and tethers: the exact solution against elimination in double, every build against the sequential reference, and
// what a schedule of chains must be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "model/compiled_object.h"
#include "model/model.h"
#include "pliant/mesh.h"
#include "solver/sweeps/chains.h"
#include "support/bits.h"
#include "support/kernels.h"
#include "topology/edges.h"

namespace pliant {
namespace {

using testing_support::available_isas;
using testing_support::nasty_float;
using testing_support::same_bits;

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}

Object line(int links, float compliance, std::mt19937& random) {
  Object object;
  ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(compliance), {}};
  Vec3f at{};
  for (int i = 0; i <= links; ++i) {
    object.positions.push_back(at);
    object.masses.push_back(static_cast<float>(uniform(random, 0.1, 2)));
    at += Vec3f{0.1f, static_cast<float>(uniform(random, -0.02, 0.02)), static_cast<float>(uniform(random, -0.02, 0.02))};
    if (i > 0) group.particles.insert(group.particles.end(), {i - 1, i});
  }
  object.constraints.push_back(group);
  return object;
}

Object grid(int columns, int rows, float compliance) {
  const TriangleMesh mesh = grid_mesh(columns, rows, 1, 1);
  Object object;
  object.positions = mesh.positions;
  object.masses.assign(mesh.positions.size(), 0.01f);
  object.triangles = mesh.triangles;
  ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(compliance), {}};
  for (const Edge& edge : find_edges(mesh.triangles, columns * rows))
    group.particles.insert(group.particles.end(), {edge.a, edge.b});
  object.constraints.push_back(group);
  return object;
}

CompileOptions chained(float softness, bool tethers = false) {
  CompileOptions options;
  options.chains = true;
  options.chain_softness = softness;
  options.tethers = tethers;
  return options;
}

/// One object in the middle of a substep.
struct Substep {
  CompiledObject object;
  Records positions, displacements;
  AlignedVector<float> multipliers, scratch;
  float h = 1.f / 600;

  Substep(const Object& from, const CompileOptions& options) : object(compile(from, options)) {
    positions.assign(object.positions.begin(), object.positions.end());
    displacements.resize(positions.size());
    multipliers.assign(object.pools[0].origin.size(), 0.f);
    int longest = 0;
    for (const ChainBatch& chain : object.chains) longest = std::max(longest, chain.steps);
    scratch.resize(static_cast<std::size_t>(longest) * chain_scratch_floats);
  }
  SweepArguments arguments(bool first) {
    SweepArguments a;
    a.positions = positions.data();
    a.displacements = displacements.data();
    a.h = h;
    a.inverse_h = 1 / h;
    a.inverse_h2 = a.inverse_h * a.inverse_h;
    a.first_pass = first;
    return a;
  }
  void solve(const ChainKernels& kernels, bool first, bool keeps) {
    for (std::size_t c = 0; c < object.chains.size(); ++c) {
      const ChainBatch& chain = object.chains[c];
      kernels.solve_chain(object.pools[chain.pool], &object.segments[chain.first_segment], chain.steps,
                          &object.chain_softness[c * batch_width], keeps ? multipliers.data() : nullptr, arguments(first),
                          scratch.data());
    }
  }
  void hold(const ChainKernels& kernels) {
    Records anchors;
    for (int anchor : object.tethers.anchors) {
      anchors.push_back(positions[anchor]);
      anchors.push_back(displacements[anchor]);
    }
    kernels.hold_tethers(object.tethers, anchors.data(), 0, object.particles, arguments(true));
  }
};

// ---------------------------------------------------------------- the exact solution

/// (J W J^T + s) dlambda = -C - alpha~ lambda by elimination with pivoting, all in double.
std::vector<double> solve_in_double(std::vector<std::vector<double>> matrix, std::vector<double> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::fabs(matrix[i][k]) > std::fabs(matrix[pivot][k])) pivot = i;
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double share = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= share * matrix[k][j];
      right[i] -= share * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) right[k] -= matrix[k][j] * right[j];
    right[k] /= matrix[k][k];
  }
  return right;
}

TEST(Chains, give_the_solution_of_the_dense_system) {
  std::mt19937 random(11);
  for (const float softness : {0.f, 0.1f, 10.f}) {
    for (const float compliance : {0.f, 1e-6f}) {
      const int links = 1 + static_cast<int>(random() % 40);
      Object from = line(links, compliance, random);
      from.pins.push_back({0, {}});
      Substep substep(from, chained(softness));
      std::vector<Vec3d> x;
      for (int i = 0; i <= links; ++i) {
        Record& d = substep.displacements[substep.object.place[i]];
        d = {static_cast<float>(uniform(random, -0.01, 0.01)), static_cast<float>(uniform(random, -0.01, 0.01)), 0, 0};
        const Record& p = substep.positions[substep.object.place[i]];
        x.push_back({double(p.x) + d.x, double(p.y) + d.y, double(p.z) + d.z});
      }
      const auto w = [&](int i) { return double(substep.positions[substep.object.place[i]].w); };
      std::vector<Vec3d> n;
      std::vector<double> right;
      for (int k = 0; k < links; ++k) {
        const Vec3d e = x[k + 1] - x[k];
        const double length = std::sqrt(length_squared(e));
        const Vec3f rest = from.positions[k + 1] - from.positions[k];
        n.push_back(e * (1 / length));
        right.push_back(std::sqrt(double(dot(rest, rest))) - length);
      }
      std::vector<std::vector<double>> matrix(links, std::vector<double>(links, 0.0));
      double mass = 0;
      for (int i = 1; i <= links; ++i) mass += 1 / w(i);
      for (int k = 0; k < links; ++k) {
        matrix[k][k] = w(k) + w(k + 1) + double(softness) / mass + double(compliance) / (double(substep.h) * substep.h);
        if (k > 0) matrix[k][k - 1] = matrix[k - 1][k] = -w(k) * dot(n[k - 1], n[k]);
      }
      const std::vector<double> change = solve_in_double(matrix, right);
      substep.solve(chain_kernels_sequential(), true, true);
      for (int i = 0; i <= links; ++i) {
        Vec3d expected = x[i];
        if (i > 0) expected += n[i - 1] * (w(i) * change[i - 1]);
        if (i < links) expected -= n[i] * (w(i) * change[i]);
        const Record &p = substep.positions[substep.object.place[i]], &d = substep.displacements[substep.object.place[i]];
        EXPECT_NEAR(double(p.x) + d.x, expected.x, 1e-5);
        EXPECT_NEAR(double(p.y) + d.y, expected.y, 1e-5);
        EXPECT_NEAR(double(p.z) + d.z, expected.z, 1e-5);
      }
    }
  }
}

TEST(Chains, keep_momentum) {
  std::mt19937 random(2);
  Substep substep(line(60, 0, random), chained(0.1f));
  for (Record& d : substep.displacements) d = {static_cast<float>(uniform(random, -0.01, 0.01)), 0.02f, 0, 0};
  const auto momentum = [&] {
    Vec3d sum{};
    for (std::size_t i = 0; i < substep.positions.size(); ++i) {
      const Record& d = substep.displacements[i];
      sum += Vec3d{d.x, d.y, d.z} * (1 / double(substep.positions[i].w));
    }
    return sum;
  };
  const Vec3d before = momentum();
  substep.solve(chain_kernels_sequential(), true, false);
  const Vec3d after = momentum();
  EXPECT_NEAR(after.x, before.x, 2e-6);
  EXPECT_NEAR(after.y, before.y, 2e-6);
  EXPECT_NEAR(after.z, before.z, 2e-6);
}

// ---------------------------------------------------------------- lanes

void expect_same(const Records& a, const Records& b, const std::string& what) {
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_TRUE(same_bits(a[i].x, b[i].x) && same_bits(a[i].y, b[i].y) && same_bits(a[i].z, b[i].z) &&
                same_bits(a[i].w, b[i].w))
        << what << ", record " << i;
}

void disturb(Substep& substep, std::mt19937& random, bool nasty) {
  const auto number = [&] { return nasty ? nasty_float(random) : static_cast<float>(uniform(random, -0.02, 0.02)); };
  for (Record& d : substep.displacements) d = {number(), number(), number(), 0};
  for (float& m : substep.multipliers) m = 1e-3f * number();
  for (std::size_t i = 0; i < substep.positions.size(); ++i)
    if (random() % 7 == 0 &&
        std::count(substep.object.tethers.anchors.begin(), substep.object.tethers.anchors.end(), i) == 0)
      substep.positions[i].w = random() % 2 == 0 ? 0.f : 1e5f;
}

TEST(Chains, and_tethers_give_the_bits_of_the_reference_in_lanes) {
  std::mt19937 random(4);
  for (int round = 0; round < 24; ++round) {
    const bool nasty = round % 3 == 2;
    Object from =
        grid(3 + static_cast<int>(random() % 30), 3 + static_cast<int>(random() % 20), round % 2 == 0 ? 0.f : 1e-6f);
    for (int pin = 0; pin < round % 7; ++pin) from.pins.push_back({static_cast<int>(random() % from.positions.size()), {}});
    Substep start(from, chained(0.1f, true));
    disturb(start, random, nasty);
    Substep reference = start;
    for (bool first : {true, false}) {
      reference.solve(chain_kernels_sequential(), first, true);
      reference.hold(chain_kernels_sequential());
    }
    for (const std::string& isa : available_isas()) {
      Substep substep = start;
      ASSERT_STREQ(chain_kernels(isa.c_str()).isa, isa.c_str());
      for (bool first : {true, false}) {
        substep.solve(chain_kernels(isa.c_str()), first, true);
        substep.hold(chain_kernels(isa.c_str()));
      }
      ASSERT_NO_FATAL_FAILURE(expect_same(substep.displacements, reference.displacements, isa));
      for (std::size_t i = 0; i < substep.multipliers.size(); ++i)
        ASSERT_TRUE(substep.object.pools[0].origin[i] < 0 || same_bits(substep.multipliers[i], reference.multipliers[i]))
            << isa;
    }
  }
}

// ---------------------------------------------------------------- the schedule

TEST(Chains, hold_every_distance_once_and_batches_of_a_colour_share_nothing) {
  Object from = grid(40, 23, 0);
  from.attachments.push_back({5, {0, 1, 0}, {}, Stiffness::rigid()});  // has no direction: stays with the tiles
  const CompiledObject object = compile(from, chained(0.1f));
  std::vector<int> times(from.constraints[0].particles.size() / 2 + 1, 0);
  for (const Pool& pool : object.pools)
    for (int origin : pool.origin)
      if (origin >= 0) ++times[origin];
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  for (const ChainColour& colour : object.chain_colours) {
    std::map<int, int> batch_of;
    for (int b = colour.first_batch; b < colour.last_batch; ++b) {
      const ChainBatch& chain = object.chains[b];
      for (int k = 0; k < chain.steps; ++k) {
        const Segment& segment = object.segments[chain.first_segment + k];
        EXPECT_EQ(segment.first_batch, object.segments[chain.first_segment].first_batch + k);
        for (int lane = 0; lane < segment.last_count; ++lane)
          for (int slot = 0; slot < 2; ++slot) {
            const int particle = object.pools[chain.pool].indices[segment.index_offset + slot * batch_width + lane];
            EXPECT_EQ(batch_of.emplace(particle, b * batch_width + lane).first->second, b * batch_width + lane);
          }
      }
    }
  }
}

TEST(Tethers, are_as_long_as_the_straight_way_on_a_flat_sheet) {
  Object from = grid(13, 9, 0);
  from.pins = {{0, {}}, {12, {}}};
  const CompiledObject object = compile(from, chained(0.1f, true));
  ASSERT_EQ(object.tethers.slots, 2);
  for (int particle = 0; particle < object.particles; ++particle) {
    for (int slot = 0; slot < 2; ++slot) {
      const int place = particle % batch_width, lane = 4 * (place % 4) + place / 4;
      const std::size_t row = static_cast<std::size_t>(particle / batch_width) * 2 + slot;
      const float length = object.tethers.lengths[row * batch_width + lane];
      if (object.positions[particle].w == 0) {
        EXPECT_EQ(length, no_tether);
        continue;
      }
      const Record &x = object.positions[particle], &anchor = object.positions[object.tethers.anchors[slot]];
      EXPECT_NEAR(length, std::hypot(x.x - anchor.x, x.z - anchor.z), 1e-5);
    }
  }
}

TEST(Tethers, bring_back_what_is_beyond_them_and_nothing_else) {
  std::mt19937 random(8);
  Object from = grid(21, 17, 0);
  from.pins = {{3, {}}};
  Substep substep(from, chained(0.1f, true));
  for (std::size_t i = 0; i < substep.positions.size(); ++i)
    if (substep.positions[i].w > 0)
      substep.displacements[i] = {static_cast<float>(uniform(random, -0.3, 0.3)),
                                  static_cast<float>(uniform(random, -0.3, 0.3)), 0, 0};
  const int anchor = substep.object.tethers.anchors[0];
  substep.displacements[anchor] = {0.1f, 0, 0, 0};  // pins may move
  const Records before = substep.displacements;
  substep.hold(chain_kernels_sequential());
  int moved = 0;
  for (int i = 0; i < substep.object.particles; ++i) {
    if (i == anchor) continue;
    const Record &p = substep.positions[i], &d = substep.displacements[i], &a = substep.positions[anchor];
    const auto away = [&](const Record& by) {
      return std::hypot(double(p.x) + by.x - a.x - 0.1f, double(p.y) + by.y - a.y, double(p.z) + by.z - a.z);
    };
    const double longest = std::hypot(double(p.x) - a.x, double(p.z) - a.z);
    EXPECT_LE(away(d), longest + 1e-5);
    if (away(before[i]) < longest - 1e-5) {
      EXPECT_EQ(d.x, before[i].x);
    }
    if (d.x != before[i].x) {
      ++moved;
      EXPECT_NEAR(away(d), longest, 1e-5);
    }
  }
  EXPECT_GT(moved, 50);
}

}  // namespace
}  // namespace pliant
