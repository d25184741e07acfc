// Tests the direct solution of joints: chains that swing with a heavy end, trees, loops.
#include "solver/bodies/joint_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/quat.h"

namespace pliant {
namespace {

constexpr float earth_gravity = 9.81f;

BodyMass body_mass(float mass, const Symmetric& inertia) { return {mass, inertia, inverse_of(inertia)}; }

struct Link {
  Vec3d place{};
  Quatd turned{};
  Vec3f velocity{}, spin{};
  float mass = 1;
  Vec3f inertia{0.001f, 0.021f, 0.021f};  ///< a rod of 0.5 m along x
};

Quatd exponential(const Vec3d& turn) {
  const double angle = length(turn), s = angle > 1e-12 ? std::sin(angle / 2) / angle : 0.5;
  return {turn.x * s, turn.y * s, turn.z * s, std::cos(angle / 2)};
}

/// A chain of ball joints from the origin along x.
class Chain {
 public:
  static constexpr double half = 0.25;

  Chain(int links, float end_mass) : tree_(links, ends(links)) {
    for (int i = 0; i < links; ++i) {
      Link link;
      link.place = {half * (2 * i + 1), 0, 0};
      if (i == links - 1) {
        link.mass = end_mass;
        link.inertia = link.inertia * end_mass;
      }
      links_.push_back(link);
    }
  }

  void substep(float h) {
    const std::vector<Link> start = links_;
    std::vector<BodyMass> masses;
    for (Link& link : links_) {
      link.velocity.y -= h * earth_gravity;
      link.place += convert<double>(link.velocity * h);
      link.turned = normalise(multiply(exponential(convert<double>(link.spin * h)), link.turned));
      masses.push_back(mass_of(link));
    }
    std::vector<JointRows> rows;
    for (std::size_t j = 0; j < links_.size(); ++j) rows.push_back(rows_of(j, start));
    std::vector<BodyCorrection> corrections;
    tree_.solve(masses, rows, corrections);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Link& link = links_[i];
      const auto& [displacement, rotation] = corrections[i];
      link.place += convert<double>(displacement);
      link.turned = normalise(multiply(exponential(convert<double>(rotation)), link.turned));
      link.velocity += displacement * (1 / h);
      link.spin += rotation * (1 / h);
    }
  }

  const std::vector<Link>& links() const { return links_; }

  /// The largest gap of a joint [m].
  double drift() const {
    double most = 0;
    for (std::size_t j = 0; j < links_.size(); ++j) most = std::max(most, length(gap(j)));
    return most;
  }

  double energy() const {
    double sum = 0;
    for (const Link& link : links_) {
      const Vec3d local = rotate(conjugate(link.turned), convert<double>(link.spin)), i = convert<double>(link.inertia);
      sum += 0.5 * double(link.mass) * double(length_squared(link.velocity)) +
             double(link.mass) * double(earth_gravity) * link.place.y +
             0.5 * (i.x * local.x * local.x + i.y * local.y * local.y + i.z * local.z * local.z);
    }
    return sum;
  }

  /// The energy that all weight could gain by falling a chain's length.
  double scale() const {
    double sum = 0;
    for (const Link& link : links_) sum += double(link.mass) * double(earth_gravity);
    return sum * 2 * half * static_cast<double>(links_.size());
  }

 private:
  static std::vector<JointEnds> ends(int links) {
    std::vector<JointEnds> out;
    for (int i = 0; i < links; ++i) out.push_back({i - 1, i});
    return out;
  }

  static BodyMass mass_of(const Link& link) {
    const Vec3d x = rotate(link.turned, Vec3d{1, 0, 0}), y = rotate(link.turned, Vec3d{0, 1, 0}),
                z = rotate(link.turned, Vec3d{0, 0, 1});
    const Vec3d i = convert<double>(link.inertia);
    const auto element = [&](double Vec3d::*r, double Vec3d::*c) {
      return static_cast<float>(i.x * x.*r * x.*c + i.y * y.*r * y.*c + i.z * z.*r * z.*c);
    };
    return body_mass(link.mass,
                     {element(&Vec3d::x, &Vec3d::x), element(&Vec3d::y, &Vec3d::y), element(&Vec3d::z, &Vec3d::z),
                      element(&Vec3d::y, &Vec3d::z), element(&Vec3d::z, &Vec3d::x), element(&Vec3d::x, &Vec3d::y)});
  }

