// Soft bodies against known answers of elasticity.
#include <algorithm>
#include <random>
#include <string>

#include "constraints/tetrahedron_shear.h"
#include "constraints/tetrahedron_volume.h"
#include "math/quat.h"
#include "pliant/scene.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ energy

/// The elastic energy per volume of both constraints in a tetrahedron that is deformed by x + strain(x).
template <class Strain>
double energy_density(double lambda, double mu, const Strain& strain) {
  Vec3d rest[4], now[4], gradient[4];
  for (std::size_t i = 0; i < 4; ++i) {
    rest[i] = tetrahedron_at_rest[i];
    now[i] = rest[i] + strain(rest[i]);
  }
  const double shear = TetrahedronShear::evaluate<double>(now, TetrahedronShear::measure<double>(rest), gradient);
  const double volume = TetrahedronVolume::evaluate<double>(now, TetrahedronVolume::measure<double>(rest), gradient);
  return 0.5 * mu * shear * shear + 0.5 * lambda * volume * volume;
}

TEST(Elasticity, EnergyOfASmallStrainIsThatOfHooke) {
  const double lambda = 3, mu = 2, e = 1e-5;
  const auto pulled = [&](const Vec3d& x) { return Vec3d{e * x.x, 0, 0}; };
  EXPECT_NEAR(energy_density(lambda, mu, pulled) / (0.5 * (lambda + 2 * mu) * e * e), 1, 1e-4);
  const auto sheared = [&](const Vec3d& x) { return Vec3d{e * x.y, 0, 0}; };
  EXPECT_NEAR(energy_density(lambda, mu, sheared) / (0.5 * mu * e * e), 1, 1e-4);
  const auto swollen = [&](const Vec3d& x) { return e * x; };
  EXPECT_NEAR(energy_density(lambda, mu, swollen) / (0.5 * (9 * lambda + 6 * mu) * e * e), 1, 1e-4);
}

TEST(Elasticity, EnergyOfALargeStrainIsThatOfTheStableNeoHookeanSolid) {
  const double lambda = 3, mu = 2;
  for (const double s : {0.1, 0.5, 0.8, 1.3, 2.0, 4.0}) {
    const auto stretched = [&](const Vec3d& x) { return Vec3d{(s - 1) * x.x, 0, 0}; };
    const double expected =
        0.5 * mu * (s * s + 2 - 3 - 2 * (s - 1)) + 0.5 * (lambda + mu) * (s - 1) * (s - 1);  // |F|^2 = s^2 + 2, J = s
    EXPECT_NEAR(energy_density(lambda, mu, stretched), expected, 1e-12 * (1 + expected)) << s;
  }
}

TEST(Elasticity, NearRestAFloatSeesStrainsOfAMillionth) {
  Vec3f rest[4], now[4], gradient[4];
  for (std::size_t i = 0; i < 4; ++i) rest[i] = convert<float>(tetrahedron_at_rest[i]);
  const auto params = TetrahedronShear::measure<float>(rest);
  for (const float e : {1e-4f, 1e-5f, 3e-6f}) {
    for (std::size_t i = 0; i < 4; ++i) now[i] = rest[i] + Vec3f{e * rest[i].y, 0, 0};
    EXPECT_NEAR(TetrahedronShear::evaluate<float>(now, params, gradient) / e, 1, 2e-7f / e) << e;
  }
}

// ------------------------------------------------------------------------------------------------ bars

