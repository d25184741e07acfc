// A whole Scene as JSON text, and back: every particle and constraint, as save_fields.h lists them.
#include <fmt/format.h>

#include "io/save_file.h"
#include "io/scene_check.h"
#include "io/text_archive.h"
#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant {

namespace {

constexpr std::string_view format_name = "pliant_scene";

}  // namespace

std::string scene_json(const Scene& scene) {
  if (!scene.forces.empty())
    throw Error({}, "the scene has force fields, which are functions and cannot be written",
                "take them out, and add them again to the scene that is read");
  std::string text;
  save_file::TextOutput out(text);
  out.open('{');
  out(format_name.data(), save_file::version);
  fields(out, scene);
  out("settings", scene.settings);
  out.close('}');
  return text + "\n";
}

Scene scene_from_json(const std::string& text, const std::string& name) {
  constexpr std::size_t most = 4 * scene_file::largest_text;
  if (text.size() > most)
    throw Error({.file = name}, fmt::format("is longer than {} MiB", most >> 20), "save the World instead, by save()");
  const scene_file::JsonDocument document = scene_file::parse_json(text, name, most);
  const scene_file::JsonValue& root = document.root;
  if (root.kind != scene_file::JsonValue::Kind::object || root.find(format_name.data()) == nullptr)
    document.fail(root, "is not a scene that scene_json() wrote",
                  "read a scene file with read_scene() or parse_scene()");
  std::uint32_t found = 0;
  Scene scene;
  save_file::TextInput in(document, root);
  in(format_name.data(), found);
  if (found != save_file::version)
    document.fail(*root.find(format_name.data()),
                  fmt::format("is version {}, and this Pliant reads version {}", found, save_file::version),
                  "use the Pliant that wrote it");
  fields(in, scene);
  in("settings", scene.settings);
  scene_file::check_all_used(document);
  return scene;
}

}  // namespace pliant
