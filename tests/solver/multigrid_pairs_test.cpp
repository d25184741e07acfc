// Objects that contacts join, corrected as one: against elimination of their dense matrix in double.
#include "solver/multigrid_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Two sheets of which the upper falls on the lower, off the grid's places; both touch in many contacts.
std::vector<Object> two_sheets() {
  std::vector<Object> sheets{crumpled(9, 9, 2), crumpled(7, 8, 3)};
  for (Vec3f& p : sheets[1].positions) p = p * 0.6f + Vec3f{0.031f, 0.06f, 0.017f};
  for (std::size_t o = 0; o < 2; ++o) {
    const int columns = o == 0 ? 9 : 7, rows = o == 0 ? 9 : 8;
    sheets[o].triangles = grid_mesh(columns, rows, 1, 1).triangles;
    sheets[o].collides = true;
    sheets[o].thickness = 0.03f;
    sheets[o].static_friction = sheets[o].kinetic_friction = 0.4f;
    sheets[o].velocities.assign(sheets[o].positions.size(), o == 0 ? Vec3f{0.5f, 2, 0} : Vec3f{-1, -6, 0.5f});
  }
  return sheets;
}

/// Both objects' dense systems in one, and the springs of their contacts.
System dense_system_of(const std::vector<Object>& objects, const Corrected& found) {
  System joint;
  std::vector<std::size_t> first;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    Linearised of(objects[o]);
    const auto begin = found.predicted.begin() + found.model.first[o],
               end = found.predicted.begin() + found.model.first[o + 1];
    of.displacements.assign(begin, end);
    System one = dense_system(of);
    hold(of, one);
    first.push_back(joint.b.size());
    for (Vector& row : joint.a) row.resize(joint.b.size() + one.b.size());
    for (const Vector& row : one.a) {
      Vector wide(first.back(), 0);
      wide.insert(wide.end(), row.begin(), row.end());
      joint.a.push_back(wide);
    }
    joint.b.insert(joint.b.end(), one.b.begin(), one.b.end());
  }
  for (const PairSpring& s : found.workspace.sweep.pair_springs) {
    const double n[3] = {s.normal.x, s.normal.y, s.normal.z}, slip[3] = {s.slip.x, s.slip.y, s.slip.z};
    const auto row = [&](std::size_t i, std::size_t c) {
      return first[std::size_t(s.object[i])] + 3 * std::size_t(s.particle[i]) + c;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      if (s.object[i] < 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        joint.b[row(i, c)] +=
            double(s.weight[i]) * (-double(s.along) * double(s.depth) * n[c] - double(s.across) * slip[c]);
        for (std::size_t j = 0; j < 4; ++j) {
          if (s.object[j] < 0) continue;
          for (std::size_t d = 0; d < 3; ++d)
            joint.a[row(i, c)][row(j, d)] += double(s.weight[i]) * double(s.weight[j]) *
                                             (double(s.along - s.across) * n[c] * n[d] + (c == d ? double(s.across) : 0));
        }
      }
    }
  }
  return joint;
}

TEST(MultigridPairs, AreSolvedWithTheirObjectsAsOne) {
  const std::vector<Object> sheets = two_sheets();
  const Corrected found(sheets, 100);
  ASSERT_GT(found.workspace.sweep.pair_springs.size(), 20u);
  const System joint = dense_system_of(sheets, found);
  EXPECT_LT(error_of(found.change(), eliminate(joint.a, joint.b)), 1e-3);
}

/// What a contact's springs did is kept as its push and friction, for the projection to go on from: the force times w h^2.
TEST(MultigridPairs, KeepTheirForcesAsPushes) {
  const Corrected found(two_sheets(), 100);
  const std::vector<PairContact>& contacts = found.workspace.pairs->contacts();
  double pushed = 0, expected = 0;
  for (const PairSpring& s : found.workspace.sweep.pair_springs) {
    const PairContact& contact = contacts[std::size_t(s.contact)];
    double apart = double(contact.gap) - double(contact.thickness), mobility = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t v = std::size_t(contact.vertex[i]);
      const Record& d = found.workspace.displacements[v];
      apart +=
          double(contact.weight[i]) * dot(convert<double>(contact.normal), Vec3d{double(d.x), double(d.y), double(d.z)});
      mobility += double(found.state.positions[v].w) * double(contact.weight[i]) * double(contact.weight[i]);
    }
    pushed += double(contact.push);
    expected += std::max(0., -apart * double(s.along) * mobility / double(inverse_h2));
    EXPECT_LE(length(contact.friction), 1.001f * contact.kinetic_friction * -s.depth);
  }
  EXPECT_GT(pushed, 0);
  EXPECT_NEAR(pushed, expected, 1e-3 * expected);
}

}  // namespace
}  // namespace pliant