/// A bar along x whose end at the smallest x is pinned; it hangs by its weight. The sag of its other end over that of a
/// beam with bending and shear (Timoshenko), after a time in which damping takes its motion.
double sag_over_beam(int cells, float youngs_modulus, float poisson_ratio, int substeps) {
  const float length = 0.4f, side = 0.1f;
  const double gravity = 0.5, density = 1000, e = youngs_modulus, nu = poisson_ratio;
  SoftBodyOptions options;
  options.material = solid_of(youngs_modulus, poisson_ratio);
  Object bar = make_soft_body(box_tetrahedra({length, side, side}, {4 * cells, cells, cells}), options);
  bar.damping = 4;
  std::vector<int> held, tip;
  for (int i = 0; i < static_cast<int>(bar.positions.size()); ++i) {
    const float x = bar.positions[static_cast<std::size_t>(i)].x;
    if (x < -0.499f * length) held.push_back(i);
    if (x > 0.499f * length) tip.push_back(i);
  }
  Scene scene = scene_of(std::move(bar), substeps);
  scene.gravity = {0, static_cast<float>(-gravity), 0};
  scene.pin(0, held);
  World world(scene);
  run(world, 240);
  const std::vector<Vec3f> positions = positions_of(world);
  double sag = 0;
  for (const int i : tip)
    sag -= static_cast<double>(positions[static_cast<std::size_t>(i)].y -
                               scene.objects[0].positions[static_cast<std::size_t>(i)].y) /
           static_cast<double>(tip.size());
  const double l = length, s = side, load = density * gravity * s * s;
  const double bending = load * l * l * l * l / (8 * e * s * s * s * s / 12);
  const double shear = load * l * l / (2 * (10 * (1 + nu) / (12 + 11 * nu)) * e / (2 * (1 + nu)) * s * s);
  return sag / (bending + shear);
}

// Linear tetrahedra are too stiff in bending, the less the finer they are (docs/guide/soft_bodies.md): so a share of
// the beam's sag.
TEST(Elasticity, ABarSagsAsABeamTheMoreTheFinerItIs) {
  EXPECT_NEAR(sag_over_beam(2, 1e5f, 0.3f, 40), 0.52, 0.02);
  EXPECT_NEAR(sag_over_beam(4, 1e5f, 0.3f, 40), 0.78, 0.02);
}

// With a constraint for the volume of each tetrahedron 0.60, 0.35 and 0.28.
TEST(Elasticity, ABarBendsThatHardlyChangesItsVolume) {
  EXPECT_NEAR(sag_over_beam(4, 1e5f, 0.45f, 40), 0.81, 0.02);
  EXPECT_NEAR(sag_over_beam(4, 1e5f, 0.49f, 40), 0.80, 0.02);
  EXPECT_NEAR(sag_over_beam(4, 1e5f, 0.495f, 40), 0.79, 0.02);
}

TEST(Elasticity, SubstepsHardlyChangeHowFarABarSags) {
  const double few = sag_over_beam(3, 1e5f, 0.3f, 40), many = sag_over_beam(3, 1e5f, 0.3f, 160);
  EXPECT_NEAR(few / many, 1, 0.02);
}

TEST(Elasticity, SubstepsByDefaultKeepTheModulus) {
  for (const float modulus : {2e4f, 2e5f, 2e6f}) {
    const double chosen = sag_over_beam(3, modulus, 0.3f, 0);
    EXPECT_NEAR(chosen, 0.681, 0.02) << modulus;  // with ten times as many substeps
  }
}

TEST(Elasticity, APulledBarBecomesNarrowerByPoissonsRatio) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0.3f);
  Object bar = make_soft_body(box_tetrahedra({0.3f, 0.06f, 0.06f}, {15, 3, 3}), options);
  bar.damping = 4;
  Motion right;
  right.keyframes = {{0, {}, {}}, {0.5f, {0.03f, 0, 0}, {}}};
  std::vector<int> held, pulled;
  for (int i = 0; i < static_cast<int>(bar.positions.size()); ++i) {
    const float x = bar.positions[static_cast<std::size_t>(i)].x;
    if (x < -0.149f) held.push_back(i);
    if (x > 0.149f) pulled.push_back(i);
  }
  Scene scene = scene_of(std::move(bar), 60);
  scene.gravity = {};
  scene.pin(0, held);
  scene.pin(0, pulled, right);
  World world(scene);
  run(world, 240);
  const std::vector<Vec3f> positions = positions_of(world);
  double low = 1, high = -1, left = 1, ahead = -1;  // of the middle, where the clamps are far
  for (std::size_t i = 0; i < scene.objects[0].positions.size(); ++i) {
    const Vec3f& rest = scene.objects[0].positions[i];
    if (std::fabs(rest.x) < 0.011f) {
      low = std::min(low, static_cast<double>(positions[i].y));
      high = std::max(high, static_cast<double>(positions[i].y));
    }
    if (std::fabs(std::fabs(rest.x) - 0.05f) < 0.001f) {
      left = std::min(left, static_cast<double>(positions[i].x));
      ahead = std::max(ahead, static_cast<double>(positions[i].x));
    }
  }
  const double strain = (ahead - left) / 0.1 - 1, narrowing = 1 - (high - low) / 0.06;
  EXPECT_NEAR(strain, 0.1, 0.01);
  EXPECT_NEAR(narrowing / strain, 0.3, 0.03);
}

