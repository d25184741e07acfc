// Edits of large objects keep the schedule of what they do not reach, and the schedule stays sound: each constraint
// once, none that share a particle at the same time. What is saved between edits goes on with the same bits.
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "constraints/registry.h"
#include "math/vector.h"
#include "model/keep_schedule.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/save.h"
#include "tears/tears_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A block of more than one tile that is nearly incompressible, so that volumes are joined around edges.
Object large_block(int cells = 14) {
  SoftBodyOptions options;
  options.material.poisson_ratio = 0.45f;
  return make_soft_body(box_tetrahedra({1, 1, 1}, {cells, cells, cells}), options);
}

/// Cuts a box out of a soft body: what is between two places along x, and above y = end.
Edit opened(const Object& object, float first, float last, float end) {
  const auto tetrahedra = tetrahedra_of(object);
  std::vector<int> part;
  for (const auto& t : tetrahedra) {
    Vec3f middle{};
    for (const int corner : t) middle = middle + object.positions[static_cast<std::size_t>(corner)] * 0.25f;
    part.push_back(middle.x > first && middle.x < last && middle.y > end ? 1 : 0);
  }
  return part_tetrahedra(object, part);
}

/// The constraints of a type in a compiled object, by the user's index of their particles, in ascending order, with how
/// often they are there.
using Counts = std::map<std::pair<int, std::vector<int>>, int>;

/// Checks the segments of a colour: no particle twice, all in the tile. Counts what is in it.
void count_colour(const CompiledObject& object, int first, int last, const Tile* tile, Counts& counts) {
  std::vector<char> is_used(static_cast<std::size_t>(object.particles));
  for (int s = first; s < last; ++s) {
    const Segment& segment = object.segments[static_cast<std::size_t>(s)];
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    const bool is_partly_contiguous = segment.runs != 0 && segment.runs != (1 << pool.stencil) - 1;
    EXPECT_TRUE(!is_partly_contiguous || segment.last_count == 4) << "such groups fill their batches";
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment))
      for (int lane = 0; lane < batch_width; ++lane) {
        if (!lane_is_valid(segment, batch, lane)) continue;
        std::set<int> particles;
        for (int slot = 0; slot < pool.stencil; ++slot) particles.insert(particle_of(segment, index, slot, lane));
        std::vector<int> users;
        for (const int p : particles) {
          ASSERT_EQ(is_used[static_cast<std::size_t>(p)]++, 0) << "two of a colour share a particle";
          ASSERT_TRUE(tile == nullptr || (p >= tile->first_particle && p < tile->last_particle));
          users.push_back(object.order[static_cast<std::size_t>(p)]);
        }
        std::sort(users.begin(), users.end());
        ++counts[{pool.type, users}];
      }
  }
}

Counts count_all(const CompiledObject& object) {
  Counts counts;
  for (const Tile& tile : object.tiles)
    for (int s = tile.first_segment; s < tile.last_segment; ++s) count_colour(object, s, s + 1, &tile, counts);
  for (const ObjectPhase& phase : object.phases)
    if (phase.driver == Driver::inter_tile) count_colour(object, phase.first, phase.last, nullptr, counts);
  return counts;
}

/// Replaces volumes around edges by those of their tetrahedra, which are the same however they are joined.
Counts without_fans(const CompiledObject& object) {
  Counts counts = count_all(object);
  const int around = find_constraint_type("volume_around_edge"), volume = find_constraint_type("tetrahedron_volume");
  std::erase_if(counts, [around](const auto& one) { return one.first.first == around; });
  for (const KeptSchedule::Fan& fan : object.fans)
    for (int i = 0; i < fan.count; ++i) {
      std::vector<int> corners{fan.a, fan.b, fan.ring[static_cast<std::size_t>(i)],
                               fan.ring[static_cast<std::size_t>((i + 1) % fan.ring_size)]};
      std::sort(corners.begin(), corners.end());
      ++counts[{volume, corners}];
    }
  return counts;
}

