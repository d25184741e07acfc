// The camera of a scene file: its part of the table, and how it is built.
#include "scene_build.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

void set_point(const JsonValue& at, const char* name, std::optional<Vec3f>& target) {
  Vec3f point;
  if (set(at, name, point)) target = point;
}

}  // namespace

const Record& camera_record() {
  static const Record result{
      "camera",
      "From where pictures show the scene. What is absent is chosen so that the scene fills the picture; options of "
      "`pliant render` override it (docs/reference/command.md).",
      {field("look_at", place(), "the middle of the scene", "The point in the middle of the picture."),
       field("distance", positive("m", largest_place), "so that the scene fits", "From the camera to that point."),
       field("azimuth", number("degree", -360, 360), "28",
             "Angle about the vertical from the front, +z, to the right."),
       field("elevation", number("degree", -89, 89), "18", "Angle above the horizon."),
       field("position", place(), "none", "Of the camera, instead of `distance`, `azimuth` and `elevation`."),
       field("fov", number("degree", 5, 120), "30", "Vertical angle of view.")},
      {}};
  return result;
}

SceneCamera build_camera(const JsonDocument& document, const JsonValue& at) {
  SceneCamera camera;
  set_point(at, "look_at", camera.look_at);
  set_point(at, "position", camera.position);
  set(at, "distance", camera.distance);
  set(at, "azimuth", camera.azimuth);
  set(at, "elevation", camera.elevation);
  set(at, "fov", camera.field_of_view);
  if (!camera.position) return camera;
  const JsonValue& position = *at.find("position");
  if (camera.distance || camera.azimuth || camera.elevation)
    document.fail_key(position, "is given beside a distance, azimuth or elevation", "give the position or these");
  if (camera.look_at && *camera.look_at == *camera.position)
    document.fail(position, "is the point that the camera looks at", "give another position or `look_at`");
  return camera;
}

}  // namespace pliant::scene_file
