// Bending: two triangles that share an edge keep their dihedral angle.
//
//         2            n1 = e x (x2 - x0),  n2 = (x3 - x0) x e,  e = x1 - x0
//       /   \          C(x) = theta - theta0,  theta = atan2((n1 x n2) . e / |e|, n1 . n2)
//      0 --- 1
//       /          theta is 0 for a flat hinge; its sign tells to which side the hinge folds.
//         3
//
// Mueller et al. 2007, section 4.4.1 and appendix A, use C = acos(n1 . n2) - phi0 with one normal reversed. acos loses
// the sign of the fold and has no derivative at the flat hinge, the usual state of cloth; atan2 has both. The gradients
// are those of the angle (Bridson et al. 2003): |e| n / |n|^2 at each tip, and at the edge's ends what makes force and
// torque vanish. (n1 x n2) . e/|e| equals -|e| n1 . (x3 - x0), which saves a cross product. Compliance in 1/(N m)
// (rad^2/J).
#pragma once

#include <array>
#include <utility>

#include "math/functions.h"
#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct DihedralBending {
  static constexpr const char* name = "dihedral_bending";
  using slots = Points<4>;
  static constexpr int rows = 1;
  /// Largest change of the angle per projection [rad]. Tips move along tangents, so a larger change would throw out the
  /// tips of a stiff, overfolded hinge, stretch its triangles and keep a small object tumbling.
  static constexpr float largest_change = 0.25f;

  template <class R>
  struct Params {
    R rest_angle;  ///< dihedral angle at rest [rad], -pi..pi
  };
  static constexpr std::array<const char*, 1> fields{"rest_angle"};

  /// The gradient at the tip of a degenerate triangle is zero; with a degenerate edge all gradients are zero.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const Vec3<R> e = x[1] - x[0], a = x[2] - x[0], b = x[3] - x[0];
    const Vec3<R> n1 = cross(e, a), n2 = cross(b, e);
    const R e2 = dot(e, e);
    const R edge = sqrt(e2);
    const R angle = atan2(-(edge * dot(n1, b)), dot(n1, n2));

    const R s1 = edge / max(dot(n1, n1), R(1e-24f));
    const R s2 = edge / max(dot(n2, n2), R(1e-24f));
    const R per_e2 = R(1) / max(e2, R(1e-24f));
    const R t1 = dot(a, e) * per_e2, t2 = dot(b, e) * per_e2;  // projections of the tips onto the edge
    gradient[2] = n1 * (-s1);
    gradient[3] = n2 * (-s2);
    gradient[1] = -(gradient[2] * t1 + gradient[3] * t2);
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);

    // C is the difference modulo 2 pi, because the angle of a hinge that is folded past pi wraps around.
    const R pi = constant<R>(3.14159265358979324), turn = constant<R>(6.28318530717958648);
    const R c = angle - p.rest_angle;
    return select(c > pi, c - turn, select(c < -pi, c + turn, c));
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    Vec3<R> gradient[4];
    return {evaluate(x, Params<R>{R(0)}, gradient)};
  }

  /// The rest angle follows the fold by what is beyond `yield`.
  static bool flow(const SlotValues<slots, float>& at, Params<float>& p, const Params<float>& start,
                   const PlasticFlow& by) {
    Vec3<float> gradient[4];
    const float elastic = evaluate(at.point, p, gradient), beyond = abs(elastic) - by.yield;
    if (!(beyond > 0)) return false;
    const float before = p.rest_angle, moved = before + (elastic > 0 ? by.share : -by.share) * beyond;
    p.rest_angle = clamp(moved, start.rest_angle - by.most, start.rest_angle + by.most);
    return p.rest_angle != before;
  }

  /// Orders the points. Exchanging the edge's ends, or the tips, changes only the sign of the angle.
  static void canonical(std::array<int, 4>& particle, Params<float>& p) {
    for (int first : {0, 2}) {
      if (particle[first] < particle[first + 1]) continue;
      std::swap(particle[first], particle[first + 1]);
      p.rest_angle = -p.rest_angle;
    }
  }
};

}  // namespace pliant
