#include "solver/bodies/body_passing.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <utility>

#include "solver/bodies/body_math.h"
#include "solver/free_objects.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// A ball that slides along cloth meets a few triangles in a substep; in all but violent impacts two or three rounds
/// do.
constexpr int rounds_of_both_sides = 8;
/// Up to this round the points stay and the body alone moves, so that it stops before light cloth too. Momentum is not
/// kept then.
constexpr int rounds_of_impulses = 16;
/// In the rounds after those, whatever would still pass goes back to the substep's start, where nothing has passed.
constexpr int most_rounds_of_passing = 32, most_rounds_of_holding = 16;

std::string name_of(const Model& model, const TouchedBody& body) {
  const CompiledObject& object = model.objects[at(body.object)];
  return words_of_body(object.bodies, body.body, object.name);
}

/// Puts a point back to where it was at the substep's start. If nothing fixed acts on it, it keeps its velocity.
void stay(Substep& s, int point) {
  Record& d = s.work.displacements[at(point)];
  const Record& start = s.state.remainders[at(point)];
  const Vec3f moved = xyz(start) - xyz(d);
  if (moved != Vec3f{} && is_free(s, s.model.object_of(point))) s.own->without_velocity.emplace_back(point, moved);
  d = start;
}

/// Puts a body, and with both sides the points, back to where they were at the substep's start. Without the points, it
/// goes with the frame in which their steps were truncated.
void take_back(Substep& s, const BodySolids& solids, const Contact& contact, bool both_sides) {
  const TouchedBody& body = solids.body_of(contact);
  if (s.state.positions[at(body.particle)].w > 0) {
    const std::size_t frame = at(body.frame);
    const Quatf& start = solids.pose_at_start(solids.number_of(contact)).rotation;
    const Vec3f moved = both_sides || !s.has_pairs() ? Vec3f{} : s.pairs->frame_of(body.object);
    s.work.displacements[at(body.particle)] = plus(s.state.remainders[at(body.particle)], moved);
    s.state.frames.orientations[frame] = {start.x, start.y, start.z, start.w};
    s.work.frames.corrections[frame] = plus({}, -xyz(s.work.frames.predicted[frame]));
  }
  if (!both_sides) return;
  for (std::size_t i = 0; i < contact.point.size(); ++i)
    if (contact.weight[i] != 0 && s.state.positions[at(contact.point[i])].w > 0) stay(s, contact.point[i]);
}

/// What else presses on a vertex that a body presses on; empty if nothing does.
std::string other_at(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts, int vertex,
                     int body) {
  for (const Contact& c : contacts) {
    const int number = solids.number_of(c);
    if (c.push > 0 && number != body && std::find(c.point.begin(), c.point.end(), vertex) != c.point.end())
      return name_of(s.model, solids.bodies()[at(number)]);
  }
  const int object = s.model.object_of(vertex), local = vertex - s.model.first[at(object)];
  std::string found;
  for_each_tile(s, [&](int task) {
    if (s.model.tiles()[at(task)].object != object) return;
    for (const Contact& c : s.work.tiles[at(task)].contacts)
      if (c.push > 0 && c.point[0] == local && at(c.collider) < s.model.colliders.size())
        found = "'" + s.model.colliders[at(c.collider)].name + "'";
  });
  return found;
}

}  // namespace

/// Notes what the contacts from number `first` on have moved.
void BodyPassing::note_moved(const Substep& s, const Parts& parts, std::size_t first) {
  moved_vertices_.resize(s.state.positions.size());
  for (const int vertex : listed_vertices_) moved_vertices_[at(vertex)] = 0;
  listed_vertices_.clear();
  const std::vector<Contact>& contacts = parts.impulses.contacts();
  std::vector<char> has_moved(parts.solids.bodies().size(), 0);
  float squared = 0;
  for (std::size_t i = first; i < contacts.size(); ++i) {
    has_moved[at(parts.solids.number_of(contacts[i]))] = 1;
    for (const int vertex : contacts[i].point) {
      squared = max(squared, length_squared(xyz(s.work.displacements[at(vertex)])));
      if (moved_vertices_[at(vertex)] != 0) continue;
      moved_vertices_[at(vertex)] = 1;
      listed_vertices_.push_back(vertex);
    }
  }
  farthest_ = sqrt(squared);
  moved_solids_.clear();
  for (const int body : parts.solids.body_of_solid()) moved_solids_.push_back(has_moved[at(body)]);
}

