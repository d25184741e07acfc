// Tests coloured contacts: no two of a colour share a dynamic point, and lanes, levels and threads give the bits of a
// plain loop.
#include "solver/contact_solver.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <random>
#include <set>

#include "solver/kernels.h"
#include "solver/random_support.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using testing_support::random_vector;
using testing_support::uniform_float;

struct Tangle {
  std::vector<Record> positions, displacements, velocities;
  std::vector<Contact> contacts;
};

/// Contacts between random points, whose indices differ by at most `apart`. Every fifth point is fixed.
Tangle random_tangle(int points, int contacts, int apart, unsigned seed) {
  std::mt19937 random(seed);
  Tangle out;
  for (int i = 0; i < points; ++i) {
    out.positions.push_back({0, 0, 0, i % 5 == 0 ? 0.f : uniform_float(random, 0.5f, 2)});
    const Vec3f d = random_vector(random, 0.01f);
    out.displacements.push_back({d.x, d.y, d.z, 0});
  }
  const std::vector<Record> remainders(out.positions.size());
  for (int i = 0; i < contacts; ++i) {
    Contact c;
    const int first = static_cast<int>(random() % static_cast<unsigned>(points - apart));
    std::set<std::int32_t> four;
    while (four.size() < 4) four.insert(first + static_cast<int>(random() % static_cast<unsigned>(apart)));
    std::copy(four.begin(), four.end(), c.point.begin());
    const float s = uniform_float(random, 0, 1), t = i % 3 == 0 ? 0 : uniform_float(random, 0, 1);
    c.weight = {1 - s, s, t - 1, -t};
    if (i % 7 == 0) {  // contacts of two points only
      c.point[2] = c.point[3] = c.point[0];
      c.weight = {1, -1, 0, 0};
    }
    const Vec3f n = random_vector(random, 1);
    c.normal = n * (1 / std::max(length(n), 1e-3f));
    c.gap = uniform_float(random, -0.01f, 0.01f);
    c.thickness = uniform_float(random, 0.001f, 0.01f);
    c.static_friction = 0.5f;
    c.kinetic_friction = 0.3f;
    c.surface_motion = i % 4 == 0 ? random_vector(random, 0.001f) : Vec3f{};
    complete_contact(c, out.positions.data(), remainders.data());
    out.contacts.push_back(c);
  }
  return out;
}

TEST(ContactColours, ShareNothingThatMovesAndLeaveNothingOut) {
  for (const int apart : {8, 40, 900}) {
    const Tangle tangle = random_tangle(1000, apart == 8 ? 30000 : 6000, apart, 1);
    ContactColours colours;
    for (int round = 0; round < 2; ++round)  // twice, because tables are kept
      colours.colour(tangle.contacts, 0, tangle.contacts.size(), tangle.positions.data(), tangle.positions.size());
    const std::vector<std::int32_t>&order = colours.order(), &start = colours.start();
    ASSERT_EQ(std::set<std::int32_t>(order.begin(), order.end()).size(), tangle.contacts.size());
    ASSERT_EQ(start.back(), static_cast<std::int32_t>(order.size()));
    for (std::size_t c = 0; c + 2 < start.size(); ++c) {
      std::set<std::int32_t> moving;
      for (std::int32_t i = start[c]; i < start[c + 1]; ++i) {
        const auto& point = tangle.contacts[order[i]].point;
        for (const std::int32_t p : std::set<std::int32_t>(point.begin(), point.end())) {
          if (!(tangle.positions[p].w > 0)) continue;
          ASSERT_TRUE(moving.insert(p).second) << "colour " << c << " has point " << p << " twice";
        }
        ASSERT_TRUE(i == start[c] || order[i - 1] < order[i]);
      }
    }
    const std::int32_t tail = start.back() - start[start.size() - 2];
    if (apart == 8) {
      EXPECT_GT(tail, 0) << "nothing tests the tail";
    } else {
      EXPECT_EQ(tail, 0);
    }
  }
}

std::vector<Record> projected(const Kernels& kernels, int threads, const Tangle& from, std::vector<Contact>& contacts) {
  Executor executor(threads);
  std::vector<Record> displacements = from.displacements;
  contacts = from.contacts;
  executor.enter([&] {
    ContactSolver solver;
    solver.begin(kernels.contacts, contacts, contacts.size() / 3, from.positions.data(), from.positions.size());
    for (const float yield : {0.f, 0.3f, 0.f})
      solver.project(executor, "contacts", contacts, displacements.data(), yield);
  });
  return displacements;
}

