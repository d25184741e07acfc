// Continuous collision tests on sets of queries with exactly known answers: no misses, few false positives, and the
// speed.
#include <ctime>

#include "apps/validate/query_sets.h"
#include "apps/validate/rows.h"
#include "pliant/error.h"
#include "pliant/queries.h"

namespace pliant::validate {
namespace {

struct Answers {
  int missed = 0, false_alarms = 0;
  double per_second = 0;  ///< queries per second of one thread's processor time
};

template <class Test>
Answers ask(const std::vector<CollisionQuery>& queries, const Test& test) {
  Answers answers;
  const std::clock_t start = std::clock();
  for (const CollisionQuery& query : queries) {
    const bool found = test(query);
    answers.missed += query.hits && !found ? 1 : 0;
    answers.false_alarms += found && !query.hits ? 1 : 0;
  }
  answers.per_second =
      static_cast<double>(queries.size()) * CLOCKS_PER_SEC / static_cast<double>(std::clock() - start + 1);
  return answers;
}

/// Repeats the queries `times` times, because a thousand are too few to measure a time.
std::vector<CollisionQuery> repeated(const std::vector<CollisionQuery>& queries, int times) {
  std::vector<CollisionQuery> result;
  for (int i = 0; i < times; ++i) result.insert(result.end(), queries.begin(), queries.end());
  return result;
}

template <class Test>
void add_rows(Result& result, const std::string& what, const std::vector<CollisionQuery>& queries, const Test& test) {
  const std::string name = "collision: continuous, query sets, " + what;
  const std::string of = "of " + std::to_string(queries.size());
  const auto rate = [](const Answers& answers) { return "; " + brief(answers.per_second / 1e6) + " million a second"; };
  const Answers answers = ask(queries, test), timed = ask(repeated(queries, 50), test);
  result.rows.push_back(at_most(name + ", missed", 0, answers.missed, "", of + rate(timed)));
  result.rows.push_back(at_most(name + ", false alarms", 0.01 * static_cast<double>(queries.size()),
                                answers.false_alarms, "", "1 % " + of));
}

}  // namespace

void query_set_rows(Result& result, const std::string& folder) {
  const auto points = read_query_sets(folder, "vertex-face");
  const auto edges = read_query_sets(folder, "edge-edge");
  if (points.empty() || edges.empty()) {
    Location where;
    where.file = folder;
    throw Error(where, "holds no queries",
                "give --queries a folder of .csv files below folders 'vertex-face' and 'edge-edge'");
  }
  add_rows(result, "vertex and triangle", points,
           [](const CollisionQuery& q) { return vertex_triangle_impact(q.from, q.to, 0.0).has_value(); });
  add_rows(result, "two edges", edges,
           [](const CollisionQuery& q) { return edge_edge_impact(q.from, q.to, 0.0).has_value(); });
}

}  // namespace pliant::validate
