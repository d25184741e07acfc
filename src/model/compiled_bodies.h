// The rigid bodies of a compiled object: where they are in the State, and their solids as convex shapes.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/convex_shape.h"
#include "pliant/scene.h"

namespace pliant {

/// One convex solid of a body.
struct CompiledSolid {
  int body = 0;  ///< index in CompiledBodies::bodies
  ConvexShape shape;
  Posed pose{};          ///< of the shape in the body's principal axes, about its centre of mass
  Vec3f half_extents{};  ///< of a box; zero for other shapes [m]
};

/// The orientation of a body that follows its pin: the pin turns, or nothing else can turn the body.
struct DrivenFrame {
  int frame = 0;  ///< index among the object's frames
  Quatd rest{};   ///< at time 0, without the motion
  Motion motion;
};

struct CompiledBodies {
  struct Body {
    int particle = 0;  ///< storage index of the centre of mass
    int frame = 0;     ///< index of the orientation, among the object's frames
  };
  /// What messages and poses need of a body.
  struct Label {
    std::string name;
    Posed described;  ///< the frame in which it was described, in its principal axes about its centre of mass
  };
  std::vector<Body> bodies;           ///< in the order of Object::bodies
  std::vector<Label> labels;          ///< likewise
  std::vector<CompiledSolid> solids;  ///< body after body
  /// Pairs of bodies with a constraint between them, which do not collide; sorted.
  std::vector<std::pair<int, int>> jointed;
  std::vector<std::pair<int, int>> attached;  ///< particles and the bodies to which a constraint ties them; likewise
  /// [attached] mean length at the start of the edges at the particle; 0: it has none [m]
  std::vector<double> edge_lengths;
  std::vector<DrivenFrame> driven;                           ///< of bodies that follow their pins, by body
  std::vector<Vec3f> surface_velocities;                     ///< [body] in principal axes; empty if none has one [m/s]
  std::shared_ptr<const std::vector<Polyhedron>> polyhedra;  ///< what shapes point to; each different one once

  bool empty() const { return bodies.empty(); }
  /// True if a particle, by storage index, is the centre of a body. Such particles touch nothing by themselves.
  bool has_centre(int particle) const {
    return !is_centre.empty() && is_centre[static_cast<std::size_t>(particle)] != 0;
  }
  std::vector<char> is_centre;  ///< [particle]; empty without bodies
};

/// The words for a body in messages: "body 3 ('wheel') of 'car'", or "body 3 of 'car'" if it has no name of its own.
std::string words_of_body(const CompiledBodies& bodies, int body, const std::string& object);

/// Compiles the bodies of an object. `place` are the storage indices of its particles.
CompiledBodies compile_bodies(const Object& object, const std::vector<int>& place, int particles);

/// The convex shape of a solid or primitive collider other than a plane. A box or hull points to a polyhedron of
/// `polyhedra`, which has room for it.
ConvexShape convex_shape_of(const SolidShape& shape, std::vector<Polyhedron>& polyhedra);

}  // namespace pliant
