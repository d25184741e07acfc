// Contacts of edges and triangles with spheres, capsules and boxes, so that edges do not cut corners and small spheres
// do not pass through triangles. Vertex contacts come from contact.h; planes need only those.
//
//   edge       contact at its closest point, with weights 1 - t, t
//   triangle   contact at the centre of a sphere, the ends of a capsule's axis, or the corners of a box
//
// An element has a contact only if it comes nearer to the solid than its vertices by more than least_dip; otherwise
// vertex contacts suffice. The test uses the prediction, which depends on positions and velocities alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_element_contacts.h"
#include "collision/narrow/shape_elements.h"
#include "parallel/executor.h"

namespace pliant {

/// The inputs of the search for shape contacts in a substep.
struct ShapeContactSearch {
  const Model& model;
  const std::vector<MovingCollider>& colliders;
  FunctionRef<AdvanceArguments(int task)> particles;  ///< the particles of a task's tile
  /// Encloses the tile's particles at the substep's start and predicted.
  FunctionRef<const PointBounds&(int task)> bounds;
  const std::vector<int>* tasks = nullptr;  ///< tasks whose tiles take part, ascending; null: all
  /// Of each of `tasks` the colliders that may be near, ascending; null: all.
  const std::vector<const std::vector<int>*>* near_colliders = nullptr;
};

/// Scratch memory of one thread.
struct ShapeContactScratch {
  std::vector<BoundingBox<float>> boxes;  ///< swept box of each cluster of a tile
  std::vector<float> paths;               ///< upper bounds of the displacements of each cluster's vertices [m]
  std::vector<VertexWay> ways;            ///< paths of a cluster's vertices
  std::vector<std::uint16_t> outcodes;
  std::vector<Contact> contacts;
};

class ShapeContacts {
 public:
  /// Prepares the elements of an object; call it after the object or the colliders were added or changed.
  void prepare(const Model& model, int object);
  /// The same for given shapes instead of the model's colliders.
  void prepare(const Model& model, int object, std::span<const LocalShape> shapes);

  /// Finds the contacts of the substep, ordered by tile, then by collider. Searches of different tiles may run at the
  /// same time.
  void detect(Executor& executor, const ShapeContactSearch& search, std::vector<Contact>& found);

 private:
  void detect_tile(const ShapeContactSearch& search, int task, const std::vector<int>* near);

  std::vector<ShapeElements> elements_;       ///< elements of each object
  std::vector<ShapeContactScratch> scratch_;  ///< scratch of each task of the model
};

/// Applies restitution after the velocity update, as respond() of contact.h does. `missing` is the gravity that
/// velocities do not include yet [m/s].
void respond_to_shape_contact(const Contact& contact, Record* velocities, const Vec3f& missing, float slow,
                              float inverse_h);

}  // namespace pliant
