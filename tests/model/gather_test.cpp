// Tests the lists of constraints that an object is compiled from: what is refused, compliances, PBD stiffness.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "model/gather_constraints.h"
#include "model/stiffness.h"
#include "pliant/error.h"

namespace pliant {
namespace {

TEST(Gather, RefusesWhatDoesNotFit) {
  Object object;
  object.name = "thing";
  object.positions.resize(3);
  object.masses.assign(3, 1);
  const auto refused = [&](ConstraintGroup group) {
    object.constraints = {std::move(group)};
    try {
      gather_constraints(object, 1);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({"elastic", {0, 1}, {}, {}, {}}).find("elastic"), std::string::npos);
  EXPECT_NE(refused({"distance", {0, 1, 2}, {}, {}, {}}).find("thing"), std::string::npos);
  EXPECT_NE(refused({"distance", {0, 3}, {}, {}, {}}).find("particle 3"), std::string::npos);
  EXPECT_NE(refused({"distance", {0, -1}, {}, {}, {}}).find("particle -1"), std::string::npos);
  EXPECT_NE(refused({"distance", {0, 1}, {1, 2}, {}, {}}).find("rest"), std::string::npos);
  EXPECT_NE(refused({"distance", {0, 1}, {}, {}, {1, 2}}).find("compliances"), std::string::npos);
  EXPECT_EQ(refused({"distance", {}, {}, {}, {}}), "");
}

TEST(Gather, GivesEachConstraintItsOwnCompliance) {
  Object object;
  object.positions = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  object.masses.assign(3, 1);
  object.constraints = {{"distance", {0, 1, 1, 2}, {}, Stiffness::compliance(7), {0.5f, 0.25f}}};
  const auto lists = gather_constraints(object, 1);
  ASSERT_EQ(lists.size(), 1u);
  EXPECT_EQ(lists[0].response, (Column<float>{0.5f, 0.25f}));
  EXPECT_EQ(lists[0].rest, (Column<float>{1, 2}));
  ASSERT_EQ(lists[0].origin.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(lists[0].origin[i], static_cast<int>(i));
}

TEST(StiffnessPerProjection, LeavesTheShareThatWasAskedFor) {
  for (double k : {0.0, 1e-6, 0.1, 0.5, 0.9, 0.999, 1.0}) {
    for (int n : {1, 2, 10, 200, 100000}) {
      const double each = stiffness_per_projection(k, n);
      EXPECT_NEAR(std::pow(1 - each, n), 1 - k, 1e-10) << k << ", " << n;
    }
  }
}

}  // namespace
}  // namespace pliant
