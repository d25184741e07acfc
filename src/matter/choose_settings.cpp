// Chooses the sweep and the substeps of a scene that leaves them open, by measurements at equal stretch
// (docs/internals/default_settings.md, "The sweep of an object").
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "constraints/registry.h"
#include "math/vector.h"
#include "matter/advice_settings.h"
#include "model/attachments.h"
#include "model/object_sets.h"
#include "pliant/scene.h"

namespace pliant {

namespace {

/// Objects with fewer particles do not need a special sweep: these are a few edges apart, and 20 substeps suffice.
constexpr std::size_t fewest_particles = 32;
/// A sheet whose bending length exceeds this share of its size supports itself; sweeps that correct only stretch
/// converge slowly.
constexpr double stiff_share = 0.25;
/// A spring continues straight at an end if another one leaves there within 10 degrees of its direction.
constexpr double straight_cosine = -0.985;
/// A mesh with more of its ends so is regular. Of a grid of 6 x 6 three quarters are, of irregular meshes a third.
constexpr double straight_share = 0.6;
/// Particles with more springs, such as the hub of a wheel, are left out of that count, which compares each with each.
constexpr std::size_t most_neighbours = 64;
constexpr const char* too_coarse = "only objects with fewer than 32 linked particles";

/// The position of a particle; zero if it does not exist, because this runs before the scene is validated.
Vec3d position(const Object& object, int particle) {
  const auto i = static_cast<std::size_t>(particle);
  return i < object.positions.size() ? convert<double>(object.positions[i]) : Vec3d{};
}

/// Counts the springs that multigrid corrects, which are distances with compliance; PBD distances are left to the sweeps.
std::size_t springs_of(const Object& object) {
  std::size_t count = 0;
  for (const ConstraintGroup& group : object.constraints)
    if (is_length(group.type) && group.stiffness.kind == Stiffness::Kind::compliance) count += group.particles.size() / 2;
  return count;
}

/// A path has one particle more than springs.
std::size_t linked_particles(std::size_t particles, std::size_t springs) {
  return springs == 0 ? 0 : std::min(particles, springs + 1);
}

/// Collects the flexural rigidity of each hinge [N m] (see hinge_compliance in cloth.cpp) and the sum of the areas of
/// hinges [m^2], in which a triangle occurs up to three times.
struct Bending {
  std::vector<double> rigidities;
  double area = 0;

  void add(const std::array<Vec3d, 4>& x, bool isometric, double compliance) {
    const Vec3d edge = x[1] - x[0];
    const double twice =
        std::sqrt(length_squared(cross(edge, x[2] - x[0]))) + std::sqrt(length_squared(cross(edge, x[3] - x[0])));
    const double beside = twice / 2;
    if (!(beside > 0)) return;  // a degenerate hinge says nothing about the sheet
    rigidities.push_back(isometric ? 3 / compliance : beside / (length_squared(edge) * compliance));
    area += beside;
  }

  /// The median rigidity, so that a few stiff hinges, such as a seam, do not make a stiff sheet.
  double median() {
    if (rigidities.empty()) return 0;
    const auto middle = rigidities.begin() + static_cast<std::ptrdiff_t>(rigidities.size() / 2);
    std::nth_element(rigidities.begin(), middle, rigidities.end());
    return *middle;
  }
};

/// Measures the hinges of an object. PBD stiffness counts as rigid if positive, because its effect depends on mesh and
/// step.
Bending bending_of(const Object& object) {
  Bending bending;
  std::size_t hinges = 0;
  for (const ConstraintGroup& group : object.constraints) hinges += group.particles.size() / 4;
  bending.rigidities.reserve(hinges);
  for (const ConstraintGroup& group : object.constraints) {
    const bool isometric = group.type == "isometric_bending", is_pbd = group.stiffness.kind == Stiffness::Kind::pbd;
    if (!isometric && group.type != "dihedral_bending") continue;
    if (is_pbd && !(group.stiffness.value > 0)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      std::array<Vec3d, 4> x;
      for (std::size_t slot = 0; slot < 4; ++slot) x[slot] = position(object, group.particles[4 * i + slot]);
      const float compliance = i < group.compliances.size() ? group.compliances[i] : group.stiffness.value;
      bending.add(x, isometric, is_pbd ? 0 : static_cast<double>(compliance));
    }
  }
  return bending;
}

double area_of(const Object& object) {
  double area = 0;
  for (const auto& triangle : object.triangles) {
    const Vec3d origin = position(object, triangle[0]);
    const Vec3d a = position(object, triangle[1]) - origin, b = position(object, triangle[2]) - origin;
    area += std::sqrt(length_squared(cross(a, b))) / 2;
  }
  return area;
}

/// True if the bending length (B / rho g)^(1/3) (Peirce 1930), the overhang at which a sheet bends under its own
/// weight, is large compared with its size. Cubes are compared, because machines differ in cube roots.
bool is_stiff_sheet(const Object& object, double gravity) {
  Bending bending = bending_of(object);
  const double rigidity = bending.median(), drawn = area_of(object), area = drawn > 0 ? drawn : bending.area / 3;
  if (!(rigidity > 0) || !(area > 0)) return false;
  const double weight = std::max(finite_mass(object) / area * std::max(gravity, least_acceleration), 1e-30);
  const double allowed = stiff_share * largest_extent(object.positions);
  return !(rigidity / weight <= allowed * allowed * allowed);
}

bool may_meet(std::uint32_t groups, std::uint32_t mask, const Object& object) {
  return (groups & object.mask) != 0 && (object.groups & mask) != 0;
}

/// True if the object's surface can touch itself, another object or a mesh collider.
bool can_touch(const Scene& scene, const Object& object) {
  if (object.self_collision) return true;
  const auto meets_object = [&](const Object& other) {
    return &other != &object && other.collides && may_meet(other.groups, other.mask, object);
  };
  const auto meets_mesh = [&](const MeshCollider& collider) {
    return collider.as == MeshCollider::As::triangles && may_meet(collider.groups, collider.mask, object);
  };
  return (object.collides && std::any_of(scene.objects.begin(), scene.objects.end(), meets_object)) ||
         std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), meets_mesh);
}

