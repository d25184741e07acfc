// Measures pictures instead of comparing them with stored ones: a driver may round differently, but a sphere covers
// what it covers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "render/render.h"

namespace pliant::render {
namespace {

constexpr int width = 320, height = 240;

/// A renderer; null if this machine has no OpenGL, and then `why` says so.
std::unique_ptr<Renderer> make_renderer(std::string& why) {
  try {
    return std::make_unique<Renderer>(width, height);
  } catch (const Error& error) {
    why = error.what();
    return nullptr;
  }
}

/// Base of all tests that draw. On a machine without OpenGL they are skipped, with the reason.
class Picture : public testing::Test {
 protected:
  void SetUp() override {
    std::string why;
    renderer = make_renderer(why);
    if (!renderer) GTEST_SKIP() << why;
  }

  struct Pixel {
    int r, g, b;
    int brightness() const { return r + g + b; }
  };
  static Pixel at(const std::vector<std::uint8_t>& picture, int x, int y) {
    const std::size_t i = (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 3;
    return {picture[i], picture[i + 1], picture[i + 2]};
  }

  /// The number of pixels in which two pictures differ.
  static int different(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int count = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Pixel p = at(a, x, y), q = at(b, x, y);
        count += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b) > 24;
      }
    }
    return count;
  }

  /// A camera that looks along -z at the origin; there, 1 m is `pixels_per_metre` pixels high.
  static Camera straight(float distance = 4) { return {{0, 0, distance}, {}, 40}; }
  static float pixels_per_metre(float distance = 4) {
    return height / (2 * distance * std::tan(20 * 3.14159265f / 180));
  }

  std::unique_ptr<Renderer> renderer;
};

RenderMesh square(float half, Vec3f centre, Vec3f colour) {
  return {{centre + Vec3f{-half, -half, 0}, centre + Vec3f{half, -half, 0}, centre + Vec3f{half, half, 0},
           centre + Vec3f{-half, half, 0}},
          {{0, 1, 2}, {0, 2, 3}},
          colour};
}

RenderScene with_sphere(float radius) {
  RenderScene scene;
  scene.ground.reset();
  scene.colliders.push_back({Sphere{radius}, {}, {}, {0.8f, 0.1f, 0.1f}});
  return scene;
}

RenderBody box_body(const Vec3f& position, const Quatf& turn) {
  const TriangleMesh mesh = mesh_of({{Box{{0.4f, 0.4f, 0.4f}}}});
  return {std::make_shared<const TriangleMesh>(mesh), {position, turn}, {0.8f, 0.1f, 0.1f}};
}

TEST_F(Picture, OfABodyIsThatOfItsSolidInItsPose) {
  RenderScene body, solid, elsewhere;
  for (RenderScene* scene : {&body, &solid, &elsewhere}) {
    scene->ground.reset();
    scene->camera = straight();
    scene->extent = Extent{{}, 1};
  }
  const Quatf turn = rotation({0, 0, 1}, 45);
  body.bodies.push_back(box_body({0.2f, 0, 0}, turn));
  elsewhere.bodies.push_back(box_body({}, {}));
  solid.colliders.push_back({Box{{0.4f, 0.4f, 0.4f}}, {0.2f, 0, 0}, turn, {0.8f, 0.1f, 0.1f}});
  const auto picture = renderer->draw(body);
  EXPECT_LT(different(picture, renderer->draw(solid)), 20);
  EXPECT_GT(different(picture, renderer->draw(elsewhere)), 500);
}

TEST_F(Picture, FramesBodiesButNotHugeFixedOnes) {
  RenderScene scene;
  scene.bodies.push_back(box_body({0, 5, 0}, {}));
  const Extent one = extent_of({scene});
  EXPECT_NEAR(one.centre.y, 5, 1e-5);
  EXPECT_NEAR(one.radius, 0.4f * std::sqrt(3.f), 1e-4);
  RenderBody floor = box_body({}, {});
  TriangleMesh slab = mesh_of({{Box{{50, 1, 50}}}});
  floor.mesh = std::make_shared<const TriangleMesh>(slab);
  floor.is_fixed = true;
  scene.bodies.push_back(floor);
  EXPECT_NEAR(extent_of({scene}).radius, one.radius, 1e-5);
  scene.bodies[1].is_fixed = false;
  EXPECT_GT(extent_of({scene}).radius, 50);
}

