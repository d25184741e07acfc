#include "solver/sheets/sheet_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/at.h"
#include "solver/sheets/sheet_cycle.h"
#include "solver/substep.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// The cycles for a step that bends over so many edges, (l / e)^4. With fewer an irregular sheet keeps errors that stretching feeds on,
/// until it bursts; measured with 10 to 40 substeps and up to 96 edges in a cantilever.
int cycles_for(float edges4) {
  constexpr float limits[] = {2, 3.5f, 5, 8, 16};
  int cycles = 1;
  for (const float limit : limits) cycles += edges4 > limit * limit * limit * limit ? 1 : 0;
  return cycles;
}
/// How much heavier a particle is in P that a collider holds up. More than a sheet's load on one particle, and little enough for floats.
constexpr float weight_on_colliders = 1e4f;

/// Where a group touches nothing, one bending is for as many substeps as it may bend over few edges for: (l / e)^4 is at most this.
/// Such sheets hang, and need most of their substeps for their stretch.
constexpr float most_edges4 = 4;

/// The substeps that one bending is for, from this one on; 0 if an earlier one was for this one, too.
int substeps_of_bending(const Substep& s, const SheetBending& sheet) {
  if (s.has_pairs() || s.bodies != nullptr || !s.own->colliders.empty()) return 1;
  const int together = s.follows_state() ? s.planned / quarters : s.planned, number = s.number % together;
  const float once = s.h * s.h * sheet.stiffness;
  int period = 1;
  while (period < together && static_cast<float>((period + 1) * (period + 1)) * once <= most_edges4) ++period;
  return number % period == 0 ? std::min(period, together - number) : 0;
}

bool is_sheet(const Substep& s, int object) { return s.model.objects[at(object)].sheet.is_used(); }

/// Masses of all levels from the State, and the matrix for this length of substep.
void begin_sheet(Substep& s, int object, float seconds, SheetScratch& scratch) {
  const CompiledObject& of = s.model.objects[at(object)];
  const SheetBending& sheet = of.sheet;
  const float h2 = seconds * (seconds + sheet.damping_time);
  if (s.made > 0 && scratch.h2 == h2 && !scratch.is_loaded) return;
  scratch.h2 = h2;
  scratch.is_loaded = false;
  const Record* positions = s.state.positions.data() + s.model.first[at(object)];
  set_masses(sheet, positions, scratch);
  factorise(sheet, scratch);
}

/// Makes the particles of contacts with colliders heavy that r presses in. True if there are any.
class HeldParticles {
 public:
  HeldParticles(Substep& s, int object, SheetScratch& scratch)
      : s_(s),
        first_(s.model.first[at(object)]),
        scratch_(scratch),
        rows_(s.model.objects[at(object)].sheet.levels.front().rows) {}

  bool find(const std::vector<Contact>& contacts) {
    bool any = false;
    for (const Contact& c : contacts) {
      if (!is_held_up(c) || !(overlap_now(c) > 0)) continue;
      for (std::size_t i = 0; i < c.point.size(); ++i) any = hold(c, i) || any;
    }
    return any;
  }

 private:
  /// True if the other side is a collider or has infinite mass.
  bool is_held_up(const Contact& c) const {
    if (c.collider >= 0) return true;
    for (std::size_t i = 0; i < c.point.size(); ++i)
      if (c.weight[i] < 0 && s_.state.positions[at(c.point[i])].w > 0) return false;
    return true;
  }
  float overlap_now(const Contact& c) const {
    Vec3f moved = -c.surface_motion;
    for (std::size_t i = 0; i < c.point.size(); ++i) {
      if (c.weight[i] == 0) continue;
      const Record& d = s_.work.displacements[at(c.point[i])];
      moved += Vec3f{d.x, d.y, d.z} * c.weight[i];
    }
    return -(c.gap + dot(c.normal, moved));
  }
  bool hold(const Contact& c, std::size_t i) {
    const int row = c.point[i] - first_;
    if (c.weight[i] == 0 || row < 0 || row >= rows_) return false;
    SheetLevelScratch& level = scratch_.levels.front();
    const Record& r = level.right[at(row)];
    if (!(dot(c.normal, Vec3f{r.x, r.y, r.z}) * c.weight[i] < 0) || level.mass[at(row)] == 0) return false;
    level.heavy[at(row)] = weight_on_colliders * level.mass[at(row)];
    return true;
  }

  Substep& s_;
  int first_;
  SheetScratch& scratch_;
  int rows_;
};

