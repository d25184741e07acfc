// Tears and cuts objects at the end of a step (Object::tearing, Object::cuts).
#include "world/tearing.h"

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "matter/around.h"
#include "matter/break_constraints.h"
#include "matter/edit_parts.h"
#include "model/rods.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "world/objects.h"
#include "world/rest.h"
#include "world/tear_rods.h"

namespace pliant {

namespace {

/// True if a blade is in an object, or has passed and its cut is not made yet.
bool is_due(const PlaneCut& cut, double now) { return static_cast<double>(cut.start) <= now; }

/// Cuts that blades have passed are made, and not again where an edit joins what they parted. Those of rods, whose
/// broken joints are part of the State, are made again after an earlier one is restored.
void mark_made(std::vector<PlaneCut>& cuts, double now) {
  for (PlaneCut& cut : cuts)
    if (static_cast<double>(cut.end) <= now) cut.start = cut.end = std::numeric_limits<float>::infinity();
}

/// How many constraints fewer each group has, in all; a group that has more counts as none.
int lost_constraints(const Object& before, const Object& after) {
  std::size_t lost = 0;
  for (std::size_t g = 0; g < std::min(before.constraints.size(), after.constraints.size()); ++g) {
    const std::size_t had = before.constraints[g].particles.size(), has = after.constraints[g].particles.size();
    if (had > has) lost += (had - has) / static_cast<std::size_t>(slots_of(before.constraints[g], before));
  }
  return static_cast<int>(lost);
}

/// What the user set for an object by call, which an edit forgets and a tear must not.
class Settled {
 public:
  Settled(const State& state, int number) : number_(number) {
    const auto is_its = [number](const auto& setting) { return setting.block == number; };
    std::copy_if(state.motors.begin(), state.motors.end(), std::back_inserter(motors_), is_its);
    std::copy_if(state.rest_factors.begin(), state.rest_factors.end(), std::back_inserter(factors_), is_its);
    std::copy_if(
        state.surface_velocities.begin(), state.surface_velocities.end(), std::back_inserter(surfaces_),
        [number](const SurfaceVelocity& one) { return one.of == SurfaceVelocity::Of::body && one.slot == number; });
  }

  void put_back(WorldData& world) const {
    CompiledObject& object = world.model.objects[static_cast<std::size_t>(number_)];
    for (const MotorSetting& setting : motors_) {
      const CompiledJoint& joint = object.joints[static_cast<std::size_t>(setting.joint)];
      set_motor(object, joint, joint.motors[static_cast<std::size_t>(setting.motor)], setting.target, setting.most);
      world.state.motors.push_back(setting);
    }
    world.state.rest_factors.insert(world.state.rest_factors.end(), factors_.begin(), factors_.end());
    std::sort(world.state.motors.begin(), world.state.motors.end(), [](const MotorSetting& a, const MotorSetting& b) {
      return std::tie(a.block, a.joint, a.motor) < std::tie(b.block, b.joint, b.motor);
    });
    std::sort(world.state.rest_factors.begin(), world.state.rest_factors.end(),
              [](const RestFactor& a, const RestFactor& b) {
                return std::tie(a.block, a.group) < std::tie(b.block, b.group);
              });
    if (!factors_.empty()) follow_rest_factors(world, world.state.time);
    std::vector<SurfaceVelocity>& surfaces = world.state.surface_velocities;
    surfaces.insert(surfaces.end(), surfaces_.begin(), surfaces_.end());
    std::sort(surfaces.begin(), surfaces.end(), [](const SurfaceVelocity& a, const SurfaceVelocity& b) {
      return std::tie(a.of, a.slot, a.body) < std::tie(b.of, b.slot, b.body);
    });
  }

