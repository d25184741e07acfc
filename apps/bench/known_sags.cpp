#include "apps/bench/known_sags.h"

#include <cmath>
#include <utility>

#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr double gravity = 9.81;  ///< [m/s^2]
constexpr int sag_frames = 150;

/// An object, which of its particles are held, and which are its free end.
struct HeldObject {
  Object object;
  std::vector<int> held, ends;
};

/// Particles up to `low` along an axis are held, those from `high` on are the free end.
HeldObject held_between(Object object, float Vec3f::*axis, float low, float high) {
  constexpr float tolerance = 1e-4f;
  HeldObject out{std::move(object), {}, {}};
  for (std::size_t i = 0; i < out.object.positions.size(); ++i) {
    const float at = out.object.positions[i].*axis;
    if (at < low + tolerance) out.held.push_back(static_cast<int>(i));
    if (at > high - tolerance) out.ends.push_back(static_cast<int>(i));
  }
  return out;
}

/// How far particles of a world's object are below where they started, in the mean [m].
double sag_of(const World& world, const std::vector<int>& particles, const std::vector<Vec3f>& start) {
  const std::vector<Vec3f> now = world.object(0).positions();
  double sum = 0;
  for (const int p : particles) {
    const auto i = static_cast<std::size_t>(p);
    sum += static_cast<double>(start[i].y) - static_cast<double>(now[i].y);
  }
  return sum / static_cast<double>(particles.size());
}

NamedScene scene_of(const char* name, HeldObject held, double known) {
  NamedScene out{name, {}, {}};
  const std::vector<Vec3f> start = held.object.positions;
  out.scene.frames = sag_frames;
  out.scene.gravity = {0, static_cast<float>(-gravity), 0};
  held.object.damping = 8;
  out.scene.add(std::move(held.object));
  out.scene.pin(0, held.held);
  out.yield = [ends = std::move(held.ends), start, known](const World& world) {
    return sag_of(world, ends, start) / known;
  };
  return out;
}

/// Sags by a twentieth of its free length, q L^4 / (8 B).
NamedScene cantilever() {
  constexpr int edges = 24, columns = 9;
  constexpr double share = 0.05;
  const Fabric& m = fabric("cotton");
  const double length = std::cbrt(8 * share * double(m.bending_stiffness) / (double(m.area_density) * gravity));
  const double edge = length / edges;
  ClothOptions options;
  options.material = m;
  Object sheet = make_cloth(
      grid_mesh(columns, edges + 2, static_cast<float>((columns - 1) * edge), static_cast<float>(length + edge)),
      options);
  const float half = static_cast<float>((length + edge) / 2);
  return scene_of("cantilever of cotton",
                  held_between(std::move(sheet), &Vec3f::z, static_cast<float>(edge) - half, half), share * length);
}

/// A sheet of 0.25 m by 1 m with the warp downwards hangs by its upper edge, and stretches by rho g L^2 / (2 Y), or by
/// its left one, and shears by rho g W^2 / (2 G).
NamedScene woven_sheet(bool is_sheared) {
  constexpr int rows = 81;
  constexpr double width = 0.25, height = 1;
  Fabric m = fabric("cotton");
  if (!is_sheared) m.stretch_stiffness = 200;  // [N/m]; cotton stretches by less than a ten-thousandth
  ClothOptions options;
  options.material = m;
  options.stretch_model = ClothOptions::Stretching::woven;
  options.bending_model = ClothOptions::Bending::none;
  options.warp = {0, 1, 0};
  TriangleMesh mesh = grid_mesh((rows - 1) / 4 + 1, rows, static_cast<float>(width), static_cast<float>(height));
  for (Vec3f& p : mesh.positions) p = {p.x, p.z, 0};
  const double weight = double(m.area_density) * gravity;
  if (is_sheared) {
    const double in_plane = 3 * weight * std::pow(width, 4) / (2 * double(m.weft_stiffness) * height * height);
    return scene_of("woven cotton, sheared", held_between(make_cloth(mesh, options), &Vec3f::x, -0.125f, 0.125f),
                    weight * width * width / (2 * double(m.shear_stiffness)) + in_plane);
  }
  for (Vec3f& p : mesh.positions) p.y = -p.y;
  Object sheet = make_cloth(mesh, options);
  HeldObject held{std::move(sheet), {}, {}};
  const int columns = (rows - 1) / 4 + 1, last = columns * (rows - 1);
  for (int i = 0; i < columns; ++i) {
    held.held.push_back(i);
    held.ends.push_back(last + i);
  }
  return scene_of("woven cloth, 200 N/m, hung", std::move(held),
                  weight * height * height / (2 * double(m.stretch_stiffness)));
}

/// A bar of 0.4 m that is held at one end; the right sag is that of eight times the substeps, which is that of linear
/// elements to 1 %.
NamedScene soft_bar() {
  SoftBodyOptions options;
  options.material.density = 1000;
  options.material.youngs_modulus = 1e6f;
  options.material.poisson_ratio = 0.45f;
  const auto bar = [&](double known) {
    return scene_of(
        "soft bar",
        held_between(make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {8, 2, 2}), options), &Vec3f::x, -0.2f, 0.2f),
        known);
  };
  NamedScene finer = bar(1);
  finer.scene.settings.substeps = 8 * chosen_substeps(finer.scene)[0];
  finer.scene.settings.threads = 1;
  World world(finer.scene);
  for (int frame = 0; frame < sag_frames; ++frame) world.step(finer.scene.frame_time);
  return bar(finer.yield(world));
}

}  // namespace

std::vector<NamedScene> known_sags() {
  std::vector<NamedScene> all;
  all.reserve(4);
  all.push_back(cantilever());
  all.push_back(woven_sheet(false));
  all.push_back(woven_sheet(true));
  all.push_back(soft_bar());
  return all;
}

}  // namespace pliant::bench
