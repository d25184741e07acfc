// Makes the layers of emitters: the lattice across the opening, and the speed at which layers of it have the wanted
// flow.
#include "model/compile_flow.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace pliant {

namespace {

/// Grains are emitted so many diameters apart, and touch nothing that is nearer than so many.
constexpr float distance_of_grains = 1.1f, room_of_grains = 0.95f, room_of_liquid = 0.5f;

Vec3f unit(const Vec3f& v) { return v * (1 / sqrt(length_squared(v))); }

/// The axes of the opening, across the direction.
struct Across {
  Vec3f width, height;
};

Across across(const Emitter& emitter) {
  const Vec3f along = unit(emitter.direction);
  Vec3f wanted = emitter.across - along * dot(emitter.across, along);
  if (!(length_squared(wanted) > 0)) wanted = cross(Vec3f{0, 1, 0}, along);
  if (!(length_squared(wanted) > 1e-6f * (1 + length_squared(emitter.across))))
    wanted = Vec3f{1, 0, 0} - along * along.x;
  const Vec3f width = unit(wanted);
  return {width, cross(along, width)};
}

/// The places along one axis of a rectangle, about its middle.
std::vector<float> places_along(float size, float distance) {
  const int count = std::max(1, static_cast<int>(std::floor(size / distance * (1 + 1e-5f))));
  std::vector<float> places;
  places.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    places.push_back(distance * (static_cast<float>(i) - static_cast<float>(count - 1) / 2));
  return places;
}

std::vector<Vec3f> places_in(const Emitter& emitter, float distance) {
  const Across axes = across(emitter);
  const bool is_disc = emitter.radius > 0;
  const float inside = std::max(emitter.radius - distance / 2, 0.f) * (1 + 1e-5f);
  const float odd = distance * (2 * std::floor(inside / distance) + 1);  // a disc has a place at its centre
  std::vector<Vec3f> places;
  for (const float v : places_along(is_disc ? odd : emitter.height, distance))
    for (const float u : places_along(is_disc ? odd : emitter.width, distance))
      if (!is_disc || u * u + v * v <= inside * inside + 1e-6f * distance * distance)
        places.push_back(axes.width * u + axes.height * v);
  return places;
}

/// The volume that a particle stands for [m^3].
float volume_of_particle(const Object& object) {
  constexpr float sphere = 4.18879020f;  // 4/3 pi
  if (!object.grains) return object.fluid->spacing * object.fluid->spacing * object.fluid->spacing;
  return sphere * object.grains->radius * object.grains->radius * object.grains->radius;
}

}  // namespace

EmitterLayer layer_of(const Emitter& emitter, const Object& object) {
  EmitterLayer layer;
  layer.distance = object.grains ? 2 * object.grains->radius * distance_of_grains : object.fluid->spacing;
  layer.places = places_in(emitter, layer.distance);
  const float volume = static_cast<float>(layer.places.size()) * volume_of_particle(object);
  layer.speed = emitter.speed > 0 ? emitter.speed : emitter.flow / volume * layer.distance;
  layer.flow = layer.speed / layer.distance * volume;
  return layer;
}

void compile_flow(const Object& object, CompiledObject& out) {
  out.flow = object.flow;
  if (!object.fluid && !object.grains) return;
  out.emitted_size =
      object.grains ? 2 * object.grains->radius * room_of_grains : object.fluid->spacing * room_of_liquid;
  out.emitted_jitter = object.grains ? 2 * object.grains->radius * (distance_of_grains - 1) / 2 : 0;
  for (const Emitter& emitter : object.flow.emitters) out.layers.push_back(layer_of(emitter, object));
}

}  // namespace pliant
