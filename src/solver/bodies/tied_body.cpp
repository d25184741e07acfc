#include "solver/bodies/tied_body.h"

#include <cmath>

#include "solver/bodies/body_math.h"
#include "solver/project.h"
#include "solver/stencil.h"
#include "solver/visit.h"

namespace pliant {

namespace {

constexpr int freedoms = 6;
/// Smallest inverse mass of a tie's particle, as a share of the body's there: particles that are fixed would
/// overdetermine the body.
constexpr double least_yield = 1e-7;

/// The body at the start of the projection.
struct Body {
  const Record& position;
  Vec3f displacement{}, motion{}, turned{};  ///< motion and rotation since the substep's start, in the world
  Quatf orientation{};
  float inverse_mass = 0;
  Vec3f inverse_inertia{};

  Body(const CompiledObject& object, const SweepArguments& a, const FrameArguments& f, const std::int32_t* number)
      : position(a.positions[number[0]]) {
    const std::int32_t frame = number[1] - object.particles;
    displacement = xyz(a.displacements[number[0]]);
    motion = displacement - xyz(a.remainders[number[0]]);
    turned = xyz(f.predicted[frame]) + xyz(f.corrections[frame]);
    orientation = quaternion(f.orientations[frame]);
    inverse_mass = position.w;
    inverse_inertia = xyz(f.inverse_inertias[frame]);
  }
};

/// One tie in the body's axes. In double: between fixed particles the system's largest and smallest pivots are 1e7 and
/// more apart.
struct Tie {
  Vec3d arm{}, rhs{};    ///< [m]
  double stiffness = 0;  ///< 1 / (w + a) [kg]
  float inverse_mass = 0;
};

/// The inverse mass of a place of a body, summed over three directions.
double mobility(const Body& body, const Vec3d& a) {
  const Vec3d i = convert<double>(body.inverse_inertia);
  return 3 * static_cast<double>(body.inverse_mass) + i.x * (a.y * a.y + a.z * a.z) + i.y * (a.x * a.x + a.z * a.z) +
         i.z * (a.x * a.x + a.y * a.y);
}

Tie tie_of(const ConstraintPlace& at, const std::int32_t* number, const SweepArguments& a, const Body& body,
           const float* multipliers) {
  const Pool& pool = at.pool;
  const Record &p = a.positions[number[2]], &d = a.displacements[number[2]], &r = a.remainders[number[2]];
  const Vec3f arm{at.value(0), at.value(1), at.value(2)}, outward = rotate(body.orientation, arm);
  const Vec3f apart{((p.x - body.position.x) + d.x) - body.displacement.x,
                    ((p.y - body.position.y) + d.y) - body.displacement.y,
                    ((p.z - body.position.z) + d.z) - body.displacement.z};
  const auto [compliance, damping] = yielding_of(at, a);
  const float gamma = viscous_share(damping);
  Vec3f rhs = outward - apart;
  if (pool.law == Law::pbd) rhs = rhs * at.value(pool.fields);
  if (multipliers != nullptr && !a.first_pass)
    rhs = rhs - Vec3f{multipliers[0], multipliers[batch_width], multipliers[2 * batch_width]} * compliance;
  const Vec3f motion = xyz(d) - xyz(r) - body.motion - cross(body.turned, outward);
  if (pool.law == Law::damped) rhs = rhs - motion * gamma;
  const float damped = 1 + gamma;
  const Vec3d place = convert<double>(arm);
  const double yield = static_cast<double>(p.w) + static_cast<double>(compliance) / static_cast<double>(damped);
  const double least = max(least_yield * mobility(body, place), static_cast<double>(smallest_denominator));
  return {place, convert<double>(rotate(conjugate(body.orientation), rhs * (1 / damped))), 1 / max(yield, least), p.w};
}

/// The symmetric system in the body's scaled motion.
class LinearSystem {
 public:
  explicit LinearSystem(const Body& body) : root_(std::sqrt(static_cast<double>(body.inverse_mass))) {
    const Vec3d i = convert<double>(body.inverse_inertia);
    roots_ = {std::sqrt(i.x), std::sqrt(i.y), std::sqrt(i.z)};
  }

  void add(const Tie& tie) {
    const Vec3d &a = tie.arm, pull = tie.rhs * tie.stiffness;
    const double s = tie.stiffness;
    sum_ = sum_ + s;
    moment_ += a * s;
    squares_ += Vec3d{a.y * a.y + a.z * a.z, a.x * a.x + a.z * a.z, a.x * a.x + a.y * a.y} * s;
    products_ += Vec3d{a.y * a.z, a.x * a.z, a.x * a.y} * s;
    force_ += pull;
    torque_ += cross(a, pull);
  }

