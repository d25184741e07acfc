// Tests one contact between dynamic primitives: distances in lanes compared with double, momentum, the thickness
// reached, friction.
#include "collision/narrow/pair_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "collision/random_support.h"
#include "math/vector.h"

namespace pliant {
namespace {

using testing_support::Random;

float uniform_float(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

Record random_record(Random& random, float range, float w = 0) {
  const float x = uniform_float(random, -range, range), y = uniform_float(random, -range, range),
              z = uniform_float(random, -range, range);
  return {x, y, z, w};
}

Vec3d place(const Record& r) { return {double(r.x), double(r.y), double(r.z)}; }

struct FourParticles {
  std::vector<Record> positions, displacements, remainders, velocities;
  PairStencil pair{{0, 1, 2, 3}, 1};
};

FourParticles random_four(Random& random, bool free) {
  FourParticles four;
  four.pair.first_side = random() % 2 == 0 ? 1 : 2;
  for (int i = 0; i < 4; ++i) {
    const bool fixed = !free && random() % 3 == 0;
    four.positions.push_back(random_record(random, 1, fixed ? 0.f : uniform_float(random, 0.1f, 10)));
    four.displacements.push_back(random_record(random, 0.5f));
    four.remainders.push_back(random_record(random, 1e-6f));
    four.velocities.push_back(random_record(random, 5));
  }
  return four;
}

Contact contact_of(const FourParticles& four, const PairMaterial& material, float h = 1) {
  PairBatch batch;
  pair_distances(&four.pair, 1, four.positions.data(), batch);
  Contact contact = make_contact(four.pair, batch, 0, material, h);
  complete_contact(contact, four.positions.data(), four.remainders.data());
  return contact;
}

Vec3d momentum(const FourParticles& four, const std::vector<Record>& of) {
  Vec3d sum{};
  for (int i = 0; i < 4; ++i)
    if (four.positions[i].w > 0) sum += place(of[i]) * (1. / double(four.positions[i].w));
  return sum;
}

/// Angular momentum about the origin, at the substep's start, where weights are measured.
Vec3d angular_momentum(const FourParticles& four, const std::vector<Record>& of) {
  Vec3d sum{};
  for (int i = 0; i < 4; ++i)
    if (four.positions[i].w > 0)
      sum += cross(place(four.positions[i]), place(of[i])) * (1. / double(four.positions[i].w));
  return sum;
}

TEST(PairDistance, IsTheSameInLanesAndInDouble) {
  Random random(91);
  for (const float away : {0.f, 100.f, -10000.f}) {
    for (int i = 0; i < 3000; ++i) {
      const int count = 1 + static_cast<int>(random() % 16), side = random() % 2 == 0 ? 1 : 2;
      std::vector<Record> positions;
      std::vector<PairStencil> pairs;
      for (int k = 0; k < count; ++k) {
        for (int v = 0; v < 4; ++v) {
          Record r = random_record(random, 1);
          if (v == 3 && random() % 5 == 0) r = positions.back();
          if (v < 3 || positions.size() % 4 == 3) r = {r.x + away, r.y + away, r.z + away, 0};
          positions.push_back(r);
        }
        pairs.push_back({{4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3}, side});
      }
      PairBatch batch;
      pair_distances(pairs.data(), count, positions.data(), batch);
      for (int k = 0; k < count; ++k) {
        const PairDistance at = pair_distance(pairs[k], positions.data());
        ASSERT_LE(batch.at_least[k], at.distance) << i;
        ASSERT_NEAR(batch.distance[k], at.distance, 5e-4) << "where edges are nearly parallel, else to 1e-6";
        double first = 0, second = 0;
        Vec3d between{};
        for (int v = 0; v < 4; ++v) {
          (v < side ? first : second) += double(batch.weight[v][k]);
          between += (place(positions[4 * k + v]) - place(positions[4 * k])) * double(batch.weight[v][k]);
        }
        ASSERT_NEAR(first, 1, 1e-6);
        ASSERT_NEAR(second, -1, 1e-6);
        ASSERT_NEAR(length(between), double(batch.distance[k]), 5e-6) << "the weights name points that are as near";
        if (at.distance < 1e-3) continue;
        const Vec3d normal{double(batch.normal[0][k]), double(batch.normal[1][k]), double(batch.normal[2][k])};
        ASSERT_NEAR(length(normal), 1, 1e-6);
        ASSERT_GT(dot(normal, between) / length(between), 1 - 1e-5);
      }
    }
  }
}

/// Edges at angles from 10^-5 and triangles with heights from 10^-6 of their length, 10^-5 to 10^-2 apart.
void hard_to_tell(Random& random, bool edges, std::vector<Record>& four) {
  const auto power = [&](float low) { return std::pow(10.f, uniform_float(random, low, -1)); };
  const float apart = power(-5), angle = power(-5), at = uniform_float(random, -1, 1),
              reach = edges ? power(-2) * 10 : 0;
  const Record a = random_record(random, apart), b = random_record(random, apart);
  const Record turned = random_record(random, angle * reach);
  four = {{at + a.x, a.y, a.z, 1}, {-1, 0, 0, 1}, {1, 0, 0, 1}, {at, power(-6), 0, 1}};
  if (edges) four = {{-1, 0, 0, 1}, {1, 0, 0, 1}, four[0], {at + reach + b.x, b.y + turned.y, b.z + turned.z, 1}};
  if (edges && random() % 2 == 0) std::swap(four[0], four[2]), std::swap(four[1], four[3]);
  const Vec3f turn{uniform_float(random, -1, 1), uniform_float(random, -1, 1), uniform_float(random, -1, 1)};
  for (Record& r : four) {
    const Vec3f p{r.x, r.y, r.z}, q = p + cross(turn, p) * 0.5f;
    r = {q.x, q.y, q.z, r.w};
  }
}

TEST(PairDistance, InLanesBoundsTheTrueOneWhereFloatsTellLittle) {
  Random random(94);
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    std::vector<Record> four;
    const PairStencil pair{{0, 1, 2, 3}, i % 2 + 1};
    hard_to_tell(random, pair.first_side == 2, four);
    PairBatch batch;
    pair_distances(&pair, 1, four.data(), batch);
    const double distance = pair_distance(pair, four.data()).distance;
    ASSERT_LE(batch.at_least[0], distance) << i;
    worst = std::max(worst, double(batch.distance[0]) - distance);
  }
  EXPECT_GT(worst, 2e-5) << "the float's own distance would be no bound";
}

TEST(PairContact, KeepsMomentum) {
  Random random(92);
  int pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    FourParticles four = random_four(random, true);
    Contact contact = contact_of(four, {0.5f, 0.6f, 0.4f});
    // Normal corrections act through the closest points, so they have no moment. Friction acts tangentially at points
    // that are a gap apart, so its moment is that of the gap.
    const Vec3d before = momentum(four, four.displacements), turn = angular_momentum(four, four.displacements);
    project_contact(contact, four.displacements.data());
    project_contact(contact, four.displacements.data());
    pushed += contact.push > 0 ? 1 : 0;
    ASSERT_LT(length(momentum(four, four.displacements) - before), 2e-4) << i;
    const Vec3d turned = angular_momentum(four, four.displacements) - turn;
    double mass = 0;
    for (int k = 0; k < 4; ++k) mass += 1. / double(four.positions[k].w);
    const double allowed = double(contact.gap + contact.thickness) * double(length(contact.friction)) * mass + 4e-3;
    ASSERT_LT(length(turned), allowed) << i;
    const Vec3d speed = momentum(four, four.velocities), spin = angular_momentum(four, four.velocities);
    respond_to_contact(contact, four.velocities.data());
    ASSERT_LT(length(momentum(four, four.velocities) - speed), 2e-3) << i;
    ASSERT_LT(length(angular_momentum(four, four.velocities) - spin), 2e-2) << i;
  }
  EXPECT_GT(pushed, 5000);
}

TEST(PairContact, ReachesTheThicknessAndMovesNothingFixed) {
  Random random(93);
  for (int i = 0; i < 20000; ++i) {
    FourParticles four = random_four(random, false);
    Contact contact = contact_of(four, {0.5f, 0, 0});
    const FourParticles before = four;
    project_contact(contact, four.displacements.data());
    double relative = double(contact.gap);
    bool movable = false;
    for (int k = 0; k < 4; ++k) {
      relative += double(contact.weight[k]) * dot(convert<double>(contact.normal), place(four.displacements[k]));
      if (four.positions[k].w > 0 && std::abs(contact.weight[k]) > 1e-3f) movable = true;
      if (four.positions[k].w > 0) continue;
      ASSERT_EQ(four.displacements[k].x, before.displacements[k].x);
      ASSERT_EQ(four.displacements[k].y, before.displacements[k].y);
    }
    if (movable) {
      ASSERT_GT(relative, -1e-4) << i;
    }
    respond_to_contact(contact, four.velocities.data());
    double separating = 0;
    for (int k = 0; k < 4; ++k)
      separating += double(contact.weight[k]) * dot(convert<double>(contact.normal), place(four.velocities[k]));
    if (movable && contact.push > 0) {
      ASSERT_LT(separating, 1e-3) << "a push is no throw";
    }
  }
}

/// A vertex of 1 kg falls at 3 m/s on a triangle of three others: 1 / (1 + 1 / 9 * 3) = 3 / 4 of the momentum stays.
TEST(PairContact, LeavesNoApproachOfAnImpact) {
  FourParticles four;
  four.positions = {{0, 0.01f, 0, 1}, {-1, 0, -1, 1}, {1, 0, -1, 1}, {0, 0, 2, 1}};
  four.velocities = {{0, -3, 0, 0}, {}, {}, {}};
  four.remainders.assign(4, Record{});
  Contact contact = contact_of(four, {0.005f, 0, 0});
  EXPECT_FALSE(is_impact(contact)) << "it has not pushed";
  contact.push = 0.001f;
  EXPECT_TRUE(is_impact(contact)) << "0.01 m apart, to keep 0.005 m: it came closer by 0.006 m";
  Contact touching = contact_of(four, {0.02f, 0, 0});
  touching.push = 0.001f;
  EXPECT_FALSE(is_impact(touching)) << "it began earlier";
  EXPECT_NEAR(end_impact(contact, four.velocities.data(), {}), 3, 1e-5f);
  for (const Record& v : four.velocities) EXPECT_NEAR(v.y, -0.75f, 1e-5f);
  four.velocities[0].y = 1;
  EXPECT_EQ(end_impact(contact, four.velocities.data(), {}), 0);
  EXPECT_EQ(four.velocities[0].y, 1) << "what separates is left to its response";
}

TEST(PairContact, SeparatesWhatOverlapsNoFasterThanTheCap) {
  FourParticles four;
  four.positions = {{0.1f, 0.001f, 0.1f, 1}, {-1, 0, -1, 1}, {1, 0, -1, 1}, {0, 0, 1, 1}};
  four.remainders.assign(4, Record{});
  const float h = 1.f / 1200;
  const Contact contact = contact_of(four, {0.5f, 0, 0}, h);
  EXPECT_NEAR(contact.gap, -largest_pair_separation_speed * h, 1e-7);
  EXPECT_FLOAT_EQ(contact.thickness, 0.001f + largest_pair_separation_speed * h);
}

/// How far a particle slides in a second that lies on a triangle at the thickness, under gravity [m].
double slide(float degrees, float static_friction, float kinetic_friction) {
  const double angle = double(degrees) * 3.14159265358979 / 180, h = 1. / 600;
  const Vec3d down{std::cos(angle), -std::sin(angle), 0}, normal{std::sin(angle), std::cos(angle), 0};
  const auto record = [](const Vec3d& v, float w) {
    return Record{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
  };
  FourParticles four;
  four.positions = {record(normal * 0.01, 1), record(down * -20. + Vec3d{0, 0, 20}, 0),
                    record(down * 20. + Vec3d{0, 0, 20}, 0), record(Vec3d{0, 0, -40}, 0)};
  four.remainders.assign(4, Record{});
  Vec3d velocity{}, at = normal * 0.01;
  for (int step = 0; step < 600; ++step) {
    velocity = velocity + Vec3d{0, -9.81, 0} * h;
    four.displacements.assign(4, Record{});
    four.displacements[0] = record(velocity * h, 0);
    Contact contact = contact_of(four, {0.01f, static_friction, kinetic_friction}, static_cast<float>(h));
    for (int iteration = 0; iteration < 3; ++iteration) project_contact(contact, four.displacements.data());
    velocity = place(four.displacements[0]) * (1 / h);
    at = at + place(four.displacements[0]);
    four.positions[0] = record(at, 1);
  }
  return dot(at, down);
}

TEST(PairContact, SticksBelowTheAngleOfFrictionAndSlipsAbove) {
  const double mu = 0.5;  // the friction angle is 26.565 degrees
  EXPECT_LT(slide(26.3f, 0.5f, 0.5f), 1e-3);
  EXPECT_GT(slide(26.9f, 0.5f, 0.5f), 0.01);
  EXPECT_GT(slide(5, 0, 0), 0.4);
  for (const float degrees : {30.f, 45.f}) {
    const double angle = double(degrees) * 3.14159265358979 / 180;
    const double expected = 0.5 * 9.81 * (std::sin(angle) - mu * std::cos(angle));
    EXPECT_NEAR(slide(degrees, 0.5f, 0.5f), expected, 0.02 * expected) << degrees;
  }
}

}  // namespace
}  // namespace pliant