/// True if the object can meet a collider of any kind.
bool can_meet_collider(const Scene& scene, const Object& object) {
  const auto meets = [&](const MeshCollider& collider) { return may_meet(collider.groups, collider.mask, object); };
  return !scene.colliders.empty() || std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), meets);
}

bool have_same_motion(const Motion& a, const Motion& b) {
  const auto same_place = [](const Vec3f& p, const Vec3f& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
  const auto same = [&](const Keyframe& k, const Keyframe& l) {
    return k.time == l.time && same_place(k.position, l.position) && k.rotation.x == l.rotation.x &&
           k.rotation.y == l.rotation.y && k.rotation.z == l.rotation.z && k.rotation.w == l.rotation.w;
  };
  return a.repeat == b.repeat && same_place(a.pivot, b.pivot) &&
         std::equal(a.keyframes.begin(), a.keyframes.end(), b.keyframes.begin(), b.keyframes.end(), same);
}

/// Each particle's neighbours along springs that multigrid and chains correct. Those of particle p are numbers first[p] to
/// first[p + 1] of `all`.
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<int> all;
};

/// Calls visit(a, b) for the two particles of each spring. Particles that do not exist are left out.
template <class Visit>
void for_springs(const Object& object, const Visit& visit) {
  const auto exists = [&](int p) { return p >= 0 && static_cast<std::size_t>(p) < object.positions.size(); };
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    for (std::size_t i = 0; i + 1 < group.particles.size(); i += 2)
      if (exists(group.particles[i]) && exists(group.particles[i + 1])) visit(group.particles[i], group.particles[i + 1]);
  }
}

Neighbours neighbours_of(const Object& object) {
  Neighbours found;
  found.first.assign(object.positions.size() + 2, 0);  // counts of particle p at p + 2, then starts at p + 1, then at p
  for_springs(object, [&](int a, int b) {
    ++found.first[static_cast<std::size_t>(a) + 2];
    ++found.first[static_cast<std::size_t>(b) + 2];
  });
  std::partial_sum(found.first.begin(), found.first.end(), found.first.begin());
  found.all.resize(found.first.back());
  for_springs(object, [&](int a, int b) {
    found.all[found.first[static_cast<std::size_t>(a) + 1]++] = b;
    found.all[found.first[static_cast<std::size_t>(b) + 1]++] = a;
  });
  return found;
}

/// Directions of the springs at one particle.
struct Ways {
  std::array<Vec3d, most_neighbours> way;
  std::size_t count = 0;

  void add(const Vec3d& along) {
    const double squared = length_squared(along);
    if (squared > 0) way[count++] = along * (1 / std::sqrt(squared));
  }
  /// The number of springs that another one continues straight.
  std::size_t straight() const {
    const auto end = way.begin() + static_cast<std::ptrdiff_t>(count);
    return static_cast<std::size_t>(std::count_if(way.begin(), end, [&](const Vec3d& one) {
      return std::any_of(way.begin(), end, [&](const Vec3d& other) { return dot(one, other) < straight_cosine; });
    }));
  }
};

