// Builds objects in scene files: cloth, rope, particles; scene_bodies.cpp builds rigid bodies.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

ClothOptions cloth_options(const JsonDocument& document, const JsonValue& at, const std::string& name) {
  ClothOptions options;
  options.name = name;
  set(document, at, "material", options.material);
  if (Stiffness stretch; set(document, at, "stretch", stretch)) options.stretch = stretch;
  if (Stiffness bending; set(document, at, "bending", bending)) options.bending = bending;
  set(document, at, "volume", options.volume);
  set(at, "bending_plasticity", options.bending_plasticity);
  std::string model = "dihedral";
  set(at, "bending_model", model);
  options.bending_model = model == "none"        ? ClothOptions::Bending::none
                          : model == "isometric" ? ClothOptions::Bending::isometric
                                                 : ClothOptions::Bending::dihedral;
  std::string stretch_model = "springs";
  set(at, "stretch_model", stretch_model);
  if (stretch_model == "woven") options.stretch_model = ClothOptions::Stretching::woven;
  set(at, "warp", options.warp);
  set(at, "strain_limit", options.strain_limit);
  return options;
}

BuiltObject cloth_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                     const MeshFolder& folder, std::vector<std::string>& repairs) {
  SceneMesh surface = make_mesh(document, *at.find("mesh"), folder, name);
  for (const std::string& repair : surface.repairs) repairs.push_back("object '" + name + "', " + repair);
  return {make_cloth(surface.mesh, cloth_options(document, at, name)), surface.columns, surface.rows};
}

}  // namespace

std::vector<Vec3f> line_points(const JsonValue& at) {
  Vec3f from, to;
  int count = 2;
  set(at, "from", from);
  set(at, "to", to);
  set(at, "points", count);
  std::vector<Vec3f> points;
  for (int i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count - 1);
    points.push_back((1 - share) * from + share * to);
  }
  return points;
}

namespace {

BuiltObject rope_of(const JsonDocument& document, const JsonValue& at, const std::string& name) {
  RopeOptions options;
  options.name = name;
  set(at, "linear_density", options.linear_density);
  set(document, at, "stretch", options.stretch);
  options.bends = set(document, at, "bending", options.bending);
  std::vector<Vec3f> points;
  for (const JsonValue& point : elements(at, "points")) points.push_back(vector_of(point));
  if (const JsonValue* line = at.find("line")) points = line_points(*line);
  return {make_rope(points, options)};
}

/// Throws an Error at `at` if a box has room for more particles than a scene may have.
void limit_particles(const Filling& by, const JsonValue& at, const Vec3f& low, const Vec3f& high) {
  const auto along = [&](float from, float to) {
    return std::max(1., (static_cast<double>(to) - static_cast<double>(from)) / static_cast<double>(by.spacing));
  };
  if (along(low.x, high.x) * along(low.y, high.y) * along(low.z, high.z) > largest_scene)
    by.document.fail(at, "more than " + std::to_string(largest_scene) + " particles",
                     "use a larger spacing, or a smaller box");
}

/// `way` is by how far places will be moved afterwards, at most [m]: none comes closer to the surface than it may.
std::vector<Vec3f> places_in_mesh(const Filling& by, const JsonValue& fill, float way) {
  if (const JsonValue* high = fill.find("max"))
    by.document.fail(*high, "is the corner of a box, but a mesh is filled", "give 'min' and 'max', or 'mesh'");
  SceneMesh surface = make_mesh(by.document, *fill.find("mesh"), by.folder, by.name);
  for (const std::string& repair : surface.repairs) by.repairs.push_back("object '" + by.name + "', " + repair);
  float clearance = 0;
  set(fill, "clearance", clearance);
  const MeshBounds bounds = bounds_of(surface.mesh.positions);
  limit_particles(by, fill, bounds.low, bounds.high);
  return fill_mesh(surface.mesh, by.spacing, clearance + way);
}

std::vector<Vec3f> places_in_box(const Filling& by, const JsonValue& fill) {
  if (fill.find("max") == nullptr) by.document.fail(fill, "has 'min' without 'max'", "give both corners of the box");
  if (const JsonValue* clearance = fill.find("clearance"))
    by.document.fail_key(*clearance, "is only for a mesh", "remove it, or make the box smaller");
  const Vec3f low = vector_of(*fill.find("min")), high = vector_of(*fill.find("max"));
  limit_particles(by, fill, low, high);
  return fill_box(low, high, by.spacing);
}

/// The places of a `fill`, moved by its jitter.
std::vector<Vec3f> places_in(const Filling& by, const JsonValue& fill) {
  float jitter = 0;
  int seed = 0;
  set(fill, "jitter", jitter);
  set(fill, "seed", seed);
  if (const JsonValue* given = fill.find("seed"); given != nullptr && jitter == 0)
    by.document.fail_key(*given, "has no 'jitter' to draw", "give a 'jitter', or remove it");
  const Filling wider{by.document, by.folder, by.name, by.repairs, by.spacing * (1 + 2 * jitter)};
  const float most = jitter * by.spacing, way = std::sqrt(3.f) * most;
  return jittered(fill.find("mesh") != nullptr ? places_in_mesh(wider, fill, way) : places_in_box(wider, fill), most,
                  seed);
}

}  // namespace

