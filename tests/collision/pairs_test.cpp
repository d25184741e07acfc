// Compares surface contact with brute force: in every substep of random moving triangles, its contacts are those of all
// pairs, a newly made SurfaceContact gives the same bits, and after the filter nothing crosses.
#include "collision/surfaces/surface_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/pairs_support.h"
#include "collision/random_support.h"
#include "math/vector.h"

namespace pliant {
namespace {

using namespace testing_support;

struct Way {
  const char* name;
  double jitter;  ///< largest random change of each velocity in a substep [m/s]
  Vec3d carried;  ///< velocity of all bodies [m/s]
  Vec3d at;
  int bodies;
  double approach;    ///< relative velocity of the bodies [m/s]
  bool immovable;     ///< true: the lowest body is immovable, but moves kinematically
  Vec3d spin{};       ///< rotation of the highest body [rad/s]
  double gap = 0.12;  ///< distance from one body to the next [m]
};
void PrintTo(const Way& motion, std::ostream* out) { *out << motion.name; }

std::vector<Body> bodies_of(const Way& motion) {
  std::vector<Body> bodies;
  for (int b = 0; b < motion.bodies; ++b) {
    Body body;
    body.mesh = sheet(6, 0.5, motion.at + Vec3d{0.013 * b, motion.gap * b, 0.017 * b});
    body.velocity = motion.carried + Vec3d{0, -motion.approach * b, 0};
    body.movable = !(motion.immovable && b == 0);
    body.meets_itself = body.movable;
    if (!body.movable) body.velocity = motion.carried + Vec3d{0, motion.approach, 0};
    if (b == motion.bodies - 1) body.spin = motion.spin;
    bodies.push_back(body);
  }
  return bodies;
}

class PairsOf : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(
    Motions, PairsOf,
    testing::Values(
        Way{"slow", 0.3, {}, {}, 1, 0, false}, Way{"fast", 20, {}, {}, 1, 0, false},
        Way{"many_edge_lengths", 1000, {}, {}, 1, 0, false}, Way{"free_flight", 0.5, {80, -60, 30}, {}, 1, 0, false},
        Way{"two", 0.1, {}, {}, 2, 2, false}, Way{"two_fast", 3, {}, {-7, -3, -5}, 2, 100, false},
        Way{"three_in_flight", 0.3, {-40, 50, 10}, {}, 3, 3, false}, Way{"immovable", 0.2, {}, {}, 2, 3, true},
        Way{"immovable_fast", 1, {0, 20, 0}, {}, 3, 20, true}, Way{"into_one_another", 20, {}, {}, 3, 200, false},
        Way{"in_flight_into_one_another", 100, {0, 300, 0}, {}, 3, 100, false},
        Way{"far", 0.5, {}, {1e4, -1e4, 1e4}, 2, 3, false}, Way{"far_head_on", 0, {}, {0, 1e4, 0}, 2, 0.6, false},
        Way{"turning", 1.5, {}, {}, 1, 0, false, {40, 60, -30}},
        Way{"two_turning", 0.05, {3, 1, 0}, {}, 2, 1, false, {10, 90, 20}},
        Way{"from_afar", 0.1, {}, {}, 2, 40, false, {}, 0.9}, Way{"crumpling", 4, {}, {}, 1, 0, false, {20, 0, 0}},
        Way{"negative", 2, {}, {-30, -20, -40}, 2, 3, false}, Way{"head_on", 0, {}, {50, 50, 50}, 2, 4.0113, false}),
    [](const auto& named) { return named.param.name; });

/// Free bodies are the same but for the filter, so fewer substeps do.
void expect_right_pairs_and_no_crossing(const Way& way, bool are_free) {
  for (std::uint64_t seed = 1; seed <= (way.bodies < 3 && way.jitter > 0 && !are_free ? 2u : 1u); ++seed) {
    Random random(seed);
    Soup soup(bodies_of(way), true, are_free);
    ASSERT_EQ(soup.crossings(), 0u);
    const int substeps = (way.at.y == 1e4 ? 200 : 40) /
                         (are_free ? 2 : 1);  // in each, bodies move by half a rounding of their positions
    for (int substep = 0; substep < substeps && soup.counts().unresolvable == 0 && !testing::Test::HasFatalFailure();
         ++substep) {
      soup.step(random, way.jitter);
      // A kinematic body can catch what lies between it and another one; other pairs must always be resolvable.
      ASSERT_TRUE(way.immovable || soup.counts().unresolvable == 0);
      const bool flat = way.jitter == 0;  // then exact signs are those of zeros, which are slow to compute
      if (soup.counts().unresolvable == 0 && (!flat || substep == substeps - 1)) {
        ASSERT_EQ(soup.crossings(), 0u) << "seed " << seed << ", substep " << substep;
      }
    }
    EXPECT_TRUE(way.jitter == 0 || are_free || soup.most_contacts > 0);
    if (are_free && way.jitter >= 10) {
      EXPECT_GT(soup.without_velocity, 0u) << "the filter had nothing to do";
    }
  }
}

TEST_P(PairsOf, AreThoseOfBruteForceAndNothingCrosses) { expect_right_pairs_and_no_crossing(GetParam(), false); }

TEST_P(PairsOf, KeepTheirMomentumWhereNothingIsFixed) { expect_right_pairs_and_no_crossing(GetParam(), true); }

TEST(Pairs, CrossWithoutTheFilter) {
  Random random(1);
  Soup soup(bodies_of({"", 300, {}, {}, 2, 0, false}), false);
  std::size_t most = 0;
  for (int substep = 0; substep < 10 && most == 0 && !testing::Test::HasFatalFailure(); ++substep) {
    soup.step(random, 300);
    most = std::max(most, soup.crossings());
  }
  EXPECT_GT(most, 0u);
}

/// Rounding depends on a position's distance from the origin. A body that is far away must not increase the bounds of
/// others.
TEST(Pairs, AreNoMoreWhereAnythingElseIsFarAway) {
  std::vector<Body> bodies = bodies_of({"", 0, {}, {}, 2, 0, false, {}, 0.09});
  for (Body& body : bodies) body.thickness = 5e-4f;
  std::int64_t candidates[2];
  for (const bool far : {false, true}) {
    if (far) {
      bodies.push_back({sheet(2, 0.1, {1e4, 0, 0}), true, false, 5e-4f});
    }
    const PairModel model = model_of(bodies, true);
    SurfaceContact system(model);
    Executor executor(1);
    std::vector<Record> positions = model.shared->rest, remainders(positions.size()), displacements(positions.size());
    const PairParticles particles{positions.data(), remainders.data(), displacements.data(), 1e-3f};
    system.begin_frame(positions.data(), true);
    system.detect(executor, particles);
    candidates[far ? 1 : 0] = system.counts().candidates;
  }
  EXPECT_GT(candidates[0], 0);
  EXPECT_EQ(candidates[0], candidates[1]);
}

/// The filter's margin grows with the rounding of positions, so lists made near the origin are not valid far from it.
TEST(Pairs, AreLookedForAnewFarFromWhereTheyWere) {
  std::vector<Body> bodies = bodies_of({"", 0, {}, {}, 2, 0, false, {}, 0.09});
  for (Body& body : bodies) {
    body.thickness = 5e-4f;
    body.meets_itself = false;
  }
  const PairModel model = model_of(bodies, true);
  Executor executor(1);
  for (const bool returns : {false, true}) {
    std::vector<Record> positions = model.shared->rest, remainders(positions.size()), displacements(positions.size());
    const PairParticles particles{positions.data(), remainders.data(), displacements.data(), 1e-3f};
    const auto plan = [&](float along, float upper) {
      for (std::size_t i = 0; i < positions.size(); ++i)
        displacements[i] = {along, model.shared->vertex_body[i] == 1 ? upper : 0.f, 0, 0};
    };
    const auto step = [&](SurfaceContact& system) {
      system.detect(executor, particles);
      for (Contact& contact : system.contacts()) project_contact(contact, particles.displacements);
      system.filter(executor, particles, none_free);
      system.end_substep(executor, particles, false);
      return system.counts().truncated;
    };
    SurfaceContact system(model);
    const auto go = [&](float along, float upper) {
      plan(along, upper);
      EXPECT_EQ(step(system), 0);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i].x += displacements[i].x;
        positions[i].y += displacements[i].y;
      }
    };
    if (returns)
      for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i].x += 5e4f;
        positions[i].y += model.shared->vertex_body[i] == 1 ? 0.2f : 0.f;
      }
    system.begin_frame(positions.data(), true);
    if (returns) {
      go(-5e4f, 0);
      for (int i = 0; i < 2; ++i) go(0, -0.1f);  // so that lists are made there
    }
    go(5e4f, 0);
    // The upper body comes closer. Here 32 roundings are a tenth of a metre.
    plan(0, -0.03f);
    const std::vector<Record> predicted = displacements;
    SurfaceContact fresh(model);
    fresh.begin_frame(positions.data(), true);
    const std::int64_t wanted = step(fresh);
    EXPECT_GT(wanted, 0);
    displacements = predicted;
    EXPECT_EQ(step(system), wanted) << (returns ? "from afar and back" : "from the origin");
  }
}

TEST(Pairs, OutliveWhatIsNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38f}) {
    const PairModel model = model_of(bodies_of({"", 0, {}, {}, 2, 0, false}), true);
    SurfaceContact system(model);
    Executor executor(1);
    std::vector<Record> positions = model.shared->rest, remainders(positions.size()), displacements(positions.size());
    const PairParticles particles{positions.data(), remainders.data(), displacements.data(), 1e-3f};
    system.begin_frame(positions.data(), true);
    for (const bool spoilt : {true, false, true, false}) {
      displacements.assign(positions.size(), Record{0, -0.01f, 0, 0});
      if (spoilt) displacements[7] = {0, bad, 0, 0};
      system.detect(executor, particles);
      for (Contact& contact : system.contacts()) project_contact(contact, particles.displacements);
      system.filter(executor, particles, none_free);
      system.end_substep(executor, particles, false);
      if (!spoilt) {
        for (const Record& d : displacements) ASSERT_TRUE(std::isfinite(d.y));
      }
    }
  }
}

}  // namespace
}  // namespace pliant
