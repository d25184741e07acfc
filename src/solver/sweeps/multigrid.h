// The multigrid correction: one Newton step on the stretching energy of all springs of an object at once, solved by conjugate
// gradients with a multigrid cycle as preconditioner, before plain sweeps over everything.
//
// A sweep carries a pull one edge at a time, so the finer a mesh the more it stretches. Here what is wrong on a large scale is
// put right on coarse levels, whose rows are groups of particles: stretch then hardly depends on the resolution. The energy
// is |x - x~|^2_M / 2 h^2 + sum K C^2 / 2 + contacts; its Hessian keeps the geometric stiffness of taut springs (model/
// multigrid.h, multigrid_lanes.cpp).
#pragma once

#include <array>

#include "model/model.h"
#include "model/multigrid.h"
#include "pliant/scene.h"
#include "solver/sweeps/multigrid_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// Of one object.
struct MultigridObject {
  std::vector<MultigridValues> levels;
  Records direction, change;    ///< of conjugate gradients: p, x
  AlignedVector<float> extra;   ///< of contacts: nine rows of sixteen a batch; empty before the first contact
  std::vector<char> has_extra;  ///< by batch
  std::vector<double> sums;     ///< by task
  /// Of a piece: what holds it to the world (xx yy zz xy xz yz), and what force it is still owed.
  struct Piece {
    double held[6], force[3];
  };
  std::vector<Piece> pieces;
  /// A p, in what is scratch while preconditioning alone.
  Records& image() { return levels[0].y; }
  bool is_made = true;  ///< whether the change was: what was not has done nothing, and leaves no multipliers and no pushes
};

/// A contact as two springs between its sides: along the normal, and across it no stiffer than Coulomb allows.
struct ContactSpring {
  float depth = 0;              ///< negative where the sides overlap [m]
  float along = 0, across = 0;  ///< [N/m]
  Vec3f slip{};                 ///< of one side over the other since the substep's start [m]
};

/// A contact among surfaces (constraints/contact.h) as springs between the closest points of its two sides.
struct PairSpring : ContactSpring {
  std::int32_t contact = 0;              ///< its number
  std::array<std::int32_t, 4> object{};  ///< of each particle; -1: one that this correction does not move
  std::array<std::int32_t, 4> particle{};
  std::array<float, 4> weight{};
  Vec3f normal{};
};

/// Its stiffness along and across, xx yy zz xy xz yz [N/m].
std::array<float, 6> block_of(const PairSpring& spring);

/// Objects that contacts join, by number, and these contacts.
struct MultigridGroup {
  std::vector<int> objects;
  std::vector<const PairSpring*> springs;
};

/// Of one substep; kept, so that none allocates.
struct MultigridGroups {
  std::vector<MultigridGroup> all;  ///< the first `count` are in use
  int count = 0;
  std::vector<int> root, of_root;  ///< of each object: another that it is joined to; of such a root: its group
};

struct MultigridScratch : SweepScratch {
  std::vector<MultigridObject> objects;  ///< by object; without levels where it is not of the group
  std::vector<PairSpring> springs;       ///< of contacts among surfaces
  MultigridGroups groups;

  void prepare(const SweepSetup& setup, int object) override;
};

/// That of the group under way.
MultigridScratch& multigrid_of(const Substep& s);

/// The correction alone, of every object that has levels. The first of a substep is made from the prediction, before any sweep;
/// after it the multipliers of compliant distances are those of where it leaves them, all others zero. Later ones go on from
/// what the equations of the first still lacked: sweeps meet constraints and leave that as it is.
void correct_multigrid(Substep& s, bool first);

// Of correct_multigrid, in multigrid_contacts.cpp: contacts as springs on their particles' rows, and afterwards the pushes and
// the friction that these have exerted, for the contacts' own projection to go on from.
void add_multigrid_contacts(Substep& s);
void keep_multigrid_pushes(Substep& s);
/// What the spring of a contact among surfaces adds to `image`, beside the rows of its particles that have the other side held, where
/// `direction` moves both. Returns what it adds to direction . image.
double couple_pair(const PairSpring& spring, std::vector<MultigridObject>& objects);
// In multigrid_group.cpp: the groups of all objects with levels, in the order of each group's first; and conjugate gradients for
// one, after which its right-hand sides are what is left of them.
void make_multigrid_groups(Substep& s);
void solve_multigrid_group(Substep& s, const MultigridGroup& group, int cycles);
/// False where the change of an object is not to be made: it is not finite, or moves something by more than an edge and makes
/// the springs' energy no less.
bool is_multigrid_change_sound(Substep& s, int object);
// In multigrid_multipliers.cpp: lambda of compliant distances after the change, and all at zero before it.
void keep_multigrid_multipliers(Substep& s, int object, bool first);
void clear_multigrid_multipliers(Substep& s);

}  // namespace pliant