 private:
  int number_;
  std::vector<MotorSetting> motors_;
  std::vector<RestFactor> factors_;
  std::vector<SurfaceVelocity> surfaces_;
};

/// Particles that were one before an edit, by that one.
using Copies = std::map<int, std::vector<int>>;

/// An edit of an object that tears keeps its particles, and adds copies of some.
Copies copies_of(const std::vector<int>& from, int particles_before) {
  Copies copies;
  for (int i = particles_before; i < static_cast<int>(from.size()); ++i) {
    const int origin = from[static_cast<std::size_t>(i)];
    if (origin >= 0) copies.try_emplace(origin, 1, origin).first->second.push_back(i);
  }
  return copies;
}

/// The mean place of those that share a triangle or tetrahedron with a particle, for each that has copies or is one.
class MiddlesAround {
 public:
  MiddlesAround(const Object& object, const Copies& copies, const std::vector<Vec3f>& positions)
      : positions_(positions) {
    std::vector<char> marks(positions.size());
    for (const auto& [origin, all] : copies)
      for (const int one : all) marks[static_cast<std::size_t>(one)] = 1;
    tetrahedra_ = tetrahedra_of(object);
    if (tetrahedra_.empty()) triangles_ = object.triangles;
    around_ = tetrahedra_.empty() ? Around(triangles_, marks) : Around(tetrahedra_, marks);
  }

  Vec3d of(int particle) const {
    return tetrahedra_.empty() ? mean(particle, triangles_) : mean(particle, tetrahedra_);
  }

 private:
  template <class Elements>
  Vec3d mean(int particle, const Elements& elements) const {
    Vec3d sum{};
    int count = 0;
    for (const int e : around_[particle]) {
      const auto& corners = elements[static_cast<std::size_t>(e)];
      Vec3d of_element{};
      for (const int p : corners) of_element = of_element + convert<double>(positions_[static_cast<std::size_t>(p)]);
      sum = sum + of_element;
      count += static_cast<int>(corners.size());
    }
    return count > 0 ? sum * (1. / count) : convert<double>(positions_[static_cast<std::size_t>(particle)]);
  }

