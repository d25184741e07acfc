#include "apps/bench/tears.h"

#include <utility>

#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

Object block(int cells) { return make_soft_body(box_tetrahedra({1, 1, 1}, {cells, cells, cells})); }

Object hanging_cloth(int cells) {
  TriangleMesh mesh = grid_mesh(cells + 1, cells + 1, 1, 1);
  for (Vec3f& p : mesh.positions) p = {p.x, -p.z, 0};
  Object cloth = make_cloth(mesh);
  for (int i = 0; i <= cells; ++i) cloth.pins.push_back({i, {}});
  return cloth;
}

/// A World of an object that hangs in the air, and is cut from above within so many frames.
World world_of(Object object, bool is_cut, int frames) {
  if (is_cut)
    object.cuts.push_back({0, static_cast<float>(frames) * frame_time, {0.003f, 0, 0}, {1, 0.01f, 0}, {0, -1, 0}});
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return World(scene);
}

double stepped(World& world, Report& report) {
  const double before = processor_ms();
  report = world.step(frame_time);
  return processor_ms() - before;
}

TearRow measure(TearRow row, const Object& object, int frames) {
  World whole = world_of(object, false, frames), cut = world_of(object, true, frames);
  std::vector<double> whole_ms, cut_ms, ratios;
  for (int frame = 0; frame < frames; ++frame) {
    Report of_whole, of_cut;
    const double one = stepped(whole, of_whole), other = stepped(cut, of_cut);
    row.substeps = of_whole.substeps;
    if (of_cut.torn.empty()) continue;
    ++row.cuts;
    row.copies += of_cut.torn[0].new_particles;
    whole_ms.push_back(one);
    cut_ms.push_back(other);
    ratios.push_back(other / one);
  }
  if (row.cuts == 0) return row;
  row.copies /= row.cuts;
  row.whole_ms = median(whole_ms);
  row.cut_ms = median(cut_ms);
  row.ratio = median(ratios);
  row.us_per_copy = 1e3 * (row.cut_ms - row.whole_ms) / row.copies;
  row.ns_per_element = 1e6 * (row.cut_ms - row.whole_ms) / row.elements;
  return row;
}

}  // namespace

std::vector<TearRow> measure_tears(const TearOptions& options) {
  constexpr int smallest = 2, largest = 60, cells_of_cloth = 8;
  if (options.frames < 1) throw Error({}, "nothing is cut in no frames", "give at least one");
  std::vector<TearRow> rows;
  const auto add = [&](const std::string& name, int cells, const Object& object, std::size_t elements) {
    TearRow row;
    row.object = name;
    row.cells = cells;
    row.elements = static_cast<int>(elements);
    rows.push_back(measure(row, object, options.frames));
    if (options.on_row) options.on_row(rows.back());
  };
  for (const int cells : options.sizes) {
    if (cells < smallest || cells > largest)
      throw Error({}, "a block of " + std::to_string(cells) + " cells along each side", "give 2 to 60");
    const Object solid = block(cells), cloth = hanging_cloth(cells_of_cloth * cells);
    add("block", cells, solid, tetrahedra_of(solid).size());
    add("cloth", cells_of_cloth * cells, cloth, cloth.triangles.size());
  }
  return rows;
}

}  // namespace pliant::bench
