// Compares a World with the tests' own solver: double precision, constraints one after another in the order in which
// they were given. The orders differ, so the tests use cases in which the order does not matter: constraints that share
// no particle, and systems projected until they converge.
#include "pliant/reference.h"

#include <gtest/gtest.h>

#include "pliant/world.h"
#include "support/constraint_support.h"
#include "support/scenes.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

reference::Hardness hardness_of(const Stiffness& stiffness) {
  reference::Hardness hardness;
  if (stiffness.kind == Stiffness::Kind::pbd) {
    hardness.pbd = stiffness.value;
  } else {
    hardness.compliance = stiffness.value;
    hardness.damping = stiffness.damping;
  }
  return hardness;
}

/// Adds an object to the reference solver. Rest data are those given, or measured in double precision.
void add_object(const Object& object, reference::Solver& solver) {
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3d velocity = object.velocities.empty() ? Vec3d{} : convert<double>(object.velocities[i]);
    solver.add(convert<double>(object.positions[i]), object.masses[i], velocity);
  }
  for (const ConstraintGroup& group : object.constraints) {
    const auto type = std::find_if(constraint_types().begin(), constraint_types().end(),
                                   [&](const ConstraintType& t) { return t.name == group.type; });
    const auto size = static_cast<std::size_t>(type->stencil_size), fields = type->rest_fields.size();
    for (std::size_t c = 0; c < group.particles.size() / size; ++c) {
      const auto first = group.particles.begin() + static_cast<std::ptrdiff_t>(c * size);
      std::vector<double> rest;
      if (!group.rest.empty())
        rest.assign(group.rest.begin() + static_cast<std::ptrdiff_t>(c * fields),
                    group.rest.begin() + static_cast<std::ptrdiff_t>((c + 1) * fields));
      solver.add(group.type, {first, first + type->stencil_size}, rest, hardness_of(group.stiffness));
    }
  }
}

/// The largest distance between a particle's two positions after some frames [m].
double difference(const Object& object, int substeps, int iterations, int frames) {
  Scene scene;
  scene.add(object);
  World world(scene, settings_of(substeps, iterations));
  reference::Solver solver;
  solver.gravity = convert<double>(scene.gravity);
  solver.substeps = substeps;
  solver.iterations = iterations;
  add_object(object, solver);
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    solver.step(static_cast<double>(dt));
  }
  const std::vector<Vec3f> positions = world.object(0).positions();
  double most = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    most = std::max(most, length(convert<double>(positions[i]) - solver.particles[i].position));
  }
  return most;
}

template <class T>
class AgainstReference : public testing::Test {};
TYPED_TEST_SUITE(AgainstReference, ConstraintTypes, NameOfType);

/// Many constraints of a type that share no particle, each away from its rest shape.
template <class T>
Object separate(const Stiffness& stiffness) {
  testing_support::Random random(31);
  Object object;
  ConstraintGroup group{T::name, {}, {}, stiffness, {}};
  for (int c = 0; c < 50; ++c) {
    const auto x = random_stencil<T>(random);
    for (const Vec3d& p : x) {
      group.particles.push_back(static_cast<int>(object.positions.size()));
      object.positions.push_back(convert<float>(p));
      object.velocities.push_back(convert<float>(random_point(random, 0.5)));
      object.masses.push_back(static_cast<float>(uniform(random, 0.5, 2)));
    }
    // The rest data are measured at slightly different positions.
    auto y = x;
    for (Vec3d& p : y) p += random_point(random, 0.03);
    const auto rest = convert_params<T, float, double>(measure<T, double>(y));
    float fields[field_count<T>];
    std::memcpy(fields, &rest, sizeof fields);
    group.rest.insert(group.rest.end(), fields, fields + field_count<T>);
  }
  object.constraints = {group};
  return object;
}

/// How many frames to compare. Near rest the gradient of the co-rotational norm turns so quickly that PBD, whose
/// correction is one over its square, makes 1.7e-6 m of rounding 2.1e-5 m in a third frame.
template <class T>
int frames_for(const Stiffness& stiffness) {
  return std::is_same_v<T, CorotationalStrain> && stiffness.kind == Stiffness::Kind::pbd ? 2 : 3;
}

TYPED_TEST(AgainstReference, SeparateConstraintsMoveAlikeByEveryLaw) {
  for (const Stiffness& stiffness :
       {Stiffness::rigid(), Stiffness::compliance(1e-3f), Stiffness::compliance(1e-3f, 5), Stiffness::pbd(0.6f)}) {
    for (int iterations : {1, 3}) {
      EXPECT_LT(difference(separate<TypeParam>(stiffness), 4, iterations, frames_for<TypeParam>(stiffness)), 2e-5)
          << static_cast<int>(stiffness.kind) << " " << stiffness.value << " " << stiffness.damping << ", "
          << iterations << " iterations";
    }
  }
}

TEST(Reference, AgreesOnAChainProjectedUntilItIsMet) {
  for (const Stiffness& stiffness :
       {Stiffness::rigid(), Stiffness::compliance(1e-4f), Stiffness::compliance(1e-3f, 2)}) {
    Object object = chain(6, 0.2f, stiffness);
    object.masses[0] = std::numeric_limits<float>::infinity();
    // Gradients rotate between projections, so even converged constraints keep a trace of the order.
    EXPECT_LT(difference(object, 2, 400, 20), 1.5e-3);
  }
}

TEST(Reference, AgreesOnAClothProjectedUntilItIsMet) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-5f);
  options.bending = Stiffness::compliance(0.1f);
  Object object = make_cloth(grid_mesh(5, 5, 0.4f, 0.4f), options);
  object.masses[0] = object.masses[4] = std::numeric_limits<float>::infinity();
  EXPECT_LT(difference(object, 2, 300, 10), 1e-3);
}

}  // namespace
}  // namespace pliant
