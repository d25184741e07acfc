#include "solver/bodies/held_bodies.h"

#include <algorithm>
#include <cstddef>

#include "solver/bodies/body_math.h"
#include "solver/bodies/joint_forest.h"
#include "solver/substep.h"

namespace pliant {

HeldBodies::HeldBodies(const ContactBodies& bodies, std::span<const BodyLink> links)
    : bodies_(&bodies), is_held_(at(bodies.dynamic())) {
  int first = 0;
  for (const BodyLink& link : links) {  // in the order of bodies
    if (!jointed_.empty() && jointed_.back().object == link.object) continue;
    while (place(first).object != link.object) ++first;
    jointed_.push_back({link.object, first});
  }
}

void HeldBodies::clear() {
  held_.clear();
  std::fill(is_held_.begin(), is_held_.end(), char{0});
}

void HeldBodies::hold(State& state, int body) {
  const BodyPlace& of = place(body);
  Record &position = state.positions[at(of.particle)], &inertia = state.frames.inverse_inertias[at(of.frame)];
  held_.push_back({body, position, state.frames.orientations[at(of.frame)], inertia});
  is_held_[at(body)] = 1;
  position.w = 0;
  inertia = {};
}

void HeldBodies::release(State& state, FunctionRef<bool(int body)> is_released) {
  stay_.clear();
  for (const Held& held : held_) {
    if (!is_released(held.body)) {
      stay_.push_back(held);
      continue;
    }
    is_held_[at(held.body)] = 0;
    state.positions[at(place(held.body).particle)].w = held.position.w;
    state.frames.inverse_inertias[at(place(held.body).frame)] = held.inverse_inertia;
  }
  held_.swap(stay_);
}

void HeldBodies::put_back(State& state) const {
  for (const Held& held : held_) {
    const BodyPlace& of = place(held.body);
    state.positions[at(of.particle)] = held.position;
    state.remainders[at(of.particle)] = state.velocities[at(of.particle)] = {};
    state.frames.orientations[at(of.frame)] = held.orientation;
    state.frames.inverse_inertias[at(of.frame)] = held.inverse_inertia;
    state.frames.angular_velocities[at(of.frame)] = {};
  }
}

void HeldBodies::leave_out_constraints(Substep& s) const {
  for (const Jointed& jointed : jointed_) {
    const CompiledObject& object = s.model.objects[at(jointed.object)];
    const auto from = is_held_.begin() + jointed.first_body,
               to = from + static_cast<std::ptrdiff_t>(object.bodies.bodies.size());
    const std::vector<char> now =
        std::find(from, to, char{1}) == to ? std::vector<char>{} : std::vector<char>(from, to);
    ObjectJoints& joints = s.work.joints[at(jointed.object)];
    if (joints.is_asleep == now) continue;
    joints.is_asleep = now;
    prepare_joints(object, joints);
  }
}

}  // namespace pliant
