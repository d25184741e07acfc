// Solves joint trees whose limits, motors and friction have bounds: which rows act at a bound is found by repeated
// solves.
#include <algorithm>
#include <utility>

#include "solver/bodies/joint_forest_work.h"
#include "solver/project.h"

namespace pliant {

namespace {

using BoundedRow = JointForest::BoundedRow;
using RowState = BoundedRow::State;

/// A row whose multiplier is held at a bound is a row of this compliance, in units of its inverse mass.
constexpr float held_compliance = 1e6f;
/// A bound beyond this is none.
constexpr float most_held = 1e15f;
/// Solves with rows that may leave their bounds again, then solves in which they may only reach them.
constexpr int free_solves = 4, most_solves = 10;

/// J M^-1 J^T of a row, with the mean inertia of each body: a scale.
float inverse_mass(const JointForest& forest, const BoundedRow& bounded) {
  const JointRows& rows = forest.rows[bounded.joint];
  const JointEnds& ends = forest.ends[bounded.joint];
  float sum = 0;
  for (const auto& [body, g] : {std::pair{ends.a, rows.of_a[bounded.row]}, std::pair{ends.b, rows.of_b[bounded.row]}}) {
    if (body < 0) continue;
    const BodyMass& mass = forest.masses[static_cast<std::size_t>(body)];
    sum = sum + length_squared(g[0]) / mass.mass +
          length_squared(g[1]) * 3 / (mass.inertia[0] + mass.inertia[1] + mass.inertia[2]);
  }
  return max(sum, smallest_denominator);
}

float held_change(const BoundedRow& bounded) { return bounded.state == RowState::low ? bounded.low : bounded.high; }

/// Writes a bounded row as it is in its state.
void write_row(JointForest& forest, const BoundedRow& bounded) {
  JointRows& rows = forest.rows[bounded.joint];
  const bool is_free = bounded.state == RowState::free;
  const float compliance = held_compliance * bounded.inverse_mass;
  rows.compliance[bounded.row] = is_free ? bounded.compliance : compliance;
  rows.value[bounded.row] = is_free ? bounded.value : -compliance * held_change(bounded);
}

/// What is left of a row's C after the corrections, with compliance.
float residual(const JointForest& forest, const BoundedRow& bounded, float change) {
  const JointRows& rows = forest.rows[bounded.joint];
  const JointEnds& ends = forest.ends[bounded.joint];
  float sum = bounded.value + bounded.compliance * change;
  for (const auto& [body, g] : {std::pair{ends.a, rows.of_a[bounded.row]}, std::pair{ends.b, rows.of_b[bounded.row]}}) {
    if (body < 0) continue;
    const BodyCorrection& by = forest.corrections[static_cast<std::size_t>(body)];
    sum = sum + dot(g[0], by.displacement) + dot(g[1], by.rotation);
  }
  return sum;
}

/// The state of a bounded row after a solve. A row that depends on others is left out of the solve; if it is not met,
/// it is held at the bound that would reduce its error.
RowState next_state(const JointForest& forest, const BoundedRow& bounded, bool may_leave) {
  const float tolerance = 1e-7f + 1e-4f * abs(bounded.value);
  if (bounded.state != RowState::free) {
    const float left = residual(forest, bounded, held_change(bounded));
    const bool leaves = bounded.state == RowState::low ? left < -tolerance : left > tolerance;
    return leaves && may_leave && bounded.low < bounded.high ? RowState::free : bounded.state;
  }
  const float change = -forest.multipliers[bounded.joint][bounded.row];
  if (change < bounded.low) return RowState::low;
  if (change > bounded.high) return RowState::high;
  const float left = residual(forest, bounded, change);
  if (left > tolerance && bounded.low > -most_held) return RowState::low;
  return left < -tolerance && bounded.high < most_held ? RowState::high : RowState::free;
}

/// True if the solve left a row out because it depends on others, as a motor against a stop does, and it is not met.
bool is_left_out(const JointForest& forest, const BoundedRow& bounded) {
  if (bounded.state != RowState::free || forest.multipliers[bounded.joint][bounded.row] != 0) return false;
  return abs(residual(forest, bounded, 0)) > 1e-7f + 1e-4f * abs(bounded.value);
}

void solve_once(JointForest& forest) {
  forest.tree->solve(forest.masses, forest.rows, forest.corrections, &forest.multipliers);
}

}  // namespace

void solve_within_bounds(JointForest& forest) {
  for (BoundedRow& bounded : forest.bounded) {
    bounded.inverse_mass = inverse_mass(forest, bounded);
    write_row(forest, bounded);
  }
  for (int round = 0; round < most_solves; ++round) {
    solve_once(forest);
    bool changes = false;
    const auto left_out = [&](const BoundedRow& bounded) { return is_left_out(forest, bounded); };
    const bool is_partial = std::any_of(forest.bounded.begin(), forest.bounded.end(), left_out);
    for (BoundedRow& bounded : forest.bounded) {
      if (is_partial && !left_out(bounded)) continue;  // what the others do follows from those that were left out
      const RowState next = next_state(forest, bounded, round < free_solves);
      changes = changes || next != bounded.state;
      bounded.state = next;
    }
    if (!changes) break;
    for (const BoundedRow& bounded : forest.bounded) write_row(forest, bounded);
  }
  for (const BoundedRow& bounded : forest.bounded)
    if (bounded.state != RowState::free) forest.multipliers[bounded.joint][bounded.row] = -held_change(bounded);
}

}  // namespace pliant
