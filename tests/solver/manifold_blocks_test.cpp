// Compares blocks of sixteen manifolds with the scalar functions bit by bit: every kernel, one and several threads, one
// to four points, fixed bodies, free lanes, the tail.
#include "solver/bodies/manifold_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "solver/kernels.h"
#include "solver/random_support.h"
#include "support/bits.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using testing_support::random_vector;
using testing_support::same_bits;
using testing_support::uniform_float;

Vec3f unit(std::mt19937& random) { return unit_or(random_vector(random, 1), Vec3f{1, 0, 0}); }

/// Bodies and contacts between them. Every seventh body is fixed, and some of those move.
struct Pile {
  std::vector<BodyMotion> motions;
  std::vector<char> is_fixed;
  std::vector<Manifold> manifolds;  ///< in the order of colours
  ManifoldColours colours;
};

BodyMotion random_motion(bool is_fixed, bool moves, std::mt19937& random) {
  BodyMotion m;
  if (moves) {
    m.velocity = random_vector(random, 2);
    m.spin = random_vector(random, 3);
    m.displacement = random_vector(random, 1e-2f);
    m.rotation = random_vector(random, 1e-2f);
  }
  if (is_fixed) return m;
  m.inverse_mass = uniform_float(random, 0.1f, 10);
  // A diagonal that dominates is positive definite.
  m.inverse_inertia = {uniform_float(random, 3, 9),  uniform_float(random, 3, 9),  uniform_float(random, 3, 9),
                       uniform_float(random, -1, 1), uniform_float(random, -1, 1), uniform_float(random, -1, 1)};
  return m;
}

Manifold random_manifold(int a, int b, std::mt19937& random) {
  Manifold m;
  m.a = a;
  m.b = b;
  m.count = 1 + static_cast<int>(random() % 4);
  m.normal = random() % 3 == 0 ? Vec3f{0, 1, 0} : unit(random);
  m.tangent1 = unit_or(cross(m.normal, unit(random)), Vec3f{0, 0, 1});
  m.tangent2 = cross(m.normal, m.tangent1);
  m.arm_a = random_vector(random, 0.5f);
  m.arm_b = random_vector(random, 0.5f);
  constexpr float frictions[] = {0, 0.6f, 10};
  m.friction = frictions[random() % 3];
  m.sliding = random() % 2 == 0 ? 1.f : 0.8f;
  if (random() % 3 == 0) m.drift = {uniform_float(random, -1, 1), uniform_float(random, -1, 1)};
  m.restitution = random() % 2 == 0 ? 0.f : uniform_float(random, 0, 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    m.x[i] = m.count == 1 ? 0.f : uniform_float(random, -0.5f, 0.5f);
    m.y[i] = m.count == 1 ? 0.f : uniform_float(random, -0.5f, 0.5f);
    m.gap[i] = uniform_float(random, -0.01f, 0.01f);
    m.impulse[i] = random() % 4 == 0 ? 0.f : uniform_float(random, 0, 0.5f);
  }
  m.friction_impulse = {uniform_float(random, -0.1f, 0.1f), uniform_float(random, -0.1f, 0.1f)};
  m.twist_impulse = uniform_float(random, -0.1f, 0.1f);
  m.settles = random() % 3 == 0 ? uniform_float(random, 0.01f, 1) : 0;
  return m;
}

/// `of_first` contacts are those of body 1, more than there are colours if it is large.
Pile random_pile(int bodies, int contacts, int of_first, unsigned seed) {
  std::mt19937 random(seed);
  Pile pile;
  for (int i = 0; i < bodies; ++i) {
    pile.is_fixed.push_back(i % 7 == 0 ? 1 : 0);
    pile.motions.push_back(random_motion(i % 7 == 0, i % 14 != 0, random));
  }
  std::vector<std::pair<int, int>> bodies_of;
  for (int i = 0; i < contacts; ++i) {
    int a = i < of_first ? 1 : static_cast<int>(random() % static_cast<unsigned>(bodies)), b = a;
    while (a == b) b = static_cast<int>(random() % static_cast<unsigned>(bodies));
    bodies_of.emplace_back(a, b);
  }
  pile.colours.colour(bodies_of, pile.is_fixed);
  for (const int i : pile.colours.order()) {
    const auto [a, b] = bodies_of[static_cast<std::size_t>(i)];
    pile.manifolds.push_back(random_manifold(a, b, random));
  }
  return pile;
}

constexpr float pile_step = 1.f / 480;
constexpr Vec3f fall{0, -0.025f, 0};
constexpr ContactSoftness pile_softness{0.04f, 0.05f, 0.5f};
constexpr int pile_substeps = 3;

/// Calls function(manifold, a, b) in the order of colours. Fixed bodies stay as they are.
template <class Function>
void one_by_one(Pile& pile, const Function& function) {
  for (Manifold& m : pile.manifolds) {
    const auto ia = static_cast<std::size_t>(m.a), ib = static_cast<std::size_t>(m.b);
    BodyMotion a = pile.motions[ia], b = pile.motions[ib];
    function(m, a, b);
    if (pile.is_fixed[ia] == 0) pile.motions[ia] = a;
    if (pile.is_fixed[ib] == 0) pile.motions[ib] = b;
  }
}

void advance(Pile& pile) {
  for (BodyMotion& m : pile.motions) {
    m.displacement += m.velocity * pile_step;
    m.rotation += m.spin * pile_step;
  }
}

