// Contact of surfaces with themselves, each other and meshes: its stages in order, once for all objects.
//
//   near      which pairs of primitives are near one another         (near/near_lists.h)
//   narrow    which of them become contacts in this substep          (narrow/contact_detector.h)
//   filter    truncates steps so that no pair crosses                (filter/step_filter.h)
//   untangle  initially intersecting pairs: exempt, and moved apart  (untangle/)
//
// A substep depends on positions and displacements alone. Lists and
// bounds only save work, so a restored State gives the same bits.
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

/// Statistics for the Report.
struct PairCounts {
  std::int64_t candidates = 0, contacts = 0, truncated = 0, unresolvable = 0, intersecting = 0, rebuilds = 0, inside = 0;
  double deepest = 0;  ///< remaining penetration of contacts in the last substep [m]
};

/// Contact among surfaces: detection, filter and untangling in one order. Over thirty members, since each stage of a substep and
/// each count of the Report has its function here; the work is in the parts that it owns.
class SurfaceContact {
 public:
  /// `kernels` must be of an instruction set level that this machine runs; all give the same bits.
  explicit SurfaceContact(const PairModel& model, const PairKernels& kernels = pair_kernels_generic());

  /// Call it between frames after update_pair_model, unless initial intersections are moved apart. All that is known of other
  /// bodies is kept.
  void change(const PairChanges& changes);

  /// Call at a frame's start: resets counts and updates the initially intersecting pairs. `rebuild` tests all pairs; needed
  /// at the first frame and after a restored State.
  void begin_frame(const Record* positions, bool rebuild);

  /// Finds the contacts of the substep from predicted displacements.
  void detect(Executor& executor, const PairParticles& particles);
  /// True if a kinematic collider moves into vertices that contacts have not moved out of its way yet, so that the filter
  /// may fail. Then contacts should be projected again, which propagates the push.
  bool is_overrun(const PairParticles& particles) const;
  /// Truncates displacements so that nothing crosses.
  void filter(Executor& executor, const PairParticles& particles);
  /// Call after a frame's last substep: measures the remaining penetration of contacts.
  void measure_overlaps(const PairParticles& particles);
  /// True if any contact is an impact; valid after the filter.
  bool has_impacts() const { return has_impacts_; }
  /// Removes the remaining approach speed of an impact after a substep, and returns it [m/s].
  float end_impact(const Contact& contact, const Record* positions, Record* velocities,
                   FunctionRef<Vec3f(int body)> gravity) const;
  /// Call after end_impact: applies restitution to one of contacts(). `gravity` is the gravity of the frame not yet
  /// included in a body's velocities [m/s]. Approaches slower than `slow` count as rest [m/s].
  void respond(const Contact& contact, const Record* positions, Record* velocities, float slow,
               FunctionRef<Vec3f(int body)> gravity) const;
  /// Call after respond: limits the speed of surfaces that are being untangled.
  void limit_untangling(Record* velocities, FunctionRef<Vec3f(int body)> gravity) const;

  /// True if initial intersections are moved apart in this frame; contacts must then be found before the projection.
  bool untangles() const { return untangler_ && untangler_->limits_speeds(); }

  /// True if untangling ignores this intersection: it separates no part, or moving would create more intersections.
  bool gives_up(const Intersection& found) const { return untangler_ && !untangler_->leads_apart(found); }
  /// True if untangling was active in the previous frame without reducing the intersections of two bodies.
  bool stalls(std::pair<int, int> bodies) const { return untangler_ && intersections_.are_no_fewer(bodies); }

  PairCounts counts() const;
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// The number of contacts of static neighbour pairs, which come first in contacts().
  std::size_t static_contacts() const { return static_contacts_; }
  std::vector<Contact>& contacts() { return contacts_; }
  /// Intersecting edges and triangles, which are exempt until they are apart.
  const std::vector<Intersection>& intersecting() const { return intersections_.found(); }
  const Triangle& triangle(int number) const { return model_.elements.triangles[number]; }
  /// Bodies that are partly too far from the origin for contact (is_too_far), ascending.
  std::vector<int> too_far() const;
  /// Unresolvable pairs of this frame, by bodies, the lower one first.
  const std::map<std::pair<int, int>, UnresolvablePairs>& unresolvable() const { return filter_.unresolvable(); }

 private:
  Vec3f missing_of(const Contact& contact, const Record* positions, FunctionRef<Vec3f(int body)> gravity) const;
  bool is_exempt(const PairStencil& pair) const {
    return (untangler_ && untangler_->is_exempt(pair)) || intersections_.hold(pair);
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
  double deepest_ = 0;
};

}  // namespace pliant