/// Finds the particles that colliders hold up. True if there are any.
bool find_held(Substep& s, int object, SheetScratch& scratch) {
  HeldParticles held(s, object, scratch);
  bool any = false;
  for_each_tile(s, [&](int task) {
    if (s.model.tiles()[task].object == object) any = held.find(s.work.tiles[at(task)].contacts) || any;
  });
  any = held.find(s.own->shape_contacts) || any;
  if (s.has_pairs()) any = held.find(s.pairs->contacts()) || any;
  return any;
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

/// Finds which pieces have a fixed or heavy particle. True if all have.
bool find_pieces_held(const SheetBending& sheet, SheetScratch& scratch) {
  const SheetLevelScratch& finest = scratch.levels.front();
  scratch.holds.assign(at(sheet.pieces), 0);
  for (std::size_t i = 0; i < finest.mass.size(); ++i)
    if (sheet.piece[i] >= 0 && (finest.mass[i] == 0 || finest.heavy[i] > 0)) scratch.holds[at(sheet.piece[i])] = 1;
  return std::all_of(scratch.holds.begin(), scratch.holds.end(), [](char holds) { return holds != 0; });
}

/// Calls body(i) for each row of a piece that nothing holds.
template <class Body>
void for_free_rows(const SheetBending& sheet, const SheetScratch& scratch, const Body& body) {
  for (std::size_t i = 0; i < sheet.piece.size(); ++i)
    if (sheet.piece[i] >= 0 && scratch.holds[at(sheet.piece[i])] == 0) body(i);
}

/// What nothing holds falls: gravity passes P by, which would let it fall by P^-1 M g, with ripples.
void leave_out_gravity(const SheetBending& sheet, const Vec3f& g, SheetScratch& scratch) {
  SheetLevelScratch& finest = scratch.levels.front();
  for_free_rows(sheet, scratch, [&](std::size_t i) {
    Record& r = finest.right[i];
    const float m = finest.mass[i];
    r = {r.x - g.x * m, r.y - g.y * m, r.z - g.z * m, r.w};
  });
}

/// Removes from the corrections of each free piece the rigid motion that they contain, which no force of bending has caused, and adds gravity.
void keep_momentum(const SheetBending& sheet, const Record* positions, const Vec3f& gravity, SheetScratch& scratch) {
  const std::vector<float>& mass = scratch.levels.front().mass;
  const auto place = [&](std::size_t i) {
    const Record &x = positions[i], &o = positions[0];
    return Vec3d{static_cast<double>(x.x - o.x), static_cast<double>(x.y - o.y), static_cast<double>(x.z - o.z)};
  };
  scratch.momentum.assign(at(sheet.pieces), {});
  for_free_rows(sheet, scratch, [&](std::size_t i) {
    const Record& c = scratch.corrections[i];
    const Vec3d correction{static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
    add_row(place(i), correction, static_cast<double>(mass[i]), scratch.momentum[at(sheet.piece[i])]);
  });
  std::vector<RigidStep> steps;
  steps.reserve(scratch.momentum.size());
  for (const RigidSums& sums : scratch.momentum) steps.push_back(rigid_step(sums));
  for_free_rows(sheet, scratch, [&](std::size_t i) {
    const RigidStep& step = steps[at(sheet.piece[i])];
    const Vec3f by = gravity - convert<float>(step.translation + cross(step.rotation, place(i)));
    Record& c = scratch.corrections[i];
    c = {c.x + by.x, c.y + by.y, c.z + by.z, 0};
  });
}

/// d = u + lead + corrections / n - (n - 1) h^2 g, where bending is for n substeps, in each of which gravity acts.
void apply(Substep& s, int object, const SheetForces& forces, BlockLoop loop, SheetScratch& scratch) {
  const SheetBending& sheet = s.model.objects[at(object)].sheet;
  const float n = forces.substeps;
  const Vec3f back = forces.gravity * (n - 1) - forces.lead();
  Record* displacements = s.work.displacements.data() + s.model.first[at(object)];
  const SheetLevel& level = sheet.levels.front();
  const std::vector<float>& mass = scratch.levels.front().mass;
  loop(level.blocks(), [&](int block) {
    for (int i = block * sheet_block; i < std::min(level.rows, (block + 1) * sheet_block); ++i) {
      if (mass[at(i)] == 0 || sheet.piece[at(i)] < 0) continue;
      const Record &u = scratch.moved[at(i)], &c = scratch.corrections[at(i)];
      displacements[i] = {u.x + (c.x / n - back.x), u.y + (c.y / n - back.y), u.z + (c.z / n - back.z), 0};
    }
  });
}

void bend(Substep& s, int object, int substeps) {
  const SheetBending& sheet = s.model.objects[at(object)].sheet;
  SheetScratch& scratch = s.work.sheets[at(object)];
  const int first = s.model.first[at(object)];
  const Vec3f gravity = gravity_for(s, static_cast<double>(s.h)) * s.h;
  begin_sheet(s, object, static_cast<float>(substeps) * s.h, scratch);
  const SheetForces forces{s.state.positions.data() + first, s.work.displacements.data() + first, gravity, s.h,
                           static_cast<float>(substeps)};
  const auto loop = [&](int blocks, FunctionRef<void(int)> body) { for_tasks(s, "bend sheets", blocks, body); };
  find_right_hand_side(sheet, forces, loop, scratch);
  if (find_held(s, object, scratch)) {
    scratch.is_loaded = true;
    spread_load(sheet, scratch);
    factorise(sheet, scratch);
  }
  const bool is_held = find_pieces_held(sheet, scratch);
  const Vec3f load = gravity * (forces.substeps * forces.substeps);
  if (!is_held) leave_out_gravity(sheet, load, scratch);
  solve_sheet(sheet, cycles_for(scratch.h2 * sheet.stiffness), loop, scratch);
  if (!is_held) keep_momentum(sheet, forces.positions, load, scratch);
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
    const SheetBending& sheet = s.model.objects[at(object)].sheet;
    const int substeps = sheet.is_used() ? substeps_of_bending(s, sheet) : 0;
    if (substeps > 0) bend(s, object, substeps);
  });
}

}  // namespace pliant
