#include "solver/bodies/rod_bundle.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "constraints/registry.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/free_tree.h"
#include "solver/bodies/joint_forest_work.h"
#include "solver/stencil.h"

namespace pliant {

namespace {

// ---------------------------------------------------------------- which rods are alike

bool is_rod(const CompiledObject& object, const JointForest& forest) {
  return forest.tree->is_plain() &&
         std::all_of(forest.joints.begin(), forest.joints.end(),
                     [&](const JointForest::Joint& joint) {
                       if (!joint.in_tree || joint.parts.size() != 1) return false;
                       const Pool& pool = object.pools[at(joint.parts.front().pool)];
                       return std::string_view(constraint_type(pool.type).name) == RodJointRows::name;
                     }) &&
         std::none_of(forest.bodies.begin(), forest.bodies.end(),
                      [](const JointForest::Body& body) { return body.is_held; });
}

/// A rod whose joints are in the order of their blocks, and whose bodies are in the order in which these meet them.
struct OrderedRod {
  std::vector<RodNode> nodes;
  std::vector<int> joints;  ///< [node] of the forest
  std::vector<int> bodies;  ///< of the forest

  OrderedRod(const CompiledObject& object, const JointForest& forest) {
    std::vector<int> number(forest.bodies.size(), -1);
    for (const JointTree::Node& from : forest.tree->nodes()) {
      const JointEnds& ends = forest.ends[at(from.index)];
      RodNode node;
      node.parent = from.parent;
      node.pool = forest.joints[at(from.index)].parts.front().pool;
      node.is_damped = object.pools[at(node.pool)].law == Law::damped;
      node.ends[0] = numbered(ends.a, number);
      node.ends[1] = numbered(ends.b, number);
      if (from.parent >= 0) {
        node.through = ends.b == from.through ? 1 : 0;
        node.of_parent = forest.ends[at(forest.tree->nodes()[at(from.parent)].index)].b == from.through ? 1 : 0;
      }
      nodes.push_back(node);
      joints.push_back(from.index);
    }
  }

  int numbered(int body, std::vector<int>& number) {
    if (body < 0) return -1;
    int& its = number[at(body)];
    if (its < 0) {
      its = static_cast<int>(bodies.size());
      bodies.push_back(body);
    }
    return its;
  }
  /// Equal for rods that can be solved side by side.
  std::vector<std::int32_t> shape() const {
    std::vector<std::int32_t> shape;
    for (const RodNode& node : nodes)
      shape.insert(shape.end(), {node.parent, node.ends[0], node.ends[1], node.through, node.of_parent, node.pool});
    return shape;
  }
};

/// Writes a rod into a lane.
void put_rod(const JointForest& forest, const OrderedRod& rod, int lane, RodBundle& into) {
  for (std::size_t j = 0; j < rod.joints.size(); ++j) {
    const JointForest::Joint& joint = forest.joints[at(rod.joints[j])];
    const JointForest::Part& part = joint.parts.front();
    for (std::size_t slot = 0; slot < 4; ++slot) into.joints[j].slots[slot][lane] = joint.slots[slot];
    into.joints[j].places[lane] = static_cast<std::int32_t>(part.batch * batch_width + part.lane);
  }
  for (std::size_t b = 0; b < rod.bodies.size(); ++b) {
    const JointForest::Body& body = forest.bodies[at(rod.bodies[b])];
    into.bodies[b].point[lane] = body.point;
    into.bodies[b].frame[lane] = body.frame;
  }
}

// ---------------------------------------------------------------- solution

/// Room for sixty-four bytes of any type.
struct alignas(64) Line {
  unsigned char bytes[64];
};

/// Scratch memory of a thread.
struct RodScratch {
  std::vector<RodJointScratch> joints;
  std::vector<RodBodyScratch> bodies;
  std::vector<Line> blocks;
};

/// A bundle in a substep.
class RodSolver {
 public:
  RodSolver(const Substep& s, int object, bool first_pass, RodBundle& bundle)
      : s_(s), object_(s.model.objects[at(object)]), bundle_(bundle) {
    thread_local RodScratch scratch;
    scratch.joints.resize(std::max(scratch.joints.size(), bundle.nodes.size()));
    scratch.bodies.resize(std::max(scratch.bodies.size(), bundle.bodies.size()));
    scratch.blocks.resize(std::max(scratch.blocks.size(), bundle.nodes.size() * rod_block + bundle.bodies.size() * 6));
    view_ = {bundle.rods,
             static_cast<int>(bundle.nodes.size()),
             static_cast<int>(bundle.bodies.size()),
             bundle.nodes.data(),
             bundle.joints.data(),
             bundle.bodies.data(),
             scratch.joints.data(),
             scratch.bodies.data(),
             scratch.blocks.data(),
             arguments(s, object, first_pass),
             frame_arguments(s, object)};
    load_rest();
    load_multipliers();
  }