/// The patch test: where the border follows an affine map, the inside does too.
TEST(Elasticity, AnAffineBorderGivesAnAffineInside) {
  TetrahedralMesh mesh = box_tetrahedra({0.4f, 0.4f, 0.4f}, {4, 4, 4});
  std::mt19937 random(5);
  std::vector<bool> is_border(mesh.positions.size(), false);
  for (const auto& triangle : border_triangles(mesh))
    for (const int corner : triangle) is_border[static_cast<std::size_t>(corner)] = true;
  const auto noise = [&] { return 0.04f * (static_cast<float>(random()) / 4294967296.f - 0.5f); };
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!is_border[i]) mesh.positions[i] += Vec3f{noise(), noise(), noise()};
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0.3f);
  Object body = make_soft_body(mesh, options);
  const std::vector<Vec3f> rest = body.positions;
  const auto mapped = [](const Vec3f& p) { return Vec3f{1.1f * p.x + 0.1f * p.y, 0.95f * p.y, p.z - 0.05f * p.x}; };
  keep_rest_shape(body);
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (is_border[i]) body.positions[i] = mapped(rest[i]);
  body.damping = 10;
  Scene scene = scene_of(std::move(body), 60);
  scene.gravity = {};
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (is_border[i]) scene.pin(0, {static_cast<int>(i)});
  World world(scene);
  run(world, 240);
  const std::vector<Vec3f> positions = positions_of(world);
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_LT(length(positions[i] - mapped(rest[i])), 2e-4f) << i;
}

// ------------------------------------------------------------------------------------------------ motion

TEST(SoftBodyMotion, KeepsMomentum) {
  SoftBodyOptions options;
  options.material = solid_of(5e4f, 0.4f);
  Object body = make_soft_body(box_tetrahedra({0.3f, 0.2f, 0.1f}, {6, 4, 2}), options);
  const std::vector<float> masses = body.masses;
  for (const Vec3f& p : body.positions) body.velocities.push_back({1 + 3 * p.y, -3 * p.x, 0.5f});
  Scene scene = scene_of(std::move(body), 40);
  scene.gravity = {};
  World world(scene);
  const Momentum before = momentum_of(world, masses);
  run(world, 60);
  const Momentum after = momentum_of(world, masses);
  EXPECT_LT(length(after.linear - before.linear), 1e-4 * length(before.linear));
  // Implicit Euler takes h w^2 of angular momentum a second: 1 / 2400 * 3^2 = 0.4 %.
  EXPECT_NEAR(after.angular.z / before.angular.z, 1, 0.01);
}

TEST(SoftBodyMotion, FindsItsShapeAgainFromRandomPlaces) {
  SoftBodyOptions options;
  options.material = solid_of(5e4f, 0.4f);
  const TetrahedralMesh mesh = box_tetrahedra({0.4f, 0.2f, 0.2f}, {8, 4, 4});
  Object body = make_soft_body(mesh, options);
  const std::vector<Vec3f> rest = body.positions;
  keep_rest_shape(body);
  std::mt19937 random(11);
  const auto anywhere = [&] { return 0.4f * (static_cast<float>(random()) / 4294967296.f - 0.5f); };
  for (Vec3f& p : body.positions) p = {anywhere(), anywhere(), anywhere()};
  body.collides = false;
  body.damping = 2;
  Scene scene = scene_of(std::move(body), 20);
  scene.gravity = {};
  World world(scene);
  run(world, 300);
  const std::vector<Vec3f> positions = positions_of(world);
  int inverted = 0;
  double edge = 0, off = 0;
  const std::vector<double> volumes = six_volumes(positions, mesh.tetrahedra);
  for (const double volume : volumes) inverted += volume <= 0;
  for (const auto& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const auto a = static_cast<std::size_t>(t[i]), b = static_cast<std::size_t>(t[k]);
        const double was = static_cast<double>(length(rest[a] - rest[b]));
        const double is = static_cast<double>(length(positions[a] - positions[b]));
        edge += was * was;
        off += (is - was) * (is - was);
      }
  EXPECT_EQ(inverted, 0);
  EXPECT_LT(std::sqrt(off / edge), 0.01);
}

