// The rate of continuous tests: queries of a cloth's size of motion, most of which miss, and such as nearly all hit.
#include <ctime>
#include <nlohmann/json.hpp>
#include <random>

#include "apps/bench/broadphase.h"
#include "geometry/continuous.h"

namespace pliant::bench {

namespace {

template <class R>
struct Query {
  Vec3<R> from[4], to[4];
};

/// Corners about an edge's length, 1, apart that move by `speed`.
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
ImpactRow measure(const char* name, const char* precision, int count, double speed, const Test& test) {
  const auto queries = make_queries<R>(count, speed);
  int hits = 0;
  const std::clock_t start = std::clock();
  for (const Query<R>& query : queries) hits += test(query.from, query.to) ? 1 : 0;
  const double seconds = static_cast<double>(std::clock() - start + 1) / CLOCKS_PER_SEC;
  return {name, speed < 1 ? "small moves" : "large moves", precision, count / seconds * 1e-6,
          static_cast<double>(hits) / count};
}

constexpr int count = 300000;

template <class R>
void measure_both(const char* precision, double speed, std::vector<ImpactRow>& rows) {
  rows.push_back(measure<R>("vertex-triangle", precision, count, speed, [](const auto& from, const auto& to) {
    return vertex_triangle_impact(from, to, R(0.01f)).hit;
  }));
  rows.push_back(measure<R>("edge-edge", precision, count, speed,
                            [](const auto& from, const auto& to) { return edge_edge_impact(from, to, R(0.01f)).hit; }));
}

}  // namespace

std::vector<ImpactRow> measure_impacts() {
  std::vector<ImpactRow> rows;
  for (const double speed : {0.2, 2.0}) {
    measure_both<float>("float", speed, rows);
    measure_both<double>("double", speed, rows);
    rows.push_back(measure<double>("vertex-triangle", "undecided", count, speed, [](const auto& from, const auto& to) {
      return vertex_triangle_impact<double>(from, to, 0.01).hit;
    }));
    rows.push_back(measure<double>("edge-edge", "undecided", count, speed, [](const auto& from, const auto& to) {
      return edge_edge_impact<double>(from, to, 0.01).hit;
    }));
  }
  return rows;
}

std::string to_json(const std::vector<ImpactRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ImpactRow& row : rows)
    list.push_back({{"test", row.test},
                    {"queries", row.queries},
                    {"precision", row.precision},
                    {"million_per_second", row.million_per_second},
                    {"hits", row.hits}});
  return list.dump(2) + "\n";
}

}  // namespace pliant::bench
