// Tests reading scenes: every field is stored, the project's scenes are readable, and the documents match the table.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/scene_grammar.h"
#include "io/scene_mesh.h"
#include "io/scene_schema.h"
#include "io/scene_values.h"
#include "scene_support.h"
#include "support/paths.h"

namespace pliant {

namespace {

using test::FullScene;

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
  EXPECT_LE(length_squared(a - b), tolerance * tolerance)
      << testing::PrintToString(a) << " is not " << testing::PrintToString(b);
}

TEST_F(FullScene, HasItsSurroundings) {
  EXPECT_EQ(scene.gravity, (Vec3f{0, -1.5f, 0.25f}));
  EXPECT_EQ(scene.frame_time, 0.02f);
  EXPECT_EQ(scene.frames, 17);
  EXPECT_EQ(scene.wind.velocity, (Vec3f{3, 0, 1}));
  EXPECT_EQ(scene.wind.air_density, 1.25f);
  EXPECT_EQ(scene.wind.gust, 0.5f);
  EXPECT_EQ(scene.wind.gust_period, 4.f);
  EXPECT_EQ(scene.settings.substeps, 3);
  EXPECT_EQ(scene.settings.iterations, 5);
  EXPECT_EQ(scene.settings.tolerance, 0.03125f);
  EXPECT_EQ(scene.settings.threads, 2);
  EXPECT_EQ(scene.settings.least_substeps, 7);
  EXPECT_EQ(scene.settings.sweep, Sweep::symmetric);
  const SweepOptions& options = scene.settings.sweep_options;
  EXPECT_EQ(options.relaxation, 1.25f);
  EXPECT_EQ(options.sharing, SweepOptions::Sharing::average);
  EXPECT_EQ(options.acceleration, SweepOptions::Acceleration::chebyshev);
  EXPECT_EQ(options.plain_iterations, 7);
  EXPECT_EQ(options.spectral_radius, 0.5f);
  EXPECT_TRUE(options.tethers);
  EXPECT_EQ(options.tether_slack, 0.25f);
  EXPECT_EQ(options.chain_softness, 0.125f);
  EXPECT_EQ(options.most_overstretch, 0.375f);
  EXPECT_EQ(options.multigrid_cycles, 3);
  EXPECT_TRUE(scene.settings.record_residuals);
  EXPECT_TRUE(scene.settings.measure);
  EXPECT_TRUE(scene.settings.record_multipliers);
  EXPECT_EQ(scene.settings.isa, "x86-64-v3");
}

TEST(SceneSettings, ReadEverySweepByItsName) {
  const std::pair<const char*, Sweep> names[] = {
      {"tiled", Sweep::tiled},         {"sequential", Sweep::sequential},
      {"symmetric", Sweep::symmetric}, {"jacobi", Sweep::jacobi},
      {"natural", Sweep::natural},     {"chains", Sweep::chains},
      {"multigrid", Sweep::multigrid}, {"tethered_chains", Sweep::tethered_chains}};
  EXPECT_EQ(sweeps().size(), std::size(names)) << "a sweep that this test does not know";
  EXPECT_EQ(parse_scene(R"({"settings": {"sweep": "automatic"}, "objects": []})", "x.json", ".").settings.sweep,
            Sweep::automatic);
  EXPECT_EQ(parse_scene(R"({"objects": []})", "x.json", ".").settings.sweep, Sweep::automatic) << "the default";
  for (const auto& [name, sweep] : names) {
    const std::string text = R"({"settings": {"sweep": ")" + std::string(name) + R"("}, "objects": []})";
    EXPECT_EQ(parse_scene(text, "x.json", ".").settings.sweep, sweep) << name;
  }
  const SweepOptions plain =
      parse_scene(R"({"settings": {"sweep_options": {}}, "objects": []})", "x.json", ".").settings.sweep_options;
  EXPECT_EQ(plain.sharing, SweepOptions::Sharing::split);
  EXPECT_EQ(plain.acceleration, SweepOptions::Acceleration::none);
}

TEST_F(FullScene, HasItsColliders) {
  ASSERT_EQ(scene.colliders.size(), 5U);
  const Collider& floor = scene.colliders[0];
  EXPECT_EQ(floor.name, "floor");
  EXPECT_TRUE(std::holds_alternative<Plane>(floor.shape));
  EXPECT_EQ(floor.position, (Vec3f{0, -1, 0}));
  EXPECT_NEAR(std::abs(floor.rotation.z), 1, 1e-6);
  EXPECT_EQ(floor.motion.keyframes.size(), 2U);
  EXPECT_EQ(floor.motion.keyframes[1].position, (Vec3f{0, 1, 0}));
  EXPECT_EQ(floor.thickness, 0.5f);
  EXPECT_EQ(floor.static_friction, 0.875f);
  EXPECT_EQ(floor.kinetic_friction, 0.75f);
  EXPECT_EQ(floor.restitution, 0.5f);
  EXPECT_EQ(floor.rolling_friction, 0.125f);
  EXPECT_EQ(floor.spinning_friction, 0.25f);
  EXPECT_EQ(floor.surface_velocity, (Vec3f{0.5f, 0, 2}));
  EXPECT_EQ(floor.colour, (Vec3f{1, 0, 0.5f}));
  EXPECT_EQ(std::get<Sphere>(scene.colliders[1].shape).radius, 3.f);
  EXPECT_EQ(std::get<Sphere>(scene.colliders[2].shape).radius, Sphere{}.radius);
  EXPECT_EQ(scene.colliders[2].name, "sphere_2");
  EXPECT_EQ(scene.colliders[2].static_friction, Collider{}.static_friction);
  EXPECT_EQ(std::get<Capsule>(scene.colliders[3].shape).radius, 2.f);
  EXPECT_EQ(std::get<Capsule>(scene.colliders[3].shape).half_length, 4.f);
  EXPECT_EQ(std::get<Box>(scene.colliders[4].shape).half_extents, (Vec3f{1, 2, 3}));
}

TEST_F(FullScene, HasItsSheetInPlace) {
  const Object& sheet = scene.objects.at(0);
  EXPECT_EQ(sheet.name, "sheet");
  ASSERT_EQ(sheet.positions.size(), 12U);
  // The corner (-1.5, 0, -1), scaled to (-3, 0, -0.5), rotated by 90 degrees about y to (-0.5, 0, 3), raised by 2.
  expect_near(sheet.positions[0], {-0.5f, 2, 3});
  expect_near(sheet.positions[3], {-0.5f, 2, -3});
  expect_near(sheet.positions[8], {0.5f, 2, 3});
  float mass = 0;
  for (const float one : sheet.masses) mass += one;
  EXPECT_NEAR(mass, 6 * 1 * 0.5, 1e-5);  // area and density
  EXPECT_EQ(sheet.velocities, std::vector<Vec3f>(12, Vec3f{0, 0, 7}));
  EXPECT_EQ(sheet.thickness, 0.003f);
  EXPECT_EQ(sheet.constraints.back().type, "distance_limit");
  EXPECT_EQ(sheet.constraints.back().rest[0], 2.5f * sheet.constraints.back().rest[1]);
  EXPECT_EQ(sheet.restitution, 0.375f);
  EXPECT_EQ(sheet.rolling_friction, 0.0625f);
  EXPECT_EQ(sheet.spinning_friction, 0.03125f);
  EXPECT_EQ(sheet.kinetic_friction, 0.25f);
  EXPECT_EQ(sheet.restitution, 0.375f);
  EXPECT_EQ(sheet.drag, 2.f);
  EXPECT_EQ(sheet.lift, 1.f);
  EXPECT_EQ(sheet.damping, 0.75f);
  EXPECT_EQ(sheet.colour, (Vec3f{0.25f, 0.5f, 0.75f}));
  EXPECT_EQ(sheet.clarity, 0.125f);
}

TEST_F(FullScene, HasItsConstraintsAsStiffAsTold) {
  const Object& sheet = scene.objects.at(0);
  ASSERT_EQ(sheet.constraints.size(), 3U);
  EXPECT_EQ(sheet.constraints[0].type, "distance");
  EXPECT_EQ(sheet.constraints[0].stiffness.value, 0.001f);
  EXPECT_EQ(sheet.constraints[0].stiffness.damping, 0.5f);
  EXPECT_EQ(sheet.constraints[1].type, "isometric_bending");
  EXPECT_EQ(sheet.constraints[1].stiffness.kind, Stiffness::Kind::pbd);
  EXPECT_EQ(sheet.constraints[1].stiffness.value, 0.5f);
}

/// The motion of a collider with these keyframes.
Motion motion_of(const std::string& keyframes, const std::string& others = "") {
  const std::string text =
      R"({"objects": [], "colliders": [{"plane": {}, "motion": {"keyframes": [)" + keyframes + "]" + others + "}}]}";
  return parse_scene(text, "x.json", ".").colliders.at(0).motion;
}

/// By how many degrees a motion about z turns from its first keyframe to its last, by the shorter arc from each to the
/// next.
double turned_about_z(const Motion& motion) {
  double degrees = 0;
  for (std::size_t k = 1; k < motion.keyframes.size(); ++k) {
    const Quatf &a = motion.keyframes[k - 1].rotation, &b = motion.keyframes[k].rotation;
    const double sine = double{b.z} * double{a.w} - double{a.z} * double{b.w},
                 cosine = double{a.z} * double{b.z} + double{a.w} * double{b.w};
    degrees += 2 * std::atan(sine / cosine) * 180 / 3.14159265358979;
  }
  return degrees;
}

TEST(SceneMotion, TurnsByAsManyDegreesAsItSays) {
  const std::string end = R"({"time": 2, "position": [3, 0, 0], "rotation": {"axis": [0, 0, 2], "degrees": )";
  for (const int degrees : {90, 179, 180, 190, 270, 360, 720, -360, 100000}) {
    const Motion motion = motion_of(R"({"time": 1}, )" + end + std::to_string(degrees) + "}}");
    EXPECT_NEAR(turned_about_z(motion), degrees, 1e-5 * std::abs(degrees)) << degrees;
    const int steps = std::abs(degrees) < 180 ? 1 : (std::abs(degrees) + 89) / 90;
    EXPECT_EQ(static_cast<int>(motion.keyframes.size()), steps + 1) << degrees;
  }
}

TEST(SceneMotion, InsertsKeyframesEvenlyInTimeAndPlace) {
  const Motion motion =
      motion_of(R"({"time": 1, "position": [1, 0, 0]}, )"
                R"({"time": 3, "position": [5, 8, 0], "rotation": {"axis": [0, 0, 1], "degrees": 720}},
                                      {"time": 4}, {"time": 5, "rotation": {"axis": [0, 0, -1], "degrees": 360}})",
                R"(, "pivot": [1, 2, 3], "repeat": true)");
  EXPECT_NEAR(turned_about_z(motion), -360, 1e-3) << "two turns there, two back and one more";
  ASSERT_EQ(motion.keyframes.size(), 4u + 7 + 7 + 3);
  EXPECT_EQ(motion.keyframes[1].time, 1.25f);
  EXPECT_EQ(motion.keyframes[1].position, (Vec3f{1.5f, 1, 0}));
  EXPECT_EQ(motion.keyframes[8].time, 3.f);
  EXPECT_EQ(motion.pivot, (Vec3f{1, 2, 3}));
  EXPECT_TRUE(motion.repeat);
}

