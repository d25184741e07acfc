// Tests the compilation of an Object to a schedule: every constraint occurs once, padding is never a constraint, tasks
// share no particle, and indices can be mapped back.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "constraints/all.h"
#include "math/vector.h"
#include "model/compiled_object.h"
#include "support/compiled_grids.h"

namespace pliant {
namespace {

/// A lane of a segment in terms of the user's description.
struct Found {
  std::array<int, 4> particles{};
  float first_field = 0, response = 0;
  Law law = Law::compliant;
};

/// All valid lanes by (type, origin). Fails if one occurs twice, or if padding has an origin.
std::map<std::pair<int, int>, Found> all_lanes(const CompiledObject& object) {
  std::map<std::pair<int, int>, Found> found;
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
      for (int lane = 0; lane < batch_width; ++lane) {
        const auto number =
            static_cast<std::size_t>(segment.first_batch + batch) * batch_width + static_cast<std::size_t>(lane);
        const int origin = pool.origin[number];
        EXPECT_EQ(origin >= 0, lane_is_valid(segment, batch, lane));
        if (origin < 0) continue;
        Found here;
        const int fields = static_cast<int>(pool.row_offset.size()) - (pool.law == Law::damped ? 2 : 1);
        here.first_field = pool.row(0, segment.first_batch + batch)[lane];
        here.response = pool.row(fields, segment.first_batch + batch)[lane];
        here.law = pool.law;
        for (int slot = 0; slot < pool.stencil; ++slot) {
          const int storage = particle_of(segment, index, slot, lane);
          EXPECT_GE(storage, 0);
          EXPECT_LT(storage, object.particles);
          here.particles[static_cast<std::size_t>(slot)] = object.order[static_cast<std::size_t>(storage)];
        }
        EXPECT_TRUE(found.emplace(std::make_pair(pool.type, origin), here).second)
            << "constraint " << origin << " twice";
      }
    }
  }
  return found;
}

int count_of(const Object& object, const std::string& type, int size) {
  std::size_t count = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type == type) count += group.particles.size() / static_cast<std::size_t>(size);
  }
  return static_cast<int>(count);
}

/// The user's stencil of constraint `origin` of a type; attachments come after all groups.
std::vector<int> stencil_given(const Object& object, const std::string& type, int size, int origin) {
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != type) continue;
    const int count = static_cast<int>(group.particles.size()) / size;
    if (origin < count) return {group.particles.begin() + origin * size, group.particles.begin() + (origin + 1) * size};
    origin -= count;
  }
  const Attachment& attachment = object.attachments.at(static_cast<std::size_t>(origin));
  return {attachment.particle, static_cast<int>(object.positions.size()) + origin};
}

/// The same object with particles renumbered, so that no lines are left for numbering.
Object renumbered(const Object& object) {
  std::vector<int> name(object.positions.size());
  std::iota(name.begin(), name.end(), 0);
  std::shuffle(name.begin() + 2, name.end(), std::mt19937(3));  // 0 and 1 stay, because tests use them
  Object out = object;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto to = static_cast<std::size_t>(name[i]);
    out.positions[to] = object.positions[i];
    out.masses[to] = object.masses[i];
    out.velocities[to] = object.velocities[i];
  }
  const auto rename = [&](int& particle) { particle = name[static_cast<std::size_t>(particle)]; };
  for (ConstraintGroup& group : out.constraints) std::for_each(group.particles.begin(), group.particles.end(), rename);
  for (auto& triangle : out.triangles) std::for_each(triangle.begin(), triangle.end(), rename);
  for (Attachment& attachment : out.attachments) rename(attachment.particle);
  return out;
}

/// Parameters: size of tiles; true if the grid is numbered line by line, false if randomly.
class Compiled : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  int largest_tile() const { return std::get<0>(GetParam()); }
  Object object_ = std::get<1>(GetParam()) ? renumbered(rumpled_grid(43, 37)) : rumpled_grid(23, 17);
  CompiledObject compiled_ = compile(object_, {10, largest_tile()});
};
INSTANTIATE_TEST_SUITE_P(TileSizes, Compiled, testing::Combine(testing::Values(1, 7, 40, 4096), testing::Bool()));

