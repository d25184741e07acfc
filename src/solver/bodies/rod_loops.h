// The functions of RodKernels, written once: F is float and D double for one rod after another, Wide and WideDouble for
// many. The formulas, and the order of all sums, are those of JointForest and JointTree.
#pragma once

#include <cstring>

#include "math/block_tree.h"
#include "math/quat.h"
#include "math/rows.h"
#include "solver/bodies/joint_formulas.h"
#include "solver/bodies/joint_tree_formulas.h"
#include "solver/bodies/rod_kernels.h"
#include "solver/frame_formulas.h"
#include "solver/project.h"

namespace pliant::rod_formulas {

using namespace joint_tree_formulas;
using block_tree::is_one_number;

/// `Unit` is a type of an unnamed namespace, so that the linker never mixes the code of two levels; void for the
/// sequential reference.
template <class F, class D, int lanes, int double_lanes, class Unit>
struct Loops {
  using At = motion_formulas::Lanes<F, lanes>;
  using Values = SlotValues<joint::Bodies, F>;
  using JointRows = Rows<joint::Bodies, rod_rows, F>;
  using View = RodBundleView;

  PLIANT_HD static At at(const std::int32_t* list) {
    At out;
    for (int lane = 0; lane < lanes; ++lane) out.index[lane] = list[lane];
    return out;
  }
  template <class R>
  PLIANT_HD static R get(const float* row) {
    R value;
    load_row(row, value);
    return value;
  }
  template <class R>
  PLIANT_HD static Vec3<R> vector(const RodLanes* rows, int l) {
    return {get<R>(rows[0] + l), get<R>(rows[1] + l), get<R>(rows[2] + l)};
  }
  PLIANT_HD static void put(const Vec3<F>& v, RodLanes* rows, int l) {
    store_row(rows[0] + l, v.x);
    store_row(rows[1] + l, v.y);
    store_row(rows[2] + l, v.z);
  }

  /// Which rods take part, as numbers above zero.
  struct Flags {
    RodLanes row;
    PLIANT_HD explicit Flags(RodBits bits) {
      for (int lane = 0; lane < most_rods; ++lane) row[lane] = (bits >> lane & 1) != 0 ? 1.f : 0.f;
    }
    PLIANT_HD RodBits bits(int rods) const {
      RodBits found = 0;
      for (int lane = 0; lane < rods; ++lane) found |= row[lane] > 0 ? RodBits{1} << lane : RodBits{0};
      return found;
    }
  };

  // ---------------------------------------------------------------- masses

  static void fill_masses(const View& v) {
    for (int b = 0; b < v.bodies; ++b)
      for (int l = 0; l < v.rods; l += lanes) fill_mass(v, v.places[b], v.of_bodies[b], l);
  }
  PLIANT_HD static void fill_mass(const View& v, const RodBody& body, RodBodyScratch& to, int l) {
    const At frame = at(body.frame + l);
    const F w = at(body.point + l).load(v.points.positions).w;
    F inertia[6], inverse[6];
    joint_formulas::turned_inertia(frame.rotation(v.frames.orientations), frame.vector(v.frames.inverse_inertias),
                                   inertia, inverse);
    store_row(to.mass + l, F(1.f) / w);
    for (int i = 0; i < 6; ++i) {
      store_row(to.inertia[i] + l, inertia[i]);
      store_row(to.inverse[i] + l, inverse[i]);
    }
  }

  // ---------------------------------------------------------------- rows

