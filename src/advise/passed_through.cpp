#include "advise/passed_through.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "pliant/queries.h"

namespace pliant {

namespace {

struct Box {
  Vec3f low, high;
};

Box box_of(const std::vector<Vec3f>& positions) {
  Box box{positions.front(), positions.front()};
  for (const Vec3f& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y && a.low.z <= b.high.z &&
         b.low.z <= a.high.z;
}

std::string count_of(std::size_t crossings) {
  return std::to_string(crossings) + (crossings == 1 ? " crossing" : " crossings");
}

std::string at_frame(const World& world) { return "frame " + std::to_string(world.state().frame) + ": "; }

void look_at_itself(const Scene& scene, const World& world, int o, std::vector<std::string>& found) {
  const Object& object = scene.objects[static_cast<std::size_t>(o)];
  if (object.self_collision || object.triangles.empty()) return;
  CrossingFinder finder(object.triangles, static_cast<int>(object.positions.size()));
  if (!finder.find(object.positions).empty()) return;
  const std::vector<Crossing> crossings = finder.find(world.object(o).positions());
  if (crossings.empty()) return;
  const Crossing& first = crossings.front();
  found.push_back(at_frame(world) + "object '" + object.name + "': edge " + std::to_string(first.a) + "-" +
                  std::to_string(first.b) + " passes through triangle " + std::to_string(first.triangle) +
                  " of the same object, one of " + count_of(crossings.size()) +
                  ", because it has no contact with itself; set its \"self_collision\" to true and give it a thickness");
}

/// Two objects whose surfaces groups and masks let meet, while one of them at least has no `collides`.
class Pair {
 public:
  Pair(const Object& a, const Object& b) : a_(a), b_(b) {}

  static bool is_open(const Object& a, const Object& b) {
    const bool masks_permit = (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
    return masks_permit && !(a.collides && b.collides) && !a.triangles.empty() && !b.triangles.empty();
  }

  /// The number of edges of one that pass through triangles of the other.
  std::size_t crossings(const std::vector<Vec3f>& of_a, const std::vector<Vec3f>& of_b) const {
    const auto offset = static_cast<int>(of_a.size());
    std::vector<std::array<int, 3>> triangles = a_.triangles;
    for (const auto& t : b_.triangles) triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    std::vector<Vec3f> positions = of_a;
    positions.insert(positions.end(), of_b.begin(), of_b.end());
    CrossingFinder finder(triangles, static_cast<int>(positions.size()));
    const std::vector<Crossing>& all = finder.find(positions);
    return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Crossing& crossing) {
      const bool edge_of_a = crossing.a < offset;
      const bool triangle_of_a = crossing.triangle < static_cast<int>(a_.triangles.size());
      return edge_of_a != triangle_of_a;
    }));
  }

  std::string words(std::size_t crossings) const {
    const std::string which = a_.collides ? "'" + b_.name + "'" : b_.collides ? "'" + a_.name + "'" : "both";
    return "object '" + a_.name + "' passes through object '" + b_.name + "' in " + count_of(crossings) +
           ", because they have no contact with each other; set \"collides\" of " + which + " to true";
  }

 private:
  const Object &a_, &b_;
};

void look_at_pairs(const Scene& scene, const World& world, std::vector<std::string>& found) {
  std::vector<std::vector<Vec3f>> now;
  std::vector<Box> boxes;
  now.reserve(scene.objects.size());
  boxes.reserve(scene.objects.size());
  for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) {
    now.push_back(world.object(o).positions());
    boxes.push_back(now.back().empty() ? Box{} : box_of(now.back()));
  }
  std::string first;
  std::size_t more = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = i + 1; j < now.size(); ++j) {
      const Object &a = scene.objects[i], &b = scene.objects[j];
      if (!overlap(boxes[i], boxes[j]) || !Pair::is_open(a, b)) continue;
      const Pair pair(a, b);
      const std::size_t crossings = pair.crossings(now[i], now[j]);
      if (crossings == 0 || pair.crossings(a.positions, b.positions) > 0) continue;
      if (first.empty())
        first = at_frame(world) + pair.words(crossings);
      else
        ++more;
    }
  if (more > 0) first += "; so do " + std::to_string(more) + (more == 1 ? " more pair" : " more pairs") + " of objects";
  if (!first.empty()) found.push_back(first);
}

}  // namespace

std::vector<std::string> passed_through(const Scene& scene, const World& world) {
  std::vector<std::string> found;
  for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) look_at_itself(scene, world, o, found);
  look_at_pairs(scene, world, found);
  return found;
}

}  // namespace pliant
