// Inputs that deform frame by frame, and each broad phase over them.
#include "apps/bench/broadphase.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "reference/candidates.h"
#include "reference/spatial_hash.h"
#include "reference/volumes.h"

namespace pliant::bench {

namespace {

/// Triangles and where their vertices are in each frame.
struct Input {
  std::string name;
  std::vector<Triangle> triangles;
  std::vector<std::vector<Vec3f>> frames;
  float edge = 0;  ///< typical length [m]
};

using Move = std::function<Vec3d(const Vec3d&, double phase)>;

Input moving(const char* name, const TriangleMesh& mesh, float edge, int frames, const Move& move) {
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

/// Onto an Archimedean spiral whose windings are `gap` apart and turn with the phase.
Vec3d roll(const Vec3d& p, double phase, double gap) {
  constexpr double pi = 3.141592653589793;
  const double along = p.x + 0.5, pitch = gap / (2 * pi), inner = 4 * gap;
  const double angle = (std::sqrt(inner * inner + 2 * pitch * along) - inner) / pitch;
  const double radius = inner + pitch * angle;
  return {radius * std::cos(angle + phase), radius * std::sin(angle + phase), p.z + 0.002 * std::sin(20 * along + phase)};
}

std::vector<Input> make_inputs(int size, int frames) {
  const TriangleMesh sheet = grid_mesh(size, size, 1, 1);
  const double edge = 1.0 / (size - 1);
  int subdivisions = 0;
  while (subdivisions < 7 && 20 << (2 * (subdivisions + 1)) <= static_cast<int>(sheet.triangles.size())) ++subdivisions;
  const TriangleMesh ball = sphere_mesh(subdivisions);
  const float ball_edge = 1.1f / static_cast<float>(1 << subdivisions);
  std::vector<Input> inputs;
  inputs.push_back(moving("cloth", sheet, static_cast<float>(edge), frames, wave));
  inputs.push_back(moving("rolled cloth", sheet, static_cast<float>(edge), frames,
                          [edge](const Vec3d& p, double phase) { return roll(p, phase, 0.5 * edge); }));
  inputs.push_back(moving("sphere", ball, ball_edge, frames,
                          [](const Vec3d& p, double phase) { return p * (1 + 0.2 * std::sin(4 * p.y + 5 * phase)); }));
  return inputs;
}

/// Processor time, so that other work on the machine counts little.
double milliseconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC;
}

double elapsed_milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class B>
std::vector<B> volumes_of(const Input& input, std::size_t frame) {
  std::vector<B> volumes;
  volumes.reserve(input.triangles.size());
  for (const Triangle& t : input.triangles) {
    Vec3f corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = input.frames[frame][static_cast<std::size_t>(t[k])];
    volumes.push_back(B::of(corners, 3).grown(0.25f * input.edge));  // pairs within half an edge
  }
  return volumes;
}

class Measurement {
 public:
  explicit Measurement(const BroadPhaseOptions& options) : options_(options) {}

  void run(int size) {
    for (const Input& input : make_inputs(size, options_.frames)) {
      for (const float cell : {1.f, 2.f, 4.f}) measure_hash(input, cell);
      measure_tree<BoxBounds, 2>(input, "boxes, 2 a node");
      measure_tree<BoxBounds, 4>(input, "boxes, 4 a node");
      measure_tree<BoxBounds, 8>(input, "boxes, 8 a node");
      measure_tree<SphereBounds, 8>(input, "spheres");
      measure_tree<OrientedBoxBounds, 8>(input, "oriented boxes");
      measure_tree<KDopBounds<14>, 8>(input, "14-DOPs");
      measure_tree<KDopBounds<18>, 8>(input, "18-DOPs");
      measure_candidates(input, 1);
      if (Executor(options_.threads).threads() > 1) measure_candidates(input, options_.threads);
    }
  }

  std::vector<BroadPhaseRow> take_rows() { return std::move(rows_); }

