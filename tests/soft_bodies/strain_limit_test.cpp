// Limits on how far edges stretch: free until there, hardly beyond.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "support/refusal.h"

namespace pliant {
namespace {

using testing_support::refusal;

/// The least and the greatest length over that at rest, of the edges that distance_limit constrains.
struct StretchRange {
  double least = 1e9, most = 0;
};

StretchRange stretch_of(const Object& object, const std::vector<std::array<int, 2>>& edges,
                        const std::vector<Vec3f>& at) {
  const auto length_in = [](const std::vector<Vec3f>& x, const std::array<int, 2>& edge) {
    const Vec3f d = x[static_cast<std::size_t>(edge[1])] - x[static_cast<std::size_t>(edge[0])];
    return std::sqrt(static_cast<double>(dot(d, d)));
  };
  StretchRange out;
  for (const auto& edge : edges) {
    const double ratio = length_in(at, edge) / length_in(object.positions, edge);
    out = {std::min(out.least, ratio), std::max(out.most, ratio)};
  }
  return out;
}

std::vector<std::array<int, 2>> edges_of(const Object& object) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& t : tetrahedra_of(object))
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k) edges.push_back({t[k], t[i]});
  for (const auto& t : object.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  return edges;
}

/// A soft bar that hangs by its upper end, or stands if `stands`, after ten seconds.
struct Hung {
  Object object;
  std::vector<Vec3f> at;
};

Hung bar(std::optional<StrainLimit> limit, bool stands, float modulus = 5000) {
  SoftBodyOptions options;
  options.material = {.name = "", .density = 1000, .youngs_modulus = modulus, .poisson_ratio = 0.3f, .source = ""};
  options.strain_limit = limit;
  Scene scene;
  scene.add(make_soft_body(box_tetrahedra({0.1f, 0.5f, 0.1f}, {2, 10, 2}), options));
  Object& object = scene.objects[0];
  object.damping = 3;
  for (std::size_t i = 0; i < object.positions.size(); ++i)
    if (stands ? object.positions[i].y < -0.249f : object.positions[i].y > 0.249f)
      object.pins.push_back({static_cast<int>(i)});
  scene.settings.threads = 1;
  scene.settings.substeps = 40;  // limits are rigid: how exactly they hold goes with the square of the substeps
  const Object kept = object;
  World world(scene);
  for (int frame = 0; frame < 600; ++frame) world.step(1.f / 60);
  return {kept, world.object(0).positions()};
}

TEST(StrainLimit, HoldsASoftBodyThatHangs) {
  const Hung free = bar({}, false), limited = bar(StrainLimit{.most = 1.1f}, false);
  EXPECT_GT(stretch_of(free.object, edges_of(free.object), free.at).most, 1.5);
  EXPECT_LT(stretch_of(limited.object, edges_of(limited.object), limited.at).most, 1.1 * 1.01);
}

TEST(StrainLimit, HoldsASoftBodyThatStands) {
  const Hung limited = bar(StrainLimit{.least = 0.95f, .most = 1.05f}, true);
  EXPECT_GT(stretch_of(limited.object, edges_of(limited.object), limited.at).least, 0.95 * 0.99);
}

/// What does not reach it rests where it would without.
TEST(StrainLimit, DoesNothingBelow) {
  const Hung free = bar({}, false, 5e4f), limited = bar(StrainLimit{.least = 0.5f, .most = 1.5f}, false, 5e4f);
  for (std::size_t i = 0; i < free.at.size(); ++i) EXPECT_NEAR(free.at[i].y, limited.at[i].y, 1e-4f);
}

/// A strip of soft cloth that would become half as long again hangs longer by its limit.
TEST(StrainLimit, HoldsCloth) {
  ClothOptions options;
  options.material.area_density = 1;
  options.material.stretch_stiffness = 5;
  options.bending_model = ClothOptions::Bending::none;
  options.strain_limit = StrainLimit{.most = 1.2f};
  Scene scene;
  const int cloth = scene.add_cloth(grid_mesh(3, 21, 0.05f, 0.5f), options);
  scene.pin(cloth, {0, 1, 2});
  scene.gravity = {0, 0, 9.81f};
  scene.objects[0].damping = 3;
  scene.settings.threads = 1;
  scene.settings.substeps = 40;
  const Object object = scene.objects[0];
  World world(scene);
  for (int frame = 0; frame < 600; ++frame) world.step(1.f / 60);
  const StretchRange stretch = stretch_of(object, edges_of(object), world.object(cloth).positions());
  EXPECT_GT(stretch.most, 1.19);
  EXPECT_LT(stretch.most, 1.2 * 1.01);
}

TEST(StrainLimit, NamesWhatIsOutOfRange) {
  ClothOptions options;
  options.name = "sheet";
  for (const StrainLimit& limit : {StrainLimit{.most = 0.9f}, StrainLimit{.least = 1.1f}, StrainLimit{.least = -1}}) {
    options.strain_limit = limit;
    const std::string words = refusal([&] { make_cloth(grid_mesh(3, 3, 1, 1), options); });
    EXPECT_NE(words.find("strain_limit"), std::string::npos) << words;
    EXPECT_NE(words.find("sheet"), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace pliant
