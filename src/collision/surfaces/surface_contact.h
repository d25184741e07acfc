// Contact of surfaces with themselves, with each other and with mesh colliders. It calls its stages in this order:
//
//   near      which pairs of primitives are near one another         (near/near_lists.h)
//   narrow    which of them become contacts in this substep          (narrow/contact_detector.h)
//   filter    truncates steps that would make a pair cross           (filter/step_filter.h)
//   untangle  initially intersecting pairs: exempt, and moved apart  (untangle/)
//
// A substep's result depends on positions and displacements alone. Lists and bounds only save work, so a restored State
// gives the same bits.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "collision/filter/step_filter.h"
#include "collision/narrow/contact_detector.h"
#include "collision/narrow/point_contacts.h"
#include "collision/near/near_lists.h"
#include "collision/untangle/initial_intersections.h"
#include "collision/untangle/untangle.h"

namespace pliant {

/// Statistics of a frame for the Report.
struct PairCounts {
  std::int64_t candidates = 0, contacts = 0, truncated = 0, unresolvable = 0, intersecting = 0, rebuilds = 0,
               inside = 0;
  double deepest = 0;  ///< largest remaining penetration of a contact in the last substep [m]
};

/// Contact among surfaces. Over thirty members, because each stage of a substep and each count of the Report has its
/// function here; the parts that it owns do the work.
class SurfaceContact {
 public:
  /// `kernels` must be of an instruction set level that this machine runs; all give the same bits.
  explicit SurfaceContact(const PairModel& model, const PairKernels& kernels = base_pair_kernels());

  /// Applies the changes of update_pair_model between frames, and keeps what was found about other bodies. Not for
  /// models with untangling, which need a new SurfaceContact.
  void change(const PairChanges& changes);

  /// Call it at a frame's start: resets counts and updates the initially intersecting pairs. If `rebuild`, all pairs
  /// are tested, as needed in the first frame and after a State was restored.
  void begin_frame(const Record* positions, bool rebuild);

  /// Finds the contacts of the substep at the predicted displacements.
  void detect(Executor& executor, const PairParticles& particles);
  /// Marks the bodies into which a kinematic collider moves and whose contacts have not yet moved them out of its way,
  /// so that the filter may fail, and the dynamic bodies in contact with them. Then project their contacts again, which
  /// propagates the push. Returns false if there are none.
  bool find_overrun(const PairParticles& particles, std::vector<char>& is_overrun) const;
  /// Truncates displacements that would make surfaces cross. Of free bodies it keeps the momentum: without_velocity().
  /// `find_free` is called if any step is truncated. Call end_substep when displacements are final.
  void filter(Executor& executor, const PairParticles& particles, FunctionRef<const FreeBodies&()> find_free);
  /// The displacement, in the last filter, of the frame in which steps of a body were truncated [m].
  const Vec3f& frame_of(int body) const { return filter_.frames().of_body(body); }
  /// The group of bodies that moved in one frame in it, as the first of them; -1: the frame of the world. `otherwise`
  /// where nothing was truncated.
  int group_of(int body, int otherwise) const { return filter_.frames().group_of_body(body, otherwise); }
  /// What is not to become velocity of the displacements after the filter.
  const std::vector<VertexDisplacement>& without_velocity() const { return filter_.without_velocity(); }
  /// The momentum that the filter took from what is not free [kg m/s].
  const Vec3d& lost_momentum() const { return filter_.lost_momentum(); }
  /// True if a body has triangles or lines that can meet others.
  bool has_surface(int body) const { return model_.bodies.has(body) && model_.bodies.at(body).clusters.size > 0; }
  /// True if these, on their way in the substep as the filter left it, come within `reach` [m] of a box.
  bool comes_near(int body, const BoxBounds& box, float reach) const;
  /// Ends the substep, of which the filter was told. `has_moved`: displacements have changed since.
  void end_substep(Executor& executor, const PairParticles& particles, bool has_moved);
  /// Measures the remaining penetration of contacts; call it after a frame's last substep.
  void measure_overlaps(const PairParticles& particles);
  /// True if a contact of this substep is an impact (is_impact); valid after the filter.
  bool has_impacts() const { return has_impacts_; }
  /// The number of the set of a contact's bodies, below sets().
  std::size_t set_of(const Contact& contact) const {
    return static_cast<std::size_t>(model_.shared->body_set[static_cast<std::size_t>(
        model_.shared->vertex_body[static_cast<std::size_t>(contact.point[0])])]);
  }
  std::size_t sets() const { return static_cast<std::size_t>(model_.sets); }
  /// Removes the remaining approach speed of an impact after a substep, and returns it [m/s].
  float end_impact(const Contact& contact, const Record* positions, Record* velocities,
                   FunctionRef<Vec3f(int body)> gravity) const;
  /// Applies restitution to one of contacts(); call it after end_impact. `gravity`: the gravity of the frame that a
  /// body's velocities do not include yet [m/s]. Approaches slower than `slow` count as rest [m/s].
  void respond(const Contact& contact, const Record* positions, Record* velocities, float slow,
               FunctionRef<Vec3f(int body)> gravity) const;
  /// Limits the speed of surfaces that are being untangled; call it after respond.
  void limit_untangling(Record* velocities, FunctionRef<Vec3f(int body)> gravity) const;