TEST_F(Picture, RefusesBodiesThatCannotBeDrawn) {
  RenderScene scene;
  scene.bodies.push_back({});
  EXPECT_THROW(renderer->draw(scene), Error) << "no mesh";
  scene.bodies[0] = box_body({std::nanf(""), 0, 0}, {});
  EXPECT_THROW(renderer->draw(scene), Error) << "not finite";
}

TEST_F(Picture, OfASphereCoversItsDisc) {
  RenderScene scene = with_sphere(0.5f);
  scene.camera = straight();
  RenderScene empty = scene;
  empty.colliders.clear();
  const int covered = different(renderer->draw(scene), renderer->draw(empty));
  // The visible disc of a sphere at distance d is that of its tangent cone: tan = r / sqrt(d^2 - r^2).
  const float pixels = 0.5f / std::sqrt(16 - 0.25f) * 4 * pixels_per_metre();
  const float expected = 3.14159265f * pixels * pixels;
  EXPECT_NEAR(static_cast<float>(covered), expected, 0.03f * expected);
}

TEST_F(Picture, OfAMeshSphereCoversTheSame) {
  RenderScene collider = with_sphere(0.5f), mesh;
  collider.camera = mesh.camera = straight();
  mesh.ground.reset();
  const TriangleMesh ball = sphere_mesh(4);
  RenderMesh half{ball.positions, ball.triangles, {0.8f, 0.1f, 0.1f}};
  for (Vec3f& p : half.positions) p = p * 0.5f;
  mesh.meshes.push_back(half);
  RenderScene empty;
  empty.ground.reset();
  empty.camera = straight();
  const auto nothing = renderer->draw(empty);
  const int a = different(renderer->draw(collider), nothing), b = different(renderer->draw(mesh), nothing);
  EXPECT_NEAR(a, b, 0.03 * a);
}

TEST_F(Picture, OfABoxACapsuleAndATubeCoversWhatTheyMeasure) {
  RenderScene empty;
  empty.ground.reset();
  empty.camera = straight(40);
  empty.camera->field_of_view = 5;
  const float metre = height / (2 * 40 * std::tan(2.5f * 3.14159265f / 180));
  const auto nothing = renderer->draw(empty);
  RenderScene box = empty, capsule = empty, tube = empty;
  box.colliders.push_back({Box{{0.6f, 0.4f, 0.05f}}, {}, {}, {0.1f, 0.1f, 0.8f}});
  capsule.colliders.push_back({Capsule{0.2f, 0.5f}, {}, {}, {0.1f, 0.1f, 0.8f}});
  tube.tubes.push_back({{{-0.5f, 0, 0}, {0, 0, 0}, {0.5f, 0, 0}}, 0.2f, {0.1f, 0.1f, 0.8f}});
  constexpr float round = 3.14159265f * 0.2f * 0.2f;
  const auto expect_area = [&](const RenderScene& scene, float area, const char* what) {
    const auto covered = static_cast<float>(different(renderer->draw(scene), nothing));
    EXPECT_NEAR(covered / (metre * metre), area, 0.05f * area) << what;
  };
  expect_area(box, 1.2f * 0.8f, "box");
  expect_area(capsule, 0.4f + round, "capsule");
  expect_area(tube, 0.4f + round, "tube");
}

TEST_F(Picture, OfBallsIsThatOfSpheres) {
  RenderScene empty;
  empty.ground.reset();
  empty.camera = straight();
  RenderScene balls = empty, spheres = empty;
  const std::vector<Vec3f> centres{{-0.4f, 0, 0}, {0.1f, 0.3f, -0.2f}, {0.3f, -0.3f, 0.1f}};
  balls.balls.push_back({centres, 0.2f, {0.1f, 0.1f, 0.8f}});
  for (const Vec3f& centre : centres) spheres.colliders.push_back({Sphere{0.2f}, centre, {}, {0.1f, 0.1f, 0.8f}});
  const auto nothing = renderer->draw(empty);
  const int a = different(renderer->draw(balls), nothing), b = different(renderer->draw(spheres), nothing);
  EXPECT_NEAR(a, b, 0.03 * b);
}

