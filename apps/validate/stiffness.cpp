// Stiffness must not depend on iterations, time step or mesh. A rubber sheet hangs by its upper edge; the sag of its
// lower edge under its own weight must always be the same. (Without XPBD's multiplier, or if that is reset in every
// iteration, the number of iterations changes the sag.)
#include <cmath>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr double cloth_density = 0.5,
                 membrane = 25;  // units [kg/m^2] and [N/m]; the sheet stretches by about a tenth under its own weight

struct Run {
  int side = 9, substeps = 20, iterations = 2;
  double dt = 1.0 / 60;
};

// A square mesh of 1 m x 1 m in the xy-plane.
TriangleMesh upright(int side) {
  TriangleMesh mesh = grid_mesh(side, side, 1, 1);
  for (Vec3f& x : mesh.positions) x = {x.x, -x.z, 0};
  return mesh;
}

bool at_top(const Vec3f& x) { return x.y > 0.4999f; }
bool at_bottom(const Vec3f& x) { return x.y < -0.4999f; }

void hang_by_top(Object& sheet) {
  sheet.damping = 6;
  for (std::size_t i = 0; i < sheet.positions.size(); ++i)
    if (at_top(sheet.positions[i])) sheet.pins.push_back({static_cast<int>(i), {}});
}

/// By how much the lower edge of a sheet has sunk [m].
double mean_sinking(const std::vector<Vec3f>& start, const std::vector<Vec3f>& end) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (at_bottom(start[i])) {
      sum += static_cast<double>(start[i].y - end[i].y);
      ++count;
    }
  return sum / count;
}

// The mean sag of the lower edge at rest [m].
double sinking(const Run& run) {
  ClothOptions options;
  options.material.area_density = static_cast<float>(cloth_density);
  options.material.stretch_stiffness = static_cast<float>(membrane);
  options.bending_model = ClothOptions::Bending::none;
  Object object = make_cloth(upright(run.side), options);
  hang_by_top(object);
  const std::vector<Vec3f> start = object.positions;
  World world(scene_with(std::move(object), standard_gravity, run.substeps, run.iterations));
  for (int i = 0; i * run.dt < 4; ++i) world.step(static_cast<float>(run.dt));
  return mean_sinking(start, world.object(0).positions());
}

plot::Series empty(const std::string& name) { return {name, {}, {}, plot::Series::Style::points}; }

void iteration_rows(Result& result, double expected) {
  plot::Series curve = empty("engine");
  for (int iterations : {1, 2, 5, 20, 50, 200}) {
    Run run;
    run.iterations = iterations;
    const double measured = sinking(run);
    result.rows.push_back(
        relative("stiffness: engine, sinking, " + brief(iterations) + (iterations > 1 ? " iterations" : " iteration"),
                 expected, measured, 0.01, "m", "20 substeps, dt 1/60 s, 9 x 9; expected: 50 substeps of 50"));
    curve.x.push_back(iterations);
    curve.y.push_back(1000 * measured);
  }
  plot::Series line{"converged", {1, 200}, {1000 * expected, 1000 * expected}, plot::Series::Style::dashed};
  result.charts.push_back({"A hanging sheet sinks as far whatever the iterations",
                           "iterations",
                           "sinking [mm]",
                           true,
                           false,
                           {line, curve},
                           true});
}

void time_step_rows(Result& result, double expected) {
  for (int rate : {30, 60, 120, 240, 1000}) {
    Run run;
    run.dt = 1.0 / rate;
    run.iterations = 10;
    result.rows.push_back(relative("stiffness: engine, sinking, dt 1/" + brief(rate) + " s", expected, sinking(run),
                                   0.01, "m", "20 substeps of 10 iterations, 9 x 9; expected: 50 substeps of 50"));
  }
}

void mesh_rows(Result& result) {
  Run finest;
  finest.side = 33;
  finest.iterations = 30;
  const double expected = sinking(finest);
  for (int side : {9, 17}) {
    Run run = finest;
    run.side = side;
    result.rows.push_back(relative("stiffness: engine, sinking, mesh " + brief(side) + " x " + brief(side), expected,
                                   sinking(run), 0.02, "m",
                                   "20 substeps of 30 iterations, dt 1/60 s; expected: 33 x 33"));
  }
}

// The sag of a sheet by default settings, over rho g L^2 / (2 Y). Its inner vertices are moved by up to a quarter of an
// edge.
double irregular_sag_over_known(int side, double stiffness) {
  ClothOptions options;
  options.material.area_density = 0.2f;
  options.material.stretch_stiffness = static_cast<float>(stiffness);
  options.bending_model = ClothOptions::Bending::none;
  TriangleMesh mesh = upright(side);
  Random random(9);
  const double by = 0.25 / (side - 1);
  for (Vec3f& x : mesh.positions) {
    if (std::fabs(x.x) > 0.4999f || std::fabs(x.y) > 0.4999f) continue;
    x.x += static_cast<float>(random.uniform(-by, by));
    x.y += static_cast<float>(random.uniform(-by, by));
  }
  Object object = make_cloth(mesh, options);
  hang_by_top(object);
  const std::vector<Vec3f> start = object.positions;
  Scene scene;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) world.step(frame_time);
  return mean_sinking(start, world.object(0).positions()) / (0.2 * standard_gravity / (2 * stiffness));
}

void irregular_rows(Result& result) {
  for (const double stiffness : {50., 200.}) {
    std::vector<double> sags;
    for (const int side : {17, 25, 41}) sags.push_back(irregular_sag_over_known(side, stiffness));
    result.rows.push_back(relative("stiffness: engine, sinking, irregular, " + brief(stiffness) + " N/m, worst", 1,
                                   farthest(1, sags), 0.05, "",
                                   "17 to 41 rows, moved by 0.25 edges, default settings"));
  }
}

}  // namespace

void stiffness_rows(Result& result, bool) {
  Run converged;
  converged.substeps = converged.iterations = 50;
  const double expected = sinking(converged);
  iteration_rows(result, expected);
  time_step_rows(result, expected);
  mesh_rows(result);
  irregular_rows(result);
}

}  // namespace pliant::validate
