// Contacts between particles and colliders: found in each substep, projected with the constraints, and answered with
// friction and restitution.
//
// A contact with something that nothing pushes touches one particle alone, so contacts are independent of one another and
// may be found and solved tile by tile. Contacts among things that move get their own file and the same shape.
#pragma once

#include <vector>

#include "collision/fields/collider_pose.h"
#include "collision/fields/solid_field.h"
#include "constraints/contact.h"
#include "geometry/shapes.h"
#include "model/control.h"
#include "model/model.h"
#include "model/substep.h"

namespace pliant {

/// A collider during one substep.
struct MovingCollider {
  LocalShape shape;
  const SolidField* field = nullptr;  ///< in place of the shape
  std::uint32_t groups = 1, mask = ~0u;
  Pose<float> before, after;  ///< at the substep's start and end
  bool moves = false;
  BoundingBox<float> swept{};  ///< holds the shape and its thickness at both
  float thickness = 0;         ///< of the collider alone [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
};

/// The colliders of a model between two times: where `control` has them, else where their keyframes do.
void move_colliders(const Model& model, const Control& control, double time_before, double time_after,
                    std::vector<MovingCollider>& colliders);

/// What finding the contacts of one tile needs.
struct ContactSearch {
  const CompiledObject& object;
  const AdvanceArguments& particles;  ///< the tile's, with displacements as predicted
  const PointBounds& bounds;          ///< holds the particles' places before and after
  const std::vector<MovingCollider>& colliders;
  int (*find_near)(const NearQuery& query, std::int32_t* near);  ///< of Kernels
};

/// Appends the contacts of a tile, by collider, then by particle. `near` is scratch.
void find_contacts(const ContactSearch& search, std::vector<std::int32_t>& near, std::vector<Contact>& contacts);

/// Appends contacts, without thickness, of particles whose displacements end them below a plane; in the same order, and
/// none that `known` has.
void find_breaches(const ContactSearch& search, const std::vector<Contact>& known, std::vector<std::int32_t>& near,
                   std::vector<Contact>& contacts);

/// Both in one, in the order of find_contacts; where both have one of a particle with a collider, that of `first`.
void merge_contacts(const std::vector<Contact>& first, const std::vector<Contact>& second, std::vector<Contact>& all);

/// Projects each contact once: the normal constraint, then friction within the cone of the pushes so far.
void project_contacts(std::vector<Contact>& contacts, const SweepArguments& arguments);

/// After the velocity update: the normal velocity of what touched becomes -e times that of the approach, or zero where the
/// approach was no faster than gravity makes it in two substeps.
///
/// `gravity` is what the velocities do not hold yet of this frame's.
void respond(const std::vector<Contact>& contacts, const Vec3f& gravity, const AdvanceArguments& particles);

}  // namespace pliant
