// Tests the camera of scene files: every field, and what is refused with its place.
#include <gtest/gtest.h>

#include "pliant/error.h"
#include "pliant/io.h"
#include "scene_support.h"

namespace pliant {
namespace {

SceneCamera camera_in(const std::string& camera) {
  return parse_scene_file(R"({"objects": [], "camera": )" + camera + "}", "s.json", ".").camera;
}

TEST(CameraOfAScene, HasEveryField) {
  const SceneCamera camera = parse_scene_file(test::full_scene(), "every_field.json", ".").camera;
  EXPECT_EQ(camera.look_at, (Vec3f{1, 2, 3}));
  EXPECT_EQ(camera.distance, 4);
  EXPECT_EQ(camera.azimuth, 50);
  EXPECT_EQ(camera.elevation, 6);
  EXPECT_EQ(camera.field_of_view, 70);
  EXPECT_FALSE(camera.position);
  EXPECT_EQ(camera_in(R"({"position": [7, 8, 9]})").position, (Vec3f{7, 8, 9}));
  const SceneCamera none = parse_scene_file(R"({"objects": []})", "s.json", ".").camera;
  EXPECT_FALSE(none.look_at || none.position || none.distance || none.azimuth || none.elevation || none.field_of_view);
}

TEST(CameraOfAScene, ChangesNothingOfTheScene) {
  const std::string scene = R"({"objects": [{"rope": {"points": [[0, 0, 0], [1, 0, 0]]}}])";
  EXPECT_EQ(scene_json(parse_scene(scene + R"(, "camera": {"distance": 2}})", "s.json", ".")),
            scene_json(parse_scene(scene + "}", "s.json", ".")));
}

TEST(CameraOfAScene, IsRefusedIfItSeesNothing) {
  const auto says = [](const std::string& camera, const std::string& words) {
    try {
      camera_in(camera);
      ADD_FAILURE() << camera << " is not refused";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << camera << ": " << error.what();
    }
  };
  says(R"({"distance": 0})", "/camera/distance: ");
  says(R"({"fov": 4})", "/camera/fov: ");
  says(R"({"fov": 121})", "/camera/fov: ");
  says(R"({"elevation": 90})", "/camera/elevation: ");
  says(R"({"azimuth": 361})", "/camera/azimuth: ");
  says(R"({"look_at": [0, 0]})", "/camera/look_at: ");
  says(R"({"position": [1, 2, 3], "look_at": [1, 2, 3]})", "/camera/position: is the point that the camera looks at");
  for (const char* other : {R"("distance": 1)", R"("azimuth": 1)", R"("elevation": 1)"})
    says(R"({"position": [1, 2, 3], )" + std::string(other) + "}", "/camera/position: is given beside");
}

}  // namespace
}  // namespace pliant
