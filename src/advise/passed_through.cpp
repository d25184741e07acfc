#include "advise/passed_through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "collision/broad/bounds.h"
#include "pliant/queries.h"

namespace pliant {

namespace {

BoxBounds box_of(const std::vector<Vec3f>& positions) {
  BoxBounds box{positions.front(), positions.front()};
  for (const Vec3f& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

std::string count_of(std::size_t crossings) {
  return std::to_string(crossings) + (crossings == 1 ? " crossing" : " crossings");
}

std::string at_frame(const World& world) { return "frame " + std::to_string(world.state().frame) + ": "; }

bool is_free(const Object& object) {
  std::vector<char> fixed(object.positions.size(), 0);
  for (const Pin& pin : object.pins) fixed[static_cast<std::size_t>(pin.particle)] = 1;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] == 0 && std::isfinite(object.masses[i])) return true;
  return false;
}

/// True if nothing makes contact between two surfaces that groups and masks let meet, and one of them can move.
bool are_open(const Object& a, const Object& b) {
  const bool masks_permit = (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
  const bool have_surfaces = !a.triangles.empty() && !b.triangles.empty();
  return masks_permit && have_surfaces && !(a.collides && b.collides) && (is_free(a) || is_free(b));
}

/// Adds the triangles of a surface that reach into a box.
void add_triangles(const Object& object, const std::vector<Vec3f>& positions, const BoxBounds& box, int offset,
                   std::vector<std::array<int, 3>>& triangles) {
  for (const auto& t : object.triangles) {
    const auto corner = [&](int c) { return positions[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])]; };
    if (overlap(box_of({corner(0), corner(1), corner(2)}), box))
      triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

/// The number of edges of one surface that pass through triangles of the other.
std::size_t crossings_of(const Object& a, const std::vector<Vec3f>& of_a, const Object& b,
                         const std::vector<Vec3f>& of_b) {
  const BoxBounds box_of_a = box_of(of_a), box_of_b = box_of(of_b);
  if (!overlap(box_of_a, box_of_b)) return 0;
  const auto offset = static_cast<int>(of_a.size());
  std::vector<std::array<int, 3>> triangles;
  add_triangles(a, of_a, box_of_b, 0, triangles);
  const auto first_of_b = static_cast<int>(triangles.size());
  add_triangles(b, of_b, box_of_a, offset, triangles);
  std::vector<Vec3f> positions = of_a;
  positions.insert(positions.end(), of_b.begin(), of_b.end());
  CrossingFinder finder(triangles, static_cast<int>(positions.size()));
  const std::vector<Crossing>& all = finder.find(positions);
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Crossing& crossing) {
    return (crossing.a < offset) != (crossing.triangle < first_of_b);
  }));
}

std::string in_words(const Object& a, const Object& b, std::size_t crossings) {
  const std::string which = a.collides ? "'" + b.name + "'" : b.collides ? "'" + a.name + "'" : "both";
  return "object '" + a.name + "' passes through object '" + b.name + "' in " + count_of(crossings) +
         ", because they have no contact with each other; set \"collides\" of " + which + " to true";
}

}  // namespace

std::vector<std::string> passed_through_themselves(const Scene& scene, const World& world) {
  std::vector<std::string> found;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.self_collision || object.triangles.empty()) continue;
    CrossingFinder finder(object.triangles, static_cast<int>(object.positions.size()));
    if (!finder.find(object.positions).empty()) continue;
    const std::vector<Crossing> crossings = finder.find(world.object(static_cast<int>(o)).positions());
    if (crossings.empty()) continue;
    const Crossing& first = crossings.front();
    found.push_back(
        at_frame(world) + "object '" + object.name + "': edge " + std::to_string(first.a) + "-" +
        std::to_string(first.b) + " passes through triangle " + std::to_string(first.triangle) +
        " of the same object, one of " + count_of(crossings.size()) +
        ", because it has no contact with itself; set its \"self_collision\" to true and give it a thickness");
  }
  return found;
}

void PassingObjects::look(const World& world, const std::function<bool()>& stops) {
  std::vector<std::vector<Vec3f>> now;
  std::vector<BoxBounds> boxes;
  now.reserve(scene_.objects.size());
  boxes.reserve(scene_.objects.size());
  for (int o = 0; o < static_cast<int>(scene_.objects.size()); ++o) {
    now.push_back(world.object(o).positions());
    boxes.push_back(now.back().empty() ? BoxBounds{} : box_of(now.back()));
  }
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = i + 1; j < now.size(); ++j) {
      const Object &a = scene_.objects[i], &b = scene_.objects[j];
      if (!overlap(boxes[i], boxes[j]) || done_.count({i, j}) > 0 || !are_open(a, b)) continue;
      if (stops()) return;
      const std::size_t crossings = crossings_of(a, now[i], b, now[j]);
      if (crossings == 0) continue;
      done_.insert({i, j});
      if (crossings_of(a, a.positions, b, b.positions) > 0) continue;
      if (found_++ == 0) first_ = at_frame(world) + in_words(a, b, crossings);
    }
}

std::string PassingObjects::warning() const {
  if (found_ < 2) return first_;
  return first_ + "; so do " + std::to_string(found_ - 1) + (found_ == 2 ? " more pair" : " more pairs") +
         " of objects";
}

}  // namespace pliant
