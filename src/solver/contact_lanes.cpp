// Contacts in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp.
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

PLIANT_HD bool any(const WideMask& mask) {
  std::int32_t set[16], sum = 0;
  std::memcpy(set, &mask, sizeof mask);
  for (const std::int32_t lane : set) sum |= lane;
  return sum != 0;
}

/// Projects the contacts number[0] to number[lanes - 1]. All sixteen entries of `number` must be valid indices.
PLIANT_HD void project_batch(Contact* contacts, const std::int32_t* number, int lanes, Record* displacements) {
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
  const WideRecords plane = load_quad(contacts, normal_gap, index), carried = load_quad(contacts, carried_approach, index),
                    sum = load_quad(contacts, friction_push, index), coefficients = load_quad(contacts, numbers, index),
                    motion = load_quad(contacts, motion_collider, index);
  ContactSums<Wide> sums{sum.position, sum.w};
  const ContactCorrection<Wide> correction = project_contact(
      {plane.position, plane.w, carried.position, motion.position, coefficients.position.x, coefficients.position.y}, moved,
      sums);
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

void project(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements) {
  for (int i = first; i < last; i += 16) project_batch(contacts, order + i, last - i < 16 ? last - i : 16, displacements);
}

}  // namespace
}  // namespace PLIANT_ISA

const ContactKernels& PLIANT_OF_LEVEL(contact_kernels)() {
  static constexpr ContactKernels table{&project};
  return table;
}

}  // namespace pliant