  const std::vector<Vec3f>& positions_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<std::array<int, 3>> triangles_;
  Around around_;
};

/// Moves particles that were one a little apart, each towards what it belongs to: contact must know on which side
/// surfaces are. Their centre of mass stays.
void open_gaps(WorldData& world, ObjectId id, const Copies& copies) {
  constexpr double share = 0.01;  // of the way to the middle of what is around a particle
  const std::vector<Vec3f> positions = ObjectView(world, id).positions();
  const MiddlesAround middles(world.descriptions.at(id.slot), copies, positions);
  const int number = world.number(id), first = world.model.first[number];
  for (const auto& [origin, all] : copies) {
    double mass = 0;
    Vec3d moment{};
    std::vector<Record*> records;
    std::vector<Vec3d> ways;
    for (const int one : all) {
      Record& x = world.state.positions[first + world.model.objects[number].place[one]];
      const Vec3d way = (middles.of(one) - Vec3d{x.x, x.y, x.z}) * share;
      const double weight = x.w > 0 ? 1 / static_cast<double>(x.w) : 0;
      mass += weight;
      moment = moment + way * weight;
      records.push_back(&x);
      ways.push_back(way);
    }
    const Vec3d shift = mass > 0 ? moment * (1 / mass) : Vec3d{};
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (!(records[i]->w > 0)) continue;
      const Vec3f way = convert<float>(ways[i] - shift);
      *records[i] = {records[i]->x + way.x, records[i]->y + way.y, records[i]->z + way.z, records[i]->w};
    }
  }
}

/// Makes an edit of an object that tears.
void open_up(WorldData& world, ObjectId id, Edit&& edit, Report& report) {
  const Object& before = world.descriptions.at(id.slot);
  const Copies copies = copies_of(edit.from, static_cast<int>(before.positions.size()));
  const Torn torn{id, static_cast<int>(edit.object.positions.size() - before.positions.size()),
                  lost_constraints(before, edit.object)};
  const Settled settled(world.state, world.number(id));
  const OverstretchRecord record = world.overstretch;  // particles keep their indices, so it stays true
  edit_object(world, id, std::move(edit));
  world.overstretch = record;
  settled.put_back(world);
  open_gaps(world, id, copies);
  const auto same =
      std::find_if(report.torn.begin(), report.torn.end(), [&](const Torn& one) { return one.object == id; });
  if (same == report.torn.end()) return report.torn.push_back(torn);
  same->new_particles += torn.new_particles;
  same->lost_constraints += torn.lost_constraints;
}

/// The positions of an object's particles with what floats cannot hold, in the user's order.
std::vector<Vec3d> exact_positions(const WorldData& world, int number) {
  const CompiledObject& object = world.model.objects[number];
  std::vector<Vec3d> positions;
  for (int user = 0; user < object.user_particles; ++user) {
    const int at = world.model.first[number] + object.place[user];
    const Record &x = world.state.positions[at], &r = world.state.remainders[at];
    positions.push_back(convert<double>(Vec3f{x.x, x.y, x.z}) + convert<double>(Vec3f{r.x, r.y, r.z}));
  }
  return positions;
}

/// The Edit that breaks what carries too much; nothing if all holds.
std::optional<Edit> broken_by_force(const WorldData& world, ObjectId id, const Object& object) {
  const int number = world.number(id);
  const std::vector<Vec3d> positions = exact_positions(world, number);
  const auto factor = [&](int group) { return rest_factor_of(world, number, group); };
  const auto multipliers = [&](const std::string& type) {
    const float h = world.workspace.last_h[number];  // 0 after an edit, until the next step
    std::vector<float> values = h > 0 ? ObjectView(world, id).multipliers(type) : std::vector<float>{};
    for (float& value : values) value /= h * h;
    return values;
  };
  return break_constraints(object,
                           {positions, factor, multipliers, static_cast<double>(world.workspace.last_h[number])});
}

void tear_object(WorldData& world, ObjectId id, Report& report) {
  const double now = world.state.time;
  Object& torn = world.descriptions.at(id.slot);
  const bool is_being_cut =
      std::any_of(torn.cuts.begin(), torn.cuts.end(), [&](const PlaneCut& cut) { return is_due(cut, now); });
  if (is_being_cut)
    if (std::optional<Edit> edit = make_cuts(torn, now)) open_up(world, id, std::move(*edit), report);
  if (can_break(torn))
    if (std::optional<Edit> edit = broken_by_force(world, id, torn)) open_up(world, id, std::move(*edit), report);
  if (torn.tearing)
    if (std::optional<Edit> edit = tear(torn, ObjectView(world, id).positions()))
      open_up(world, id, std::move(*edit), report);
  if (has_rods(torn))
    tear_rods(world, id, torn, is_being_cut, report);
  else
    mark_made(torn.cuts, now);
}

}  // namespace

void keep_description(WorldData& world, int slot, const Object* object) {
  if (object == nullptr || !(world.kept_scene || comes_apart(*object))) {
    world.descriptions.erase(slot);
    return;
  }
  world.descriptions[slot] = *object;
}

void keep_description(WorldData& world, int slot, Object&& object) {
  if (world.kept_scene || comes_apart(object))
    world.descriptions[slot] = std::move(object);
  else
    world.descriptions.erase(slot);
}

void tear_objects(WorldData& world, Report& report) {
  if (world.descriptions.empty()) return;
  for (const ObjectId id : world.ids.objects.all()) {
    const auto found = world.descriptions.find(id.slot);
    if (found == world.descriptions.end() || !comes_apart(found->second)) continue;
    try {
      tear_object(world, id, report);
    } catch (const std::exception& error) {  // it stays whole
      report.warnings.push_back("object '" + found->second.name + "' could not tear: " + error.what());
    }
  }
}

const Object& ObjectView::description() const {
  const std::string& name = read_->object(id_).name;  // throws an Error if the id is stale
  const auto found = read_->descriptions.find(id_.slot);
  if (found == read_->descriptions.end())
    throw Error({.object = name}, "has no description in the World",
                "make the World with KeepDescription, or keep the Object that you added");
  return found->second;
}

}  // namespace pliant