  /// The body's motion in its own axes.
  void solve(Vec3d& move, Vec3d& turn) {
    fill();
    factor_and_substitute();
    move = Vec3d{x_[0], x_[1], x_[2]} * root_;
    turn = {x_[3] * roots_.x, x_[4] * roots_.y, x_[5] * roots_.z};
  }

 private:
  void fill() {
    const double g[3] = {roots_.x, roots_.y, roots_.z};
    const double square[3] = {squares_.x, squares_.y, squares_.z};
    const double force[3] = {force_.x, force_.y, force_.z}, torque[3] = {torque_.x, torque_.y, torque_.z};
    for (int i = 0; i < 3; ++i) {
      m_[i][i] = 1 + root_ * root_ * sum_;
      m_[3 + i][3 + i] = 1 + g[i] * g[i] * square[i];
      x_[i] = -root_ * force[i];
      x_[3 + i] = -g[i] * torque[i];
    }
    m_[4][3] = -g[1] * g[0] * products_.z;
    m_[5][3] = -g[2] * g[0] * products_.y;
    m_[5][4] = -g[2] * g[1] * products_.x;
    // Rows of moment x d: the torque of a translation.
    const double across[3][3] = {{0, -moment_.z, moment_.y}, {moment_.z, 0, -moment_.x}, {-moment_.y, moment_.x, 0}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m_[3 + i][j] = g[i] * root_ * across[i][j];
  }

  /// L D L^T; the diagonal is at least about 1.
  void factor_and_substitute() {
    for (int i = 0; i < freedoms; ++i) {
      for (int j = 0; j <= i; ++j) {
        double left = m_[i][j];
        for (int k = 0; k < j; ++k) left = left - m_[i][k] * m_[k][k] * m_[j][k];
        m_[i][j] = i == j ? max(left, 1.) : left / m_[j][j];
      }
      for (int j = 0; j < i; ++j) x_[i] = x_[i] - m_[i][j] * x_[j];
    }
    for (int i = 0; i < freedoms; ++i) x_[i] = x_[i] / m_[i][i];
    for (int i = freedoms; i-- > 0;)
      for (int j = i + 1; j < freedoms; ++j) x_[i] = x_[i] - m_[j][i] * x_[j];
  }

  double root_;
  Vec3d roots_;
  double sum_ = 0;
  Vec3d moment_{}, squares_{}, products_{}, force_{}, torque_{};
  double m_[freedoms][freedoms] = {}, x_[freedoms] = {};
};

/// Keeps the multipliers of one tie for the substep's next pass.
void keep(const Vec3f& change, bool first_pass, float* multipliers) {
  const float of[3] = {change.x, change.y, change.z};
  for (int row = 0; row < 3; ++row) {
    float& multiplier = multipliers[row * batch_width];
    multiplier = (first_pass ? 0.f : multiplier) + of[row];
  }
}

}  // namespace

void project_tied_body(const CompiledObject& object, const Segment& segment, const SweepArguments& points,
                       const FrameArguments& frames) {
  const Pool& pool = object.pools[segment.pool];
  float* all = points.multipliers != nullptr && pool.law != Law::pbd ? points.multipliers[segment.pool] : nullptr;
  const char* skipped = points.skipped != nullptr ? points.skipped[segment.pool] : nullptr;
  const std::int32_t* first = pool.indices.data() + segment.index_offset;
  const std::int32_t of_body[2] = {particle_of(segment, first, 0, 0), particle_of(segment, first, 1, 0)};
  const Body body(object, points, frames, of_body);
  const auto for_ties = [&](const auto& visit) {
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      if (skipped != nullptr && skipped[at.batch * batch_width + at.lane] != 0) return;
      float* multipliers = all == nullptr ? nullptr : all + at.multiplier_place(0);
      visit(tie_of(at, number, points, body, multipliers), number[2], multipliers);
    });
  };
  LinearSystem system(body);
  for_ties([&](const Tie& tie, std::int32_t, float*) { system.add(tie); });
  Vec3d move{}, turn{};
  system.solve(move, turn);
  for_ties([&](const Tie& tie, std::int32_t particle, float* multipliers) {
    const Vec3d local = (tie.rhs + move + cross(turn, tie.arm)) * tie.stiffness;
    const Vec3f change = rotate(body.orientation, convert<float>(local) * points.relaxation);
    if (multipliers != nullptr) keep(change, points.first_pass, multipliers);
    Record& d = points.displacements[particle];
    d = plus(d, change * tie.inverse_mass);
  });
  const std::int32_t frame = of_body[1] - object.particles;
  Record& d = points.displacements[of_body[0]];
  d = plus(d, rotate(body.orientation, convert<float>(move) * points.relaxation));
  rotate_frame(rotate(body.orientation, convert<float>(turn) * points.relaxation), frames.orientations[frame],
               frames.corrections[frame]);
}

}  // namespace pliant