/// Stops what would pass; not in the first round of a pass, of what the last round has moved. False if there is
/// nothing.
bool BodyPassing::stop_once(Substep& s, const Parts& parts, bool is_first, Stop by) {
  BodySolids& solids = parts.solids;
  SurfaceTiles& surfaces = parts.surfaces;
  SweptContacts& swept = parts.swept;
  PointImpulses& impulses = parts.impulses;
  solids.place(s);
  impulses.note_progress(s, solids);
  if (is_first) surfaces.update(s, solids.moving(), false);
  const BodySolids& all = solids;  // clang 14 captures no structured binding
  const auto meets = [&](const Contact& c) { return all.meets(s.model, c); };
  std::vector<Contact> more;
  if (swept.has_fast()) swept.detect(s, surfaces, solids.moving(), meets, more);
  const PassingFilter::Moved moved{is_first ? nullptr : &moved_solids_, &moved_vertices_, is_first ? 0 : farthest_};
  filter_.find(s, surfaces, solids.moving(), moved, meets, more);
  std::erase_if(more, [&](const Contact& c) { return parts.led_out.leads_out(s, parts.solids, c); });
  if (more.empty()) return false;
  const std::size_t first = impulses.append(more);
  if (by == Stop::back || by == Stop::bodies_back) {
    for (const Contact& contact : more) take_back(s, solids, contact, by == Stop::back);
  } else {
    impulses.project_from(s, solids, first, parts.motions, by == Stop::both_sides);
  }
  note_moved(s, parts, first);
  return true;
}

namespace {

/// Why a body and a surface overlap, and what to do. What presses from the other side is the cause where something
/// does. Else the vertex is held; else the substeps were too few for the impact, or nothing was apart at the start.
std::string cause_of(const Substep& s, int vertex, const std::string& other) {
  if (!other.empty())
    return "it is pinched between that body and " + other + "; give it more room, or name more substeps";
  if (s.state.positions[at(vertex)].w == 0) return "the vertex is pinned; move the pin away, or let the body yield";
  return "they hit one another too hard for " + std::to_string(s.planned) +
         (s.planned == 1 ? " substep" : " substeps") +
         " a frame, or overlapped when they came into contact; name more substeps, or move them apart";
}

}  // namespace

void BodyPassing::begin_alone(const Substep& s, const BodySolids& solids) {
  before_alone_.clear();
  before_alone_.reserve(solids.bodies().size());
  for (const TouchedBody& body : solids.bodies())
    before_alone_.emplace_back(s.work.displacements[at(body.particle)], s.work.frames.corrections[at(body.frame)]);
}

/// What moves bodies alone takes momentum from them. Of those on which nothing fixed acts it moves positions, and no
/// velocities.
void BodyPassing::end_alone(Substep& s, const BodySolids& solids) {
  Vec3d lost{};
  for (std::size_t b = 0; b < before_alone_.size(); ++b) {
    const TouchedBody& body = solids.bodies()[b];
    const auto& [displacement, correction] = before_alone_[b];
    const Vec3f moved = xyz(s.work.displacements[at(body.particle)]) - xyz(displacement);
    if (moved == Vec3f{} && xyz(s.work.frames.corrections[at(body.frame)]) == xyz(correction)) continue;
    if (!is_free(s, body.object)) {
      if (const float w = s.state.positions[at(body.particle)].w; w > 0)
        lost += convert<double>(moved) * (1 / (double(w) * double(s.h)));
      continue;
    }
    if (moved != Vec3f{}) s.own->without_velocity.emplace_back(body.particle, moved);
    Record& corrections = s.work.frames.corrections[at(body.frame)];
    Record& predicted = s.work.frames.predicted[at(body.frame)];
    predicted = plus(predicted, xyz(corrections) - xyz(correction));
    corrections = correction;
  }
  before_alone_.clear();
  s.report.lost_momentum.filter += length(lost);
}

