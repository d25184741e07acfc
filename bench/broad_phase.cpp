// Compares broad phases on triangles that deform in every frame: the spatial hash, and BVHs over each kind of bounding
// volume. Argument: number of vertices along a side of the cloth. The counter `pairs` is the number of overlapping
// volumes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>

#include "pliant/mesh.h"
#include "reference/candidates.h"
#include "reference/spatial_hash.h"
#include "reference/volumes.h"

namespace pliant {
namespace {

constexpr int frames = 8;

/// Triangles, and the positions of their vertices in each frame.
struct Input {
  std::string name;
  std::vector<Triangle> triangles;
  std::vector<std::vector<Vec3f>> frames;
  float edge = 0;  ///< typical edge length [m]
};

using Move = std::function<Vec3d(const Vec3d&, double phase)>;

Input moving(const char* name, const TriangleMesh& mesh, float edge, const Move& move) {
  Input input{name, mesh.triangles, {}, edge};
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Vec3f> positions;
    for (const Vec3f& p : mesh.positions) {
      const Vec3d q = move({p.x, p.y, p.z}, 0.02 * frame);
      positions.push_back({static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
    }
    input.frames.push_back(std::move(positions));
  }
  return input;
}

Vec3d wave(const Vec3d& p, double phase) {
  return {p.x, 0.1 * std::sin(6 * p.x + 5 * phase) * std::cos(7 * p.z - 3 * phase), p.z};
}

/// Rolls a sheet up to an Archimedean spiral whose windings are `gap` apart; `phase` rotates it.
Vec3d roll(const Vec3d& p, double phase, double gap) {
  constexpr double pi = 3.141592653589793;
  const double along = p.x + 0.5, pitch = gap / (2 * pi), inner = 4 * gap;
  const double angle = (std::sqrt(inner * inner + 2 * pitch * along) - inner) / pitch;
  const double radius = inner + pitch * angle;
  return {radius * std::cos(angle + phase), radius * std::sin(angle + phase),
          p.z + 0.002 * std::sin(20 * along + phase)};
}

std::vector<Input> make_inputs(int size) {
  const TriangleMesh sheet = grid_mesh(size, size, 1, 1);
  const double edge = 1.0 / (size - 1);
  int subdivisions = 0;
  while (subdivisions < 7 && 20 << (2 * (subdivisions + 1)) <= static_cast<int>(sheet.triangles.size())) ++subdivisions;
  const TriangleMesh ball = sphere_mesh(subdivisions);
  const float ball_edge = 1.1f / static_cast<float>(1 << subdivisions);
  std::vector<Input> inputs;
  inputs.push_back(moving("cloth", sheet, static_cast<float>(edge), wave));
  inputs.push_back(moving("rolled cloth", sheet, static_cast<float>(edge),
                          [edge](const Vec3d& p, double phase) { return roll(p, phase, 0.5 * edge); }));
  inputs.push_back(moving("sphere", ball, ball_edge,
                          [](const Vec3d& p, double phase) { return p * (1 + 0.2 * std::sin(4 * p.y + 5 * phase)); }));
  return inputs;
}

template <class B>
std::vector<B> volumes_of(const Input& input, std::size_t frame) {
  std::vector<B> volumes;
  volumes.reserve(input.triangles.size());
  for (const Triangle& t : input.triangles) {
    Vec3f corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = input.frames[frame][static_cast<std::size_t>(t[k])];
    volumes.push_back(B::of(corners, 3).grown(0.25f * input.edge));  // reports pairs that are within half an edge
  }
  return volumes;
}

/// Measures refit(frame) and query() in turn; query() returns the number of pairs.
template <class Refit, class Query>
void measure(benchmark::State& state, const Input& input, const Refit& refit, const Query& query) {
  std::size_t frame = 0;
  double pairs = 0;
  for (auto _ : state) {
    refit(frame);
    pairs = static_cast<double>(query());
    frame = (frame + 1) % input.frames.size();
  }
  state.counters["pairs"] = pairs;
  state.counters["triangles"] = static_cast<double>(input.triangles.size());
}

template <class Structure>
std::size_t self_pairs_of(const Structure& structure) {
  std::size_t pairs = 0;
  structure.self_pairs([&](int, int) { ++pairs; });
  return pairs;
}

template <class B, int fanout>
void tree(benchmark::State& state, std::size_t which) {
  const Input input = make_inputs(static_cast<int>(state.range(0)))[which];
  Tree<B, fanout> tree;
  tree.build(volumes_of<B>(input, 0));
  measure(
      state, input, [&](std::size_t frame) { tree.refit(volumes_of<B>(input, frame)); },
      [&] { return self_pairs_of(tree); });
}

void hash(benchmark::State& state, std::size_t which, float cell) {
  const Input input = make_inputs(static_cast<int>(state.range(0)))[which];
  SpatialHash hash(cell * input.edge);
  measure(
      state, input, [&](std::size_t frame) { hash.build(volumes_of<BoxBounds>(input, frame)); },
      [&] { return self_pairs_of(hash); });
}

void candidates(benchmark::State& state, std::size_t which) {
  const Input input = make_inputs(static_cast<int>(state.range(0)))[which];
  Executor executor(1);
  CandidateFinder finder(make_contact_elements(input.triangles, {}, {}, static_cast<int>(input.frames[0].size())));
  measure(
      state, input,
      [&](std::size_t frame) {
        finder.find(executor, input.frames[frame], input.frames[frame], 0.5f * input.edge, frame == 0);
      },
      [&] { return finder.vertex_triangles().items.size() + finder.edge_edges().items.size(); });
}

using Run = std::function<void(benchmark::State&, std::size_t)>;

void add(const std::string& method, const Run& run) {
  const char* const names[] = {"cloth", "rolled_cloth", "sphere"};
  for (std::size_t input = 0; input < 3; ++input)
    benchmark::RegisterBenchmark(("broad_phase/" + method + "/" + names[input]).c_str(),
                                 [run, input](benchmark::State& state) { run(state, input); })
        ->Arg(64)
        ->Arg(128)
        ->Unit(benchmark::kMillisecond);
}

const bool added = [] {
  for (const int cell : {1, 2, 4})
    add("hash_" + std::to_string(cell) + "_edges",
        [cell](benchmark::State& state, std::size_t i) { hash(state, i, static_cast<float>(cell)); });
  add("boxes_2", tree<BoxBounds, 2>);
  add("boxes_4", tree<BoxBounds, 4>);
  add("boxes_8", tree<BoxBounds, 8>);
  add("spheres", tree<SphereBounds, 8>);
  add("oriented_boxes", tree<OrientedBoxBounds, 8>);
  add("14_dops", tree<KDopBounds<14>, 8>);
  add("18_dops", tree<KDopBounds<18>, 8>);
  add("candidates", candidates);
  return true;
}();

}  // namespace
}  // namespace pliant
