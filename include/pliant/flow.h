// Particles that come and go: emitters, drains and lifetimes of liquids and grains.
#pragma once

#include <string>
#include <vector>

#include "pliant/motion.h"
#include "pliant/shape.h"
#include "pliant/vec3.h"

namespace pliant {

/// Emits layers of particles through a flat opening. Layers are cubic lattices that follow one another at the distance
/// of particles at rest, so that they neither overlap nor leave gaps. The opening holds two layers behind it, and those
/// that pass it in the next frame: they move as it says, and cannot be pushed back. The space there must be free.
struct Emitter {
  std::string name = "emitter";
  Vec3f position{};             ///< centre of the opening [m]
  Vec3f direction{0, -1, 0};    ///< of what is emitted, of any length but 0
  Vec3f across{};               ///< along a rectangle's width, square to `direction`; 0: level [m]
  float radius = 0;             ///< of a disc [m]; 0: the opening is a rectangle
  float width = 0, height = 0;  ///< of a rectangle [m]
  float speed = 0;              ///< through the opening, against it if it moves [m/s]; 0: it follows from `flow`
  float flow = 0;  ///< volume of particles a second [m^3/s]; 0: it follows from `speed`. One of both must be above 0
  float start = 0, end = 3e38f;  ///< time of the first and the last layer [s]
  Motion motion{};               ///< of the opening, whose velocity is added to that of what it emits
};

/// A solid that takes away every particle whose centre is in it when a frame begins.
struct Drain {
  std::string name = "drain";
  Shape shape{Box{}};
  Vec3f position{};  ///< of the shape's frame [m]
  Quatf rotation{};
};

/// How particles of an object come and go.
struct Flow {
  std::vector<Emitter> emitters;
  std::vector<Drain> drains;
  float lifetime = 0;  ///< for which a particle stays [s]; 0: for ever
  int spare = 0;       ///< how many of the last of Object::positions are not there at the start, but may be emitted
  /// True: they may come and go for other reasons. A World sets it for liquids that may soak in (Absorbency)
  bool open = false;

  /// True if particles can come or go.
  bool is_used() const { return !emitters.empty() || !drains.empty() || lifetime > 0 || spare > 0 || open; }
};

/// What an emitter makes of its opening: the places of a layer, and how fast they go.
struct EmitterLayer {
  std::vector<Vec3f> places;  ///< across the opening, about its centre [m]
  float speed = 0;            ///< [m/s]
  float flow = 0;             ///< volume of particles a second [m^3/s]
  float distance = 0;         ///< from a layer to the next [m]
};

struct Object;

/// The layers that an emitter makes of an object's particles. Particles are a spacing apart; grains 1.1 diameters, and
/// each is up to 0.05 diameters off its place, differently in each layer, because spheres that fall exactly on one
/// another would stand.
EmitterLayer layer_of(const Emitter& emitter, const Object& object);

}  // namespace pliant
