// Reads a scene in four steps: parse the JSON, check it against the table of fields, build the scene, reject members
// that were not used.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "pliant/io.h"
#include "scene_build.h"
#include "scene_check.h"
#include "scene_grammar.h"
#include "scene_json.h"

namespace pliant {

namespace {

namespace fs = std::filesystem;

/// A text, the name that stands for its file in errors, and the folder of its paths.
struct SourceText {
  std::string text, name, folder;
};

/// What a text is: the record that it is checked against, and what builds it.
template <class Build>
auto read_as(const scene_file::Record& record, const SourceText& source, const SceneReadOptions& options, Build build) {
  scene_file::JsonDocument document = scene_file::parse_json(source.text, source.name);
  for (const auto& [pointer, value] : options.values) scene_file::set_value(document, pointer, value);
  const scene_file::MeshFolder folder{source.folder, options.allow_outside, options.meshes, &options.arrays};
  scene_file::check(document, record);
  auto built = build(document, folder);
  scene_file::check_all_used(document);
  return built;
}

SceneFile scene_from(const SourceText& source, const SceneReadOptions& options) {
  return read_as(scene_file::scene_record(), source, options,
                 [](const scene_file::JsonDocument& document, const scene_file::MeshFolder& folder) {
                   return scene_file::build(document, folder);
                 });
}

/// Returns the bytes of a regular file. Others are rejected: a pipe may never end, and a device has no size.
std::string text_of(const std::string& path) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (!fs::exists(status))
    throw Error({path, 0, {}, {}}, "the file does not exist",
                "check the path; a relative one starts at the current folder");
  if (!fs::is_regular_file(status)) throw Error({path, 0, {}, {}}, "not a regular file", "name a scene in JSON");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error({path, 0, {}, {}}, "cannot be opened", "check its permissions");
  std::string text;
  std::string block(1 << 16, '\0');
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
    if (text.size() > scene_file::largest_text + 3) break;  // too long, which parse_json reports
  }
  if (stream.bad()) throw Error({path, 0, {}, {}}, "cannot be read");
  return text;
}

}  // namespace

SceneFile read_scene_file(const std::string& path, const SceneReadOptions& options) {
  const std::string folder = fs::path(path).parent_path().string();
  return scene_from({text_of(path), path, folder}, options);
}

SceneFile read_scene_file(const std::string& path, bool allow_outside) {
  return read_scene_file(path, SceneReadOptions{allow_outside, {}, {}, {}});
}

Scene read_scene(const std::string& path, bool allow_outside) { return read_scene_file(path, allow_outside).scene; }

Scene parse_scene(const std::string& text, const std::string& name, const std::string& folder, bool allow_outside) {
  return parse_scene_file(text, name, folder, {allow_outside, {}, {}, {}}).scene;
}

SceneFile parse_scene_file(const std::string& text, const std::string& name, const std::string& folder,
                           const SceneReadOptions& options) {
  return scene_from({text, name, folder}, options);
}

Object parse_object(const std::string& text, const std::string& name, const std::string& folder,
                    const SceneReadOptions& options, std::vector<std::string>* repairs) {
  std::vector<std::string> made;
  Object object = read_as(scene_file::object_record(), {text, name, folder}, options,
                          [&](const scene_file::JsonDocument& document, const scene_file::MeshFolder& at) {
                            return scene_file::build_object(document, at, made);
                          });
  if (repairs != nullptr) *repairs = std::move(made);
  return object;
}

std::variant<Collider, MeshCollider> parse_collider(const std::string& text, const std::string& name,
                                                    const std::string& folder, const SceneReadOptions& options,
                                                    std::vector<std::string>* repairs) {
  std::vector<std::string> made;
  auto collider = read_as(scene_file::collider_record(), {text, name, folder}, options,
                          [&](const scene_file::JsonDocument& document, const scene_file::MeshFolder& at) {
                            return scene_file::build_collider(document, at, made);
                          });
  if (repairs != nullptr) *repairs = std::move(made);
  return collider;
}

}  // namespace pliant
