#include "solver/sheets/sheet_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/at.h"
#include "math/record.h"
#include "solver/damper.h"
#include "solver/sheets/sheet_contacts.h"
#include "solver/sheets/sheet_cycle.h"
#include "solver/substep.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// The cycles for a step that bends over so many edges, (l / e)^4. With fewer an irregular sheet keeps errors that
/// stretching feeds on, until it bursts; measured with 10 to 40 substeps and up to 96 edges in a cantilever.
int cycles_for(float edges4) {
  constexpr float limits[] = {2, 3.5f, 5, 8, 16};
  int cycles = 1;
  for (const float limit : limits) cycles += edges4 > limit * limit * limit * limit ? 1 : 0;
  return cycles;
}
/// The same without coarse levels, of Gauss-Seidel: a sweep reaches about an edge.
int sweeps_for(float edges4) {
  constexpr float most = 60;
  return 4 + static_cast<int>(std::min(most, std::sqrt(sheets::largest_of_grid * edges4) / 2));
}

/// One bending is for as many substeps as keep (l / e)^4 below this, so that it bends over few edges, and for so many
/// at most: sheets that hang have many substeps for their stretch. For 9 to 40 substeps sheets of two to four edges
/// crumpled. Where something may be touched, each substep has a bending: fine cotton slid off a ball else.
constexpr float most_edges4 = 4;
constexpr int most_together = 4;

/// What K is multiplied by in P [s^2].
float h2_of(const SheetBending& sheet, float seconds) {
  return seconds * seconds * (1 + viscous_share(sheet.damping_time / seconds));
}

/// The substeps that one bending is for, and the number of the present one among them.
struct Together {
  int substeps = 1, number = 0;
};

Together substeps_of_bending(const Substep& s, const SheetBending& sheet) {
  const bool may_touch = s.has_pairs() || s.bodies != nullptr || !s.own->colliders.empty();
  const int all = s.follows_state() ? s.planned / quarters : s.planned, number = s.number % all;
  const int most = may_touch ? 1 : std::min(all, most_together);
  const auto most_within = [&](float rate, float limit) {
    int n = 0;
    while (n < most && h2_of(sheet, static_cast<float>(n + 1) * s.h) * rate <= limit) ++n;
    return n;
  };
  int period = most_within(sheets::largest_of_grid * sheet.stiffness, 1);  // one term costs a quarter of a cycle
  if (period == 0) period = std::max(1, most_within(sheet.stiffness, most_edges4));
  const int begun = number - number % period;
  return {std::min(period, all - begun), number - begun};
}

bool is_sheet(const Substep& s, int object) { return s.model.objects[at(object)].sheet.is_used(); }

/// Masses of all levels from the State, and the matrix for this length of substep.
void begin_sheet(Substep& s, int object, float seconds, SheetScratch& scratch) {
  const CompiledObject& of = s.model.objects[at(object)];
  const SheetBending& sheet = of.sheet;
  const float h2 = h2_of(sheet, seconds);
  if (s.made > 0 && scratch.h2 == h2) return;
  scratch.h2 = h2;
  const Record* positions = s.state.positions.data() + s.model.first[at(object)];
  if (sheets::terms_for(sheet, h2) > 0) return sheets::set_diagonals(sheet, positions, scratch);
  sheets::set_masses(sheet, positions, scratch);
  sheets::factorise(sheet, scratch);
}

/// Adds a row's correction to the sums of its piece.
void add_row(const Vec3d& p, const Vec3d& c, double mass, RigidSums& sums) {
  sums.mass += mass;
  sums.first += p * mass;
  sums.squares += Vec3d{p.x * p.x, p.y * p.y, p.z * p.z} * mass;
  sums.products += Vec3d{p.y * p.z, p.z * p.x, p.x * p.y} * mass;
  sums.corrections.linear += c * mass;
  sums.corrections.angular += cross(p, c) * mass;
}

/// Finds which pieces have pinned particles. True if all have.
bool find_pinned(const SheetBending& sheet, SheetScratch& scratch) {
  const std::vector<float>& mass = scratch.levels.front().mass;
  scratch.is_pinned.assign(at(sheet.pieces), 0);
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] == 0 && sheet.piece[i] >= 0) scratch.is_pinned[at(sheet.piece[i])] = 1;
  return std::all_of(scratch.is_pinned.begin(), scratch.is_pinned.end(), [](char pinned) { return pinned != 0; });
}

/// Calls body(i) for each row of a piece without pins.
template <class Body>
void for_loose_rows(const SheetBending& sheet, const SheetScratch& scratch, const Body& body) {
  for (std::size_t i = 0; i < sheet.piece.size(); ++i)
    if (sheet.piece[i] >= 0 && scratch.is_pinned[at(sheet.piece[i])] == 0) body(i);
}

