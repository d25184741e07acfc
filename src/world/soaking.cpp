// A particle of liquid soaks in as a whole: its mass goes to the particles of the surface around the place that it
// touches, each up to its capacity, and it waits, as others of Flow do, until it is a drop again. So the solver sees no
// particle of another size. Where chance decides, a particle of diameter d goes in a frame with the probability speed
// dt / d, so that on average liquid flows at that speed.
#include "world/soaking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "collision/broad/tree.h"
#include "core/at.h"
#include "geometry/shapes.h"
#include "geometry/triangle.h"
#include "math/motion.h"
#include "math/record.h"
#include "world/control.h"
#include "world/particles.h"
#include "world/wicking.h"

namespace pliant {

namespace {

void add(Record& to, const Vec3f& what) { to = {to.x + what.x, to.y + what.y, to.z + what.z, to.w}; }

/// How much farther than at contact a particle of liquid still touches a surface, as a share of that distance.
constexpr float slack = 0.25f;
/// The least distance of a drop from other particles, as a share of its diameter.
constexpr float room_of_drop = 0.7f;

bool is_liquid(const CompiledObject& object) { return object.fluid && !object.gas; }

/// A number from 0 to 1 that differs for each particle, frame and purpose.
double chance(std::int64_t particle, std::int64_t frame, std::uint64_t purpose) {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t seed = ((static_cast<std::uint64_t>(frame) << 32) + static_cast<std::uint64_t>(particle)) * 2 + purpose;
  seed = (seed + 1) * golden;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9ULL;  // splitmix64
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((seed ^ (seed >> 31)) >> 11) * 0x1p-53;
}

/// What each particle of the State holds [kg].
float* water_of(WorldData& world) {
  const auto found = std::find_if(world.state.channels.begin(), world.state.channels.end(),
                                  [](const Channel& channel) { return channel.name == water_channel; });
  return found->values.data();
}

/// A particle of liquid at a surface.
struct Touch {
  int liquid = 0;                ///< number of its object
  std::int64_t particle = 0;     ///< of the State
  std::array<int, 3> corners{};  ///< of the surface, in storage order
  std::array<float, 3> weights{};
  Vec3f place{};       ///< on the surface [m]
  Vec3f away{};        ///< unit vector from there to the particle
  float distance = 0;  ///< [m]
};

/// What one surface takes up and gives off in a frame.
class Soaking {
 public:
  Soaking(WorldData& world, int number, double dt, FlowReport& report)
      : world_(world),
        state_(world.state),
        number_(number),
        object_(world.model.objects[at(number)]),
        surface_(object_.absorbency),
        first_(world.model.first[at(number)]),
        water_(water_of(world) + first_),
        dt_(dt),
        report_(report) {
    const float g = length(world.model.gravity);
    down_ = g > 0 ? world.model.gravity * (1 / g) : Vec3f{};
  }

  void run() {
    list_neighbours();
    find_near();
    for (const Touch& touch : near_) note(touch.particle);
    for (Touch& touch : near_) {
      if (touch.distance > (1 + slack) * contact_distance(touch.liquid)) continue;
      drag(touch);
      if (!take_up(touch)) seep(touch);
    }
    const Slopes slopes = slopes_of(surface_, heights());
    spread(surface_, slopes, dt_, water_, [&](int from, int to, float mass) { carry(from, to, mass); });
    drip(slopes);
    set_wet_masses(world_, number_);
  }

 private:
  const CompiledObject& liquid(int number) const { return world_.model.objects[at(number)]; }
  float contact_distance(int of) const { return object_.thickness + liquid(of).thickness; }
  Record& corner(int particle) const { return state_.positions[at(first_ + particle)]; }
  float capacity(int particle) const { return surface_.areas[at(particle)] * surface_.described.capacity; }
  float room(int particle) const { return std::max(capacity(particle) - water_[particle], 0.f); }
  /// The inverse mass that a particle of a liquid has while it is there [1/kg].
  float inverse_mass_of(int of, std::int64_t particle) const { return own_inverse_mass(world_.model, of, particle); }
  /// Its mass [kg]; 0 if that is infinite.
  float mass_of(int of, std::int64_t particle) const {
    const float w = inverse_mass_of(of, particle);
    return w > 0 ? 1 / w : 0;
  }
  /// The mass of a particle of the surface without water [kg]; 0 if it is infinite.
  float dry_mass(int particle) const {
    const float w = object_.positions[at(particle)].w;
    return w > 0 ? 1 / w : 0;
  }

