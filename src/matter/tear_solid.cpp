// Tears soft bodies where tetrahedra are stretched too far, as tear_surface.cpp does with triangles.
#include <algorithm>
#include <array>

#include "math/jacobi_rotation.h"
#include "matter/tears.h"

namespace pliant {

namespace {

using Tetrahedron = std::array<int, 4>;

/// A tetrahedron that is too long along a direction of the rest shape.
struct LongTetrahedron {
  double stretch = 1;
  int number = 0;
  Vec3d direction;
};

/// No eigenvalue of a symmetric matrix is greater (Wolkowicz and Styan 1980).
double upper_bound(const double (&a)[3][3]) {
  const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3;
  double squares = 2 * (a[0][1] * a[0][1] + a[1][2] * a[1][2] + a[2][0] * a[2][0]);
  for (int i = 0; i < 3; ++i) squares += (a[i][i] - mean) * (a[i][i] - mean);
  return mean + std::sqrt(squares * 2 / 3);
}

/// The greatest stretch of a tetrahedron, and its direction in the rest shape: of F^T F, F the deformation gradient. 1
/// if it is not above `enough`.
LongTetrahedron greatest_stretch(const Tetrahedron& t, const std::vector<Vec3f>& rest, std::span<const Vec3f> now,
                                 double enough) {
  const auto edges = [&](const auto& positions, Vec3d(&out)[3]) {
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = convert<double>(positions[static_cast<std::size_t>(t[i + 1])]) -
               convert<double>(positions[static_cast<std::size_t>(t[0])]);
  };
  Vec3d x[3], y[3];
  edges(rest, x);
  edges(now, y);
  const double six = dot(cross(x[0], x[1]), x[2]);
  if (std::fabs(six) < 1e-30) return {};
  const Vec3d rows[3] = {cross(x[1], x[2]) * (1 / six), cross(x[2], x[0]) * (1 / six), cross(x[0], x[1]) * (1 / six)};
  const auto column = [&](double Vec3d::*axis) {
    return y[0] * (rows[0].*axis) + y[1] * (rows[1].*axis) + y[2] * (rows[2].*axis);
  };
  const Vec3d f[3] = {column(&Vec3d::x), column(&Vec3d::y), column(&Vec3d::z)};
  Diagonal<3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.a[i][j] = dot(f[i], f[j]);
  if (upper_bound(m.a) <= enough * enough) return {};
  make_diagonal(m);
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (m.a[i][i] > m.a[largest][largest]) largest = i;
  return {std::sqrt(std::max(m.a[largest][largest], 0.)), 0, {m.v[0][largest], m.v[1][largest], m.v[2][largest]}};
}

/// Tears a soft body.
class SolidTear {
 public:
  SolidTear(const Object& object, std::span<const Vec3f> positions)
      : object_(object), positions_(positions), tetrahedra_(required_tetrahedra(object)) {}

  std::set<Face> find() {
    const std::vector<LongTetrahedron> longs = too_long();
    if (longs.empty()) return {};
    std::vector<char> at(object_.positions.size());
    for (const LongTetrahedron& one : longs)
      for (const int corner : tetrahedron(one.number)) at[static_cast<std::size_t>(corner)] = 1;
    around_ = Around(tetrahedra_, at);
    held_ = held_particles(object_);
    touched_.resize(object_.positions.size());
    on_surface_.resize(object_.positions.size());
    for (const auto& triangle : object_.triangles)
      for (const int corner : triangle) on_surface_[static_cast<std::size_t>(corner)] = 1;
    for (const LongTetrahedron& one : longs) tear(one);
    return std::move(faces_);
  }

 private:
  const Tetrahedron& tetrahedron(int t) const { return tetrahedra_[static_cast<std::size_t>(t)]; }
  std::span<const int> around(int p) const { return around_[p]; }
  static bool is_in(const std::vector<char>& set, int p) { return set[static_cast<std::size_t>(p)] != 0; }

  std::vector<LongTetrahedron> too_long() const {
    const auto limit = static_cast<double>(object_.tearing->stretch);
    std::vector<LongTetrahedron> found;
    for (int t = 0; t < static_cast<int>(tetrahedra_.size()); ++t) {
      LongTetrahedron one = greatest_stretch(tetrahedron(t), object_.positions, positions_, limit);
      one.number = t;
      if (one.stretch > limit) found.push_back(one);
    }
    std::stable_sort(found.begin(), found.end(), [](const LongTetrahedron& one, const LongTetrahedron& other) {
      return one.stretch > other.stretch;
    });
    return found;
  }

  /// Splits a corner: one that is not held, on the surface before others, so that tears begin there and run on.
  void tear(const LongTetrahedron& one) {
    Tetrahedron corners = tetrahedron(one.number);
    if (std::any_of(corners.begin(), corners.end(), [&](int p) { return is_in(touched_, p); })) return;
    std::stable_sort(corners.begin(), corners.end(),
                     [&](int a, int b) { return is_in(on_surface_, a) && !is_in(on_surface_, b); });
    for (const int corner : corners) {
      if (is_in(held_, corner)) continue;
      const std::set<Face> faces = faces_across(corner, one.direction);
      if (faces.empty()) continue;
      faces_.insert(faces.begin(), faces.end());
      for (const int t : around(corner))
        for (const int p : tetrahedron(t)) touched_[static_cast<std::size_t>(p)] = 1;
      return;
    }
  }

  /// The faces at p between tetrahedra on both sides of the plane through p, across a direction of the rest shape.
  std::set<Face> faces_across(int p, const Vec3d& direction) const {
    std::vector<Tetrahedron> near;
    std::vector<char> is_ahead;
    const Vec3d place = convert<double>(object_.positions[static_cast<std::size_t>(p)]);
    for (const int t : around(p)) {
      near.push_back(tetrahedron(t));
      Vec3d sum = place * -4.;
      for (const int corner : near.back())
        sum = sum + convert<double>(object_.positions[static_cast<std::size_t>(corner)]);
      is_ahead.push_back(dot(sum, direction) > 0 ? 1 : 0);
    }
    std::set<Face> found;
    const auto has_p = [p](const Face& face) { return std::find(face.begin(), face.end(), p) != face.end(); };
    for (const InnerFace& inner : inner_faces(near, {}, has_p))
      if (is_ahead[static_cast<std::size_t>(inner.a)] != is_ahead[static_cast<std::size_t>(inner.b)])
        found.insert(inner.face);
    return found;
  }

  const Object& object_;
  std::span<const Vec3f> positions_;
  std::vector<Tetrahedron> tetrahedra_;
  Around around_;                                  ///< tetrahedra at the corners of those that are too long
  std::vector<char> held_, touched_, on_surface_;  ///< by particle
  std::set<Face> faces_;
};

}  // namespace

std::set<Face> faces_that_tear(const Object& object, std::span<const Vec3f> positions) {
  return SolidTear(object, positions).find();
}

}  // namespace pliant
