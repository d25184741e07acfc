// What tests of the multigrid correction share: crumpled sheets, dense matrices in double, and sheets that were
// corrected once.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "constraints/all.h"
#include "pliant/mesh.h"
#include "solver/stages/stages.h"
#include "solver/sweeps/multigrid.h"
#include "solver/sweeps_support.h"
#include "support/kernels.h"
#include "topology/edges.h"

namespace pliant::testing_support {

inline constexpr float inverse_h2 = 360.f * 360;

inline float uniform_16_bit(std::mt19937& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random() % 65536) / 65536;
}

/// A crumpled sheet, partly taut and partly slack, with rigid and soft springs; particle 0 and another one are pinned.
inline Object crumpled(int columns, int rows, unsigned seed) {
  std::mt19937 random(seed);
  const TriangleMesh mesh = grid_mesh(columns, rows, 1, 1);
  Object object;
  object.positions = mesh.positions;
  for (Vec3f& p : object.positions)
    p += Vec3f{uniform_16_bit(random, -0.02f, 0.02f), uniform_16_bit(random, -0.02f, 0.02f),
               uniform_16_bit(random, -0.02f, 0.02f)};
  for (std::size_t i = 0; i < object.positions.size(); ++i)
    object.masses.push_back(uniform_16_bit(random, 0.001f, 0.004f));
  object.pins = {{0, {}}, {columns + 2, {}}};
  ConstraintGroup rigid{"distance", {}, {}, Stiffness::rigid(), {}}, soft = rigid;
  soft.stiffness = Stiffness::compliance(0.01f);
  int number = 0;
  for (const Edge& edge : find_edges(mesh.triangles, columns * rows)) {
    ConstraintGroup& group = number++ % 3 == 0 ? soft : rigid;
    group.particles.insert(group.particles.end(), {edge.a, edge.b});
    group.rest.push_back(uniform_16_bit(random, 0.9f, 1.05f) / static_cast<float>(columns - 1));
  }
  object.constraints = {rigid, soft};
  return object;
}

using Matrix = std::vector<std::vector<double>>;
using Vector = std::vector<double>;

/// Gaussian elimination with pivoting, for small matrices.
inline Vector eliminate(Matrix a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; factor != 0 && j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

inline Vector times(const Matrix& a, const Vector& x) {
  Vector y(a.size(), 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) y[i] += a[i][j] * x[j];
  return y;
}

inline double max_norm(const Vector& a) {
  double largest = 0;
  for (double x : a) largest = std::max(largest, std::fabs(x));
  return largest;
}

/// An object linearised on every level by the kernels of an instruction set.
struct Linearised {
  CompiledObject object;
  Records positions, displacements;
  std::vector<MultigridObject> work;
  const MultigridKernels* kernels = nullptr;

  explicit Linearised(const Object& from, const std::string& isa = available_isas().front(), bool touches = false)
      : object(compile_with_levels(from)), kernels(&pick_kernels(isa).multigrid) {
    std::mt19937 random(5);
    positions.assign(object.positions.begin(), object.positions.end());
    displacements.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (positions[i].w > 0)
        displacements[i] = {uniform_16_bit(random, -1e-3f, 1e-3f), uniform_16_bit(random, -1e-3f, 1e-3f),
                            uniform_16_bit(random, -1e-3f, 1e-3f), 0};
    Model model;
    model.objects = {object};
    MultigridScratch scratch;
    const Workspace none;
    const SweepOptions options;
    scratch.prepare({model, none, options}, 0);
    work = std::move(scratch.objects);
    if (touches) touch();
    const LinearisedAt at{positions.data(), displacements.data(), inverse_h2, of().extra.data(), of().has_extra.data()};
    kernels->linearise(level(0), at, values(0), 0, level(0).batches());
    for (int l = 1; l < levels(); ++l)
      kernels->coarsen(level(l - 1), values(l - 1), l == 1, level(l), values(l), 0, level(l).batches());
  }
  static CompiledObject compile_with_levels(const Object& from) {
    CompileOptions options;
    options.sweep = Sweep::multigrid;
    options.gravity = 9.81f;
    return compile(from, options);
  }
  /// Adds a contact of particle 7 along y with stiffness 1e4, which pushes with 3 N.
  void touch() {
    const int place = lane_place(7);
    of().extra.resize(of().has_extra.size() * 9 * batch_width);
    of().has_extra[static_cast<std::size_t>(place / batch_width)] = 1;
    float* extra = of().extra.data() + place / batch_width * 9 * batch_width + place % batch_width;
    extra[1 * batch_width] = 1e4f;
    extra[7 * batch_width] = 3;
  }
  MultigridObject& of() { return work[0]; }
  int levels() const { return static_cast<int>(object.multigrid.levels.size()); }
  const MultigridLevel& level(int l) const { return object.multigrid.levels[static_cast<std::size_t>(l)]; }
  MultigridValues& values(int l) { return of().levels[static_cast<std::size_t>(l)]; }
  int rows(int l) const { return level(l).rows; }
  bool moves(int row) const { return positions[static_cast<std::size_t>(row)].w > 0; }
};

/// Adds s (g g^T + k I) to the rows and columns of two particles, as a spring does.
inline void add_coupling(Matrix& a, int i, int j, const Vec3d& g, double k) {
  const double of[3] = {g.x, g.y, g.z};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = of[r] * of[c] + (r == c ? k : 0);
      const std::size_t ir = 3 * std::size_t(i) + r, jr = 3 * std::size_t(j) + r;
      const std::size_t ic = 3 * std::size_t(i) + c, jc = 3 * std::size_t(j) + c;
      a[ir][ic] += value;
      a[jr][jc] += value;
      a[ir][jc] -= value;
      a[jr][ic] -= value;
    }
  }
}

