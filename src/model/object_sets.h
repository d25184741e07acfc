// Sets of objects that can meet. All objects of a set have the same substeps, which objects of other sets do not
// affect.
//
// Two objects are in one set if groups, masks and `collides` let their surfaces touch, directly or through other
// objects. In a World they must also be near (solver/near_sets.h). Mesh colliders as triangles join the sets that they
// touch, because their vertices move in the substeps of a set. Primitive colliders, distance grids and heightfields
// have a pose at any time, so they join no set.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Default substeps per frame of objects solved by `multigrid` that are disturbed (own_substeps), and of all others.
inline constexpr int substeps_of_multigrid = 10, substeps_of_others = 20;

/// Substeps of sets of rigid bodies alone: boxes of a wall of 30 rows sink by 1 cm, 3 with 16.
inline constexpr int substeps_of_bodies = 8;
/// The least substeps of sets of rigid bodies and what deforms: with them a ball that lands on cloth bounces less each
/// time.
inline constexpr int substeps_of_coupled = 40;

/// Pins or anchors within this share of an object's extent lie together: it swings about them.
inline constexpr double swinging_share = 0.25;

/// The largest number of substeps of any object; chosen_settings(scene) has 0 substeps if objects differ.
inline int most_substeps_of(const Settings& chosen) {
  return chosen.substeps > 0 ? chosen.substeps : substeps_of_others;
}

/// The substeps that an object needs by itself. An object with PBD stiffness between 0 and 1 gets substeps_of_others,
/// the largest default: its stiffness is converted for a fixed number of projections, which no set may change. With
/// `multigrid`, objects are disturbed that can touch, that are blown about by wind or force fields, whose pins move, or
/// that swing about pins which lie together; others need half as many.
/// An inflated object needs more the longer the frame is [s]. A sheet that is meant to stretch and hangs from few of
/// its many particles needs more too, if chains solve it.
int own_substeps(const Object& object, Sweep sweep, bool is_blown, double frame_time = 1.0 / 60);

/// The strain of an object's edges at its target volume if it grows alike in all directions: pressure^(1/3) - 1. 0 if
/// its pressure is 1 or less.
double strain_of_inflated(const Object& object);

/// Substeps of chains where there is a volume, which is corrected after the lengths and pushes them out again: an edge
/// in a hundred of a balloon is 5 % too long with 20, 0.6 % with 80.
inline constexpr int substeps_of_volumes = 80;

/// The overstretch (p99) that chains leave in an inflated object at rest, in substeps of the given duration [s].
/// Lengths and volume are projected in turn, and each turn leaves a share h^2 / (compliance mass) of the strain: 1.8
/// times that, measured over stiffnesses of 1 : 36 and pressures of 1.02 to 2. Infinite if edges are rigid.
double overstretch_of_inflated(const Object& object, double substep = 1.0 / 60 / substeps_of_volumes);

/// False for an inflated object whose edges resist its volume in substeps of the given duration [s]: both cannot be
/// met.
bool can_follow_volume(const Object& object, double substep = 1.0 / 60 / substeps_of_volumes);

/// The substeps of a liquid, with which its density is 0.35 % too high on average when it rests. The error is the depth
/// of what lies above a particle, times the square of the substep.
int substeps_of_fluid(const Object& object, double frame_time);
/// The substeps that the surface tension of a liquid needs: of 0.05 sqrt(density spacing^3 / tension), of a capillary
/// wave of the spacing.
int substeps_of_tension(const Object& object, double frame_time);

/// The share of its overlap that a contact of two grains removes in an iteration (solver/grains/grain_formulas.h).
inline constexpr float stiffness_of_grains = 0.2f;

/// What the substeps of grains follow from, at the start.
struct GrainHeights {
  float low = 0, high = 0;  ///< of their centres [m]
  float diameter = 0;       ///< 0: no grains [m]
  float frame_time = 0;     ///< [s]
};

/// Empty for what has no grains.
GrainHeights heights_of_grains(const Object& object, double frame_time);

/// The substeps of grains below which others lie up to a height [m], in all, so that those at the bottom overlap by 3 %
/// of their diameter at rest.
int substeps_of_grains(const GrainHeights& grains, double height);

/// True if wind or a force field acts on objects.
bool blows(const Wind& wind, const std::vector<ForceField>& forces);

/// How the number of substeps of an object's set may be decided.
enum class SubstepRule {
  any,       ///< at least own_substeps; the rule of others in the set
  by_state,  ///< by the State of each quarter of a frame (solver/substep_law.h), unless one of the set needs a fixed number
  /// The same in every frame, where rigid bodies or grains can meet what deforms: contact stores energy in proportion
  /// to 1 / h^2, so a smaller h in the middle of an impact would increase it.
  constant,
  fixed,  ///< own_substeps, because PBD stiffness is converted for that number
};

/// The mean strain of an object's distances under a load: its weight, which in a sheet the particles of one row share
/// [-]. Without triangles, the strain of its stiffest group of distances, as links are in a rope. Empty if it has no
/// distances with a compliance.
std::optional<double> strain_by_weight(const Object& object, double gravity);

/// True if an object's weight strains its distances so much that its stretch counts as intended.
bool is_meant_to_stretch(const Object& object, double gravity);

/// Objects solved by chains follow the State, unless they are meant to stretch: the law sees strain, not what force
/// explains. It does not matter how small they are, nor whether they can touch.
SubstepRule substep_rule(const Object& object, Sweep sweep, double gravity);

/// The data that determine the set of an object or mesh collider.
struct SetMember {
  std::uint32_t groups = 0, mask = 0;
  bool collides = false;     ///< true if it collides with other objects
  bool is_collider = false;  ///< a mesh collider, which touches all objects, but no other collider
  int substeps = 0;          ///< substeps that it needs by itself; 0: any number
  SubstepRule rule = SubstepRule::any;
  float spacing = 0, speed_of_sound = 0;  ///< of a liquid, which meets those that have the same; 0: it is none
  bool is_of_grains = false;              ///< grains meet by their masks
  GrainHeights grains{};                  ///< if it is to have its substeps
  bool is_of_gas = false;                 ///< gases and tracers meet by their masks
  int place = 0;                          ///< those of different places do not meet
};

SetMember member_of(const Object& object, int substeps, SubstepRule rule, double frame_time = 0);
SetMember member_of(const MeshCollider& collider);

/// True if groups, masks and kinds let two members meet, whatever their distance.
bool can_meet(const SetMember& a, const SetMember& b);

/// For each member, the first member of its set, whatever their distances. solver/near_sets.h divides these sets by
/// distance.
std::vector<int> find_sets(const std::vector<SetMember>& members);

/// The substeps of a set: the largest number that a member needs.
struct SetSubsteps {
  int set = 0;  ///< its first member
  int substeps = 0;
  bool by_state = false;  ///< true: decided by the State instead
  int least = 0;          ///< the largest number that a member needs that does not follow the State

  friend bool operator==(const SetSubsteps&, const SetSubsteps&) = default;
};

/// For each member, the substeps of its set. `sets` has the first member of each one's set; without it they are those
/// of find_sets().
std::vector<SetSubsteps> substeps_of_sets(const std::vector<SetMember>& members);
std::vector<SetSubsteps> substeps_of_sets(const std::vector<SetMember>& members, const std::vector<int>& sets);

}  // namespace pliant
