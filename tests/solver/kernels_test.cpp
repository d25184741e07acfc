// Compares all kernels with the sequential reference bit by bit: sweeps of every type and law, with and without
// multipliers, over contiguous and single slots; prediction, update, bounds and the search for non-finite values, for
// all lengths of the tail.
#include "solver/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/shapes.h"
#include "model/compiled_object.h"
#include "solver/records_support.h"
#include "support/bits.h"
#include "support/constraint_support.h"
#include "support/kernels.h"
#include "topology/fours.h"

namespace pliant {
namespace {

using namespace testing_support;
using testing_support::expect_same;

std::vector<const Kernels*> kernels_in_lanes() {
  std::vector<const Kernels*> all;
  for (const std::string& name : available_isas()) all.push_back(&pick_kernels(name));
  return all;
}

/// Makes `count` constraints that share no particle. In a slot whose bit is set in `ladder`, constraint i has particle
/// slot * count + i, which gives contiguous groups of four; other slots have random particles.
template <class T>
Object separate_constraints(int count, Law law, int ladder, Random& random) {
  Object object;
  std::vector<int> deal(static_cast<std::size_t>(count * slot_count<T>));
  std::iota(deal.begin(), deal.end(), 0);
  std::vector<int> dealt;
  for (std::size_t i = 0; i < deal.size(); ++i)
    if ((ladder >> (static_cast<int>(i) / count) & 1) == 0) dealt.push_back(deal[i]);
  std::shuffle(dealt.begin(), dealt.end(), random);
  for (std::size_t i = 0, next = 0; i < deal.size(); ++i)
    if ((ladder >> (static_cast<int>(i) / count) & 1) == 0) deal[i] = dealt[next++];
  object.positions.assign(deal.size(), Vec3f{});
  object.masses.assign(deal.size(), 1);
  ConstraintGroup group{T::name, {}, {}, {}, {}};
  for (int i = 0; i < count; ++i) {
    for (int slot = 0; slot < slot_count<T>; ++slot)
      group.particles.push_back(deal[static_cast<std::size_t>(slot * count + i)]);
  }
  // Rest data differ between constraints, so that their rows are not stored once; damping and k are equal.
  for (int i = 0; i < count * field_count<T>; ++i) group.rest.push_back(static_cast<float>(i));
  for (int i = 0; i < count && law != Law::pbd; ++i) group.compliances.push_back(static_cast<float>(i));
  group.stiffness = law == Law::pbd ? Stiffness::pbd(0.5f) : Stiffness::compliance(1, law == Law::damped ? 1.f : 0.f);
  object.constraints.push_back(group);
  return object;
}

/// Fills a pool with random numbers; rows that are stored once stay the same for all constraints.
void fill(Pool& pool, Random& random, bool nasty) {
  const auto number = [&] { return nasty ? nasty_float(random) : static_cast<float>(uniform(random, 0.2, 1)); };
  for (float& value : pool.blocks) value = number();
  for (std::size_t first = 0; first < pool.constants.size(); first += batch_width) {
    std::fill_n(pool.constants.begin() + static_cast<std::ptrdiff_t>(first), batch_width, number());
  }
}

/// Random arrays for a sweep: mostly ordinary numbers, some extreme.
struct Numbers {
  Records positions, displacements, remainders;
  Numbers(std::size_t particles, Random& random, bool nasty) {
    const auto number = [&] { return nasty ? nasty_float(random) : static_cast<float>(uniform(random, -1, 1)); };
    for (std::size_t i = 0; i < particles; ++i) {
      const float w = random() % 5 == 0 ? 0.f : static_cast<float>(uniform(random, 0.1, 10));
      positions.push_back({number(), number(), number(), w});
      displacements.push_back({0.1f * number(), 0.1f * number(), 0.1f * number(), 0});
      remainders.push_back({1e-8f * number(), 1e-8f * number(), 1e-8f * number(), 0});
    }
  }
};

/// The displacements after three passes of a substep.
Records swept(const Kernels& kernels, const CompiledObject& object, Numbers numbers,
              AlignedVector<float>* multipliers) {
  SweepArguments a;
  a.positions = numbers.positions.data();
  a.displacements = numbers.displacements.data();
  a.remainders = numbers.remainders.data();
  float* pools[1] = {multipliers != nullptr ? multipliers->data() : nullptr};
  a.multipliers = multipliers != nullptr ? pools : nullptr;
  a.h = 1.f / 240;
  a.inverse_h = 1 / a.h;
  a.inverse_h2 = a.inverse_h * a.inverse_h;
  for (int pass = 0; pass < 3; ++pass) {
    a.first_pass = pass == 0;
    kernels.sweep(object.pools.data(), object.segments.data(), object.segments.data() + object.segments.size(), a);
  }
  return numbers.displacements;
}

void compare_sweeps(const CompiledObject& object, const Numbers& numbers, bool keeps, const std::string& what) {
  const Pool& pool = object.pools[0];
  AlignedVector<float> reference(pool.origin.size(), 0.f);
  const Records expected = swept(kernels_sequential(), object, numbers, keeps ? &reference : nullptr);
  for (const Kernels* kernels : kernels_in_lanes()) {
    AlignedVector<float> multipliers(pool.origin.size(), 0.f);
    const Records found = swept(*kernels, object, numbers, keeps ? &multipliers : nullptr);
    ASSERT_NO_FATAL_FAILURE(expect_same(found, expected, what + ", " + kernels->isa));
    for (std::size_t lane = 0; lane < pool.origin.size(); ++lane) {
      ASSERT_TRUE(pool.origin[lane] < 0 || same_bits(multipliers[lane], reference[lane]))
          << what << ", " << kernels->isa;
    }
  }
}

template <class T>
constexpr int all_slots = (1 << slot_count<T>)-1;

template <class T>
class SweepsInLanes : public testing::Test {
 protected:
  Random random_{5};
};
TYPED_TEST_SUITE(SweepsInLanes, ConstraintTypes, NameOfType);

TYPED_TEST(SweepsInLanes, GiveTheBitsOfTheReference) {
  using T = TypeParam;
  for (Law law : {Law::compliant, Law::damped, Law::pbd}) {
    for (int ladder : {all_slots<T>, 0}) {
      for (int count : {1, 3, 4, 15, 16, 17, 20, 31, 600}) {
        const Object object = separate_constraints<T>(count, law, ladder, this->random_);
        CompiledObject compiled = compile(object, {10, 4096});
        ASSERT_EQ(compiled.pools.size(), 1u);
        for (bool nasty : {false, true}) {
          fill(compiled.pools[0], this->random_, nasty);
          const Numbers numbers(static_cast<std::size_t>(compiled.particles), this->random_, nasty);
          for (bool keeps : {false, true}) {
            ASSERT_NO_FATAL_FAILURE(compare_sweeps(compiled, numbers, keeps,
                                                   std::to_string(count) + (ladder != 0 ? " in runs" : " singly") +
                                                       (nasty ? ", nasty" : "") + ", law " +
                                                       std::to_string(static_cast<int>(law))));
          }
        }
      }
    }
  }
}

/// The number of sets of contiguous slots that a schedule can have: larger stencils are never grouped.
template <class T>
constexpr int sets_of_slots = slot_count<T> > largest_grouped_stencil ? 1 : 1 << slot_count<T>;

/// Batches with every set of contiguous slots, laid out by hand, because no object has them all.
template <class T>
CompiledObject every_set_of_slots(Law law, Random& random) {
  CompiledObject compiled =
      compile(separate_constraints<T>(batch_width * sets_of_slots<T>, law, 0, random), {10, 4096});
  Pool& pool = compiled.pools[0];
  std::vector<int> particles(static_cast<std::size_t>(compiled.particles));
  std::iota(particles.begin(), particles.end(), 0);
  pool.indices.clear();
  compiled.segments.clear();
  for (int runs = 0; runs < sets_of_slots<T>; ++runs) {
    compiled.segments.push_back({0, runs, runs, 1, runs == 0 ? 16 : 4, static_cast<std::int64_t>(pool.indices.size())});
    for (int slot = 0; slot < slot_count<T>; ++slot) {
      const auto first = particles.begin() + (runs * slot_count<T> + slot) * batch_width;
      if ((runs >> slot & 1) == 0) std::shuffle(first, first + batch_width, random);
      for (int i = 0; i < batch_width; i += (runs >> slot & 1) != 0 ? 4 : 1) pool.indices.push_back(first[i]);
    }
  }
  return compiled;
}

TYPED_TEST(SweepsInLanes, GiveTheBitsOfTheReferenceWithAnySlotsInRuns) {
  using T = TypeParam;
  for (Law law : {Law::compliant, Law::damped, Law::pbd}) {
    for (bool nasty : {false, true}) {
      CompiledObject compiled = every_set_of_slots<T>(law, this->random_);
      fill(compiled.pools[0], this->random_, nasty);
      const Numbers numbers(static_cast<std::size_t>(compiled.particles), this->random_, nasty);
      for (bool keeps : {false, true}) {
        ASSERT_NO_FATAL_FAILURE(compare_sweeps(compiled, numbers, keeps, nasty ? "nasty" : "plain"));
      }
    }
  }
}

TYPED_TEST(SweepsInLanes, MeetRunsAndSinglesInThisTest) {
  using T = TypeParam;
  const CompiledObject rows =
      compile(separate_constraints<T>(160, Law::damped, all_slots<T>, this->random_), {10, 4096});
  EXPECT_EQ(rows.pools[0].block_floats, batch_width * (field_count<T> + 1))
      << "rest and compliance differ, damping does not";
  const auto batches_in_runs = [&](int ladder, int runs) {
    const CompiledObject compiled =
        compile(separate_constraints<T>(160, Law::compliant, ladder, this->random_), {10, 4096});
    int batches = 0;
    for (const Segment& segment : compiled.segments) batches += segment.runs == runs ? segment.batches : 0;
    return batches;
  };
  EXPECT_EQ(batches_in_runs(all_slots<T>, all_slots<T>), slot_count<T> <= largest_grouped_stencil ? 10 : 0);
  EXPECT_GT(batches_in_runs(0, 0), 0);
}

TYPED_TEST(SweepsInLanes, LeaveOthersAloneAndPaddingUnwritten) {
  using T = TypeParam;
  CompiledObject compiled = compile(separate_constraints<T>(5, Law::pbd, 0, this->random_), {10, 4096});
  fill(compiled.pools[0], this->random_, false);
  Numbers numbers(static_cast<std::size_t>(compiled.particles), this->random_, false);
  for (Record& p : numbers.positions) p.w = 1;
  // Five constraints only: just the particles of their lanes may move. With padding written, the first constraint would
  // be projected 12 times.
  const Records once = swept(kernels_sequential(), compiled, numbers, nullptr);
  for (const Kernels* kernels : kernels_in_lanes()) {
    ASSERT_NO_FATAL_FAILURE(expect_same(swept(*kernels, compiled, numbers, nullptr), once, kernels->isa));
  }
}

// ------------------------------------------------------------------------------------------------ particles

struct RandomParticles {
  Records positions, displacements, remainders, velocities;
  RandomParticles(int count, Random& random, bool nasty) {
    const auto number = [&] { return nasty ? nasty_float(random) : static_cast<float>(uniform(random, -1, 1)); };
    for (int i = 0; i < count; ++i) {
      const float w = random() % 3 == 0 ? 0.f : static_cast<float>(uniform(random, 0.1, 10));
      positions.push_back({number(), number(), number(), w});
      displacements.push_back({0.1f * number(), 0.1f * number(), 0.1f * number(), 0});
      remainders.push_back({1e-8f * number(), 1e-8f * number(), 1e-8f * number(), 0});
      velocities.push_back({number(), number(), number(), 0});
    }
  }
  AdvanceArguments arguments(int first, int last) {
    AdvanceArguments a;
    a.positions = positions.data();
    a.displacements = displacements.data();
    a.remainders = remainders.data();
    a.velocities = velocities.data();
    a.first = first;
    a.last = last;
    a.h = 1.f / 1200;
    a.inverse_h = 1 / a.h;
    a.velocity_kept = 0.99f;
    const Vec3f gravity{0.1f, -9.81f, 0.2f};
    a.gravity_step = gravity * a.h;
    a.gravity_finished = gravity * (2 * a.h);
    a.gravity_begun = gravity * (3 * a.h);
    a.gravity_settled = gravity * (1.9f * a.h);
    return a;
  }
};

void expect_same(const RandomParticles& a, const RandomParticles& b, const std::string& what) {
  ASSERT_NO_FATAL_FAILURE(expect_same(a.positions, b.positions, what + ", positions"));
  ASSERT_NO_FATAL_FAILURE(expect_same(a.displacements, b.displacements, what + ", displacements"));
  ASSERT_NO_FATAL_FAILURE(expect_same(a.remainders, b.remainders, what + ", remainders"));
  ASSERT_NO_FATAL_FAILURE(expect_same(a.velocities, b.velocities, what + ", velocities"));
}

/// Runs act(kernels, arguments) on particles [first, last) of 24, for every length of the tail, and compares with the
/// reference.
template <class Act>
void compare_on_all_lengths(const Act& act) {
  Random random(17);
  for (bool nasty : {false, true}) {
    for (int first = 0; first < 5; ++first) {
      for (int last = first; last <= 24; ++last) {
        const RandomParticles start(24, random, nasty);
        RandomParticles expected = start;
        act(kernels_sequential(), expected.arguments(first, last));
        for (const Kernels* kernels : kernels_in_lanes()) {
          RandomParticles found = start;
          act(*kernels, found.arguments(first, last));
          ASSERT_NO_FATAL_FAILURE(
              expect_same(found, expected,
                          std::string(kernels->isa) + ", " + std::to_string(first) + " to " + std::to_string(last)));
        }
      }
    }
  }
}

TEST(Kernels, PredictAsTheReference) {
  compare_on_all_lengths([](const Kernels& kernels, const AdvanceArguments& a) { kernels.predict(a, nullptr); });
}
TEST(Kernels, UpdateAsTheReference) {
  compare_on_all_lengths([](const Kernels& kernels, const AdvanceArguments& a) { kernels.update(a); });
}

TEST(Kernels, AdvanceAsUpdateAndThenPredict) {
  compare_on_all_lengths([](const Kernels& kernels, const AdvanceArguments& a) { kernels.advance(a, nullptr); });
  Random random(18);
  for (const Kernels* kernels : kernels_in_lanes()) {
    const RandomParticles start(23, random, false);
    RandomParticles together = start, apart = start;
    kernels->advance(together.arguments(1, 22), nullptr);
    kernels->update(apart.arguments(1, 22));
    kernels->predict(apart.arguments(1, 22), nullptr);
    ASSERT_NO_FATAL_FAILURE(expect_same(together, apart, kernels->isa));
  }
}

TEST(Kernels, FindEveryParticleThatCouldTouch) {
  Random random(6);
  const LocalShape shapes[] = {{ShapeKind::plane, 0, 0, 0},
                               {ShapeKind::sphere, 0.3f, 0, 0},
                               {ShapeKind::capsule, 0.1f, 0.4f, 0},
                               {ShapeKind::box, 0.5f, 0.02f, 0.3f}};
  for (const Kernels* kernels : kernels_in_lanes()) {
    for (const LocalShape& shape : shapes) {
      int left_out = 0;
      for (int count : {0, 1, 15, 16, 17, 33, 200}) {
        RandomParticles particles(std::max(count, 1), random, false);
        const Posed pose{random_point(random, 0.3), random_rotation(random)};
        const NearQuery query{
            particles.positions.data(), particles.displacements.data(), 0, count, shape, convert<float>(pose), 0.05f};
        std::vector<std::int32_t> near(static_cast<std::size_t>(count) + batch_width, -1);
        near.resize(static_cast<std::size_t>(kernels->find_near(query, near.data())));
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end()) << "one twice";
        for (int i = 0; i < count; ++i) {
          const Record &x = particles.positions[static_cast<std::size_t>(i)],
                       &d = particles.displacements[static_cast<std::size_t>(i)];
          const double distance =
              signed_distance(shape, to_local(pose, Vec3d{x.x, x.y, x.z} + Vec3d{d.x, d.y, d.z})).distance;
          const bool could = distance < 0.05 + length(Vec3d{d.x, d.y, d.z}) - 1e-5;
          const bool found = std::binary_search(near.begin(), near.end(), i);
          EXPECT_TRUE(found || !could) << kernels->isa << ", particle " << i << " of " << count;
          left_out += found ? 0 : 1;
        }
      }
      EXPECT_GT(left_out, 20) << "nobody is spared a closer look";
    }
  }
}

TEST(Kernels, BoundThePathsAsTheReference) {
  Random random(2);
  for (int count = 0; count <= 21; ++count) {
    const RandomParticles start(std::max(count, 1), random, false);
    RandomParticles particles = start;
    PointBounds expected;
    kernels_sequential().predict(particles.arguments(0, count), &expected);
    for (int i = 0; i < count; ++i) {
      for (const Record& p :
           {start.positions[static_cast<std::size_t>(i)], particles.positions[static_cast<std::size_t>(i)]}) {
        EXPECT_TRUE(p.x >= expected.low.x && p.y >= expected.low.y && p.z >= expected.low.z);
        EXPECT_TRUE(p.x <= expected.high.x && p.y <= expected.high.y && p.z <= expected.high.z);
      }
    }
    for (const Kernels* kernels : kernels_in_lanes()) {
      RandomParticles again = start;
      PointBounds found;
      kernels->predict(again.arguments(0, count), &found);
      EXPECT_TRUE(found.low.x == expected.low.x && found.low.y == expected.low.y && found.low.z == expected.low.z)
          << count;
      EXPECT_TRUE(found.high.x == expected.high.x && found.high.y == expected.high.y && found.high.z == expected.high.z)
          << count;
    }
  }
}

TEST(Kernels, FindAnythingThatIsNotFinite) {
  std::vector<const Kernels*> all = kernels_in_lanes();
  all.push_back(&kernels_sequential());
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const Kernels* kernels : all) {
    for (int count = 0; count <= 20; ++count) {
      std::vector<Record> records(24, Record{3.4e38f, -3.4e38f, 1e-45f, 1});
      for (int first = 0; first < 4; ++first) {
        const int last = first + count;
        EXPECT_TRUE(kernels->all_finite(records.data(), first, last));
        for (int bad = 0; bad < 24; ++bad) {
          for (int axis = 0; axis < 3; ++axis) {
            Record& r = records[static_cast<std::size_t>(bad)];
            const Record whole = r;
            (axis == 0 ? r.x : axis == 1 ? r.y : r.z) = bad % 3 == 0 ? nan : bad % 3 == 1 ? infinity : -infinity;
            EXPECT_EQ(kernels->all_finite(records.data(), first, last), bad < first || bad >= last)
                << kernels->isa << " " << bad;
            r = whole;
          }
        }
      }
    }
  }
}

