// Contacts in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp.
#include "math/quat.h"
#include "math/wide.h"
#include "solver/contact_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// The number of four-float records (quads) in a Contact. The enumeration names them in order.
constexpr int quads = sizeof(Contact) / sizeof(Record);
enum Quad : int { normal_gap, carried_approach, friction_push, numbers, point, weight, share, motion_collider };

PLIANT_HD Record* quads_of(Contact* contacts, Quad quad) { return reinterpret_cast<Record*>(contacts) + quad; }

PLIANT_HD WideRecords load_quad(Contact* contacts, Quad quad, const std::int32_t* index) {
  return from_registers(load_indexed(quads_of(contacts, quad), index));
}

/// The point indices of sixteen contacts, by slot.
struct Points {
  std::int32_t at[4][16];
};

PLIANT_HD Points load_points(Contact* contacts, const std::int32_t* index) {
  const WideRecords of = load_quad(contacts, point, index);
  Points points;
  static_assert(sizeof of == sizeof points);
  std::memcpy(&points, &of, sizeof points);  // bits of integers, loaded through float registers
  return points;
}

struct Slots {
  Wide at[4];
};

PLIANT_HD Slots load_slots(Contact* contacts, Quad quad, const std::int32_t* index) {
  const WideRecords of = load_quad(contacts, quad, index);
  return {{of.position.x, of.position.y, of.position.z, of.w}};
}

/// Stores the records of those lanes whose mask is set.
PLIANT_HD void store_masked(Record* base, const std::int32_t* index, const Registers& registers, const WideMask& mask,
                            int lanes) {
  Record records[4][4];
  std::int32_t set[16];
  static_assert(sizeof records == sizeof registers && sizeof set == sizeof mask);
  std::memcpy(static_cast<void*>(records), &registers, sizeof registers);
  std::memcpy(set, &mask, sizeof mask);
  for (int lane = 0; lane < lanes; ++lane)
    if (set[lane] != 0) base[index[lane]] = records[lane % 4][lane / 4];
}

/// Projects the contacts number[0] to number[lanes - 1]. All sixteen entries of `number` must be valid indices.
PLIANT_HD void project_batch(Contact* contacts, const std::int32_t* number, int lanes, Record* displacements,
                             float yield) {
  std::int32_t index[16];
  for (int lane = 0; lane < 16; ++lane) index[lane] = number[lane < lanes ? lane : 0] * quads;
  const Points points = load_points(contacts, index);
  const Slots weights = load_slots(contacts, weight, index);
  Registers before[4];
  Vec3<Wide> moved{Wide(0.f), Wide(0.f), Wide(0.f)};
  for (int slot = 0; slot < 4; ++slot) {
    before[slot] = load_indexed(displacements, points.at[slot]);
    moved += from_registers(before[slot]).position * weights.at[slot];
  }
  const WideRecords plane = load_quad(contacts, normal_gap, index),
                    carried = load_quad(contacts, carried_approach, index),
                    sum = load_quad(contacts, friction_push, index), coefficients = load_quad(contacts, numbers, index),
                    motion = load_quad(contacts, motion_collider, index);
  ContactSums<Wide> sums{sum.position, sum.w};
  const ContactCorrection<Wide> correction =
      project_contact({plane.position, plane.w + Wide(yield) * coefficients.w, carried.position, motion.position,
                       coefficients.position.x, coefficients.position.y},
                      moved, sums);
  const WideMask touches = sums.push > Wide(0.f);
  if (!any(touches)) return;
  store_masked(quads_of(contacts, friction_push), index, to_registers({sums.friction, sums.push}), touches, lanes);
  const Slots shares = load_slots(contacts, share, index);
  const Vec3<Wide> change = correction.along + correction.across;
  for (int slot = 3; slot >= 0; --slot) {
    const Wide s = select(touches, shares.at[slot], Wide(0.f));
    const Registers after = before[slot] + to_registers({change * s, Wide(0.f)});
    store_masked(displacements, points.at[slot], after, abs(s) > Wide(0.f), lanes);
  }
}