  /// The slots of a joint, relative to the first.
  PLIANT_HD static Values slots_of(const View& v, const RodJoint& joint, const Record* displacements,
                                   const Record* orientations, int l) {
    const At a = at(joint.slots[0] + l), b = at(joint.slots[2] + l);
    Values out;
    out.point[2] = (b.vector(v.points.positions) - a.vector(v.points.positions)) +
                   (b.vector(displacements) - a.vector(displacements));
    out.frame[1] = at(joint.slots[1] + l).rotation(orientations);
    out.frame[3] = at(joint.slots[3] + l).rotation(orientations);
    return out;
  }
  PLIANT_HD static void evaluate(const Values& slots, const RodJointScratch& joint, JointRows& out, int l) {
    F fields[rod_fields];
    PLIANT_UNROLL
    for (int i = 0; i < rod_fields; ++i) fields[i] = get<F>(joint.rest[i] + l);
    typename RodJointRows::template Params<F> params;
    static_assert(sizeof params == sizeof fields);
    std::memcpy(&params, fields, sizeof params);
    RodJointRows::evaluate(slots, params, out);
  }
  PLIANT_HD static void evaluate_now(const View& v, int j, JointRows& out, int l) {
    evaluate(slots_of(v, v.kept[j], v.points.displacements, v.frames.orientations, l), v.of_joints[j], out, l);
  }
  PLIANT_HD static void evaluate_start(const View& v, int j, JointRows& out, int l) {
    evaluate(slots_of(v, v.kept[j], v.points.remainders, v.frames.starts, l), v.of_joints[j], out, l);
  }

  /// What the rows of a joint yield by: compliance over h^2, and damping.
  PLIANT_HD static void yielding(const View& v, int j, F& alpha, F& gamma, int l) {
    const F softness = get<F>(v.of_joints[j].rest[rod_fields] + l), most(largest_compliance);
    alpha = min(softness * F(v.points.inverse_h2), most);
    gamma = F(0.f);
    if (v.nodes[j].is_damped)
      gamma = min(softness * get<F>(v.of_joints[j].rest[rod_fields + 1] + l) * F(v.points.inverse_h), most);
  }
  /// The displacement of each slot since the substep's start.
  PLIANT_HD static void motion_of(const View& v, const RodJoint& joint, Vec3<F> (&motion)[4], int l) {
    for (int slot = 0; slot < 4; ++slot) {
      const At n = at(joint.slots[slot] + l);
      motion[slot] = slot % 2 == 1 ? n.vector(v.frames.predicted) + n.vector(v.frames.corrections)
                                   : n.vector(v.points.displacements) - n.vector(v.points.remainders);
    }
  }
  /// The same at the velocities of the substep's start.
  PLIANT_HD static void coast_of(const View& v, const RodJoint& joint, Vec3<F> (&coast)[4], int l) {
    const F zero(0.f), h(v.points.h);
    const Vec3<F> gravity{F(v.points.gravity.x), F(v.points.gravity.y), F(v.points.gravity.z)};
    for (int slot = 0; slot < 4; ++slot) {
      const At n = at(joint.slots[slot] + l);
      if (slot % 2 == 1) {
        coast[slot] = n.vector(v.frames.predicted);
        continue;
      }
      const auto falls = n.load(v.points.positions).w > zero;
      const Vec3<F> velocity = n.vector(v.points.velocities);
      coast[slot] = {(velocity.x + select(falls, gravity.x, zero)) * h,
                     (velocity.y + select(falls, gravity.y, zero)) * h,
                     (velocity.z + select(falls, gravity.z, zero)) * h};
    }
  }
  /// J M^-1 J^T of a row of a joint.
  PLIANT_HD static F inverse_mass_of(const View& v, const RodJoint& joint, const Vec3<F>* gradient, int l) {
    F sum(0.f);
    for (int slot = 0; slot < 4; ++slot) {
      const At n = at(joint.slots[slot] + l);
      if (slot % 2 == 0) {
        sum = sum + n.load(v.points.positions).w * length_squared(gradient[slot]);
        continue;
      }
      const Vec3<F> own = rotate(conjugate(n.rotation(v.frames.orientations)), gradient[slot]),
                    w = n.vector(v.frames.inverse_inertias);
      sum = sum + (w.x * own.x * own.x + w.y * own.y * own.y + w.z * own.z * own.z);
    }
    return sum;
  }
  /// What a row of a joint has besides C and its multiplier: the share of the substep's motion, along which C changes,
  /// and what is added to C. See response_of in joint_forest_rows.cpp.
  struct Response {
    F share, past;
  };
  PLIANT_HD static Response response_of(const View& v, const RodJoint& joint, const Vec3<F>* gradient,
                                        const Vec3<F> (&motion)[4], const F& alpha, const F& gamma, int l) {
    const F zero(0.f), one(1.f);
    const auto yields = alpha > zero;
    if (!v.points.keeps_energy) {
      const F viscous = select(yields, viscous_share(gamma), zero);
      return {one + viscous, select(viscous > zero, viscous * along(gradient, motion), zero)};
    }
    Vec3<F> coast[4];
    coast_of(v, joint, coast, l);
    const auto mean = energy_law::shares_of(alpha, inverse_mass_of(v, joint, gradient, l),
                                            energy_law::most_of_tree(length_squared(gradient[2])));
    const F by_motion = viscous_share(gamma, one - mean.motion - mean.coast) - mean.motion;
    const F past = by_motion * along(gradient, motion) - mean.coast * along(gradient, coast);
    return {select(yields, one + by_motion, one), select(yields, past, zero)};
  }
  PLIANT_HD static F along(const Vec3<F>* gradient, const Vec3<F> (&motion)[4]) {
    F sum(0.f);
    for (int slot = 0; slot < 4; ++slot) sum = sum + dot(gradient[slot], motion[slot]);
    return sum;
  }

