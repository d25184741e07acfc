#include "collision/bodies/body_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int parts_a_task = 256, pairs_a_task = 2048, renewed_a_task = 64;
/// Boxes are larger by this share of their part's size than they need be, so that pairs last for more than a frame.
constexpr float spare_share = 0.1f;
/// Parts stay paired with a mesh as long as they are this multiple of their size beyond its box.
constexpr float through_share = 4;

/// How far a part reaches from its frame's origin in six directions of some frame.
struct Extent {
  Vec3d low{}, high{};
};

/// The least and greatest coordinate of a core along a direction.
std::pair<double, double> range_along(const ConvexShape& shape, const Vec3d& direction) {
  if (shape.kind != ConvexShape::Kind::polyhedron)
    return {dot(direction, support(shape, -direction)), dot(direction, support(shape, direction))};
  std::pair<double, double> range{1e300, -1e300};
  for (const Vec3f& corner : shape.polyhedron->corners) {
    const double place = dot(direction, convert<double>(corner));
    range = {std::min(range.first, place), std::max(range.second, place)};
  }
  return range;
}

Extent extent_of(const ConvexShape& shape, const Posed& pose) {
  const auto range = [&](const Vec3d& axis) { return range_along(shape, rotate(conjugate(pose.rotation), axis)); };
  const auto [x, y, z] = std::array{range({1, 0, 0}), range({0, 1, 0}), range({0, 0, 1})};
  const double r = static_cast<double>(shape.radius);
  return {pose.position + Vec3d{x.first - r, y.first - r, z.first - r},
          pose.position + Vec3d{x.second + r, y.second + r, z.second + r}};
}

/// The box of a part in the world. Supports are exact up to rounding.
BoxBounds box_of(const BodyPart& part, const Posed& body) {
  const auto [low, high] = extent_of(part.shape, compose(body, part.pose));
  return {{detail::float_below(low.x), detail::float_below(low.y), detail::float_below(low.z)},
          {detail::float_above(high.x), detail::float_above(high.y), detail::float_above(high.z)}};
}

float size_of(const ConvexShape& shape) {
  const auto [low, high] = extent_of(shape, {});
  return static_cast<float>(0.5 * std::min({high.x - low.x, high.y - low.y, high.z - low.z}));
}

/// An upper bound of the speed of a part's points against the body's centre: a box of it lies around them [m/s].
float turning_speed(const BodyState& body, const BoxBounds& box) {
  const Vec3f centre = convert<float>(body.pose.position);
  const Vec3f reach = max(abs(box.high - centre), abs(box.low - centre));
  return length(body.spin) * length(reach);
}

/// A box around a box on its way along a path.
BoxBounds swept(const BoxBounds& box, const Vec3f& path) {
  return {box.low + min(path, Vec3f{}), box.high + max(path, Vec3f{})};
}

/// A box in the world around a mesh.
BoxBounds world_box(const BodyMesh& mesh, const Posed& pose) {
  const BoxBounds local = mesh.bounds();
  const Posef at = convert<float>(pose);
  const Vec3f centre = to_world(at, (local.low + local.high) * 0.5f), half = (local.high - local.low) * 0.5f;
  const Vec3f x = abs(rotate(at.rotation, Vec3f{half.x, 0, 0})), y = abs(rotate(at.rotation, Vec3f{0, half.y, 0})),
              z = abs(rotate(at.rotation, Vec3f{0, 0, half.z}));
  const Vec3f reach = x + y + z;
  const float grown = static_cast<float>(mesh.thickness()) + 1e-5f * (largest(centre) + largest(reach));
  return BoxBounds{centre - reach, centre + reach}.grown(grown);
}

/// The turning speed of a half-space, which counts as none, or a mesh, whose vertices may move besides.
float turning_of_other(const BodyPart& part, const BodyState& body) {
  return part.mesh == nullptr ? 0 : turning_speed(body, world_box(*part.mesh, body.pose)) + body.deforming;
}

/// True if a box comes within `margin` of a half-space y <= 0.
bool reaches(const BoxBounds& box, const Posef& half_space, float margin) {
  const Vec3f up = rotate(half_space.rotation, Vec3f{0, 1, 0}), centre = (box.low + box.high) * 0.5f,
              half = (box.high - box.low) * 0.5f;
  return dot(up, centre - half_space.position) - dot(abs(up), half) <=
         margin + 1e-5f * (largest(centre) + largest(half));
}

template <class Visit>
void for_each(const std::vector<int>& of, const Visit& visit) {
  for (const int i : of) visit(i);
}

bool is_inside(const BoxBounds& box, const BoxBounds& larger) {
  return (box.low.x >= larger.low.x) & (box.low.y >= larger.low.y) & (box.low.z >= larger.low.z) &
         (box.high.x <= larger.high.x) & (box.high.y <= larger.high.y) & (box.high.z <= larger.high.z);
}

}  // namespace