/// By colours alone, the third contact would be projected before the second one, with which it shares a point.
TEST(ContactSolver, ProjectsTheLeadingContactsFirst) {
  std::vector<Contact> contacts(3);
  for (int i = 0; i < 3; ++i) contacts[i].point = {i, i + 1, i, i};
  const std::vector<Record> positions(4, Record{0, 0, 0, 1});
  Executor executor(1);
  const auto order_of = [&](std::size_t leading) {
    ContactSolver solver;
    std::vector<std::ptrdiff_t> order;
    solver.begin(kernels_sequential().contacts, contacts, leading, positions.data(), positions.size());
    solver.for_each(executor, "contacts", contacts, [&](const Contact& c) { order.push_back(&c - contacts.data()); });
    return order;
  };
  EXPECT_EQ(order_of(2), (std::vector<std::ptrdiff_t>{0, 1, 2}));
  EXPECT_EQ(order_of(0), (std::vector<std::ptrdiff_t>{0, 2, 1}));
}

/// Two points at rest 2 mm apart whose contact has a thickness of 10 mm.
TEST(ContactSolver, LeavesTheOverlapThatAContactMayYield) {
  const std::vector<Record> positions{{0, 0.002f, 0, 1}, {0, 0, 0, 1}};
  for (const float yield : {0.f, 0.3f, 1.f}) {
    std::vector<Contact> contacts(1);
    Contact& contact = contacts[0];
    contact.point = {0, 1, 0, 0};
    contact.weight = {1, -1, 0, 0};
    contact.normal = {0, 1, 0};
    contact.thickness = 0.01f;
    contact.gap = -0.008f;
    std::vector<Record> displacements(2);
    complete_contact(contact, positions.data(), displacements.data());
    Executor executor(1);
    ContactSolver solver;
    solver.begin(kernels_sequential().contacts, contacts, 0, positions.data(), positions.size());
    solver.project(executor, "contacts", contacts, displacements.data(), yield);
    EXPECT_NEAR(overlap_of(contact, displacements.data()), std::min(0.008f, yield * 0.01f), 1e-7f) << yield;
  }
}

TEST(ContactSolver, GivesTheSameBitsOnAnyThreadsAndInstructionSet) {
  const std::vector<std::string> isas = testing_support::available_code_paths();
  for (const int apart : {8, 30000}) {
    const Tangle tangle = random_tangle(apart == 8 ? 3000 : 40000, 60000, apart, 2);
    std::vector<Contact> expected_contacts;
    const std::vector<Record> expected = projected(kernels_sequential(), 1, tangle, expected_contacts);
    int pushed = 0, slid = 0;
    for (const Contact& c : expected_contacts) {
      pushed += c.push > 0 ? 1 : 0;
      slid += c.push > 0 && length(c.friction) > 0.29f * c.push && length(c.friction) < 0.31f * c.push ? 1 : 0;
    }
    EXPECT_GT(pushed, 20000);
    EXPECT_GT(slid, 5000);
    EXPECT_LT(slid, pushed - 1000) << "none sticks";
    for (const int threads : {1, 2, 3, 4, 8}) {
      for (const std::string& isa : isas) {
        std::vector<Contact> contacts;
        const std::vector<Record> found = projected(pick_kernels(isa), threads, tangle, contacts);
        ASSERT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Record)), 0)
            << isa << " " << threads;
        for (std::size_t i = 0; i < contacts.size(); ++i)
          ASSERT_EQ(std::memcmp(&contacts[i], &expected_contacts[i], sizeof(Contact)), 0) << isa << " " << i;
      }
    }
  }
}

TEST(ContactSolver, AnswersEachContactOnce) {
  const Tangle tangle = random_tangle(40000, 30000, 30000, 3);
  for (const int threads : {1, 3}) {
    Executor executor(threads);
    std::vector<std::atomic<int>> times(tangle.contacts.size());
    executor.enter([&] {
      ContactSolver solver;
      solver.begin(kernels_sequential().contacts, tangle.contacts, 0, tangle.positions.data(), tangle.positions.size());
      solver.for_each(executor, "answer", tangle.contacts,
                      [&](const Contact& c) { ++times[static_cast<std::size_t>(&c - tangle.contacts.data())]; });
    });
    for (const std::atomic<int>& count : times) ASSERT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace pliant