/// A grey wall behind the place at which the camera looks.
RenderScene grey_wall(const Camera& camera) {
  RenderScene scene;
  scene.ground.reset();
  scene.camera = camera;
  scene.extent = Extent{{}, 1};
  scene.meshes.push_back(square(0.9f, {0, 0, -0.8f}, {0.8f, 0.8f, 0.8f}));
  return scene;
}

/// An ellipsoid of blue liquid.
RenderMesh blue_liquid(const Vec3f& half, const Vec3f& centre = {}, float clarity = 0) {
  const TriangleMesh ball = sphere_mesh(4);
  RenderMesh liquid{.positions = ball.positions,
                    .triangles = ball.triangles,
                    .colour = {0.1f, 0.3f, 0.6f},
                    .is_liquid = true,
                    .clarity = clarity};
  for (Vec3f& p : liquid.positions) p = Vec3f{p.x * half.x, p.y * half.y, p.z * half.z} + centre;
  return liquid;
}

TEST_F(Picture, OfALiquidIsClearWhereItIsThinAndColouredWhereItIsThick) {
  const RenderScene bare = grey_wall(straight());
  const auto with_ball = [&](float radius) {
    RenderScene scene = bare;
    scene.meshes.push_back(blue_liquid({0.6f, 0.6f, radius}));
    return scene;
  };
  const auto middle = [&](const RenderScene& scene) { return at(renderer->draw(scene), width / 2, height / 2); };
  const Pixel without = middle(bare), thin = middle(with_ball(0.005f)), thick = middle(with_ball(0.6f));
  EXPECT_LT(std::abs(thin.r - without.r) + std::abs(thin.b - without.b), 30) << "a centimetre is clear";
  EXPECT_LT(thick.r, without.r - 80);
  EXPECT_GT(thick.b - thick.r, thin.b - thin.r + 40);
  RenderScene hidden = with_ball(0.6f), front = bare;
  for (RenderScene* scene : {&hidden, &front}) scene->meshes.push_back(square(0.3f, {0, 0, 0.8f}, {0.7f, 0.1f, 0.1f}));
  EXPECT_EQ(middle(hidden).brightness(), middle(front).brightness());
}

TEST_F(Picture, OfALiquidHasItsShadowByItsClarity) {
  const RenderScene bare = grey_wall(straight());
  const Vec3f toward_the_sun{-0.64f, 0.73f, -0.56f};  // of the wall's middle
  const auto middle = [&](const RenderScene& scene) { return at(renderer->draw(scene), width / 2, height / 2); };
  const auto shaded = [&](float clarity) {
    RenderScene scene = bare;
    scene.meshes.push_back(blue_liquid({0.25f, 0.25f, 0.25f}, toward_the_sun, clarity));
    return middle(scene);
  };
  RenderScene opaque = bare;
  opaque.colliders.push_back({Sphere{0.25f}, toward_the_sun, {}, {0.1f, 0.3f, 0.6f}});
  const Pixel sunny = middle(bare), clear = shaded(100), tinted = shaded(1.5f), usual = shaded(0), dark = shaded(0.05f);
  EXPECT_LT(clear.r, sunny.r - 5);
  EXPECT_LT(usual.r, clear.r - 10);
  EXPECT_GT(usual.b - usual.r, clear.b - clear.r + 5) << "the light that is left has the liquid's colour";
  EXPECT_LT(dark.r, usual.r);
  EXPECT_LT(dark.r, tinted.r - 20);
  const Pixel shadow = middle(opaque);
  EXPECT_NEAR(dark.r, shadow.r, 4) << "what absorbs all has the shadow of a solid";
  EXPECT_NEAR(dark.b, shadow.b, 4);
}