  std::vector<double> heights() const {
    constexpr double earth = 9.80665;
    const Vec3d g = convert<double>(world_.model.gravity) * (-1 / earth);
    std::vector<double> out(surface_.areas.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = dot(g, convert<double>(xyz(corner(static_cast<int>(i)))));
    return out;
  }

  void list_neighbours() {
    begin_.assign(surface_.areas.size() + 1, 0);
    for (const auto& edge : surface_.edges) ++begin_[at(edge.a) + 1], ++begin_[at(edge.b) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    neighbours_.resize(at(begin_.back()));
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (const auto& edge : surface_.edges) {
      neighbours_[at(next[at(edge.a)]++)] = edge.b;
      neighbours_[at(next[at(edge.b)]++)] = edge.a;
    }
  }

  // ---- what is near

  /// Lists the particles of all liquids within about a diameter of the surface, each with the nearest triangle.
  void find_near() {
    float reach = 0;
    for (int o = 0; o < static_cast<int>(world_.model.objects.size()); ++o)
      if (is_liquid(liquid(o)) && masks_meet(liquid(o), object_))
        reach = std::max(reach, (1 + slack) * contact_distance(o) + liquid(o).fluid->spacing);
    if (reach == 0) return;
    cell_size_ = reach;
    std::vector<BoxBounds> boxes;
    for (const std::array<int, 3>& t : object_.surface.triangles) {
      const std::array<Vec3f, 3> x{xyz(corner(t[0])), xyz(corner(t[1])), xyz(corner(t[2]))};
      boxes.push_back(BoxBounds::of(x.data(), 3).grown(reach));
    }
    if (boxes.empty()) return;
    Tree<BoxBounds> tree;
    tree.build(boxes);
    const BoxBounds all = BoxBounds::merged(boxes.data(), static_cast<int>(boxes.size()));
    for (int o = 0; o < static_cast<int>(world_.model.objects.size()); ++o)
      if (is_liquid(liquid(o)) && masks_meet(liquid(o), object_)) find_near(o, tree, all);
  }

  void find_near(int of, const Tree<BoxBounds>& tree, const BoxBounds& all) {
    const std::int64_t begin = world_.model.first[at(of)], end = begin + liquid(of).user_particles;
    for (std::int64_t i = begin; i < end; ++i) {
      if (!is_there(state_, at(i)) || !(state_.positions[at(i)].w > 0)) continue;
      const Vec3f x = xyz(state_.positions[at(i)]);
      const BoxBounds point = BoxBounds::of(&x, 1);
      if (!overlap(point, all)) continue;
      int nearest = -1;
      ClosestOnTriangle<float> closest{};
      tree.query(point, [&](int triangle) {
        const auto found = closest_on(triangle, x);
        const bool is_nearer = nearest < 0 || found.distance_squared < closest.distance_squared ||
                               (found.distance_squared == closest.distance_squared && triangle < nearest);
        if (is_nearer) closest = found, nearest = triangle;
      });
      if (nearest >= 0) near_.push_back(touch_of(of, i, nearest, closest, x));
    }
  }

  ClosestOnTriangle<float> closest_on(int triangle, const Vec3f& x) const {
    const std::array<int, 3>& t = object_.surface.triangles[at(triangle)];
    return closest_on_triangle(x, xyz(corner(t[0])), xyz(corner(t[1])), xyz(corner(t[2])));
  }

  Touch touch_of(int of, std::int64_t particle, int triangle, const ClosestOnTriangle<float>& closest,
                 const Vec3f& x) const {
    const float distance = sqrt(closest.distance_squared);
    return {of,
            particle,
            object_.surface.triangles[at(triangle)],
            {closest.weights.x, closest.weights.y, closest.weights.z},
            closest.point,
            distance > 0 ? (x - closest.point) * (1 / distance) : Vec3f{} - down_,
            distance};
  }

  std::array<std::int64_t, 3> cell_of(const Vec3f& place) const {
    const auto cell = [&](float x) {
      return static_cast<std::int64_t>(std::floor(std::clamp(x / cell_size_, -1e15f, 1e15f)));
    };
    return {cell(place.x), cell(place.y), cell(place.z)};
  }

  /// Notes where a particle of liquid is now; where it was before need not be forgotten.
  void note(std::int64_t particle) { cells_[cell_of(xyz(state_.positions[at(particle)]))].push_back(particle); }

  /// True if a particle of liquid may be put at a place: no other one is too near, and no solid.
  bool is_free(const Vec3f& place, int of, std::int64_t but) const {
    const float least = room_of_drop * liquid(of).fluid->spacing;
    const auto is_near = [&](std::int64_t other) {
      return other != but && is_there(state_, at(other)) &&
             length_squared(xyz(state_.positions[at(other)]) - place) < least * least;
    };
    const std::array<std::int64_t, 3> middle = cell_of(place);
    for (std::int64_t c = 0; c < 27; ++c) {
      const auto found = cells_.find({middle[0] + c % 3 - 1, middle[1] + c / 3 % 3 - 1, middle[2] + c / 9 - 1});
      if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), is_near)) return false;
    }
    return std::none_of(colliders_.begin(), colliders_.end(), [&](const ColliderId& id) {
      const Collider& collider = world_.collider(id);
      const Vec3f local = convert<float>(to_local(pose_now(world_, id), convert<double>(place)));
      return signed_distance(local_shape(collider.shape), local).distance < liquid(of).thickness + collider.thickness;
    });
  }

