// Gases: buoyancy by temperature, cooling, diffusion, drag, vorticity, momentum, and the same bits.
#include "pliant/gas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/save.h"
#include "pliant/world.h"
#include "support/kernels.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::run;

constexpr float spacing = 0.05f;

/// What a gas of the tests has beyond that of the air.
struct Of {
  float temperature = 293.15f, ambient_temperature = 293.15f, ambient_density = 1.2f, cooling_time = 0, diffusivity = 0,
        drag = 0, vorticity = 0;
  std::vector<GasHeater> heaters{};
};

Object cube_of_gas(float side, const Of& of, float density = 1.2f) {
  GasOptions options;
  options.fluid = {.spacing = spacing, .density = density};
  options.gas = {of.temperature, of.ambient_temperature, of.ambient_density, of.cooling_time, of.diffusivity,
                 of.drag,        of.vorticity,           of.heaters};
  return make_gas(fill_box({}, {side, side, side}, spacing), options);
}

Scene scene_of(Object object) {
  Scene scene;
  scene.add(std::move(object));
  scene.settings.threads = 1;
  return scene;
}

Vec3d mean(const std::vector<Vec3f>& values) {
  Vec3d sum{};
  for (const Vec3f& v : values) sum = sum + Vec3d{v.x, v.y, v.z};
  return sum * (1.0 / static_cast<double>(values.size()));
}

double mean_temperature(const World& world) {
  double sum = 0;
  const std::vector<float> all = world.object(0).channel("temperature");
  for (const float t : all) sum += static_cast<double>(t);
  return sum / static_cast<double>(all.size());
}

TEST(Gas, RisesByItsTemperature) {
  World world(scene_of(cube_of_gas(0.3f, {.temperature = 400, .ambient_temperature = 300, .ambient_density = 1.2f})));
  run(world, 30);
  EXPECT_NEAR(mean(world.object(0).velocities()).y, 9.81 * (400. / 300 - 1) * 0.5, 1e-4);
}

TEST(Gas, FloatsWhereItIsAsHeavyAsTheAir) {
  World world(scene_of(cube_of_gas(0.3f, {.ambient_density = 1.2f})));
  const double before = mean(world.object(0).positions()).y;
  run(world, 120);
  EXPECT_NEAR(mean(world.object(0).positions()).y, before, 1e-4);
}

TEST(Gas, LighterThanAirRisesByArchimedes) {
  World world(scene_of(cube_of_gas(0.1f, {.ambient_density = 1.2f}, 0.6f)));
  run(world, 12);
  EXPECT_NEAR(mean(world.object(0).velocities()).y, 9.81 * 0.2, 1e-4);
}

TEST(Gas, CoolsExponentially) {
  World world(scene_of(cube_of_gas(0.2f, {.temperature = 500, .ambient_temperature = 300, .cooling_time = 0.7f})));
  run(world, 60);
  EXPECT_NEAR(mean_temperature(world), 300 + 200 * std::exp(-1 / 0.7), 0.01);
}

// A particle alone has the density of its own kernel, so that a known share of the drag acts on it.
TEST(Gas, ReachesItsTerminalVelocity) {
  // The kernel (2 - r)^3 at its centre over its sum in a lattice of spacing 1.
  const double own = 8 / (14 + 12 * std::pow(2 - std::sqrt(2.0), 3) + 8 * std::pow(2 - std::sqrt(3.0), 3));
  const Of gas{.temperature = 450, .ambient_temperature = 300, .drag = 10};
  World world(scene_of(cube_of_gas(spacing, gas)));
  run(world, 240);
  const double velocity = mean(world.object(0).velocities()).y;
  const double missing = 9.81 * 0.5 / (10 * velocity);
  EXPECT_NEAR(missing, 1 - own, 0.001);
  run(world, 60);
  EXPECT_NEAR(mean(world.object(0).velocities()).y, velocity, 1e-4 * velocity) << "it still accelerates";
}

TEST(Gas, IsBlownByTheWind) {
  Scene scene = scene_of(cube_of_gas(0.2f, {.ambient_density = 1.2f, .drag = 20}));
  scene.wind.velocity = {3, 0, 0};
  scene.wind.air_density = 1.2f;
  World world(scene);
  run(world, 300);
  EXPECT_NEAR(mean(world.object(0).velocities()).x, 3, 0.05);
}

// A wave of temperature decays by exp(-k^2 diffusivity t); its mean stays.
TEST(Gas, DiffusesHeat) {
  constexpr float side = 1, diffusivity = 0.01f;
  GasOptions options;
  options.gas.diffusivity = diffusivity;
  Scene scene = scene_of(make_gas(fill_box({}, {side, 0.4f, 0.4f}, spacing), options));
  scene.gravity = {};
  World world(scene);
  State state = world.state();
  const double k = 3.14159265358979 / static_cast<double>(side);
  for (std::size_t i = 0; i < state.positions.size(); ++i)
    state.channels.front().values[i] =
        300 + 10 * static_cast<float>(std::cos(k * static_cast<double>(state.positions[i].x)));
  world.restore(state);
  run(world, 120);
  double amplitude = 0, count = 0;
  const std::vector<float> temperatures = world.object(0).channel("temperature");
  const std::vector<Vec3f> places = world.object(0).positions();
  for (std::size_t i = 0; i < places.size(); ++i, ++count)
    amplitude += 2 * (static_cast<double>(temperatures[i]) - 300) * std::cos(k * static_cast<double>(places[i].x));
  EXPECT_NEAR(amplitude / count, 10 * std::exp(-k * k * 0.01 * 2), 0.15);
  EXPECT_NEAR(mean_temperature(world), 300, 0.001);
}

