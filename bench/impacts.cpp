// Measures continuous collision tests: queries that move like cloth, of which few hit, and queries of which most hit.
#include <benchmark/benchmark.h>

#include <random>

#include "geometry/continuous.h"

namespace pliant {
namespace {

template <class R>
struct Query {
  Vec3<R> from[4], to[4];
};

/// Corners about 1 apart, the length of an edge, that move by `speed`.
template <class R>
std::vector<Query<R>> make_queries(int count, double speed) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3d{x, y, z};
  };
  std::vector<Query<R>> queries(static_cast<std::size_t>(count));
  for (Query<R>& query : queries)
    for (int i = 0; i < 4; ++i) {
      const Vec3d from = point();
      query.from[i] = convert<R>(from);
      query.to[i] = convert<R>(from + point() * speed);
    }
  return queries;
}

template <class R, class Test>
void measure(benchmark::State& state, double speed, const Test& test) {
  const auto queries = make_queries<R>(1 << 14, speed);
  std::size_t next = 0, hits = 0, asked = 0;
  for (auto _ : state) {
    const Query<R>& query = queries[next];
    hits += test(query.from, query.to) ? 1 : 0;
    next = (next + 1) % queries.size();
    ++asked;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(asked));
  state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(asked);
}

template <class R>
bool vertex_triangle(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4]) {
  return vertex_triangle_impact(from, to, R(0.01f)).hit;
}
template <class R>
bool edge_edge(const Vec3<R> (&from)[4], const Vec3<R> (&to)[4]) {
  return edge_edge_impact(from, to, R(0.01f)).hit;
}
/// The test in double precision, without the exact test of cases that it leaves open.
bool vertex_triangle_undecided(const Vec3d (&from)[4], const Vec3d (&to)[4]) {
  return vertex_triangle_impact<double>(from, to, 0.01).hit;
}
bool edge_edge_undecided(const Vec3d (&from)[4], const Vec3d (&to)[4]) {
  return edge_edge_impact<double>(from, to, 0.01).hit;
}

template <class R, class Test>
void add(const std::string& name, const Test& test) {
  for (const double speed : {0.2, 2.0})
    benchmark::RegisterBenchmark(("impacts/" + name + (speed < 1 ? "/small_moves" : "/large_moves")).c_str(),
                                 [speed, test](benchmark::State& state) { measure<R>(state, speed, test); });
}

const bool added = [] {
  add<float>("vertex_triangle_float", vertex_triangle<float>);
  add<double>("vertex_triangle_double", vertex_triangle<double>);
  add<double>("vertex_triangle_undecided", vertex_triangle_undecided);
  add<float>("edge_edge_float", edge_edge<float>);
  add<double>("edge_edge_double", edge_edge<double>);
  add<double>("edge_edge_undecided", edge_edge_undecided);
  return true;
}();

}  // namespace
}  // namespace pliant