TEST(Kernels, KeepWhatAFloatCannotHold) {
  // Displacements far below the last bit of the position must add up over a hundred thousand substeps.
  Records all(4, Record{});
  AdvanceArguments a;
  a.positions = &all[0];
  a.displacements = &all[1];
  a.remainders = &all[2];
  a.velocities = &all[3];
  a.last = 1;
  a.h = 1e-6f;
  a.inverse_h = 1e6f;
  for (const Kernels* kernels : kernels_in_lanes()) {
    all = {{1, 0, 0, 1}, {}, {}, {1e-2f, 0, 0, 0}};
    for (int i = 0; i < 100000; ++i) {
      kernels->predict(a, nullptr);
      kernels->update(a);
    }
    EXPECT_NEAR(all[0].x - 1, 1e-3, 1e-6);
    EXPECT_EQ(all[0].w, 1);
  }
}

TEST(PickKernels, NamesWhatItGives) {
  for (const std::string& name : available_isas()) EXPECT_EQ(pick_kernels(name).isa, name);
  EXPECT_EQ(pick_kernels("").isa, available_isas().back()) << "the widest";
  EXPECT_THROW(pick_kernels("x86-64-v9"), Error);
  EXPECT_THROW(pick_kernels("x86-64"), Error);
}

}  // namespace
}  // namespace pliant