TEST(Gas, KeepsItsMomentum) {
  Object gas = cube_of_gas(0.4f, {.temperature = 350, .ambient_temperature = 300, .diffusivity = 0.01f});
  gas.velocities.assign(gas.positions.size(), {});
  for (std::size_t i = 0; i < gas.positions.size(); ++i)
    gas.velocities[i] = gas.positions[i].x < 0.2f ? Vec3f{2, 1, 0} : Vec3f{-2, 0, 0};
  Scene scene = scene_of(std::move(gas));
  scene.gravity = {};
  World world(scene);
  const Vec3d before = mean(world.object(0).velocities());
  run(world, 60);
  const Vec3d after = mean(world.object(0).velocities());
  EXPECT_NEAR(after.x, before.x, 1e-5);
  EXPECT_NEAR(after.y, before.y, 1e-5);
  EXPECT_NEAR(after.z, before.z, 1e-5);
}

/// A vortex ring or eddy: the kinetic energy of a spinning cylinder of gas.
double spin_left(float vorticity) {
  Object gas = cube_of_gas(0.6f, {.vorticity = vorticity});
  gas.velocities.assign(gas.positions.size(), {});
  for (std::size_t i = 0; i < gas.positions.size(); ++i) {
    const Vec3f d = gas.positions[i] - Vec3f{0.3f, 0.3f, 0.3f};
    const float decay = std::exp(-(d.x * d.x + d.y * d.y) / 0.02f);
    gas.velocities[i] = Vec3f{-d.y, d.x, 0} * (10 * decay);
  }
  Scene scene = scene_of(std::move(gas));
  scene.gravity = {};
  World world(scene);
  run(world, 60);
  double sum = 0;
  for (const Vec3f& v : world.object(0).velocities()) sum += static_cast<double>(length_squared(v));
  return sum;
}

TEST(Gas, SpinsOnByVorticityConfinement) { EXPECT_GT(spin_left(1), 1.2 * spin_left(0)); }

Scene scene_with_all() {
  Scene scene = scene_of(cube_of_gas(0.5f, {.temperature = 320,
                                            .cooling_time = 2,
                                            .diffusivity = 0.01f,
                                            .drag = 3,
                                            .vorticity = 0.3f,
                                            .heaters = {{{.centre = {0.25f, 0.1f, 0.25f}, .radius = 0.15f}, 600, 8}}}));
  TracersOptions smoke;
  smoke.tracers = {.source = {.centre = {0.25f, 0.2f, 0.25f}, .radius = 0.1f}, .rate = 700, .lifetime = 0.5f};
  smoke.capacity = 300;
  scene.add(make_tracers(smoke));
  Collider ball;
  ball.shape = Sphere{0.1f};
  ball.position = {0.25f, 0.6f, 0.25f};
  scene.add(ball);
  scene.wind = {.velocity = {1, 0, 0}, .air_density = 1.2f};
  return scene;
}

TEST(Gas, HasTheSameBitsOnThreadsAndLevels) {
  const std::vector<std::string> isas = testing_support::available_code_paths();
  std::string expected;
  for (const int threads : {1, 2, 3})
    for (const std::string& isa : isas) {
      Scene scene = scene_with_all();
      scene.settings.threads = threads;
      scene.settings.isa = isa;
      World world(scene);
      run(world, 40);
      if (expected.empty()) expected = hash(world.state());
      EXPECT_EQ(hash(world.state()), expected);
    }
}

TEST(Gas, HasTheSameBitsAfterARestoredState) {
  World world(scene_with_all());
  run(world, 20);
  const State state = world.state();
  run(world, 20);
  World again(scene_with_all());
  again.restore(state);
  run(again, 20);
  EXPECT_EQ(hash(again.state()), hash(world.state()));
}

TEST(Gas, RefusesAStateWithoutTemperatures) {
  World world(scene_with_all());
  State state = world.state();
  state.channels.clear();
  EXPECT_THROW(world.restore(state), Error);
}

TEST(Gas, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(cube_of_gas(0.1f, {.temperature = 0}), Error);
  EXPECT_THROW(cube_of_gas(0.1f, {.drag = -1}), Error);
  EXPECT_THROW(gas_preset("argon"), Error);
  EXPECT_THROW(make_tracers({.tracers = {.rate = 0}}), Error);
  EXPECT_THROW(make_tracers({.tracers = {}, .capacity = 0}), Error);
}

}  // namespace
}  // namespace pliant
