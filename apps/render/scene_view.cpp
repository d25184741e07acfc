// Makes a RenderScene of a Scene and its World.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>

#include "geometry.h"
#include "io/write_frames.h"
#include "joint_view.h"
#include "matrix.h"
#include "pliant/edit.h"
#include "pliant/soft_body.h"
#include "pliant/surface.h"
#include "render.h"
#include "rod_view.h"

namespace pliant::render {

namespace {

/// The lowest point of an object's bodies at the start.
float lowest_body(const Object& object) {
  float low = std::numeric_limits<float>::infinity();
  const output::FrameObject shape = output::describe(object);
  for (std::size_t b = 0; b < object.bodies.size(); ++b) {
    const ObjectBody& body = object.bodies[b];
    const Quatf& rotation = object.frames[static_cast<std::size_t>(body.frame)].orientation;
    const Vec3f& centre = object.positions[static_cast<std::size_t>(body.particle)];
    for (const Vec3f& p : shape.solids[static_cast<std::size_t>(shape.bodies[b].solid)].positions)
      low = std::min(low, centre.y + rotate(rotation, p).y);
  }
  return std::isfinite(low) ? low : 0;
}

/// The lowest height that an object can reach: a hanging one can swing down by its size, a falling one lands on
/// something.
float lowest(const Object& object) {
  Bounds all, held;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    all.include(object.positions[i]);
    if (i < object.masses.size() && !std::isfinite(object.masses[i])) held.include(object.positions[i]);
  }
  if (!object.bodies.empty()) return lowest_body(object);
  for (const Pin& pin : object.pins)
    if (pin.particle >= 0 && pin.particle < static_cast<int>(object.positions.size()))
      held.include(object.positions[pin.particle]);
  for (const Attachment& attachment : object.attachments) held.include(attachment.target);
  if (all.empty()) return 0;
  return held.empty() ? all.low.y : std::min(all.low.y, held.low.y - 2 * all.radius());
}

/// The height of the ground: that of the lowest horizontal plane, otherwise 0, or less if the scene extends below. It
/// depends on the Scene alone, so it is constant in a movie.
float ground_height(const Scene& scene, const std::vector<RenderCollider>& at_rest) {
  bool level = false, tilted = false;
  float plane = 0, low = 0;
  for (const RenderCollider& collider : at_rest) {
    if (is_level_plane(collider)) {
      plane = level ? std::min(plane, collider.position.y) : collider.position.y;
      level = true;
    } else if (std::holds_alternative<Plane>(collider.shape)) {
      tilted = true;
    }
  }
  if (level) return plane;
  Bounds all;
  for (const Object& object : scene.objects) {
    low = std::min(low, lowest(object));
    for (const Vec3f& position : object.positions) all.include(position);
  }
  for (const Vec3f& point : points_of_interest({.meshes = {},
                            .tubes = {},
                            .colliders = at_rest,
                            .ground = {},
                            .camera = {},
                            .extent = {},
                            .bodies = {},
                            .balls = {},
                            .smokes = {},
                            .unseen = {}}))
    low = std::min(low, point.y);
  for (const MeshCollider& collider : scene.mesh_colliders)
    for (const Vec3f& position : collider.mesh.positions) low = std::min(low, position.y);
  if (tilted && !all.empty()) low = std::min(low, all.low.y - all.radius());
  return low < 0 ? low - 0.02f * all.radius() : 0;
}

/// Colours of neighbouring bodies differ in brightness, so that a pile can be read: a share of 0.75 to 1.15 by index.
Vec3f body_colour(const Vec3f& colour, std::size_t body) {
  constexpr std::array<float, 7> shares{1, 0.82f, 1.12f, 0.9f, 1.06f, 0.76f, 0.96f};
  const Vec3f lit = colour * shares[body % shares.size()];
  return {std::min(lit.x, 1.f), std::min(lit.y, 1.f), std::min(lit.z, 1.f)};
}

/// Bodies that sleep are paler and bluish, so that pictures show what is awake.
Vec3f sleeping_colour(const Vec3f& colour) { return colour * 0.3f + Vec3f{0.36f, 0.42f, 0.52f}; }

void add_bodies(RenderScene& result, const Object& object, const output::FrameObject& shape, const ObjectView& view) {
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  for (const TriangleMesh& solid : shape.solids) meshes.push_back(std::make_shared<const TriangleMesh>(solid));
  const std::vector<output::BodyMotion> motions = output::body_motions(object, view);
  const std::vector<char> segments = rod_segments(object);
  const auto colour_of = [&](std::size_t body, std::size_t number) {
    const Vec3f awake = body_colour(shape.colour, number);
    return view.body_is_asleep(static_cast<int>(body)) ? sleeping_colour(awake) : awake;
  };
  for (std::size_t b = 0; b < motions.size(); ++b) {
    if (segments[b] != 0) continue;
    const bool is_fixed = !std::isfinite(object.masses[static_cast<std::size_t>(object.bodies[b].particle)]);
    result.bodies.push_back(
        {meshes[static_cast<std::size_t>(shape.bodies[b].solid)], motions[b].pose, colour_of(b, b), is_fixed});
  }
  for (RodPart& part : rod_parts(object, view, motions, segments)) {
    part.tube.colour = colour_of(part.first, part.rod);
    result.tubes.push_back(std::move(part.tube));
  }
}

/// Draws particles that are much heavier than others as balls, with a volume in proportion to their mass. A ball of
/// equal mass would have twice the line's thickness.
void add_weights(RenderScene& result, const Object& object, const std::vector<Vec3f>& positions) {
  constexpr float much = 2.5f;  // more than the ratio between particles in the middle and at the end of a rope
  std::vector<float> masses;
  std::copy_if(object.masses.begin(), object.masses.end(), std::back_inserter(masses),
               [](float mass) { return std::isfinite(mass); });
  if (masses.empty()) return;
  const auto middle = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  const float usual = *middle;
  for (std::size_t i = 0; i < object.masses.size(); ++i) {
    const float mass = object.masses[i];
    const auto is_centre = [i](const ObjectBody& body) { return body.particle == static_cast<int>(i); };
    if (!std::isfinite(mass) || mass < much * usual) continue;
    if (std::any_of(object.bodies.begin(), object.bodies.end(), is_centre)) continue;  // drawn with its solids
    const float radius = 2 * object.thickness * std::min(std::cbrt(mass / usual), 10.f);
    result.tubes.push_back({.points = {positions[i]}, .radius = radius, .colour = object.colour});
  }
}

/// Draws the surface of a liquid. Particles that are not finite, or far away, are left out.
void add_liquid(RenderScene& result, const Object& object, std::vector<Vec3f> positions, const Vec3f& colour) {
  const float spacing = object.fluid->spacing, most = 1e6f * spacing;
  std::erase_if(positions, [&](const Vec3f& p) {
    return !(std::abs(p.x) < most && std::abs(p.y) < most && std::abs(p.z) < most);
  });
  TriangleMesh surface = liquid_surface(positions, {.spacing = spacing});
  result.meshes.push_back({.positions = std::move(surface.positions),
                           .triangles = std::move(surface.triangles),
                           .colour = colour,
                           .is_liquid = true,
                           .clarity = object.fluid->clarity});
}

/// Places in a pattern of checks on a sheet that is flat at rest, along the axes of the world in which it extends; none
/// on other surfaces. The pattern shows how the sheet bends, which an even colour hides.
std::vector<std::array<float, 2>> checks_of(const Object& object) {
  constexpr float along_the_longer_side = 16;
  Bounds box;
  for (const Vec3f& p : object.positions) box.include(p);
  const Vec3f size = box.high - box.low;
  std::array<float Vec3f::*, 3> axes{&Vec3f::x, &Vec3f::y, &Vec3f::z};
  std::sort(axes.begin(), axes.end(), [&](auto a, auto b) { return size.*a > size.*b; });
  if (object.volume || !(size.*axes[1] > 0) || size.*axes[2] > 1e-3f * size.*axes[1]) return {};
  const float scale = along_the_longer_side / (size.*axes[0]);
  std::vector<std::array<float, 2>> checks;
  for (const Vec3f& p : object.positions)
    checks.push_back({(p.*axes[0] - box.low.*axes[0]) * scale, (p.*axes[1] - box.low.*axes[1]) * scale});
  return checks;
}

/// The clarity of an object's surface, which must be closed to have an inside [m].
float clarity_of(const Object& object) {
  const bool is_closed = object.skin || object.volume || !object.clusters.empty() || !tetrahedra_of(object).empty();
  return is_closed ? object.clarity : 0;
}

/// True for grains of which each belongs to a cluster.
bool keeps_shape(const Object& object) {
  std::vector<char> is_in(object.positions.size(), 0);
  for (const Cluster& cluster : object.clusters)
    for (const int i : cluster.particles) is_in[static_cast<std::size_t>(i)] = 1;
  return object.grains && !is_in.empty() && std::count(is_in.begin(), is_in.end(), 0) == 0;
}

/// Draws grains that keep a shape as the surface around them: a stone, a jelly, clay.
void add_block(RenderScene& result, const Object& object, const std::vector<Vec3f>& positions, const Vec3f& colour) {
  const bool is_finite = std::all_of(positions.begin(), positions.end(), [](const Vec3f& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
  if (!is_finite) return;
  TriangleMesh surface = liquid_surface(positions, {.spacing = 2 * object.thickness});
  result.meshes.push_back({.positions = std::move(surface.positions),
                           .triangles = std::move(surface.triangles),
                           .colour = colour,
                           .clarity = object.clarity});
}

/// Draws tracers as smoke that thins out with age.
void add_smoke(RenderScene& result, const Object& object, const ObjectView& view, const std::vector<Vec3f>& positions) {
  const std::vector<float> ages = view.channel("age");
  RenderSmoke smoke{.centres = {},
                    .strengths = {},
                    .radius = object.tracers->radius,
                    .opacity = object.tracers->opacity,
                    .colour = object.colour};
  for (std::size_t i = 0; i < ages.size(); ++i) {
    if (ages[i] < 0) continue;
    const float left = std::clamp(1 - ages[i] / object.tracers->lifetime, 0.f, 1.f);
    smoke.centres.push_back(positions[i]);
    smoke.strengths.push_back(left * std::min(1.f, 8 * (1 - left) + 0.2f));
  }
  result.smokes.push_back(std::move(smoke));
}

/// What each particle of a surface holds of its capacity.
std::vector<float> wetness_of(const Object& object, const ObjectView& view) {
  std::vector<float> areas(object.positions.size()), wetness = view.channel("water");
  const auto place = [&](int particle) { return object.positions[static_cast<std::size_t>(particle)]; };
  for (const auto& [a, b, c] : object.triangles) {
    const Vec3f normal = cross(place(b) - place(a), place(c) - place(a));
    const float third = std::sqrt(dot(normal, normal)) / 6;
    for (const int corner : {a, b, c}) areas[static_cast<std::size_t>(corner)] += third;
  }
  for (std::size_t i = 0; i < wetness.size(); ++i)
    wetness[i] = areas[i] > 0 ? wetness[i] / (areas[i] * object.absorbency->capacity) : 0;
  return wetness;
}

void add_object(RenderScene& result, const Object& described, const ObjectView& view) {
  const Object& object = comes_apart(described) ? view.description() : described;
  const output::FrameObject shape = output::describe(object);
  std::vector<Vec3f> positions = view.present_positions();
  add_bodies(result, object, shape, view);
  add_joints(result, object, shape, view);
  if (!shape.has_matter()) return;
  if (object.tracers) return add_smoke(result, object, view, positions);
  if (object.gas) {  // clear, but smoke will be where it is
    Bounds box;
    for (const Vec3f& p : object.positions) box.include(p);
    for (const float x : {box.low.x, box.high.x})
      for (const float y : {box.low.y, box.high.y})
        for (const float z : {box.low.z, box.high.z}) result.unseen.push_back({x, y, z});
    return;
  }
  if (object.fluid) return add_liquid(result, object, std::move(positions), shape.colour);
  if (!shape.triangles.empty()) {
    if (object.skin) positions = skinned(*object.skin, positions);
    result.meshes.push_back({.positions = std::move(positions),
                             .triangles = shape.triangles,
                             .colour = shape.colour,
                             .clarity = clarity_of(object)});
    if (!object.skin && !tetrahedra_of(object).empty()) result.meshes.back().creased = object.positions;
    if (!object.skin && tetrahedra_of(object).empty()) result.meshes.back().checks = checks_of(object);
    if (object.absorbency && !object.skin) result.meshes.back().wetness = wetness_of(object, view);
    return;
  }
  for (const auto& line : shape.lines) {
    RenderTube tube{.points = {}, .radius = object.thickness, .colour = shape.colour};
    for (const int i : line) tube.points.push_back(positions[i]);
    result.tubes.push_back(std::move(tube));
  }
  if (!shape.lines.empty()) return add_weights(result, object, positions);
  if (object.positions.size() < 2) {
    for (const Vec3f& position : positions)
      result.tubes.push_back({.points = {position}, .radius = object.thickness, .colour = shape.colour});
    return;
  }
  if (keeps_shape(object)) return add_block(result, object, positions, shape.colour);
  result.balls.push_back({.centres = std::move(positions),
                          .radius = object.thickness,
                          .colour = shape.colour,
                          .are_grains = object.grains.has_value()});
}

}  // namespace

RenderScene make_render_scene(const Scene& scene, const World& world) {
  RenderScene result;
  std::vector<RenderCollider> at_rest;
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    const int index = static_cast<int>(i);
    at_rest.push_back({collider.shape, collider.position, collider.rotation, collider.colour});
    result.colliders.push_back({collider.shape, world.collider(index).pose().position,
                                world.collider(index).pose().rotation, collider.colour});
  }
  result.ground = ground_height(scene, at_rest);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    add_object(result, scene.objects[i], world.object(static_cast<int>(i)));
  for (std::size_t i = 0; i < scene.mesh_colliders.size(); ++i) {
    const MeshCollider& collider = scene.mesh_colliders[i];
    result.meshes.push_back(
        {world.mesh_collider(static_cast<int>(i)).positions(), collider.mesh.triangles, collider.colour, true});
  }
  return result;
}

}  // namespace pliant::render