  void solve(RodBits which) {
    free_.clear();
    kernels().fill_masses(view_);
    const RodBits hard = padded(pulled_hard() & which);
    if (hard != 0) stiffen(hard);
    kernels().fill_rows(view_, ~hard);
    kernels().solve(view_, which);
    const RodBits soft = which & ~hard;
    if (soft != 0) solve_again(soft);
    keep_pulls(which);
    kernels().apply(view_, which);
    for (const FreeTree& rod : free_) rod.restore();
    store_multipliers(which);
  }

  /// Solves the open ones of the rods until all are closed, at most so many times.
  void close(float share, int most_rounds) {
    for (int round = 0; round < most_rounds; ++round) {
      const RodBits open = padded(kernels().find_open(view_, share));
      if (open == 0) return;
      solve(open);
      load_multipliers();
    }
  }

 private:
  const RodKernels& kernels() const { return s_.kernels.rods; }

  /// The same for lanes without a rod as for the last rod.
  RodBits padded(RodBits bits) const {
    const RodBits rods = (RodBits{1} << bundle_.rods) - 1;
    return (bits >> (bundle_.rods - 1) & 1) != 0 ? bits | ~rods : bits & rods;
  }
  const Pool& pool_of(std::size_t joint) const { return object_.pools[at(bundle_.nodes[joint].pool)]; }
  float* multipliers_of(std::size_t joint) const {
    return view_.points.multipliers == nullptr ? nullptr : view_.points.multipliers[bundle_.nodes[joint].pool];
  }

  void load_rest() {
    for (std::size_t j = 0; j < bundle_.nodes.size(); ++j) {
      const Pool& pool = pool_of(j);
      const int rows = rod_fields + (bundle_.nodes[j].is_damped ? 2 : 1);
      for (int row = 0; row < rows; ++row) {
        const float* const from = pool.row(row, 0);
        const std::int64_t step = pool.row_step(row);
        for (int lane = 0; lane < most_rods; ++lane) {
          const std::int32_t place = bundle_.joints[j].places[lane];
          view_.of_joints[j].rest[row][lane] = from[step * (place / batch_width) + place % batch_width];
        }
      }
    }
  }
  static std::int64_t multiplier_place(const Pool& pool, std::int32_t place, int row) {
    return multiplier_index(pool, place / batch_width, place % batch_width, row);
  }
  void load_multipliers() {
    for (std::size_t j = 0; j < bundle_.nodes.size(); ++j) {
      const float* const from = view_.points.first_pass ? nullptr : multipliers_of(j);
      for (int row = 0; row < rod_rows; ++row)
        for (int lane = 0; lane < most_rods; ++lane)
          view_.of_joints[j].before[row][lane] =
              from == nullptr ? 0 : from[multiplier_place(pool_of(j), bundle_.joints[j].places[lane], row)];
    }
  }
  void store_multipliers(RodBits which) {
    for (std::size_t j = 0; j < bundle_.nodes.size(); ++j) {
      float* const to = multipliers_of(j);
      if (to == nullptr) continue;
      for (int row = 0; row < rod_rows; ++row)
        for (int lane = 0; lane < bundle_.rods; ++lane) {
          if ((which >> lane & 1) == 0) continue;
          float& multiplier = to[multiplier_place(pool_of(j), bundle_.joints[j].places[lane], row)];
          multiplier = (view_.points.first_pass ? 0.f : multiplier) - view_.of_joints[j].change[row][lane];
        }
    }
  }

  /// The rods whose joints pulled hard in the last substep, and do so now.
  RodBits pulled_hard() {
    if (!view_.points.first_pass || s_.number == 0) return 0;
    const float scale = view_.points.h * view_.points.h * bundle_.inverse_h2_of_pulls;
    for (RodJoint& joint : bundle_.joints)
      for (auto& of_end : joint.pull)
        for (RodLanes& row : of_end)
          for (float& number : row) number = number * scale;
    return kernels().find_stiffness(view_, true, false, largest_advance);
  }

  /// Solves those rods again whose pulls need stiffness, with the gradients of the present.
  void solve_again(RodBits soft) {
    const RodBits grown =
        padded(kernels().find_stiffness(view_, !view_.points.first_pass, true, largest_advance) & soft);
    if (grown == 0) return;
    stiffen(grown);
    kernels().fill_rows(view_, 0);
    kernels().solve(view_, grown);
  }

  void keep_pulls(RodBits which) {
    for (std::size_t j = 0; j < bundle_.nodes.size(); ++j)
      for (int end = 0; end < 2; ++end)
        for (int axis = 0; axis < 3; ++axis)
          for (int lane = 0; lane < most_rods; ++lane) {
            float& kept = bundle_.joints[j].pull[end][axis][lane];
            const float sum = (view_.points.first_pass ? 0.f : kept) + view_.of_joints[j].pull[end][axis][lane];
            kept = (which >> lane & 1) != 0 ? sum : kept;
          }
    bundle_.inverse_h2_of_pulls = view_.points.inverse_h2;
  }