void project(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements, float yield) {
  for (int i = first; i < last; i += 16)
    project_batch(contacts, order + i, last - i < 16 ? last - i : 16, displacements, yield);
}

// ---------------------------------------------------------------- points and primitive colliders

PLIANT_HD Vec3<Wide> everywhere(const Vec3f& v) { return {Wide(v.x), Wide(v.y), Wide(v.z)}; }
PLIANT_HD Pose<Wide> everywhere(const Pose<float>& p) {
  return {everywhere(p.position), {Wide(p.rotation.x), Wide(p.rotation.y), Wide(p.rotation.z), Wide(p.rotation.w)}};
}

/// Converts a mask to bits: bit l is set if lane l is true.
PLIANT_HD unsigned bits_of(const WideMask& mask) {
  std::int32_t set[16];
  std::memcpy(set, &mask, sizeof mask);
  unsigned bits = 0;
  for (int lane = 0; lane < 16; ++lane) bits |= static_cast<unsigned>(set[lane] & 1) << lane;
  return bits;
}

PLIANT_HD Vec3<Wide> vectors(const Record* base, const std::int32_t* index) {
  return from_registers(load_indexed(base, index)).position;
}

/// Writes each contact's particle, and the fields that are equal in all contacts of a query.
PLIANT_HD void write_shared(const PointContactQuery& q, const std::int32_t* particles, Contact* contacts) {
  for (int lane = 0; lane < 16; ++lane) {
    Contact& c = contacts[lane];
    const std::int32_t i = particles[lane];
    c.friction = {0, 0, 0};
    c.push = 0;
    c.static_friction = q.static_friction;
    c.kinetic_friction = q.kinetic_friction;
    c.restitution = q.restitution;
    c.thickness = q.thickness;
    c.point = {i, i, i, i};
    c.weight = {1, 0, 0, 0};
    c.share = {1, 0, 0, 0};
    c.collider = q.collider;
  }
}

PointContactLanes make_point_contacts(const PointContactQuery& q, const std::int32_t* particles, Contact* contacts) {
  const AdvanceArguments& a = q.particles;
  const WideRecords x = from_registers(load_indexed(a.positions, particles));
  const Pose<Wide> before = everywhere(q.before), after = everywhere(q.after);
  const Vec3<Wide> to = to_local(after, x.position + vectors(a.displacements, particles)),
                   from = to_local(before, x.position), moved = to - from;
  const SurfaceDistance<Wide> end = signed_distance(q.shape, to);
  const Wide thickness(q.thickness), path = length(moved);
  const unsigned meets = bits_of(end.distance < thickness + path) & ~bits_of(x.w == Wide(0.f)),
                 is_short = bits_of(path <= Wide(share_of_short_path * q.thickness)),
                 stays = bits_of(stays_beyond(Wide(share_of_first_hit * q.thickness), end, to, moved));
  const PointContactLanes lanes{meets & (is_short | stays), meets & ~(is_short | stays)};
  if (lanes.found == 0) return lanes;
  const Wide height = height_after(signed_distance(q.shape, from).distance, thickness, a.h);
  const PointContact<Wide> contact =
      contact_at_plane(plane_at_end(end, to, height), before, after, q.moves, x.position,
                       vectors(a.velocities, particles) + everywhere(q.gravity), a.inverse_h);
  const Vec3<Wide> carried = vectors(a.remainders, particles);
  std::int32_t index[16];
  for (int lane = 0; lane < 16; ++lane) index[lane] = quads * lane;
  store_indexed(quads_of(contacts, normal_gap), index, to_registers({contact.normal, contact.gap}));
  store_indexed(quads_of(contacts, carried_approach), index, to_registers({carried, contact.approach}));
  store_indexed(quads_of(contacts, motion_collider), index, to_registers({contact.surface_motion, Wide(0.f)}));
  write_shared(q, particles, contacts);
  return lanes;
}

}  // namespace
}  // namespace PLIANT_ISA

const ContactKernels& PLIANT_OF_LEVEL(contact_kernels)() {
  static constexpr ContactKernels table{&project, &make_point_contacts};
  return table;
}

}  // namespace pliant
