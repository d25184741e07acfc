// The manifolds of a frame as blocks of sixteen, colour after colour, and the passes over them on all threads.
//
// Manifolds of one colour share no dynamic body, so neither lanes nor threads change a bit: the result is that of the
// scalar functions (manifold_passes.h) called in the order of colours. The tail is solved one by one.
#pragma once

#include <span>
#include <vector>

#include "parallel/executor.h"
#include "solver/bodies/manifold_colours.h"
#include "solver/bodies/manifold_kernels.h"

namespace pliant {

class ManifoldBlocks {
 public:
  /// Asks for each manifold by its number in colours.order(), on any thread, after prefetch(number), since these are
  /// far apart in memory. `is_fixed` is by body: nonzero where a body is fixed.
  void fill(Executor& executor, const ManifoldColours& colours, std::span<const char> is_fixed,
            FunctionRef<void(int)> prefetch, FunctionRef<Manifold(int)> manifold);

  /// Calls keep(number, manifold) for each manifold of `fill`, on any thread, with impulses and present gaps alone.
  void take(Executor& executor, const ManifoldColours& colours, FunctionRef<void(int)> prefetch,
            FunctionRef<void(int, const Manifold&)> keep) const;

  /// Moves the place where a manifold of `fill` touches, by its number in the order of colours.
  void set_arms(int number, const Vec3f& arm_a, const Vec3f& arm_b);

  /// True if some manifold has restitution.
  bool bounces() const;

  /// Multiplies all impulses, where the next substep is longer or shorter by that factor.
  void scale_impulses(Executor& executor, float factor);

  /// Forgets what bounces gave in the last substep.
  void clear_bounced();
  /// Calls visit(number, impulse) for each manifold that has bounced since then [N s].
  void for_bounced(const ManifoldColours& colours, FunctionRef<void(int, float)> visit) const;

  /// The number of manifolds with a normal impulse.
  int pressing() const;
  /// Calls visit(number) for each of them.
  void for_pressing(const ManifoldColours& colours, FunctionRef<void(int)> visit) const;

  // Each of these calls the function of that name (manifold_passes.h) for all manifolds.
  void prepare(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions);
  void warm_start(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions);
  bool bounce(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions, float h,
              const Vec3f& fall);
  void position_pass(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions, float h,
                     const ContactSoftness& softness);
  void velocity_pass(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions, float h);

 private:
  using Pass = FunctionRef<void(const ManifoldKernels&, const BlockRange&)>;
  /// Calls pass for ranges of each colour, on all threads if the colour is large; then for the tail.
  void run(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions, const Pass& pass);
  void prefetch_block(int number, const ManifoldColours& colours, FunctionRef<void(int)> prefetch) const;
  void fill_block(int number, const ManifoldColours& colours, std::span<const char> is_fixed,
                  FunctionRef<Manifold(int)> manifold);

  std::vector<ManifoldBlock> blocks_;
  /// First block of each colour, of the tail, and the end.
  std::vector<int> start_ = std::vector<int>(manifold_colours + 2, 0);
  std::vector<int> first_;  ///< first manifold of each block, and the number of all
};

}  // namespace pliant
