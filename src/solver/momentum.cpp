#include "solver/momentum.h"

#include <algorithm>
#include <cmath>

#include "math/matrix.h"
#include "solver/points.h"
#include "solver/substep.h"

namespace pliant {

namespace {

Vec3f difference(const Record& a, const Record& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// A particle's position relative to the object's first one.
Vec3f from_first(const AdvanceArguments& a, int i) { return difference(a.positions[i], a.positions[0]); }

void add(const Vec3d& x, const Vec3d& impulse, DisplacementMomentum& to) {
  to.linear += impulse;
  to.angular += cross(x, impulse);
}

void add(const RigidSums& tile, RigidSums& to) {
  to.mass += tile.mass;
  to.first += tile.first;
  to.squares += tile.squares;
  to.products += tile.products;
  to.corrections.linear += tile.corrections.linear;
  to.corrections.angular += tile.corrections.angular;
}

/// The sums of a tile. Corrections count from the prediction, or are the whole displacements.
RigidSums sums_of(const AdvanceArguments& a, Since since) {
  RigidSums sums;
  for (int i = a.first; i < a.last; ++i) {
    const double mass = 1 / static_cast<double>(a.positions[i].w);
    const Vec3d x = convert<double>(from_first(a, i));
    const Record before = since == Since::prediction ? predicted_displacement(a, i) : Record{};
    sums.mass += mass;
    sums.first += x * mass;
    sums.squares += Vec3d{x.x * x.x, x.y * x.y, x.z * x.z} * mass;
    sums.products += Vec3d{x.y * x.z, x.z * x.x, x.x * x.y} * mass;
    add(x, convert<double>(difference(a.displacements[i], before)) * mass, sums.corrections);
  }
  return sums;
}

/// Objects of which momentum is conserved.
struct Inflated {
  const Substep& s;
  const std::vector<char>* only;

  bool has(int object) const {
    return s.model.objects[object].volume.keeps_momentum && is_swept(s, object) &&
           (only == nullptr || (*only)[static_cast<std::size_t>(object)] != 0);
  }
  bool has_object_of(int task) const { return has(s.model.tiles()[task].object); }

  /// `multigrid` includes contacts, whose momentum must not be removed.
  bool empty() const {
    if (s.group != nullptr && s.group->sweep == Sweep::multigrid) return true;
    bool found = false;
    for_objects(s, [&](int object) { found = found || has(object); });
    return !found;
  }
};

/// Calls body(task) for their tiles, in parallel.
void for_tiles_of(const Inflated& inflated, Substep& s, FunctionRef<void(int)> body) {
  for_tiles(s, "solve: momentum", [&](int task) {
    if (inflated.has_object_of(task)) body(task);
  });
}

/// Adds the sums of the tiles of each object, and stores its rigid motion.
void find_rigid_steps(const Inflated& inflated, Substep& s) {
  std::vector<RigidStep>& steps = s.own->rigid_steps;
  steps.resize(s.model.objects.size());
  RigidSums sums;
  int object = -1;
  const auto finish = [&] {
    if (object >= 0) steps[static_cast<std::size_t>(object)] = rigid_step(sums);
    sums = {};
  };
  for_each_tile(s, [&](int task) {  // those of one object are consecutive
    if (!inflated.has_object_of(task)) return;
    const int next = s.model.tiles()[task].object;
    if (next != object) finish();
    object = next;
    add(s.work.tiles[task].rigid, sums);
  });
  finish();
}

void remove(const RigidStep& step, const AdvanceArguments& a) {
  const Vec3f translation = convert<float>(step.translation), rotation = convert<float>(step.rotation);
  for (int i = a.first; i < a.last; ++i) {
    const Vec3f moved = translation + cross(rotation, from_first(a, i));
    Record& d = a.displacements[i];
    d = {d.x - moved.x, d.y - moved.y, d.z - moved.z, 0};
  }
}

}  // namespace

RigidStep rigid_step(const RigidSums& sums) {
  const Vec3d centre = sums.first * (1 / sums.mass), push = sums.corrections.linear;
  const auto about_centre = [&](double sum, double a, double b) { return sum - sums.mass * a * b; };
  const Vec3d squares{about_centre(sums.squares.x, centre.x, centre.x),
                      about_centre(sums.squares.y, centre.y, centre.y),
                      about_centre(sums.squares.z, centre.z, centre.z)};
  const Vec3d products{about_centre(sums.products.x, centre.y, centre.z),
                       about_centre(sums.products.y, centre.z, centre.x),
                       about_centre(sums.products.z, centre.x, centre.y)};
  const Vec3d moments{squares.y + squares.z, squares.z + squares.x, squares.x + squares.y};
  const Vec3d inertia[3] = {{moments.x, -products.z, -products.y},
                            {-products.z, moments.y, -products.x},
                            {-products.y, -products.x, moments.z}};
  const Vec3d rotation = solve_by_cramer(inertia, sums.corrections.angular - cross(centre, push));
  const Vec3d translation = push * (1 / sums.mass) - cross(rotation, centre);
  return is_finite(rotation) && is_finite(translation) ? RigidStep{translation, rotation} : RigidStep{};
}

void note_momentum(Substep& s, Since since, const std::vector<char>* only) {
  const Inflated inflated{s, only};
  if (inflated.empty()) return;
  if (since == Since::prediction) {
    for_each_tile(s, [&](int task) {
      if (inflated.has_object_of(task)) s.work.tiles[task].noted = {};
    });
    return;
  }
  for_tiles_of(inflated, s,
               [&](int task) { s.work.tiles[task].noted = sums_of(particles(s, task), since).corrections; });
}

void note_impulse_on_body(Substep& s, int object, const Vec3f& place, const Vec3f& impulse) {
  if (!s.model.objects[object].volume.keeps_momentum) return;
  const std::vector<Task>& tiles = s.model.tiles();  // by object
  const auto first = std::lower_bound(tiles.begin(), tiles.end(), object,
                                      [](const Task& tile, int number) { return tile.object < number; });
  add(convert<double>(place), -convert<double>(impulse), s.work.tiles[first - tiles.begin()].noted);
}

void conserve_momentum(Substep& s, Since since, const std::vector<char>* only) {
  const Inflated inflated{s, only};
  if (inflated.empty()) return;
  for_tiles_of(inflated, s, [&](int task) {
    RigidSums& sums = s.work.tiles[task].rigid;
    sums = sums_of(particles(s, task), since);
    const DisplacementMomentum& noted = s.work.tiles[task].noted;
    sums.corrections.linear -= noted.linear;
    sums.corrections.angular -= noted.angular;
  });
  find_rigid_steps(inflated, s);
  for_tiles_of(inflated, s, [&](int task) {
    remove(s.own->rigid_steps[static_cast<std::size_t>(s.model.tiles()[task].object)], particles(s, task));
  });
}

}  // namespace pliant