/// Gravity passes P by where nothing is pinned: through P a piece would fall by P^-1 M g, with ripples.
void leave_out_gravity(const SheetBending& sheet, const Vec3f& gravity, SheetScratch& scratch) {
  SheetLevelScratch& finest = scratch.levels.front();
  const bool is_polynomial = sheets::terms_for(sheet, scratch.h2) > 0;
  for_loose_rows(sheet, scratch, [&](std::size_t i) {
    Record& r = is_polynomial ? scratch.corrections[i] : finest.right[i];
    const Vec3f by = gravity * (finest.mass[i] * (is_polynomial ? finest.inverse[i] : 1));
    r = {r.x - by.x, r.y - by.y, r.z - by.z, r.w};
  });
}

/// Takes the rigid motion from the corrections of loose pieces, which no force of bending has caused, but that of
/// `own(row)`, and adds `more` to them.
template <class Own>
void move_loose_pieces(const SheetBending& sheet, const Record* positions, const Own& own, const Vec3f& more,
                       SheetScratch& scratch) {
  const std::vector<float>& mass = scratch.levels.front().mass;
  const auto place = [&](std::size_t i) {
    const Record &x = positions[i], &o = positions[0];
    return Vec3d{static_cast<double>(x.x - o.x), static_cast<double>(x.y - o.y), static_cast<double>(x.z - o.z)};
  };
  scratch.momentum.assign(at(sheet.pieces), {});
  for_loose_rows(sheet, scratch, [&](std::size_t i) {
    const Record& c = scratch.corrections[i];
    const Vec3f of = own(i);
    const Vec3d correction{static_cast<double>(c.x - of.x), static_cast<double>(c.y - of.y),
                           static_cast<double>(c.z - of.z)};
    add_row(place(i), correction, static_cast<double>(mass[i]), scratch.momentum[at(sheet.piece[i])]);
  });
  std::vector<RigidStep> steps;
  steps.reserve(scratch.momentum.size());
  for (const RigidSums& sums : scratch.momentum) steps.push_back(sums.mass > 0 ? rigid_step(sums) : RigidStep{});
  for_loose_rows(sheet, scratch, [&](std::size_t i) {
    const RigidStep& step = steps[at(sheet.piece[i])];
    const Vec3f by = more - convert<float>(step.translation + cross(step.rotation, place(i)));
    Record& c = scratch.corrections[i];
    c = {c.x + by.x, c.y + by.y, c.z + by.z, 0};
  });
}

/// d += corrections / n^2 - h^2 g, where bending is for n substeps: in each of them velocities change by the same.
void apply(Substep& s, int object, const sheets::SheetForces& forces, sheets::BlockLoop loop,
           const SheetScratch& scratch) {
  const SheetBending& sheet = s.model.objects[at(object)].sheet;
  const Vec3f g = forces.gravity;
  const float share = 1 / (forces.substeps * forces.substeps);
  Record* displacements = s.work.displacements.data() + s.model.first[at(object)];
  const SheetLevel& level = sheet.levels.front();
  const std::vector<float>& mass = scratch.levels.front().mass;
  loop(level.blocks(), [&](int block) {
    for (int i = block * sheet_block; i < std::min(level.rows, (block + 1) * sheet_block); ++i) {
      if (mass[at(i)] == 0 || sheet.piece[at(i)] < 0) continue;
      const Record& c = scratch.corrections[at(i)];
      Record& d = displacements[i];
      d = {d.x + (c.x * share - g.x), d.y + (c.y * share - g.y), d.z + (c.z * share - g.z), 0};
    }
  });
}

/// The sum of the normals of a piece's contacts, as a unit vector: gravity along it is what contacts bear. Zero where
/// nothing touches.
std::vector<Vec3f> directions_of_contacts(const SheetBending& sheet,
                                          const std::vector<sheets::SheetContact>& contacts) {
  std::vector<Vec3f> along(at(sheet.pieces));
  for (const sheets::SheetContact& c : contacts)
    if (const int piece = sheet.piece[at(c.row[0])]; piece >= 0)
      along[at(piece)] += c.normal * (c.weight[0] > 0 ? 1.f : -1.f);
  for (Vec3f& one : along) one = one * (1 / std::max(length(one), 1e-30f));
  return along;
}

/// Adds to each loose row `by(row)`.
template <class By>
void add_to_loose_rows(const SheetBending& sheet, const SheetScratch& scratch, const By& by, Records& to) {
  for_loose_rows(sheet, scratch, [&](std::size_t i) {
    const Vec3f more = by(i);
    to[i] = {to[i].x + more.x, to[i].y + more.y, to[i].z + more.z, to[i].w};
  });
}

