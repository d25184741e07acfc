// What `inspect` and the first Report say of how stiffly solids bend and yield, against linear finite elements of the
// same mesh, beams and more substeps.
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "pliant/scene.h"
#include "soft_bodies/linear_elements.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The message and advice of the finding that has these words; empty without one.
std::string told(const Scene& scene, const std::string& words) {
  for (const Finding& found : inspect(scene))
    if (found.message.find(words) != std::string::npos) return found.message + "; " + found.advice;
  return {};
}

/// The number after "about"; 0 without one.
double number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? 0 : std::atof(text.c_str() + at + words.size());
}

Object box_of(const Vec3f& size, const std::array<int, 3>& cells, const ElasticSolid& material) {
  SoftBodyOptions options;
  options.name = "bar";
  options.material = material;
  return make_soft_body(box_tetrahedra(size, cells), options);
}

/// A bar of 0.6 m x 0.1 m x 0.1 m along x.
Object slender_bar(int cells, float poisson_ratio) {
  return box_of({0.6f, 0.1f, 0.1f}, {6 * cells, cells, cells}, solid_of(1e5f, poisson_ratio));
}

/// The sag of a beam with shear (Timoshenko) over that of linear elements, clamped at one end under its weight.
double stiffness_over_beam(const Object& bar, double poisson_ratio) {
  std::vector<int> held, tip;
  for (int i = 0; i < static_cast<int>(bar.positions.size()); ++i) {
    const float x = bar.positions[static_cast<std::size_t>(i)].x;
    if (x < -0.299f) held.push_back(i);
    if (x > 0.299f) tip.push_back(i);
  }
  const std::vector<Vec3d> moved = LinearElements(bar).hang({0, -1, 0}, held);
  double sag = 0;
  for (const int i : tip) sag -= moved[static_cast<std::size_t>(i)].y / static_cast<double>(tip.size());
  const double l = 0.6, s = 0.1, load = 1000 * s * s, e = 1e5, nu = poisson_ratio;
  const double bending = load * l * l * l * l / (8 * e * s * s * s * s / 12);
  const double shear = load * l * l / (2 * (10 * (1 + nu) / (12 + 11 * nu)) * e / (2 * (1 + nu)) * s * s);
  return (bending + shear) / sag;
}

double told_bending(const Object& bar) {
  return number_after(told(testing_support::scene_of(bar, 0), "too stiffly"), "bends about ");
}

// Nothing was said of a bar that bends 4.3 times too stiffly.
TEST(ToldStiffness, SaysHowStifflyBarsOfFewCellsBend) {
  for (const float poisson_ratio : {0.3f, 0.45f})
    for (const int cells : {1, 2, 3}) {
      const Object bar = slender_bar(cells, poisson_ratio);
      const double right = stiffness_over_beam(bar, static_cast<double>(poisson_ratio)), found = told_bending(bar);
      EXPECT_NEAR(found / right, 1, 0.13)
          << cells << " cells, " << poisson_ratio << ": " << found << ", right " << right;
    }
}

TEST(ToldStiffness, SaysNothingOfFineCompactAndHeldSolids) {
  EXPECT_EQ(told_bending(slender_bar(4, 0.3f)), 0);
  EXPECT_EQ(told_bending(box_of({0.1f, 0.1f, 0.1f}, {1, 1, 1}, solid_of(1e5f, 0.3f))), 0);
  EXPECT_EQ(told_bending(box_of({0.3f, 0.1f, 0.3f}, {3, 1, 3}, solid_of(1e5f, 0.3f))), 0);
  EXPECT_NEAR(told_bending(box_of({0.8f, 0.1f, 0.8f}, {8, 1, 8}, solid_of(1e5f, 0.3f))), 4.3, 0.1);
  Object held = slender_bar(1, 0.3f);
  for (int i = 0; i < static_cast<int>(held.positions.size()); ++i) held.pins.push_back({i, {}});
  EXPECT_EQ(told_bending(held), 0);
}

