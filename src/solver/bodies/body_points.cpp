#include "solver/bodies/body_points.h"

#include <algorithm>
#include <cstddef>

#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

BodyPoints::BodyPoints(const Model& model, const std::vector<int>& objects, const std::vector<TouchedBody>& bodies,
                       const ContactRules& rules) {
  for (const int o : objects)
    if (!model.objects[at(o)].is_collider &&
        model.objects[at(o)].particles > static_cast<int>(model.objects[at(o)].bodies.bodies.size()))
      objects_.push_back(o);
  solids_ = BodySolids(bodies, rules);
  if (objects_.empty()) return;
  solids_.add_solids(model);
  for (int task = 0; task < static_cast<int>(model.tiles().size()); ++task)
    if (std::binary_search(objects_.begin(), objects_.end(), model.tiles()[at(task)].object)) tasks_.push_back(task);
  of_task_.resize(tasks_.size());
  surfaces_ = SurfaceTiles(model, tasks_);
  loads_ = PointLoads(model, bodies);
  passing_ = BodyPassing(solids_);
  depenetration_ = PointDepenetration(solids_.convex_shapes());
  const std::vector<LocalShape> primitives = solids_.primitives();
  for (const int o : objects_) shapes_.prepare(model, o, primitives);
}

void BodyPoints::begin_frame(const Substep& s) {
  impulses_.begin_frame();
  passing_.begin_frame();
  surfaces_.begin_frame();
  keep_poses(s);
}

void BodyPoints::keep_poses(const Substep& s) {
  if (has_any()) solids_.keep_poses(s);
}

void BodyPoints::detect(Substep& s) {
  solids_.place(s);
  loads_.note_pressed(s, {impulses_.contacts(), impulses_.impulses(), solids_.body_of_solid()});
  {
    const Stopwatch stopwatch(s.context.executor.timings(), "bodies: points");
    surfaces_.update(s, solids_.moving(), true);
  }
  near_.clear();
  for (const SurfaceTile& tile : surfaces_.tiles()) near_.push_back(&tile.solids);
  s.context.executor.parallel_for("bodies: points", static_cast<int>(tasks_.size()), [&](int i) {
    const int task = tasks_[at(i)], number = s.model.tiles()[at(task)].object;
    std::vector<Contact>& found = of_task_[at(i)];
    found.clear();
    const AdvanceArguments a = particles(s, task);
    TileScratch& scratch = s.work.tiles[at(task)];
    const SurfaceTile& tile = surfaces_.tiles()[at(i)];
    find_contacts({object_of(s, task), a, scratch.bounds, solids_.moving(), s.kernels.find_near,
                   s.kernels.contacts.make_point_contacts, &tile.solids, &surfaces_.near_points(i),
                   s.model.first[at(number)], tile.fastest},
                  scratch.near, found);
    for (Contact& contact : found)
      for (std::int32_t& point : contact.point) point += s.model.first[at(number)];
  });
  std::vector<Contact>& contacts = impulses_.contacts();
  contacts.clear();
  for (const std::vector<Contact>& found : of_task_) contacts.insert(contacts.end(), found.begin(), found.end());
  shapes_.detect(s.context.executor,
                 {s.model, solids_.moving(), [&](int task) { return particles(s, task); },
                  [&](int task) -> const PointBounds& { return s.work.tiles[at(task)].bounds; }, &tasks_, &near_},
                 of_shapes_);
  contacts.insert(contacts.end(), of_shapes_.begin(), of_shapes_.end());
  const auto meets = [&](const Contact& c) { return solids_.meets(s.model, c); };
  swept_.detect(s, surfaces_, solids_.moving(), meets, contacts);
  std::erase_if(contacts, [&](const Contact& c) { return !meets(c); });
  depenetration_.replace(s, solids_, contacts);
  impulses_.begin_substep(s, solids_);
}

void BodyPoints::stop_passing(Substep& s, const std::vector<BodyMotion>& motions) {
  if (has_any()) passing_.stop_passing(s, {solids_, surfaces_, swept_, impulses_, motions, depenetration_});
}

void BodyPoints::hold_bodies(Substep& s, const std::vector<BodyMotion>& motions) {
  if (has_any()) passing_.hold_bodies(s, {solids_, surfaces_, swept_, impulses_, motions, depenetration_});
}

}  // namespace pliant
