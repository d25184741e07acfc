// Builds a whole scene: settings, objects with their pins, colliders.
#include "scene_build.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "pliant/substep_bounds.h"
#include "scene_grammar.h"
#include "scene_hints.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

Sweep sweep_of(const std::string& name) {
  for (const NamedSweep& one : sweeps())
    if (one.name == name) return one.sweep;
  return Settings{}.sweep;
}

SweepOptions sweep_options_of(const JsonValue& at) {
  SweepOptions options;
  std::string sharing, acceleration;
  set(at, "sharing", sharing);
  set(at, "acceleration", acceleration);
  if (sharing == "average") options.sharing = SweepOptions::Sharing::average;
  if (acceleration == "chebyshev") options.acceleration = SweepOptions::Acceleration::chebyshev;
  set(at, "relaxation", options.relaxation);
  set(at, "plain_iterations", options.plain_iterations);
  set(at, "spectral_radius", options.spectral_radius);
  set(at, "tethers", options.tethers);
  set(at, "tether_slack", options.tether_slack);
  set(at, "chain_softness", options.chain_softness);
  set(at, "most_overstretch", options.most_overstretch);
  set(at, "multigrid_cycles", options.multigrid_cycles);
  return options;
}

SleepOptions sleep_of(const JsonValue& at) {
  SleepOptions sleep;
  set(at, "on", sleep.on);
  set(at, "speed", sleep.speed);
  set(at, "spin", sleep.spin);
  set(at, "time", sleep.time);
  return sleep;
}

Settings settings_of(const JsonDocument& document, const JsonValue& at) {
  Settings settings;
  set(at, "substeps", settings.substeps);
  set(at, "iterations", settings.iterations);
  set(at, "threads", settings.threads);
  set(at, "contact_filter", settings.contact_filter);
  set(at, "most_substeps", settings.most_substeps);
  set(at, "least_substeps", settings.least_substeps);
  set(at, "untangling_speed", settings.untangling_speed);
  std::string integrator, intersections;
  set(at, "integrator", integrator);
  if (integrator == "energy") settings.integrator = Settings::Integrator::energy;
  set(at, "initial_intersections", intersections);
  if (intersections == "untangle") settings.initial_intersections = Settings::Intersections::untangle;
  if (intersections == "refuse") settings.initial_intersections = Settings::Intersections::refuse;
  set(at, "measure", settings.measure);
  set(at, "record_multipliers", settings.record_multipliers);
  set(at, "isa", settings.isa);
  set(at, "record_residuals", settings.record_residuals);
  set(at, "tolerance", settings.tolerance);
  std::string sweep;
  set(at, "sweep", sweep);
  settings.sweep = sweep_of(sweep);
  if (const JsonValue* options = at.find("sweep_options")) settings.sweep_options = sweep_options_of(*options);
  if (const JsonValue* sleep = at.find("sleep")) settings.sleep = sleep_of(*sleep);
  if (const auto error = error_of_bounds(settings))
    document.fail(*at.find("least_substeps"), error->problem(), error->advice());
  return settings;
}

Wind wind_of(const JsonValue& at) {
  Wind wind;
  set(at, "velocity", wind.velocity);
  set(at, "air_density", wind.air_density);
  set(at, "gust", wind.gust);
  set(at, "gust_period", wind.gust_period);
  return wind;
}

/// Names of objects or of colliders that are taken.
class Names {
 public:
  /// Returns the name that `at` gives, or makes one of `kind`. Throws an Error if the name is taken.
  std::string of(const JsonDocument& document, const JsonValue& at, const std::string& kind) {
    std::string name = kind;
    if (const JsonValue* given = at.find("name")) {
      name = given->text;
      if (taken_.count(name) > 0) document.fail(*given, "the name '" + printable(name) + "' is taken", "names differ");
    }
    for (int number = 2; taken_.count(name) > 0; ++number) name = kind + "_" + std::to_string(number);
    taken_.insert(name);
    return name;
  }

 private:
  std::set<std::string> taken_;
};

void set_properties(const JsonDocument& document, const JsonValue& at, Object& object) {
  set(at, "thickness", object.thickness);
  set(at, "self_collision", object.self_collision);
  set(at, "collides", object.collides);
  set(at, "groups", object.groups);
  set(at, "mask", object.mask);
  set_friction(document, at, object.static_friction, object.kinetic_friction);
  set(at, "restitution", object.restitution);
  set(at, "rolling_friction", object.rolling_friction);
  set(at, "spinning_friction", object.spinning_friction);
  std::string sweep;
  set(at, "sweep", sweep);
  if (!sweep.empty()) object.sweep = sweep_of(sweep);
  set(at, "drag", object.drag);
  set(at, "lift", object.lift);
  set(at, "damping", object.damping);
  set(at, "colour", object.colour);
  set(at, "clarity", object.clarity);
}