BodyPairs::BodyPairs(const std::vector<BodyPart>& parts) {
  size_.reserve(parts.size());
  std::vector<int> family;
  for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
    const BodyPart& part = parts[at(i)];
    (part.is_convex() ? convex_ : others_).push_back(i);
    if (part.is_convex()) family.push_back(part.family);
    size_.push_back(part.is_convex() ? size_of(part.shape) : 1e30f);
    if (part.is_convex()) most_through_ = std::max(most_through_, through_share * size_.back());
  }
  crowds_ = BodyCrowds(family);
  std::vector<int> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return parts[at(a)].id < parts[at(b)].id; });
  rank_.resize(parts.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank_[at(order[i])] = static_cast<int>(i);
}

bool BodyPairs::in_order(const Pair& a, const Pair& b) const {
  return std::pair{rank_[at(a.first)], rank_[at(a.second)]} < std::pair{rank_[at(b.first)], rank_[at(b.second)]};
}

bool BodyPairs::are_apart(int a, int b, float reach) const {
  const BoxBounds &one = still_[at(a)], &other = still_[at(b)];
  const Vec3f gap = max(other.low - one.high, one.low - other.high);
  return std::max({gap.x, gap.y, gap.z}) > reach;
}

void BodyPairs::find_box(const Frame& frame, float faster, int i) {
  const int number = convex_[at(i)];
  const BodyPart& part = frame.parts[at(number)];
  const BodyState& body = frame.bodies[at(part.body)];
  const BoxBounds box = still_[at(number)] = box_of(part, body.pose);
  turning_[at(number)] = turning_speed(body, box) + (body.is_fixed ? 0 : faster);
  boxes_[at(i)] = swept(box, body.velocity * frame.dt)
                      .grown(0.5f * margin_share * size_[at(number)] + frame.dt * turning_[at(number)]);
}

/// Finds the boxes of all convex parts, or, unless `of` is null, of the bodies for which it is not zero.
void BodyPairs::find_boxes(Executor& executor, const Frame& frame, float faster, const std::vector<char>* of) {
  boxes_.resize(convex_.size());
  still_.resize(frame.parts.size());
  turning_.resize(frame.parts.size());
  for (const int part : others_)
    turning_[at(part)] = turning_of_other(frame.parts[at(part)], frame.bodies[at(frame.parts[at(part)].body)]);
  for_items(executor, "bodies: boxes", static_cast<int>(convex_.size()), parts_a_task, [&](int i) {
    if (of == nullptr || (*of)[at(frame.parts[at(convex_[at(i)])].body)] != 0) find_box(frame, faster, i);
  });
}

/// True if each box is still in its larger one, so that near_ has all pairs that overlap.
bool BodyPairs::fits() const {
  if (larger_.size() != boxes_.size()) return false;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (!is_inside(boxes_[i], larger_[i])) return false;
  return true;
}

/// Finds the pairs of a task of crowds_. Those of one part are contiguous and ascending if there is one crowd.
void BodyPairs::find_near(const Frame& frame, int task, std::vector<Pair>& found) {
  std::vector<int> packs, hits;
  found.clear();
  crowds_.overlaps(task, packs, hits, [&](int i, const std::vector<int>& others) {
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    const int a = frame.parts[at(convex_[at(i)])].body;
    for (const int j : others) {
      const int b = frame.parts[at(convex_[at(j)])].body;
      if ((i < j || !crowds_.is_one()) && a != b && frame.meet(std::min(a, b), std::max(a, b)))
        found.emplace_back(std::minmax(i, j));
    }
    std::sort(found.begin() + begin, found.end());
    if (crowds_.is_one()) first_near_[at(i + 1)] = static_cast<int>(found.size()) - static_cast<int>(begin);
  });
}

void BodyPairs::find_near(Executor& executor, const Frame& frame) {
  larger_.clear();
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    larger_.push_back(boxes_[i].grown(spare_share * size_[at(convex_[i])]));
  crowds_.build(larger_);
  const int tasks = crowds_.tasks();
  of_task_.resize(std::max(of_task_.size(), at(tasks)));
  first_near_.assign(boxes_.size() + 1, 0);
  executor.parallel_for(nullptr, tasks, [&](int task) { find_near(frame, task, of_task_[at(task)]); });
  if (!crowds_.is_one()) {
    near_.clear();
    for (int task = 0; task < tasks; ++task)
      near_.insert(near_.end(), of_task_[at(task)].begin(), of_task_[at(task)].end());
    std::sort(near_.begin(), near_.end());
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());  // those of crowd 0 came both ways
    return;
  }
  std::partial_sum(first_near_.begin(), first_near_.end(), first_near_.begin());
  near_.resize(at(first_near_.back()));
  executor.parallel_for(nullptr, tasks, [&](int task) {
    const std::vector<Pair>& found = of_task_[at(task)];
    for (auto pair = found.begin(); pair != found.end();) {
      const int i = pair->first, count = first_near_[at(i + 1)] - first_near_[at(i)];
      std::copy_n(pair, count, near_.begin() + first_near_[at(i)]);
      pair += count;
    }
  });
}