TEST_F(Picture, OfJellyIsClearWhereItIsThinAndSunlitWithin) {
  const RenderScene bare = grey_wall(straight());
  const auto with_ball = [&](float depth, float clarity) {
    RenderScene scene = bare;
    scene.meshes.push_back(blue_liquid({0.6f, 0.6f, depth}, {}, clarity));
    scene.meshes.back().is_liquid = false;
    return scene;
  };
  const auto drawn = [&](float depth, float clarity) { return renderer->draw(with_ball(depth, clarity)); };
  const Pixel wall = at(renderer->draw(bare), width / 2, height / 2);
  const auto thin = drawn(0.005f, 0.2f), thick = drawn(0.5f, 0.2f), opaque = drawn(0.5f, 0);
  EXPECT_LT(wall.r - at(thin, width / 2, height / 2).r, 60) << "the wall is seen through it";
  EXPECT_LT(at(thick, width / 2, height / 2).r, wall.r - 80);
  EXPECT_LT(at(thick, width / 2, height / 2).r, at(thick, width / 2, height / 2).b - 40) << "it has its colour";
  // The side away from the sun, right and below, is lit through the ball.
  const int x = width / 2 + 22, y = height / 2 + 18;
  EXPECT_GT(at(thick, x, y).brightness(), at(opaque, x, y).brightness() + 40);
}

TEST_F(Picture, OfGrainsIsUnevenWithVariousTones) {
  RenderScene balls;
  balls.ground.reset();
  balls.camera = straight();
  balls.balls.push_back({{{-0.4f, 0, 0}, {0.4f, 0, 0}}, 0.3f, {0.6f, 0.5f, 0.3f}});
  RenderScene grains = balls;
  grains.balls[0].are_grains = true;
  const auto brightness_of = [&](const std::vector<std::uint8_t>& picture, int middle) {
    int sum = 0;
    for (int y = height / 2 - 10; y < height / 2 + 10; ++y)
      for (int x = middle - 10; x < middle + 10; ++x) sum += at(picture, x, y).brightness();
    return sum / 400;
  };
  const auto even = renderer->draw(balls), uneven = renderer->draw(grains);
  // The sun lights both alike, but for the place in the picture.
  const auto apart = [&](const auto& picture) {
    return brightness_of(picture, width / 2 - 33) - brightness_of(picture, width / 2 + 33);
  };
  EXPECT_GT(std::abs(apart(uneven) - apart(even)), 25);
  EXPECT_EQ(uneven, renderer->draw(grains)) << "their tones are the same in each picture of a movie";
}

TEST_F(Picture, OfASheetWithChecksHasDarkerStripes) {
  RenderScene plain;
  plain.ground.reset();
  plain.camera = straight();
  plain.meshes.push_back(square(0.8f, {}, {0.8f, 0.1f, 0.1f}));
  RenderScene checked = plain;
  for (const Vec3f& p : plain.meshes[0].positions) checked.meshes[0].checks.push_back({3 * p.x, 3 * p.y});
  const auto a = renderer->draw(plain), b = renderer->draw(checked);
  int darker = 0, brighter = 0;
  for (int x = 0; x < width; ++x) {
    darker += at(b, x, height / 2 + 3).r < at(a, x, height / 2 + 3).r - 3;
    brighter += at(b, x, height / 2 + 3).r > at(a, x, height / 2 + 3).r + 2;
  }
  EXPECT_GT(darker, 10);
  EXPECT_LT(darker, 60) << "a fifth of the sheet";
  EXPECT_EQ(brighter, 0);
}

TEST_F(Picture, LeavesOutAWallBetweenTheCameraAndWhatItHolds) {
  const float half = std::sqrt(0.5f);
  RenderScene bare = with_sphere(0.5f), front = bare, back = bare;
  bare.camera = front.camera = back.camera = straight();
  front.colliders.push_back(
      {Plane{}, {0, 0, 0.6f}, {-half, 0, 0, half}, {0.1f, 0.5f, 0.1f}});  // faces -z, the camera looks there
  back.colliders.push_back({Plane{}, {0, 0, -0.6f}, {half, 0, 0, half}, {0.1f, 0.5f, 0.1f}});
  const auto without = renderer->draw(bare);
  EXPECT_EQ(renderer->draw(front), without);
  EXPECT_GT(different(renderer->draw(back), without), width * height / 10);
}

