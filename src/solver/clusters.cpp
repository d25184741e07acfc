#include "solver/clusters.h"

#include <algorithm>
#include <array>

#include "math/best_rotation.h"
#include "math/closest_volume.h"
#include "model/cluster_moments.h"
#include "solver/damper.h"

namespace pliant {

namespace {

/// Positions relative to a cluster's first particle, so that rounding does not grow with the distance from the origin.
struct ClusterPlaces {
  const Record* positions;
  const Record* displacements;
  int origin;
  Vec3d at(int particle) const {
    const Record &p = positions[particle], &o = positions[origin], &d = displacements[particle];
    return {(double(p.x) - o.x) + d.x, (double(p.y) - o.y) + d.y, (double(p.z) - o.z) + d.z};
  }
};

/// The goal of a rest place: centre + deformation q.
struct Fit {
  Vec3d centre{};
  Quatd turn{};
  double deformation[3][most_moments] = {};
  int moments = 3;

  Vec3d goal(const Vec3d& rest, const std::array<double, 6>& means) const {
    const std::array<double, most_moments> q = moments_at(rest, means);
    double out[3] = {centre.x, centre.y, centre.z};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < moments; ++k) out[i] += deformation[i][k] * q[k];
    return {out[0], out[1], out[2]};
  }
};

/// Replaces the linear part of a deformation, which is given in an orthonormal basis, by the closest one with the
/// volume of the rest shape. The closest, so that the pull to it is the gradient of half the squared distance and makes
/// no energy.
void keep_volume(double (&fitted)[3][most_moments], const double* basis, int n, double size) {
  Matrix3d linear;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) linear[3 * i + j] = fitted[i][j] / size;
  linear = closest_of_determinant(linear, 1 / (basis[0] * basis[n + 1] * basis[2 * n + 2]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) fitted[i][j] = linear[3 * i + j] * size;
}

/// Adds `share` of the fitted deformation to (1 - share) of the rotation that `fit` has.
void add_deformation(const CompiledCluster& cluster, const double* basis, const double (&sums)[3][most_moments],
                     Fit& fit) {
  const int n = moments_of(cluster.mode);
  double fitted[3][most_moments] = {};  // sums basis^T
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k <= j; ++k) fitted[i][j] += sums[i][k] * basis[j * n + k];
  if (!cluster.is_flat) keep_volume(fitted, basis, n, cluster.size);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) fit.deformation[i][j] *= 1 - cluster.share;
    for (int j = 0; j < n; ++j)
      for (int k = 0; k <= j; ++k) fit.deformation[i][k] += cluster.share * fitted[i][j] * basis[j * n + k];
  }
  fit.moments = n;
}

Fit fit(const CompiledClusters& clusters, const CompiledCluster& cluster, const ClusterPlaces& places) {
  Fit out;
  for (int m = cluster.first; m < cluster.last; ++m)
    out.centre += clusters.members[m].weight * places.at(clusters.members[m].particle);
  const int n = cluster.mode == Cluster::Mode::quadratic ? most_moments : 3;
  double sums[3][most_moments] = {};  // of w (x - c) q^T
  for (int m = cluster.first; m < cluster.last; ++m) {
    const ClusterMember& member = clusters.members[m];
    const Vec3d r = member.weight * (places.at(member.particle) - out.centre);
    const std::array<double, most_moments> q = moments_at(member.rest, cluster.means);
    for (int k = 0; k < n; ++k) {
      sums[0][k] += r.x * q[k];
      sums[1][k] += r.y * q[k];
      sums[2][k] += r.z * q[k];
    }
  }
  out.turn = best_rotation(
      {sums[0][0], sums[0][1], sums[0][2], sums[1][0], sums[1][1], sums[1][2], sums[2][0], sums[2][1], sums[2][2]});
  const Vec3d axes[3] = {rotate(out.turn, Vec3d{1, 0, 0}), rotate(out.turn, Vec3d{0, 1, 0}),
                         rotate(out.turn, Vec3d{0, 0, 1})};
  for (int j = 0; j < 3; ++j) {
    out.deformation[0][j] = cluster.size * axes[j].x;
    out.deformation[1][j] = cluster.size * axes[j].y;
    out.deformation[2][j] = cluster.size * axes[j].z;
  }
  if (cluster.mode != Cluster::Mode::rigid) add_deformation(cluster, clusters.bases.data() + cluster.basis, sums, out);
  return out;
}

Vec3d vector(const Vec3f& v) { return convert<double>(v); }

/// How an error C = x - goal becomes a correction: XPBD with masses cancelled, or a share of it.
struct Yield {
  double compliance = 0, gamma = 0, scale = 1;

  Yield(const CompiledCluster& cluster, const SweepArguments& a) {
    if (cluster.law == Law::pbd) {
      scale = cluster.response;
      return;
    }
    compliance = min(cluster.response * a.inverse_h2, 1e30);
    set_damping(viscous_share(min(cluster.response * cluster.damping * a.inverse_h, 1e30)));
  }

  void set_damping(double value) {
    gamma = value;
    scale = 1 / (1 + gamma + compliance);
  }
};

/// A cluster in a substep. Corrections are zero to first order in the torque about the positions at the substep's
/// start, as the velocities that they change act there: with the torque about the prediction alone, which the rotation
/// makes zero, a spin would decay by omega^2 h.
class Projection {
 public:
  Projection(const CompiledClusters& clusters, const CompiledCluster& cluster, const SweepArguments& a,
             const Vec3f* multipliers)
      : clusters_(clusters),
        cluster_(cluster),
        yield_(cluster, a),
        multipliers_(multipliers),
        places_{a.positions, a.displacements, clusters.members[cluster.first].particle},
        starts_{a.positions, a.remainders, clusters.members[cluster.first].particle},
        now_(fit(clusters, cluster, places_)) {
    if (yield_.gamma > 0) before_ = fit(clusters, cluster, starts_);
    turn_ = multiply(now_.turn, conjugate(before_.turn));
    if (yield_.gamma > 0 && cluster.mode != Cluster::Mode::rigid && !damping_takes_energy()) yield_.set_damping(0);
    settle();
  }

