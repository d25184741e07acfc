#include "collision/narrow/point_contacts.h"

#include <algorithm>
#include <iterator>

#include "math/record.h"
#include "math/vector.h"
#include "parallel/ranges.h"

namespace pliant {

namespace {

/// Activation distance over the thickness. It exceeds 1, since other contacts may push a point nearer within the
/// substep.
constexpr float reach_over_thickness = 1.25f;
/// Packets of the BVH per task.
constexpr int packets_a_task = 32;
/// Points per task that look for lines.
constexpr int points_a_task = 256;

/// The swept box of a point, grown by half the activation distance.
BoxBounds swept_box(const Record& position, const Record& displacement, float thickness) {
  const Vec3f from = xyz(position), to = from + xyz(displacement);
  const Vec3f low = min(from, to), high = max(from, to);
  const float grown = 0.5f * reach_over_thickness * thickness + 1e-6f * (largest(low) + largest(high));
  return {low - Vec3f{grown, grown, grown}, high + Vec3f{grown, grown, grown}};
}

/// The smallest t at which the path x + t m comes within `distance` of the origin; the path must start farther away.
float first_within(const Vec3f& x, const Vec3f& m, float distance) {
  const float b = dot(x, m), c = dot(x, x) - distance * distance;
  const float root = sqrt(max(b * b - dot(m, m) * c, 0.f));
  return min(c / max(root - b, 1e-30f), 1.f);
}

/// Fills the normal, gap and material of a contact; false if the path from x to x + m stays clear of the origin.
bool find_contact(const Vec3f& x, const Vec3f& m, const PairMaterial& material, float h, Contact& contact) {
  const float thickness = material.thickness, distance = length(x), mm = dot(m, m);
  const float closest = mm > 0 ? clamp(-dot(x, m) / mm, 0.f, 1.f) : 0.f;
  const float least = length(x + m * closest);
  if (!(least < reach_over_thickness * thickness)) return false;
  float t = closest, kept = thickness;
  if (distance <= thickness) {
    t = 0;
    kept = min(thickness, distance + largest_pair_separation_speed * h);
  } else if (least < thickness) {
    t = first_within(x, m, thickness);
  }
  contact = {};
  contact.normal = unit_or(x + m * t, Vec3f{0, 1, 0});  // fallback for coincident points: straight up
  contact.gap = dot(contact.normal, x) - kept;
  contact.thickness = kept;
  contact.static_friction = material.static_friction;
  contact.kinetic_friction = material.kinetic_friction;
  contact.restitution = material.restitution;
  return true;
}

void complete(const PairMaterial& material, const PairParticles& particles, Contact& contact) {
  complete_contact(contact, particles.positions, particles.remainders);
  if (material.restitution > 0) contact.approach = approach_of(contact, particles.displacements, particles.h);
}

}  // namespace

bool find_point_contact(int i, int j, const PairMaterial& material, const PairParticles& particles, Contact& contact) {
  const Record &p = particles.positions[i], &q = particles.positions[j];
  if (!(p.w + q.w > 0)) return false;
  const Vec3f x = xyz(p) - xyz(q);
  const Vec3f m = xyz(particles.displacements[i]) - xyz(particles.displacements[j]);
  if (!find_contact(x, m, material, particles.h, contact)) return false;
  contact.point = {i, j, i, i};
  contact.weight = {1, -1, 0, 0};
  complete(material, particles, contact);
  return true;
}

bool find_line_contact(int i, const std::array<int, 2>& line, const PairMaterial& material,
                       const PairParticles& particles, Contact& contact) {
  const Record &p = particles.positions[i], &a = particles.positions[line[0]], &b = particles.positions[line[1]];
  if (!(p.w + a.w + b.w > 0)) return false;
  const Vec3f along = xyz(b) - xyz(a), from = xyz(p) - xyz(a);
  const float squared = dot(along, along), share = squared > 0 ? clamp(dot(from, along) / squared, 0.f, 1.f) : 0.f;
  const Vec3f start = xyz(particles.displacements[line[0]]), end = xyz(particles.displacements[line[1]]);
  const Vec3f m = xyz(particles.displacements[i]) - (start + (end - start) * share);
  if (!find_contact(from - along * share, m, material, particles.h, contact)) return false;
  contact.point = {i, line[0], line[1], i};
  contact.weight = {1, share - 1, -share, 0};
  complete(material, particles, contact);
  return true;
}

PairMaterial PointContacts::material_of(int i, int j) const {
  const std::vector<int>& body = model_.shared->vertex_body;
  return model_.shared->rules.material(body[static_cast<std::size_t>(i)], body[static_cast<std::size_t>(j)]);
}

bool PointContacts::meet(int i, int j) const {
  const std::vector<int>& body = model_.shared->vertex_body;
  return model_.shared->rules.meet(body[static_cast<std::size_t>(i)], body[static_cast<std::size_t>(j)]);
}

const std::vector<int>& PointContacts::present(const std::vector<int>& points, const PairParticles& particles) {
  if (particles.births == nullptr) return points;
  present_.clear();
  std::copy_if(points.begin(), points.end(), std::back_inserter(present_),
               [&](int point) { return particles.births[point] != not_there; });
  return present_;
}

void PointContacts::detect(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts) {
  detect_points(executor, particles, contacts);
  detect_lines(executor, particles, contacts);
}

void PointContacts::detect_lines(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts) {
  const std::vector<int>& points = present(model_.points_at_lines, particles);
  const int lines = static_cast<int>(model_.lines.size()), count = static_cast<int>(points.size());
  if (lines == 0 || count == 0) return;
  const auto box_of = [&](int i) {
    return swept_box(particles.positions[i], particles.displacements[i], model_.largest_thickness);
  };
  boxes_.resize(static_cast<std::size_t>(lines));
  for (std::size_t l = 0; l < boxes_.size(); ++l) {
    const BoxBounds a = box_of(model_.lines[l][0]), b = box_of(model_.lines[l][1]);
    boxes_[l] = {min(a.low, b.low), max(a.high, b.high)};
  }
  tree_.build(boxes_);
  tasks_.resize(static_cast<std::size_t>(ranges_of(count, points_a_task)));
  for_ranges(executor, "detect contacts", count, points_a_task, [&](int first, int last) {
    Task& task = tasks_[static_cast<std::size_t>(first / points_a_task)];
    task.pairs.clear();
    for (int k = first; k < last; ++k) {
      const int i = points[static_cast<std::size_t>(k)];
      tree_.query(box_of(i), [&](int l) {
        if (meet(i, model_.lines[static_cast<std::size_t>(l)][0])) task.pairs.push_back({i, l});
      });
    }
  });
  pairs_.clear();
  for (const Task& task : tasks_) pairs_.insert(pairs_.end(), task.pairs.begin(), task.pairs.end());
  std::sort(pairs_.begin(), pairs_.end());
  for (const auto& [i, l] : pairs_) {
    const std::array<int, 2>& line = model_.lines[static_cast<std::size_t>(l)];
    Contact contact;
    if (find_line_contact(i, line, material_of(i, line[0]), particles, contact)) contacts.push_back(contact);
  }
}

void PointContacts::detect_points(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts) {
  const std::vector<int>& points = present(model_.free_points, particles);
  if (points.empty()) return;
  boxes_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    boxes_[i] = swept_box(particles.positions[points[i]], particles.displacements[points[i]], model_.largest_thickness);
  tree_.build(boxes_);
  const int packets = tree_.packet_count();
  tasks_.resize(static_cast<std::size_t>(ranges_of(packets, packets_a_task)));
  const auto collect = [&](Task& task, int a, const std::vector<int>& others) {
    for (const int b : others) {
      if (b <= a) continue;
      const int i = points[static_cast<std::size_t>(a)], j = points[static_cast<std::size_t>(b)];
      Contact contact;
      if (meet(i, j) && find_point_contact(i, j, material_of(i, j), particles, contact)) task.pairs.push_back({i, j});
    }
  };
  for_ranges(executor, "detect contacts", packets, packets_a_task, [&](int first, int last) {
    Task& task = tasks_[static_cast<std::size_t>(first / packets_a_task)];
    task.pairs.clear();
    for (int packet = first; packet < last; ++packet)
      tree_.packet_overlaps(packet, tree_, task.packs, task.hits,
                            [&](int a, const std::vector<int>& others) { collect(task, a, others); });
  });
  pairs_.clear();
  for (const Task& task : tasks_) pairs_.insert(pairs_.end(), task.pairs.begin(), task.pairs.end());
  std::sort(pairs_.begin(), pairs_.end());
  for (const auto& [i, j] : pairs_) {
    contacts.emplace_back();
    find_point_contact(i, j, material_of(i, j), particles, contacts.back());
  }
}

}  // namespace pliant
