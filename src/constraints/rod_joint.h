// Two neighbouring segments of an elastic rod: the rod stretches, shears, bends and twists where they meet
// (pliant/rod.h).
//
//   C_k = sqrt(K_k) d_k, k = x, y, z       d: gap of the anchors [m], in the joint frame of a, whose x-axis is the tangent
//   C_3+k = sqrt(B_k) phi_k                phi = 4 v / (1 + w), (v, w) the rotation from the joint frame of a to that of b:
//                                          along the axis of rotation, 4 tan(angle / 4) long [rad]
//
// With a compliance of 1 the energy is C . C / 2. Six rows of one constraint, so that a chain of segments is solved
// directly (Deul, Kugelstadt, Weiler and Bender 2018).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct RodJointRows {
  static constexpr const char* name = "rod_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 6;
  static constexpr bool is_joint = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    Vec3<R> root_of_force;   ///< square roots of the stiffnesses along x, y, z [(N/m)^1/2]
    Vec3<R> root_of_torque;  ///< and about them [(N m/rad)^1/2]
    R strain_per_angle;  ///< radius over the length of rod that bends: strain at the surface per angle of bending [1/rad]
  };
  static constexpr auto fields = joint::place_fields_and(
      std::array<const char*, 7>{"root_of_force_x", "root_of_force_y", "root_of_force_z", "root_of_torque_x",
                                 "root_of_torque_y", "root_of_torque_z", "strain_per_angle"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p.places);
    const Quat<R> turned = joint::relative(posed.frame_a, posed.frame_b);
    for (int axis = 0; axis < 3; ++axis) {
      joint::displacement(posed, axis, axis, out);
      scale(joint::component(p.root_of_force, axis), axis, out);
      bend(posed, turned, axis, out);
      scale(joint::component(p.root_of_torque, axis), 3 + axis, out);
    }
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Vec3<R> one{R(1), R(1), R(1)};
    return {joint::measure_places(at), one, one, R(1)};
  }

  /// The rest rotation follows that of the segments by what is beyond `yield`, a strain at the surface of a round rod.
  static bool flow(const SlotValues<slots, float>& at, Params<float>& p, const Params<float>& start,
                   const PlasticFlow& by) {
    const joint::Posed<float> posed = joint::pose(at, p.places);
    const Quat<float> turned = joint::relative(posed.frame_a, posed.frame_b);
    const float strain = surface_strain(rotation_vector(turned), p), beyond = strain - by.yield;
    if (!(beyond > 0) || !(by.share > 0)) return false;
    const Quat<float> flowed = of_rotation_vector(rotation_vector(turned) * (-by.share * (beyond / strain)));
    Quat<float> axes = normalise(multiply(p.places.axes_b, flowed));
    const Quat<float> permanent = joint::relative(start.places.axes_b, axes);
    const float size = surface_strain(rotation_vector(permanent), p);
    if (size > by.most)
      axes =
          normalise(multiply(start.places.axes_b, of_rotation_vector(rotation_vector(permanent) * (by.most / size))));
    p.places.axes_b = axes;
    return true;
  }

 private:
  /// phi of a rotation, and the rotation of a phi.
  static Vec3<float> rotation_vector(const Quat<float>& q) {
    const float share = 4 / (1 + q.w);
    return {q.x * share, q.y * share, q.z * share};
  }
  static Quat<float> of_rotation_vector(const Vec3<float>& phi) {
    const Vec3<float> m = phi * 0.25f;
    const float share = 1 / (1 + dot(m, m));
    return {2 * m.x * share, 2 * m.y * share, 2 * m.z * share, (1 - dot(m, m)) * share};
  }
  /// The equivalent strain at the surface of a round rod: that of bending, and twisting over the square root of 3.
  static float surface_strain(const Vec3<float>& phi, const Params<float>& p) {
    return p.strain_per_angle * sqrt(phi.y * phi.y + phi.z * phi.z + phi.x * phi.x * (1.f / 3));
  }

  /// Component `axis` of phi, in row 3 + axis.
  template <class R>
  PLIANT_HD static void bend(const joint::Posed<R>& posed, const Quat<R>& p, int axis, Rows<slots, rows, R>& out) {
    const Vec3<R> v{p.x, p.y, p.z}, e = joint::unit<R>(axis);
    const R share = R(1) / (R(1) + p.w), k = joint::component(v, axis);
    out.c[3 + axis] = R(4) * share * k;
    joint::set_rotation(rotate(posed.frame_a, (e * p.w + cross(v, e) + v * (share * k)) * (R(2) * share)), 3 + axis,
                        out);
  }

  template <class R>
  PLIANT_HD static void scale(const R& by, int row, Rows<slots, rows, R>& out) {
    out.c[row] = out.c[row] * by;
    for (int slot = 0; slot < 4; ++slot) out.gradient[row][slot] = out.gradient[row][slot] * by;
  }
};

}  // namespace pliant