  /// True if the rods hold on to nothing.
  bool is_free() const {
    return std::all_of(bundle_.nodes.begin(), bundle_.nodes.end(),
                       [](const RodNode& node) { return node.ends[0] >= 0 && node.ends[1] >= 0; });
  }
  std::vector<JointForest::Body> bodies_of(int lane) const {
    std::vector<JointForest::Body> bodies;
    for (const RodBody& body : bundle_.bodies) bodies.push_back({body.point[lane], body.frame[lane]});
    return bodies;
  }

  /// Adds the stiffness to the inertia, and takes away the part of the predicted rotation that it prevents. Free rods
  /// are noted before.
  void stiffen(RodBits which) {
    for (int lane = 0; lane < bundle_.rods && is_free(); ++lane)
      if ((which >> lane & 1) != 0) free_.emplace_back(bodies_of(lane), view_.points, view_.frames);
    for (std::size_t b = 0; b < bundle_.bodies.size(); ++b)
      for (int lane = 0; lane < bundle_.rods; ++lane)
        if ((which >> lane & 1) != 0) stiffen_body(b, lane);
  }
  void stiffen_body(std::size_t b, int lane) {
    RodBodyScratch& body = view_.of_bodies[b];
    Symmetric stiffness, inertia;
    for (std::size_t i = 0; i < 6; ++i) {
      stiffness[i] = body.stiffness[i][lane];
      inertia[i] = body.inertia[i][lane] + stiffness[i];
    }
    const Symmetric inverse = inverse_of(inertia);
    const int last = lane + 1 == bundle_.rods ? most_rods : lane + 1;
    for (int l = lane; l < last; ++l)
      for (std::size_t i = 0; i < 6; ++i) {
        body.inertia[i][l] = inertia[i];
        body.inverse[i][l] = inverse[i];
      }
    if (!view_.points.first_pass) return;
    const std::int32_t frame = bundle_.bodies[b].frame[lane];
    const Vec3f predicted = xyz(view_.frames.predicted[frame]);
    rotate_frame(-times(inverse, times(stiffness, predicted)), view_.frames.orientations[frame],
                 view_.frames.corrections[frame]);
  }

  const Substep& s_;
  const CompiledObject& object_;
  RodBundle& bundle_;
  RodBundleView view_;
  std::vector<FreeTree> free_;  ///< rods of this solve that need stiffness and hold on to nothing
};

/// Calls a function for each bundle of the objects that take part, on all threads.
void for_bundles(Substep& s, bool first_pass, FunctionRef<void(RodSolver&)> body) {
  std::vector<std::pair<int, std::size_t>> tasks;
  for_objects(s, [&](int o) {
    for (std::size_t i = 0; i < s.work.joints[at(o)].bundles.size(); ++i) tasks.emplace_back(o, i);
  });
  if (tasks.empty()) return;
  for_tasks(s, "solve: joints", static_cast<int>(tasks.size()), [&](int number) {
    const auto& [o, i] = tasks[at(number)];
    RodSolver solver(s, o, first_pass, s.work.joints[at(o)].bundles[i]);
    body(solver);
  });
}

}  // namespace

std::vector<RodBundle> bundle_rods(const CompiledObject& object, std::vector<JointForest>& forests) {
  std::map<std::vector<std::int32_t>, std::vector<std::size_t>> alike;
  std::vector<OrderedRod> rods;
  std::vector<std::size_t> forest_of;
  for (std::size_t f = 0; f < forests.size(); ++f) {
    if (!is_rod(object, forests[f])) continue;
    rods.emplace_back(object, forests[f]);
    forest_of.push_back(f);
    alike[rods.back().shape()].push_back(rods.size() - 1);
  }
  std::vector<RodBundle> bundles;
  for (const auto& [shape, members] : alike)
    for (std::size_t first = 0; first + least_rods_of_bundle <= members.size(); first += most_rods) {
      const std::size_t count = std::min(members.size() - first, std::size_t{most_rods});
      const OrderedRod& any = rods[members[first]];
      RodBundle& bundle = bundles.emplace_back();
      bundle.rods = static_cast<int>(count);
      bundle.nodes = any.nodes;
      bundle.joints.resize(any.nodes.size());
      bundle.bodies.resize(any.bodies.size());
      for (std::size_t lane = 0; lane < most_rods; ++lane) {
        const std::size_t rod = members[first + std::min(lane, count - 1)];
        put_rod(forests[forest_of[rod]], rods[rod], static_cast<int>(lane), bundle);
        forests[forest_of[rod]].in_bundle = true;
      }
    }
  return bundles;
}

void solve_rod_bundles(Substep& s, bool first_pass) {
  for_bundles(s, first_pass, [](RodSolver& solver) { solver.solve(~RodBits{0}); });
}

void close_rod_bundles(Substep& s) {
  for_bundles(s, false, [](RodSolver& solver) { solver.close(closed_share, most_closing_rounds); });
}

}  // namespace pliant
