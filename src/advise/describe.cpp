// Describes scenes, worlds and reports in a few lines.
#include "pliant/describe.h"

#include <array>
#include <cstdio>
#include <utility>
#include <variant>

#include "pliant/measurements.h"

namespace pliant {

namespace {

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return digits;
}

/// "3 particles", "1 body"; nothing for none.
std::string count_of(std::size_t count, const char* one, const char* several) {
  if (count == 0) return {};
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

std::string joined(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts)
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string line_of(const Object& object) {
  std::size_t constraints = 0;
  for (const ConstraintGroup& group : object.constraints) constraints += group.particles.size();
  return "\n  object '" + object.name + "': " +
         joined({count_of(object.positions.size(), "particle", "particles"),
                 count_of(object.triangles.size(), "triangle", "triangles"),
                 count_of(object.bodies.size(), "body", "bodies"), count_of(object.joints.size(), "joint", "joints"),
                 count_of(constraints, "constraint", "constraints"), count_of(object.pins.size(), "pin", "pins"),
                 count_of(object.attachments.size(), "attachment", "attachments")});
}

std::string word_of(const Shape& shape) {
  constexpr std::array<const char*, 4> words{"plane", "sphere", "capsule", "box"};
  static_assert(std::variant_size_v<Shape> == words.size());
  return words.at(shape.index());
}

std::string word_of(MeshCollider::As as) {
  constexpr std::array<const char*, 3> words{"triangles", "distance grid", "heightfield"};
  return words.at(static_cast<std::size_t>(as));
}

std::string words_of(const Settings& settings) {
  const std::string substeps = settings.substeps == 0
                                   ? "substeps as needed"
                                   : count_of(static_cast<std::size_t>(settings.substeps), "substep", "substeps");
  return substeps + ", sweep " + sweep_name(settings.sweep);
}

}  // namespace

std::string describe(const Scene& scene) {
  const Vec3f& g = scene.gravity;
  std::string text = "Scene of " + std::to_string(scene.frames) + " frames of " + short_number(scene.frame_time) +
                     " s, gravity (" + short_number(g.x) + ", " + short_number(g.y) + ", " + short_number(g.z) +
                     ") m/s^2, " + words_of(scene.settings);
  for (const Object& object : scene.objects) text += line_of(object);
  for (const Collider& collider : scene.colliders)
    text += "\n  collider '" + collider.name + "': " + word_of(collider.shape);
  for (const MeshCollider& collider : scene.mesh_colliders)
    text += "\n  collider '" + collider.name + "': mesh of " +
            count_of(collider.mesh.triangles.size(), "triangle", "triangles") + " as " + word_of(collider.as);
  return text;
}

std::string describe(const World& world) {
  std::string text = "World at frame " + std::to_string(world.state().frame) + ", time " +
                     short_number(world.state().time) + " s, " + words_of(world.settings()) + ", " +
                     count_of(static_cast<std::size_t>(world.threads()), "thread", "threads") + ", " + world.isa();
  for (const ObjectId id : world.objects()) {
    const ObjectInfo info = world.object(id).info();
    text += "\n  object '" + info.name +
            "': " + count_of(static_cast<std::size_t>(info.particles), "particle", "particles");
    for (const auto& [type, count] : info.constraints) text += ", " + std::to_string(count) + " " + type;
  }
  for (const ColliderId id : world.colliders()) text += "\n  collider '" + world.collider(id).name() + "'";
  for (const MeshColliderId id : world.mesh_colliders())
    text += "\n  collider '" + world.mesh_collider(id).name() + "': mesh of " +
            std::to_string(world.mesh_collider(id).vertex_count()) + " vertices";
  return text;
}

std::string describe(const Report& report) {
  std::string text = "Report of frame " + std::to_string(report.frame) + " at " + short_number(report.time) +
                     " s: " + short_number(report.milliseconds) + " ms, " + std::to_string(report.substeps) +
                     " substeps, " + std::to_string(report.contacts + report.pairs.contacts) + " contacts";
  if (report.overstretch)
    text += ", overstretch " + short_number(100 * report.overstretch->p99) + " % (99th percentile), " +
            short_number(100 * report.overstretch->largest) + " % (largest)";
  if (report.stopped) text += ", stopped within the frame";
  const std::string words = report.explain();
  return words.empty() ? text : text + "\n" + words;
}

}  // namespace pliant