/// Pairs of half-spaces and meshes with convex parts: with all of them, or, unless it is null, with `some` (indices in
/// convex_).
void BodyPairs::find_pairs_of_others(const Frame& frame, const std::vector<int>* some) {
  of_others_.clear();
  for (const int other : others_) {
    const BodyPart& part = frame.parts[at(other)];
    const BodyState& body = frame.bodies[at(part.body)];
    const auto add = [&](int i) {
      const int convex = convex_[at(i)], of = frame.parts[at(convex)].body;
      if (!(body.is_fixed && frame.bodies[at(of)].is_fixed) && frame.meet(part.body, of))
        of_others_.emplace_back(other, convex);
    };
    if (part.is_half_space) {
      const Posef plane = convert<float>(compose(body.pose, part.pose));
      const float grown = frame.dt * length(body.velocity);
      const int count = static_cast<int>(some == nullptr ? boxes_.size() : some->size());
      for (int k = 0; k < count; ++k) {
        const int i = some == nullptr ? k : (*some)[at(k)];
        if (reaches(boxes_[at(i)], plane, grown)) add(i);
      }
    } else {
      const BoxBounds box =
          swept(world_box(*part.mesh, body.pose), body.velocity * frame.dt).grown(frame.dt * turning_[at(other)]);
      // What has been pressed through a flat mesh is below its box, and is held by the side from which it came.
      const auto add_overlapping = [&](int i) {
        if (overlap(boxes_[at(i)].grown(through_share * size_[at(convex_[at(i)])]), box)) add(i);
      };
      some == nullptr ? crowds_.query(box.grown(most_through_), -1, add_overlapping) : for_each(*some, add_overlapping);
    }
  }
  std::sort(of_others_.begin(), of_others_.end(), [&](const Pair& a, const Pair& b) { return in_order(a, b); });
}

/// Finds the pairs of near_ whose boxes overlap: all, or, unless `of` is null, those of the bodies for which it is not
/// zero.
void BodyPairs::find_overlapping(Executor& executor, const Frame& frame, const std::vector<char>* of) {
  const int count = static_cast<int>(near_.size()), tasks = ranges_of(count, pairs_a_task);
  of_task_.resize(std::max(of_task_.size(), at(tasks)));
  const auto body_of = [&](int part) { return at(frame.parts[at(part)].body); };
  for_ranges(executor, nullptr, count, pairs_a_task, [&](int from, int to) {
    std::vector<Pair>& found = of_task_[at(from / pairs_a_task)];
    found.clear();
    for (int k = from; k < to; ++k) {
      const auto& [i, j] = near_[at(k)];
      const int a = convex_[at(i)], b = convex_[at(j)];
      if (of != nullptr && (*of)[body_of(a)] == 0 && (*of)[body_of(b)] == 0) continue;
      if (overlap(boxes_[at(i)], boxes_[at(j)]) &&
          !(frame.bodies[body_of(a)].is_fixed && frame.bodies[body_of(b)].is_fixed))
        found.emplace_back(a, b);
    }
  });
  take_found(tasks);
}

/// Takes the pairs that tasks have found.
void BodyPairs::take_found(int tasks) {
  found_.clear();
  for (int task = 0; task < tasks; ++task)
    found_.insert(found_.end(), of_task_[at(task)].begin(), of_task_[at(task)].end());
}