  static void fill_rows(const View& v, RodBits at_start) {
    const Flags starts(at_start);
    for (int j = 0; j < v.joints; ++j)
      for (int l = 0; l < v.rods; l += lanes) fill_joint(v, j, at_start, starts, l);
  }
  PLIANT_HD static void fill_joint(const View& v, int j, RodBits at_start, const Flags& starts, int l) {
    RodJointScratch& to = v.of_joints[j];
    JointRows now;
    evaluate_now(v, j, now, l);
    store_gradients(now, to, l);
    if (at_start != 0) {
      JointRows before;
      evaluate_start(v, j, before, l);
      mix_gradients(before, starts, to, l);
    }
    fill_values(v, j, now, l);
  }
  PLIANT_HD static void store_gradients(const JointRows& rows, RodJointScratch& to, int l) {
    for (int r = 0; r < rod_rows; ++r)
      for (int slot = 0; slot < 4; ++slot) put(rows.gradient[r][slot], to.gradient[r][slot], l);
  }
  PLIANT_HD static void mix_gradients(const JointRows& rows, const Flags& which, RodJointScratch& to, int l) {
    const auto takes = get<F>(which.row + l) > F(0.f);
    for (int r = 0; r < rod_rows; ++r)
      for (int slot = 0; slot < 4; ++slot) {
        const Vec3<F> old = vector<F>(to.gradient[r][slot], l), &own = rows.gradient[r][slot];
        put({select(takes, own.x, old.x), select(takes, own.y, old.y), select(takes, own.z, old.z)},
            to.gradient[r][slot], l);
      }
  }
  PLIANT_HD static void fill_values(const View& v, int j, const JointRows& now, int l) {
    RodJointScratch& to = v.of_joints[j];
    const F zero(0.f), one(1.f);
    F alpha, gamma;
    yielding(v, j, alpha, gamma, l);
    Vec3<F> motion[4];
    const bool needs_motion = v.nodes[j].is_damped || v.points.keeps_energy;
    if (needs_motion) motion_of(v, v.kept[j], motion, l);
    for (int r = 0; r < rod_rows; ++r) {
      Response response{one, zero};
      if (needs_motion) {
        Vec3<F> gradient[4];
        for (int slot = 0; slot < 4; ++slot) gradient[slot] = vector<F>(to.gradient[r][slot], l);
        response = response_of(v, v.kept[j], gradient, motion, alpha, gamma, l);
      }
      store_row(to.value[r] + l, (now.c[r] + alpha * get<F>(to.before[r] + l) + response.past) / response.share);
      store_row(to.compliance[r] + l, alpha / response.share);
    }
  }