  /// True if surfaces are moved apart in this frame; contacts must then be found before constraints are projected.
  bool untangles() const { return untangler_ && untangler_->limits_speeds(); }

  /// True if untangling leaves this intersection: it cuts no piece off, or moving would create more intersections.
  bool gives_up(const Intersection& found) const { return untangler_ && !untangler_->leads_apart(found); }
  /// True if untangling was active in the previous frame and did not reduce the number of intersections of two bodies.
  bool stalls(std::pair<int, int> bodies) const { return untangler_ && intersections_.are_no_fewer(bodies); }

  PairCounts counts() const;
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// The number of contacts of static neighbour pairs, which come first in contacts().
  std::size_t static_contacts() const { return static_contacts_; }
  std::vector<Contact>& contacts() { return contacts_; }
  /// Intersecting edges and triangles. Contact and filter ignore their pairs until they no longer intersect.
  const std::vector<Intersection>& intersecting() const { return intersections_.found(); }
  const Triangle& triangle(int number) const { return model_.elements.triangles[number]; }
  /// Bodies that are partly too far from the origin for contact (is_too_far), ascending.
  std::vector<int> too_far() const;
  /// Unresolvable pairs of this frame, by bodies, the lower one first.
  const std::map<std::pair<int, int>, UnresolvablePairs>& unresolvable() const { return filter_.unresolvable(); }

 private:
  Vec3f missing_of(const Contact& contact, const Record* positions, FunctionRef<Vec3f(int body)> gravity) const;
  bool is_exempt(const PairStencil& pair) const {
    return (untangler_ && untangler_->is_exempt(pair)) || intersections_.hold(pair) || has_gone(pair);
  }
  /// True if a particle of the pair is not there.
  bool has_gone(const PairStencil& pair) const {
    return births_ != nullptr && std::any_of(pair.vertex.begin(), pair.vertex.end(),
                                             [&](std::int32_t vertex) { return births_[vertex] == not_there; });
  }

  const PairModel& model_;
  NearLists lists_;
  ContactDetector detector_;
  PointContacts points_;
  StepFilter filter_;
  InitialIntersections intersections_;
  std::unique_ptr<Untangler> untangler_;  ///< null unless the model requests untangling
  std::vector<Contact> contacts_;
  std::size_t static_contacts_ = 0;
  bool is_bounded_ = true, has_impacts_ = false;
  std::int64_t pushing_ = 0, rebuilds_before_ = 0;
  const double* births_ = nullptr;  ///< PairParticles::births of this substep
  double deepest_ = 0;
};

}  // namespace pliant