// ------------------------------------------------------------------------------------------------ substeps

int substeps_by_default(float youngs_modulus, float damping, int cells = 3) {
  SoftBodyOptions options;
  options.material = solid_of(youngs_modulus, 0.3f);
  options.material.damping = damping;
  return chosen_substeps(
      scene_of(make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {4 * cells, cells, cells}), options), 0))[0];
}

TEST(SoftBodySubsteps, GrowWithTheWaveSpeedOverTheEdge) {
  EXPECT_EQ(substeps_by_default(1e3f, 0), 20);
  const int some = substeps_by_default(1e6f, 0), stiffer = substeps_by_default(4e6f, 0),
            finer = substeps_by_default(1e6f, 0, 6);
  EXPECT_NEAR(stiffer, 2 * some, 2);
  EXPECT_NEAR(finer, 2 * some, 2);
}

// As max(1, damping / h). With 1 + damping / h a bar damped by as much as a substep had 1.6 times as many for nothing.
TEST(SoftBodySubsteps, GrowWithTheDampingThatExceedsASubstep) {
  const int some = substeps_by_default(1e6f, 0);
  const double h = 1 / 60. / some;
  EXPECT_EQ(substeps_by_default(1e6f, static_cast<float>(0.9 * h)), some);
  for (const int times : {2, 5})
    EXPECT_NEAR(substeps_by_default(1e6f, static_cast<float>(times * h)) / (times * some * 1.), 1, 0.05) << times;
}

TEST(SoftBodySubsteps, AreThoseOfFlatTetrahedra) {
  const auto of = [](const Vec3f& size) {
    SoftBodyOptions options;
    options.material = solid_of(1e6f, 0.3f);
    return chosen_substeps(scene_of(make_soft_body(box_tetrahedra(size, {8, 4, 4}), options), 0))[0];
  };
  const int cubes = of({0.2f, 0.1f, 0.1f}), flat = of({0.2f, 0.01f, 0.1f});
  EXPECT_NEAR(flat / static_cast<double>(cubes), std::sqrt((2. + 100) / 3),
              0.3);  // gradients of 1 / 25 mm, one of them of 1 / 2.5 mm
}

TEST(SoftBodySubsteps, GrowWhereTheVolumeHardlyChanges) {
  const auto of = [](float poisson_ratio) {
    SoftBodyOptions options;
    options.material = solid_of(4e6f * (1 + poisson_ratio), poisson_ratio);  // one shear modulus
    return static_cast<double>(
        chosen_substeps(scene_of(make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {12, 3, 3}), options), 0))[0]);
  };
  EXPECT_EQ(of(0.45f), of(0.3f));
  EXPECT_NEAR(of(0.49f) / of(0.45f), 1.33, 0.03);  // 1.4 - 0.4 * 9 / 49
}

TEST(SoftBodySubsteps, DoNotCountTheBodiesThatItIsTiedTo) {
  SoftBodyOptions options;
  options.material = solid_of(1e6f, 0.3f);
  Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {12, 3, 3}), options);
  const int alone = chosen_substeps(scene_of(bar, 0))[0];
  bar.positions.push_back({5, 0, 0});
  bar.masses.push_back(1e6f);
  EXPECT_EQ(chosen_substeps(scene_of(bar, 0))[0], alone);
}

TEST(SoftBodySubsteps, TooFewAreADoubt) {
  SoftBodyOptions options;
  options.material = solid_of(1e6f, 0.3f);
  const Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {12, 3, 3}), options);
  const auto doubts = [&](int substeps) {
    std::string all;
    for (const Finding& finding : inspect(scene_of(bar, substeps))) all += finding.message + "\n";
    return all;
  };
  EXPECT_NE(doubts(12).find("modulus"), std::string::npos) << doubts(12);  // 1.3 times as far
  EXPECT_EQ(doubts(25).find("modulus"), std::string::npos) << doubts(25);
  EXPECT_EQ(doubts(0).find("modulus"), std::string::npos) << doubts(0);
}