int solve_one_by_one(Pile& pile) {
  int bounces = 0;
  one_by_one(pile, [](Manifold& m, BodyMotion& a, BodyMotion& b) { prepare(m, a, b); });
  for (int substep = 0; substep < pile_substeps; ++substep) {
    one_by_one(pile, [](Manifold& m, BodyMotion& a, BodyMotion& b) { warm_start(m, a, b); });
    bool bounced = false;
    one_by_one(pile, [&](Manifold& m, BodyMotion& a, BodyMotion& b) {
      if (bounce(m, a, b, pile_step, fall)) bounced = true;
    });
    bounces += bounced ? 1 : 0;
    one_by_one(pile,
               [](Manifold& m, BodyMotion& a, BodyMotion& b) { position_pass(m, a, b, pile_step, pile_softness); });
    advance(pile);
    one_by_one(pile, [](Manifold& m, BodyMotion& a, BodyMotion& b) { velocity_pass(m, a, b, pile_step); });
  }
  return bounces;
}

int solve_in_blocks(Pile& pile, const ManifoldKernels& kernels, int threads) {
  Executor executor(threads);
  ManifoldBlocks blocks;
  int bounces = 0;
  std::vector<std::size_t> place_of(pile.manifolds.size());  // of a manifold's number in pile.manifolds
  for (std::size_t i = 0; i < place_of.size(); ++i) place_of[static_cast<std::size_t>(pile.colours.order()[i])] = i;
  const auto manifold = [&](int i) -> Manifold& { return pile.manifolds[place_of[static_cast<std::size_t>(i)]]; };
  blocks.fill(
      executor, pile.colours, pile.is_fixed, [](int) {}, [&](int i) { return manifold(i); });
  EXPECT_EQ(blocks.bounces(), std::any_of(pile.manifolds.begin(), pile.manifolds.end(),
                                          [](const Manifold& m) { return m.restitution > 0; }));
  blocks.prepare(executor, kernels, pile.motions);
  for (int substep = 0; substep < pile_substeps; ++substep) {
    blocks.warm_start(executor, kernels, pile.motions);
    bounces += blocks.bounce(executor, kernels, pile.motions, pile_step, fall) ? 1 : 0;
    blocks.position_pass(executor, kernels, pile.motions, pile_step, pile_softness);
    advance(pile);
    blocks.velocity_pass(executor, kernels, pile.motions, pile_step);
  }
  blocks.take(
      executor, pile.colours, [](int) {},
      [&](int i, const Manifold& m) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(manifold(i).count); ++k) {
          manifold(i).impulse[k] = m.impulse[k];
          manifold(i).gap_now[k] = m.gap_now[k];
        }
        manifold(i).bounced = m.bounced;
        manifold(i).friction_impulse = m.friction_impulse;
        manifold(i).twist_impulse = m.twist_impulse;
      });
  return bounces;
}

bool same(const Vec3f& a, const Vec3f& b) { return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z); }

void expect_same(const Pile& got, const Pile& expected, const std::string& name) {
  for (std::size_t i = 0; i < got.motions.size(); ++i)
    ASSERT_TRUE(same(got.motions[i].velocity, expected.motions[i].velocity) &&
                same(got.motions[i].spin, expected.motions[i].spin))
        << name << ", body " << i << ": " << got.motions[i].velocity.x << ' ' << expected.motions[i].velocity.x;
  for (std::size_t i = 0; i < got.manifolds.size(); ++i) {
    const Manifold &a = got.manifolds[i], &b = expected.manifolds[i];
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_TRUE(same_bits(a.impulse[k], b.impulse[k]) && same_bits(a.gap_now[k], b.gap_now[k]))
          << name << ", contact " << i << ", point " << k << " of " << a.count;
    ASSERT_TRUE(same_bits(a.bounced, b.bounced)) << name << ", contact " << i;
    ASSERT_TRUE(same_bits(a.friction_impulse[0], b.friction_impulse[0]) &&
                same_bits(a.friction_impulse[1], b.friction_impulse[1]) && same_bits(a.twist_impulse, b.twist_impulse))
        << name << ", contact " << i;
  }
}

bool is_finite(const Pile& pile) {
  for (const BodyMotion& m : pile.motions)
    if (!(length(m.velocity) < 1e3f && length(m.spin) < 1e4f)) return false;
  return true;
}

void compare_all(const Pile& pile, bool must_bounce) {
  Pile expected = pile;
  const int bounces = solve_one_by_one(expected);
  EXPECT_TRUE(is_finite(expected));
  if (must_bounce) {
    EXPECT_GT(bounces, 0);
  }
  const std::vector<std::string> names = testing_support::available_code_paths();
  for (const std::string& name : names)
    for (const int threads : {1, 3}) {
      Pile got = pile;
      EXPECT_EQ(solve_in_blocks(got, pick_kernels(name).manifolds, threads), bounces);
      expect_same(got, expected, name);
    }
}

TEST(ManifoldBlocks, GiveTheBitsOfScalarFunctions) {
  for (unsigned seed = 0; seed < 20; ++seed) compare_all(random_pile(30, 60, 0, seed), true);
}

TEST(ManifoldBlocks, GiveTheBitsOfScalarFunctionsOnManyThreads) { compare_all(random_pile(3000, 9000, 0, 1), true); }

TEST(ManifoldBlocks, SolveTheTailOneByOne) {
  const Pile pile = random_pile(40, 100, 60, 3);
  EXPECT_GT(static_cast<int>(pile.manifolds.size()) - pile.colours.tail(), 10);
  compare_all(pile, true);
}

TEST(ManifoldBlocks, TakeAnyNumberOfManifolds) {
  for (const int contacts : {1, 2, 15, 16, 17, 33}) compare_all(random_pile(100, contacts, 0, 5), false);
  Pile none;
  none.colours.colour({}, {});
  compare_all(none, false);
}

}  // namespace
}  // namespace pliant
