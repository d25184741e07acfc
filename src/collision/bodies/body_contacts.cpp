#include "collision/bodies/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "collision/bodies/mesh_contacts.h"
#include "geometry/convex_contact.h"

namespace pliant {

namespace {

constexpr int parts_a_task = 256, pairs_a_task = 64;
/// A contact stays while its bodies have moved less against each other since it began than this share of the smaller part's size, and
/// turned by less than 1.6 degrees (cosine of half the angle).
constexpr double still_share = 0.04, straight = 0.9999;
/// Parts nearer than this share of the smaller one's size have a contact.
constexpr double margin_share = 0.04;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Posed relative_pose(const Posed& a, const Posed& b) {
  return {to_local(a, b.position), normalise(multiply(conjugate(a.rotation), b.rotation))};
}

/// How far a part reaches from its frame's origin in six directions of some frame.
struct Extent {
  Vec3d low{}, high{};
};

Extent extent_of(const ConvexShape& shape, const Posed& pose) {
  const auto farthest = [&](const Vec3d& direction) {
    const Vec3d local = rotate(conjugate(pose.rotation), direction);
    return dot(direction, to_world(pose, support(shape, local))) + static_cast<double>(shape.radius);
  };
  return {{-farthest({-1, 0, 0}), -farthest({0, -1, 0}), -farthest({0, 0, -1})},
          {farthest({1, 0, 0}), farthest({0, 1, 0}), farthest({0, 0, 1})}};
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

/// The turning speed of a half-space, which counts as none, or a mesh.
float turning_of_other(const BodyPart& part, const BodyState& body) {
  return part.mesh == nullptr ? 0 : turning_speed(body, world_box(*part.mesh, body.pose));
}

/// True if a box comes within `margin` of a half-space y <= 0.
bool reaches(const BoxBounds& box, const Posef& half_space, float margin) {
  const Vec3f up = rotate(half_space.rotation, Vec3f{0, 1, 0}), centre = (box.low + box.high) * 0.5f,
              half = (box.high - box.low) * 0.5f;
  return dot(up, centre - half_space.position) - dot(abs(up), half) <= margin + 1e-5f * (largest(centre) + largest(half));
}

/// Where two bodies are in one place, no direction separates them. They count as a little apart, each pair in a direction of its own.
Posed apart(Posed relative, int a, int b, double size) {
  if (!(length(relative.position) < 1e-4 * size)) return relative;
  std::uint32_t mixed = static_cast<std::uint32_t>(a) * 2654435761u ^ static_cast<std::uint32_t>(b) * 2246822519u;
  const auto next = [&] {
    mixed ^= mixed << 13, mixed ^= mixed >> 17, mixed ^= mixed << 5;
    return static_cast<double>(mixed) / 2147483648.0 - 1;
  };
  const double x = next(), y = next(), z = next();
  relative.position += unit_or(Vec3d{x, y, z}, Vec3d{0, 1, 0}) * (1e-3 * size);
  return relative;
}

bool hardly_moved(const Posed& now, const BodyContact& contact, double size) {
  return length(now.position - contact.position) < still_share * size &&
         std::fabs(dot(now.rotation, contact.rotation)) > straight;
}

/// Normal and arms are those of the world, so a contact does not stay where both bodies turn together.
bool hardly_turned(const Quatd& now, const BodyContact& contact) {
  return std::fabs(dot(now, convert<double>(contact.turned))) > straight;
}

void renew_gaps(const Posed& a, const Posed& b, BodyContact& c) {
  for (std::size_t i = 0; i < at(c.count); ++i)
    c.gap[i] = static_cast<float>(dot(convert<double>(c.normal), to_world(b, c.anchor_b[i]) - to_world(a, c.anchor_a[i])));
}

/// Contact points of two parts in the frame of body a.
Touch touch_of(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, double reach) {
  const Posed pose = relative_pose(a.pose, compose(b_in_a, b.pose));
  Touch found = a.is_half_space ? touch_half_space(b.shape, pose, reach) : touch(a.shape, b.shape, pose, reach);
  found.normal = rotate(a.pose.rotation, found.normal);
  for (int i = 0; i < found.count; ++i) {
    TouchPoint& point = found.points[at(i)];
    point.on_a = to_world(a.pose, point.on_a);
    point.on_b = to_world(a.pose, point.on_b);
  }
  return found;
}

void set_directions(BodyContact& c, const Vec3d& normal) {
  const Vec3d size = abs(normal);
  const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                     : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                          : Vec3d{0, 0, 1};
  const Vec3d first = unit_or(cross(normal, axis), axis);
  c.normal = convert<float>(normal);
  c.tangent1 = convert<float>(first);
  c.tangent2 = convert<float>(cross(normal, first));
}

/// Places the points of a new contact.
void set_points(const Touch& found, const Posed& a, const Posed& b, BodyContact& c) {
  c.count = found.count;
  set_directions(c, rotate(a.rotation, found.normal));
  Vec3d centre{};
  for (int i = 0; i < found.count; ++i) {
    const TouchPoint& point = found.points[at(i)];
    centre += to_world(a, (point.on_a + point.on_b) * 0.5) * (1. / found.count);
  }
  c.arm_a = convert<float>(centre - a.position);
  c.arm_b = convert<float>(centre - b.position);
  for (std::size_t i = 0; i < at(found.count); ++i) {
    const TouchPoint& point = found.points[i];
    const Vec3f place = convert<float>(to_world(a, (point.on_a + point.on_b) * 0.5) - centre);
    c.x[i] = dot(place, c.tangent1);
    c.y[i] = dot(place, c.tangent2);
    c.gap[i] = static_cast<float>(point.separation);
    c.anchor_a[i] = point.on_a;
    c.anchor_b[i] = to_local(b, to_world(a, point.on_b));
    c.feature[i] = point.feature;
  }
}

/// Hands the impulses of an earlier contact of the same parts to the points that are the same.
void take_impulses(const BodyContact& old, BodyContact& c) {
  for (std::size_t i = 0; i < at(c.count); ++i)
    for (std::size_t j = 0; j < at(old.count); ++j)
      if (c.feature[i] == old.feature[j]) c.impulse[i] = old.impulse[j];
  const Vec3f friction = old.tangent1 * old.friction_impulse[0] + old.tangent2 * old.friction_impulse[1];
  c.friction_impulse = {dot(friction, c.tangent1), dot(friction, c.tangent2)};
  c.twist_impulse = old.twist_impulse;
  c.substep = old.substep;
}

auto solids_of(const BodyContact& c) { return std::tuple{c.a.owner, c.a.solid, c.b.owner, c.b.solid}; }

/// Finds the contacts of two parts in the frame before. Pairs are mostly asked for in ascending order, so the search begins where
/// the last one ended.
class ContactsBefore {
 public:
  explicit ContactsBefore(const std::vector<BodyContact>& before) : all_(before) {}

  std::span<const BodyContact> find(const ContactPart& a, const ContactPart& b) {
    const std::tuple wanted{a.owner, a.solid, b.owner, b.solid};
    const auto is_before = [&](const BodyContact& c) { return solids_of(c) < wanted; };
    std::size_t first = next_, steps = 0;
    while (first < all_.size() && steps < most_steps && is_before(all_[first])) ++first, ++steps;
    const bool is_found = steps < most_steps && first > 0 && is_before(all_[first - 1]);
    if (!is_found)
      first = static_cast<std::size_t>(std::partition_point(all_.begin(), all_.end(), is_before) - all_.begin());
    std::size_t last = first;
    while (last < all_.size() && solids_of(all_[last]) == wanted) ++last;
    next_ = last;
    return std::span(all_).subspan(first, last - first);
  }

 private:
  static constexpr std::size_t most_steps = 8;  ///< beyond, a binary search is faster

  const std::vector<BodyContact>& all_;
  std::size_t next_ = 0;
};

/// The contact of the frame before with the same piece, or else the one whose normal agrees best; null if none is similar.
const BodyContact* like(const BodyContact& c, std::span<const BodyContact> before) {
  const BodyContact* best = nullptr;
  float closest = 0.9f;
  for (const BodyContact& old : before) {
    const float agreement = old.a.piece == c.a.piece ? 2 : dot(old.normal, c.normal);
    if (!(agreement > closest)) continue;
    closest = agreement;
    best = &old;
  }
  return best;
}

}  // namespace

/// What the search for the contact of one pair needs.
struct BodyContacts::Task {
  const BodyContacts& of;
  const std::vector<BodyState>& bodies;
  const std::vector<BodyContact>& before;
  float dt;

