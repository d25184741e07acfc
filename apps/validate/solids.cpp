// Elastic solids with the default settings bear their weight as their modulus says. A bar hangs by one end, and another
// is clamped at one end; the right displacement is that of many times the substeps, which is that of linear finite
// elements of the same mesh to 1 % (tests/soft_bodies/converged_test.cpp).
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
}

}  // namespace pliant::validate
