// Tests the correction of objects that contacts connect: compared with elimination of their dense matrix in double.
#include "solver/multigrid_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Two sheets, the upper one falling on the lower, displaced against its grid; they have many contacts.
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

Vec3f at(const Record& r) { return {r.x, r.y, r.z}; }

/// The dense matrices of both objects as one, with the springs of their contacts.
LinearSystem dense_system_of(const std::vector<Object>& objects, const Corrected& found) {
  LinearSystem joint;
  std::vector<std::size_t> first;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    Linearised of(objects[o]);
    const auto begin = found.predicted.begin() + found.model.first[o],
               end = found.predicted.begin() + found.model.end_of(static_cast<int>(o));
    of.displacements.assign(begin, end);
    LinearSystem one = dense_system(of);
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
  for (const PairSpring& s : found.springs()) {
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
            joint.a[row(i, c)][row(j, d)] +=
                double(s.weight[i]) * double(s.weight[j]) *
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
  ASSERT_GT(found.springs().size(), 20u);
  const LinearSystem joint = dense_system_of(sheets, found);
  EXPECT_LT(error_of(found.change(), eliminate(joint.a, joint.b)), 1e-3);
}

/// After few cycles the springs still overlap, and seem to push with forces that no particle has felt. So the
/// projection of contacts starts from zero.
TEST(MultigridPairs, HandNoForcesToTheProjection) {
  const Corrected found(two_sheets(), 2);
  ASSERT_GT(found.springs().size(), 20u);
  for (const Contact& contact : found.workspace.pairs->contacts()) {
    EXPECT_EQ(contact.push, 0);
    EXPECT_EQ(length(contact.friction), 0);
  }
}

/// The residual r acts like an outside force -r. Its work on the motion since the substep's start, less the mean motion
/// of each sheet, must not be positive.
TEST(MultigridPairs, LeaveAResidualThatFeedsNoEnergy) {
  const std::vector<Object> sheets = two_sheets();
  for (const int cycles : {1, 2, 3}) {
    const Corrected found(sheets, cycles);
    const LinearSystem joint = dense_system_of(sheets, found);
    const Vector change = found.change(), image = times(joint.a, change);
    double work = 0, size = 0;
    for (std::size_t o = 0; o < 2; ++o) {
      Vec3d moment{};
      double mass = 0;
      const auto displacement = [&](std::size_t i) { return convert<double>(at(found.workspace.displacements[i])); };
      const auto first = static_cast<std::size_t>(found.model.first[o]),
                 last = static_cast<std::size_t>(found.model.end_of(static_cast<int>(o)));
      for (std::size_t i = first; i < last; ++i) {
        if (!(found.state.positions[i].w > 0)) continue;
        moment += displacement(i) * (1 / double(found.state.positions[i].w));
        mass += 1 / double(found.state.positions[i].w);
      }
      for (std::size_t i = first; i < last; ++i) {
        if (!(found.state.positions[i].w > 0)) continue;
        const Vec3d d = displacement(i) - moment * (1 / mass);
        const Vec3d r{joint.b[3 * i] - image[3 * i], joint.b[3 * i + 1] - image[3 * i + 1],
                      joint.b[3 * i + 2] - image[3 * i + 2]};
        work -= dot(r, d);
        size += std::fabs(dot(r, d));
      }
    }
    EXPECT_LT(work, 1e-3 * size) << cycles;
  }
}

/// By how much the sides of a contact overlap after the displacements [m].
double overlap_of(const Contact& contact, const Corrected& found) {
  double apart = double(contact.gap);
  for (std::size_t i = 0; i < 4; ++i) {
    const Record& d = found.workspace.displacements[std::size_t(contact.point[i])];
    apart +=
        double(contact.weight[i]) * dot(convert<double>(contact.normal), Vec3d{double(d.x), double(d.y), double(d.z)});
  }
  return std::max(0., -apart);
}

/// Contacts are projected between the forward and the backward pass: for objects without levels nothing else resolves
/// overlaps.
TEST(MultigridPairs, AreSweptBetweenThereAndBack) {
  std::vector<Object> loose = two_sheets();
  for (Object& object : loose) object.constraints.clear();
  const Corrected corrected(loose, 3), iterated(loose, 3, iterate_multigrid);
  ASSERT_TRUE(corrected.springs().empty()) << "or the correction pushes them too";
  double before = 0, after = 0, pushed = 0;
  for (const Contact& contact : corrected.workspace.pairs->contacts()) before += overlap_of(contact, corrected);
  for (const Contact& contact : iterated.workspace.pairs->contacts()) {
    after += overlap_of(contact, iterated);
    pushed += double(contact.push);
  }
  ASSERT_GT(before, 0.01) << "metres: they come through one another";
  EXPECT_GT(pushed, 0);
  EXPECT_LT(after, 0.2 * before);
}

/// A free sheet folded over itself, displaced against its grid; its upper half falls on the lower.
Object folded_sheet() {
  constexpr int columns = 15, rows = 8;
  Object sheet = crumpled(columns, rows, 4);
  sheet.pins.clear();
  sheet.triangles = grid_mesh(columns, rows, 1, 1).triangles;
  sheet.self_collision = true;
  sheet.thickness = 0.03f;
  sheet.velocities.assign(sheet.positions.size(), Vec3f{});
  for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
    Vec3f& p = sheet.positions[i];
    if (p.x < 0.05f) continue;
    p = {-p.x + 0.017f, p.y + 0.06f, p.z + 0.011f};
    sheet.velocities[i] = {0, -9, 0};
  }
  return sheet;
}

/// Contacts of an object with itself must neither move it as a whole nor hold it: its momentum stays for any number of
/// cycles.
TEST(MultigridPairs, OfAPieceWithItselfKeepItsMomentum) {
  const Corrected found({folded_sheet()}, 1);
  ASSERT_GT(found.springs().size(), 20u);
  const Vector change = found.change();
  double sum[3] = {0, 0, 0}, size = 0;
  for (std::size_t i = 0; i < change.size(); ++i) {
    const double mass = 1 / double(found.state.positions[i / 3].w);
    sum[i % 3] += mass * change[i];
    size += mass * std::fabs(change[i]);
  }
  ASSERT_GT(size, 1e-5);
  for (double s : sum) EXPECT_LT(std::fabs(s), 1e-4 * size);
}

}  // namespace
}  // namespace pliant
