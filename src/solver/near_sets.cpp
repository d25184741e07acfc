#include "solver/near_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "collision/fields/collider_pose.h"
#include "core/at.h"
#include "geometry/convex_shape.h"
#include "math/motion.h"
#include "math/vector.h"
#include "model/forest.h"

namespace pliant {

namespace {

/// Where an object's particles are when a frame begins, and how far they may move in it [m].
struct Reach {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  double radius = 0;  ///< what lies about a particle
  double moved = 0;   ///< largest displacement in the frame

  bool is_empty() const { return low.x > high.x; }
  double size() const { return max(max(high.x - low.x, high.y - low.y), high.z - low.z) + 2 * radius; }
  /// By how much the box of the particles is grown.
  double margin() const { return radius + size() + 2 * moved; }
};

bool are_near(const Reach& a, const Reach& b) {
  if (a.is_empty() || b.is_empty()) return false;
  const Vec3d apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z) <= a.margin() + b.margin();
}

/// The radius of a sphere about the origin of its frame that has a convex shape in it [m].
double radius_about_origin(const ConvexShape& shape) {
  Vec3d farthest{};
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
    farthest = max(farthest, max(abs(support(shape, axis)), abs(support(shape, -axis))));
  return static_cast<double>(shape.radius) + length(farthest);
}

/// What an object has about its particles [m]: solids of bodies, its thickness, the reach of liquids and grains.
double radius_of(const CompiledObject& object) {
  double radius = 0;
  for (const CompiledSolid& solid : object.bodies.solids)
    radius = std::max(radius, length(solid.pose.position) + radius_about_origin(solid.shape));
  if (object.fluid) radius = std::max(radius, 3 * static_cast<double>(object.fluid->spacing));
  if (object.grains) radius = std::max(radius, 2 * static_cast<double>(object.grains->radius));
  return radius + static_cast<double>(object.thickness);
}

/// The largest distance that a pair of the scene keeps from an object [m].
double kept_distance(const Model& model, int o) {
  double most = 0;
  for (const PairProperties& pair : model.pairs)
    if (pair.thickness && (pair.first == model.objects[at(o)].name || pair.second == model.objects[at(o)].name))
      most = std::max(most, static_cast<double>(*pair.thickness));
  return most;
}

/// All that displacements in a frame follow from.
struct FrameStart {
  const Model& model;
  const State& state;
  const Control& control;
  double dt = 0;

