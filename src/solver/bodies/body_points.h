// Contact of particles, edges and triangles with the solids of rigid bodies, in both directions: each contact moves the points of
// a surface and the body by one impulse at the point of contact, with the generalised inverse masses of both sides. The impulse
// m dx / dt of the encyclopedia entry on position based dynamics is the limit of a body much heavier than the points.
//
// Solids are found like primitive colliders that move with their body's prediction. Contacts are projected one after another, in the
// order in which they were found, because they share bodies: averages let a body fall through, sequences do not.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_contacts.h"
#include "collision/proxies/contact_rules.h"
#include "model/model.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/bodies/passing_filter.h"
#include "solver/bodies/point_loads.h"
#include "solver/bodies/surface_tiles.h"
#include "solver/bodies/swept_contacts.h"
#include "solver/contact_log.h"

namespace pliant {

struct Substep;

class BodyPoints {
 public:
  BodyPoints() = default;
  /// For objects whose particles may touch the solids of bodies. `rules` stay where they are.
  BodyPoints(const Model& model, const std::vector<int>& objects, const std::vector<TouchedBody>& bodies,
             const ContactRules& rules);

  /// False if no particle can touch a body.
  bool has_any() const { return !tasks_.empty() && !solids_.empty(); }

  /// Starts a frame: forgets contacts, because a State does not have them.
  void begin_frame(const Substep& s);
  /// Keeps where bodies are, before the next prediction.
  void keep_poses(const Substep& s);
  /// Finds the contacts of a substep, after the prediction.
  void detect(Substep& s);
  /// Projects each contact once, or those with points of the objects for which `of` is not zero. `motions` have the bodies' inverse masses and inertias, in the order of the bodies.
  void project(Substep& s, const std::vector<BodyMotion>& motions, const std::vector<char>* of = nullptr);
  /// After the iterations: keeps solids and triangles from passing one another on the way which these have given them.
  void stop_passing(Substep& s, const std::vector<BodyMotion>& motions);
  /// The same after surfaces were kept apart, by moving bodies alone.
  void hold_bodies(Substep& s, const std::vector<BodyMotion>& motions);
  /// Finds the particles that carry bodies. `begins`: at a substep's start, after detect.
  void find_loads(const Substep& s, const std::vector<BodyMotion>& motions, bool begins) {
    loads_.find(s, {contacts_, impulses_, body_of_solid_}, motions, begins);
  }
  PointLoads& loads() { return loads_; }
  /// After a phase of chains: gives the bodies the impulses of the particles that carry them.
  void end_chains(Substep& s, const std::vector<BodyMotion>& motions) { loads_.end_chains(s, motions, impulses_); }
  /// Adds a warning for each body that surfaces overlap at a substep's end, after hold_bodies.
  void warn_of_overlaps(const Substep& s, std::vector<std::string>& warnings) const;
  const std::vector<TouchedBody>& bodies() const { return bodies_; }
  /// The index among bodies() of the body of a contact's solid.
  int body_of_solid(int solid) const { return body_of_solid_[static_cast<std::size_t>(solid)]; }
  /// All contacts of the substep.
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// Applies restitution to velocities. `gravity` is what the velocities of an object lack of this frame's gravity [m/s].
  void respond(Substep& s, const std::vector<BodyMotion>& motions, FunctionRef<Vec3f(int object)> gravity);
  int contacts_that_press() const;
  /// Adds the pushes of the current substep.
  void log_contacts(const Substep& s, ContactLog& log) const;

 private:
  struct Solid {
    int body = 0;
    LocalShape shape;
    Posef pose{};                             ///< of the shape in the body's frame
    std::shared_ptr<const SolidField> field;  ///< instead of the shape where that is no primitive; null: a primitive
    float margin = 0;                         ///< around the field [m]
    ConvexShape convex{};                     ///< the solid itself, for the filter
  };
  /// How a body has moved since contacts were found, and in this pass.
  struct Progress {
    Vec3f displacement{}, rotation{};       ///< at the prediction [m], [rad]
    Vec3f moved{}, turned{};                ///< since then
    Vec3f moved_before{}, turned_before{};  ///< those when the pass began
  };

  void add_solids(const Model& model);
  void place_solids(const Substep& s);
  void note_progress(const Substep& s);
  void find_swept(const Substep& s, std::vector<Contact>& contacts);
  bool has_moved(const Substep& s) const;
  std::string other_at(const Substep& s, int vertex, int body) const;
  /// How a round keeps bodies and triangles from passing: by impulses on both sides or on bodies alone, or by taking back their motion in the substep.
  enum class Stop { both_sides, bodies, back, bodies_back };
  bool stop_once(Substep& s, const std::vector<BodyMotion>& motions, bool is_first, Stop by);
  void take_back(Substep& s, const Contact& contact, bool both_sides);
  void note_moved(const Substep& s, std::size_t first);
  void begin_pass(const Substep& s);
  void end_pass(Substep& s);
  bool meets(const Model& model, const Contact& contact) const;
  void project(Substep& s, const BodyMotion& motion, Contact& contact, bool yields = true);

  std::vector<float> impulses_;  ///< of contacts_ along their normals in this pass [N s]
  const ContactRules* rules_ = nullptr;
  std::vector<TouchedBody> bodies_;
  std::vector<Solid> solids_;
  std::vector<int> body_of_solid_;
  PointLoads loads_;
  std::vector<int> objects_, tasks_;           ///< objects with surfaces or particles, and their tiles, ascending
  std::vector<Posef> poses_;                   ///< of bodies at the substep's start
  std::vector<MovingCollider> moving_;         ///< solids in the substep
  SurfaceTiles surfaces_;                      ///< of tasks_
  std::vector<const std::vector<int>*> near_;  ///< [task of tasks_] solids that may be near
  std::vector<std::vector<Contact>> of_task_;
  std::vector<Contact> contacts_, of_shapes_;  ///< `collider` is a solid; points are indices in the State
  ShapeContacts shapes_;
  SweptContacts swept_;
  PassingFilter passing_;
  std::vector<char> moved_vertices_, moved_solids_;  ///< by the last round of passing
  std::vector<int> listed_vertices_;                 ///< the former as a list
  float farthest_ = 0;                               ///< largest displacement of these [m]
  std::vector<Record> kept_;                         ///< displacements of tiles near solids after stop_passing
  bool passing_is_done_ = false;                     ///< stop_passing has left nothing that would pass
  std::vector<Progress> progress_;
};

}  // namespace pliant
