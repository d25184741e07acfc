// The multigrid correction: one Newton step on the stretching energy of all springs of an object, solved by conjugate
// gradients with a multigrid cycle as preconditioner, before the plain sweeps.
//
// A sweep carries a force one edge at a time, so finer meshes stretch more. Coarse levels, whose
// rows are groups of particles, correct large-scale errors, so that stretch hardly depends on
// resolution. The energy is |x - x~|^2_M / 2 h^2 + sum K C^2 / 2 + contacts. Its Hessian keeps
// the geometric stiffness of taut springs (model/multigrid.h, multigrid_lanes.cpp).
#pragma once

#include <array>

#include "model/model.h"
#include "model/multigrid.h"
#include "pliant/scene.h"
#include "solver/sweeps/multigrid_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The data of one object.
struct MultigridObject {
  std::vector<MultigridValues> levels;
  Records direction, change;    ///< vectors of conjugate gradients: p, x
  AlignedVector<float> extra;   ///< of contacts: nine rows of sixteen per batch; empty before the first contact
  std::vector<char> has_extra;  ///< by batch: true if its rows have contacts
  std::vector<double> sums;     ///< partial sums of reductions, by task
  /// Per connected piece: its stiffness against the world (xx yy zz xy xz yz), and the remaining force on it.
  struct Piece {
    double held[6], force[3];
  };
  std::vector<Piece> pieces;
  /// The product A p of conjugate gradients, in scratch memory of the preconditioner.
  Records& image() { return levels[0].y; }
  bool is_made = true;  ///< false if the correction was rejected: it then leaves no multipliers and no pushes
};

/// A contact as two springs between its sides: along the normal, and tangential with at most Coulomb's stiffness.
struct ContactSpring {
  float depth = 0;              ///< negative if the sides overlap [m]
  float along = 0, across = 0;  ///< [N/m]
  Vec3f slip{};                 ///< tangential displacement since the substep's start [m]
};

/// A contact between surfaces (constraints/contact.h) as springs between the closest points of its two sides.
struct PairSpring : ContactSpring {
  std::int32_t contact = 0;              ///< index of the contact
  std::array<std::int32_t, 4> object{};  ///< of each particle; -1: not moved by this correction
  std::array<std::int32_t, 4> particle{};
  std::array<float, 4> weight{};
  Vec3f normal{};
};

/// The stiffness of a spring, normal and tangential, as xx yy zz xy xz yz [N/m].
std::array<float, 6> block_of(const PairSpring& spring);

/// Objects connected by contacts, and these contacts.
struct MultigridGroup {
  std::vector<int> objects;
  std::vector<const PairSpring*> springs;
};

/// The groups of one substep; kept to avoid allocations.
struct MultigridGroups {
  std::vector<MultigridGroup> all;  ///< the first `count` are in use
  int count = 0;
  std::vector<int> root, of_root;  ///< union-find over objects: parent of each; of a root: its group
};

struct MultigridScratch : SweepScratch {
  std::vector<MultigridObject> objects;  ///< by object; without levels for objects of other groups
  std::vector<PairSpring> springs;       ///< of contacts between surfaces
  MultigridGroups groups;

  void prepare(const SweepSetup& setup, int object) override;
};

/// The data of the current group.
MultigridScratch& multigrid_of(const Substep& s);

/// The correction alone, for every object with levels. The first of a substep starts from the prediction, before any sweep.
/// After it, the multipliers of compliant distances match the correction, and all others are zero. Later ones continue with
/// the remaining right-hand side of the first, which sweeps do not change.
void correct_multigrid(Substep& s, bool first);

// Parts of correct_multigrid in multigrid_contacts.cpp: adds contacts as springs on their particles' rows, and afterwards
// stores the pushes and the friction that these exerted, from which the contacts' own projection continues.
void add_multigrid_contacts(Substep& s);
void keep_multigrid_pushes(Substep& s);
/// Adds the off-diagonal effect of a surface contact's spring to `image`: the rows hold the other side fixed, but
/// `direction` moves both. Returns its contribution to direction . image.
double couple_pair(const PairSpring& spring, std::vector<MultigridObject>& objects);
// In multigrid_group.cpp: groups all objects with levels, ordered by first object; and solves one group by conjugate
// gradients, after which its right-hand sides hold the residual.
void make_multigrid_groups(Substep& s);
void solve_multigrid_group(Substep& s, const MultigridGroup& group, int cycles);
/// False if an object's correction must be rejected: it is not finite, or
/// moves a particle by more than an edge without reducing the springs' energy.
bool is_multigrid_change_sound(Substep& s, int object);
// In multigrid_multipliers.cpp: lambda of compliant distances after the correction, and zeros before it.
void keep_multigrid_multipliers(Substep& s, int object, bool first);
void clear_multigrid_multipliers(Substep& s);

}  // namespace pliant