  Vec3d gap(std::size_t j) const {
    const Vec3d at_b = links_[j].place + rotate(links_[j].turned, Vec3d{-half, 0, 0});
    if (j == 0) return at_b;
    return at_b - links_[j - 1].place - rotate(links_[j - 1].turned, Vec3d{half, 0, 0});
  }

  /// C of the end, gradients of the start, which keep energy (SHAKE, Ryckaert 1977).
  JointRows rows_of(std::size_t j, const std::vector<Link>& start) const {
    JointRows out;
    out.rows = 3;
    const Vec3f apart = convert<float>(gap(j));
    out.value = {apart.x, apart.y, apart.z};
    const Vec3f arm_b = convert<float>(rotate(start[j].turned, Vec3d{-half, 0, 0}));
    const Vec3f arm_a = j == 0 ? Vec3f{} : convert<float>(rotate(start[j - 1].turned, Vec3d{half, 0, 0}));
    const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t r = 0; r < 3; ++r) {
      out.of_b[r] = {axes[r], cross(arm_b, axes[r])};
      out.of_a[r] = {-axes[r], -cross(arm_a, axes[r])};
    }
    return out;
  }

  std::vector<Link> links_;
  JointTree tree_;
};

TEST(JointTree, AHeavyEndOnALongChainKeepsJointsAndEnergy) {
  Chain chain(100, 100);
  const double start = chain.energy(), scale = chain.scale();
  double drift = 0, highest = start;
  for (int frame = 0; frame < 600; ++frame) {
    for (int substep = 0; substep < 4; ++substep) chain.substep(1.f / 240);
    drift = std::max(drift, chain.drift());
    highest = std::max(highest, chain.energy());
  }
  EXPECT_LT(drift, 3e-5);
  EXPECT_LT((highest - start) / scale, 1e-3);
  EXPECT_GT((chain.energy() - start) / scale, -0.01);
  RecordProperty("drift", std::to_string(drift));
}

/// One link lets go from horizontal: a compound pendulum, T = 1.18034 x 2 pi sqrt((I + m r^2) / (m g r)) for swings of
/// 90 degrees.
TEST(JointTree, OneLinkSwingsAsACompoundPendulum) {
  Chain chain(1, 1);
  const double period = 1.18034 * 2 * std::acos(-1) * std::sqrt((0.021 + 0.0625) / (double(earth_gravity) * 0.25));
  const float h = 1.f / 2400;
  const double start = chain.energy();
  int substeps = 0, passages = 0;
  double x = 1, highest = start;
  while (passages < 8 && substeps < 48000) {
    chain.substep(h);
    ++substeps;
    highest = std::max(highest, chain.energy());
    const double now = chain.links().front().place.x;
    passages += (now > 0) != (x > 0) ? 1 : 0;
    x = now;
  }
  EXPECT_NEAR(substeps * double(h), 3.75 * period,
              0.005 * 3.75 * period);  // the eighth passage below is after 15 quarters
  EXPECT_LT(highest - start, 1e-3 * chain.scale());
  EXPECT_GT(chain.energy() - start, -1e-3 * chain.scale());
}

/// Three links of a triangle: two joints are a tree, the third closes the loop.
TEST(JointTree, LoopsAreLeftLoose) {
  EXPECT_EQ(JointTree(3, {{0, 1}, {1, 2}, {2, 0}}).loose(), std::vector<int>{2});
  EXPECT_EQ(JointTree(3, {{0, 1}, {1, 2}, {-1, 0}, {2, -1}}).loose(), std::vector<int>{})
      << "the ground closes no loop";
  EXPECT_EQ(JointTree(2, {{0, 1}, {-1, 0}, {-1, 0}}).loose(), std::vector<int>{2});
  EXPECT_EQ(JointTree(2, {{0, 0}, {-1, -1}, {0, 1}}).loose(), (std::vector<int>{0, 1}));
  EXPECT_EQ(JointTree(2, {{0, 1}, {1, 0}}).loose(), std::vector<int>{1});
}