TEST_P(Compiled, HasEveryConstraintOnceWithItsParticles) {
  const auto lanes = all_lanes(compiled_);
  std::size_t total = 0;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    using T = typename decltype(tag)::type;
    const int attachments = std::is_same_v<T, Distance> ? static_cast<int>(object_.attachments.size()) : 0;
    const int count = count_of(object_, T::name, slot_count<T>) + attachments;
    total += static_cast<std::size_t>(count);
    for (int origin = 0; origin < count; ++origin) {
      const auto found = lanes.find({type, origin});
      ASSERT_NE(found, lanes.end()) << T::name << " " << origin;
      std::vector<int> given = stencil_given(object_, T::name, slot_count<T>, origin);
      std::vector<int> compiled(found->second.particles.begin(), found->second.particles.begin() + slot_count<T>);
      std::sort(given.begin(), given.end());
      std::sort(compiled.begin(), compiled.end());
      EXPECT_EQ(given, compiled) << T::name << " " << origin;
    }
  });
  EXPECT_EQ(lanes.size(), total);
}

TEST_P(Compiled, KeepsRestDataRightAfterReordering) {
  const int type = 1;
  for (const auto& [key, lane] : all_lanes(compiled_)) {
    if (key.first != type) continue;
    Vec3<double> x[4];
    for (std::size_t slot = 0; slot < 4; ++slot)
      x[slot] = convert<double>(object_.positions[static_cast<std::size_t>(lane.particles[slot])]);
    EXPECT_NEAR(DihedralBending::measure(x).rest_angle, lane.first_field, 1e-6) << "hinge " << key.second;
  }
}

TEST_P(Compiled, NumbersParticlesBothWays) {
  ASSERT_EQ(compiled_.particles, static_cast<int>(object_.positions.size() + object_.attachments.size()));
  EXPECT_EQ(compiled_.user_particles, static_cast<int>(object_.positions.size()));
  for (int user = 0; user < compiled_.particles; ++user) {
    const int storage = compiled_.place[static_cast<std::size_t>(user)];
    ASSERT_EQ(compiled_.order[static_cast<std::size_t>(storage)], user);
    const Record& r = compiled_.positions[static_cast<std::size_t>(storage)];
    const Vec3f given = user < compiled_.user_particles ? object_.positions[static_cast<std::size_t>(user)]
                                                        : object_.attachments[0].target;
    EXPECT_EQ((Vec3f{r.x, r.y, r.z}), given);
    const bool fixed = user <= 1 || user >= compiled_.user_particles;
    EXPECT_EQ(r.w, fixed ? 0.f : 1 / object_.masses[static_cast<std::size_t>(user)]);
    const Record& v = compiled_.velocities[static_cast<std::size_t>(storage)];
    EXPECT_EQ((Vec3f{v.x, v.y, v.z}), fixed ? Vec3f{} : object_.velocities[static_cast<std::size_t>(user)]);
  }
}

TEST_P(Compiled, TilesPartitionParticlesAndSegments) {
  int particle = 0, segment = 0;
  for (const Tile& tile : compiled_.tiles) {
    EXPECT_EQ(tile.first_particle, particle);
    EXPECT_EQ(tile.first_segment, segment);
    EXPECT_GT(tile.last_particle, tile.first_particle);
    EXPECT_LE(tile.last_particle - tile.first_particle, largest_tile());
    particle = tile.last_particle;
    segment = tile.last_segment;
  }
  EXPECT_EQ(particle, compiled_.particles);
  for (const ObjectPhase& colour : phases_of(compiled_, Driver::inter_tile)) {
    EXPECT_EQ(colour.first, segment);
    segment = colour.last;
  }
  EXPECT_EQ(segment, static_cast<int>(compiled_.segments.size()));
}