TEST(SceneMotion, TakesTheShorterArcBetweenOtherAxes) {
  EXPECT_EQ(motion_of(R"({"time": 0, "rotation": {"axis": [1, 0, 0], "degrees": 90}},
                         {"time": 1, "rotation": {"axis": [0, 1, 0], "degrees": 400}})")
                .keyframes.size(),
            2u);
}

TEST(SceneMotion, RefusesMoreTurnsThanThereAreTimes) {
  EXPECT_NE(
      test::scene_message(R"({"objects": [], "colliders": [{"plane": {}, "motion": {"keyframes": [{"time": 1000000},
                {"time": 1000000.125, "rotation": {"axis": [0, 0, 1], "degrees": 720}}]}}]})")
          .find("turns by too many degrees"),
      std::string::npos);
}

TEST_F(FullScene, HasItsPinsAndAttachments) {
  const Object& sheet = scene.objects.at(0);
  std::vector<int> pinned;
  for (const Pin& pin : sheet.pins) pinned.push_back(pin.particle);
  EXPECT_EQ(pinned, (std::vector<int>{0, 3, 8, 11, 2, 6, 10}));  // the corners, and the vertices at z = -1
  const Motion& motion = sheet.pins.back().motion;
  ASSERT_EQ(motion.keyframes.size(), 2U);
  EXPECT_EQ(motion.keyframes[0].time, 1.f);
  EXPECT_EQ(motion.keyframes[0].position, (Vec3f{0, 1, 0}));
  EXPECT_EQ(motion.keyframes[1].time, 2.5f);
  EXPECT_NEAR(motion.keyframes[1].rotation.z, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(motion.pivot, (Vec3f{1, 2, 3}));
  EXPECT_TRUE(motion.repeat);
  ASSERT_EQ(sheet.attachments.size(), 2U);
  EXPECT_EQ(sheet.attachments[0].particle, 9);  // at (0.5, 2, 1)
  EXPECT_EQ(sheet.attachments[0].target, (Vec3f{4, 5, 6}));
  EXPECT_EQ(sheet.attachments[0].stiffness.value, 0.5f);
  EXPECT_TRUE(sheet.attachments[0].motion.moves());
  EXPECT_EQ(sheet.attachments[1].particle, 5);
  EXPECT_EQ(sheet.attachments[1].target, sheet.positions[5]);
}

/// The sum of 1 / compliance of the triangles at an edge.
float area_at(const ConstraintGroup& triangles, int a, int b) {
  float sum = 0;
  for (std::size_t t = 0; t < triangles.compliances.size(); ++t) {
    const int* corners = &triangles.particles[3 * t];
    const bool has_both = std::count(corners, corners + 3, a) + std::count(corners, corners + 3, b) == 2;
    sum += has_both ? 1 / triangles.compliances[t] : 0;
  }
  return sum;
}

TEST_F(FullScene, HasItsBalloonAndTube) {
  const Object& balloon = scene.objects.at(1);
  EXPECT_EQ(balloon.name, "cloth");
  ASSERT_TRUE(balloon.volume.has_value());
  EXPECT_EQ(balloon.volume->pressure, 1.5f);
  EXPECT_EQ(balloon.volume->stiffness.value, 0.0625f);
  EXPECT_EQ(balloon.volume->lift, 1.0625f);
  ASSERT_EQ(balloon.volume->keyframes.size(), 2u);
  EXPECT_EQ(balloon.volume->keyframes[1].time, 2.f);
  EXPECT_EQ(balloon.volume->keyframes[1].pressure, 1.25f);
  EXPECT_EQ(balloon.volume->leak, 0.125f);
  for (const Vec3f& p : balloon.positions) EXPECT_NEAR(length_squared(p), 0.25, 1e-5);
  EXPECT_EQ(balloon.static_friction, fabric("rubber sheet").static_friction);
  const Object& tube = scene.objects.at(2);
  EXPECT_EQ(tube.name, "cloth_2");
  EXPECT_EQ(tube.positions.size(), 48U);
  // The weft runs along the rings: its stretch is that of their edges. No edge lies along the warp of a cone.
  const ConstraintGroup &weft = tube.constraints.at(0), &warp = tube.constraints.at(1), &shear = tube.constraints.at(2);
  ASSERT_EQ(weft.type, "distance");
  ASSERT_EQ(warp.type, "triangle_stretch");
  ASSERT_EQ(shear.type, "triangle_shear");
  EXPECT_EQ(warp.compliances, std::vector<float>(shear.compliances.size(), 0.f));
  EXPECT_EQ(std::vector<float>(warp.rest.begin() + 1, warp.rest.begin() + 3),
            std::vector<float>(shear.rest.begin(), shear.rest.begin() + 2));
  for (std::size_t i = 0; i < weft.compliances.size(); ++i)  // alpha = L^2 / (Y A), of shear 1 / (G A)
    EXPECT_NEAR(300 * weft.compliances[i] * area_at(shear, weft.particles[2 * i], weft.particles[2 * i + 1]),
                40 * weft.rest[i] * weft.rest[i], 1e-5);
  for (const ConstraintGroup& group : tube.constraints) {
    ASSERT_EQ(group.plasticity.has_value(), group.type == "dihedral_bending");
    if (!group.plasticity) continue;
    EXPECT_EQ(group.plasticity->yield, 0.5f);
    EXPECT_EQ(group.plasticity->rate, 2.f);
    EXPECT_EQ(group.plasticity->most, 1.5f);
  }
  EXPECT_EQ(weft.stiffness.value, 0.f);
}

TEST(SceneRead, TakesAnyConstraintTypeTheLibraryHas) {
  for (const ConstraintType& type : constraint_types()) {
    nlohmann::json stencil, positions, frames;
    for (int i = 0; i < type.stencil_size; ++i) {
      stencil.push_back(i);
      positions.push_back({i, i * i, i % 2});
      frames.push_back({{"inertia", {1, 2, 3}}});
    }
    const nlohmann::json constraint{{"type", type.name}, {"particles", {stencil}}};
    const nlohmann::json particles{
        {"positions", positions}, {"masses", 1}, {"frames", frames}, {"constraints", {constraint}}};
    const Scene scene = parse_scene(nlohmann::json{{"objects", {{{"particles", particles}}}}}.dump(), "x.json", ".");
    EXPECT_EQ(scene.objects.at(0).constraints.at(0).type, type.name);
  }
}

TEST(SceneRead, LowersKineticFrictionWithStatic) {
  const Scene scene =
      parse_scene(R"({"objects": [], "colliders": [{"plane": {}, "static_friction": 0.125}]})", "x.json", ".");
  EXPECT_EQ(scene.colliders[0].kinetic_friction, 0.125f);
}

TEST(SceneRead, ReportsWhatWasMendedInAMesh) {
  std::string folder = testing::TempDir() + "/pliant_mend_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  std::ofstream(folder + "/a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n";
  std::ofstream(folder + "/a.json") << R"({"description": "d", "objects": [{"cloth": {"mesh": {"file": "a.obj"}}}]})";
  const SceneFile file = read_scene_file(folder + "/a.json", false);
  EXPECT_EQ(file.description, "d");
  EXPECT_EQ(file.scene.objects.at(0).positions.size(), 3U);
  ASSERT_FALSE(file.repairs.empty());
  EXPECT_EQ(file.repairs[0].compare(0, 22, "object 'cloth', a.obj:"), 0) << file.repairs[0];
  std::filesystem::remove_all(folder);
}

TEST(SceneRead, ReadsEverySceneOfTheProject) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::in_tree("scenes"))) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path());
    const SceneFile file = read_scene_file(entry.path(), false);
    EXPECT_FALSE(file.description.empty());
    EXPECT_FALSE(file.scene.objects.empty());
    EXPECT_TRUE(file.repairs.empty());
    ++scenes;
  }
  EXPECT_GE(scenes, 20);
}