/// True if most springs continue straight at most of their ends, as on a grid and in a rope: chains are then long and carry
/// a force across the object in one pass.
bool is_regular(const Object& object) {
  const Neighbours neighbours = neighbours_of(object);
  std::size_t straight = 0, ends = 0;
  Ways ways;
  for (std::size_t p = 0; p < object.positions.size(); ++p) {
    if (neighbours.first[p + 1] - neighbours.first[p] > most_neighbours) continue;
    ways.count = 0;
    const Vec3d here = convert<double>(object.positions[p]);
    for (std::size_t i = neighbours.first[p]; i < neighbours.first[p + 1]; ++i)
      ways.add(position(object, neighbours.all[i]) - here);
    straight += ways.straight();
    ends += ways.count;
  }
  return static_cast<double>(straight) > straight_share * static_cast<double>(ends);
}

/// True if it has pins, or attachments that act like pins, whose distances stay the same: none moves, or all have one motion.
bool hangs(const Object& object, double gravity) {
  if (object.pins.empty() && object.attachments.empty()) return false;
  const Motion& one = object.pins.empty() ? object.attachments.front().motion : object.pins.front().motion;
  const auto moves_alike = [&](const auto& other) { return have_same_motion(other.motion, one); };
  const AttachmentTest test(object, gravity);
  const auto holds = [&](const Attachment& other) { return test.is_like_pin(other) && moves_alike(other); };
  return std::all_of(object.pins.begin(), object.pins.end(), moves_alike) &&
         std::all_of(object.attachments.begin(), object.attachments.end(), holds);
}

double gravity_of(const Scene& scene) { return std::sqrt(static_cast<double>(length_squared(scene.gravity))); }

/// True if tethers do not change how an object moves: it hangs from pins whose distances stay, and is not meant to stretch.
bool may_be_tethered(const Scene& scene, const Object& object) {
  return hangs(object, gravity_of(scene)) && !is_meant_to_stretch(object, gravity_of(scene));
}

/// True if more than a tenth of the particles are pinned or attached, as in Cusick's test of drape. What overhangs is short, and bends by the
/// substeps that its strain demands; with tethers there is less strain, so fewer substeps, and cloth that can touch itself drapes
/// too softly.
bool lies_on_pins(const Object& object) {
  return 10 * (object.pins.size() + object.attachments.size()) > object.positions.size();
}

bool has_fixed(const Object& object) {
  return !object.pins.empty() || !object.attachments.empty() ||
         std::any_of(object.masses.begin(), object.masses.end(), [](float mass) { return std::isinf(mass); });
}

struct Choice {
  Sweep sweep = Sweep::tiled;
  std::string reason;
};

/// What the sets of a scene demand before a sweep is chosen for its volumes; found when the first inflated object asks.
class OpenSets {
 public:
  OpenSets(const Scene& scene, const Settings& settings) : scene_(scene), settings_(settings) {}

  /// The substeps in which chains would solve an inflated object of the scene, or fewer.
  int substeps_of(const Object& object) {
    if (settings_.substeps > 0) return settings_.substeps;
    if (sets_.empty()) find();
    const SetSubsteps& set = sets_[static_cast<std::size_t>(&object - scene_.objects.data())];
    if (set.substeps == substeps_of_others) return substeps_of_others;  // for which PBD stiffness is converted
    const bool has_bounds = set.by_state && settings_.least_substeps + settings_.most_substeps > 0;
    if (!has_bounds) return substeps_of_volumes;
    const int least = settings_.least_substeps > 0 ? settings_.least_substeps : substeps_of_volumes;
    return settings_.most_substeps > 0 ? std::min(least, settings_.most_substeps) : least;
  }

 private:
  void find() {
    std::vector<SetMember> members;
    for (const Object& object : scene_.objects) {
      const Sweep named = object.sweep != Sweep::automatic ? object.sweep : settings_.sweep;
      const Sweep sweep = named != Sweep::automatic ? named : Sweep::chains;
      members.push_back(member_of(object, 0, substep_rule(object, sweep, gravity_of(scene_))));
    }
    for (const MeshCollider& collider : scene_.mesh_colliders) members.push_back(member_of(collider));
    sets_ = substeps_of_sets(members);
  }

  const Scene& scene_;
  const Settings& settings_;
  std::vector<SetSubsteps> sets_;
};

