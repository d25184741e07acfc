// Scenes: reading, adding and setting.
#include <filesystem>

#include "arrays.h"
#include "memory.h"
#include "scene_handle.h"

namespace pliant::c {

namespace {

std::string text_or(const char* text, const char* otherwise) { return text == nullptr ? otherwise : text; }

/// The options of the library. Those of a later version of the header are refused if they ask for something.
SceneReadOptions options_of(const pliant_scene_options* given) {
  SceneReadOptions options;
  if (given == nullptr) return options;
  require_size(given->size, sizeof(pliant_scene_options), "options");
  const char* all = reinterpret_cast<const char*>(given);
  if (std::any_of(all + sizeof(pliant_scene_options), all + given->size, [](char byte) { return byte != 0; }))
    throw StatusError(PLIANT_REFUSED, "'options' asks for something that this version of the library lacks",
                      "use the header of the library");
  options.allow_outside = given->refuse_outside == 0;
  options.arrays = arrays_of(given->arrays, given->array_count);
  if (given->value_count > 0) require(given->values, "values");
  options.values.reserve(given->value_count);
  for (size_t i = 0; i < given->value_count; ++i) {
    require(given->values[i].pointer, "pointer");
    require(given->values[i].json, "json");
    options.values.emplace_back(given->values[i].pointer, given->values[i].json);
  }
  return options;
}

std::shared_ptr<SceneHandle> scene_from(std::function<SceneFile(const SceneReadOptions&)> source, std::string folder,
                                        SceneReadOptions options) {
  auto made = std::make_shared<SceneHandle>();
  made->folder = std::move(folder);
  made->source = std::move(source);
  made->options = std::move(options);
  read_again(*made);
  return made;
}

/// True if an object has to be read together with the rest of the scene: a fill leaves out the solids around it.
bool depends_on_others(const std::string& json) { return json.find("\"fill\"") != std::string::npos; }

/// While it lives, the scene's options have no values to set: those are of the whole scene, not of a part of it.
class WithoutValues {
 public:
  explicit WithoutValues(SceneReadOptions& options) : options_(options) { values_.swap(options.values); }
  ~WithoutValues() { values_.swap(options_.values); }
  WithoutValues(const WithoutValues&) = delete;
  WithoutValues& operator=(const WithoutValues&) = delete;

