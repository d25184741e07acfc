// Validation by known answers: what mechanics requires of the engine, as a table that anyone can compute.
//
// A row with an exact answer uses the reference solver in double precision, which has the engine's formulas. Next to it
// is a row of the engine's own float result, with a tolerance of its own.
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

/// A known answer, and what was measured.
struct Row {
  std::string name;  ///< name of the group, a colon, and what is measured
  double expected = 0, measured = 0, tolerance = 0;
  Comparison comparison = Comparison::relative;
  std::string unit;
  bool pass = false;
  std::string note;  ///< settings, and where the answer comes from
};

struct Result {
  std::vector<Row> rows;
  std::vector<plot::Chart> charts;
};

struct Options {
  std::optional<std::string> name;  ///< one of group_names(); none: all groups
  bool slow = false;                ///< true: also rows that take minutes
  std::string queries;              ///< folder of query sets for rows of the group `collision`; empty: none
};

/// A group of rows, and the function that computes them.
struct Group {
  std::string name, what;
};

const std::vector<Group>& groups();

/// Computes the rows of one group or of all. Throws an Error if the group is unknown.
Result run_validation(const Options& options = {});

/// Writes rows with their verdicts as lines of text; to_json writes them as a JSON list.
std::string to_table(const std::vector<Row>& rows);
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::validate