/// The sweep of an object of 32 linked particles or more with a volume.
Choice choose_for_volume(const Scene& scene, const Object& object, OpenSets& sets) {
  const std::string name = "'" + object.name + "'";
  const double frame = static_cast<double>(scene.frame_time);
  if (strain_of_inflated(object) == 0) return {Sweep::chains, name + ", which has a volume"};
  if (!can_follow_volume(object, frame / substeps_of_volumes))
    return {Sweep::tiled, name + ", which is inflated, though its edges resist that"};
  const int substeps = sets.substeps_of(object);
  if (!can_follow_volume(object, frame / substeps))
    return {Sweep::tiled,
            name + ", which is inflated, for which " + std::to_string(substeps) + " substeps of chains are too few"};
  return {Sweep::chains, name + ", which has a volume"};
}

Choice choose(const Scene& scene, const Settings& settings, const Object& object, OpenSets& sets) {
  const std::string name = "'" + object.name + "'";
  const double gravity = gravity_of(scene);
  const std::size_t springs = springs_of(object);
  if (settings.iterations > 1) return {Sweep::tiled, "more than one iteration"};
  const std::size_t particles = linked_particles(object.positions.size(), springs);
  if (is_coarse(particles)) return {Sweep::tiled, too_coarse};
  if (object.volume) return choose_for_volume(scene, object, sets);
  // Neither tethers nor multigrid know of bending, which demands more substeps than they need for stretch.
  const bool is_stiff = is_stiff_sheet(object, gravity), is_in_rows = is_regular(object);
  const bool touches = can_touch(scene, object);
  if (!is_stiff && is_in_rows && may_be_tethered(scene, object) && (!touches || !lies_on_pins(object)))
    return {Sweep::tethered_chains, name + ", which hangs from pins or attachments and has its springs in straight rows"};
  if (touches) return {Sweep::chains, name + ", a surface that can touch itself or others"};
  if (is_stiff) return {Sweep::chains, name + ", a sheet whose bending length is more than a quarter of its size"};
  if (is_in_rows) return {Sweep::chains, name + ", whose springs lie in straight rows"};
  // Multigrid would be faster at equal stretch, but cloth that should slide over a collider sticks with it.
  if (can_meet_collider(scene, object)) return {Sweep::chains, name + ", which can meet a collider"};
  return {Sweep::multigrid,
          "irregular cloth or rope that meets nothing, the largest of " + std::to_string(particles) + " particles"};
}

/// The sweep of one object: its own, else that of the settings, else the one chosen for it.
Choice choice_of(const Scene& scene, const Settings& settings, const Object& object, OpenSets& sets) {
  if (object.sweep != Sweep::automatic) return {object.sweep, {}};
  if (settings.sweep != Sweep::automatic) return {settings.sweep, {}};
  return choose(scene, settings, object, sets);
}

/// Counts the objects of each sweep. Objects too small for sweeps to differ are ignored; they use the sweep of the others.
struct SweepsInUse {
  struct Use {
    std::string first;  ///< name of the first object
    int objects = 0;
  };
  std::map<Sweep, Use> uses;
  std::string reason = too_coarse;  ///< reason of the largest object with multigrid, else of the first object
  std::size_t particles = 0;        ///< number of particles of the object that `reason` concerns

  void add(const Object& object, const Choice& choice) {
    Use& use = uses[choice.sweep];
    if (use.objects++ == 0) use.first = object.name;
    const bool is_larger = choice.sweep == Sweep::multigrid && object.positions.size() > particles;
    if (reason != too_coarse && !is_larger) return;
    reason = choice.reason;
    particles = object.positions.size();
  }

  /// The sweep that all objects have; `automatic` if they differ; `of_none` if there are no objects.
  Sweep common(Sweep of_none) const {
    return uses.empty() ? of_none : uses.size() == 1 ? uses.begin()->first : Sweep::automatic;
  }

  std::string in_words() const {
    if (uses.size() < 2) return reason;
    std::string text;
    for (const auto& [sweep, use] : uses)
      text += (text.empty() ? "'" : ", '") + use.first + "'" +
              (use.objects > 1 ? " and " + std::to_string(use.objects - 1) + " more" : "") + " by '" + sweep_name(sweep) +
              "'";
    return text;
  }
};

/// The sweep of an object that is too small for sweeps to differ: that of the others if it needs no more substeps. But
/// tethers would hold back an object that is meant to stretch, or whose pins move apart.
Sweep sweep_of_coarse(const Scene& scene, const Object& object, Sweep common) {
  if (common == Sweep::tethered_chains && has_fixed(object) && !may_be_tethered(scene, object)) return Sweep::chains;
  return common == Sweep::multigrid || solves_chains(common) ? common : Sweep::tiled;
}

