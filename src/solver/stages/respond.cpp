#include <algorithm>
#include <vector>

#include "solver/collider_depenetration.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// Several threads may set one flag at the same time. By the compilers' own function, because not all supported
/// libraries have std::atomic_ref.
void set_flag(char& flag) { __atomic_store_n(&flag, 1, __ATOMIC_RELAXED); }

/// Upper limit of passes that end impacts. Each propagates velocity changes from one contact of a vertex to its other
/// ones.
constexpr int most_impact_passes = 8;
/// A remaining approach per substep below this share of the thickness is left to the next substep.
constexpr float approach_over_thickness = 0.1f;

/// Removes the remaining approach velocity of impacts in this substep. If it were left to the next one, contact normals
/// of crumpled surfaces would deflect it sideways. Each set of objects that can meet has as many rounds as it needs, so
/// that it gets the bits that it gets alone.
void end_impacts(Substep& s, FunctionRef<Vec3f(int)> gravity, float slow) {
  SurfaceContact& pairs = *s.pairs;
  const Record* positions = s.state.positions.data();
  Record* velocities = s.state.velocities.data();
  const ContactSolver impacts =
      s.own->contact_solver.only(pairs.contacts(), [](const Contact& c) { return is_impact(c); });
  const auto for_impacts = [&](FunctionRef<void(const Contact&)> answer) {
    impacts.for_each(s.context.executor, "respond", pairs.contacts(), answer);
  };
  std::vector<char>&goes_on = s.own->impacts.goes_on, &again = s.own->impacts.again;
  goes_on.assign(pairs.sets(), 1);
  for (int round = 0; round < most_impact_passes; ++round) {
    again.assign(goes_on.size(), 0);
    for_impacts([&](const Contact& contact) {
      const std::size_t set = pairs.set_of(contact);
      if (goes_on[set] == 0) return;
      const float approach = pairs.end_impact(contact, positions, velocities, gravity);
      if (approach * s.h > approach_over_thickness * contact.thickness) set_flag(again[set]);
    });
    for_impacts([&](const Contact& contact) {
      if (goes_on[pairs.set_of(contact)] != 0) pairs.respond(contact, positions, velocities, slow, gravity);
    });
    goes_on.swap(again);
    if (std::find(goes_on.begin(), goes_on.end(), 1) == goes_on.end()) break;
  }
}

/// Applies restitution to contacts of edges and triangles with primitive colliders.
void respond_to_shapes(Substep& s, float slow, FunctionRef<Vec3f(int object)> gravity) {
  const Record* positions = s.state.positions.data();
  s.own->shape_contact_solver.for_each(
      s.context.executor, "respond", s.own->shape_contacts, [&](const Contact& contact) {
        float free = 0;  // total weight of the contact's dynamic points
        for (int i = 0; i < 4; ++i) free += positions[contact.point[i]].w > 0 ? contact.weight[i] : 0.f;
        const Vec3f missing = gravity(s.model.object_of(contact.point[0])) * free;
        respond_to_shape_contact(contact, s.state.velocities.data(), missing, slow, 1 / s.h);
      });
}

void respond_to_all(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  const float slow = 2 * length(s.model.gravity) * s.h;
  for_systems(s, [&](System& system) { system.respond(s, gravity); });
  respond_to_shapes(s, slow, gravity);
  if (!s.has_pairs()) return;
  Record* velocities = s.state.velocities.data();
  s.own->contact_solver.for_each(s.context.executor, "respond", s.pairs->contacts(), [&](const Contact& contact) {
    s.pairs->respond(contact, s.state.positions.data(), velocities, slow, gravity);
  });
  if (s.pairs->has_impacts()) end_impacts(s, gravity, slow);
  s.pairs->limit_untangling(velocities, gravity);
}

}  // namespace

void respond(Substep& s) {
  const bool is_settled = s.is_last() || ends_quarter(s);
  const auto gravity = [&](int object) {
    return is_settled ? Vec3f{} : gravity_for(s, s.work.gravity[object].settled);
  };
  respond_to_all(s, gravity);
  limit_speeds(s, gravity);
}

}  // namespace pliant