  // ---- liquid and surface

  void push(int particle, const Vec3f& impulse) {
    Record& v = state_.velocities[at(first_ + particle)];
    add(v, impulse * corner(particle).w);
  }

  /// Both take on part of the velocity of the other.
  void drag(const Touch& touch) {
    const auto by = static_cast<float>(dt_) * surface_.described.drag;
    if (by > 0) share_velocity(touch, by / (1 + by));
  }

  /// Takes away a share of the velocity of a particle against the surface, and keeps momentum.
  void share_velocity(const Touch& touch, float share) {
    Record& own = state_.velocities[at(touch.particle)];
    const float w = state_.positions[at(touch.particle)].w;
    float inverse = w;
    Vec3f slower = xyz(own);
    for (std::size_t k = 0; k < 3; ++k) {
      slower = slower - xyz(state_.velocities[at(first_ + touch.corners[k])]) * touch.weights[k];
      inverse += touch.weights[k] * touch.weights[k] * corner(touch.corners[k]).w;
    }
    const Vec3f impulse = slower * (share / inverse);
    add(own, impulse * -w);
    for (std::size_t k = 0; k < 3; ++k) push(touch.corners[k], impulse * touch.weights[k]);
  }

  /// Particles of the surface along edges from the given ones, nearest first, no farther from a place than the root of
  /// `reach_squared`, until their shares add up to a mass; empty if they do not.
  template <class Share>
  std::vector<int> gather(std::vector<int> found, const Vec3f& place, float reach_squared, float mass,
                          const Share& share) {
    visited_.resize(surface_.areas.size(), 0);
    for (const int one : found) visited_[at(one)] = 1;
    float sum = 0;
    for (std::size_t k = 0; k < found.size() && sum < mass; ++k) {
      sum += share(found[k]);
      for (int n = begin_[at(found[k])]; n < begin_[at(found[k]) + 1]; ++n) {
        const int next = neighbours_[at(n)];
        if (visited_[at(next)] != 0 || length_squared(xyz(corner(next)) - place) > reach_squared) continue;
        visited_[at(next)] = 1;
        found.push_back(next);
      }
    }
    for (const int one : found) visited_[at(one)] = 0;
    if (sum < mass) found.clear();
    return found;
  }

