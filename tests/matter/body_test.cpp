// Tests rigid bodies as they are made: mass, place and axes; what is refused.
#include "pliant/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pliant/error.h"

namespace pliant {
namespace {

TEST(Body, OfABoxHasItsMassAndInertia) {
  const Object body = make_body({{Box{{0.5f, 1, 1.5f}}, {}, {}, 2}});
  ASSERT_EQ(body.masses.size(), 1U);
  EXPECT_FLOAT_EQ(body.masses[0], 12);
  EXPECT_NEAR(body.frames[0].inertia.x, 13, 1e-5);
  EXPECT_NEAR(body.frames[0].inertia.y, 10, 1e-5);
  EXPECT_NEAR(body.frames[0].inertia.z, 5, 1e-5);
  EXPECT_EQ(body.frames[0].orientation.w, 1);
}

/// A hammer: its centre of mass is nearer to the head.
TEST(Body, OfTwoSolidsHasItsParticleAtTheCentreOfMass) {
  BodyOptions options;
  options.position = {0, 2, 0};
  options.mass = 3;
  const Object body = make_body(
      {{Box{{0.5f, 0.5f, 0.5f}}, {-1, 0, 0}, {}, 100}, {Box{{0.5f, 0.5f, 0.5f}}, {1, 0, 0}, {}, 300}}, options);
  EXPECT_FLOAT_EQ(body.masses[0], 3);
  EXPECT_NEAR(body.positions[0].x, 0.5, 1e-6);
  EXPECT_NEAR(body.positions[0].y, 2, 1e-6);
}

TEST(Body, OfAHullIsThatOfItsBox) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({(i & 1) != 0 ? 0.5f : -0.5f, (i & 2) != 0 ? 1.f : -1.f, (i & 4) != 0 ? 1.5f : -1.5f});
  const Object hull = make_body({{Hull{corners}, {}, {}, 2}}), box = make_body({{Box{{0.5f, 1, 1.5f}}, {}, {}, 2}});
  EXPECT_NEAR(hull.masses[0], box.masses[0], 1e-4);
  EXPECT_NEAR(hull.frames[0].inertia.x, box.frames[0].inertia.x, 1e-4);
}

std::string refused(const Solid& solid, const BodyOptions& options = {}) {
  try {
    static_cast<void>(make_body({solid}, options));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// The inertia of a turned box about its centre, given as a tensor, makes the same body as the box itself.
TEST(Body, OfGivenInertiaIsThatOfItsSolid) {
  const Solid box{Box{{0.5f, 1, 1.5f}}, {0.25f, 2, 0}, rotation({0, 0, 1}, 90), 2};
  const Object solid = make_body({box});
  BodyOptions options;
  options.inertia = BodyInertia{12, {0.25f, 2, 0}, {10, 13, 5}, {}};
  const Object given = make_body({box}, options);
  EXPECT_FLOAT_EQ(given.masses[0], solid.masses[0]);
  EXPECT_NEAR(given.positions[0].y, 2, 1e-6);
  EXPECT_NEAR(given.frames[0].inertia.x + given.frames[0].inertia.y + given.frames[0].inertia.z, 28, 1e-4);
  options.inertia =
      BodyInertia{12, {}, {11.5f, 11.5f, 5}, {0, 0, 1.5f}};  // the box turned by 45 degrees: Ixy = (13 - 10) / 2
  const Object turned = make_body({}, options);
  const Vec3f inertia = turned.frames[0].inertia;
  EXPECT_NEAR(std::max({inertia.x, inertia.y, inertia.z}), 13, 1e-4);
  EXPECT_NEAR(std::min({inertia.x, inertia.y, inertia.z}), 5, 1e-4);
  EXPECT_TRUE(turned.bodies[0].solids.empty());
  options.inertia->moments.y = 0;
  EXPECT_THROW(static_cast<void>(make_body({}, options)), Error);
  options.inertia = BodyInertia{12, {}, {1, 1, 1}, {0, 0, 2}};
  EXPECT_THROW(static_cast<void>(make_body({}, options)), Error) << "not positive definite";
}

TEST(Body, OfNoSizeDensityOrVolumeIsRefused) {
  EXPECT_NE(refused({Sphere{0}}).find("solid 0"), std::string::npos) << refused({Sphere{0}});
  EXPECT_NE(refused({Cylinder{0.1f, -1}}).find("half_length is -1"), std::string::npos);
  EXPECT_NE(refused({Sphere{1}, {}, {}, std::numeric_limits<float>::quiet_NaN()}).find("density"), std::string::npos);
  EXPECT_NE(refused({Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}).find("in one plane"), std::string::npos);
  BodyOptions options;
  options.mass = -1;
  EXPECT_NE(refused({Sphere{1}}, options).find("mass"), std::string::npos);
}

TEST(Body, OfARotationOfZeroIsRefused) {
  BodyOptions options;
  options.name = "wheel";
  options.rotation = {0, 0, 0, 0};
  EXPECT_NE(refused({Sphere{1}}, options).find("object 'wheel': has a rotation that is zero"), std::string::npos)
      << refused({Sphere{1}}, options);
  EXPECT_NE(refused({Sphere{1}, {}, {0, 0, 0, 0}}).find("solid 0: has a rotation that is zero"), std::string::npos);
  options.rotation = {0, NAN, 0, 1};
  EXPECT_NE(refused({Sphere{1}}, options).find("not a unit quaternion"), std::string::npos);
  options.rotation = {0, 0, 0, 1.001f};
  EXPECT_EQ(refused({Sphere{1}}, options), "") << "what rounding leaves is normalised";
}

/// No moment of inertia exceeds the sum of the others, with equality for flat plates.
TEST(Body, OfAnInertiaThatNoBodyHasIsRefused) {
  BodyOptions options;
  options.name = "plate";
  options.inertia = BodyInertia{1, {}, {1, 1, 2}, {}};
  EXPECT_EQ(refused({Sphere{1}}, options), "");
  options.inertia->moments = {1, 1, 2.01f};
  const std::string text = refused({Sphere{1}}, options);
  EXPECT_NE(text.find("object 'plate', inertia"), std::string::npos) << text;
  EXPECT_NE(text.find("more than the sum of the others"), std::string::npos) << text;
  // Products count, too: the principal moments of this tensor are 1.5 - 1, 1.5 + 1 and 1.5.
  options.inertia = BodyInertia{1, {}, {1.5f, 1.5f, 1.5f}, {0, 0, 1}};
  EXPECT_NE(refused({Sphere{1}}, options).find("more than the sum"), std::string::npos);
}

}  // namespace
}  // namespace pliant
