// Tests that columns and ordinals contain what was appended, however they store it.
#include "model/column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pliant {
namespace {

std::vector<float> values_of(const Column<float>& column) {
  std::vector<float> values;
  for (std::size_t i = 0; i < column.size(); ++i) values.push_back(column[i]);
  return values;
}

TEST(Column, HoldsEqualNumbersOnceAndSaysSoByItsStride) {
  Column<float> column;
  for (int i = 0; i < 5; ++i) column.push_back(3);
  EXPECT_EQ(values_of(column), std::vector<float>(5, 3));
  EXPECT_EQ(column.row(0, 1).stride, 0);
  column.push_back(4);
  EXPECT_EQ(values_of(column), (std::vector<float>{3, 3, 3, 3, 3, 4}));
  EXPECT_EQ(column.row(0, 1).stride, 1);
  EXPECT_EQ(column.row(0, 1).at(5), 4);
}

TEST(Column, KeepsTheSignsOfZeros) {
  Column<float> column;
  for (const float zero : {0.f, -0.f, 0.f}) column.push_back(zero);
  EXPECT_FALSE(std::signbit(column[0]));
  EXPECT_TRUE(std::signbit(column[1]));
  column.set(0, -0.f);
  EXPECT_TRUE(std::signbit(column[0]));
  EXPECT_FALSE(std::signbit(column[2]));
}

TEST(Column, DoesNotCopyTheFirstArrayUntilItChanges) {
  const std::vector<float> given{1, 2, 3, 4}, more{5, 6};
  Column<float> column;
  column.append(given);
  EXPECT_EQ(column.row(1, 2).first, given.data() + 1);
  column.set(2, 3);  // the value that it has already
  EXPECT_EQ(&column[0], given.data());
  column.set(2, 30);
  EXPECT_EQ(values_of(column), (std::vector<float>{1, 2, 30, 4}));
  column.append(more);
  column.push_back(7);
  EXPECT_EQ(values_of(column), (std::vector<float>{1, 2, 30, 4, 5, 6, 7}));
  EXPECT_EQ(given, (std::vector<float>{1, 2, 3, 4}));
}

TEST(Column, KeepsAnArrayThatIsGivenAway) {
  std::vector<float> given{1, 2, 3};
  const float* first = given.data();
  Column<float> column;
  column.append(std::move(given));
  EXPECT_EQ(&column[0], first);
  EXPECT_EQ(column.own().data(), first);
  column.append(std::vector<float>{4, 5});
  EXPECT_EQ(values_of(column), (std::vector<float>{1, 2, 3, 4, 5}));
}

TEST(Column, AppendsAnArrayToEqualNumbers) {
  const std::vector<float> given{1, 2};
  Column<float> column;
  column.push_back(9);
  column.push_back(9);
  column.append(given);
  EXPECT_EQ(values_of(column), (std::vector<float>{9, 9, 1, 2}));
  EXPECT_EQ(column.own(), (std::vector<float>{9, 9, 1, 2}));
}

TEST(Ordinals, HoldAnyNumbers) {
  const std::vector<int> given{0, 1, 2, 7, 8, 3, 4, 5, 5, 6, -1};
  Ordinals ordinals;
  for (const int value : given) ordinals.push_back(value);
  ASSERT_EQ(ordinals.size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) EXPECT_EQ(ordinals[i], given[i]) << i;
}

}  // namespace
}  // namespace pliant