  // ---------------------------------------------------------------- solution

  PLIANT_HD static block_tree::Block<D> block(const View& v, int j) {
    D* const first = static_cast<D*>(v.blocks) + static_cast<std::ptrdiff_t>(j) * rod_block;
    return {first, first + rod_rows * rod_rows, first + 2 * rod_rows * rod_rows};
  }
  PLIANT_HD static Gradient<D>* moves_of(const View& v) {
    return reinterpret_cast<Gradient<D>*>(static_cast<D*>(v.blocks) +
                                          static_cast<std::ptrdiff_t>(v.joints) * rod_block);
  }
  PLIANT_HD static InverseMass<D> inverse_of(const RodBodyScratch& body, int l) {
    InverseMass<D> of;
    of.mass = D(1) / get<D>(body.mass + l);
    for (int i = 0; i < 6; ++i) of.inertia[i] = get<D>(body.inverse[i] + l);
    return of;
  }
  PLIANT_HD static void gradients_of(const RodJointScratch& joint, int end, Gradient<D> (&g)[rod_rows], int l) {
    for (int r = 0; r < rod_rows; ++r)
      g[r] = {vector<D>(joint.gradient[r][2 * end], l), vector<D>(joint.gradient[r][2 * end + 1], l)};
  }

  static void fill_block(const View& v, int j, int l) {
    const RodNode& node = v.nodes[j];
    const RodJointScratch& rows = v.of_joints[j];
    const block_tree::Block<D> to = block(v, j);
    for (int r = 0; r < rod_rows; ++r) {
      for (int c = is_one_number<D> ? 0 : r + 1; c < rod_rows; ++c) to.m[r * rod_rows + c] = D(0);
      to.m[r * rod_rows + r] = -get<D>(rows.compliance[r] + l);
      to.x[r] = -get<D>(rows.value[r] + l);
    }
    for (int end = 0; end < 2; ++end) {
      if (node.ends[end] < 0) continue;
      Gradient<D> g[rod_rows], moved[rod_rows];
      gradients_of(rows, end, g, l);
      subtract_body(g, inverse_of(v.of_bodies[node.ends[end]], l), rod_rows, to.m, rod_rows, moved);
      if (end != node.through) continue;
      Gradient<D> above[rod_rows];
      gradients_of(v.of_joints[node.parent], node.of_parent, above, l);
      couple(moved, rod_rows, above, rod_rows, to.to_parent, rod_rows);
    }
  }
  static void eliminate_all(const View& v) {
    for (int j = 0; j < v.joints; ++j) {
      block_tree::Parent<D> parent{nullptr, nullptr, 0};
      if (v.nodes[j].parent >= 0) {
        const block_tree::Block<D> above = block(v, v.nodes[j].parent);
        parent = {above.m, above.x, rod_rows};
      }
      block_tree::eliminate<rod_rows>(block(v, j), rod_rows, parent);
    }
    for (int j = v.joints; j-- > 0;)
      if (v.nodes[j].parent >= 0)
        block_tree::substitute<rod_rows>(block(v, j), rod_rows, block(v, v.nodes[j].parent).x, rod_rows);
  }
  static void find_moves(const View& v, int l) {
    Gradient<D>* const moves = moves_of(v);
    const Vec3<D> none{D(0), D(0), D(0)};
    for (int b = 0; b < v.bodies; ++b) moves[b] = {none, none};
    for (int j = 0; j < v.joints; ++j)
      for (int end = 0; end < 2; ++end) {
        const int body = v.nodes[j].ends[end];
        if (body < 0) continue;
        Gradient<D> g[rod_rows];
        gradients_of(v.of_joints[j], end, g, l);
        move_body(g, block(v, j).x, rod_rows, inverse_of(v.of_bodies[body], l), moves[body]);
      }
  }
  /// Replaces a row where a flag is set.
  PLIANT_HD static void keep(const Flags& which, const D& value, float* row, int l) {
    store_row(row + l, select(get<D>(which.row + l) > D(0), value, get<D>(row + l)));
  }
  static void keep_solution(const View& v, const Flags& which, int l) {
    for (int j = 0; j < v.joints; ++j)
      for (int r = 0; r < rod_rows; ++r) keep(which, block(v, j).x[r], v.of_joints[j].change[r], l);
    for (int b = 0; b < v.bodies; ++b) {
      const Vec3<D>&d = moves_of(v)[b].displacement, &t = moves_of(v)[b].rotation;
      const D six[6] = {d.x, d.y, d.z, t.x, t.y, t.z};
      for (int i = 0; i < 6; ++i) keep(which, six[i], v.of_bodies[b].move[i], l);
    }
  }
  static void find_pulls(const View& v, const Flags& which, int l) {
    const auto takes = get<F>(which.row + l) > F(0.f);
    for (int j = 0; j < v.joints; ++j)
      for (int end = 0; end < 2; ++end) {
        RodJointScratch& joint = v.of_joints[j];
        Vec3<F> pull{F(0.f), F(0.f), F(0.f)};
        for (int r = 0; r < rod_rows; ++r)
          pull = pull - vector<F>(joint.gradient[r][2 * end], l) * get<F>(joint.change[r] + l);
        const Vec3<F> old = vector<F>(joint.pull[end], l);
        put({select(takes, pull.x, old.x), select(takes, pull.y, old.y), select(takes, pull.z, old.z)}, joint.pull[end],
            l);
      }
  }
  static void solve(const View& v, RodBits bits) {
    const Flags which(bits);
    for (int l = 0; l < (lanes > 1 ? lanes : v.rods); l += double_lanes) {
      for (int j = 0; j < v.joints; ++j) fill_block(v, j, l);
      eliminate_all(v);
      find_moves(v, l);
      keep_solution(v, which, l);
    }
    for (int l = 0; l < v.rods; l += lanes) find_pulls(v, which, l);
  }

