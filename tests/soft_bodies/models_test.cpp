// The models of elastic solids against their energies: at small and large strain, turned, and as bodies that carry a
// weight.
#include <algorithm>
#include <cmath>
#include <random>

#include "constraints/corotational_strain.h"
#include "constraints/green_strain.h"
#include "constraints/tetrahedron_volume.h"
#include "math/quat.h"
#include "pliant/error.h"
#include "pliant/measurements.h"
#include "pliant/scene.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr double lambda = 3, mu = 2;

template <class T>
double value_of(const std::array<Vec3d, 4>& places) {
  Vec3d rest[4], now[4], gradient[4];
  std::copy(tetrahedron_at_rest.begin(), tetrahedron_at_rest.end(), rest);
  std::copy(places.begin(), places.end(), now);
  return T::evaluate(now, T::template measure<double>(rest), gradient);
}

/// Energies per volume of a tetrahedron whose corners are moved.
template <class Move>
double corotational(const Move& move) {
  std::array<Vec3d, 4> now{};
  std::transform(tetrahedron_at_rest.begin(), tetrahedron_at_rest.end(), now.begin(), move);
  return 0.5 * mu * std::pow(value_of<CorotationalStrain>(now), 2) +
         0.5 * lambda * std::pow(value_of<TetrahedronVolume>(now), 2);
}
template <class Move>
double st_venant_kirchhoff(const Move& move) {
  std::array<Vec3d, 4> now{};
  std::transform(tetrahedron_at_rest.begin(), tetrahedron_at_rest.end(), now.begin(), move);
  return 0.5 * mu * std::pow(value_of<GreenStrain>(now), 2) + 0.5 * lambda * std::pow(value_of<GreenTrace>(now), 2);
}

const Quatd turn = normalise(Quatd{0.3, -0.5, 0.7, -0.2});

TEST(SolidModels, FollowHookesLawAtSmallStrain) {
  const double e = 1e-5;
  const auto pulled = [&](const Vec3d& x) { return rotate(turn, x + Vec3d{e * x.x, 0, 0}); };
  const auto sheared = [&](const Vec3d& x) { return rotate(turn, x + Vec3d{e * x.y, 0, 0}); };
  const auto swollen = [&](const Vec3d& x) { return rotate(turn, (1 + e) * x); };
  const double of_pull = 0.5 * (lambda + 2 * mu) * e * e, of_shear = 0.5 * mu * e * e,
               of_swelling = 0.5 * (9 * lambda + 6 * mu) * e * e;
  EXPECT_NEAR(corotational(pulled) / of_pull, 1, 1e-4);
  EXPECT_NEAR(corotational(sheared) / of_shear, 1, 1e-4);
  EXPECT_NEAR(corotational(swollen) / of_swelling, 1, 1e-4);
  EXPECT_NEAR(st_venant_kirchhoff(pulled) / of_pull, 1, 1e-4);
  EXPECT_NEAR(st_venant_kirchhoff(sheared) / of_shear, 1, 1e-4);
  EXPECT_NEAR(st_venant_kirchhoff(swollen) / of_swelling, 1, 1e-4);
}

// The nearest rotation of diag(s, 1, 1) is none, of a shape turned inside out along x that by half a turn about what is
// left.
TEST(SolidModels, HaveTheirEnergiesAtLargeStrain) {
  for (const double s : {0.2, 0.5, 0.9, 1.1, 1.5, 4.0}) {
    const auto pulled = [&](const Vec3d& x) { return rotate(turn, Vec3d{s * x.x, x.y, x.z}); };
    const double green = (s * s - 1) / 2;
    EXPECT_NEAR(corotational(pulled), (mu + lambda / 2) * (s - 1) * (s - 1), 1e-9 * (1 + s * s)) << s;
    EXPECT_NEAR(st_venant_kirchhoff(pulled), (mu + lambda / 2) * green * green, 1e-9 * (1 + s * s * s * s)) << s;
  }
  const auto inverted = [&](const Vec3d& x) { return rotate(turn, Vec3d{3 * x.x, 2 * x.y, -0.5 * x.z}); };
  EXPECT_NEAR(corotational(inverted), mu * (4 + 1 + 2.25) + lambda / 2 * 16, 1e-9);
}