// ---------------------------------------------------------------- shapes

double signed_volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) { return mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
    six += dot(at(0), cross(at(1), at(2)));
  }
  return six / 6;
}

TEST(SceneMesh, TubesAreRoundAndFaceOutwards) {
  const TriangleMesh tube = scene_file::tube_mesh(96, 5, 2, 0.5f, 0.5f, 0, 0);
  ASSERT_EQ(tube.positions.size(), 480U);
  EXPECT_EQ(tube.triangles.size(), 2U * 96 * 4);
  for (const Vec3f& p : tube.positions) EXPECT_NEAR(p.x * p.x + p.z * p.z, 0.25, 1e-6);
  EXPECT_EQ(tube.positions.front().y, 0);
  EXPECT_EQ(tube.positions.back().y, -2);
  // Without caps, the signed volume is two thirds of pi r^2 h. The upper cap contains the origin and would add nothing;
  // the lower one would add the cone to the origin, a third.
  EXPECT_NEAR(signed_volume(tube), 2.0 / 3 * 3.14159265 * 0.25 * 2, 0.003);
}

TEST(SceneMesh, TubesHaveAsManyFoldsAsTold) {
  const TriangleMesh tube = scene_file::tube_mesh(60, 3, 1, 1, 2, 5, 0.25f);
  for (std::size_t c = 0; c < 60; ++c) {
    const auto radius = [&](std::size_t row) {
      return std::hypot(tube.positions[row * 60 + c].x, tube.positions[row * 60 + c].z);
    };
    const double wave = std::cos(2 * 3.14159265358979 * 5 * static_cast<double>(c) / 60);
    EXPECT_NEAR(radius(0), 1, 1e-5);
    EXPECT_NEAR(radius(1), 1.5 * (1 + 0.125 * wave), 1e-5);
    EXPECT_NEAR(radius(2), 2 * (1 + 0.25 * wave), 1e-5);
  }
}

