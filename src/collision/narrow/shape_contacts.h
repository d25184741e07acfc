// Contacts of edges and triangles with spheres, capsules and boxes, so that no edge cuts a corner and no small sphere slips through a
// triangle. Vertices have theirs from contact.h; planes need no more than those.
//
//   edge       the closest place on it                        weights 1 - t, t
//   triangle   the centre of a sphere, the ends of a capsule's axis, the corners of a box, where they face its inside    barycentric
//
// An element has a contact only where it comes nearer to the solid than its vertices do (least_dip): else theirs stand for it. Its elements
// are looked at where the prediction takes them, which positions and velocities alone decide.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_elements.h"
#include "parallel/executor.h"

namespace pliant {

/// What finding the contacts of a substep needs.
struct ShapeContactSearch {
  const Model& model;
  const std::vector<MovingCollider>& colliders;
  FunctionRef<AdvanceArguments(int task)> particles;  ///< of the tile of a task of the model
  FunctionRef<const PointBounds&(int task)> bounds;  ///< holds the tile's particles at the substep's start and as predicted
};

/// Of a vertex in a collider's frame, from where the substep begins to where it is predicted.
struct VertexWay {
  Vec3f from, to;
  Vec3f at(float s) const { return from + (to - from) * s; }
};

/// What one thread works with.
struct ShapeContactScratch {
  std::vector<BoundingBox<float>> boxes;  ///< around the ways of each cluster of a tile
  std::vector<float> paths;               ///< the longest of them, at least [m]
  std::vector<VertexWay> ways;            ///< of the vertices of a cluster
  std::vector<std::uint16_t> outcodes;
  std::vector<Contact> contacts;
};

class ShapeContacts {
 public:
  /// Makes the elements of an object, after it or the colliders were added or changed.
  void prepare(const Model& model, int object);

  /// Finds those of the substep, by tile, then by collider.
  void detect(Executor& executor, const ShapeContactSearch& search);

  const std::vector<Contact>& contacts() const { return contacts_; }
  std::vector<Contact>& contacts() { return contacts_; }

 private:
  void detect_tile(const ShapeContactSearch& search, int task);

  std::vector<ShapeElements> elements_;       ///< [object]
  std::vector<ShapeContactScratch> scratch_;  ///< [task of the model]
  std::vector<Contact> contacts_;
};

/// After the velocity update: the normal velocity of what touched, as respond() of contact.h has it. `missing`: what velocities lack of
/// gravity [m/s].
void respond_to_shape_contact(const Contact& contact, Record* velocities, const Vec3f& missing, float slow,
                              float inverse_h);

}  // namespace pliant