/// Storage indices of all particles that the valid lanes of a segment write; padding reads the same ones.
std::vector<int> particles_of(const CompiledObject& object, const Segment& segment) {
  std::vector<int> particles;
  const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      for (int slot = 0; slot < pool.stencil; ++slot) {
        const int particle = particle_of(segment, index, slot, lane);
        EXPECT_TRUE(particle >= 0 && particle < object.particles) << "padding must be readable";
        if (lane_is_valid(segment, batch, lane)) particles.push_back(particle);
      }
    }
  }
  return particles;
}

TEST_P(Compiled, NoSegmentTouchesAParticleTwice) {
  for (const Segment& segment : compiled_.segments) {
    const std::vector<int> particles = particles_of(compiled_, segment);
    EXPECT_EQ(std::set<int>(particles.begin(), particles.end()).size(), particles.size());
  }
}

TEST_P(Compiled, TilesTouchTheirOwnParticlesAlone) {
  for (const Tile& tile : compiled_.tiles) {
    for (int s = tile.first_segment; s < tile.last_segment; ++s) {
      for (int particle : particles_of(compiled_, compiled_.segments[static_cast<std::size_t>(s)])) {
        EXPECT_GE(particle, tile.first_particle);
        EXPECT_LT(particle, tile.last_particle);
      }
    }
  }
}

TEST_P(Compiled, SegmentsOfAnInterTileColourShareNothing) {
  for (const ObjectPhase& colour : phases_of(compiled_, Driver::inter_tile)) {
    std::set<int> met;
    for (int s = colour.first; s < colour.last; ++s) {
      for (int particle : particles_of(compiled_, compiled_.segments[static_cast<std::size_t>(s)])) {
        EXPECT_TRUE(met.insert(particle).second);
      }
    }
  }
}

TEST_P(Compiled, PadsEveryStretchOfMemory) {
  for (const Segment& segment : compiled_.segments) {
    const Pool& pool = compiled_.pools[static_cast<std::size_t>(segment.pool)];
    EXPECT_GT(segment.batches, 0);
    EXPECT_GE(segment.last_count, 1);
    EXPECT_LE(segment.last_count, segment.runs != 0 ? 4 : 16);
    EXPECT_LE(segment.first_batch + segment.batches, pool.batches);
    EXPECT_LE(segment.index_offset + static_cast<std::int64_t>(segment.batches) * indices_per_batch(pool, segment),
              static_cast<std::int64_t>(pool.indices.size()));
  }
  for (const Pool& pool : compiled_.pools) {
    EXPECT_EQ(pool.blocks.size(), static_cast<std::size_t>(pool.batches) * static_cast<std::size_t>(pool.block_floats));
    EXPECT_EQ(pool.origin.size(), static_cast<std::size_t>(pool.batches) * batch_width);
  }
}

TEST_P(Compiled, FindsTheTrianglesAroundEachParticle) {
  const Surface& surface = compiled_.surface;
  ASSERT_EQ(surface.triangles.size(), object_.triangles.size());
  std::size_t corners = 0;
  for (int p = 0; p < compiled_.particles; ++p) {
    for (int c = surface.corner_begin[static_cast<std::size_t>(p)];
         c < surface.corner_begin[static_cast<std::size_t>(p) + 1]; ++c, ++corners) {
      const int corner = surface.corners[static_cast<std::size_t>(c)];
      EXPECT_EQ(surface.triangles[static_cast<std::size_t>(corner / 4)][static_cast<std::size_t>(corner % 4)], p);
    }
  }
  EXPECT_EQ(corners, 3 * object_.triangles.size());
}

TEST(Compile, BringsAnyNumberingIntoRuns) {
  const CompiledObject compiled = compile(renumbered(rumpled_grid(43, 37)), {10, 4096});
  std::set<int> sets;
  int batches = 0, in_runs = 0;
  for (const Segment& segment : compiled.segments) {
    if (compiled.pools[static_cast<std::size_t>(segment.pool)].stencil == 4) sets.insert(segment.runs);
    batches += segment.batches;
    in_runs += segment.runs != 0 ? segment.batches : 0;
    if (segment.runs != 0 && segment.runs + 1 != 1 << compiled.pools[static_cast<std::size_t>(segment.pool)].stencil) {
      EXPECT_EQ(segment.last_count, 4) << "sweeps rely on whole batches where only some slots are in runs";
    }
  }
  EXPECT_GT(in_runs, batches / 2);
  EXPECT_GT(sets.size(), 3u) << "hinges with all, some and no slots in runs";
}

