#include "apps/bench/soft_bodies.h"

#include <algorithm>
#include <array>

#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr float cell = 0.02f;
constexpr const char *plain_loop_row = "plain loop", *pliant_row = "pliant", *two_threads_row = "two threads";

TetrahedralMesh bar_of(int cells) {
  const int across = std::max(1, cells / 4);
  return box_tetrahedra(cell * Vec3f{static_cast<float>(cells), static_cast<float>(across), static_cast<float>(across)},
                        {cells, across, across});
}

/// Rigid distances along all edges, instead of the constraint on shear; the volumes become rigid.
void use_edges(const TetrahedralMesh& mesh, Object& bar) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k) edges.push_back({std::min(t[i], t[k]), std::max(t[i], t[k])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  ConstraintGroup group;
  group.type = "distance";
  for (const auto& [a, b] : edges) group.particles.insert(group.particles.end(), {a, b});
  bar.constraints[0] = std::move(group);
  bar.constraints[1].compliances.clear();
  bar.constraints[1].stiffness = Stiffness::rigid();
}

struct Case {
  const char* material;
  bool has_edges;
  int substeps;
};
constexpr std::array<Case, 2> cases{{{"edges and volumes", true, 10}, {"neo-Hookean", false, 20}}};

Scene scene_of(const TetrahedralMesh& mesh, const Case& of) {
  SoftBodyOptions options;
  options.material.youngs_modulus = 1e6f;
  Object bar = make_soft_body(mesh, options);
  if (of.has_edges) use_edges(mesh, bar);
  bar.collides = false;
  bar.sweep = Sweep::tiled;
  std::vector<int> held;
  float low = 0;
  for (const Vec3f& p : mesh.positions) low = std::min(low, p.x);
  for (int i = 0; i < static_cast<int>(mesh.positions.size()); ++i)
    if (mesh.positions[static_cast<std::size_t>(i)].x < low + 0.1f * cell) held.push_back(i);
  Scene scene;
  scene.settings.threads = 1;
  scene.settings.substeps = of.substeps;
  scene.add(std::move(bar));
  scene.pin(0, held);
  return scene;
}

double six_volumes(const std::vector<Vec3f>& at, const std::array<int, 4>& t) {
  const auto place = [&](int corner) {
    const Vec3f p = at[static_cast<std::size_t>(corner)] - at[static_cast<std::size_t>(t[0])];
    return Vec3d{p.x, p.y, p.z};
  };
  return dot(cross(place(t[1]), place(t[2])), place(t[3]));
}

/// One of the ways to step the same bar.
class Bar {
 public:
  Bar(const Scene& scene, const TetrahedralMesh& mesh, const char* engine) : Bar(for_engine(scene, engine), mesh) {
    row_.engine = engine;
  }

  void step() {
    const double before = processor_ms(), wall_before = wall_ms();
    const Report report = world_.step(frame_time);
    times_.push_back(processor_ms() - before);
    wall_times_.push_back(wall_ms() - wall_before);
    row_.substeps = report.substeps;
    row_.inverted = 0;
    const std::vector<Vec3f> positions = world_.object(ObjectId(0)).positions();
    for (const auto& t : mesh_.tetrahedra) {
      const double share = six_volumes(positions, t) / six_volumes(mesh_.positions, t);
      row_.inverted += share < 0;
      row_.worst = std::min(row_.worst, share);
    }
  }

  /// Compares the times with those of the same frames.
  SoftBodyRow row(const Bar& other) {
    const bool is_parallel = row_.engine == two_threads_row;
    const std::vector<double>&mine = is_parallel ? wall_times_ : times_,
          &theirs = is_parallel ? other.wall_times_ : other.times_;
    row_.median_ms = median(mine);
    row_.ns = 1e6 * row_.median_ms / (static_cast<double>(row_.projections) * row_.substeps);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < mine.size(); ++i) ratios.push_back(theirs[i] / mine[i]);
    row_.ratio = median(ratios);
    return row_;
  }

  std::string hash() const { return world_.state_hash(); }
  SoftBodyRow& row() { return row_; }

 private:
  Bar(const Scene& scene, const TetrahedralMesh& mesh) : started_(processor_ms()), mesh_(mesh), world_(scene) {
    row_.set_up_ms = processor_ms() - started_;
    row_.worst = 1;
    row_.tetrahedra = static_cast<int>(mesh.tetrahedra.size());
    for (const ConstraintGroup& group : scene.objects[0].constraints)
      row_.projections += static_cast<int>(group.particles.size() / (group.type == "distance" ? 2 : 4));
  }

  static Scene for_engine(Scene scene, const char* engine) {
    if (engine == plain_loop_row) scene.settings.isa = "sequential";
    if (engine == two_threads_row) scene.settings.threads = 2;
    return scene;
  }

  double started_;
  const TetrahedralMesh& mesh_;
  World world_;
  SoftBodyRow row_;
  std::vector<double> times_, wall_times_;
};

void measure(const Case& of, int cells, const SoftBodyBenchOptions& options, std::vector<SoftBodyRow>& rows) {
  const TetrahedralMesh mesh = bar_of(cells);
  const Scene scene = scene_of(mesh, of);
  std::vector<Bar> bars;
  for (const char* engine : {plain_loop_row, pliant_row, two_threads_row}) bars.emplace_back(scene, mesh, engine);
  for (int frame = 0; frame < options.frames; ++frame)
    for (Bar& bar : bars) bar.step();
  for (Bar& bar : bars) {
    if (bar.hash() != bars[0].hash())
      throw Error({}, "the plain loop, the lanes and two threads do not give the same bits", "report this as a bug");
    bar.row().cells = cells;
    bar.row().material = of.material;
    rows.push_back(bar.row(bar.row().engine == two_threads_row ? bars[1] : bars[0]));
    if (options.on_row) options.on_row(rows.back());
  }
}

}  // namespace

std::vector<SoftBodyRow> measure_soft_bodies(const SoftBodyBenchOptions& options) {
  std::vector<SoftBodyRow> rows;
  for (const int cells : options.sizes)
    if (cells < 4 || cells > 400) throw Error({}, "a bar of " + std::to_string(cells) + " cells", "give 4 to 400");
  for (const int cells : options.sizes)
    for (const Case& of : cases) measure(of, cells, options, rows);
  return rows;
}

}  // namespace pliant::bench