  Vec3d correction(int member) const {
    const Vec3d arm = turns_goals_ ? goal(now_, member) - now_.centre : start(member);
    return -yield_.scale * (pull(member) - (1 + yield_.gamma) * cross(settle_, arm));
  }

 private:
  Vec3d goal(const Fit& fit, int member) const { return fit.goal(clusters_.members[member].rest, cluster_.means); }

  /// (1 + gamma) C + compliance lambda - gamma C at the start, which has turned with the cluster since.
  Vec3d pull(int member) const {
    const int particle = clusters_.members[member].particle;
    const Vec3d c = places_.at(particle) - goal(now_, member);
    Vec3d sum = (1 + yield_.gamma) * c;
    if (multipliers_ != nullptr) sum += yield_.compliance * vector(multipliers_[member]);
    if (yield_.gamma > 0) sum -= yield_.gamma * rotate(turn_, starts_.at(particle) - goal(before_, member));
    return sum;
  }

  /// Where a deformation is large, C can fall while its particles depart, and damping of C would push them on.
  bool damping_takes_energy() const {
    double power = 0;
    for (int m = cluster_.first; m < cluster_.last; ++m) {
      const ClusterMember& member = clusters_.members[m];
      const Vec3d now = places_.at(member.particle), before = starts_.at(member.particle);
      const Vec3d motion = now - now_.centre - rotate(turn_, before - before_.centre);
      const Vec3d goals = goal(now_, m) - now_.centre - rotate(turn_, goal(before_, m) - before_.centre);
      power += member.weight * dot(motion, motion - goals);
    }
    return power >= 0;
  }

  Vec3d start(int member) const { return starts_.at(clusters_.members[member].particle) - start_centre_; }

  /// Finds what makes corrections free of torque about the start: a small rotation of all goals. Where none does,
  /// because the shape is far from its goals (mirrored, say), the closest torque-free corrections: those less a
  /// rotation of the start.
  void settle() {
    constexpr double largest = 0.2;  // [rad]
    if (find_settle(1e-9 * cluster_.size * cluster_.size) && dot(settle_, settle_) < largest * largest) return;
    turns_goals_ = false;
    start_centre_ = {};
    for (int m = cluster_.first; m < cluster_.last; ++m)
      start_centre_ += clusters_.members[m].weight * starts_.at(clusters_.members[m].particle);
    find_settle(0);
  }

  /// Sets settle_ = d so that d cross the arms have the torque of the pulls. False, and zero, where the arms have less
  /// than the least moment.
  bool find_settle(double least) {
    Vec3d torque{};
    double rows[3][3] = {};
    for (int m = cluster_.first; m < cluster_.last; ++m) {
      const ClusterMember& member = clusters_.members[m];
      const Vec3d x = turns_goals_ ? starts_.at(member.particle) - now_.centre : start(m);
      const Vec3d g = turns_goals_ ? goal(now_, m) - now_.centre : x;
      torque += member.weight * cross(x, pull(m));
      const double along = member.weight * dot(x, g), xs[3] = {x.x, x.y, x.z}, gs[3] = {g.x, g.y, g.z};
      for (int i = 0; i < 3; ++i)  // x cross (d cross g) = (x . g) d - (x . d) g
        for (int j = 0; j < 3; ++j) rows[i][j] += (i == j ? along : 0) - member.weight * gs[i] * xs[j];
    }
    return solve(rows, (1 / (1 + yield_.gamma)) * torque, least);
  }

  bool solve(double (&m)[3][3], const Vec3d& b, double least) {
    settle_ = {};
    const double trace = m[0][0] + m[1][1] + m[2][2];
    if (!(trace > least)) return false;
    for (int i = 0; i < 3; ++i) m[i][i] += 1e-9 * trace;
    const Vec3d x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
    const double volume = dot(x, cross(y, z)), whole = trace * trace * trace;
    constexpr double thinnest = 1e-12;  // of the matrix
    if (!(volume > thinnest * whole)) return false;
    settle_ = (1 / volume) * Vec3d{dot(b, cross(y, z)), dot(x, cross(b, z)), dot(x, cross(y, b))};
    return true;
  }

  const CompiledClusters& clusters_;
  const CompiledCluster& cluster_;
  Yield yield_;
  const Vec3f* multipliers_;
  ClusterPlaces places_, starts_;
  Fit now_, before_;
  Quatd turn_;
  Vec3d settle_{}, start_centre_{};
  bool turns_goals_ = true;
};

}  // namespace

void project_cluster(const CompiledClusters& clusters, int number, const SweepArguments& a, Vec3f* multipliers) {
  const CompiledCluster& cluster = clusters.clusters[number];
  if (multipliers != nullptr && a.first_pass)
    std::fill(multipliers + cluster.first, multipliers + cluster.last, Vec3f{});
  const Projection projection(clusters, cluster, a, multipliers);
  for (int m = cluster.first; m < cluster.last; ++m) {
    const int particle = clusters.members[m].particle;
    if (!(a.positions[particle].w > 0)) continue;
    const Vec3d move = double(a.relaxation) * projection.correction(m);
    if (multipliers != nullptr) multipliers[m] += convert<float>(move);
    Record& d = a.displacements[particle];
    d = {d.x + float(move.x), d.y + float(move.y), d.z + float(move.z), 0};
  }
}

}  // namespace pliant
