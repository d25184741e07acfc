// Builds objects of rigid bodies from scene files, and repeats bodies.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>

#include "pliant/body.h"
#include "pliant/decompose.h"
#include "pliant/random.h"
#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

constexpr double most_copies = 1 << 20;

// ------------------------------------------------------------------------------------------------ solids

/// What a body's solids are read with.
struct Reader {
  const JsonDocument& document;
  const MeshFolder& folder;
  const std::string& object;
  std::vector<std::string>& repairs;
  std::string body{};  ///< the body that is read
};

/// Only the corners of a mesh's hull are kept, so that copies of the body are cheap to make.
Hull hull_of(const Reader& reader, const JsonValue& at) {
  Hull hull;
  for (const JsonValue& point : elements(at, "points")) hull.points.push_back(vector_of(point));
  if (const JsonValue* mesh = at.find("mesh")) {
    SceneMesh surface = make_mesh(reader.document, *mesh, reader.folder, reader.object);
    for (const std::string& repair : surface.repairs)
      reader.repairs.push_back("object '" + reader.object + "', " + repair);
    hull.points = mesh_of({{Hull{std::move(surface.mesh.positions), 0}}}).positions;
  }
  set(at, "margin", hull.margin);
  return hull;
}

template <class Round>
Round round_of(const JsonValue& at) {
  Round shape;
  set(at, "radius", shape.radius);
  set(at, "half_length", shape.half_length);
  return shape;
}

SolidShape shape_of(const Reader& reader, const JsonValue& solid) {
  if (const JsonValue* at = solid.find("capsule")) return round_of<Capsule>(*at);
  if (const JsonValue* at = solid.find("cylinder")) return round_of<Cylinder>(*at);
  if (const JsonValue* at = solid.find("cone")) return round_of<Cone>(*at);
  if (const JsonValue* at = solid.find("hull")) return hull_of(reader, *at);
  if (const JsonValue* at = solid.find("box")) {
    Box box;
    set(*at, "half_extents", box.half_extents);
    return box;
  }
  Sphere sphere;
  if (const JsonValue* at = solid.find("sphere")) set(*at, "radius", sphere.radius);
  return sphere;
}

/// An Error of decompose() with the mesh's file, and the body that has it.
Decomposition decomposed(const Reader& reader, const JsonValue& at, const TriangleMesh& mesh,
                         const DecomposeOptions& options) {
  try {
    return decompose(mesh, options);
  } catch (const Error& error) {
    const JsonValue* file = at.find("mesh")->find("file");
    const std::string element = file != nullptr ? "mesh '" + printable(file->text) + "'" : "mesh";
    throw Error({"", 0, reader.body, element + (error.where().element.empty() ? "" : ", " + error.where().element)},
                error.problem(), error.advice());
  }
}

Decomposition pieces_of(const Reader& reader, const JsonValue& at, float density) {
  DecomposeOptions options;
  options.density = density;
  set(at, "tolerance", options.tolerance);
  set(at, "most_pieces", options.most_pieces);
  set(at, "most_corners", options.most_corners);
  SceneMesh surface = make_mesh(reader.document, *at.find("mesh"), reader.folder, reader.object);
  for (const std::string& repair : surface.repairs)
    reader.repairs.push_back("object '" + reader.object + "', " + repair);
  Decomposition pieces = decomposed(reader, at, surface.mesh, options);
  if (static_cast<int>(pieces.solids.size()) >= options.most_pieces && pieces.filled > options.tolerance)
    reader.repairs.push_back("object '" + reader.object + "', concave solid: " + std::to_string(pieces.solids.size()) +
                             " pieces fill hollows by up to " + std::to_string(pieces.filled) +
                             " m; a greater most_pieces keeps them open");
  return pieces;
}

/// The solids of a body, and its inertia where it is that of one mesh.
struct BodySolids {
  std::vector<Solid> solids;
  std::optional<BodyInertia> inertia;
};

BodySolids solids_of(const Reader& reader, const JsonValue& body) {
  BodySolids out;
  const std::vector<JsonValue>& items = elements(body, "solids");
  for (const JsonValue& item : items) {
    Solid solid;
    bool is_moved = set(item, "position", solid.position);
    is_moved = set(reader.document, item, "rotation", solid.rotation) || is_moved;
    set(item, "density", solid.density);
    const JsonValue* concave = item.find("concave");
    if (concave == nullptr) {
      solid.shape = shape_of(reader, item);
      out.solids.push_back(std::move(solid));
      continue;
    }
    const Decomposition pieces = pieces_of(reader, *concave, solid.density);
    for (const Solid& piece : pieces.solids)
      out.solids.push_back({piece.shape, solid.position, solid.rotation, piece.density});
    if (items.size() == 1 && !is_moved) out.inertia = pieces.inertia;
  }
  return out;
}