TEST(Compile, IsTheSameEachTime) {
  const Object object = rumpled_grid(9, 9);
  const CompiledObject a = compile(object, {10, 16}), b = compile(object, {10, 16});
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.pools.size(), b.pools.size());
  for (std::size_t p = 0; p < a.pools.size(); ++p) {
    EXPECT_EQ(a.pools[p].indices, b.pools[p].indices);
    EXPECT_EQ(a.pools[p].origin, b.pools[p].origin);
    EXPECT_TRUE(std::equal(a.pools[p].blocks.begin(), a.pools[p].blocks.end(), b.pools[p].blocks.begin(),
                           b.pools[p].blocks.end()));
  }
}

TEST(Compile, OneParticleAndNothingElse) {
  Object object;
  object.positions = {{1, 2, 3}};
  object.masses = {2};
  const CompiledObject compiled = compile(object, {});
  EXPECT_EQ(compiled.particles, 1);
  EXPECT_EQ(compiled.positions[0].w, 0.5f);
  EXPECT_TRUE(compiled.segments.empty());
  EXPECT_EQ(compiled.tiles.size(), 1u);
}

TEST(Compile, MovingPinsAndTargetsAreKinematic) {
  const Object object = rumpled_grid(5, 5);
  const CompiledObject compiled = compile(object, {});
  ASSERT_EQ(compiled.kinematics.size(), 1u);  // the attachment's target does not move
  EXPECT_EQ(compiled.order[static_cast<std::size_t>(compiled.kinematics[0].particle)], 0);
  EXPECT_EQ(compiled.kinematics[0].rest, object.positions[0]);
}

/// Momentum is conserved where the volume is in conflict with the lengths, and nothing but contact takes it away.
TEST(Compile, MomentumIsConservedOfOneFreeInflatedSurface) {
  Object ball;
  const TriangleMesh mesh = sphere_mesh(1);
  ball.positions = mesh.positions;
  ball.triangles = mesh.triangles;
  ball.masses.assign(ball.positions.size(), 1);
  ball.volume = Volume{1.1f, Stiffness::rigid()};
  EXPECT_TRUE(compile(ball, {}).volume.keeps_momentum);

  Object level = ball;
  level.volume->pressure = 1;
  EXPECT_FALSE(compile(level, {}).volume.keeps_momentum);
  Object pinned = ball;
  pinned.pins.push_back({3, {}});
  EXPECT_FALSE(compile(pinned, {}).volume.keeps_momentum);
  Object with_string = ball;
  with_string.positions.push_back({0, -2, 0});
  with_string.masses.push_back(1);
  EXPECT_FALSE(compile(with_string, {}).volume.keeps_momentum);
  Object two = ball;
  for (const auto& t : mesh.triangles) {
    const int first = static_cast<int>(mesh.positions.size());
    two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  for (const Vec3f& p : mesh.positions) two.positions.push_back(p + Vec3f{3, 0, 0});
  two.masses.assign(two.positions.size(), 1);
  EXPECT_FALSE(compile(two, {}).volume.keeps_momentum) << "each would turn on";
}

TEST(Compile, TheStarOfFiveHundredEdges) {
  Object star;
  star.positions.push_back({});
  ConstraintGroup edges{"distance", {}, {}, {}, {}};
  for (int i = 1; i <= 500; ++i) {
    const float a = static_cast<float>(i);
    star.positions.push_back({1, a * 0.01f, a * 0.001f});
    edges.particles.insert(edges.particles.end(), {0, i});
  }
  star.masses.assign(star.positions.size(), 1);
  star.constraints = {edges};
  for (int largest : {16, 100, 4096}) {
    const CompiledObject compiled = compile(star, {10, largest});
    EXPECT_EQ(all_lanes(compiled).size(), 500u);
  }
}

}  // namespace
}  // namespace pliant