// ---------------------------------------------------------------- documents

TEST(SceneSchema, HoldsEveryFieldWithItsRange) {
  const nlohmann::json schema = nlohmann::json::parse(scene_schema());
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema.at("$defs").size(), scene_file::all_records().size());  // no two records have the same name
  const nlohmann::json& settings = schema.at("$defs").at("settings");
  EXPECT_EQ(settings.at("additionalProperties"), false);
  EXPECT_EQ(settings.at("properties").at("substeps").at("maximum"), 10000);
  EXPECT_EQ(schema.at("$defs").at("sphere").at("properties").at("radius").at("exclusiveMinimum"), 0);
  EXPECT_EQ(schema.at("$defs").at("scene").at("required"), nlohmann::json({"objects"}));
  EXPECT_EQ(schema.at("$defs").at("object").at("oneOf").size(), 11U);
}

TEST(SceneSchema, NamesEveryConstraintType) {
  const nlohmann::json schema = nlohmann::json::parse(scene_schema());
  nlohmann::json names;
  for (const ConstraintType& type : constraint_types()) names.push_back(type.name);
  EXPECT_EQ(schema.at("$defs").at("constraints").at("properties").at("type").at("enum"), names);
}

class SceneDocument : public testing::Test {
 protected:
  const std::string path = test::in_tree("docs/reference/scene-format.md");
  static constexpr const char* begin = "<!-- reference: begin -->\n";
  static constexpr const char* end = "<!-- reference: end -->\n";
};

TEST_F(SceneDocument, HoldsTheReference) {
  std::string text = test::text_of(path);
  const std::size_t from = text.find(begin) + std::string(begin).size(), to = text.find(end);
  ASSERT_NE(to, std::string::npos);
  const std::string reference = "\n" + scene_file::scene_reference();
  if (std::getenv("PLIANT_WRITE_DOCS") != nullptr) std::ofstream(path) << text.replace(from, to - from, reference);
  EXPECT_TRUE(test::text_of(path).find(begin + reference + end) != std::string::npos)
      << "docs/reference/scene-format.md is older than io/scene_grammar.cpp; run this test with PLIANT_WRITE_DOCS=1";
}

TEST_F(SceneDocument, HasExamplesThatRead) {
  const std::string text = test::text_of(path);
  int examples = 0;
  for (std::size_t at = text.find("```json\n"); at != std::string::npos; at = text.find("```json\n", at + 1)) {
    const std::size_t from = at + 8;
    EXPECT_NO_THROW(parse_scene(text.substr(from, text.find("```", from) - from), "example", "."));
    ++examples;
  }
  EXPECT_GE(examples, 2);
}

}  // namespace
}  // namespace pliant
