// Contact of surfaces with themselves, one another and meshes: the stages in order, once for all objects.
//
//   near      which pairs of primitives are near one another         (near/near_lists.h)
//   narrow    which of them become contacts in this substep          (narrow/contact_detector.h)
//   filter    truncates steps so that no pair crosses                (filter/step_filter.h)
//   untangle  what intersects initially: exempt, and led apart       (untangle/)
//
// A substep depends on positions and displacements alone: lists and bounds only save work, so a State that is put back gives the same
// bits.
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

/// What was done, for the Report.
struct PairCounts {
  std::int64_t candidates = 0, contacts = 0, truncated = 0, unresolvable = 0, intersecting = 0, rebuilds = 0, inside = 0;
  double deepest = 0;  ///< overlap that contacts of the last substep left [m]
};

class SurfaceContact {
 public:
  /// `kernels` are those of an instruction set that this machine has; all give the same bits.
  explicit SurfaceContact(const PairModel& model, const PairKernels& kernels = pair_kernels_generic());

  /// At a frame's start: forgets counts, and finds which initially intersecting pairs are apart by now. `rebuild` tests all pairs: due
  /// at the first frame and after a State was put back.
  void begin_frame(const Record* positions, bool rebuild);

  /// Contacts of the substep from predicted displacements.
  void detect(Executor& executor, const PairParticles& particles);
  /// Whether a kinematic collider moves on into what contacts have not yet moved out of its way, so that the filter might not keep them
  /// apart: then they should be projected again, which passes a push on to what lies behind.
  bool is_overrun(const PairParticles& particles) const;
  /// Truncates displacements so that nothing crosses.
  void filter(Executor& executor, const PairParticles& particles);
  /// After a frame's last substep: how much of their thickness contacts lack.
  void measure_overlaps(const PairParticles& particles);
  /// After the filter: whether any contact is an impact.
  bool has_impacts() const { return has_impacts_; }
  /// After a substep, to an impact: removes what is left of its approach and returns it [m/s].
  float end_impact(const Contact& contact, const Record* positions, Record* velocities,
                   FunctionRef<Vec3f(int body)> gravity) const;
  /// Then, to one of contacts(): restitution. `gravity` is what velocities of a body's free particles lack: within a frame, that of the
  /// frame [m/s]. Approaches no faster than `slow` are rest [m/s].
  void respond(const Contact& contact, const Record* positions, Record* velocities, float slow,
               FunctionRef<Vec3f(int body)> gravity) const;
  /// Then limits the speed of what is being led apart.
  void limit_untangling(Record* velocities, FunctionRef<Vec3f(int body)> gravity) const;

  /// Whether initially intersecting surfaces are led apart in this frame: contacts are then to be found before constraints are projected.
  bool untangles() const { return untangler_ && untangler_->limits_speeds(); }

  /// Whether untangling leaves this one as it is: it cuts nothing off, or moving would make more intersections.
  bool gives_up(const Intersection& found) const { return untangler_ && !untangler_->leads_apart(found); }
  /// Whether untangling was active in the frame before and made the intersections of two bodies no fewer.
  bool stalls(std::pair<int, int> bodies) const { return untangler_ && intersections_.are_no_fewer(bodies); }

  PairCounts counts() const;
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// How many of contacts(), from the first on, are of static neighbour pairs.
  std::size_t static_contacts() const { return static_contacts_; }
  std::vector<Contact>& contacts() { return contacts_; }
  /// Edges and triangles that intersect: left out until they are apart.
  const std::vector<Intersection>& intersecting() const { return intersections_.found(); }
  const Triangle& triangle(int number) const { return model_.elements.triangles[number]; }
  /// Bodies that are partly too far from the origin for contact (is_too_far), ascending.
  std::vector<int> too_far() const;
  /// Of this frame, by their bodies, the lower one first.
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
  std::unique_ptr<Untangler> untangler_;  ///< where the model asks for it
  std::vector<Contact> contacts_;
  std::size_t static_contacts_ = 0;
  bool is_bounded_ = true, has_impacts_ = false;
  std::int64_t pushing_ = 0, rebuilds_before_ = 0;
  double deepest_ = 0;
};

}  // namespace pliant