constexpr std::array<Vec3f, 3> unit_axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

JointRows ball_joint(const Vec3f& value, const Vec3f& arm_a, const Vec3f& arm_b) {
  JointRows joint;
  joint.rows = 3;
  joint.value = {value.x, value.y, value.z};
  for (std::size_t r = 0; r < 3; ++r) {
    joint.of_b[r] = {unit_axes[r], cross(arm_b, unit_axes[r])};
    joint.of_a[r] = {-unit_axes[r], -cross(arm_a, unit_axes[r])};
  }
  return joint;
}

/// By how much the corrections miss what each row demands, at most.
float largest_miss(const std::vector<JointEnds>& ends, const std::vector<JointRows>& rows,
                   const std::vector<BodyCorrection>& moved) {
  float most = 0;
  const auto change = [&](const std::array<Vec3f, 2>& gradient, int body) {
    if (body < 0) return 0.f;
    const BodyCorrection& by = moved[std::size_t(body)];
    return dot(gradient[0], by.displacement) + dot(gradient[1], by.rotation);
  };
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (std::size_t r = 0; r < 3; ++r)
      most = std::max(
          most, std::fabs(change(rows[j].of_a[r], ends[j].a) + change(rows[j].of_b[r], ends[j].b) + rows[j].value[r]));
  return most;
}

/// Of a star of bodies about one, momentum is kept, and every joint is satisfied.
TEST(JointTree, AStarIsSolvedAtOnce) {
  std::vector<JointEnds> ends;
  std::vector<BodyMass> masses;
  std::vector<JointRows> rows;
  for (int i = 0; i < 9; ++i) masses.push_back(body_mass(1.f + float(i), {0.1f, 0.2f, 0.3f, 0.01f, 0, 0.02f}));
  for (int i = 1; i < 9; ++i) {
    ends.push_back(i % 2 == 0 ? JointEnds{0, i} : JointEnds{i, 0});
    rows.push_back(ball_joint({0.01f * float(i), -0.02f, 0.005f}, {0.3f, 0.1f * float(i), 0}, {-0.2f, 0, 0.1f}));
  }
  std::vector<BodyCorrection> moved;
  JointTree(9, ends).solve(masses, rows, moved);
  Vec3f momentum{};
  for (std::size_t i = 0; i < 9; ++i) momentum += moved[i].displacement * masses[i].mass;
  EXPECT_LT(length(momentum), 1e-6f);
  EXPECT_LT(largest_miss(ends, rows, moved), 1e-6f);
}

/// Five planks that sag between two fixed ends: joints with the ground stand at both ends, in either order.
TEST(JointTree, ABridgeIsSolvedAtOnce) {
  const std::vector<JointEnds> ends{{-1, 0}, {0, 1}, {2, 1}, {2, 3}, {3, 4}, {4, -1}};
  std::vector<JointRows> rows;
  for (const auto& [a, b] :
       ends) {  // plank i descends by 0.1 (2 - i) from its left end to its middle, so that they sag
    const auto arm = [](int body, float side) { return Vec3f{0.25f * side, 0.1f * float(body - 2) * side, 0}; };
    rows.push_back(
        ball_joint({0.01f, 0.02f * float(a), -0.01f}, arm(a, a < b || b < 0 ? 1 : -1), arm(b, b < a ? 1 : -1)));
  }
  const std::vector<BodyMass> masses(5, body_mass(2, {0.01f, 0.1f, 0.1f, 0, 0, 0}));
  std::vector<BodyCorrection> moved;
  std::vector<std::array<float, most_joint_rows>> multipliers;
  JointTree(5, ends).solve(masses, rows, moved, &multipliers);
  EXPECT_LT(largest_miss(ends, rows, moved), 2e-4f) << "of gaps up to 0.1: joints between fixed ends yield a little";
  Vec3f sum{}, momentum{};  // what the ends push is what the planks gain
  for (std::size_t r = 0; r < 3; ++r) sum -= unit_axes[r] * (multipliers[0][r] - multipliers[5][r]);
  for (const BodyCorrection& one : moved) momentum += one.displacement * 2.f;
  EXPECT_LT(length(sum - momentum), 1e-4f);
}

}  // namespace
}  // namespace pliant