/// How many constraints were coloured by edits.
int added_constraints(const CompiledObject& object) {
  int count = 0;
  for (const KeptSchedule::Colour& colour : schedule_of(object).colours)
    if (colour.is_added) count += static_cast<int>(colour.constraints.size());
  return count;
}

void expect_same_schedule(const CompiledObject& one, const CompiledObject& other) {
  EXPECT_EQ(one.order, other.order);
  ASSERT_EQ(one.pools.size(), other.pools.size());
  for (std::size_t i = 0; i < one.pools.size(); ++i) {
    EXPECT_EQ(one.pools[i].indices, other.pools[i].indices);
    EXPECT_EQ(one.pools[i].origin, other.pools[i].origin);
    EXPECT_TRUE(one.pools[i].blocks == other.pools[i].blocks);
  }
  ASSERT_EQ(one.segments.size(), other.segments.size());
  for (std::size_t i = 0; i < one.segments.size(); ++i) {
    EXPECT_EQ(one.segments[i].pool, other.segments[i].pool);
    EXPECT_EQ(one.segments[i].index_offset, other.segments[i].index_offset);
  }
  EXPECT_EQ(one.phases.size(), other.phases.size());
}

TEST(KeptSchedule, KeepsAllButWhatAnEditReaches) {
  const Object block = large_block();
  const CompiledObject before = compile(block, CompileOptions{});
  ASSERT_GT(before.tiles.size(), 1u);
  ASSERT_FALSE(before.fans.empty());
  const Edit edit = opened(block, 0.01f, 1, 0.3f);
  const std::optional<KeptSchedule> kept = follow_edit(before, edit.object, edit.from);
  ASSERT_TRUE(kept);
  const CompiledObject after = compile(edit.object, CompileOptions{}, &*kept);
  EXPECT_EQ(without_fans(after), without_fans(compile(edit.object, CompileOptions{})));
  for (int i = 0; i < before.particles; ++i)
    ASSERT_EQ(before.order[static_cast<std::size_t>(i)], after.order[static_cast<std::size_t>(i)]);
  const int copies = after.particles - before.particles;
  EXPECT_GT(copies, 20);
  EXPECT_GT(added_constraints(after), copies);
  // At a particle in a grid of six tetrahedra a cell there are up to 14 edges, 24 tetrahedra and as many volumes;
  // groups of four go with them.
  EXPECT_LT(added_constraints(after), 2 * 4 * 62 * copies);
  EXPECT_LT(added_constraints(after), static_cast<int>(count_all(after).size()) / 8);
}

TEST(KeptSchedule, IsThatOfTheObjectIfNothingChanges) {
  const Object block = large_block();
  const CompiledObject before = compile(block, CompileOptions{});
  const Edit edit = unchanged(block);
  const std::optional<KeptSchedule> kept = follow_edit(before, edit.object, edit.from);
  ASSERT_TRUE(kept);
  expect_same_schedule(compile(edit.object, CompileOptions{}, &*kept), before);
}

TEST(KeptSchedule, StaysSoundOverManyEdits) {
  Object block = large_block();
  CompiledObject now = compile(block, CompileOptions{});
  for (int i = 0; i < 6; ++i) {
    const float place = 0.15f * static_cast<float>(i) - 0.45f;
    Edit edit = i == 3 ? remove_tetrahedra(block, std::vector<int>{5, 900, 901, 7000})
                       : opened(block, place, place + 0.1f, 0.4f);
    const std::optional<KeptSchedule> kept = follow_edit(now, edit.object, edit.from);
    ASSERT_TRUE(kept);
    now = compile(edit.object, CompileOptions{}, &*kept);
    block = std::move(edit.object);
    EXPECT_EQ(without_fans(now), without_fans(compile(block, CompileOptions{}))) << "edit " << i;
    const KeptSchedule again = schedule_of(now);
    const CompiledObject loaded = compile(block, CompileOptions{}, &again);
    expect_same_schedule(loaded, now);
    EXPECT_EQ(loaded.additions.segments, now.additions.segments);
  }
}

