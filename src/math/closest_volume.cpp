#include "math/closest_volume.h"

#include "math/best_rotation.h"
#include "math/functions.h"

namespace pliant {

namespace {

/// Finds the numbers v > 0 of product d > 0 that are closest to s, of which only the smallest may be negative. By Lagrange
/// v_i (v_i - s_i) = mu for all i. At most the smallest v takes the smaller root of this (second-order condition), so t = v of the
/// smallest s gives mu, and the others as the larger roots.
class ClosestOfProduct {
 public:
  ClosestOfProduct(double least, double second, double third, double d) : s_{least, second, third}, d_(d) {
    const double top = product(least), side = pow(d, 1.0 / 3);
    if (!(least > 0 && top > d))
      set(root(max(least, 0.0), max(least, side)));
    else if (top < 2 * d)  // then t > least / 2, where the product rises with t
      set(root(least / 2, least));
    else
      search(least);
  }

  double operator[](int i) const { return v_[i]; }

 private:
  /// The larger root v of v (v - s) = mu.
  static double larger_root(double s, double mu) {
    const double root = sqrt(max(s * s + 4 * mu, 0.0));
    return s >= 0 ? (s + root) / 2 : 2 * mu / (root - s);
  }

  void set(double t) {
    const double mu = t * (t - s_[0]);
    v_[0] = t;
    for (int i = 1; i < 3; ++i) v_[i] = larger_root(s_[i], mu);
  }

  double product(double t) {
    set(t);
    return v_[0] * v_[1] * v_[2];
  }

  /// Derivative of the product of the present v by t.
  double slope() const {
    const double rise = v_[0] * (2 * v_[0] - s_[0]);
    return v_[1] * v_[2] + rise * (v_[2] / (2 * v_[1] - s_[1]) + v_[1] / (2 * v_[2] - s_[2]));
  }

  /// The t from `low`, where the product is at most d, to `high`, where it is at least d: Newton's method, kept in the interval by bisection.
  double root(double low, double high) {
    constexpr int most_steps = 60;
    constexpr double precision = 1e-15;
    double t = high;
    for (int step = 0; step < most_steps; ++step) {
      const double error = product(t) - d_;
      (error < 0 ? low : high) = t;
      double next = t - error / slope();
      if (!(next >= low && next <= high)) next = (low + high) / 2;
      if (abs(next - t) <= precision * high) return next;
      t = next;
    }
    return t;
  }

  double distance() const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += (v_[i] - s_[i]) * (v_[i] - s_[i]);
    return sum;
  }

  /// Where s has twice the product or more there can be two local minima: takes the closer.
  void search(double least) {
    constexpr int intervals = 32;
    double best = least, closest = 0;
    bool is_found = false, was_below = true;  // as the product vanishes with t
    for (int i = 1; i <= intervals; ++i) {
      const bool is_below = i < intervals && product(least * i / intervals) < d_;
      if (was_below && !is_below) {
        const double t = root(least * (i - 1) / intervals, least * i / intervals);
        set(t);
        if (!is_found || distance() < closest) best = t, closest = distance();
        is_found = true;
      }
      was_below = is_below;
    }
    set(best);
  }

  double s_[3], v_[3] = {}, d_;
};

/// f = R S with the rotation R nearest to f, so S is symmetric and only its smallest eigenvalue may be negative.
struct Stretch {
  Vec3<double> axes[3];  // columns of R
  Diagonal<3> s;

  explicit Stretch(const Matrix3d& f) {
    const Quatd turn = best_rotation(f);
    axes[0] = rotate(turn, Vec3<double>{1, 0, 0});
    axes[1] = rotate(turn, Vec3<double>{0, 1, 0});
    axes[2] = rotate(turn, Vec3<double>{0, 0, 1});
    const auto raw = [&](int i, int j) { return axes[i].x * f[j] + axes[i].y * f[3 + j] + axes[i].z * f[6 + j]; };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s.a[i][j] = (raw(i, j) + raw(j, i)) / 2;
    make_diagonal(s);
  }

  /// The eigenvector k, turned: R times column k of s.v.
  Vec3<double> turned(int k) const { return s.v[0][k] * axes[0] + s.v[1][k] * axes[1] + s.v[2][k] * axes[2]; }
};

}  // namespace

Matrix3d closest_of_determinant(const Matrix3d& f, double d) {
  const Stretch stretch(f);
  int least = 0;
  for (int i = 1; i < 3; ++i)
    if (stretch.s.a[i][i] < stretch.s.a[least][least]) least = i;
  const int order[3] = {least, (least + 1) % 3, (least + 2) % 3};
  const auto value = [&](int i) { return stretch.s.a[order[i]][order[i]]; };
  const ClosestOfProduct closest(value(0), value(1), value(2), d);
  Matrix3d out;
  for (int k = 0; k < 3; ++k) {
    const Vec3<double> to = stretch.turned(order[k]);
    for (int j = 0; j < 3; ++j) {
      const double along = closest[k] * stretch.s.v[j][order[k]];
      out[j] += to.x * along;
      out[3 + j] += to.y * along;
      out[6 + j] += to.z * along;
    }
  }
  return out;
}

}  // namespace pliant
