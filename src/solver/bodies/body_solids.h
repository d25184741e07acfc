// The solids of rigid bodies as the points of surfaces see them: like primitive colliders that move with their body's
// prediction.
#pragma once

#include <memory>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/proxies/contact_rules.h"
#include "geometry/convex_shape.h"
#include "model/model.h"
#include "solver/bodies/point_loads.h"

namespace pliant {

struct Substep;

class BodySolids {
 public:
  BodySolids() = default;
  /// Bodies without solids. `rules` stay where they are.
  BodySolids(const std::vector<TouchedBody>& bodies, const ContactRules& rules) : rules_(&rules), bodies_(bodies) {}
  /// Adds the solids of the bodies, which may take distance grids.
  void add_solids(const Model& model);

  bool empty() const { return solids_.empty(); }
  const std::vector<TouchedBody>& bodies() const { return bodies_; }
  /// The index among bodies() of the body of each solid.
  const std::vector<int>& body_of_solid() const { return body_of_solid_; }
  int number_of(const Contact& contact) const { return body_of_solid_[static_cast<std::size_t>(contact.collider)]; }
  const TouchedBody& body_of(const Contact& contact) const {
    return bodies_[static_cast<std::size_t>(number_of(contact))];
  }
  /// The solids themselves, and those that points touch as primitives.
  std::vector<ConvexShape> convex_shapes() const;
  std::vector<LocalShape> primitives() const;
  /// False if the points of a contact may not touch its body: by groups and masks, or because they are tied to it.
  bool meets(const Model& model, const Contact& contact) const;
  /// False if the particles of an object may not touch the body of a solid, by groups and masks.
  bool meets_object(int object, int solid) const {
    const int body = body_of_solid_[static_cast<std::size_t>(solid)];
    return rules_->meet(object, bodies_[static_cast<std::size_t>(body)].object);
  }

  /// Keeps where bodies are, before the next prediction.
  void keep_poses(const Substep& s);
  const Posef& pose_at_start(int body) const { return poses_[static_cast<std::size_t>(body)]; }
  /// Finds where displacements put the solids.
  void place(const Substep& s);
  /// In the substep, from its start to where they were placed last.
  const std::vector<MovingCollider>& moving() const { return moving_; }

 private:
  struct Solid {
    int body = 0;
    LocalShape shape;
    Posef pose{};                             ///< of the shape in the body's frame
    std::shared_ptr<const SolidField> field;  ///< instead of the shape where that is no primitive; null: a primitive
    float margin = 0;                         ///< around the field [m]
    ConvexShape convex{};                     ///< the solid itself, for the filter
    std::vector<NamedPair> named{};           ///< objects that the scene's `pairs` name with its body
  };

  const ContactRules* rules_ = nullptr;
  std::vector<TouchedBody> bodies_;
  std::vector<Solid> solids_;
  std::vector<int> body_of_solid_;
  std::vector<Posef> poses_;            ///< of bodies at the substep's start
  std::vector<MovingCollider> moving_;  ///< solids in the substep
};

}  // namespace pliant