  /// The particles of the surface that take up a mass; empty if those within twice the radius of a disc that holds it
  /// have no room.
  std::vector<int> takers(const Touch& touch, float mass) {
    const float reach_squared = 4 * mass / (3.14159265f * surface_.described.capacity);
    return gather({touch.corners.begin(), touch.corners.end()}, touch.place, reach_squared, mass,
                  [&](int i) { return room(i); });
  }

  bool happens(const Touch& touch, float speed, std::uint64_t purpose) const {
    const double probability =
        static_cast<double>(speed) * dt_ / static_cast<double>(liquid(touch.liquid).fluid->spacing);
    return chance(touch.particle, state_.frame, purpose) < probability;
  }

  /// Takes up a particle, if the surface has room. True unless it is full there.
  bool take_up(const Touch& touch) {
    const float mass = mass_of(touch.liquid, touch.particle);
    if (!(mass > 0)) return true;
    const bool soaks = happens(touch, surface_.described.uptake, 0);
    if (!soaks && !(surface_.described.seepage > 0)) return true;
    const std::vector<int> into = takers(touch, mass);
    if (into.empty() || !soaks) return !into.empty();
    const Vec3f velocity = xyz(state_.velocities[at(touch.particle)]);
    float left = mass;
    for (const int one : into) {
      const float taken = std::min(room(one), left);
      left -= taken;
      give(one, taken, velocity);
    }
    remove(touch.particle);
    ++report_.soaked;
    return true;
  }

  /// Adds liquid that comes with a velocity to a particle of the surface.
  void give(int particle, float mass, const Vec3f& velocity) {
    water_[particle] += mass;
    mix(particle, mass, velocity);
    if (corner(particle).w > 0)
      corner(particle).w = wet_inverse_mass(object_.positions[at(particle)].w, water_[particle]);
  }

  /// What a particle of the surface has taken up changes its velocity.
  void mix(int particle, float mass, const Vec3f& velocity) {
    const float dry = dry_mass(particle);
    if (!(dry > 0) || !(corner(particle).w > 0)) return;
    Record& v = state_.velocities[at(first_ + particle)];
    add(v, (velocity - xyz(v)) * (mass / (dry + water_[particle])));
  }

  void carry(int from, int to, float mass) { mix(to, mass, xyz(state_.velocities[at(first_ + from)])); }

  void remove(std::int64_t particle) {
    state_.positions[at(particle)].w = 0;
    state_.velocities[at(particle)] = {};
    state_.remainders[at(particle)] = {};
    state_.births[at(particle)] = not_there;
  }

  /// Lets a particle that lies on a full surface pass to its other side, where it leaves with the surface's velocity:
  /// what comes out of pores has lost its own.
  void seep(const Touch& touch) {
    const float falls = -dot(touch.away, down_);
    if (!(falls > 0) || !happens(touch, surface_.described.seepage * falls, 1)) return;
    const Vec3f below = touch.place - touch.away * ((1 + slack / 2) * contact_distance(touch.liquid));
    if (!is_free(below, touch.liquid, touch.particle)) return;
    Record& x = state_.positions[at(touch.particle)];
    x = {below.x, below.y, below.z, x.w};
    state_.remainders[at(touch.particle)] = {};
    share_velocity(touch, 1);
    note(touch.particle);
    ++report_.seeped;
  }

  // ---- drops

  /// The first particle that is not there, from one on, of a liquid that meets the surface; -1: none.
  std::int64_t find_spare(int of, std::int64_t begin) const {
    const std::int64_t end = world_.model.first[at(of)] + liquid(of).user_particles;
    for (std::int64_t i = begin; i < end; ++i)
      if (!is_there(state_, at(i)) && mass_of(of, i) > 0) return i;
    return -1;
  }