TEST(KeptSchedule, IsMadeAnewWhereItIsBetter) {
  const Object block = large_block();
  const CompiledObject before = compile(block, CompileOptions{});
  std::vector<int> part(tetrahedra_of(block).size());
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<int>(i);
  const Edit dust = part_tetrahedra(block, part);
  EXPECT_FALSE(follow_edit(before, dust.object, dust.from)) << "nearly all is new";
  for (const float ratio : {0.3f, 0.45f}) {  // the same particles, but volumes are joined otherwise
    SoftBodyOptions options;
    options.material.poisson_ratio = ratio;
    Edit other = unchanged(block);
    other.object.constraints = make_soft_body(box_tetrahedra({1, 1, 1}, {14, 14, 14}), options).constraints;
    const std::optional<KeptSchedule> kept = follow_edit(before, other.object, other.from);
    ASSERT_TRUE(kept);
    const CompiledObject now = compile(other.object, CompileOptions{}, &*kept);
    EXPECT_EQ(now.fans.empty(), ratio < 0.4f);
    expect_same_schedule(now, compile(other.object, CompileOptions{}));
    EXPECT_EQ(now.additions.are_used, ratio > 0.4f);
  }
  Edit damped = unchanged(block);
  for (ConstraintGroup& group : damped.object.constraints) group.stiffness.damping = 0.1f;
  const std::optional<KeptSchedule> kept = follow_edit(before, damped.object, damped.from);
  ASSERT_TRUE(kept);
  expect_same_schedule(compile(damped.object, CompileOptions{}, &*kept), compile(damped.object, CompileOptions{}));
  Edit reversed = unchanged(block);
  std::reverse(reversed.from.begin(), reversed.from.end());
  EXPECT_FALSE(follow_edit(before, reversed.object, reversed.from)) << "particles have changed places";
  const Object small = large_block(4);
  const Edit edit = opened(small, 0.01f, 1, 0);
  EXPECT_FALSE(follow_edit(compile(small, CompileOptions{}), edit.object, edit.from)) << "one tile";
}

TEST(KeptSchedule, FindsConstraintsThatAreInAnotherOrder) {
  const Object block = large_block();
  const CompiledObject before = compile(block, CompileOptions{});
  Edit edit = unchanged(block);
  for (ConstraintGroup& group : edit.object.constraints) {
    if (group.type != "distance" || !group.rest.empty()) continue;
    std::vector<int> turned;
    for (std::size_t i = group.particles.size(); i > 0; i -= 2)
      turned.insert(turned.end(), {group.particles[i - 1], group.particles[i - 2]});
    group.particles = turned;
  }
  const std::optional<KeptSchedule> kept = follow_edit(before, edit.object, edit.from);
  ASSERT_TRUE(kept);
  const CompiledObject after = compile(edit.object, CompileOptions{}, &*kept);
  EXPECT_EQ(added_constraints(after), 0);
  EXPECT_EQ(count_all(after), count_all(before));
}

TEST(KeptSchedule, OfAFileMayHaveAnyNumbers) {
  const Object block = large_block(13);
  const CompiledObject before = compile(block, CompileOptions{});
  const Counts counts = without_fans(before);
  std::mt19937 random(5);
  for (int i = 0; i < 40; ++i) {
    KeptSchedule kept = schedule_of(before);
    for (int changes = 0; changes < 20; ++changes) {
      KeptSchedule::Colour& colour = kept.colours[random() % kept.colours.size()];
      KeptSchedule::Fan& fan = kept.fans[random() % kept.fans.size()];
      const int number = static_cast<int>(random() % 30000) - 100;
      switch (random() % 9) {
        case 0:
          colour.constraints[random() % colour.constraints.size()] = number;
          break;
        case 1:
          colour.runs = number % 32;
          break;
        case 2:
          colour.tile = number % 5;
          break;
        case 3:
          colour.type = number % 9;
          break;
        case 4:
          fan.tetrahedra[random() % 6] = number;
          break;
        case 5:
          fan.count = number % 9;
          break;
        case 6:
          fan.ring_size = number % 9;
          break;
        case 7:
          fan.a = number;
          break;
        default:
          colour.is_added = !colour.is_added;
      }
    }
    if (i % 8 == 7) kept.order[random() % kept.order.size()] = static_cast<int>(random() % 4000) - 100;
    try {
      EXPECT_EQ(without_fans(compile(block, CompileOptions{}, &kept)), counts);
    } catch (const Error& error) {
      EXPECT_EQ(i % 8, 7) << error.what();
    }
  }
}