TEST_F(Picture, OfOneSceneIsTheSameTwice) {
  RenderScene scene = with_sphere(0.5f);
  scene.ground = -0.5f;
  scene.meshes.push_back(square(0.7f, {0.5f, 0.2f, -0.3f}, {0.2f, 0.6f, 0.3f}));
  const auto first = renderer->draw(scene);
  renderer->draw(with_sphere(1));
  EXPECT_EQ(first, renderer->draw(scene));
  std::string why;
  EXPECT_EQ(first, make_renderer(why)->draw(scene));
}

TEST_F(Picture, HasShadowsOnTheGround) {
  RenderScene scene;
  scene.camera = Camera{{0, 6, 0.01f}, {}, 40};  // from above: left is -x, up is -z
  RenderScene lit = scene;
  scene.colliders.push_back({Sphere{0.4f}, {0, 1.2f, 0}, {}, {0.5f, 0.5f, 0.5f}});
  lit.colliders.push_back({Sphere{0.01f}, {0, 1.2f, 0}, {}, {0.5f, 0.5f, 0.5f}});
  const auto shaded = renderer->draw(scene), bare = renderer->draw(lit);
  int darker = 0, brighter = 0, left = 0, right = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float from_sphere = std::hypot(static_cast<float>(x) - width / 2.f, static_cast<float>(y) - height / 2.f);
      if (from_sphere < 35) continue;  // the sphere itself, and the ground from which it hides the sky
      const int change = at(shaded, x, y).brightness() - at(bare, x, y).brightness();
      darker += change < -90;
      brighter += change > 30;
      (x < width / 2 ? left : right) += change < -90;
    }
  }
  EXPECT_GT(darker, 300);
  EXPECT_EQ(brighter, 0);
  EXPECT_GT(right, 10 * left) << "the sun stands left of the viewer";
}

TEST_F(Picture, ShowsClothFromBothSidesAndTheBackDuller) {
  RenderScene front, back;
  front.ground.reset();
  front.camera = straight();
  front.meshes.push_back(square(0.8f, {}, {0.8f, 0.1f, 0.1f}));
  back = front;
  for (auto& triangle : back.meshes[0].triangles) std::swap(triangle[1], triangle[2]);
  const Pixel a = at(renderer->draw(front), width / 2, height / 2), b = at(renderer->draw(back), width / 2, height / 2);
  EXPECT_GT(a.r, b.r + 8);
  EXPECT_GT(4 * b.r, 3 * a.r) << "the back is lit as the front is";
  EXPECT_GT(b.r, b.g + 40) << "the back keeps the cloth's colour";
}

TEST_F(Picture, HidesWhatIsBehind) {
  RenderScene scene;
  scene.ground.reset();
  scene.camera = straight();
  scene.meshes = {square(0.5f, {0, 0, 0.5f}, {0.9f, 0, 0}), square(0.5f, {}, {0, 0.9f, 0})};
  const Pixel near_first = at(renderer->draw(scene), width / 2, height / 2);
  std::swap(scene.meshes[0], scene.meshes[1]);
  const Pixel near_last = at(renderer->draw(scene), width / 2, height / 2);
  for (const Pixel& pixel : {near_first, near_last}) EXPECT_GT(pixel.r, pixel.g + 60);
}

TEST_F(Picture, ShowsTheFrontWhereTwoLayersLieInOnePlace) {
  RenderScene scene;
  scene.ground.reset();
  scene.camera = Camera{{1, 1, 4}, {}, 40};
  scene.meshes.push_back(square(0.8f, {}, {0.8f, 0.1f, 0.1f}));
  const auto single = renderer->draw(scene);
  RenderMesh layer = square(0.8f, {}, {0.8f, 0.1f, 0.1f});
  layer.triangles = {{0, 3, 1}, {1, 3, 2}};  // wound the other way, and divided along the other diagonal
  scene.meshes.insert(scene.meshes.begin(), layer);
  EXPECT_EQ(different(renderer->draw(scene), single), 0);
}

TEST_F(Picture, ShowsWhatLiesFlatOnTheGround) {
  RenderScene scene;
  scene.meshes.push_back({{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}, {{0, 1, 2}}, {0.9f, 0.1f, 0.1f}});
  const auto picture = renderer->draw(scene);
  int red = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) red += at(picture, x, y).r > at(picture, x, y).g + 60;
  EXPECT_GT(red, width * height / 20);
}