/// Gives the object's velocity to all particles but those of bodies that have their own, or are fixed.
void set_velocity(const JsonDocument& document, const JsonValue& at, BuiltObject& built) {
  Vec3f velocity;
  if (!set(at, "velocity", velocity)) return;
  const auto has_one_per_particle = [](const JsonValue& record) {
    const JsonValue* particles = record.find("particles");
    return particles != nullptr && particles->find("velocities") != nullptr;
  };
  const std::vector<JsonValue>& parts = elements(at, "parts");
  if (has_one_per_particle(at) || std::any_of(parts.begin(), parts.end(), has_one_per_particle))
    document.fail_key(*at.find("velocity"), "this object already has a velocity per particle", "give one of the two");
  Object& object = built.object;
  const std::vector<Vec3f> given =
      std::exchange(object.velocities, std::vector<Vec3f>(object.positions.size(), velocity));
  for (const int particle : built.own_velocities)
    object.velocities[static_cast<std::size_t>(particle)] =
        given.empty() ? Vec3f{} : given[static_cast<std::size_t>(particle)];
  for (const ObjectBody& body : object.bodies)
    if (std::isinf(object.masses[body.particle])) object.velocities[body.particle] = {};
}

const JsonValue& one_of(const JsonValue& at, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const JsonValue* found = at.find(name)) return *found;
  return at;  // not reached: check() has found exactly one
}

void set_tears(const JsonValue& at, Object& object) {
  if (const JsonValue* tearing = at.find("tearing")) {
    object.tearing.emplace();
    set(*tearing, "stretch", object.tearing->stretch);
  }
  for (const JsonValue& item : elements(at, "cuts")) {
    PlaneCut cut;
    set(item, "start", cut.start);
    cut.end = cut.start;
    set(item, "end", cut.end);
    set(item, "point", cut.point);
    set(item, "normal", cut.normal);
    set(item, "along", cut.along);
    object.cuts.push_back(cut);
  }
}

void set_absorbency(const JsonValue& at, Object& object) {
  const JsonValue* found = at.find("absorbency");
  if (found == nullptr) return;
  Absorbency& absorbency = object.absorbency.emplace();
  set(*found, "capacity", absorbency.capacity);
  set(*found, "uptake", absorbency.uptake);
  set(*found, "wicking", absorbency.wicking);
  set(*found, "rise", absorbency.rise);
  set(*found, "runoff", absorbency.runoff);
  set(*found, "seepage", absorbency.seepage);
  set(*found, "drag", absorbency.drag);
}

const JsonValue& matter_of(const JsonValue& at) {
  return one_of(
      at, {"cloth", "soft_body", "rope", "rod", "liquid", "gas", "tracers", "grains", "particles", "bodies", "urdf"});
}

/// True if an object fills a box or mesh with particles, and leaves out those inside solids.
bool leaves_out_solids(const JsonValue& at) {
  const JsonValue* fill = matter_of(at).find("fill");
  bool leaves_out = true;
  if (fill != nullptr) set(*fill, "leave_out_solids", leaves_out);
  return fill != nullptr && leaves_out;
}

/// Objects are described by `at`, and built by what lies around them: all that leaves nothing out itself.
struct ObjectToBuild {
  const JsonValue& at;
  const std::string& name;
  const Scene& around;
};

Object object_of(const JsonDocument& document, const ObjectToBuild& by, const MeshFolder& folder, SceneFile& file) {
  const JsonValue& at = by.at;
  std::vector<std::string>& repairs = file.repairs;
  BuiltObject built = build_matter(document, matter_of(at), by.name, folder, repairs);
  if (leaves_out_solids(at))
    leave_out(document, at, *matter_of(at).find("fill"), by.around, built.object, file.left_out);
  add_parts(document, at, folder, built.object, repairs);
  set_joints(document, at, built.object);
  set_properties(document, at, built.object);
  set_velocity(document, at, built);
  set_clusters(document, at, built);
  set_pins(document, at, built);
  set_attachments(document, at, built);
  set_stitches(document, at, built);
  set_tears(at, built.object);
  set_absorbency(at, built.object);
  return std::move(built.object);
}

Collider collider_of(const JsonDocument& document, const JsonValue& at, Names& names) {
  Collider collider;
  const JsonValue& shape = one_of(at, {"plane", "sphere", "capsule", "box"});
  collider.name = names.of(document, at, shape.key);
  collider.shape = shape_of(shape);
  set(at, "position", collider.position);
  set(document, at, "rotation", collider.rotation);
  set(document, at, "motion", collider.motion);
  set(at, "thickness", collider.thickness);
  set_friction(document, at, collider.static_friction, collider.kinetic_friction);
  set(at, "restitution", collider.restitution);
  set(at, "rolling_friction", collider.rolling_friction);
  set(at, "spinning_friction", collider.spinning_friction);
  set(at, "surface_velocity", collider.surface_velocity);
  set(at, "colour", collider.colour);
  return collider;
}

