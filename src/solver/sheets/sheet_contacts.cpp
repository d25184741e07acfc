#include "solver/sheets/sheet_contacts.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "solver/bodies/body_solver.h"
#include "solver/substep.h"

namespace pliant::sheets {

namespace {

/// Passes over contacts that find the first forces, and steps of conjugate gradients at most after these.
constexpr int first_passes = 8, most_steps = 2;
/// Forces are found where no side is farther in, or apart under a force, than this share of the largest correction, or
/// of what gravity moves in a substep.
constexpr float tolerated_error = 0.1f, tolerated_of_gravity = 0.001f;

Vec3f place_of(const Record& r) { return {r.x, r.y, r.z}; }

/// Collects the contacts of one object.
class Collected {
 public:
  Collected(const Substep& s, int object, const Vec3f& gravity)
      : s_(s), first_(s.model.first[at(object)]), rows_(s.model.objects[at(object)].particles), gravity_(gravity) {}

  /// `base`: what the indices of points count from. `yields`: the inverse mass of the other side.
  void add(const Contact& c, int base, float yields, Contact* of_collider) {
    SheetContact out;
    Vec3f moved = -c.surface_motion;
    bool is_of_one_side = true;
    for (std::size_t k = 0; k < 4; ++k) {
      if (c.weight[k] == 0) continue;
      const int i = base + c.point[k];
      const float w = s_.state.positions[at(i)].w;
      const Vec3f d = place_of(s_.work.displacements[at(i)]);
      moved += (w > 0 ? d - gravity_ : d) * c.weight[k];
      if (!(w > 0)) continue;
      is_of_one_side = is_of_one_side && i >= first_ && i < first_ + rows_ &&
                       (out.points == 0 || (out.weight[0] > 0) == (c.weight[k] > 0));
      out.row[at(out.points)] = i - first_;
      out.weight[at(out.points++)] = c.weight[k];
      out.inverse_mass += w * c.weight[k] * c.weight[k];
    }
    if (!is_of_one_side || out.points == 0) return;
    out.normal = c.normal;
    out.room = std::max(c.gap + dot(c.normal, moved), 0.f);
    out.yields = yields;
    out.of_collider = of_collider;
    all.push_back(out);
  }

  std::vector<SheetContact> all;

 private:
  const Substep& s_;
  int first_, rows_;
  Vec3f gravity_;
};

/// The inverse mass of each touched body times the number of points' contacts with it.
std::vector<float> yields_of_bodies(const Substep& s) {
  std::vector<float> yields(s.bodies->touched_bodies().size(), 0);
  for (const Contact& c : s.bodies->point_contacts()) {
    const auto b = at(s.bodies->body_of(c));
    yields[b] += s.state.positions[at(s.bodies->touched_bodies()[b].particle)].w;
  }
  return yields;
}

Vec3f motion_of(const SheetContact& c, const Records& x) {
  Vec3f sum{};
  for (int k = 0; k < c.points; ++k) sum += place_of(x[at(c.row[at(k)])]) * c.weight[at(k)];
  return sum;
}

/// room + J x + y f: what is left between the sides [m].
float left_of(const SheetContact& c, const Records& x) {
  return c.room + dot(c.normal, motion_of(c, x)) + c.yields * c.force;
}

/// Puts forces into `turn` that let nothing in where each row moves by its own mass: at rest those that are right.
void guess_forces(const std::vector<float>& mass, const Records& right, std::vector<SheetContact>& contacts) {
  Records moved(right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    const float w = mass[i] > 0 ? 1 / mass[i] : 0;
    moved[i] = {right[i].x * w, right[i].y * w, right[i].z * w, 0};
  }
  for (SheetContact& c : contacts) c.turn = 0;
  const auto project = [&](SheetContact& c) {
    const float left = c.room + dot(c.normal, motion_of(c, moved)) + c.yields * c.turn;
    const float before = c.turn;
    c.turn = std::max(before - left / (c.inverse_mass + c.yields), 0.f);
    for (int k = 0; k < c.points; ++k) {
      Record& r = moved[at(c.row[at(k)])];
      const float m = mass[at(c.row[at(k)])];
      const Vec3f by = c.normal * (m > 0 ? (c.turn - before) * c.weight[at(k)] / m : 0);
      r = {r.x + by.x, r.y + by.y, r.z + by.z, 0};
    }
  };
  for (int pass = 0; pass < first_passes; ++pass) {
    if (pass % 2 == 0)
      for (SheetContact& c : contacts) project(c);
    else
      for (std::size_t k = contacts.size(); k-- > 0;) project(contacts[k]);
  }
}

/// The largest error of the forces: how far a side is in, or apart under a force [m].
float error_of(const std::vector<SheetContact>& contacts, const Records& x) {
  float error = 0;
  for (const SheetContact& c : contacts) {
    const float left = left_of(c, x);
    error = std::max(error, c.force > 0 ? std::fabs(left) : -left);
  }
  return error;
}

float tolerance_of(const Records& x, float gravity) {
  float most = 0;
  for (const Record& r : x) most = std::max({most, std::fabs(r.x), std::fabs(r.y), std::fabs(r.z)});
  return std::max(tolerated_error * most, tolerated_of_gravity * gravity);
}

/// Goes along the search direction, whose response is z, as far as it helps and no force becomes negative.
void advance(std::vector<SheetContact>& contacts, const Records& z, Records& x) {
  double slope = 0, curvature = 0, most = 1e30;
  for (const SheetContact& c : contacts) {
    if (c.turn == 0) continue;
    const auto turn = static_cast<double>(c.turn);
    slope -= turn * static_cast<double>(left_of(c, x));
    curvature += turn * static_cast<double>(dot(c.normal, motion_of(c, z)) + c.yields * c.turn);
    if (turn < 0) most = std::min(most, static_cast<double>(c.force) / -turn);
  }
  if (!(curvature > 0) || !(slope > 0)) return;
  const auto by = static_cast<float>(std::min(slope / curvature, most));
  for (SheetContact& c : contacts) c.force = std::max(c.force + by * c.turn, 0.f);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = {x[i].x + by * z[i].x, x[i].y + by * z[i].y, x[i].z + by * z[i].z, 0};
}

/// The next search direction (Polak and Ribiere, by the contacts' own masses). `slopes`: those of the last one, by
/// which each force would go without the others [kg m]. False if there is none.
bool turn_directions(std::vector<SheetContact>& contacts, const Records& x, std::vector<float>& slopes, bool is_first) {
  double before = 0, changed = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const SheetContact& c = contacts[k];
    const float left = left_of(c, x), own = c.inverse_mass + c.yields;
    const float slope = c.force > 0 || left < 0 ? left / own : 0;
    before += static_cast<double>(slopes[k]) * static_cast<double>(slopes[k] * own);
    changed += static_cast<double>(slope - slopes[k]) * static_cast<double>(slope * own);
    slopes[k] = slope;
  }
  const auto beta = static_cast<float>(!is_first && before > 0 ? std::max(changed / before, 0.) : 0.);
  bool any = false;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    SheetContact& c = contacts[k];
    c.turn = (is_first ? 0 : beta * c.turn) - slopes[k];
    if (c.force <= 0 && c.turn < 0) c.turn = 0;
    any = any || c.turn != 0;
  }
  return any;
}

}  // namespace