  // ---------------------------------------------------------------- stiffness of pulls

  static RodBits find_stiffness(const View& v, bool kept, bool of_pass, float most) {
    Flags above(0);
    for (int l = 0; l < v.rods; l += lanes) {
      const F zero(0.f);
      for (int b = 0; b < v.bodies; ++b) {
        for (int i = 0; i < 6; ++i) store_row(v.of_bodies[b].stiffness[i] + l, zero);
        store_row(v.of_bodies[b].size + l, zero);
      }
      for (int j = 0; j < v.joints; ++j)
        for (int end = 0; end < 2; ++end) add_stiffness(v, j, end, kept, of_pass, l);
      F largest = zero;
      for (int b = 0; b < v.bodies; ++b) {
        const RodBodyScratch& body = v.of_bodies[b];
        const F inertia = get<F>(body.inertia[0] + l) + get<F>(body.inertia[1] + l) + get<F>(body.inertia[2] + l);
        largest = max(largest, get<F>(body.size + l) * F(3.f) / inertia);
      }
      store_row(above.row + l, select(largest > F(most), F(1.f), zero));
    }
    return above.bits(v.rods);
  }
  PLIANT_HD static void add_stiffness(const View& v, int j, int end, bool kept, bool of_pass, int l) {
    const int b = v.nodes[j].ends[end];
    if (b < 0) return;
    const RodJointScratch& joint = v.of_joints[j];
    const Vec3<F> old = vector<F>(v.kept[j].pull[end], l), own = vector<F>(joint.pull[end], l);
    const Vec3<F> pull = !kept ? own : of_pass ? old + own : old;
    const Quat<F> q = at(v.kept[j].slots[2 * end + 1] + l).rotation(v.frames.orientations);
    RodBodyScratch& body = v.of_bodies[b];
    F sum[6];
    for (int i = 0; i < 6; ++i) sum[i] = get<F>(body.stiffness[i] + l);
    const F size = joint_formulas::add_stiffness(pull, rotate(q, vector<F>(joint.rest + 3 * end, l)), sum);
    for (int i = 0; i < 6; ++i) store_row(body.stiffness[i] + l, sum[i]);
    store_row(body.size + l, get<F>(body.size + l) + size);
  }