TEST(KeptSchedule, OfAFileHasNoFanOfOneTetrahedronAndNoneTurnedInsideOut) {
  const Object block = large_block(13);
  const CompiledObject before = compile(block, CompileOptions{});
  for (const bool is_turned : {false, true}) {
    KeptSchedule kept = schedule_of(before);
    for (KeptSchedule::Fan& fan : kept.fans) {
      if (is_turned) {
        std::swap(fan.a, fan.b);
      } else {
        fan.count = fan.ring_size = 2;
        fan.tetrahedra.fill(fan.tetrahedra[0]);
      }
    }
    const CompiledObject after = compile(block, CompileOptions{}, &kept);
    EXPECT_EQ(without_fans(after), without_fans(before));
    for (const KeptSchedule::Fan& fan : after.fans) {
      if (fan.count == 0) continue;  // one that was not kept
      const auto at = [&](int p) { return convert<double>(block.positions[static_cast<std::size_t>(p)]); };
      EXPECT_GT(dot(at(fan.b) - at(fan.a), cross(at(fan.ring[0]) - at(fan.a), at(fan.ring[1]) - at(fan.a))), 0);
    }
  }
}

TEST(KeptSchedule, OfAFileIsRefusedIfParticlesThatWereAddedDoNotBeginATile) {
  const Object block = large_block(13);
  KeptSchedule kept = schedule_of(compile(block, CompileOptions{}));
  for (const int first : {std::numeric_limits<int>::min(), -1, 1, std::numeric_limits<int>::max()}) {
    kept.first_added = first;
    EXPECT_THROW(compile(block, CompileOptions{}, &kept), Error) << first;
  }
}

TEST(KeptSchedule, OfOtherConstraintsIsRefused) {
  Object block = large_block();
  std::fill(block.masses.begin(), block.masses.end(), 1.f);  // so that States would not tell particles apart
  Scene scene = weightless(block, 2);
  World world(scene);
  world.edit(ObjectId(0), unchanged(block));
  ASSERT_TRUE(world.layout().schedules[0].is_used());
  EXPECT_NO_THROW(World(scene, world.layout()));
  for (ConstraintGroup& group : scene.objects[0].constraints) group.stiffness.damping = 0.1f;
  EXPECT_THROW(World(scene, world.layout()), Error);
}

/// Cuts a block, saves it in the middle of the cut, and compares.
TEST(KeptSchedule, IsSaved) {
  Object block = large_block();
  block.cuts.push_back({0, 0.2f, {}, {1, 0, 0.3f}, {0, -1, 0}});
  Scene scene = weightless(block, 2);
  World world(scene);
  ASSERT_GT(run_and_tear(world, 6).new_particles, 20);
  scene.objects[0] = world.object(ObjectId(0)).description();
  const std::string path = (std::filesystem::temp_directory_path() / "pliant_kept_schedule.pliant").string();
  save(path, world, scene);
  LoadedWorld loaded = load_world(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(world.layout().schedules[0].is_used());
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  for (int i = 0; i < 8; ++i) {
    run_and_tear(world, 1);
    run_and_tear(loaded.world, 1);
    ASSERT_EQ(loaded.world.state_hash(), world.state_hash()) << "frame " << i;
  }
  EXPECT_EQ(pieces_of(world.object(ObjectId(0)).description()), 2);
}

}  // namespace
}  // namespace pliant