[[noreturn]] void fail_too_large(const JsonDocument& document, const JsonValue& at) {
  document.fail(at, "more than " + std::to_string(largest_scene) + " particles so far", "use fewer particles");
}

void set_representation(const JsonDocument& document, const JsonValue& at, MeshCollider& collider) {
  std::string as;
  set(at, "as", as);
  if (as == "distance_grid") collider.as = MeshCollider::As::distance_grid;
  if (as == "heightfield") collider.as = MeshCollider::As::heightfield;
  if (const JsonValue* spacing = at.find("grid_spacing"); spacing != nullptr) {
    if (as != "distance_grid") document.fail_key(*spacing, "only a distance grid has a spacing", "remove it");
    set(at, "grid_spacing", collider.grid_spacing);
  }
}

void set_frames(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, const SceneMesh& surface,
                MeshCollider& collider) {
  for (const JsonValue& item : elements(at, "frames")) {
    MeshFrame frame;
    set(item, "time", frame.time);
    if (!collider.frames.empty() && !(frame.time > collider.frames.back().time))
      document.fail(*item.find("time"), "this time is not after the previous one", "times must increase");
    frame.positions = make_frame(document, item, folder, surface);
    collider.frames.push_back(std::move(frame));
  }
  set(at, "repeat_frames", collider.repeat_frames);
}

/// Makes a mesh collider. `position` and `rotation` move the vertices, not the collider's frame. A deforming mesh is
/// read without repairs.
MeshCollider mesh_collider_of(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, Names& names,
                              std::vector<std::string>& repairs) {
  MeshCollider collider;
  collider.name = names.of(document, at, "mesh");
  const Repair repair = at.find("frames") == nullptr ? Repair::yes : Repair::no;
  SceneMesh surface = make_mesh(document, *at.find("mesh"), folder, collider.name, repair);
  for (const std::string& one : surface.repairs) repairs.push_back("collider '" + collider.name + "', " + one);
  set_frames(document, at, folder, surface, collider);
  collider.mesh = std::move(surface.mesh);
  Vec3f position;
  Quatf turn;
  const bool turns = set(document, at, "rotation", turn);
  set(at, "position", position);
  const auto put = [&](std::vector<Vec3f>& places) {
    for (Vec3f& p : places) p = (turns ? rotated(turn, p) : p) + position;
  };
  put(collider.mesh.positions);
  for (MeshFrame& frame : collider.frames) put(frame.positions);
  set_representation(document, at, collider);
  set(document, at, "motion", collider.motion);
  set(at, "thickness", collider.thickness);
  set_friction(document, at, collider.static_friction, collider.kinetic_friction);
  set(at, "restitution", collider.restitution);
  set(at, "rolling_friction", collider.rolling_friction);
  set(at, "spinning_friction", collider.spinning_friction);
  set(at, "surface_velocity", collider.surface_velocity);
  if (turns) collider.surface_velocity = rotated(turn, collider.surface_velocity);
  set(at, "groups", collider.groups);
  set(at, "mask", collider.mask);
  set(at, "colour", collider.colour);
  return collider;
}

PairProperties pair_of(const JsonDocument& document, const JsonValue& at, const Scene& scene) {
  PairProperties pair;
  const JsonValue& between = *at.find("between");
  const auto exists = [&](const std::string& name) {
    const auto called = [&](const auto& one) { return one.name == name; };
    return std::any_of(scene.objects.begin(), scene.objects.end(), called) ||
           std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), called);
  };
  for (const JsonValue& name : between.items)
    if (!exists(name.text))
      document.fail(name, "there is no object or mesh collider '" + printable(name.text) + "'",
                    "use the name of one; for a primitive collider set friction, restitution and thickness in the "
                    "collider itself");
  pair.first = between.items[0].text;
  pair.second = between.items[1].text;
  set(at, "thickness", pair.thickness);
  set(at, "restitution", pair.restitution);
  set(at, "static_friction", pair.static_friction);
  const bool has_kinetic = set(at, "kinetic_friction", pair.kinetic_friction);
  if (has_kinetic && pair.static_friction && *pair.kinetic_friction > *pair.static_friction)
    document.fail(*at.find("kinetic_friction"), "kinetic friction is larger than static friction",
                  "reduce it to the static one or less");
  return pair;
}