 private:
  SceneReadOptions& options_;
  std::vector<std::pair<std::string, std::string>> values_;
};

/// Reads an object or collider with the arrays of the scene.
template <class Parse>
auto parse_part(SceneHandle& scene, const Parse& parse, const std::string& json, const char* name,
                std::vector<std::string>& repairs) {
  const WithoutValues without(scene.options);
  return parse(json, name, scene.folder, scene.options, &repairs);
}

/// Adds to a scene by `add`, and keeps the text for the next reading. If that throws, the scene is as it was.
template <class Add>
pliant_id add_to(SceneHandle& scene, const std::pair<const char*, const char*>& value, SceneArrays&& arrays,
                 const Add& add) {
  const std::vector<std::string> added = add_arrays(scene.options.arrays, std::move(arrays));
  const size_t values = scene.options.values.size();
  try {
    scene.options.values.emplace_back(value.first, value.second);
    const pliant_id id = add(scene, value.second);
    scene.findings.clear();
    return id;
  } catch (...) {
    scene.options.values.resize(values);
    remove_arrays(scene.options.arrays, added);
    throw;
  }
}

pliant_id add_object(SceneHandle& scene, const std::string& json) {
  std::vector<std::string> repairs;
  Object object = parse_part(scene, parse_object, json, "object", repairs);
  if (scene.source && depends_on_others(json)) {
    read_again(scene);
    return {PLIANT_OBJECT, static_cast<std::int32_t>(scene.scene.objects.size()) - 1, 0};
  }
  scene.notes.insert(scene.notes.end(), repairs.begin(), repairs.end());
  return {PLIANT_OBJECT, scene.scene.add(std::move(object)), 0};
}

pliant_id add_collider(SceneHandle& scene, const std::string& json) {
  std::vector<std::string> repairs;
  auto collider = parse_part(scene, parse_collider, json, "collider", repairs);
  scene.notes.insert(scene.notes.end(), repairs.begin(), repairs.end());
  if (auto* primitive = std::get_if<Collider>(&collider))
    return {PLIANT_COLLIDER, scene.scene.add(std::move(*primitive)), 0};
  return {PLIANT_MESH_COLLIDER, scene.scene.add(std::get<MeshCollider>(std::move(collider))), 0};
}

/// The body of pliant_scene_add_object and _collider. `value` is a JSON pointer and the JSON to add there.
template <class Add>
pliant_status add_by_handle(pliant_scene* scene, const std::pair<const char*, const char*>& value,
                            const std::pair<const pliant_array*, size_t>& arrays, pliant_id* id, const Add& add) {
  return guarded([&] {
    const auto to = at(scene);
    require(value.second, "json");
    const pliant_id made = add_to(*to, value, arrays_of(arrays.first, arrays.second), add);
    if (id != nullptr) *id = made;
  });
}

}  // namespace

void read_again(SceneHandle& scene) {
  SceneFile file = scene.source(scene.options);
  file.scene.forces = scene.forces;
  file.repairs.insert(file.repairs.end(), file.left_out.begin(), file.left_out.end());
  scene.scene = std::move(file.scene);
  scene.notes = std::move(file.repairs);
  scene.findings.clear();
}

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_scene_parse(const char* text, const pliant_scene_options* options, pliant_scene** scene) {
  return guarded([&] {
    require(text, "text");
    require(scene, "scene");
    const SceneReadOptions read = options_of(options);
    const pliant_scene_options given = options == nullptr ? pliant_scene_options{} : *options;
    const std::string name = text_or(given.name, "scene"), folder = text_or(given.folder, ".");
    const auto source = [text = std::string(text), name, folder](const SceneReadOptions& with) {
      return parse_scene_file(text, name, folder, with);
    };
    give_handle(scene_from(source, folder, read), scene);
  });
}

pliant_status pliant_scene_read(const char* path, const pliant_scene_options* options, pliant_scene** scene) {
  return guarded([&] {
    require(path, "path");
    require(scene, "scene");
    const auto source = [path = std::string(path)](const SceneReadOptions& with) {
      return read_scene_file(path, with);
    };
    const std::string folder = std::filesystem::path(path).parent_path().string();
    give_handle(scene_from(source, folder, options_of(options)), scene);
  });
}

pliant_status pliant_scene_from_json(const char* text, pliant_scene** scene) {
  return guarded([&] {
    require(text, "text");
    require(scene, "scene");
    auto made = std::make_shared<SceneHandle>();
    made->scene = scene_from_json(text);
    give_handle(std::move(made), scene);
  });
}

pliant_status pliant_scene_copy(const pliant_scene* scene, pliant_scene** copy) {
  return guarded([&] {
    const auto from = at(scene);
    require(copy, "copy");
    auto made = std::make_shared<SceneHandle>(*from);
    made->findings.clear();
    give_handle(std::move(made), copy);
  });
}

pliant_status pliant_scene_free(pliant_scene* scene) { return free_handle(scene); }

pliant_status pliant_scene_add_object(pliant_scene* scene, const char* json, const pliant_array* arrays, size_t count,
                                      pliant_id* id) {
  return add_by_handle(scene, {"/objects/-", json}, {arrays, count}, id, add_object);
}

pliant_status pliant_scene_add_collider(pliant_scene* scene, const char* json, const pliant_array* arrays, size_t count,
                                        pliant_id* id) {
  return add_by_handle(scene, {"/colliders/-", json}, {arrays, count}, id, add_collider);
}

pliant_status pliant_scene_add_force(pliant_scene* scene, pliant_force force, void* user) {
  return guarded([&] {
    const auto to = at(scene);
    if (force == nullptr) throw StatusError(PLIANT_NULL, "'force' is a null pointer", "pass a function");
    const auto call = [force, user](const ForceField::Arrays& of) {
      const std::string name(of.object);
      force(user, name.c_str(), &of.positions.data()->x, &of.velocities.data()->x, of.masses.data(), of.masses.size(),
            of.time, &of.forces.data()->x);
    };
    to->forces.push_back(ForceField::on_arrays(call));
    to->scene.forces = to->forces;
    to->findings.clear();
  });
}

pliant_status pliant_scene_set(pliant_scene* scene, const char* pointer, const char* value) {
  return guarded([&] {
    const auto to = at(scene);
    require(pointer, "pointer");
    require(value, "value");
    if (!to->source)
      throw StatusError(PLIANT_REFUSED, "the scene lists particles and constraints, and has no members to set",
                        "set them in a scene that pliant_scene_parse or pliant_scene_read made");
    to->options.values.emplace_back(pointer, value);
    try {
      read_again(*to);
    } catch (...) {
      to->options.values.pop_back();
      throw;
    }
  });
}