/// A bar with a thin layer: tetrahedra of a hundredth of the volume of their neighbours, as many meshers make.
TetrahedralMesh graded_bar() {
  constexpr std::array<float, 5> heights{-0.1f, -0.05f, -0.0495f, 0.05f, 0.1f};
  TetrahedralMesh mesh = box_tetrahedra({0.6f, 0.2f, 0.2f}, {12, 4, 4});
  for (Vec3f& p : mesh.positions) p.y = heights[static_cast<std::size_t>(std::lround(p.y / 0.05f) + 2)];
  return mesh;
}

// One damping for all, the mean, threw corners of small tetrahedra metres away.
TEST(SoftBodyMotion, DampingFitsEachTetrahedron) {
  SoftBodyOptions options;
  options.material = elastic_solid("gelatine");
  const TetrahedralMesh mesh = graded_bar();
  Scene scene = scene_of(make_soft_body(mesh, options), 0);
  Collider floor;
  floor.position = {0, -0.12f, 0};
  scene.add(floor);
  World world(scene);
  run(world, 60);
  const std::vector<Vec3f> positions = positions_of(world);
  for (const auto& t : mesh.tetrahedra)
    for (std::size_t i = 1; i < 4; ++i) {
      const auto a = static_cast<std::size_t>(t[0]), b = static_cast<std::size_t>(t[i]);
      EXPECT_LT(length(positions[a] - positions[b]), 3 * length(mesh.positions[a] - mesh.positions[b]));
    }
}

TEST(SoftBodyDoubts, NameNumbersInOtherUnits) {
  const auto doubts = [](float modulus, float damping) {
    SoftBodyOptions options;
    options.material = solid_of(modulus, 0.3f);
    options.material.damping = damping;
    std::string all;
    for (const Finding& finding :
         inspect(scene_of(make_soft_body(box_tetrahedra({0.1f, 0.1f, 0.1f}, {4, 4, 4}), options), 0)))
      all += finding.message + "\n";
    return all;
  };
  EXPECT_NE(doubts(1.5f, 0).find("youngs_modulus"), std::string::npos) << doubts(1.5f, 0);
  EXPECT_NE(doubts(1e5f, 2).find("like tar"), std::string::npos) << doubts(1e5f, 2);
  EXPECT_EQ(doubts(1e5f, 0.002f), "");
}

TEST(SoftBodySubsteps, TooFewAreADoubtAlsoByDefault) {
  SoftBodyOptions options;
  options.material = solid_of(1e10f, 0.3f);
  Scene scene = scene_of(make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {12, 3, 3}), options), 0);
  EXPECT_EQ(chosen_substeps(scene)[0], 1000);
  std::string all;
  for (const Finding& finding : inspect(scene)) all += finding.message + "; " + finding.advice + "\n";
  EXPECT_NE(all.find("use larger tetrahedra"), std::string::npos) << all;
}

/// The root mean square of the height of the free end over the third quarter of a second, after it was let go.
double swing(float damping) {
  SoftBodyOptions options;
  options.material = solid_of(2e5f, 0.3f);
  options.material.damping = damping;
  Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {12, 3, 3}), options);
  std::vector<int> held;
  std::size_t tip = 0;
  for (std::size_t i = 0; i < bar.positions.size(); ++i) {
    if (bar.positions[i].x < -0.199f) held.push_back(static_cast<int>(i));
    if (bar.positions[i].x > bar.positions[tip].x) tip = i;
    bar.velocities.push_back({0, 0.3f * (bar.positions[i].x + 0.2f), 0});
  }
  Scene scene = scene_of(std::move(bar), 240);
  scene.gravity = {};
  scene.pin(0, held);
  World world(scene);
  double squares = 0;
  for (int frame = 0; frame < 45; ++frame) {
    world.step(1.f / 60);
    const double y = static_cast<double>(positions_of(world)[tip].y - scene.objects[0].positions[tip].y);
    if (frame >= 30) squares += y * y / 15;
  }
  return std::sqrt(squares);
}

TEST(SoftBodyMotion, DampingTakesEnergyFromASwing) {
  // The first mode of the beam has 9 rad/s; a viscous stress of 10 ms takes exp(-0.01 9^2 t / 2) of its amplitude, 0.78
  // at 0.62 s.
  EXPECT_NEAR(swing(0.01f) / swing(0), 0.78, 0.1);
}

}  // namespace
}  // namespace pliant
