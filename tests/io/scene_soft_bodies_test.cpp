// Tests how soft bodies in scene files become objects, and what is refused.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "scene_support.h"

namespace pliant {
namespace {

using test::named;

TEST(SceneSoftBodies, AreReadWithEveryField) {
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& bar = named(scene, "bar");
  ASSERT_EQ(bar.positions.size(), 3u * 2 * 4);
  ASSERT_EQ(bar.constraints.size(), 3u);
  ASSERT_TRUE(bar.constraints[0].plasticity);
  EXPECT_EQ(bar.constraints[0].plasticity->yield, 0.25f);
  EXPECT_FALSE(bar.constraints[1].plasticity);
  const ConstraintGroup& fibres = bar.constraints[2];
  EXPECT_EQ(fibres.type, "fibre");
  ASSERT_EQ(fibres.keyframes.size(), 2u);
  EXPECT_EQ(fibres.keyframes[1].factor, 0.5f);
  EXPECT_NEAR(fibres.compliances[0] * (1024 / 18.f), 1, 1e-4);
  EXPECT_EQ(bar.constraints[0].particles.size(), 4u * 6 * 2 * 1 * 3);
  // 2 x 1 x 1 m, fitted to 4 m and halved, so as large as it was; its x-axis points up.
  float low = 1e9f, high = -1e9f, mass = 0;
  for (const Vec3f& p : bar.positions) low = std::min(low, p.y), high = std::max(high, p.y);
  for (const float one : bar.masses) mass += one;
  EXPECT_NEAR(high - low, 2, 1e-5);
  EXPECT_NEAR(mass, 1250 * 2, 0.1);
  // mu = E / 2.5, and a tetrahedron has a sixth of a cell of 1 x 1 x 1/3 m.
  EXPECT_NEAR(bar.constraints[0].compliances[0] * (65536 / 2.5 / 18), 1, 1e-4);
  EXPECT_GT(bar.constraints[0].stiffness.damping, 0);
  EXPECT_EQ(bar.static_friction, 0.75f);
  EXPECT_EQ(bar.kinetic_friction, 0.5f);
  EXPECT_TRUE(bar.collides);
  ASSERT_TRUE(bar.absorbency);
  EXPECT_EQ(bar.absorbency->capacity, 0.75f);
  EXPECT_EQ(bar.absorbency->uptake, 0.25f);
  EXPECT_EQ(bar.absorbency->wicking, 0.0005f);
  EXPECT_EQ(bar.absorbency->rise, 0.125f);
  EXPECT_EQ(bar.absorbency->runoff, 0.0625f);
  EXPECT_EQ(bar.absorbency->seepage, 0.03125f);
  EXPECT_EQ(bar.absorbency->drag, 4);
  ASSERT_TRUE(bar.tearing);
  EXPECT_EQ(bar.tearing->stretch, 1.75f);
  ASSERT_EQ(bar.cuts.size(), 1u);
  EXPECT_EQ(bar.cuts[0].start, 0.5f);
  EXPECT_EQ(bar.cuts[0].end, 1.5f);
  EXPECT_EQ(bar.cuts[0].point, (Vec3f{1, 2, 3}));
  EXPECT_EQ(bar.cuts[0].normal, (Vec3f{0, 2, 0}));
  EXPECT_EQ(bar.cuts[0].along, (Vec3f{1, 0, 0.5f}));
}

TEST(SceneSoftBodies, HaveASkin) {
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& ball = named(scene, "ball");
  ASSERT_TRUE(ball.skin) << "true: that of the mesh that is filled";
  EXPECT_EQ(ball.skin->vertices.size(), 162u);
  const std::vector<Vec3f> skin = skinned(*ball.skin, ball.positions);
  for (const Vec3f& p : skin) EXPECT_NEAR(length_squared(p - Vec3f{-24, 9, 1}), 1, 1e-4);
  const std::string other =
      R"({"objects": [{"soft_body": {"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
    "skin": {"sphere": {"subdivisions": 1, "radius": 0.5}}}}]})";
  EXPECT_EQ(parse_scene(other, "x.json", ".").objects[0].skin->vertices.size(), 42u);
  const std::string none =
      R"({"objects": [{"soft_body": {"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}}, "skin": true}}]})";
  EXPECT_THROW(parse_scene(none, "x.json", "."), Error);
}

TEST(SceneSoftBodies, OfAClosedMeshAreFilled) {
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& ball = named(scene, "ball");
  float mass = 0;
  for (const float one : ball.masses) mass += one;
  EXPECT_NEAR(mass / (30 * 4.18879f), 1, 0.15);
  for (const Vec3f& p : ball.positions) EXPECT_LT(length_squared(p - Vec3f{-24, 9, 1}), 1.05f);
}

