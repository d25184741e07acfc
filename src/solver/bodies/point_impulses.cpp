#include "solver/bodies/point_impulses.h"

#include <algorithm>
#include <utility>

#include "constraints/contact.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// The impulse at an arm from a body's centre that changes the velocity of its point against points of inverse mass `w`
/// by `change`.
Vec3f impulse_for(const Vec3f& change, const BodyMotion& body, const Vec3f& arm, float w) {
  const float mass = w + body.inverse_mass;
  Vec3f column[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3f unit{axis == 0 ? 1.f : 0.f, axis == 1 ? 1.f : 0.f, axis == 2 ? 1.f : 0.f};
    column[axis] = unit * mass + cross(times(body.inverse_inertia, cross(arm, unit)), arm);
  }
  const Vec3f x = cross(column[1], column[2]), y = cross(column[2], column[0]), z = cross(column[0], column[1]);
  const float determinant = dot(column[0], x);
  if (!(determinant > 0)) return {};
  return Vec3f{dot(x, change), dot(y, change), dot(z, change)} * (1 / determinant);
}

/// The weighted place of a contact's points after the displacements so far.
Vec3f place_of(const Contact& c, const Record* positions, const Record* displacements) {
  return relative(c, positions) + relative(c, displacements);
}

}  // namespace

void PointImpulses::note_progress(const Substep& s, const BodySolids& solids) {
  const std::vector<TouchedBody>& all = solids.bodies();
  progress_.assign(all.size(), {});
  pinched_ = {};  // those that were found count the motion of bodies from another time
  pinched_are_found_ = true;
  for (std::size_t b = 0; b < all.size(); ++b) {
    progress_[b].displacement = xyz(s.work.displacements[at(all[b].particle)]);
    const std::size_t frame = at(all[b].frame);
    progress_[b].rotation = xyz(s.work.frames.predicted[frame]) + xyz(s.work.frames.corrections[frame]);
  }
}

void PointImpulses::begin_pass(const Substep& s, const BodySolids& solids) {
  const std::vector<TouchedBody>& all = solids.bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    BodyProgress& p = progress_[b];
    const std::size_t frame = at(all[b].frame);
    p.moved = p.moved_before = xyz(s.work.displacements[at(all[b].particle)]) - p.displacement;
    p.turned = p.turned_before =
        (xyz(s.work.frames.predicted[frame]) + xyz(s.work.frames.corrections[frame])) - p.rotation;
  }
}

void PointImpulses::end_pass(Substep& s, const BodySolids& solids) {
  const std::vector<TouchedBody>& all = solids.bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const BodyProgress& p = progress_[b];
    const Vec3f turned = p.turned - p.turned_before;
    Record& d = s.work.displacements[at(all[b].particle)];
    d = plus(d, p.moved - p.moved_before);
    if (turned == Vec3f{}) continue;
    const std::size_t frame = at(all[b].frame);
    s.work.frames.corrections[frame] = plus(s.work.frames.corrections[frame], turned);
    rotate_by(turned, s.state.frames.orientations[frame]);
  }
}

/// `yields`: the points move too; else only a body that is not fixed.
void PointImpulses::project(Substep& s, const BodySolids& solids, const BodyMotion& motion, Contact& c, bool yields) {
  const int number = solids.number_of(c);
  const Record *positions = s.state.positions.data(), *displacements = s.work.displacements.data();
  BodyProgress& p = progress_[at(number)];
  const Vec3f centre = (xyz(positions[solids.bodies()[at(number)].particle]) + p.displacement) + p.moved;
  const Vec3f arm = place_of(c, positions, displacements) - centre;
  ContactSums<float> sums{c.friction, c.push};
  const Vec3f moved = relative(c, displacements) - (p.moved + cross(p.turned, arm));
  const auto [along, across] = project_contact(values_of(c), moved, sums);
  if (!(sums.push > 0)) return;
  c.friction = sums.friction;
  c.push = sums.push;
  const float w = yields || !(motion.inverse_mass > 0) ? inverse_mass_of(c, positions) : 0;
  const Vec3f impulse = impulse_for(along + across, motion, arm, w);
  move_sides(c, impulse * w, s.work.displacements.data());
  impulses_[static_cast<std::size_t>(&c - contacts_.data())] += dot(c.normal, impulse) / s.h;
  p.moved -= impulse * motion.inverse_mass;
  p.turned -= times(motion.inverse_inertia, cross(arm, impulse));
}