  /// Where liquid has collected at lowest places, drops fall off: from those that have most first.
  void drip(const Slopes& slopes) {
    std::vector<int> lowest;
    for (int i = 0; i < static_cast<int>(slopes.down.size()); ++i)
      if (slopes.down[at(i)] < 0 && excess(i) > 0) lowest.push_back(i);
    if (lowest.empty()) return;
    std::stable_sort(lowest.begin(), lowest.end(), [&](int a, int b) { return excess(a) > excess(b); });
    for (int of = 0; of < static_cast<int>(world_.model.objects.size()); ++of) {
      if (!is_liquid(liquid(of)) || !masks_meet(liquid(of), object_)) continue;
      std::int64_t spare = find_spare(of, world_.model.first[at(of)]);
      for (std::size_t k = 0; spare >= 0 && k < lowest.size(); ++k)
        if (let_fall(lowest[k], of, spare)) spare = find_spare(of, spare + 1);
    }
  }

  float excess(int particle) const { return std::max(water_[particle] - capacity(particle), 0.f); }

  /// Lets a drop fall off, if there is enough for it within two of its diameters: there surface tension draws it
  /// together.
  bool let_fall(int from, int of, std::int64_t spare) {
    const float mass = mass_of(of, spare), reach = 2 * liquid(of).fluid->spacing;
    const std::vector<int> found =
        gather({from}, xyz(corner(from)), reach * reach, mass, [&](int i) { return excess(i); });
    if (found.empty()) return false;
    const Vec3f place = xyz(corner(from)) + down_ * ((1 + slack / 2) * contact_distance(of));
    if (!is_free(place, of, -1)) return false;
    float left = mass;
    Vec3f momentum{};
    for (const int one : found) {
      const float taken = std::min(excess(one), left);
      left -= taken;
      water_[one] -= taken;
      momentum = momentum + xyz(state_.velocities[at(first_ + one)]) * taken;
    }
    const Vec3f v = momentum * (1 / mass);
    state_.positions[at(spare)] = {place.x, place.y, place.z, inverse_mass_of(of, spare)};
    state_.velocities[at(spare)] = {v.x, v.y, v.z, 0};
    state_.remainders[at(spare)] = {};
    state_.births[at(spare)] = state_.time;
    note(spare);
    ++report_.dripped;
    return true;
  }

  WorldData& world_;
  State& state_;
  int number_;
  const CompiledObject& object_;
  const CompiledAbsorbency& surface_;
  std::int64_t first_;
  float* water_;  ///< of the object's particles [kg]
  double dt_;
  FlowReport& report_;
  Vec3f down_{};
  std::vector<ColliderId> colliders_ = world_.ids.colliders.all();
  std::vector<Touch> near_;
  float cell_size_ = 1;  ///< at least the least distance of a drop from others [m]
  /// Particles of liquids that are or were near.
  std::map<std::array<std::int64_t, 3>, std::vector<std::int64_t>> cells_;
  std::vector<int> begin_, neighbours_;  ///< of particles, along edges
  std::vector<char> visited_;
};

}  // namespace

void open_liquids(WorldData& world) {
  const bool any = std::any_of(world.model.objects.begin(), world.model.objects.end(),
                               [](const CompiledObject& object) { return object.absorbency.is_used; });
  if (!any) return;
  for (CompiledObject& object : world.model.objects)
    if (is_liquid(object)) object.flow.open = true;
}

void open_all_liquids(WorldData& world) {
  bool any = false;
  for (CompiledObject& object : world.model.objects)
    if (is_liquid(object)) any = object.flow.open = true;
  if (any) world.state.births.resize(static_cast<std::size_t>(world.model.particles()), 0.0);
}

void set_wet_masses(WorldData& world, int number) {
  const CompiledObject& object = world.model.objects[at(number)];
  const std::int64_t first = world.model.first[at(number)];
  const float* water = water_of(world) + first;
  for (int i = 0; i < object.user_particles; ++i) {
    float& w = world.state.positions[at(first + i)].w;
    if (w > 0) w = wet_inverse_mass(object.positions[at(i)].w, water[i]);
  }
}

void soak(WorldData& world, double dt, FlowReport& report) {
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number)
    if (world.model.objects[at(number)].absorbency.is_used) Soaking(world, number, dt, report).run();
  if (report.seeped + report.dripped > 0) world.workspace.look_for_tangles = true;
}

}  // namespace pliant
