// Contacts between particles and colliders: found in each substep, projected with the constraints, and followed by
// friction and restitution.
//
// A contact with a static or kinematic collider involves a single particle. So these contacts are independent of one
// another, and are found and solved tile by tile.
#pragma once

#include <vector>

#include "collision/fields/collider_pose.h"
#include "collision/fields/solid_field.h"
#include "collision/narrow/point_contact.h"
#include "collision/proxies/contact_tables.h"
#include "constraints/contact.h"
#include "geometry/shapes.h"
#include "model/control.h"
#include "model/model.h"
#include "model/substep.h"

namespace pliant {

class NearPoints;

/// What the scene's `pairs` say of a collider and one object.
struct NamedPair {
  std::string object;
  PairProperties said;  ///< its thickness includes that of the collider
};

/// A collider during one substep.
struct MovingCollider {
  LocalShape shape;
  const SolidField* field = nullptr;  ///< distance field, used instead of the shape; null for a primitive
  std::uint32_t groups = 1, mask = ~0u;
  Pose<float> before, after;  ///< poses of the collider's frame at the substep's start and end
  bool moves = false;
  BoundingBox<float> swept{};  ///< encloses the shape and its thickness in both poses
  float thickness = 0;         ///< thickness of the collider alone [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
  const std::vector<NamedPair>* named = nullptr;  ///< null: the scene's `pairs` do not name it
  Vec3f slide{};  ///< how far the surface moves along itself in the substep by its surface velocity, in world axes [m]

  bool slides() const { return slide != Vec3f{}; }
};

/// The contact properties of an object and a collider. The thickness includes that of the collider.
PairMaterial material_of(const CompiledObject& object, const MovingCollider& collider);

/// That thickness without the collider's own [m].
float thickness_of(const CompiledObject& object, const MovingCollider& collider);

/// True if an object and a collider can meet. Primitive colliders meet every object.
bool meet(const CompiledObject& object, const MovingCollider& collider);

/// Adds what a collider's surface moves along itself to the motion of a contact with it.
void add_slide(const MovingCollider& collider, Contact& contact);

/// Moves the colliders to their poses between two times, by user control if there is any, else by keyframes.
void move_colliders(const Model& model, const Control& control, double time_before, double time_after,
                    std::vector<MovingCollider>& colliders);

/// The inputs of the search for contacts of one tile's particles with colliders.
struct ContactSearch {
  const CompiledObject& object;
  const AdvanceArguments& particles;  ///< particles of the tile, with predicted displacements
  const PointBounds& bounds;          ///< encloses the particles before and after the predicted displacement
  const std::vector<MovingCollider>& colliders;
  int (*find_near)(const NearQuery& query, std::int32_t* near);  ///< the kernel StepKernels::find_near
  /// ContactKernels::make_point_contacts, or null for one particle at a time.
  MakePointContacts make_contacts = nullptr;
  const std::vector<int>* near_colliders = nullptr;  ///< the colliders that may be near the tile, ascending; null: all
  NearPoints* near_points = nullptr;  ///< of the tile; null: all its particles are tested. Numbers as in the State
  int first_of_object = 0;            ///< the number of the object's first particle in `near_points`
  float largest_displacement = 0;     ///< of the particles in `near_points` [m]
};

/// Appends the contacts of a tile's particles, ordered by collider, then by particle. `near` is scratch memory.
void find_contacts(const ContactSearch& search, std::vector<std::int32_t>& near, std::vector<Contact>& contacts);

/// Appends contacts of thickness 0 for particles whose displacements end below a plane collider, ordered by collider,
/// then by particle. Skips pairs of particle and collider that have a contact in `known`. Particles of liquids also get
/// contacts, of a tenth of their thickness, with all other colliders that their displacements enter.
void find_breaches(const ContactSearch& search, const std::vector<Contact>& known, std::vector<std::int32_t>& near,
                   std::vector<Contact>& contacts);

/// Merges two lists ordered by collider, then by particle. `first` wins where both have the same collider and particle.
void merge_contacts(const std::vector<Contact>& first, const std::vector<Contact>& second, std::vector<Contact>& all);

/// Projects each contact once: the normal constraint, then friction within the cone of all normal corrections so far.
void project_contacts(std::vector<Contact>& contacts, const SweepArguments& arguments);

/// Restitution after the velocity update. The normal velocity of an active contact becomes -e times its approach
/// velocity, or zero if the approach was not faster than gravity causes in two substeps.
///
/// `gravity` is the gravity of this frame that the velocities do not include yet.
void respond(const std::vector<Contact>& contacts, const Vec3f& gravity, const AdvanceArguments& particles);

}  // namespace pliant