  Vec3d place(int particle) const {
    const Record& x = state.positions[at(particle)];
    return {x.x, x.y, x.z};
  }
  double end() const { return state.time + dt; }
  /// Times at which what follows keyframes is looked at: it may come back within the frame.
  std::array<double, 4> times() const {
    return {state.time + dt / 4, state.time + dt / 2, state.time + dt * 3 / 4, end()};
  }
};

/// The largest displacement of an object's kinematic particles [m].
double kinematic_move(const FrameStart& f, int o) {
  const CompiledObject& object = f.model.objects[at(o)];
  const int first = f.model.first[at(o)];
  double moved = 0;
  const auto follow = [&](int particle, const Vec3d& to) {
    moved = std::max(moved, length(to - f.place(first + particle)));
  };
  const PoseDrive* drive = f.control.mesh(o);
  for (const double time : f.times()) {
    if (drive != nullptr || object.carrier.moves()) {
      const CarrierPose pose =
          drive != nullptr ? CarrierPose(object.carrier, time, drive->at(time)) : CarrierPose(object.carrier, time);
      for (int i = 0; i < object.particles; ++i) follow(i, pose.place(i));
    }
    for (const Kinematic& kinematic : object.kinematics)
      follow(kinematic.particle, to_world(pose_at(kinematic.motion, time), convert<double>(kinematic.rest)));
  }
  if (const ObjectControl* given = f.control.object(o))
    for (const Target& target : given->targets) follow(target.particle, target.to);
  return moved;
}

/// The largest acceleration by the forces that the user sets for the frame [m/s^2].
double acceleration_by_user(const FrameStart& f, int o) {
  const ObjectControl* given = f.control.object(o);
  double most = 0;
  for (std::size_t i = 0; given != nullptr && i < given->forces.size(); ++i)
    most = std::max(most,
                    static_cast<double>(length(given->forces[i]) * f.state.positions[at(f.model.first[at(o)]) + i].w));
  return most;
}

Reach reach_of(const FrameStart& f, int o, double radius) {
  Reach of;
  of.radius = radius;
  float fastest = 0;
  for (int i = f.model.first[at(o)]; i < f.model.end_of(o); ++i) {
    if (!is_there(f.state, at(i))) continue;
    const Vec3d x = f.place(i);
    const Record& v = f.state.velocities[at(i)];
    of.low = min(of.low, x);
    of.high = max(of.high, x);
    fastest = max(fastest, v.x * v.x + v.y * v.y + v.z * v.z);
  }
  const double acceleration = static_cast<double>(length(f.model.gravity)) + acceleration_by_user(f, o);
  float turning = 0;  // of bodies
  for (int i = f.model.first_frame[at(o)];
       i < f.model.first_frame[at(o)] + static_cast<int>(f.model.objects[at(o)].frames.size()); ++i) {
    const Record& w = f.state.frames.angular_velocities[at(i)];
    turning = max(turning, w.x * w.x + w.y * w.y + w.z * w.z);
  }
  const double speed = std::sqrt(static_cast<double>(fastest)) + std::sqrt(static_cast<double>(turning)) * radius +
                       static_cast<double>(length(f.model.wind.velocity) * (1 + f.model.wind.gust));
  of.moved = (speed + acceleration * f.dt) * f.dt;
  of.moved = std::max(of.moved, kinematic_move(f, o));
  return of;
}

/// The radius of a primitive collider about the origin of its frame [m]; that of a plane is infinite.
double radius_of(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return static_cast<double>(sphere->radius);
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return static_cast<double>(capsule->radius + capsule->half_length);
  if (const auto* box = std::get_if<Box>(&shape)) return static_cast<double>(length(box->half_extents));
  return 1e300;
}

/// What a collider that is no member of a set sweeps, and how far it moves: it may push what it meets as fast as that.
std::vector<Reach> moving_colliders(const FrameStart& f) {
  std::vector<Reach> moving;
  for (int c = 0; c < static_cast<int>(f.model.colliders.size()); ++c) {
    const Collider& collider = f.model.colliders[at(c)];
    const PoseDrive* drive = f.control.collider(c);
    if (drive != nullptr ? !drive->moves() : !collider.motion.moves()) continue;
    const Posed from = drive != nullptr ? drive->at(f.state.time) : collider_pose(collider, f.state.time),
                to = drive != nullptr ? drive->at(f.end()) : collider_pose(collider, f.end());
    const double radius = radius_of(collider.shape), turned = std::min(std::fabs(dot(from.rotation, to.rotation)), 1.);
    const double arm = radius < 1e300 ? 2 * radius * std::sqrt(1 - turned * turned) : 0;
    moving.push_back({min(from.position, to.position), max(from.position, to.position), radius,
                      length(to.position - from.position) + arm});
  }
  for (const FieldCollider& field : f.model.fields) {
    const PoseDrive* drive = f.control.mesh(field.object);
    if (drive != nullptr ? drive->moves() : f.model.objects[at(field.object)].carrier.moves())
      moving.push_back(reach_of(f, field.object, static_cast<double>(field.thickness)));
  }
  return moving;
}

/// The members that are near each other, by index in `among`.
Forest join_near(const std::vector<SetMember>& members, const std::vector<int>& among,
                 const std::vector<Reach>& reaches) {
  Forest forest(among.size());
  const auto meet = [&](int i, int j) { return can_meet(members[at(among[at(i)])], members[at(among[at(j)])]); };
  int gas = -1;  // what is mixed into gases is not divided
  for (int i = 0; i < static_cast<int>(among.size()); ++i) {
    if (!members[at(among[at(i)])].is_of_gas) continue;
    if (gas >= 0) forest.join(gas, i);
    gas = i;
  }
  // Nor are grains: the force of a contact depends on the substep, so that a heap would hop where its substeps change.
  for (int i = 0; i < static_cast<int>(among.size()); ++i)
    for (int j = 0; j < static_cast<int>(among.size()) && members[at(among[at(i)])].is_of_grains; ++j)
      if (i != j && meet(i, j)) forest.join(i, j);
  const auto low = [&](int i) { return reaches[at(i)].low.x - reaches[at(i)].margin(); };
  const auto high = [&](int i) { return reaches[at(i)].high.x + reaches[at(i)].margin(); };
  std::vector<int> order(among.size()), open;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return low(i) != low(j) ? low(i) < low(j) : i < j; });
  for (const int i : order) {
    if (reaches[at(i)].is_empty()) continue;
    std::erase_if(open, [&](int j) { return high(j) < low(i); });
    for (const int j : open)
      if (forest.first_of(i) != forest.first_of(j) && meet(i, j) && are_near(reaches[at(i)], reaches[at(j)]))
        forest.join(i, j);
    open.push_back(i);
  }
  return forest;
}