std::vector<SheetContact> contacts_of_sheet(Substep& s, int object, const Vec3f& gravity) {
  Collected found(s, object, gravity);
  if (!s.own->colliders.empty()) {
    for_each_tile(s, [&](int task) {
      if (s.model.tiles()[task].object != object) return;
      for (Contact& c : s.work.tiles[task].contacts) found.add(c, s.model.first[at(object)], 0, &c);
    });
    for (Contact& c : s.own->shape_contacts) found.add(c, 0, 0, &c);
  }
  if (s.has_pairs())
    for (Contact& c : s.pairs->contacts()) found.add(c, 0, 0, &c);
  if (s.bodies == nullptr || s.bodies->point_contacts().empty()) return std::move(found.all);
  const std::vector<float> yields = yields_of_bodies(s);
  for (const Contact& c : s.bodies->point_contacts()) found.add(c, 0, yields[at(s.bodies->body_of(c))], nullptr);
  return std::move(found.all);
}

void add_contact_forces(const std::vector<SheetContact>& contacts, float SheetContact::*of, float by, Records& to) {
  for (const SheetContact& c : contacts)
    for (int k = 0; k < c.points; ++k) {
      Record& r = to[at(c.row[at(k)])];
      const Vec3f f = c.normal * (by * c.*of * c.weight[at(k)]);
      r = {r.x + f.x, r.y + f.y, r.z + f.z, r.w};
    }
}

void hand_over_forces(std::vector<SheetContact>& contacts) {
  for (SheetContact& c : contacts) {
    if (c.of_collider == nullptr) continue;
    c.of_collider->push += c.force * c.inverse_mass;
    c.force = 0;
  }
}

void solve_contacts(const std::vector<float>& mass, const Records& right, float gravity, SheetResponse respond,
                    std::vector<SheetContact>& contacts, Records& x) {
  guess_forces(mass, right, contacts);
  Records guessed, z;
  const bool presses = std::any_of(contacts.begin(), contacts.end(), [](const SheetContact& c) { return c.turn > 0; });
  for (SheetContact& c : contacts) c.force = c.turn;
  if (presses) {
    respond(&right, &SheetContact::force, guessed);
    if (error_of(contacts, guessed) <= tolerance_of(guessed, gravity)) return x.swap(guessed);
  }
  for (SheetContact& c : contacts) c.force = 0;
  respond(&right, &SheetContact::force, x);
  if (error_of(contacts, x) <= 0) return;
  if (presses) {
    for (std::size_t i = 0; i < x.size(); ++i)
      guessed[i] = {guessed[i].x - x[i].x, guessed[i].y - x[i].y, guessed[i].z - x[i].z, 0};
    advance(contacts, guessed, x);
  }
  std::vector<float> last(contacts.size(), 0);
  for (int step = 0; step < most_steps && error_of(contacts, x) > tolerance_of(x, gravity); ++step) {
    if (!turn_directions(contacts, x, last, step == 0)) return;
    respond(nullptr, &SheetContact::turn, z);
    advance(contacts, z, x);
  }
}

}  // namespace pliant::sheets