struct LinearSystem {
  Matrix a;
  Vector b;
};

/// The Hessian and the negative gradient of |x - x~|^2_M / 2 h^2 + sum K C^2 / 2, in double, spring by spring. The
/// (negative) geometric stiffness of slack springs is left out.
inline LinearSystem dense_system(const Linearised& of, bool touches = false) {
  const std::size_t n = 3 * of.positions.size();
  LinearSystem system{Matrix(n, Vector(n, 0)), Vector(n, 0)};
  const auto place = [&](int i) {
    const Record &p = of.positions[std::size_t(i)], &d = of.displacements[std::size_t(i)];
    return Vec3d{double(p.x) + double(d.x), double(p.y) + double(d.y), double(p.z) + double(d.z)};
  };
  for (int row = 0; row < of.rows(0); ++row) {
    const MultigridLevel& level = of.level(0);
    const int at = lane_place(row), batch = at / batch_width, lane = at % batch_width;
    for (int slot = level.first_slot[batch]; slot < level.first_slot[batch + 1]; ++slot) {
      const int other = level.column[slot * batch_width + lane];
      if (other <= row) continue;  // each spring once
      const double stiffness = level.stiffness[slot * batch_width + lane],
                   rest = level.rest_length[slot * batch_width + lane];
      const Vec3d u = place(other) - place(row);
      const double length = std::sqrt(dot(u, u)), tension = stiffness * (length - rest);
      const double across = std::max(0., tension / length);
      const Vec3d n3 = u * (1 / length);
      add_coupling(system.a, row, other, n3 * std::sqrt(stiffness - across), across);
      const double force[3] = {n3.x * tension, n3.y * tension, n3.z * tension};
      for (std::size_t c = 0; c < 3; ++c) {
        system.b[3 * std::size_t(row) + c] += force[c];
        system.b[3 * std::size_t(other) + c] -= force[c];
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Record& p = of.positions[i / 3];
    if (p.w > 0) system.a[i][i] += double(inverse_h2) / double(p.w);
  }
  if (touches) {
    system.a[22][22] += 1e4;
    system.b[22] += 3;
  }
  return system;
}

/// Replaces the rows and columns of fixed particles by those of the identity.
inline void hold(const Linearised& of, LinearSystem& system) {
  for (std::size_t i = 0; i < system.b.size(); ++i) {
    if (of.moves(static_cast<int>(i / 3))) continue;
    for (std::size_t j = 0; j < system.b.size(); ++j) system.a[i][j] = system.a[j][i] = 0;
    system.a[i][i] = 1;
    system.b[i] = 0;
  }
}

/// An object after prediction and one correction without sweeps, or after a whole iteration by iterate_multigrid.
struct Corrected {
  using Part = void (*)(Substep& s, bool first);

  Model model;
  State state;
  Workspace workspace;
  Records predicted;
  std::unique_ptr<PairModel> pairs;

  Corrected(const Object& object, int cycles) : Corrected(std::vector<Object>{object}, cycles) {}

  Corrected(const std::vector<Object>& objects, int cycles, Part part = correct_multigrid) {
    SweepRun run = run_of(Sweep::multigrid, 1, 1);
    run.settings.sweep_options.multigrid_cycles = cycles;
    CompileOptions options;
    options.sweep = Sweep::multigrid;
    options.gravity = 9.81f;
    for (const Object& object : objects) model.add(compile(object, options));
    state = initial_state(model);
    prepare(model, Multipliers::all, workspace);
    prepare_sweeps(model, run.settings, 1, workspace);
    pairs = make_pair_model(model);
    if (pairs) workspace.pairs = std::make_unique<SurfaceContact>(*pairs);
    Executor executor(1);
    const Kernels& kernels = pick_kernels(available_isas().front());
    const StepContext context{model, state, workspace, executor, kernels, 1, 1, run.settings.sweep_options, false};
    executor.enter([&] {
      Substep s = begin_frame(context, 1.0 / 360).front();
      control(s);
      predict(s);
      predicted = workspace.displacements;
      collide(s);
      s.group = &workspace.sweeps.at(Sweep::multigrid);
      part(s, true);
    });
  }
  const std::vector<PairSpring>& springs() const {
    return static_cast<const MultigridScratch&>(*workspace.sweeps.at(Sweep::multigrid).scratch).springs;
  }
  Vector change() const {
    Vector out;
    for (std::size_t i = 0; i < predicted.size(); ++i)
      for (int c = 0; c < 3; ++c)
        out.push_back(double((&workspace.displacements[i].x)[c]) - double((&predicted[i].x)[c]));
    return out;
  }
};

inline double error_of(const Vector& found, const Vector& expected) {
  double largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::fabs(found[i] - expected[i]));
  return largest / max_norm(expected);
}

}  // namespace pliant::testing_support
