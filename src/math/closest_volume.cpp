#include "math/closest_volume.h"

#include "math/functions.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Finds the numbers v > 0 of product d > 0 that are closest to s, of which only the smallest may be negative. By
/// Lagrange v_i (v_i - s_i) = mu for all i. At most the smallest v takes the smaller root of this (second-order
/// condition), so t = v of the smallest s gives mu, and the others as the larger roots.
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

  /// The t from `low`, where the product is at most d, to `high`, where it is at least d: Newton's method, kept in the
  /// interval by bisection.
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

/// Rotates columns a and b so that they become orthogonal, and those of `axes` with them. False if they are already.
bool make_orthogonal(Vec3d (&columns)[3], Vec3d (&axes)[3], int a, int b) {
  constexpr double precision = 1e-15;
  const double aa = dot(columns[a], columns[a]), bb = dot(columns[b], columns[b]), ab = dot(columns[a], columns[b]);
  if (!(abs(ab) > precision * sqrt(aa * bb))) return false;
  const double tau = (bb - aa) / (2 * ab);
  const double t = (tau >= 0 ? 1.0 : -1.0) / (abs(tau) + sqrt(1 + tau * tau));
  const double c = 1 / sqrt(1 + t * t), s = t * c;
  for (auto* of : {&columns, &axes}) {
    const Vec3d before = (*of)[a];
    (*of)[a] = c * before - s * (*of)[b];
    (*of)[b] = s * before + c * (*of)[b];
  }
  return true;
}

Vec3d perpendicular_to(const Vec3d& v) {
  const double x = abs(v.x), y = abs(v.y), z = abs(v.z);
  const Vec3d axis = y <= x && y <= z ? Vec3d{0, 1, 0} : z <= x ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  return axis - dot(axis, v) * v;
}

/// The singular value decomposition f = sum s_k left_k right_k^T by Hestenes' one-sided method, which is exact for
/// small values too. Both bases are right-handed, and s falls; so only the last of s may be negative.
struct SingularValues {
  Vec3d left[3], right[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double s[3];

  explicit SingularValues(const Matrix3d& f) {
    Vec3d columns[3];  // f right
    for (int i = 0; i < 3; ++i) columns[i] = {f[i], f[3 + i], f[6 + i]};
    constexpr int most_sweeps = 12;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const bool first = make_orthogonal(columns, right, 0, 1), second = make_orthogonal(columns, right, 0, 2);
      if (!make_orthogonal(columns, right, 1, 2) && !first && !second) break;
    }
    for (const int k : {0, 1, 0}) sort(columns, k);
    set_left(columns);
    for (int k = 0; k < 3; ++k) s[k] = dot(left[k], columns[k]);
  }

 private:
  /// Puts the longer of two columns first, by a quarter turn.
  void sort(Vec3d (&columns)[3], int k) {
    if (!(dot(columns[k], columns[k]) < dot(columns[k + 1], columns[k + 1]))) return;
    for (auto* of : {&columns, &right}) {
      const Vec3d before = (*of)[k];
      (*of)[k] = (*of)[k + 1];
      (*of)[k + 1] = -before;
    }
  }

  void set_left(const Vec3d (&columns)[3]) {
    const double largest = length(columns[0]);
    left[0] = largest > 0 ? 1 / largest * columns[0] : Vec3d{1, 0, 0};
    left[1] = columns[1] - dot(columns[1], left[0]) * left[0];
    constexpr double least = 1e-14;
    if (!(length(left[1]) > least * largest)) left[1] = perpendicular_to(left[0]);
    left[1] = 1 / length(left[1]) * left[1];
    left[2] = cross(left[0], left[1]);
  }
};

}  // namespace

Matrix3d closest_of_determinant(const Matrix3d& f, double d) {
  const SingularValues of(f);
  const ClosestOfProduct closest(of.s[2], of.s[1], of.s[0], d);
  Matrix3d out;
  for (int k = 0; k < 3; ++k) {
    const Vec3d column = closest[2 - k] * of.left[k], &along = of.right[k];
    const double rows[3] = {column.x, column.y, column.z};
    for (int i = 0; i < 3; ++i) {
      out[3 * i] += rows[i] * along.x;
      out[3 * i + 1] += rows[i] * along.y;
      out[3 * i + 2] += rows[i] * along.z;
    }
  }
  return out;
}

}  // namespace pliant