std::vector<Vec3f> places_of(const Filling& by, const JsonValue& at) {
  std::vector<Vec3f> positions = positions_at(by.document, at, by.folder);
  const JsonValue* fill = at.find("fill");
  if (fill == nullptr && positions.empty() && at.find("emitters") == nullptr)
    by.document.fail(at, "has no particles", "give 'fill', 'positions' or 'emitters'");
  if (fill != nullptr && !positions.empty())
    by.document.fail_key(*fill, "is given with 'positions'", "give one of them");
  if (fill == nullptr) return positions;
  return places_in(by, *fill);
}

namespace {

/// Reads how particles come and go.
template <class Options>
void set_flow(const JsonDocument& document, const JsonValue& at, Options& options) {
  options.flow = particle_flow(document, at);
  set(at, "capacity", options.capacity);
  if (const JsonValue* emitters = at.find("emitters"); emitters != nullptr && options.capacity == 0)
    document.fail_key(*emitters, "need a 'capacity'", "say how many particles may be there at a time");
  if (options.capacity > largest_scene)
    document.fail(*at.find("capacity"), "more than " + std::to_string(largest_scene) + " particles", "give fewer");
}

BuiltObject liquid_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                      const MeshFolder& folder, std::vector<std::string>& repairs) {
  LiquidOptions options;
  options.name = name;
  if (const JsonValue* kind = at.find("kind")) {
    const LiquidKind& of = liquid(kind->text);
    options.fluid.density = of.density;
    options.fluid.viscosity = of.viscosity;
  }
  set(at, "spacing", options.fluid.spacing);
  set(at, "density", options.fluid.density);
  set(at, "speed_of_sound", options.fluid.speed_of_sound);
  set(at, "viscosity", options.fluid.viscosity);
  set(at, "surface_tension", options.fluid.surface_tension);
  set(at, "contact_angle", options.fluid.contact_angle);
  set(at, "vorticity", options.fluid.vorticity);
  set(at, "clarity", options.fluid.clarity);
  set_flow(document, at, options);
  return {make_liquid(places_of({document, folder, name, repairs, options.fluid.spacing}, at), options)};
}

BuiltObject grains_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                      const MeshFolder& folder, std::vector<std::string>& repairs) {
  GrainsOptions options;
  options.name = name;
  if (const JsonValue* kind = at.find("kind")) {
    const GrainKind& of = grain_kind(kind->text);
    options.grains.density = of.density;
    options.grains.friction = of.friction;
    options.grains.cohesion = of.cohesion;
  }
  set(at, "radius", options.grains.radius);
  set(at, "density", options.grains.density);
  set(at, "friction", options.grains.friction);
  set(at, "cohesion", options.grains.cohesion);
  set(at, "mass_scaling", options.grains.mass_scaling);
  set_flow(document, at, options);
  return {make_grains(places_of({document, folder, name, repairs, 2 * options.grains.radius}, at), options)};
}

std::vector<float> masses_of(const JsonDocument& document, const JsonValue& at, std::size_t particles) {
  if (at.kind == JsonValue::Kind::number) return std::vector<float>(particles, static_cast<float>(at.number));
  if (at.items.size() != particles)
    document.fail(at, std::to_string(at.items.size()) + " masses for " + std::to_string(particles) + " particles",
                  "give one number for all, or one per particle");
  std::vector<float> masses;
  for (const JsonValue& item : at.items) {
    const bool fixed = item.kind == JsonValue::Kind::string;
    masses.push_back(fixed ? std::numeric_limits<float>::infinity() : static_cast<float>(item.number));
  }
  return masses;
}

int particle_of(const JsonDocument& document, const JsonValue& at, std::size_t particles) {
  if (at.number < static_cast<double>(particles)) return static_cast<int>(at.number);
  document.fail(at, "there is no particle " + std::to_string(static_cast<long long>(at.number)),
                "the object has " + std::to_string(particles) + ", counted from 0");
}

const ConstraintType& type_named(const std::string& name) {
  const std::vector<ConstraintType>& types = constraint_types();
  return *std::find_if(types.begin(), types.end(), [&](const ConstraintType& type) { return type.name == name; });
}

/// Throws an Error unless a row has as many numbers as the constraint type requires.
void check_width(const JsonDocument& document, const JsonValue& row, std::size_t wanted, const std::string& of) {
  if (row.items.size() == wanted) return;
  document.fail(row, std::to_string(row.items.size()) + " elements", of + " takes " + std::to_string(wanted));
}

void check_rows(const JsonDocument& document, const JsonValue& at, std::size_t found, std::size_t wanted) {
  if (found == wanted) return;
  document.fail(at, std::to_string(found) + " elements for " + std::to_string(wanted) + " constraints",
                "give one per constraint");
}

