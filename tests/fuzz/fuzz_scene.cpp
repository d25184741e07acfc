// Fuzzes the scene reader: any bytes must give a scene, or an Error with a position. CMakeLists.txt says how to run it.
//
// Scenes with meshes of many vertices would only make the search slow, so for these the text is checked, but nothing is
// built.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "io/scene_check.h"
#include "io/scene_grammar.h"
#include "io/scene_json.h"
#include "pliant/error.h"
#include "pliant/io.h"

namespace {

using pliant::scene_file::JsonValue;

bool is_large(const JsonValue& at) {
  const bool count = at.key == "columns" || at.key == "rows" || at.key == "points" || at.key == "segments";
  if ((count && at.number > 24) || (at.key == "subdivisions" && at.number > 2)) return true;
  for (const JsonValue& item : at.items)
    if (is_large(item)) return true;
  return false;
}

void require(bool truth) {
  if (!truth) __builtin_trap();
}

void require_sound(const pliant::Scene& scene) {
  for (const pliant::Object& object : scene.objects) {
    require(object.masses.size() == object.positions.size());
    require(object.velocities.empty() || object.velocities.size() == object.positions.size());
    for (const pliant::Vec3f& p : object.positions)
      require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (const pliant::Pin& pin : object.pins) require(pin.particle < static_cast<int>(object.positions.size()));
    require(object.kinetic_friction <= object.static_friction);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto document = pliant::scene_file::parse_json(text, "x");
    pliant::scene_file::check(document, pliant::scene_file::scene_record());
    if (is_large(document.root)) return 0;
    require_sound(pliant::parse_scene(text, "x", "/nonexistent", false));
  } catch (const pliant::Error& error) {
    require(error.where().file == "x" && error.where().line > 0 && error.where().column > 0);
    require(!error.problem().empty());
  }
  return 0;
}