/// The stretch of a bar of 0.1 x 0.2 x 0.1 m and 2 kg, Young's modulus 1e5 Pa and a Poisson ratio of 0, by a mean force
/// along it: a weight at its end and half of its own.
double stretch_of(SolidModel model, double force) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0);
  options.material.model = model;
  Object bar = make_soft_body(box_tetrahedra({0.1f, 0.2f, 0.1f}, {2, 4, 2}), options);
  std::vector<int> low;
  for (int i = 0; i < static_cast<int>(bar.positions.size()); ++i) {
    const float y = bar.positions[static_cast<std::size_t>(i)].y;
    if (y > 0.099f) bar.pins.push_back({i, {}});
    if (y < -0.099f) low.push_back(i);
  }
  // A row of nine: corners carry a quarter, edges a half.
  for (const int i : low) {
    const Vec3f& p = bar.positions[static_cast<std::size_t>(i)];
    const double share = (std::fabs(p.x) > 0.04f ? 0.5 : 1) * (std::fabs(p.z) > 0.04f ? 0.5 : 1) / 4;
    bar.masses[static_cast<std::size_t>(i)] += static_cast<float>(share * (force / 10 - 1));
  }
  bar.damping = 8;
  Scene scene = scene_of(std::move(bar), 200);
  scene.gravity = {0, -10, 0};
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) {
    const Report report = world.step(1 / 60.f);
    EXPECT_TRUE(report.ok()) << report.explain();
  }
  double mean = 0;
  for (const int i : low)
    mean += static_cast<double>(positions_of(world)[static_cast<std::size_t>(i)].y) / static_cast<double>(low.size());
  return (0.1 - mean) / 0.2;
}

// Without narrowing, the force over the section at rest is E (s - 1) in a co-rotational bar and E s (s^2 - 1) / 2 in
// one of St. Venant and Kirchhoff.
TEST(SolidModels, CarryWeightsAsTheirEnergiesSay) {
  const double section = 0.01, modulus = 1e5;
  for (const double s : {1.1, 1.5}) {
    EXPECT_NEAR(stretch_of(SolidModel::corotational, section * modulus * (s - 1)), s, 0.01 * (s - 1) + 0.002);
    EXPECT_NEAR(stretch_of(SolidModel::st_venant_kirchhoff, section * modulus * s * (s * s - 1) / 2), s,
                0.01 * (s - 1) + 0.002);
  }
}

/// Of a co-rotational block that starts with its particles at random places, after five seconds.
TetrahedraMeasure after_a_random_start(float poisson_ratio) {
  SoftBodyOptions options;
  options.material = solid_of(2e4f, poisson_ratio);
  options.material.model = SolidModel::corotational;
  Object body = make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options);
  keep_rest_shape(body);
  std::mt19937 random(7);
  const auto some = [&] { return 0.2f * (static_cast<float>(random()) / 2147483648.f - 1); };
  for (Vec3f& p : body.positions) p = {2 * some(), some(), some()};
  body.damping = 2;
  Scene scene = scene_of(std::move(body), 0);
  scene.gravity = {};
  World world(scene);
  for (int frame = 0; frame < 300; ++frame) EXPECT_TRUE(world.step(1 / 60.f).ok());
  return world.measure().tetrahedra();
}

TEST(SolidModels, CorotationalTetrahedraTurnBackFromRandomPlaces) {
  for (const float ratio : {0.3f, 0.45f}) {
    const TetrahedraMeasure found = after_a_random_start(ratio);
    EXPECT_EQ(found.tetrahedra, 96);
    EXPECT_EQ(found.inverted, 0) << ratio;
    EXPECT_GT(found.least_ratio, 0.9) << ratio;
  }
}

TEST(SolidModels, KeepAFreeBlockAtRest) {
  for (const SolidModel model : {SolidModel::corotational, SolidModel::st_venant_kirchhoff}) {
    SoftBodyOptions options;
    options.material = solid_of(1e7f, 0.3f);
    options.material.model = model;
    Scene scene = scene_of(make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options), 0);
    scene.gravity = {};
    World world(scene);
    const std::vector<Vec3f> before = positions_of(world);
    for (int frame = 0; frame < 60; ++frame) EXPECT_TRUE(world.step(1 / 60.f).ok());
    double most = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      most = std::max(most, static_cast<double>(length_squared(positions_of(world)[i] - before[i])));
    EXPECT_LT(std::sqrt(most), 1e-6);
  }
}

TEST(SolidModels, MakeTheConstraintsOfTheirTypes) {
  SoftBodyOptions options;
  options.material.plasticity = Plasticity{0.1f};
  const auto types = [&](SolidModel model) {
    options.material.model = model;
    const Object body = make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}), options);
    EXPECT_EQ(tetrahedra_of(body).size(), 6U);
    return std::pair{body.constraints.at(0), body.constraints.at(1)};
  };
  const auto [strain, volume] = types(SolidModel::corotational);
  EXPECT_EQ(strain.type, "corotational_strain");
  EXPECT_EQ(volume.type, "tetrahedron_volume");
  EXPECT_FALSE(volume.plasticity.has_value());
  const auto [green, trace] = types(SolidModel::st_venant_kirchhoff);
  EXPECT_EQ(green.type, "green_strain");
  EXPECT_EQ(trace.type, "green_trace");
  EXPECT_TRUE(green.plasticity.has_value() && trace.plasticity.has_value()) << "both have the rest shape";
}

}  // namespace
}  // namespace pliant