struct Choices {
  std::vector<Sweep> sweeps;  ///< sweep of each object
  SweepsInUse used;
};

Choices choices_of(const Scene& scene, const Settings& settings) {
  Choices out;
  std::vector<std::size_t> coarse;
  OpenSets sets(scene, settings);
  for (const Object& object : scene.objects) {
    const Choice choice = choice_of(scene, settings, object, sets);
    if (choice.reason != too_coarse)
      out.used.add(object, choice);
    else
      coarse.push_back(out.sweeps.size());
    out.sweeps.push_back(choice.sweep);
  }
  const Sweep common = out.used.common(Sweep::tiled);
  for (const std::size_t o : coarse) {
    out.sweeps[o] = sweep_of_coarse(scene, scene.objects[o], common);
    if (common == Sweep::tethered_chains && out.sweeps[o] != common)
      out.used.add(scene.objects[o], {out.sweeps[o], too_coarse});
  }
  return out;
}

}  // namespace

bool is_coarse(std::size_t particles) { return particles < fewest_particles; }

bool has_stiff_sheet(const Scene& scene) {
  const double gravity = gravity_of(scene);
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return springs_of(object) > 0 && is_stiff_sheet(object, gravity); });
}

Sweep chosen_sweep(const Scene& scene, int object, std::string* reason) {
  return chosen_sweep(scene, scene.settings, object, reason);
}

Sweep chosen_sweep(const Scene& scene, const Settings& settings, int object, std::string* reason) {
  OpenSets sets(scene, settings);
  const Choice choice = choice_of(scene, settings, scene.objects[static_cast<std::size_t>(object)], sets);
  if (reason != nullptr) *reason = choice.reason;
  if (choice.reason != too_coarse) return choice.sweep;
  return choices_of(scene, settings).sweeps[static_cast<std::size_t>(object)];
}

std::vector<Sweep> chosen_sweeps(const Scene& scene, const Settings& settings) {
  return choices_of(scene, settings).sweeps;
}

namespace {

/// The substeps of each object's set, if the settings name none. With a tolerance or recorded residuals, all objects
/// have the largest. 0 where they follow the State.
std::vector<int> substeps_of_objects(const Scene& scene, const Settings& settings, const std::vector<Sweep>& sweeps) {
  std::vector<SetMember> members;
  const double gravity = gravity_of(scene);
  const bool is_blown = blows(scene.wind, scene.forces);
  for (std::size_t o = 0; o < sweeps.size(); ++o)
    members.push_back(member_of(scene.objects[o],
                                own_substeps(scene.objects[o], sweeps[o], is_blown, static_cast<double>(scene.frame_time)),
                                substep_rule(scene.objects[o], sweeps[o], gravity)));
  for (const MeshCollider& collider : scene.mesh_colliders) members.push_back(member_of(collider));
  std::vector<SetSubsteps> sets = substeps_of_sets(members);
  sets.resize(scene.objects.size());
  const bool is_one_set = settings.tolerance > 0 || settings.record_residuals;
  int most = 0;
  for (const SetSubsteps& set : sets) most = std::max(most, set.substeps);
  std::vector<int> substeps;
  substeps.reserve(sets.size());
  for (const SetSubsteps& set : sets) substeps.push_back(is_one_set ? most : set.by_state ? 0 : set.substeps);
  return substeps;
}

}  // namespace

std::vector<int> chosen_substeps(const Scene& scene) {
  if (scene.settings.substeps != 0) return std::vector<int>(scene.objects.size(), scene.settings.substeps);
  return substeps_of_objects(scene, scene.settings, chosen_sweeps(scene, scene.settings));
}

Settings chosen_settings(const Scene& scene, std::string* reason) { return chosen_settings(scene, scene.settings, reason); }

Settings chosen_settings(const Scene& scene, Settings settings, std::string* reason) {
  const Choices choices = choices_of(scene, settings);
  const SweepsInUse& used = choices.used;
  const bool is_open = settings.sweep == Sweep::automatic;
  const Sweep common = used.common(is_open ? Sweep::tiled : settings.sweep);
  if (is_open) settings.sweep = common;
  if (is_open && reason != nullptr) *reason = used.in_words();
  if (settings.substeps != 0) return settings;
  const std::vector<int> substeps = substeps_of_objects(scene, settings, choices.sweeps);
  if (substeps.empty())
    settings.substeps = common == Sweep::multigrid ? substeps_of_multigrid : substeps_of_others;
  else if (std::all_of(substeps.begin(), substeps.end(), [&](int other) { return other == substeps.front(); }))
    settings.substeps = substeps.front();
  return settings;
}

}  // namespace pliant