void BodyPassing::stop_passing(Substep& s, const Parts& parts) {
  const Stopwatch stopwatch(s.context.executor.timings(), "bodies: filter");
  is_done_ = false;
  for (int round = 0; round < most_rounds_of_passing && !is_done_; ++round) {
    if (round == rounds_of_both_sides) begin_alone(s, parts.solids);
    const Stop by = round < rounds_of_both_sides ? Stop::both_sides
                    : round < rounds_of_impulses ? Stop::bodies
                                                 : Stop::back;
    is_done_ = !stop_once(s, parts, round == 0, by);
  }
  end_alone(s, parts.solids);
  kept_.clear();
  for (const SurfaceTile& tile : parts.surfaces.tiles())
    if (!tile.solids.empty())
      kept_.insert(kept_.end(), s.work.displacements.begin() + tile.first, s.work.displacements.begin() + tile.last);
}

/// True if a particle near solids has another displacement than after stop_passing.
bool BodyPassing::has_moved(const Substep& s, const SurfaceTiles& surfaces) const {
  const Record* kept = kept_.data();
  for (const SurfaceTile& tile : surfaces.tiles()) {
    if (tile.solids.empty()) continue;
    const std::size_t count = at(tile.last - tile.first);
    const Record* const now = &s.work.displacements[at(tile.first)];
    const auto are_same = [](const Record& a, const Record& b) { return xyz(a) == xyz(b); };
    if (std::memcmp(kept, now, count * sizeof(Record)) != 0 && !std::equal(kept, kept + count, now, are_same))
      return true;
    kept += count;
  }
  return false;
}

void BodyPassing::hold_bodies(Substep& s, const Parts& parts) {
  const Stopwatch stopwatch(s.context.executor.timings(), "bodies: filter");
  bool goes_on = !is_done_ || has_moved(s, parts.surfaces) || !s.own->without_velocity.empty();
  begin_alone(s, parts.solids);
  for (int round = 0; round < most_rounds_of_holding && goes_on; ++round)
    goes_on = stop_once(s, parts, round == 0, round < rounds_of_both_sides ? Stop::bodies : Stop::bodies_back);
  end_alone(s, parts.solids);
  if (goes_on) parts.solids.place(s);
  filter_.end_substep(!goes_on);
}

void BodyPassing::warn_of_overlaps(const Substep& s, const Found& found, std::vector<std::string>& warnings) const {
  const BodySolids& solids = found.solids;
  struct Between {
    int count = 0, vertex = 0;
    std::string other;
  };
  std::map<std::pair<int, int>, Between> all;  // object of the surface and body
  for (const PassingFilter::Overlap& overlap : filter_.overlaps()) {
    const int body = solids.body_of_solid()[at(overlap.solid)];
    const auto is_told = [&](const PointDepenetration::Inside& inside) {
      return inside.way.object == overlap.object && solids.body_of_solid()[at(inside.way.solid)] == body;
    };
    if (std::any_of(found.inside.begin(), found.inside.end(), is_told)) continue;
    Between& between = all[{overlap.object, body}];
    if (between.count++ == 0) between.vertex = overlap.vertex;
    if (between.other.empty()) between.other = other_at(s, solids, found.contacts, overlap.vertex, body);
  }
  for (const auto& [which, between] : all) {
    const CompiledObject& object = s.model.objects[at(which.first)];
    const int vertex = object.order[at(between.vertex - s.model.first[at(which.first)])];
    warnings.push_back("object '" + object.name + "' passes through " +
                       name_of(s.model, solids.bodies()[at(which.second)]) + " in " + std::to_string(between.count) +
                       (between.count == 1 ? " triangle" : " triangles") + ", the first at vertex " +
                       std::to_string(vertex) + ": " + cause_of(s, between.vertex, between.other));
  }
}

}  // namespace pliant