// The centre of a pixel at the lower edge of a box is beneath the box, where the ground is dark.
TEST_F(Picture, HasNoDarkDashesBeneathABoxOnTheGround) {
  RenderScene scene;
  scene.camera = Camera{{1.5f, 1.2f, 5}, {0, 0.2f, 0}, 30};
  scene.extent = Extent{{0, 0.2f, 0}, 4};
  scene.colliders.push_back({Box{{2, 0.2f, 0.2f}}, {0, 0.2f, 0}, {}, {0.8f, 0.6f, 0.4f}});
  const auto picture = renderer->draw(scene);
  int darkest = 765;
  for (int y = height / 3; y < height; ++y)
    for (int x = width / 4; x < 3 * width / 4; ++x) darkest = std::min(darkest, at(picture, x, y).brightness());
  EXPECT_GT(darkest, 300);
}

// If a pixel's centre is outside the triangle that it shows, its position in the shadow map is wrong.
TEST_F(Picture, OfAWavySheetInTheSunHasNoSpecks) {
  RenderScene scene;
  const TriangleMesh grid = grid_mesh(17, 17, 1, 1);
  RenderMesh sheet{grid.positions, grid.triangles, {0.6f, 0.6f, 0.58f}, false};
  for (Vec3f& p : sheet.positions) p.y = 0.3f + 0.04f * std::sin(7 * p.x + 2 * p.z) * std::sin(9 * p.z);
  scene.meshes.push_back(sheet);
  scene.camera = Camera{{1.2f, 1.4f, 3}, {0, 0.3f, 0}, 40};
  const auto picture = renderer->draw(scene);
  int specks = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const int around = std::min({at(picture, x - 1, y).brightness(), at(picture, x + 1, y).brightness(),
                                   at(picture, x, y - 1).brightness(), at(picture, x, y + 1).brightness()});
      specks += at(picture, x, y).brightness() < around - 30;
    }
  }
  EXPECT_LE(specks, 2);
}

/// A cube of half size 0.5 with one vertex for each corner, turned so that a straight camera sees three faces.
RenderMesh turned_cube() {
  const Quatf turn{0.3f, 0.4f, 0, 0.8660254f};
  RenderMesh cube;
  for (const float x : {-0.5f, 0.5f})
    for (const float y : {-0.5f, 0.5f})
      for (const float z : {-0.5f, 0.5f}) cube.positions.push_back(rotate(turn, Vec3f{x, y, z}));
  cube.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return cube;
}

TEST_F(Picture, OfACubeWithCreasesHasFacesOfOneShade) {
  RenderScene scene;
  scene.ground.reset();
  scene.camera = straight();
  scene.meshes.push_back(turned_cube());
  const auto most_of_one_shade = [&] {
    const std::vector<std::uint8_t> picture = renderer->draw(scene);
    std::map<int, int> counts;
    for (int y = height / 2 - 25; y < height / 2 + 25; ++y)
      for (int x = width / 2 - 25; x < width / 2 + 25; ++x) ++counts[at(picture, x, y).brightness() / 16];
    int most = 0;
    for (const auto& [shade, count] : counts) most = std::max(most, count);
    return most;
  };
  const int smooth = most_of_one_shade();
  scene.meshes[0].creased = scene.meshes[0].positions;
  const int creased = most_of_one_shade();
  EXPECT_GT(creased, 2 * smooth) << "of 2 500 pixels";
  scene.meshes[0].creased.pop_back();
  EXPECT_THROW(renderer->draw(scene), Error) << "too few";
}

TEST_F(Picture, OfADraftIsNearlyTheSame) {
  RenderScene scene = with_sphere(0.5f);
  scene.camera = straight();
  Renderer draft(width, height, Quality::draft);
  EXPECT_LT(different(renderer->draw(scene), draft.draw(scene)), 600) << "of 76 800 pixels, at the edge and in shadow";
}

TEST_F(Picture, OfAnEmptySceneIsSkyAndGround) {
  const auto picture = renderer->draw({});
  ASSERT_EQ(picture.size(), std::size_t{3} * width * height);
  EXPECT_GT(at(picture, width / 2, 2).b, at(picture, width / 2, height - 2).b);
}