TEST(SceneSoftBodies, OfThinMeshesAreFilledByDefault) {
  for (const char* size : {"[10, 0.5, 0.5]", "[1, 0.1, 1]"}) {
    const std::string text = std::string(R"({"objects": [{"soft_body": {"mesh": {"box": {"size": )") + size + "}}}}]}";
    const Scene scene = parse_scene(text, "x.json", ".");
    float mass = 0;
    for (const float one : scene.objects[0].masses) mass += one;
    EXPECT_NEAR(mass / (1000 * (size[1] == '1' && size[2] == '0' ? 2.5f : 0.1f)), 1, 0.15) << size;
  }
}

TEST(SceneSoftBodies, ArePartsOfObjectsOfBodies) {
  const Scene scene = parse_scene(R"({"objects": [{
    "bodies": [{"name": "hub", "solids": [{"box": {"half_extents": [0.1, 0.1, 0.1]}}]}],
    "parts": [{
      "soft_body": {"tetrahedra": {"box": {"size": [0.4, 0.1, 0.1], "cells": [4, 1, 1]}, "translate": [0.3, 0, 0]}},
      "ties": [{"particles": {"box": {"min": [0.09, -1, -1], "max": [0.11, 1, 1]}}, "body": "hub"}]
    }]
  }]})",
                                  "x.json", ".");
  ASSERT_EQ(scene.objects[0].bodies.size(), 1u);
  EXPECT_EQ(scene.objects[0].positions.size(), 1u + 5 * 2 * 2);
}

TEST(SceneSoftBodies, AreReadFromFiles) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "soft_bodies";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "one.node") << "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
  std::ofstream(folder / "one.ele") << "1 4 0\n1 1 2 3 4\n";
  const Scene scene =
      parse_scene(R"({"objects": [{"soft_body": {"tetrahedra": {"file": "one.ele"}}}]})", "x.json", folder.string());
  EXPECT_EQ(scene.objects[0].positions.size(), 4u);
  const std::string outside = R"({"objects": [{"soft_body": {"tetrahedra": {"file": "../one.ele"}}}]})";
  EXPECT_NE(std::string(test::scene_error(outside, folder.string(), false).what()).find("leaves the scene's folder"),
            std::string::npos);
}

TEST(SceneSoftBodies, AreRefusedWithAReason) {
  const std::string start = R"({"objects": [{"soft_body": )";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1, 1]}}})", "/objects/0/soft_body/tetrahedra/box/cells"},
      {R"({"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1000, 1000, 1000]}}})", "use fewer cells"},
      {R"({"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}}, "size": 0.1})", "size: is only for a mesh"},
      {R"({"mesh": {"grid": {"columns": 2, "rows": 2, "width": 1, "depth": 1}}})", "/objects/0/soft_body"},
      {R"({"mesh": {"sphere": {"subdivisions": 1}}, "size": 0.00001})", "give a larger size"},
      {R"({"mesh": {"sphere": {"subdivisions": 1}}, "size": 90})", "is too large"},
      {R"({"mesh": {"sphere": {"subdivisions": 1}}, "material": "jelly"})", "gelatine"},
      {R"({"mesh": {"sphere": {"subdivisions": 1}}, "material": {"poisson_ratio": 0.5}})", "0.495"},
      {R"({"tetrahedra": {"file": "no.ele"}})", "there is no file"},
      {R"({"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [200, 200, 200]}}})", "tetrahedra; use fewer cells"},
      {R"({"size": 1})", "/objects/0/soft_body"},
  };
  for (const auto& [body, expected] : cases) {
    const std::string found = test::scene_message(start + body + "}]}");
    EXPECT_NE(found.find(expected), std::string::npos) << body << "\n" << found;
  }
}

TEST(SceneSoftBodies, HaveTheModelThatIsNamed) {
  const auto type_of = [](const std::string& model) {
    const std::string text =
        R"({"objects": [{"soft_body": {"tetrahedra": {"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
      "material": {"model": ")" +
        model + R"("}}}]})";
    return parse_scene(text, "x.json", ".").objects.at(0).constraints.at(0).type;
  };
  EXPECT_EQ(type_of("neo_hookean"), "tetrahedron_shear");
  EXPECT_EQ(type_of("corotational"), "corotational_strain");
  EXPECT_EQ(type_of("st_venant_kirchhoff"), "green_strain");
}

}  // namespace
}  // namespace pliant