/// Finds the pairs of renewed_ by the tree of larger boxes, and with all boxes that are no longer in theirs, as those
/// of earlier renewals in the frame. Returns false if near_ costs less.
bool BodyPairs::find_by_tree(Executor& executor, const Frame& frame) {
  std::vector<int> escaped;
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i)
    if (!is_inside(boxes_[at(i)], larger_[at(i)])) escaped.push_back(i);
  if (4 * renewed_.size() > boxes_.size() || escaped.size() * renewed_.size() > 16 * boxes_.size()) return false;
  const auto add = [&](int i, int j, std::vector<Pair>& found) {
    const auto [first, second] = std::minmax(convex_[at(i)], convex_[at(j)]);
    const int a = frame.parts[at(first)].body, b = frame.parts[at(second)].body;
    if (a == b || !overlap(boxes_[at(i)], boxes_[at(j)])) return;
    if (!(frame.bodies[at(a)].is_fixed && frame.bodies[at(b)].is_fixed) && frame.meet(std::min(a, b), std::max(a, b)))
      found.emplace_back(first, second);
  };
  const int count = static_cast<int>(renewed_.size()), tasks = ranges_of(count, renewed_a_task);
  of_task_.resize(std::max(of_task_.size(), at(tasks)));
  for_ranges(executor, nullptr, count, renewed_a_task, [&](int first, int last) {
    std::vector<Pair>& found = of_task_[at(first / renewed_a_task)];
    found.clear();
    for (int k = first; k < last; ++k) {
      const int i = renewed_[at(k)];
      crowds_.query(boxes_[at(i)], i, [&](int j) { add(i, j, found); });
      for (const int j : escaped) add(i, j, found);
    }
  });
  take_found(tasks);
  return true;
}

/// Puts the pairs of renewed parts in the place of those that they had. All others stay, whatever the state of the
/// tree, so that a State that is restored goes on with the same bits.
void BodyPairs::replace(const Frame& frame, const std::vector<char>& of) {
  const auto is_before = [&](const Pair& a, const Pair& b) { return in_order(a, b); };
  found_.insert(found_.end(), of_others_.begin(), of_others_.end());
  std::sort(found_.begin(), found_.end(), is_before);
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  const auto is_replaced = [&](const Pair& pair) {
    const BodyPart &one = frame.parts[at(pair.first)], &other = frame.parts[at(pair.second)];
    if ((one.is_convex() && of[at(one.body)] != 0) || (other.is_convex() && of[at(other.body)] != 0)) return true;
    return frame.bodies[at(one.body)].is_fixed && frame.bodies[at(other.body)].is_fixed;  // beside sleepers
  };
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), is_replaced), pairs_.end());
  const auto kept = static_cast<std::ptrdiff_t>(pairs_.size());
  pairs_.insert(pairs_.end(), found_.begin(), found_.end());
  std::inplace_merge(pairs_.begin(), pairs_.begin() + kept, pairs_.end(), is_before);
}

void BodyPairs::thin_crowd(const Frame& frame) {
  left_out_ = 0;
  if (pairs_.size() <= most_of_crowded * convex_.size()) return;
  std::vector<std::size_t> met(frame.parts.size());
  const auto is_left_out = [&](const Pair& pair) {
    if (frame.bodies[at(frame.parts[at(pair.first)].body)].is_fixed ||
        frame.bodies[at(frame.parts[at(pair.second)].body)].is_fixed)
      return false;
    if (met[at(pair.first)] >= most_of_crowded || met[at(pair.second)] >= most_of_crowded) return true;
    ++met[at(pair.first)];
    ++met[at(pair.second)];
    return false;
  };
  const auto end = std::remove_if(pairs_.begin(), pairs_.end(), is_left_out);
  left_out_ = pairs_.end() - end;
  pairs_.erase(end, pairs_.end());
}

void BodyPairs::update(Executor& executor, const std::vector<BodyPart>& parts, const std::vector<BodyState>& bodies,
                       float dt, float faster, FunctionRef<bool(int, int)> meet) {
  const Frame frame{parts, bodies, dt, meet};
  find_boxes(executor, frame, faster, nullptr);
  const Stopwatch stopwatch(executor.timings(), "bodies: pairs");
  if (!fits()) find_near(executor, frame);
  find_pairs_of_others(frame, nullptr);
  find_overlapping(executor, frame, nullptr);
  pairs_ = of_others_;
  pairs_.insert(pairs_.end(), found_.begin(), found_.end());
  std::inplace_merge(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(of_others_.size()), pairs_.end(),
                     [&](const Pair& a, const Pair& b) { return in_order(a, b); });
  thin_crowd(frame);
}

void BodyPairs::renew(Executor& executor, const std::vector<BodyPart>& parts, const std::vector<BodyState>& bodies,
                      float dt, float faster, FunctionRef<bool(int, int)> meet, const std::vector<char>& of) {
  const Frame frame{parts, bodies, dt, meet};
  find_boxes(executor, frame, faster, &of);
  const Stopwatch stopwatch(executor.timings(), "bodies: pairs");
  renewed_.clear();
  for (int i = 0; i < static_cast<int>(convex_.size()); ++i)
    if (of[at(parts[at(convex_[at(i)])].body)] != 0) renewed_.push_back(i);
  if (!find_by_tree(executor, frame)) {
    if (!fits()) find_near(executor, frame);
    find_overlapping(executor, frame, &of);
  }
  find_pairs_of_others(frame, &renewed_);
  replace(frame, of);
  thin_crowd(frame);
}

}  // namespace pliant