  // ---------------------------------------------------------------- motion

  static void apply(const View& v, RodBits bits) {
    const Flags which(bits);
    for (int b = 0; b < v.bodies; ++b)
      for (int l = 0; l < v.rods; l += lanes) apply_to(v, b, which, l);
  }
  PLIANT_HD static void apply_to(const View& v, int b, const Flags& which, int l) {
    const At point = at(v.places[b].point + l), frame = at(v.places[b].frame + l);
    const RodBodyScratch& body = v.of_bodies[b];
    const auto takes = get<F>(which.row + l) > F(0.f);
    const Vec3<F> none{F(0.f), F(0.f), F(0.f)}, move = vector<F>(body.move, l), turn = vector<F>(body.move + 3, l);
    const motion_formulas::RecordOf<F> d = point.load(v.points.displacements), c = frame.load(v.frames.corrections);
    point.store(v.points.displacements, select_vector(takes, d.xyz + move, d.xyz), select(takes, none.x, d.w));
    const Quat<F> q = frame.rotation(v.frames.orientations), now = joint_formulas::turned(q, turn);
    frame.store(v.frames.orientations, {select(takes, now.x, q.x), select(takes, now.y, q.y), select(takes, now.z, q.z),
                                        select(takes, now.w, q.w)});
    frame.store(v.frames.corrections, select_vector(takes, c.xyz + turn, c.xyz), select(takes, none.x, c.w));
  }
  template <class Mask>
  PLIANT_HD static Vec3<F> select_vector(const Mask& mask, const Vec3<F>& a, const Vec3<F>& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
  }

  // ---------------------------------------------------------------- open joints

  static RodBits find_open(const View& v, float share) {
    Flags open(0);
    for (int l = 0; l < v.rods; l += lanes) {
      F any(0.f);
      for (int j = 0; j < v.joints; ++j) any = max(any, is_open(v, j, share, l));
      store_row(open.row + l, any);
    }
    return open.bits(v.rods);
  }
  /// 1 where a joint is open, else 0.
  PLIANT_HD static F is_open(const View& v, int j, float share, int l) {
    const RodJointScratch& joint = v.of_joints[j];
    const F zero(0.f), one(1.f), least(joint_formulas::least_gap);
    JointRows now;
    evaluate_now(v, j, now, l);
    const F size = sqrt(length_squared(vector<F>(joint.rest, l))) + sqrt(length_squared(vector<F>(joint.rest + 3, l)));
    const F of_soft = max(least, F(joint_formulas::open_share_of_soft) * size),
            of_rigid = max(least, F(share) * min(size, one));
    F alpha, gamma;
    yielding(v, j, alpha, gamma, l);
    Vec3<F> motion[4];
    const bool needs_motion = v.nodes[j].is_damped || v.points.keeps_energy;
    if (needs_motion) motion_of(v, v.kept[j], motion, l);
    const auto is_soft = get<F>(joint.rest[rod_fields] + l) > zero;
    F open = zero;
    for (int r = 0; r < rod_rows; ++r) {
      const F squared = length_squared(now.gradient[r][2]);
      Response response{one, zero};
      if (needs_motion) response = response_of(v, v.kept[j], now.gradient[r], motion, alpha, gamma, l);
      const F error = now.c[r] + alpha * get<F>(joint.before[r] + l) + response.past;
      const F displaced = select(squared > zero, select(error * error > of_soft * of_soft * squared, one, zero), zero);
      open = max(open, select(is_soft, displaced, select(abs(now.c[r]) > of_rigid, one, zero)));
    }
    return open;
  }

  static constexpr RodKernels table{&fill_masses, &fill_rows, &solve, &find_stiffness, &apply, &find_open};
};

}  // namespace pliant::rod_formulas