/// The bending of a sheet that touches something. Gravity along the contacts is part of the right-hand side of loose
/// pieces, that across them passes P by.
void bend_on_contacts(const SheetBending& sheet, const sheets::SheetForces& forces, sheets::BlockLoop loop, int cycles,
                      std::vector<sheets::SheetContact>& contacts, SheetScratch& scratch) {
  using sheets::SheetContact;
  SheetLevelScratch& finest = scratch.levels.front();
  const bool any_moves = !find_pinned(sheet, scratch);
  const std::vector<Vec3f> along = directions_of_contacts(sheet, contacts);
  const auto borne = [&](std::size_t i) {
    const Vec3f& n = along[at(sheet.piece[i])];
    return n * dot(n, forces.gravity);
  };
  add_to_loose_rows(
      sheet, scratch, [&](std::size_t i) { return (borne(i) - forces.gravity) * finest.mass[i]; }, finest.right);
  const Records right = finest.right;
  Records own(right.size()), x;  // what each row would move by its own mass
  const auto by_own_mass = [&](float SheetContact::*of, float by) {
    own.assign(right.size(), {});
    sheets::add_contact_forces(contacts, of, by, own);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const float w = finest.mass[i] > 0 ? 1 / finest.mass[i] : 0;
      own[i] = {own[i].x * w, own[i].y * w, own[i].z * w, 0};
    }
  };
  const auto respond = [&](const Records* from, float SheetContact::*of, Records& to) {
    if (from != nullptr)
      finest.right = *from;
    else
      finest.right.assign(right.size(), {});
    sheets::add_contact_forces(contacts, of, 1, finest.right);
    sheets::solve_sheet(sheet, cycles, loop, scratch);
    if (any_moves) {
      by_own_mass(of, 1);
      if (from != nullptr) add_to_loose_rows(sheet, scratch, borne, own);
      move_loose_pieces(
          sheet, forces.positions, [&](std::size_t i) { return xyz(own[i]); }, {}, scratch);
    }
    to = scratch.corrections;
  };
  sheets::solve_contacts(finest.mass, right, length(forces.gravity), respond, contacts, x);
  sheets::hand_over_forces(contacts);
  by_own_mass(&SheetContact::force, -1);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = {x[i].x + own[i].x, x[i].y + own[i].y, x[i].z + own[i].z, 0};
  add_to_loose_rows(
      sheet, scratch, [&](std::size_t i) { return forces.gravity - borne(i); }, x);
  scratch.corrections.swap(x);
}

/// Finds the corrections for the substeps from this one on.
void find_corrections(Substep& s, int object, const sheets::SheetForces& forces, sheets::BlockLoop loop,
                      SheetScratch& scratch) {
  const SheetBending& sheet = s.model.objects[at(object)].sheet;
  begin_sheet(s, object, forces.substeps * s.h, scratch);
  sheets::find_right_hand_side(sheet, forces, loop, scratch);
  const Vec3f load = forces.gravity * (forces.substeps * forces.substeps);
  const int terms = sheets::terms_for(sheet, scratch.h2);
  const float edges4 = scratch.h2 * sheet.stiffness;
  const bool has_levels = sheet.levels.size() > 1 || sheet.levels.front().rows <= coarsest_sheet_rows;
  const int cycles = has_levels ? cycles_for(edges4) : sweeps_for(edges4);
  if (terms == 0 && forces.substeps == 1) {
    std::vector<sheets::SheetContact> contacts = sheets::contacts_of_sheet(s, object, forces.gravity);
    if (!contacts.empty()) return bend_on_contacts(sheet, forces, loop, cycles, contacts, scratch);
  }
  // K resists no motion of a piece as a whole, but it acts on positions ahead of these with damping and several
  // substeps.
  const bool is_rigid_free = sheet.damping_time == 0 && forces.substeps == 1;
  const bool any_moves =
      !(terms > 0 && is_rigid_free && sheets::keeps_momentum(scratch)) && !find_pinned(sheet, scratch);
  if (any_moves) leave_out_gravity(sheet, load, scratch);
  if (terms > 1) sheets::add_term(sheet, loop, scratch);
  if (terms == 0) sheets::solve_sheet(sheet, cycles, loop, scratch);
  if (any_moves)
    move_loose_pieces(
        sheet, forces.positions, [](std::size_t) { return Vec3f{}; }, load, scratch);
}

void bend(Substep& s, int object) {
  SheetScratch& scratch = s.work.sheets[at(object)];
  const Together together = substeps_of_bending(s, s.model.objects[at(object)].sheet);
  const int first = s.model.first[at(object)];
  const Vec3f gravity = gravity_for(s, static_cast<double>(s.h)) * s.h;
  const sheets::SheetForces forces{s.state.positions.data() + first, s.work.displacements.data() + first, gravity, s.h,
                                   static_cast<float>(together.substeps)};
  const auto loop = [&](int blocks, FunctionRef<void(int)> body) { for_tasks(s, "bend sheets", blocks, body); };
  if (together.number == 0) find_corrections(s, object, forces, loop, scratch);
  apply(s, object, forces, loop, scratch);
}

}  // namespace

bool has_sheets(const Substep& s) {
  bool any = false;
  for_objects(s, [&](int object) { any = any || is_sheet(s, object); });
  return any;
}

void bend_sheets(Substep& s) {
  for_objects(s, [&](int object) {
    if (is_sheet(s, object)) bend(s, object);
  });
}

}  // namespace pliant
