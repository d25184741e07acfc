#include "world/jumps.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <optional>

#include "core/at.h"
#include "math/record.h"
#include "math/vector.h"
#include "world/groups.h"
#include "world/teleport.h"

namespace pliant {

namespace {

/// A jump is longer than this many sizes, and this many times the largest thickness: a frame has some hundred substeps,
/// each of which resolves half a thickness, so contact on the way of a jump is lost in any case.
constexpr double jump_over_size = 4, jump_over_thickness = 1000;
/// What jumps by as much as another thing, up to this share of its size, is placed by the same displacement.
constexpr double alike_over_size = 0.25;

/// A thing that the user moves in the coming frame.
struct Jump {
  int number = 0;         ///< in the model
  Vec3d by{};             ///< mean displacement of what is moved [m]
  double unforeseen = 0;  ///< its distance from where the velocity leads [m]
  double size = 0;        ///< largest extent [m]
  bool is_whole = true;   ///< false: parts of it are moved otherwise, or held
};

/// The size, and the mean velocity of the particles that the frame moves freely, or of all if there are none.
struct Whole {
  double size = 0;
  Vec3d velocity{};
  int kinematic = 0;  ///< particles of infinite mass
};

Whole measure_whole(const WorldData& world, int number) {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300}, of_free{}, of_all{};
  Whole whole;
  int all = 0;
  for (int i = world.model.first[at(number)]; i < world.model.end_of(number); ++i) {
    if (!is_there(world.state, at(i))) continue;
    const Record& x = world.state.positions[at(i)];
    const Vec3d place = convert<double>(xyz(x)), velocity = convert<double>(xyz(world.state.velocities[at(i)]));
    low = min(low, place);
    high = max(high, place);
    of_all += velocity;
    ++all;
    if (x.w > 0) of_free += velocity;
    if (!(x.w > 0)) ++whole.kinematic;
  }
  const int free = all - whole.kinematic;
  if (all > 0) whole.size = largest(high - low);
  if (all > 0) whole.velocity = free > 0 ? of_free * (1. / free) : of_all * (1. / all);
  return whole;
}

/// The displacements that targets or a pose ask for, by storage index.
std::vector<Vec3d> asked_moves(const WorldData& world, int number) {
  std::vector<Vec3d> moves;
  const Control& control = world.workspace.control;
  if (const ObjectControl* given = control.object(number)) {
    moves.reserve(given->targets.size());
    for (const Target& target : given->targets) moves.push_back(target.to - target.from);
  } else if (const PoseDrive* drive = control.mesh(number); drive != nullptr && drive->moves()) {
    const CompiledObject& object = world.model.objects[at(number)];
    const CarrierPose pose(object.carrier, drive->end, drive->to);
    moves.reserve(at(object.particles));
    for (int i = 0; i < object.particles; ++i)
      moves.push_back(pose.place(i) -
                      convert<double>(xyz(world.state.positions[at(world.model.first[at(number)] + i)])));
  }
  return moves;
}

/// The largest thickness of a surface [m].
double largest_thickness(const WorldData& world) {
  float largest = 0;
  for (const CompiledObject& object : world.model.objects) largest = max(largest, object.thickness);
  return static_cast<double>(largest);
}

/// True if contact between surfaces may search an object.
bool may_meet_surfaces(const WorldData& world, const CompiledObject& object) {
  const auto is_mesh = [](const CompiledObject& one) { return one.is_collider && one.groups != 0; };
  return object.self_collision || object.collides ||
         std::any_of(world.model.objects.begin(), world.model.objects.end(), is_mesh);
}

/// What the user moves by a jump; nothing where contact between surfaces does not search the thing.
std::optional<Jump> find_jump(const WorldData& world, int number, double dt) {
  const CompiledObject& object = world.model.objects[at(number)];
  if (object.groups == 0 || !may_meet_surfaces(world, object)) return std::nullopt;
  const std::vector<Vec3d> moves = asked_moves(world, number);
  if (moves.empty()) return std::nullopt;
  const Whole whole = measure_whole(world, number);
  Jump jump{number, std::accumulate(moves.begin(), moves.end(), Vec3d{}) * (1. / static_cast<double>(moves.size()))};
  jump.size = whole.size;
  jump.unforeseen = length(jump.by - whole.velocity * dt);
  const double least = std::max(jump_over_size * whole.size, jump_over_thickness * largest_thickness(world));
  if (!(whole.size > 0) || !(jump.unforeseen > least)) return std::nullopt;
  const auto is_alike = [&](const Vec3d& move) { return length(move - jump.by) <= whole.size; };
  const bool is_held =
      !object.is_collider && (static_cast<int>(moves.size()) < whole.kinematic || !object.kinematics.empty());
  // Bodies that no joint connects with what is moved stay where they are.
  const bool has_loose =
      !object.bodies.bodies.empty() && object.joints.empty() && moves.size() < object.bodies.bodies.size();
  jump.is_whole =
      !is_held && !has_loose && !object.carrier.moves() && std::all_of(moves.begin(), moves.end(), is_alike);
  return jump;
}

std::string words_of_jump(const WorldData& world, const Jump& jump) {
  const CompiledObject& object = world.model.objects[at(jump.number)];
  char text[160];
  std::snprintf(text, sizeof text, "moves %.3g m in one frame, over 4 times its size of %.3g m, ", length(jump.by),
                jump.size);
  return (object.is_collider ? "collider '" : "object '") + object.name + "': " + text +
         (jump.is_whole ? "and is placed there at once: call teleport first"
                        : "while a part of it stays, which stretches it and costs time: call teleport, or move it in "
                          "more frames");
}

/// Makes things that jump nearly alike jump alike, so that they keep their places to one another.
void align(std::vector<Jump>& jumps) {
  for (std::size_t i = 0; i < jumps.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (!(length(jumps[i].by - jumps[j].by) <= alike_over_size * jumps[i].size)) continue;
      jumps[i].by = jumps[j].by;
      break;
    }
}

}  // namespace

void place_what_jumps(WorldData& world, double dt, std::vector<std::string>& warnings) {
  Control& control = world.workspace.control;
  std::vector<Jump> jumps;
  const auto look_at = [&](int number) {
    if (const std::optional<Jump> jump = find_jump(world, number, dt)) jumps.push_back(*jump);
  };
  for (const auto& [number, given] : control.objects) look_at(number);
  for (const auto& [number, drive] : control.meshes) look_at(number);
  align(jumps);
  bool any = false;
  for (const Jump& jump : jumps) {
    warnings.push_back(words_of_jump(world, jump));
    if (!jump.is_whole) continue;
    any = true;
    displace(world, jump.number, {jump.by, {}});
    if (const auto drive = control.meshes.find(jump.number); drive != control.meshes.end())
      drive->second.from.position += jump.by;
  }
  if (any) bring_up_to_date(world);
}

}  // namespace pliant