  /// Finds the contacts of pairs [first, last).
  void run(int first, int last, Found& found) const {
    found.clear();
    ContactsBefore contacts(before);
    for (int i = first; i < last; ++i) {
      const Pair& pair = of.pairs_[at(i)];
      find(pair, contacts.find(of.parts_[at(pair.first)].id, of.parts_[at(pair.second)].id), found);
    }
  }

  /// Copies the contacts that run has found to their places, and renews the gaps of those that stay.
  static void place(const Found& found, const std::vector<BodyState>& bodies, BodyContact* to) {
    auto made = found.made.begin();
    for (const Piece& piece : found.pieces) {
      if (piece.stays.empty()) *to++ = *made++;
      for (const BodyContact& contact : piece.stays) {
        *to = contact;
        renew_gaps(bodies[at(piece.a)].pose, bodies[at(piece.b)].pose, *to++);
      }
    }
  }

  void find(const Pair& pair, std::span<const BodyContact> old, Found& found) const {
    const BodyPart &one = of.parts_[at(pair.first)], &other = of.parts_[at(pair.second)];
    const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
    const Posed relative = relative_pose(a.pose, b.pose);
    const double size = static_cast<double>(std::min(of.size_[at(pair.first)], of.size_[at(pair.second)]));
    const auto stays = [&](const BodyContact& contact) {
      return hardly_moved(relative, contact, size) && hardly_turned(a.pose.rotation, contact);
    };
    if (!old.empty() && !a.deforms && std::all_of(old.begin(), old.end(), stays)) {
      found.pieces.push_back({old, one.body, other.body});
      found.count += old.size();
      return;
    }
    const float fast = length(a.velocity - b.velocity) + of.turning_[at(pair.first)] + of.turning_[at(pair.second)];
    const double reach = margin_share * size + static_cast<double>(dt * fast);
    const auto add = [&](const Touch& touching, int piece) {
      if (touching.count == 0) return;
      BodyContact contact;
      contact.a = one.id;
      contact.a.piece = piece;
      contact.b = other.id;
      contact.position = relative.position;
      contact.rotation = relative.rotation;
      contact.turned = convert<float>(a.pose.rotation);
      set_points(touching, a.pose, b.pose, contact);
      if (const BodyContact* alike = like(contact, old)) take_impulses(*alike, contact);
      found.pieces.emplace_back();
      found.made.push_back(contact);
      ++found.count;
    };
    if (one.mesh == nullptr) return add(touch_of(one, other, apart(relative, one.body, other.body, size), reach), 0);
    std::vector<MeshTouch> touches;
    touch_mesh(other.shape, compose(relative, other.pose), *one.mesh, reach, touches);
    for (const MeshTouch& touching : touches) add(touching.touch, touching.piece);
  }
};

bool in_order(const BodyContact& a, const BodyContact& b) {
  return std::tuple{solids_of(a), a.a.piece, a.b.piece} < std::tuple{solids_of(b), b.a.piece, b.b.piece};
}

BodyContacts::BodyContacts(std::vector<BodyPart> parts) : parts_(std::move(parts)) {
  size_.reserve(parts_.size());
  for (int i = 0; i < static_cast<int>(parts_.size()); ++i) {
    const BodyPart& part = parts_[at(i)];
    (part.is_convex() ? convex_ : others_).push_back(i);
    size_.push_back(part.is_convex() ? size_of(part.shape) : 1e30f);
  }
}

void BodyContacts::find_boxes(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster) {
  const int count = static_cast<int>(convex_.size());
  boxes_.resize(convex_.size());
  turning_.resize(parts_.size());
  for (const int part : others_) turning_[at(part)] = turning_of_other(parts_[at(part)], bodies[at(parts_[at(part)].body)]);
  executor.parallel_for("bodies: boxes", (count + parts_a_task - 1) / parts_a_task, [&](int task) {
    for (int i = task * parts_a_task; i < std::min(count, (task + 1) * parts_a_task); ++i) {
      const int number = convex_[at(i)];
      const BodyPart& part = parts_[at(number)];
      const BodyState& body = bodies[at(part.body)];
      const BoxBounds box = box_of(part, body.pose);
      turning_[at(number)] = turning_speed(body, box) + (body.is_fixed ? 0 : faster);
      boxes_[at(i)] = swept(box, body.velocity * dt)
                          .grown(0.5f * static_cast<float>(margin_share) * size_[at(number)] + dt * turning_[at(number)]);
    }
  });
}

void BodyContacts::thin_crowd(const std::vector<BodyState>& bodies) {
  left_out_ = 0;
  if (pairs_.size() <= most_of_crowded * convex_.size()) return;
  std::vector<std::size_t> met(parts_.size());
  const auto is_left_out = [&](const Pair& pair) {
    if (bodies[at(parts_[at(pair.first)].body)].is_fixed || bodies[at(parts_[at(pair.second)].body)].is_fixed) return false;
    if (met[at(pair.first)] >= most_of_crowded || met[at(pair.second)] >= most_of_crowded) return true;
    ++met[at(pair.first)];
    ++met[at(pair.second)];
    return false;
  };
  const auto end = std::remove_if(pairs_.begin(), pairs_.end(), is_left_out);
  left_out_ = pairs_.end() - end;
  pairs_.erase(end, pairs_.end());
}

void BodyContacts::find_pairs(const std::vector<BodyState>& bodies, float dt, FunctionRef<bool(int, int)> meet) {
  pairs_.clear();
  const auto add = [&](int i, int j) {
    const int a = parts_[at(i)].body, b = parts_[at(j)].body;
    const bool are_fixed = bodies[at(a)].is_fixed && bodies[at(b)].is_fixed;
    if (a != b && !are_fixed && meet(a, b)) pairs_.emplace_back(i, j);
  };
  tree_.build(boxes_);
  tree_.self_pairs([&](int i, int j) { add(convex_[at(std::min(i, j))], convex_[at(std::max(i, j))]); });
  for (const int other : others_) {
    const BodyPart& part = parts_[at(other)];
    const BodyState& body = bodies[at(part.body)];
    if (part.is_half_space) {
      const Posef plane = convert<float>(compose(body.pose, part.pose));
      const float grown = dt * length(body.velocity);
      for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (reaches(boxes_[i], plane, grown)) add(other, convex_[i]);
    } else {
      const BoxBounds box = swept(world_box(*part.mesh, body.pose), body.velocity * dt).grown(dt * turning_[at(other)]);
      tree_.query(box, [&](int i) { add(other, convex_[at(i)]); });
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  thin_crowd(bodies);
}

void BodyContacts::update(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
                          FunctionRef<bool(int, int)> meet, const std::vector<BodyContact>& before,
                          std::vector<BodyContact>& now) {
  find_boxes(executor, bodies, dt, faster);
  {
    const Stopwatch stopwatch(executor.timings(), "bodies: pairs");
    find_pairs(bodies, dt, meet);
  }
  const int count = static_cast<int>(pairs_.size()), tasks = (count + pairs_a_task - 1) / pairs_a_task;
  if (static_cast<int>(found_.size()) < tasks) found_.resize(at(tasks));
  const Task task_of_pair{*this, bodies, before, dt};
  executor.parallel_for("bodies: contacts", tasks, [&](int task) {
    task_of_pair.run(task * pairs_a_task, std::min(count, (task + 1) * pairs_a_task), found_[at(task)]);
  });
  std::vector<std::size_t> first(1, 0);
  for (int task = 0; task < tasks; ++task) first.push_back(first.back() + found_[at(task)].count);
  now.resize(first.back());
  executor.parallel_for("bodies: contacts", tasks,
                        [&](int task) { Task::place(found_[at(task)], bodies, now.data() + first[at(task)]); });
  if (!std::is_sorted(now.begin(), now.end(), in_order)) std::sort(now.begin(), now.end(), in_order);
}

}  // namespace pliant
