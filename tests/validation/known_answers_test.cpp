// Asserts every row of `pliant validate`, one test for each group, so that they can run in parallel.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "apps/validate/validate.h"
#include "pliant/error.h"
#include "support/paths.h"

namespace pliant::validate {
namespace {

class KnownAnswers : public testing::TestWithParam<std::string> {};

TEST_P(KnownAnswers, EveryRowPasses) {
  Options options;
  options.name = GetParam();
  const std::string queries = test::in_shared_data("ccd/sample-queries");
  if (std::filesystem::exists(queries)) options.queries = queries;
  const Result result = run_validation(options);
  EXPECT_FALSE(result.rows.empty());
  for (const Row& row : result.rows) EXPECT_TRUE(row.pass) << to_table({row});
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const Group& group : groups()) result.push_back(group.name);
  return result;
}

TEST(QuerySets, AreRefusedWhereThereAreNone) {
  Options options;
  options.name = "collision";
  options.queries = test::in_tree("scenes");
  try {
    run_validation(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("holds no queries"), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, KnownAnswers, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& group) { return group.param; });

}  // namespace
}  // namespace pliant::validate