int frame_of(const JsonDocument& document, const JsonValue& at, std::size_t frames) {
  if (at.number < static_cast<double>(frames)) return static_cast<int>(at.number);
  document.fail(at, "there is no frame " + std::to_string(static_cast<long long>(at.number)),
                "the object has " + std::to_string(frames) + ", counted from 0");
}

ObjectFrame object_frame_of(const JsonDocument& document, const JsonValue& at) {
  ObjectFrame frame;
  set(document, at, "orientation", frame.orientation);
  set(at, "angular_velocity", frame.angular_velocity);
  const JsonValue& inertia = *at.find("inertia");
  const float fixed = std::numeric_limits<float>::infinity();
  frame.inertia = inertia.kind == JsonValue::Kind::string ? Vec3f{fixed, fixed, fixed} : vector_of(inertia);
  return frame;
}

ConstraintGroup constraints_of(const JsonDocument& document, const JsonValue& at, std::size_t particles,
                               std::size_t frames) {
  ConstraintGroup group;
  set(at, "type", group.type);
  set(document, at, "stiffness", group.stiffness);
  set(at, "plasticity", group.plasticity);
  set(document, at, "keyframes", group.keyframes);
  set(at, "break_force", group.break_force);
  const ConstraintType& type = type_named(group.type);
  const std::vector<JsonValue>& stencils = elements(at, "particles");
  for (const JsonValue& stencil : stencils) {
    check_width(document, stencil, static_cast<std::size_t>(type.stencil_size), "a " + type.name + " constraint");
    for (std::size_t slot = 0; slot < stencil.items.size(); ++slot) {
      const bool is_frame = type.slots[slot] == SlotKind::frame;
      group.particles.push_back(is_frame ? frame_of(document, stencil.items[slot], frames)
                                         : particle_of(document, stencil.items[slot], particles));
    }
  }
  if (const JsonValue* rest = at.find("rest")) {
    check_rows(document, *rest, rest->items.size(), stencils.size());
    for (const JsonValue& row : rest->items) {
      check_width(document, row, type.rest_fields.size(), "the rest data of a " + type.name + " constraint");
      for (const JsonValue& item : row.items) group.rest.push_back(static_cast<float>(item.number));
    }
  }
  if (const JsonValue* compliances = at.find("compliances")) {
    check_rows(document, *compliances, compliances->items.size(), stencils.size());
    if (group.stiffness.kind == Stiffness::Kind::pbd)
      document.fail_key(*compliances, "compliances cannot be combined with a PBD stiffness", "give one of the two");
    for (const JsonValue& item : compliances->items) group.compliances.push_back(static_cast<float>(item.number));
  }
  return group;
}

BuiltObject particles_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                         const MeshFolder& folder) {
  Object object;
  object.name = name;
  object.positions = positions_at(document, at, folder);
  const std::size_t count = object.positions.size();
  object.masses = masses_of(document, *at.find("masses"), count);
  if (const JsonValue* velocities = at.find("velocities")) {
    if (velocities->items.size() != count)
      document.fail(
          *velocities,
          std::to_string(velocities->items.size()) + " velocities for " + std::to_string(count) + " particles",
          "give one per particle, or the object's velocity");
    for (const JsonValue& item : velocities->items) object.velocities.push_back(vector_of(item));
  }
  for (const JsonValue& item : elements(at, "frames")) object.frames.push_back(object_frame_of(document, item));
  for (const JsonValue& item : elements(at, "constraints"))
    object.constraints.push_back(constraints_of(document, item, count, object.frames.size()));
  for (const JsonValue& item : elements(at, "triangles"))
    object.triangles.push_back({particle_of(document, item.items[0], count),
                                particle_of(document, item.items[1], count),
                                particle_of(document, item.items[2], count)});
  set(document, at, "volume", object.volume);
  return {std::move(object)};
}

}  // namespace

BuiltObject build_matter(const JsonDocument& document, const JsonValue& what, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs) {
  try {
    if (what.key == "cloth") return cloth_of(document, what, name, folder, repairs);
    if (what.key == "soft_body") return soft_body_of(document, what, name, folder, repairs);
    if (what.key == "liquid") return liquid_of(document, what, name, folder, repairs);
    if (what.key == "gas") return gas_of(document, what, name, folder, repairs);
    if (what.key == "tracers") return tracers_of(what, name);
    if (what.key == "grains") return grains_of(document, what, name, folder, repairs);
    if (what.key == "rope") return rope_of(document, what, name);
    if (what.key == "rod") return {rod_of(document, what, name)};
    if (what.key == "bodies") return build_bodies(document, what, name, folder, repairs);
    if (what.key == "urdf") return {build_robot(document, what, name, folder, repairs)};
  } catch (const Error& error) {
    if (!error.where().file.empty()) throw;  // the error has a location already: this file, or that of the mesh
    Location place = document.locate(what);
    place.object = name;
    if (!error.where().element.empty()) place.element += ", " + error.where().element;
    throw Error(place, error.problem(), error.advice());
  }
  return particles_of(document, what, name, folder);
}

}  // namespace pliant::scene_file
