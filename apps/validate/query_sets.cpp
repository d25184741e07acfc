// Continuous tests on query sets whose answers are known exactly: none missed, hardly any false alarm, and how fast.
#include <ctime>

#include "apps/validate/rows.h"
#include "geometry/continuous.h"
#include "pliant/error.h"
#include "tests/support/query_sets.h"

namespace pliant::validate {
namespace {

using testing_support::CollisionQuery;

struct Answers {
  int missed = 0, false_alarms = 0;
  double per_second = 0;  ///< queries, of one thread's processor time
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
  answers.per_second = static_cast<double>(queries.size()) * CLOCKS_PER_SEC / static_cast<double>(std::clock() - start + 1);
  return answers;
}

/// The same queries over and over: the clock tells nothing about a thousand.
std::vector<CollisionQuery> repeated(const std::vector<CollisionQuery>& queries, int times) {
  std::vector<CollisionQuery> result;
  for (int i = 0; i < times; ++i) result.insert(result.end(), queries.begin(), queries.end());
  return result;
}

/// `undecided` is double precision alone, which can't tell what touches from what passes by a hair: its false alarms are counted
/// where `decided` says that more than 1e-12 m lie between.
template <class Undecided, class Decided>
void add_rows(Result& result, const std::string& what, const std::vector<CollisionQuery>& queries,
              const Undecided& undecided, const Decided& decided) {
  const std::string name = "collision: continuous, query sets, " + what;
  const std::string of = "of " + std::to_string(queries.size());
  const auto rate = [](const Answers& answers) { return "; " + brief(answers.per_second / 1e6) + " million a second"; };
  const Answers answers = ask(queries, [&](const CollisionQuery& query) { return decided(query, 0.0); });
  const Answers timed = ask(repeated(queries, 50), [&](const CollisionQuery& query) { return decided(query, 0.0); });
  result.rows.push_back(at_most(name + ", missed", 0, answers.missed, "", of + rate(timed)));
  result.rows.push_back(
      at_most(name + ", false alarms", 0.01 * static_cast<double>(queries.size()), answers.false_alarms, "", "1 % " + of));
  const Answers in_double = ask(repeated(queries, 50), undecided);
  result.rows.push_back(at_most(name + ", undecided, missed", 0, in_double.missed, "", of + rate(in_double)));
  int far = 0;
  for (const CollisionQuery& query : queries) far += undecided(query) && !query.hits && !decided(query, 1e-12) ? 1 : 0;
  result.rows.push_back(at_most(name + ", undecided, false alarms beyond 1e-12 m", 0, far, "", of));
}

}  // namespace

void query_set_rows(Result& result, const std::string& folder) {
  const auto points = testing_support::read_query_sets(folder, "vertex-face");
  const auto edges = testing_support::read_query_sets(folder, "edge-edge");
  if (points.empty() || edges.empty()) {
    Location where;
    where.file = folder;
    throw Error(where, "holds no queries",
                "give --queries a folder of .csv files below folders 'vertex-face' and 'edge-edge'");
  }
  add_rows(
      result, "vertex and triangle", points,
      [](const CollisionQuery& q) { return vertex_triangle_impact<double>(q.from, q.to, 0.0).hit; },
      [](const CollisionQuery& q, double within) { return vertex_triangle_impact(q.from, q.to, within).hit; });
  add_rows(
      result, "two edges", edges, [](const CollisionQuery& q) { return edge_edge_impact<double>(q.from, q.to, 0.0).hit; },
      [](const CollisionQuery& q, double within) { return edge_edge_impact(q.from, q.to, within).hit; });
}

}  // namespace pliant::validate