TEST(ToldStiffness, LooksAtEachPieceOfASolid) {
  TetrahedralMesh mesh = box_tetrahedra({0.1f, 0.1f, 0.1f}, {1, 1, 1});
  const std::vector<Vec3f> corners = mesh.positions;
  const auto tetrahedra = mesh.tetrahedra;
  for (Vec3f p : corners) {
    p.x += 1;
    mesh.positions.push_back(p);
  }
  for (auto one : tetrahedra) {
    for (int& corner : one) corner += static_cast<int>(corners.size());
    mesh.tetrahedra.push_back(one);
  }
  EXPECT_EQ(told_bending(make_soft_body(mesh, {})), 0) << "two cubes that lie 1 m apart";
}

/// A beam of 0.5 m of softwood, which needs 1656 substeps in a frame of 1/60 s.
Object beam_of_wood() {
  ElasticSolid wood = solid_of(1e9f, 0.3f, 600);
  return box_of({0.5f, 0.05f, 0.05f}, {20, 2, 2}, wood);
}

// Nothing was said of a beam that yields by 15 % more than with enough substeps.
TEST(ToldStiffness, SaysWhereTheMostSubstepsByDefaultAreTooFew) {
  Scene scene = testing_support::scene_of(beam_of_wood(), 0);
  const std::string text = told(scene, "the most by default");
  EXPECT_NE(text.find("are 1000, the most by default, so that 'bar' will yield about 1.1 times as much"),
            std::string::npos)
      << text;
  const double wanted = number_after(text, "\"substeps\": ");
  EXPECT_GT(wanted, 1500);
  World world(scene);
  const Report report = world.step(frame_time);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("the most by default"), std::string::npos) << report.warnings[0];
  scene.settings.substeps = static_cast<int>(wanted);
  EXPECT_EQ(told(scene, "will yield"), "");
  scene.settings.substeps = 0;
  scene.frame_time = 1.f / 240;
  EXPECT_EQ(told(scene, "will yield"), "");
}

/// The mean sag of the last quarter of a second of a bar of 0.3 m, of 2 cells, clamped at one end.
double sag_with(int substeps) {
  Object bar = box_of({0.3f, 0.05f, 0.05f}, {12, 2, 2}, solid_of(2e6f, 0.3f, 1100));
  bar.damping = 8;
  std::vector<int> held;
  std::size_t tip = 0;
  for (std::size_t i = 0; i < bar.positions.size(); ++i) {
    if (bar.positions[i].x < -0.1499f) held.push_back(static_cast<int>(i));
    if (bar.positions[i].x > bar.positions[tip].x) tip = i;
  }
  Scene scene = testing_support::scene_of(std::move(bar), substeps);
  scene.pin(0, held);
  World world(scene);
  run(world, 60);
  double sag = 0;
  for (int frame = 0; frame < 15; ++frame) {
    run(world, 1);
    sag -= static_cast<double>(positions_of(world)[tip].y - scene.objects[0].positions[tip].y) / 15;
  }
  return sag;
}

/// How many times as much `inspect` says that the bar of sag_with yields.
double told_yield(int substeps) {
  const Object bar = box_of({0.3f, 0.05f, 0.05f}, {12, 2, 2}, solid_of(2e6f, 0.3f, 1100));
  return number_after(told(testing_support::scene_of(bar, substeps), "will yield"), "will yield about ");
}

// Needed are 55: 1.14 times was not told, and 1.26 told as 1.1.
TEST(ToldStiffness, PredictsWhatMoreSubstepsChange) {
  const double right = sag_with(80);
  for (const int substeps : {33, 27}) EXPECT_NEAR(told_yield(substeps), sag_with(substeps) / right, 0.07) << substeps;
  EXPECT_LT(sag_with(44) / right, 1.06);
  EXPECT_EQ(told_yield(44), 0) << "need not be told";
}

}  // namespace
}  // namespace pliant