/// The names of the cloths and mesh colliders, whose meshes can be replaced.
std::vector<std::string> names_with_mesh(const JsonDocument& document, const Scene& scene) {
  std::vector<std::string> names;
  const std::vector<JsonValue>& objects = elements(document.root, "objects");
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const JsonValue* soft = objects[i].find("soft_body");
    if (objects[i].find("cloth") != nullptr || (soft != nullptr && soft->find("mesh") != nullptr))
      names.push_back(scene.objects[i].name);
  }
  for (const MeshCollider& collider : scene.mesh_colliders) names.push_back(collider.name);
  return names;
}

std::string advice_on(const std::string& name, const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  if (names.empty()) return "nothing in this scene has a mesh";
  const std::string near = nearest_name(name, names);
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    list += (i == 0 ? "'" : ", '") + printable(names[i]) + "'";
  if (names.size() > most) list += " and " + std::to_string(names.size() - most) + " more";
  return (near.empty() ? "" : "did you mean '" + printable(near) + "'? ") + "the scene has meshes for " + list;
}

/// Throws an Error if a replacement mesh names no object or collider that has a mesh.
void require_known(const MeshFolder& folder, const JsonDocument& document, const Scene& scene) {
  const std::vector<std::string> names = names_with_mesh(document, scene);
  for (const auto& [name, path] : folder.instead) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw Error({document.name, 0, {}, {}}, "nothing with a mesh is called '" + printable(name) + "'",
                advice_on(name, names));
  }
}

/// The names of all objects.
std::vector<std::string> names_of_objects(const JsonDocument& document, const std::vector<JsonValue>& items) {
  Names names;
  std::vector<std::string> all;
  all.reserve(items.size());
  for (const JsonValue& item : items) all.push_back(names.of(document, item, matter_of(item).key));
  return all;
}

enum class Fills { none, leave_out_solids };

/// Builds the objects of a scene that leave out solids, or the others, and adds their particles to `particles`.
void build_objects(const JsonDocument& document, const MeshFolder& folder, const std::vector<std::string>& names,
                   Fills which, SceneFile& file, std::size_t& particles) {
  const std::vector<JsonValue>& items = elements(document.root, "objects");
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (leaves_out_solids(items[i]) != (which == Fills::leave_out_solids)) continue;
    file.scene.objects[i] = object_of(document, {items[i], names[i], file.scene}, folder, file);
    particles += file.scene.objects[i].positions.size();
    if (particles > largest_scene) fail_too_large(document, items[i]);
  }
}

}  // namespace

Object build_object(const JsonDocument& document, const MeshFolder& folder, std::vector<std::string>& repairs) {
  Names names;
  const std::string name = names.of(document, document.root, matter_of(document.root).key);
  SceneFile file;
  Object object = object_of(document, {document.root, name, file.scene}, folder, file);
  repairs = std::move(file.repairs);
  return object;
}

std::variant<Collider, MeshCollider> build_collider(const JsonDocument& document, const MeshFolder& folder,
                                                    std::vector<std::string>& repairs) {
  Names names;
  if (document.root.find("mesh") == nullptr) return collider_of(document, document.root, names);
  return mesh_collider_of(document, document.root, folder, names, repairs);
}

SceneFile build(const JsonDocument& document, const MeshFolder& folder) {
  const JsonValue& root = document.root;
  SceneFile file;
  Scene& scene = file.scene;
  root.find("$schema");  // allowed, because editors use it
  set(root, "description", file.description);
  set(root, "gravity", scene.gravity);
  set(root, "frame_time", scene.frame_time);
  set(root, "frames", scene.frames);
  if (const JsonValue* wind = root.find("wind")) scene.wind = wind_of(*wind);
  if (const JsonValue* settings = root.find("settings")) scene.settings = settings_of(document, *settings);
  std::size_t particles = 0;
  const std::vector<std::string> names = names_of_objects(document, elements(root, "objects"));
  scene.objects.resize(names.size());
  build_objects(document, folder, names, Fills::none, file, particles);
  Names colliders;
  for (const JsonValue& item : elements(root, "colliders")) {
    if (item.find("mesh") == nullptr) {
      scene.colliders.push_back(collider_of(document, item, colliders));
      continue;
    }
    scene.mesh_colliders.push_back(mesh_collider_of(document, item, folder, colliders, file.repairs));
    particles += scene.mesh_colliders.back().mesh.positions.size();
    if (particles > largest_scene) fail_too_large(document, item);
  }
  build_objects(document, folder, names, Fills::leave_out_solids, file, particles);  // which are known now
  for (const JsonValue& item : elements(root, "pairs")) scene.pairs.push_back(pair_of(document, item, scene));
  file.gauges = build_gauges(document, root, scene);
  if (const JsonValue* camera = root.find("camera")) file.camera = build_camera(document, *camera);
  require_known(folder, document, scene);
  return file;
}

}  // namespace pliant::scene_file
