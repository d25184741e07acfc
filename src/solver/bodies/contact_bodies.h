// The rigid bodies and colliders between which contacts of bodies are: their parts, materials and poses.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/bodies/body_contacts.h"
#include "collision/narrow/contact.h"
#include "collision/proxies/contact_rules.h"
#include "model/model.h"
#include "solver/bodies/manifolds.h"
#include "solver/bodies/mesh_motion.h"

namespace pliant {

struct Substep;

/// The meshes of a World's mesh colliders as bodies touch them, by object and generation. They are kept, because to
/// make one takes longer than a frame.
struct BodyMeshes {
  struct Entry {
    int generation = 0;
    bool is_deformed = false;  ///< true: moved to places in the world, so its pose is the identity
    std::unique_ptr<BodyMesh> mesh;
    // Of a deformed mesh:
    std::vector<Vec3f> velocities{};  ///< mean ones of its vertices in the frame [m/s]
    Vec3f velocity{};                 ///< the mean of those [m/s]
    float deforming = 0;              ///< greatest difference from that mean [m/s]
  };
  std::map<int, Entry> of_object;
};

/// Where a body is in the State; or a collider.
struct BodyPlace {
  int object = -1, body = -1;   ///< index in Model::objects, and among the object's bodies
  int particle = 0, frame = 0;  ///< indices in the State
  int collider = -1;            ///< >= 0: a primitive collider instead: index in SubstepScratch::colliders
  BodyMesh* mesh = nullptr;     ///< or that of mesh collider `object`

  bool is_body() const { return collider < 0 && mesh == nullptr; }
};

class ContactBodies {
 public:
  /// The bodies of the given objects, or of all if it is null, and all colliders.
  ContactBodies(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes);

  /// Bodies of objects, then colliders; only bodies are there if there are none.
  const std::vector<BodyPlace>& places() const { return places_; }
  /// The number of bodies of objects.
  int dynamic() const { return dynamic_; }
  const ContactRules& rules() const { return rules_; }
  /// The parts of all places, in ascending order of owners. They point to shapes that are kept here.
  std::vector<BodyPart> take_parts() { return std::move(parts_); }

  /// One for each principal axis about which the solids of a body of an object are round, else zero.
  Vec3f round_axes(int body) const { return round_[static_cast<std::size_t>(body)]; }
  /// "body 3 of 'pile'", or the name of a collider.
  std::string name(const Model& model, int place) const;
  /// Whether two places may touch. It changes as joints break.
  bool meet(const Substep& s, int a, int b) const;
  BodyMaterial material(const Model& model, int a, int b) const;

  /// Finds where colliders are at the substep's start and the frame's end.
  void begin_frame(const Substep& s);
  /// The state of a place at the substep's start. At a frame's start, moves the vertices of a mesh that deforms to
  /// where they are.
  BodyState state_at_start(const Substep& s, int place);
  /// The poses of a collider before and after the substep.
  std::pair<Posed, Posed> poses_of_collider(const Substep& s, int place) const;
  /// The motion in this frame of the mesh of a contact, which deforms.
  SurfaceMotion motion_of_surface(const Model& model, int place, const BodyContact& contact) const;

 private:
  void add_object(const Model& model, int object, std::vector<BodyPart>& parts);
  void add_collider(const Model& model, int collider);
  void add_mesh(const Model& model, int object);
  bool meets_mesh(const Model& model, const BodyPlace& body, const BodyPlace& mesh) const;
  BodyMaterial sliding(const Model& model, int a, int b) const;
  std::pair<float, float> rolling(const Model& model, const BodyPlace& place) const;
  void move_vertices(const Substep& s, const BodyPlace& place);
  BodyState deformed_at_start(const Substep& s, const BodyPlace& place) const;
  bool is_deformed(const Substep& s, const BodyPlace& place) const;
  std::pair<Posed, Posed> rigid_poses(const Substep& s, const BodyPlace& place, double before, double after) const;
  std::pair<Posed, Posed> poses_of_mesh(const Substep& s, const BodyPlace& place, double before, double after) const;
  BodyState collider_at_start(const Substep& s, const BodyPlace& place);
  void drive(const Substep& s, int body, BodyState& state) const;
  static void drive_to_target(const Substep& s, const BodyPlace& place, BodyState& state);

  ContactRules rules_;
  BodyMeshes* meshes_ = nullptr;
  std::vector<BodyPlace> places_;
  int dynamic_ = 0;
  std::vector<BodyPart> parts_;
  std::vector<Vec3f> round_;  ///< [body]
  std::vector<int> driven_;   ///< [body] index in CompiledBodies::driven of its object; -1: it is not driven
  std::vector<Polyhedron> collider_shapes_;
  std::vector<MovingCollider> colliders_at_start_;  ///< their poses are those at the frame's start and end
};

}  // namespace pliant