/// Gives all members of a set the largest displacement of one of them, which impacts may pass on. True if one changed.
bool share_moves(Forest& forest, std::vector<Reach>& reaches) {
  std::vector<double> most(reaches.size(), 0);
  for (int i = 0; i < static_cast<int>(reaches.size()); ++i)
    most[at(forest.first_of(i))] = std::max(most[at(forest.first_of(i))], reaches[at(i)].moved);
  bool has_changed = false;
  for (int i = 0; i < static_cast<int>(reaches.size()); ++i) {
    has_changed = has_changed || reaches[at(i)].moved < most[at(forest.first_of(i))];
    reaches[at(i)].moved = most[at(forest.first_of(i))];
  }
  return has_changed;
}

/// True if distances between the members of a set matter: not for rigid bodies alone, which have equal substeps, near
/// or far.
bool is_worth_dividing(const std::vector<SetMember>& members, const std::vector<int>& among) {
  return among.size() > 1 && !std::all_of(among.begin(), among.end(), [&](int o) {
           const SetMember& m = members[at(o)];
           return m.rule == SubstepRule::constant && m.substeps == substeps_of_bodies && !m.is_of_grains;
         });
}

}  // namespace

NearSets::NearSets(const Model& model) : members_(set_members(model)), by_rules_(find_sets(members_)) {
  std::vector<std::vector<int>> sets(members_.size());
  for (int o = 0; o < static_cast<int>(members_.size()); ++o) sets[at(by_rules_[at(o)])].push_back(o);
  radius_.resize(members_.size(), 0);
  for (std::vector<int>& among : sets) {
    if (!is_worth_dividing(members_, among)) continue;
    for (const int o : among) radius_[at(o)] = std::max(radius_of(model.objects[at(o)]), kept_distance(model, o));
    divided_.push_back(std::move(among));
  }
}

std::vector<int> NearSets::find(const Model& model, const State& state, const Control& control, double dt) const {
  std::vector<int> sets = by_rules_;
  if (divided_.empty() || !model.forces.empty()) return sets;  // force fields may move anything anywhere
  const FrameStart frame{model, state, control, dt};
  const std::vector<Reach> colliders = moving_colliders(frame);
  for (const std::vector<int>& among : divided_) {
    std::vector<Reach> reaches;
    reaches.reserve(among.size());
    for (const int o : among) {
      Reach of = reach_of(frame, o, radius_[at(o)]);
      double pushed = 0;
      for (const Reach& collider : colliders)
        if (are_near(of, collider)) pushed = std::max(pushed, collider.moved);
      of.moved = std::max(of.moved, pushed);
      reaches.push_back(of);
    }
    Forest forest = join_near(members_, among, reaches);
    while (share_moves(forest, reaches)) forest = join_near(members_, among, reaches);
    for (std::size_t i = 0; i < among.size(); ++i) sets[at(among[i])] = among[at(forest.first_of(static_cast<int>(i)))];
  }
  return sets;
}

}  // namespace pliant
