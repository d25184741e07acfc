// The multigrid correction: one Newton step on the stretching energy of all springs of an object, solved by conjugate
// gradients with a multigrid cycle as preconditioner, before the plain sweeps.
//
// A sweep propagates a force by one edge, so finer meshes stretch more. Coarse levels, whose rows are groups of
// particles, correct large-scale errors, so that stretch hardly depends on resolution. The energy is |x - x~|^2_M / 2
// h^2 + sum K C^2 / 2 + contacts, x~ the prediction. Its Hessian includes the geometric stiffness of taut springs
// (model/multigrid.h, multigrid_lanes.cpp).
#pragma once

#include <array>

#include "model/model.h"
#include "model/multigrid.h"
#include "pliant/scene.h"
#include "solver/sweeps/multigrid_kernels.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The data of one object in the multigrid correction.
struct MultigridObject {
  std::vector<MultigridValues> levels;
  Records direction, change;    ///< conjugate gradients: search direction p and solution x
  AlignedVector<float> extra;   ///< matrix terms of contacts: nine rows of sixteen per batch; empty before the first
  std::vector<char> has_extra;  ///< for each batch, 1 if one of its rows has contacts
  std::vector<double> sums;     ///< partial sums of reductions, one for each task
  /// A connected component: its stiffness against pins and contacts (xx yy zz xy xz yz) [N/m], its residual force [N],
  /// its mass [kg], the sum of mass times displacement [kg m], and a displacement of the whole [m].
  struct Piece {
    double held[6], force[3];
    double mass = 0;
    Vec3d moment{};
    Record shift{};
  };
  std::vector<Piece> pieces;
  /// The product A p of conjugate gradients; it uses scratch memory of the preconditioner.
  Records& image() { return levels[0].y; }
  bool is_made = true;  ///< false if the correction was rejected: it then changes no multipliers and contacts
};

/// A contact as two springs between its sides: one along the normal, and a tangential one limited by Coulomb friction.
struct ContactSpring {
  float depth = 0;              ///< distance of the sides less the thickness [m]; negative: they overlap
  float along = 0, across = 0;  ///< normal and tangential stiffness [N/m]
  Vec3f slip{};                 ///< tangential displacement since the substep's start [m]
};

/// A contact between surfaces (constraints/contact.h) as springs between the closest points of its two sides.
struct PairSpring : ContactSpring {
  std::array<std::int32_t, 4> object{};  ///< object of each particle; -1: not moved by this correction
  std::array<std::int32_t, 4> particle{};
  std::array<float, 4> weight{};
  Vec3f normal{};
};

/// The 3 x 3 stiffness matrix of a spring, as xx yy zz xy xz yz [N/m].
std::array<float, 6> block_of(const PairSpring& spring);

/// Objects that contacts connect, and these contacts.
struct MultigridGroup {
  std::vector<int> objects;
  std::vector<const PairSpring*> springs;
};

/// The multigrid groups of a substep; kept between substeps to avoid allocations.
struct MultigridGroups {
  std::vector<MultigridGroup> all;  ///< the first `count` are in use
  int count = 0;
  std::vector<int> root, of_root;  ///< union-find over objects: parent of each; group of each root
};

struct MultigridScratch : SweepScratch {
  std::vector<MultigridObject> objects;  ///< for each object; those of other sweep groups have no levels
  std::vector<PairSpring> springs;       ///< contacts between surfaces
  MultigridGroups groups;

  void prepare(const SweepSetup& setup, int object) override;
};

/// The scratch data of the current sweep group.
MultigridScratch& multigrid_of(const Substep& s);

/// Makes the multigrid correction of every object with levels. The first one of a substep starts from the prediction,
/// before any sweep; after it, the multipliers of compliant distances match it, and all others are zero. Later ones
/// continue with what remains of the first one's right-hand side, which sweeps do not change.
void correct_multigrid(Substep& s, bool first);

// Parts of correct_multigrid, defined in multigrid_contacts.cpp: add contacts as springs to the rows of their
// particles; then store the pushes and friction of the springs between particles and colliders, from which the
// projection of these contacts continues.
void add_multigrid_contacts(Substep& s);
void keep_multigrid_pushes(Substep& s);
/// Adds the off-diagonal terms of a surface contact's spring to A p: the matrix rows treat the other side as fixed, but
/// p moves both sides. Returns their contribution to p . A p.
double couple_pair(const PairSpring& spring, std::vector<MultigridObject>& objects);
// Defined in multigrid_group.cpp: groups all objects with levels, ordered by their first object; solves one group by
// conjugate gradients, after which its right-hand sides hold the residual; shortens motion that the residual feeds.
void make_multigrid_groups(Substep& s);
void solve_multigrid_group(Substep& s, const MultigridGroup& group, int cycles);
void shorten_fed_motion(Substep& s, const MultigridGroup& group);
/// Returns false if an object's correction must be rejected: it is not finite, or it moves a particle by more than an
/// edge without reducing the springs' energy.
bool is_multigrid_change_sound(Substep& s, int object);
// Defined in multigrid_multipliers.cpp: sets lambda of compliant distances after the correction; sets all to zero.
void keep_multigrid_multipliers(Substep& s, int object, bool first);
void clear_multigrid_multipliers(Substep& s);

}  // namespace pliant
