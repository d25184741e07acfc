// Tests that a stiff sheet that lies on two supports sags as the beam's formula says, whatever it lies on, with the
// default substeps: the bending finds the forces of the contacts (solver/sheets/sheet_contacts.h).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "core/at.h"
#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// A plate of acrylic of 3 mm that lies across two rails, 0.4 m apart.
struct PlateCase {
  std::string support = "box";  ///< box, capsule, mesh, grid, body or heavy
  int cells = 20;               ///< along its length of 0.5 m
  double moved = 0;             ///< vertices inside of it at random, in cells
  double frame_time = 1.0 / 60;
  int substeps = 0;
};

constexpr float plate_length = 0.5f, plate_width = 0.1f, between_rails = 0.4f, rail_radius = 0.01f;
constexpr float flexural_rigidity = 6.75f, plate_density = 3.6f, plate_thickness = 0.003f;

/// A prism along z with an edge on top.
TriangleMesh edge_of_rail(float x) {
  const float low = -2 * rail_radius, z = plate_width;
  return {{{x, 0, -z}, {x, 0, z}, {x - 0.01f, low, -z}, {x - 0.01f, low, z}, {x + 0.01f, low, -z}, {x + 0.01f, low, z}},
          {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}}};
}

void add_rail(const std::string& kind, float x, Scene& scene) {
  const std::string name = x < 0 ? "left" : "right";
  if (kind == "mesh" || kind == "grid") {
    MeshCollider rail;
    rail.name = name;
    rail.mesh = edge_of_rail(x);
    if (kind == "grid") rail.as = MeshCollider::As::distance_grid;
    scene.add(rail);
  } else if (kind == "body" || kind == "heavy") {
    BodyOptions options;
    options.name = name;
    options.position = {x, -rail_radius, 0};
    options.mass = kind == "body" ? std::numeric_limits<float>::infinity() : 5;
    scene.add(make_body({{Box{{0.001f, rail_radius, plate_width}}}}, options));
  } else {
    Collider rail;
    rail.name = name;
    rail.position = {x, -rail_radius, 0};
    rail.shape = Box{{0.001f, rail_radius, plate_width}};
    if (kind == "capsule") {
      rail.shape = Capsule{rail_radius, plate_width};
      rail.rotation = {std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)};
    }
    scene.add(rail);
  }
}

Object plate_of_case(const PlateCase& of) {
  TriangleMesh mesh = grid_mesh(of.cells + 1, of.cells / 5 + 1, plate_length, plate_width);
  Vec3f centre{};
  for (const Vec3f& p : mesh.positions) centre += p * (1 / static_cast<float>(mesh.positions.size()));
  std::mt19937 random(1);
  const auto uniform = [&] {
    return static_cast<float>(of.moved * double(plate_length) / of.cells *
                              (static_cast<double>(random() % 65536) / 32768 - 1));
  };
  for (Vec3f& p : mesh.positions) {
    p = p - centre;
    const bool is_inner = std::fabs(p.x) < plate_length / 2.01f && std::fabs(p.z) < plate_width / 2.01f;
    if (is_inner) p += Vec3f{uniform(), 0, uniform()};
    p.y = plate_thickness + 0.0005f;
  }
  ClothOptions options;
  options.name = "plate";
  options.material.area_density = plate_density;
  options.material.bending_stiffness = flexural_rigidity;
  options.material.stretch_stiffness = 9e5f;
  options.material.thickness = plate_thickness;
  Object plate = make_cloth(mesh, options);
  plate.damping = 5;
  plate.collides = true;
  return plate;
}

/// The mean height of what lies within `near` of |x| = `at_x` [m].
double height_at(const std::vector<Vec3f>& places, double at_x, double near) {
  double sum = 0, count = 0;
  for (const Vec3f& p : places)
    if (std::fabs(std::fabs(double(p.x)) - at_x) < near) {
      sum += double(p.y);
      ++count;
    }
  return sum / count;
}

struct SaggedPlate {
  double ratio = 0;   ///< of the sag between the rails over the beam's
  double motion = 0;  ///< farthest of a vertex in a frame at the end [m]
};

SaggedPlate sag_of(const PlateCase& of) {
  Scene scene;
  scene.frame_time = static_cast<float>(of.frame_time);
  scene.settings.substeps = of.substeps;
  for (const float x : {-between_rails / 2, between_rails / 2}) add_rail(of.support, x, scene);
  if (of.support == "heavy") {
    Collider ground;
    ground.position = {0, -2 * rail_radius, 0};
    scene.add(ground);
  }
  scene.add(plate_of_case(of));
  World world(scene);
  const auto places = [&] { return world.object(*world.find("plate")).positions(); };
  for (int frame = 0; frame < 1.5 / of.frame_time; ++frame) world.step(scene.frame_time);
  const std::vector<Vec3f> before = places();
  world.step(scene.frame_time);
  const std::vector<Vec3f> now = places();
  SaggedPlate out;
  for (std::size_t i = 0; i < now.size(); ++i) out.motion = std::max(out.motion, double(length(now[i] - before[i])));
  const double near = of.moved > 0 ? 0.02 : 0.6 * double(plate_length) / of.cells, span = double(between_rails),
               over = (double(plate_length) - span) / 2;
  const double beam = double(plate_density) * 9.81 * span * span * (5 * span * span - 24 * over * over) /
                      (384 * double(flexural_rigidity));
  out.ratio = (height_at(now, span / 2, near) - height_at(now, 0, near)) / beam;
  return out;
}

TEST(PlateOnSupports, SagsAsTheBeamWhateverItLiesOn) {
  for (const char* support : {"box", "capsule", "mesh", "grid", "body", "heavy"}) {
    const SaggedPlate plate = sag_of({support});
    EXPECT_NEAR(plate.ratio, 1, 0.03) << support;
    EXPECT_LT(plate.motion, 1e-4) << support;
  }
}

/// Up to l / e = 1.8, that of 1/60 s and 12 substeps; beyond it 8 % are left.
TEST(PlateOnSupports, SagsAlikeWhateverTheFrameTimeAndTheSubsteps) {
  for (const char* support : {"box", "mesh", "body"}) {
    for (const double frame_time : {1.0 / 30, 1.0 / 120}) {
      const SaggedPlate plate = sag_of({support, 20, 0, frame_time});
      EXPECT_NEAR(plate.ratio, 1, frame_time < 1.0 / 60 ? 0.03 : 0.08) << support << ", frames of " << frame_time;
    }
    for (const int substeps : {12, 30, 60})
      EXPECT_NEAR(sag_of({support, 20, 0, 1.0 / 60, substeps}).ratio, 1, 0.03) << support << ", " << substeps;
  }
}

TEST(PlateOnSupports, SagsAlikeOnFinerAndIrregularMeshes) {
  for (const char* support : {"box", "mesh"}) {
    EXPECT_NEAR(sag_of({support, 40}).ratio, 1, 0.08) << support << ", finer";
    EXPECT_NEAR(sag_of({support, 40, 0, 1.0 / 60, 48}).ratio, 1, 0.03) << support << ", finer, 48 substeps";
    const PlateCase irregular{support, 40, 0.25};
    EXPECT_NEAR(sag_of(irregular).ratio, 1, 0.08) << support << ", vertices moved";
  }
}

}  // namespace
}  // namespace pliant
