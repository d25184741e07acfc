// Tests the schedule of chains, and that tethers are as long as the way to the pins to which they lead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "solver/chains_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Chains, hold_every_distance_once_and_batches_of_a_colour_share_nothing) {
  Object from = grid(40, 23, 0);
  from.attachments.push_back(
      {5, {0, 1, 0}, {}, Stiffness::rigid()});  // it has no direction, so it stays with the tiles
  const CompiledObject object = compile(from, chained(0.1f));
  std::vector<int> times(from.constraints[0].particles.size() / 2 + 1, 0);
  for (const Pool& pool : object.pools)
    for (int origin : pool.origin)
      if (origin >= 0) ++times[origin];
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  for (const ObjectPhase& colour : object.phases) {
    if (colour.driver != Driver::chain) continue;
    std::map<int, int> batch_of;
    for (int b = colour.first; b < colour.last; ++b) {
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

/// Calls visit(position in the pool, index of the constraint) for every link.
template <class Visit>
void for_links(const CompiledObject& object, const Visit& visit) {
  for (const ChainBatch& chain : object.chains) {
    const Pool& pool = object.pools[chain.pool];
    for (int k = 0; k < chain.steps; ++k) {
      const Segment& segment = object.segments[chain.first_segment + k];
      for (int lane = 0; lane < segment.last_count; ++lane)
        visit(pool, segment.first_batch, lane, pool.origin[segment.first_batch * batch_width + lane]);
    }
  }
}

TEST(Chains, take_each_distance_with_its_own_numbers) {
  std::mt19937 random(6);
  Object from = line(40, 0, random);
  ConstraintGroup& links = from.constraints[0];
  for (int i = 0; i < 40; ++i) {
    links.compliances.push_back(1e-6f * static_cast<float>(i + 1));
    links.rest.push_back(0.1f + 0.001f * static_cast<float>(i));
  }
  from.attachments.push_back({5, {0, 1, 0}, {}, Stiffness::rigid()});
  const CompiledObject object = compile(from, chained(0));
  int found = 0;
  for_links(object, [&](const Pool& pool, int batch, int lane, int number) {
    ASSERT_LT(number, 40) << "an attachment has no direction";
    EXPECT_EQ(pool.row(0, batch)[lane], links.rest[number]);
    EXPECT_EQ(pool.row(1, batch)[lane], links.compliances[number]);
    ++found;
  });
  EXPECT_EQ(found, 40);
}

/// The particles that links of chains join, by the user's numbers; targets of attachments come after all particles.
std::vector<int> joined(const CompiledObject& object) {
  std::vector<int> ends;
  for (const ChainBatch& chain : object.chains)
    for (int k = 0; k < chain.steps; ++k) {
      const Segment& segment = object.segments[chain.first_segment + k];
      for (int slot = 0; slot < 2; ++slot)
        for (int lane = 0; lane < segment.last_count; ++lane)
          ends.push_back(
              object.order[object.pools[chain.pool].indices[segment.index_offset + slot * batch_width + lane]]);
    }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

// Attachments are projected before the chains, which would pull a held particle off its target.
TEST(Chains, end_at_the_targets_of_rigid_attachments) {
  std::mt19937 random(6);
  const Object from = line(4, 0, random);
  const auto joined_with = [&](const Stiffness& stiffness, float gap, bool is_pinned = false) {
    Object object = from;
    object.attachments.push_back({4, object.positions[4] + Vec3f{gap, 0, 0}, {}, stiffness});
    if (is_pinned) object.pins.push_back({4, {}});
    return joined(compile(object, chained(0)));
  };
  const std::vector<int> own{0, 1, 2, 3, 4}, at_target{0, 1, 2, 3, 5};
  for (const Stiffness& rigid : {Stiffness::rigid(), Stiffness::compliance(1e-8f), Stiffness::pbd(1)})
    EXPECT_EQ(joined_with(rigid, 0.01f), at_target);
  for (const Stiffness& yields : {Stiffness::compliance(1e-5f), Stiffness::pbd(0.9f)})
    EXPECT_EQ(joined_with(yields, 0), own);
  EXPECT_EQ(joined_with(Stiffness::rigid(), 0.02f), own) << "0.4 m long, it would be torn away";
  EXPECT_EQ(joined_with(Stiffness::rigid(), 0, true), own) << "the pin keeps it";
}

TEST(Tethers, lead_to_pins_and_to_attachments_that_act_like_pins) {
  Object object = grid(9, 9, 0);  // 0.8 kg
  object.pins.push_back({0, {}});
  object.attachments.push_back({8, object.positions[8], {}, Stiffness::compliance(1e-4f)});
  object.attachments.push_back({72, object.positions[72], {}, Stiffness::compliance(1e-3f)});
  object.attachments.push_back({80, object.positions[80] + Vec3f{0.01f, 0, 0}, {}, Stiffness::rigid()});
  const CompiledObject compiled = compile(object, chained(0, true));
  std::vector<int> anchors;
  for (const int storage : compiled.tethers.anchors) anchors.push_back(compiled.order[storage]);
  std::sort(anchors.begin(), anchors.end());
  EXPECT_EQ(anchors, (std::vector<int>{0, 81}));
}

TEST(Chains, leave_damped_and_pbd_distances_to_the_tiles) {
  for (const Stiffness& other : {Stiffness::compliance(1e-5f, 0.1f), Stiffness::pbd(0.5f)}) {
    std::mt19937 random(6);
    Object from = line(6, 0, random);
    std::vector<int>& pairs = from.constraints[0].particles;
    from.constraints.insert(from.constraints.begin(), {"distance", {pairs.begin(), pairs.begin() + 6}, {}, other, {}});
    from.constraints[1].particles.erase(from.constraints[1].particles.begin(),
                                        from.constraints[1].particles.begin() + 6);
    std::vector<int> numbers;
    for_links(compile(from, chained(0)), [&](const Pool&, int, int, int number) { numbers.push_back(number); });
    std::sort(numbers.begin(), numbers.end());
    EXPECT_EQ(numbers, (std::vector<int>{3, 4, 5})) << "numbered among all distances of the object";
  }
}

/// The tethers of a particle, ascending: their lengths, and the pins at their ends.
std::vector<std::pair<float, int>> tethers_of(const CompiledObject& object, int particle) {
  const Tethers& tethers = object.tethers;
  const int place = particle % batch_width, lane = 4 * (place % 4) + place / 4;
  std::vector<std::pair<float, int>> found;
  for (int slot = 0; slot < tethers.slots; ++slot) {
    const std::size_t row = static_cast<std::size_t>(particle / batch_width) * tethers.slots + slot;
    const float length = tethers.lengths[row * batch_width + lane];
    const Tethers::Row& of = tethers.rows[row];
    const int anchor = of.anchor >= 0 ? of.anchor : tethers.lane_anchors[of.lanes + lane];
    if (length < no_tether) found.emplace_back(length, tethers.anchors[anchor]);
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Tethers, lead_to_the_four_nearest_of_many_pins) {
  Object from = grid(17, 13, 0);
  for (int pin : {0, 16, 60, 104, 130, 204, 220}) from.pins.push_back({pin, {}});
  CompileOptions options = chained(0.1f, true);
  options.tether_slack = 0.25f;
  const CompiledObject object = compile(from, options);
  ASSERT_EQ(object.tethers.anchors.size(), 7U);
  for (int particle = 0; particle < object.particles; ++particle) {
    const std::vector<std::pair<float, int>> found = tethers_of(object, particle);
    const Record& x = object.positions[particle];
    if (x.w == 0) {
      EXPECT_TRUE(found.empty());
      continue;
    }
    std::vector<double> straight;
    for (int anchor : object.tethers.anchors)
      straight.push_back(1.25 * std::hypot(x.x - object.positions[anchor].x, x.z - object.positions[anchor].z));
    std::sort(straight.begin(), straight.end());
    ASSERT_EQ(found.size(), 4U);
    EXPECT_NEAR(found[0].first, straight[0], 1e-5);
    for (const auto& [length, pin] : found) {  // a pin behind four others may count as a little farther than it is
      const Record& anchor = object.positions[pin];
      const double own = 1.25 * std::hypot(x.x - anchor.x, x.z - anchor.z);
      EXPECT_GT(length, own - 1e-5) << "another's pin, or the slack left out";
      EXPECT_LT(length, 1.05 * own + 1e-5);
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
  ChainedSubstep substep(from, chained(0.1f, true));
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