 private:
  /// refit(frame) fits to that frame's positions, query() returns a number of pairs.
  template <class Refit, class Query>
  void measure(const Input& input, const std::string& method, double build_ms, const Refit& refit, const Query& query,
               bool by_processor = true) {
    const auto time = by_processor ? milliseconds : elapsed_milliseconds;
    BroadPhaseRow row{input.name, static_cast<int>(input.triangles.size()), method, build_ms};
    std::vector<double> refits, queries;
    for (std::size_t frame = 0; frame < input.frames.size(); ++frame) {
      refits.push_back(refit(frame));
      queries.push_back(time([&] { row.pairs = static_cast<double>(query()); }));
    }
    row.refit_ms = median(refits);
    row.query_ms = median(queries);
    rows_.push_back(row);
    if (options_.on_row) options_.on_row(row);
  }

  template <class B, int fanout>
  void measure_tree(const Input& input, const char* method) {
    Tree<B, fanout> tree;
    std::vector<B> volumes = volumes_of<B>(input, 0);
    const double build = milliseconds([&] {
      volumes = volumes_of<B>(input, 0);
      tree.build(volumes);
    });
    measure(
        input, method, build,
        [&](std::size_t frame) {
          return milliseconds([&] {
            volumes = volumes_of<B>(input, frame);
            tree.refit(volumes);
          });
        },
        [&] {
          std::size_t pairs = 0;
          tree.self_pairs([&](int, int) { ++pairs; });
          return pairs;
        });
  }

  void measure_hash(const Input& input, float cell) {
    SpatialHash hash(cell * input.edge);
    const auto fill = [&](std::size_t frame) {
      return milliseconds([&] { hash.build(volumes_of<BoxBounds>(input, frame)); });
    };
    const double build = fill(0);
    char name[64];
    std::snprintf(name, sizeof name, "hash, cells of %g edges", static_cast<double>(cell));
    measure(input, name, build, fill, [&] {
      std::size_t pairs = 0;
      hash.self_pairs([&](int, int) { ++pairs; });
      return pairs;
    });
  }

  void measure_candidates(const Input& input, int threads) {
    Executor executor(threads);
    const int vertices = static_cast<int>(input.frames[0].size());
    CandidateFinder finder(make_contact_elements(input.triangles, {}, {}, vertices));
    const auto find = [&](std::size_t frame, bool anew) {
      finder.find(executor, input.frames[frame], input.frames[frame], 0.5f * input.edge, anew);
    };
    const double build = milliseconds([&] { find(0, true); });
    std::size_t frame = 0;
    measure(
        input, "candidates, " + std::to_string(executor.threads()) + (executor.threads() == 1 ? " thread" : " threads"),
        build,
        [&](std::size_t next) {
          frame = next;
          return 0.0;
        },
        [&] {
          find(frame, false);
          return finder.vertex_triangles().items.size() + finder.edge_edges().items.size();
        },
        executor.threads() == 1);
  }

  const BroadPhaseOptions& options_;
  std::vector<BroadPhaseRow> rows_;
};

}  // namespace

std::vector<BroadPhaseRow> measure_broad_phases(const BroadPhaseOptions& options) {
  if (options.frames < 1) throw Error({}, "there are no frames to measure", "measure at least 1");
  for (const int size : options.sizes)
    if (size < 2 || size > 4096)
      throw Error({}, "a cloth of " + std::to_string(size) + " vertices a side can't be measured",
                  "choose a size in 2..4096");
  Measurement measurement(options);
  for (const int size : options.sizes) measurement.run(size);
  return measurement.take_rows();
}

std::string to_json(const std::vector<BroadPhaseRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BroadPhaseRow& row : rows)
    list.push_back({{"input", row.input},
                    {"triangles", row.triangles},
                    {"method", row.method},
                    {"build_ms", row.build_ms},
                    {"refit_ms", row.refit_ms},
                    {"query_ms", row.query_ms},
                    {"pairs", row.pairs}});
  return list.dump(2) + "\n";
}

}  // namespace pliant::bench
