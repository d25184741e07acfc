// Reads joints between steps: their loads, angles and speeds.
#include <algorithm>
#include <cmath>

#include "math/quat.h"
#include "pliant/error.h"
#include "solver/bodies/joint_load.h"
#include "world/world_data.h"

namespace pliant {

namespace {

/// Throws an Error if the object has no such joint.
const CompiledJoint& joint_of(const CompiledObject& object, int joint) {
  if (joint < 0 || static_cast<std::size_t>(joint) >= object.joints.size())
    throw Error({.object = object.name, .element = "joint " + std::to_string(joint)},
                "does not exist; there are " + std::to_string(object.joints.size()) + " joints",
                "indices count from 0");
  return object.joints[static_cast<std::size_t>(joint)];
}

}  // namespace

JointLoad ObjectView::joint_load(int joint) const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  const CompiledJoint& of = joint_of(from, joint);
  if (joint_is_broken(joint)) return {};
  const State& state = read_->state;
  const ReactionLoad load = load_of({from, state.positions.data() + read_->model.first[number], nullptr,
                                     state.frames.orientations.data() + read_->model.first_frame[number],
                                     read_->workspace.multipliers[number], read_->workspace.last_h[number]},
                                    of);
  return {load.force, load.torque};
}

bool ObjectView::joint_is_broken(int joint) const {
  const int number = read_->number(id_);
  (void)joint_of(read_->model.objects[number], joint);
  const std::vector<int>& broken = read_->workspace.joints[number].broken;
  return std::binary_search(broken.begin(), broken.end(), joint);
}

namespace {

/// The place of a joint in one of its bodies, and how that moves.
struct JointSide {
  Vec3d place, velocity, spin;  ///< [m], [m/s], [rad/s], in world axes
  Quatd axes;                   ///< of the joint, as this body has them
};

JointSide side_of(const WorldData& world, int number, const CompiledJoint::Side& side, const Vec3d* at = nullptr) {
  const int particle = world.model.first[number] + side.point;
  const int frame = world.model.first_frame[number] + side.frame;
  const Record &x = world.state.positions[particle], &v = world.state.velocities[particle],
               &q = world.state.frames.orientations[frame], &w = world.state.frames.angular_velocities[frame];
  const Quatd rotation = normalise(convert<double>(Quatf{q.x, q.y, q.z, q.w}));
  const Record& rest = world.state.remainders[particle];  // what rounding left out of the position
  const Vec3d centre = convert<double>(Vec3f{x.x, x.y, x.z}) + convert<double>(Vec3f{rest.x, rest.y, rest.z});
  const Vec3d place = centre + rotate(rotation, convert<double>(side.anchor));
  const Vec3d spin = rotate(rotation, convert<double>(Vec3f{w.x, w.y, w.z}));
  const Vec3d arm = (at != nullptr ? *at : place) - centre;
  return {place, convert<double>(Vec3f{v.x, v.y, v.z}) + cross(spin, arm), spin,
          multiply(rotation, convert<double>(side.axes))};
}

/// A rotation as a vector along its axis with the angle as length, up to half a turn.
Vec3d rotation_vector(Quatd q) {
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  const Vec3d part{q.x, q.y, q.z};
  const double size = std::sqrt(dot(part, part));
  return part * (size > 1e-12 ? 2 * std::atan2(size, q.w) / size : 2);
}

}  // namespace

JointState ObjectView::joint_state(int joint) const {
  const int number = read_->number(id_);
  const CompiledJoint& of = joint_of(read_->model.objects[number], joint);
  const JointSide b = side_of(*read_, number, of.b);
  const JointSide a = side_of(*read_, number, of.a, &b.place);  // which moves as a would at the place of b's anchor
  const auto seen_from_a = [&](const Vec3d& v) { return convert<float>(rotate(conjugate(a.axes), v)); };
  return {seen_from_a(b.place - a.place), convert<float>(rotation_vector(multiply(conjugate(a.axes), b.axes))),
          seen_from_a(b.velocity - a.velocity), seen_from_a(b.spin - a.spin)};
}

JointLoad ObjectView::mean_joint_load(int joint) const {
  const int number = read_->number(id_);
  const CompiledObject& object = read_->model.objects[number];
  (void)joint_of(object, joint);
  if (!read_->workspace.sums_joint_loads)
    throw Error({.object = object.name}, "the loads of its joints are not recorded",
                "turn record_joint_loads on before the step");
  const auto index = static_cast<std::size_t>(number), j = static_cast<std::size_t>(joint);
  if (index >= read_->workspace.joint_loads.size()) return {};
  const JointLoadSums& sums = read_->workspace.joint_loads[index];
  if (sums.forces.size() != object.joints.size() || !(sums.time > 0)) return {};
  return {convert<float>(sums.forces[j] * (1 / sums.time)), convert<float>(sums.torques[j] * (1 / sums.time))};
}

int ObjectView::joint_index(const std::string& name) const {
  const CompiledObject& object = read_->object(id_);
  const auto has_name = [&](const CompiledJoint& joint) { return joint.name == name; };
  const auto count = std::count_if(object.joints.begin(), object.joints.end(), has_name);
  if (count != 1)
    throw Error({.object = object.name, .element = "joint '" + name + "'"},
                count == 0 ? "does not exist" : "is the name of " + std::to_string(count) + " joints",
                count == 0 ? "use the name of one of its joints" : "use the index, or give each joint its own name");
  return static_cast<int>(std::find_if(object.joints.begin(), object.joints.end(), has_name) - object.joints.begin());
}

void World::record_joint_loads(bool on) {
  data_->workspace.sums_joint_loads = on;
  data_->workspace.joint_loads.clear();
}

}  // namespace pliant
