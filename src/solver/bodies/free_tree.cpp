#include "solver/bodies/free_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/matrix.h"
#include "math/vector.h"
#include "solver/bodies/body_math.h"
#include "solver/stencil.h"

namespace pliant {

namespace {

Vec3d times(const Symmetric& m, const Vec3d& v) {
  const auto e = [&](std::size_t i) { return static_cast<double>(m[i]); };
  return {e(0) * v.x + e(5) * v.y + e(4) * v.z, e(5) * v.x + e(1) * v.y + e(3) * v.z,
          e(4) * v.x + e(3) * v.y + e(2) * v.z};
}

/// Adds what a rotation by theta changes of the angular momentum of a particle at x that is now at y, about any point:
/// m x cross (theta cross y) = m (x.y theta - y (x.theta)).
void add_particle(double mass, const Vec3d& x, const Vec3d& y, Vec3d (&row)[3]) {
  const double along = dot(x, y);
  row[0] += (Vec3d{along, 0, 0} - x * y.x) * mass;
  row[1] += (Vec3d{0, along, 0} - x * y.y) * mass;
  row[2] += (Vec3d{0, 0, along} - x * y.z) * mass;
}

void add_inertia(const Symmetric& m, Vec3d (&row)[3]) {
  row[0] += times(m, {1, 0, 0});
  row[1] += times(m, {0, 1, 0});
  row[2] += times(m, {0, 0, 1});
}

}  // namespace

bool is_free(const JointForest& forest) {
  return std::all_of(forest.ends.begin(), forest.ends.end(),
                     [](const JointEnds& ends) { return ends.a >= 0 && ends.b >= 0; }) &&
         std::none_of(forest.bodies.begin(), forest.bodies.end(),
                      [](const JointForest::Body& body) { return body.is_held; });
}

FreeTree::FreeTree(std::vector<JointForest::Body> bodies, const SweepArguments& points, const FrameArguments& frames)
    : bodies_(std::move(bodies)), points_(points), frames_(frames) {
  std::sort(bodies_.begin(), bodies_.end(), [](const auto& a, const auto& b) { return a.point < b.point; });
  for (const JointForest::Body& body : bodies_) {
    float inertia[6], inverse[6];
    joint_formulas::turned_inertia(quaternion(frames.orientations[body.frame]),
                                   xyz(frames.inverse_inertias[body.frame]), inertia, inverse);
    std::copy_n(inertia, 6, inertias_.emplace_back().begin());
  }
  before_ = momentum();
}

Vec3d FreeTree::start_of(const JointForest::Body& body) const {
  return convert<double>(xyz(points_.positions[body.point]) - xyz(points_.positions[bodies_.front().point]));
}
Vec3d FreeTree::place_of(const JointForest::Body& body) const {
  return start_of(body) + convert<double>(xyz(points_.displacements[body.point]));
}
double FreeTree::mass_of(const JointForest::Body& body) const {
  return 1 / static_cast<double>(points_.positions[body.point].w);
}

Vec3d FreeTree::momentum() const {
  Vec3d sum{};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vec3d moved = convert<double>(xyz(points_.displacements[bodies_[i].point]));
    sum += cross(start_of(bodies_[i]), moved) * mass_of(bodies_[i]) +
           times(inertias_[i], convert<double>(xyz(frames_.corrections[bodies_[i].frame])));
  }
  return sum;
}

Vec3d FreeTree::centre() const {
  double mass = 0;
  Vec3d sum{};
  for (const JointForest::Body& body : bodies_) {
    mass += mass_of(body);
    sum += place_of(body) * mass_of(body);
  }
  return sum * (1 / mass);
}

void FreeTree::restore() const {
  const Vec3d middle = centre();
  Vec3d row[3] = {};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    add_particle(mass_of(bodies_[i]), start_of(bodies_[i]), place_of(bodies_[i]) - middle, row);
    add_inertia(inertias_[i], row);
  }
  const Vec3d theta = solve_by_cramer(row, before_ - momentum());
  if (!is_finite(theta)) return;
  for (const JointForest::Body& body : bodies_) {
    const Vec3f by = convert<float>(cross(theta, place_of(body) - middle));
    Record& d = points_.displacements[body.point];
    d = {d.x + by.x, d.y + by.y, d.z + by.z, 0};
    rotate_frame(convert<float>(theta), frames_.orientations[body.frame], frames_.corrections[body.frame]);
  }
}

}  // namespace pliant