void PointImpulses::project(Substep& s, const BodySolids& solids, const std::vector<BodyMotion>& motions,
                            const std::vector<char>* of) {
  if (contacts_.empty()) return;
  const Stopwatch stopwatch(s.context.executor.timings(), "solve: bodies and points");
  begin_pass(s, solids);
  for (Contact& contact : contacts_)
    if (of == nullptr || (*of)[at(s.model.object_of(contact.point[0]))] != 0)
      project(s, solids, motions[at(solids.number_of(contact))], contact, true);
  if (!std::exchange(pinched_are_found_, true)) pinched_.find(s, solids, contacts_);
  pinched_.project(s, {solids, motions, contacts_, impulses_, progress_}, of);
  end_pass(s, solids);
}

void PointImpulses::project_from(Substep& s, const BodySolids& solids, std::size_t first,
                                 const std::vector<BodyMotion>& motions, bool yields) {
  begin_pass(s, solids);
  for (std::size_t i = first; i < contacts_.size(); ++i)
    project(s, solids, motions[at(solids.number_of(contacts_[i]))], contacts_[i], yields);
  end_pass(s, solids);
}

std::size_t PointImpulses::append(const std::vector<Contact>& more) {
  const std::size_t first = contacts_.size();
  contacts_.insert(contacts_.end(), more.begin(), more.end());
  impulses_.resize(contacts_.size());
  return first;
}

void PointImpulses::begin_frame() {
  contacts_.clear();
  impulses_.clear();
}

void PointImpulses::begin_substep(const Substep& s, const BodySolids& solids) {
  impulses_.assign(contacts_.size(), 0.f);
  note_progress(s, solids);
  pinched_are_found_ = false;
}

void PointImpulses::respond(Substep& s, const BodySolids& solids, const std::vector<BodyMotion>& motions,
                            FunctionRef<Vec3f(int object)> gravity) {
  const float slow = 2 * length(s.model.gravity) * s.h;
  Record* velocities = s.state.velocities.data();
  bounced_.assign(contacts_.size(), 0.f);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    if (!(c.push > 0)) continue;
    const int number = solids.number_of(c);
    const TouchedBody& body = solids.bodies()[at(number)];
    const BodyMotion& motion = motions[at(number)];
    Record& spin = s.state.frames.angular_velocities[at(body.frame)];
    const Quatf q = quaternion(s.state.frames.orientations[at(body.frame)]);
    const Vec3f arm = relative(c, s.state.positions.data()) - xyz(s.state.positions[at(body.particle)]);
    const Vec3f missing = gravity(s.model.object_of(c.point[0])),
                own_missing = motion.inverse_mass > 0 ? gravity(body.object) : Vec3f{};
    const Vec3f of_body = (xyz(velocities[body.particle]) + own_missing) + cross(rotate(q, xyz(spin)), arm);
    const float separating = dot(c.normal, (relative(c, velocities) + missing) - of_body);
    const float wanted = separation_after(separating, c.approach, c.restitution, slow, true);
    const float w = inverse_mass_of(c, s.state.positions.data());
    const Vec3f turning = cross(arm, c.normal);
    const float mass = w + motion.inverse_mass + dot(turning, times(motion.inverse_inertia, turning));
    if (!(mass > 0)) continue;
    const float size = (wanted - separating) / mass;
    const Vec3f impulse = c.normal * size;
    bounced_[i] = size;
    move_sides(c, impulse * w, velocities);
    velocities[body.particle] = plus(velocities[body.particle], -impulse * motion.inverse_mass);
    spin = plus(spin, rotate(conjugate(q), -times(motion.inverse_inertia, cross(arm, impulse))));
  }
}

void PointImpulses::log_contacts(const Substep& s, const BodySolids& solids, const VelocityShares& shares,
                                 ContactLog& log) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    const float share = s.velocity_share * shares.of_points(s.model.object_of(c.point[0]));
    const double impulse = static_cast<double>(impulses_[i] * share) + static_cast<double>(bounced_[i]);
    if (!(c.push > 0) || !(impulse > 0)) continue;
    const Vec3d place = convert<double>(relative(c, s.state.positions.data()));
    const TouchedBody& body = solids.body_of(c);
    add_push({s.model.object_of(c.point[0]), body.object, impulse, c.normal, place, -1, body.body}, log);
  }
}

int PointImpulses::contacts_that_press() const {
  return static_cast<int>(
      std::count_if(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.push > 0; }));
}

}  // namespace pliant
