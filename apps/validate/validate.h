// Known answers: what the engine must give because mechanics says so, as a table that anyone can run.
//
// Rows whose answer is exact use the reference solver in double precision, which shares the engine's formulas; beside each
// stands what the engine itself gives in float, with a tolerance of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/plot/chart.h"

namespace pliant::validate {

/// How `measured` is compared with `expected`.
enum class Comparison {
  relative,  ///< |measured - expected| <= tolerance |expected|
  absolute,  ///< |measured - expected| <= tolerance
  at_most,   ///< measured <= expected; the tolerance is 0
  at_least,  ///< measured >= expected; the tolerance is 0
};

/// One known answer.
struct Row {
  std::string name;  ///< "group: what"
  double expected = 0, measured = 0, tolerance = 0;
  Comparison comparison = Comparison::relative;
  std::string unit;
  bool pass = false;
  std::string note;  ///< settings, where the answer comes from
};

struct Result {
  std::vector<Row> rows;
  std::vector<plot::Chart> charts;
};

struct Options {
  std::optional<std::string> name;  ///< one of group_names() alone
  bool slow = false;                ///< also what takes minutes
  std::string queries;              ///< a folder of query sets for continuous tests, rows of `collision`; empty: none
};

/// A family of rows.
struct Group {
  std::string name, what;
};

const std::vector<Group>& groups();

/// Computes the rows of one group or of all. Throws Error for an unknown name.
Result run_validation(const Options& options = {});

/// The rows as lines of text with a verdict each, and as a JSON list.
std::string to_table(const std::vector<Row>& rows);
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::validate
