// Solves objects that contacts connect as one system: conjugate gradients over their levels and the contacts between
// them.
#include <algorithm>
#include <array>

#include "solver/sweeps/multigrid_solve.h"

namespace pliant {

namespace {

double apply(Substep& s, const MultigridGroup& group) {
  double curvature = 0;
  for (const int o : group.objects) curvature += MultigridSolve(s, o).apply();
  for (const PairSpring* spring : group.springs) curvature += couple_pair(*spring, multigrid_of(s).objects);
  return curvature;
}

/// The same for directions that displace each piece as a whole.
void apply_to_shifts(Substep& s, const MultigridGroup& group) {
  for (const int o : group.objects) MultigridSolve(s, o).apply_to_shifts();
  for (const PairSpring* spring : group.springs) couple_pair(*spring, multigrid_of(s).objects);
}

void advance(Substep& s, const MultigridGroup& group, float alpha) {
  for (const int o : group.objects) MultigridSolve(s, o).advance(alpha);
}

/// Makes one conjugate gradient step. Returns false if the solve has converged.
bool step(Substep& s, const MultigridGroup& group, double& before) {
  double now = 0;
  for (const int o : group.objects) now += MultigridSolve(s, o).precondition();
  const float beta = before > 0 ? static_cast<float>(now / before) : 0.f;
  before = now;
  for (const int o : group.objects) MultigridSolve(s, o).turn(beta);
  const double curvature = apply(s, group);
  if (!(curvature > 0) || !(now > 0)) return false;
  advance(s, group, static_cast<float>(now / curvature));
  return true;
}

/// Subtracts a contact between objects of the group from the group's stiffness: it does not resist a common
/// displacement.
void release(const PairSpring& s, MultigridObject::Piece& sum) {
  const std::array<float, 6> block = block_of(s);
  float side[2] = {0, 0};  // weights of the group's particles on each side; matrix rows contain both
  for (int i = 0; i < 4; ++i)
    if (s.object[i] >= 0) side[s.weight[i] > 0 ? 0 : 1] += abs(s.weight[i]);
  const float free = side[0] + side[1] - (side[0] - side[1]) * (side[0] - side[1]);
  for (int c = 0; c < 6; ++c) sum.held[c] -= static_cast<double>(free * block[c]);
}

/// Moves all objects of a group by one common displacement; so far each piece moved as if the other pieces were fixed.
void shift_together(Substep& s, const MultigridGroup& group) {
  MultigridObject::Piece sum{};
  for (const int o : group.objects) MultigridSolve(s, o).add_pieces(sum);
  for (const PairSpring* spring : group.springs) release(*spring, sum);
  const Record shift = shift_of(sum);
  for (const int o : group.objects) MultigridSolve(s, o).turn_to({shift.x, shift.y, shift.z});
  apply_to_shifts(s, group);
  advance(s, group, 1);
}

/// Returns the root of `o` in the union-find structure, with path halving.
int find(std::vector<int>& root, int o) {
  while (root[o] != o) o = root[o] = root[root[o]];
  return o;
}

int first_of(const PairSpring& s) { return *std::max_element(s.object.begin(), s.object.end()); }

}  // namespace

void make_multigrid_groups(Substep& s) {
  MultigridGroups& groups = multigrid_of(s).groups;
  const int objects = static_cast<int>(s.model.objects.size());
  const std::vector<PairSpring>& springs = multigrid_of(s).springs;
  groups.root.resize(static_cast<std::size_t>(objects));
  for (int o = 0; o < objects; ++o) groups.root[o] = o;
  for (const PairSpring& spring : springs) {
    for (const int o : spring.object) {
      if (o < 0) continue;
      const int a = find(groups.root, o), b = find(groups.root, first_of(spring));
      groups.root[std::max(a, b)] = std::min(a, b);
    }
  }
  groups.of_root.assign(static_cast<std::size_t>(objects), -1);
  groups.count = 0;
  for (int o = 0; o < objects; ++o) {
    if (s.model.objects[o].multigrid.levels.empty() || !takes_part(s, o)) continue;
    int& number = groups.of_root[find(groups.root, o)];
    if (number < 0) {
      number = groups.count++;
      if (static_cast<std::size_t>(groups.count) > groups.all.size()) groups.all.emplace_back();
      groups.all[number].objects.clear();
      groups.all[number].springs.clear();
    }
    groups.all[number].objects.push_back(o);
  }
  for (const PairSpring& spring : springs)
    groups.all[groups.of_root[find(groups.root, first_of(spring))]].springs.push_back(&spring);
}

void solve_multigrid_group(Substep& s, const MultigridGroup& group, int cycles) {
  for (const int o : group.objects) {
    MultigridSolve solve(s, o);
    solve.clear_change();
    solve.clear_direction();
  }
  double before = 0;
  for (int i = 0; i < cycles && step(s, group, before); ++i) {
  }
  for (const int o : group.objects) MultigridSolve(s, o).turn_to_shifts(group.springs);
  apply_to_shifts(s, group);
  advance(s, group, 1);
  if (group.objects.size() > 1) shift_together(s, group);
}

// The substep ends as if an outside force -r acted; its
// work is -r . d, d being the displacement since the substep's start. One minimisation along d makes r . d zero, and
// the energy then does not rise, however few the cycles. It only shortens: lengthened motion did not come to rest. Of d
// it takes the part that is not common to a piece, or what falls would be held up.
void shorten_fed_motion(Substep& s, const MultigridGroup& group) {
  double along = 0;
  for (const int o : group.objects) {
    MultigridSolve solve(s, o);
    solve.turn_to_motion(arguments(s, o, false).displacements);
    along += solve.residual_along();
  }
  if (!(along < 0)) return;
  const double curvature = apply(s, group);
  if (curvature > 0) advance(s, group, static_cast<float>(std::max(along / curvature, -1.0)));
}

}  // namespace pliant