/// The inertia of a body whose mass is given instead of its density.
BodyInertia scaled(BodyInertia inertia, float mass) {
  const float factor = mass / inertia.mass;
  return {mass, inertia.centre, inertia.moments * factor, inertia.products * factor};
}

// ------------------------------------------------------------------------------------------------ copies

Quatf product(const Quatf& a, const Quatf& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

void require_few(const JsonDocument& document, const JsonValue& at, double copies) {
  if (copies > most_copies) document.fail(at, "more than 1048576 copies of a body", "make fewer");
}

std::vector<RigidPose> grid_poses(const JsonDocument& document, const JsonValue& at) {
  const std::vector<JsonValue>& counts = at.find("counts")->items;
  require_few(document, at, counts[0].number * counts[1].number * counts[2].number);
  Vec3f spacing;
  float jitter = 0;
  bool tumbled = false;
  int seed = 0;
  set(at, "spacing", spacing);
  set(at, "jitter", jitter);
  set(at, "tumbled", tumbled);
  set(at, "seed", seed);
  Random random(seed);
  std::vector<RigidPose> poses;
  for (float z = 0; z < counts[2].number; ++z)
    for (float y = 0; y < counts[1].number; ++y)
      for (float x = 0; x < counts[0].number; ++x) {
        RigidPose pose{{x * spacing.x, y * spacing.y, z * spacing.z}, {}};
        const Vec3f shift{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        pose.position += jitter * shift;
        const Quatf rotation = random.rotation();
        if (tumbled) pose.rotation = rotation;
        poses.push_back(pose);
      }
  return poses;
}

/// The first row is centred at the body's x.
std::vector<RigidPose> pyramid_poses(const JsonDocument& document, const JsonValue& at) {
  int base = 1;
  float spacing = 0, rise = 0;
  bool square = false;
  set(at, "base", base);
  set(at, "spacing", spacing);
  set(at, "rise", rise);
  set(at, "square", square);
  const double n = base;
  require_few(document, at, square ? n * (n + 1) * (2 * n + 1) / 6 : n * (n + 1) / 2);
  std::vector<RigidPose> poses;
  for (int row = 0; row < base; ++row) {
    const int across = base - row, deep = square ? across : 1;
    const auto along = [&](int i, int count) { return spacing * 0.5f * static_cast<float>(2 * i - (count - 1)); };
    for (int z = 0; z < deep; ++z)
      for (int x = 0; x < across; ++x)
        poses.push_back({{along(x, across), rise * static_cast<float>(row), along(z, deep)}, {}});
  }
  return poses;
}

/// An Archimedean spiral: from one copy to the next the angle grows by spacing / sqrt(r^2 + (dr/dangle)^2).
std::vector<RigidPose> spiral_poses(const JsonDocument& document, const JsonValue& at) {
  constexpr double degree = 3.14159265358979323846 / 180;
  int count = 1;
  float radius = 0, spacing = 0, pitch = 0;
  set(at, "count", count);
  set(at, "radius", radius);
  set(at, "spacing", spacing);
  set(at, "pitch", pitch);
  require_few(document, at, count);
  const double growth = static_cast<double>(pitch) / 360;  // of the radius in a degree
  std::vector<RigidPose> poses;
  double degrees = 0, r = static_cast<double>(radius);
  for (int i = 0; i < count; ++i) {
    const double slope = growth / degree;
    // The tangent leans outward by the slope over the radius.
    const Vec3f outward = rotated(rotation({0, 1, 0}, static_cast<float>(std::fmod(degrees, 360.0))), {1, 0, 0});
    const Vec3f around = rotated(rotation({0, 1, 0}, static_cast<float>(std::fmod(degrees, 360.0))), {0, 0, -1});
    const Vec3f ahead = static_cast<float>(r) * around + static_cast<float>(slope) * outward;
    const float norm = std::sqrt(length_squared(ahead));
    // The rotation about y that takes -z to `ahead`: half-angle formulas.
    const float cosine = -ahead.z / norm, sine = -ahead.x / norm;
    const float w = std::sqrt(std::fmax(0.f, 0.5f * (1 + cosine))), y = std::sqrt(std::fmax(0.f, 0.5f * (1 - cosine)));
    poses.push_back({static_cast<float>(r) * outward, {0, sine < 0 ? -y : y, 0, w}});
    const double step = static_cast<double>(spacing) / std::sqrt(r * r + slope * slope) / degree;
    degrees += step;
    r += step * growth;
  }
  return poses;
}

/// The poses of the copies relative to the body's own; empty if the body is not repeated.
std::vector<RigidPose> copies_of(const JsonDocument& document, const JsonValue& body) {
  const JsonValue* repeat = body.find("repeat");
  if (repeat == nullptr) return {};
  if (const JsonValue* at = repeat->find("grid")) return grid_poses(document, *at);
  if (const JsonValue* at = repeat->find("pyramid")) return pyramid_poses(document, *at);
  return spiral_poses(document, *repeat->find("spiral"));
}

// ------------------------------------------------------------------------------------------------ bodies

void set_kinematic(const JsonDocument& document, const JsonValue& at, BodyOptions& options) {
  set(at, "kinematic", options.kinematic);
  const bool moves = set(document, at, "motion", options.motion);
  if (moves && !options.kinematic)
    document.fail_key(*at.find("motion"), "only a kinematic body follows a motion",
                      "add \"kinematic\": true, or move the body by joints");
  const JsonValue* mass = at.find("mass");
  if (mass != nullptr && options.kinematic)
    document.fail_key(*mass, "a kinematic body has infinite mass", "remove the mass, or \"kinematic\"");
}

BodyOptions options_of(const JsonDocument& document, const JsonValue& at) {
  BodyOptions options;
  set(at, "position", options.position);
  set(document, at, "rotation", options.rotation);
  set(at, "velocity", options.velocity);
  set(at, "angular_velocity", options.angular_velocity);
  set(at, "surface_velocity", options.surface_velocity);
  set_kinematic(document, at, options);
  const JsonValue* mass = at.find("mass");
  const bool is_fixed = mass != nullptr && mass->kind == JsonValue::Kind::string;
  if (mass != nullptr)
    options.mass = is_fixed ? std::numeric_limits<float>::infinity() : static_cast<float>(mass->number);
  for (const char* motion : {"velocity", "angular_velocity"}) {
    const JsonValue* given = at.find(motion);
    if (given != nullptr && options.kinematic)
      document.fail_key(*given, "a kinematic body has the velocity of its motion", "remove it, or give a motion");
    if (given != nullptr && is_fixed)
      document.fail_key(*given, "a fixed body has no velocity", "remove it, or give the body a mass");
  }
  return options;
}

/// The bodies of one object, with the names that are taken.
class Bodies {
 public:
  Bodies(const Reader& reader, Object& object) : reader_(reader), object_(object) {}

  void add(const JsonValue& at) {
    const std::string name = name_of(at);
    BodyOptions options = options_of(reader_.document, at);
    const auto [solids, inertia] =
        solids_of({reader_.document, reader_.folder, reader_.object, reader_.repairs, name}, at);
    const bool has_mass = options.mass > 0 && !std::isinf(options.mass);
    if (inertia) options.inertia = has_mass ? scaled(*inertia, options.mass) : *inertia;
    const std::vector<RigidPose> copies = copies_of(reader_.document, at);
    if (at.find("repeat") == nullptr) return add_one(at, solids, name, options);
    const RigidPose own{options.position, options.rotation};
    for (std::size_t i = 0; i < copies.size(); ++i) {
      options.position = own.position + copies[i].position;
      options.rotation = product(copies[i].rotation, own.rotation);
      add_one(at, solids, name + "_" + std::to_string(i), options);
    }
  }

 private:
  std::string name_of(const JsonValue& at) {
    std::string name = "body";
    if (set(at, "name", name)) {
      if (name == "world")
        reader_.document.fail(*at.find("name"), "no body can be called 'world'", "joints use that name");
      return name;
    }
    for (int number = 2; !unnamed_.insert(name).second; ++number) name = "body_" + std::to_string(number);
    return name;
  }

  void add_one(const JsonValue& at, const std::vector<Solid>& solids, const std::string& name, BodyOptions& options) {
    if (!taken_.insert(name).second) {
      const JsonValue* given = at.find("name");
      reader_.document.fail(given != nullptr ? *given : at, "the name '" + printable(name) + "' is taken",
                            "names of an object's bodies differ");
    }
    options.name = name;
    add_body(object_, solids, options);
  }

  const Reader& reader_;
  Object& object_;
  std::set<std::string> taken_, unnamed_;
};

}  // namespace

BuiltObject build_bodies(const JsonDocument& document, const JsonValue& list, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs) {
  BuiltObject built;
  Object& object = built.object;
  object.name = name;
  const Reader reader{document, folder, object.name, repairs};
  Bodies bodies(reader, object);
  for (const JsonValue& item : list.items) {
    const std::size_t first = object.bodies.size();
    try {
      bodies.add(item);
    } catch (const Error& error) {
      if (!error.where().file.empty()) throw;  // the error has a location already
      const Location& inner = error.where();
      Location place = document.locate(item);
      place.object = name;
      if (!inner.object.empty()) place.element += ", body '" + printable(inner.object) + "'";
      if (!inner.element.empty()) place.element += ", " + inner.element;
      throw Error(place, error.problem(), error.advice());
    }
    for (std::size_t b = first; b < object.bodies.size() && item.find("velocity") != nullptr; ++b)
      built.own_velocities.push_back(object.bodies[b].particle);
  }
  return built;
}

}  // namespace pliant::scene_file
