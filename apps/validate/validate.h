// Validation against known answers: results that mechanics requires of the engine, as a table that anyone can run.
//
// Rows with an exact answer use the reference solver in double precision, which shares the engine's formulas. Next to each
// is the engine's own float result, with its own tolerance.
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
  std::string note;  ///< settings, and the source of the answer
};

struct Result {
  std::vector<Row> rows;
  std::vector<plot::Chart> charts;
};

struct Options {
  std::optional<std::string> name;  ///< one of group_names() only
  bool slow = false;                ///< include rows that take minutes
  std::string queries;              ///< folder of query sets for continuous tests, rows of `collision`; empty: none
};

/// A group of rows.
struct Group {
  std::string name, what;
};

const std::vector<Group>& groups();

/// Computes the rows of one or all groups. Throws an Error for an unknown name.
Result run_validation(const Options& options = {});

/// The rows as lines of text with verdicts, and as a JSON list.
std::string to_table(const std::vector<Row>& rows);
std::string to_json(const std::vector<Row>& rows);

}  // namespace pliant::validate