/// A skirt that opens makes the body below it a point of interest, and the picture's extent jumps. Only what is out of
/// sight differs here, so the ground with its grid, haze and shadows must not.
TEST_F(Picture, KeepsTheGroundInAMovieWhateverItsExtent) {
  std::vector<RenderScene> frames(2);
  for (std::size_t i = 0; i < 2; ++i) {
    frames[i].camera = Camera{{0, 1, 3}, {}, 40};
    frames[i].meshes.push_back(square(i == 0 ? 0.1f : 1.f, {0, 50, 0}, {}));
  }
  ASSERT_GT(different(renderer->draw(frames[0]), renderer->draw(frames[1])), 1000) << "extents of their own";
  const Extent extent = extent_of(frames);
  for (RenderScene& frame : frames) frame.extent = extent;
  EXPECT_EQ(different(renderer->draw(frames[0]), renderer->draw(frames[1])), 0);
}

TEST_F(Picture, RefusesWhatItCannotDraw) {
  RenderScene scene;
  scene.meshes.push_back(square(1, {}, {}));
  scene.meshes[0].triangles.push_back({0, 1, 4});
  EXPECT_THROW(renderer->draw(scene), Error);
  scene.meshes[0].triangles.back() = {0, 1, -1};
  EXPECT_THROW(renderer->draw(scene), Error);
  scene.meshes[0].triangles.pop_back();
  scene.meshes[0].positions[0].x = NAN;
  EXPECT_THROW(renderer->draw(scene), Error);
  EXPECT_THROW(Renderer(8, 100), Error);
  EXPECT_THROW(Renderer(100, 100000), Error);
}

TEST(FrameCamera, HasEveryPointInThePicture) {
  for (const float azimuth : {-120.f, 0.f, 28.f, 90.f}) {
    for (const float elevation : {-80.f, 0.f, 18.f, 89.f}) {
      RenderScene scene = with_sphere(0.5f);
      scene.meshes.push_back(square(0.3f, {2, 1, -3}, {}));
      const Camera camera = frame_camera({scene}, 300, 200, {.azimuth = azimuth, .elevation = elevation});
      const Vec3f forward = camera.target - camera.eye;
      const float distance = std::sqrt(length_squared(forward));
      const Vec3f ahead = forward * (1 / distance);
      Vec3f right = cross(ahead, Vec3f{0, 1, 0});
      right = right * (1 / std::sqrt(length_squared(right)));
      const Vec3f up = cross(right, ahead);
      const float slope = std::tan(camera.field_of_view / 2 * 3.14159265f / 180);
      float widest = 0;
      for (const Vec3f& point : scene.meshes[0].positions) {
        const Vec3f way = point - camera.eye;
        const float depth = dot(way, ahead);
        widest = std::max(
            {widest, std::abs(dot(way, right)) / depth / (1.5f * slope), std::abs(dot(way, up)) / depth / slope});
        EXPECT_GT(depth, 0);
      }
      EXPECT_LT(widest, 0.95f) << azimuth << ", " << elevation;
      EXPECT_GT(distance, 1);
    }
  }
}

TEST(FrameCamera, StaysNearForOneAndMovesBackForTwo) {
  RenderScene one = with_sphere(0.5f), two = with_sphere(0.5f);
  two.colliders[0].position = {4, 0, 0};
  const auto distance = [](const Camera& c) { return std::sqrt(length_squared(c.eye - c.target)); };
  EXPECT_GT(distance(frame_camera({one, two}, 100, 100)), 2 * distance(frame_camera({one}, 100, 100)));
  EXPECT_TRUE(std::isfinite(distance(frame_camera({}, 100, 100))));
}

TEST(Extent, ContainsTheScenesTogether) {
  RenderScene one = with_sphere(0.5f), two = with_sphere(0.5f);
  two.colliders[0].position = {4, 0, 0};
  const Extent extent = extent_of({one, two});
  EXPECT_NEAR(length_squared(extent.centre - Vec3f{2, 0, 0}), 0, 1e-9f);
  EXPECT_NEAR(extent.radius, std::sqrt(2.5f * 2.5f + 2 * 0.5f * 0.5f), 1e-4f);
  EXPECT_GT(extent_of({}).radius, 0);
}

}  // namespace
}  // namespace pliant::render
