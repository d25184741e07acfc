// Elastic solids with the default settings bear their weight as their modulus says. A bar hangs by one end, and another
// is clamped at one end; the right displacement is that of many times the substeps, which is that of linear finite
// elements of the same mesh to 1 % (tests/soft_bodies/converged_test.cpp). Blocks that stand without friction are
// compressed by rho g H^2 / (2 E).
#include "apps/validate/rows.h"
#include "pliant/soft_body.h"

namespace pliant::validate {
namespace {

struct Bar {
  bool hangs = true;
  int cells = 2;  // over its thickness of 0.1 m
  double poisson_ratio = 0.3;
};

// The mean sag of the free end at rest [m], with the default substeps or `times` as many.
double sag(const Bar& bar, int times) {
  SoftBodyOptions options;
  options.material.density = 1000;
  options.material.youngs_modulus = 1e6f;
  options.material.poisson_ratio = static_cast<float>(bar.poisson_ratio);
  const int n = bar.cells;
  Object object = make_soft_body(
      bar.hangs ? box_tetrahedra({0.1f, 0.5f, 0.1f}, {n, 5 * n, n}) : box_tetrahedra({0.4f, 0.1f, 0.1f}, {4 * n, n, n}),
      options);
  object.damping = 8;
  const std::vector<Vec3f> start = object.positions;
  const auto along = [&](const Vec3f& p) { return bar.hangs ? -p.y / 0.25f : p.x / 0.2f; };
  for (std::size_t i = 0; i < start.size(); ++i)
    if (along(start[i]) < -0.999f) object.pins.push_back({static_cast<int>(i), {}});
  Scene scene = scene_with(std::move(object), bar.hangs ? 4 : 1, 0, 1);
  if (times > 1) scene.settings.substeps = times * chosen_substeps(scene)[0];
  World world(scene);
  for (int frame = 0; frame < 150; ++frame) world.step(frame_time);
  const std::vector<Vec3f> end = world.object(0).positions();
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (along(start[i]) > 0.999f) {
      sum += static_cast<double>(start[i].y - end[i].y);
      ++count;
    }
  return sum / count;
}

constexpr double block_cell = 0.025, block_density = 1000, block_modulus = 3e5;  // [m, kg/m^3, Pa]

// The mean compression of a block that stands on a plane without friction [m]. `height` is its number of cells.
double compression(int width, int height, double poisson_ratio) {
  SoftBodyOptions options;
  options.material.density = static_cast<float>(block_density);
  options.material.youngs_modulus = static_cast<float>(block_modulus);
  options.material.poisson_ratio = static_cast<float>(poisson_ratio);
  options.material.static_friction = options.material.kinetic_friction = 0;
  const auto edge = [](int cells) { return static_cast<float>(block_cell * cells); };
  Object object =
      make_soft_body(box_tetrahedra({edge(width), edge(height), edge(width)}, {width, height, width}), options);
  for (Vec3f& p : object.positions) p.y += edge(height) / 2 + options.thickness;
  object.damping = 4;
  const std::vector<Vec3f> start = object.positions;
  Scene scene = scene_with(std::move(object), standard_gravity, 0, 1);
  scene.colliders.push_back(Collider{});
  World world(scene);
  for (int frame = 0; frame < 200; ++frame) world.step(frame_time);
  const std::vector<Vec3f> end = world.object(0).positions();
  double sums[2] = {0, 0};  // of what the lower and the upper side go down
  for (std::size_t i = 0; i < start.size(); ++i)
    for (const int side : {0, 1})
      if (std::fabs(start[i].y - options.thickness - edge(side * height)) < 0.1f * edge(1))
        sums[side] += static_cast<double>(start[i].y - end[i].y);
  return (sums[1] - sums[0]) / ((width + 1) * (width + 1));
}

void standing_rows(Result& result) {
  for (const bool is_slab : {false, true})
    for (const double poisson_ratio : {0.3, 0.45, 0.49}) {
      const int height = is_slab ? 2 : 4;
      const double size = block_cell * height,
                   right = block_density * standard_gravity * size * size / (2 * block_modulus);
      result.rows.push_back(relative(std::string("solids: engine, ") +
                                         (is_slab ? "slab of 2 cells" : "cube of 4 cells") +
                                         " stands, Poisson's ratio " + brief(poisson_ratio),
                                     right, compression(is_slab ? 8 : 4, height, poisson_ratio), 0.03, "m",
                                     "E 300 kPa, default settings, no friction; expected: rho g H^2 / (2 E)"));
    }
}

}  // namespace

void solid_rows(Result& result, bool /*slow*/) {
  for (const bool hangs : {true, false})
    for (const int cells : {2, 4})
      for (const double poisson_ratio : {0.3, 0.45, 0.49}) {
        const Bar bar{hangs, cells, poisson_ratio};
        result.rows.push_back(relative(std::string("solids: engine, ") + (hangs ? "bar in tension" : "cantilever") +
                                           ", Poisson's ratio " + brief(poisson_ratio) + ", " + brief(cells) + " cells",
                                       sag(bar, 8), sag(bar, 1), 0.03, "m",
                                       "E 1 MPa, default settings; expected: eight times the substeps"));
      }
  standing_rows(result);
}

}  // namespace pliant::validate
