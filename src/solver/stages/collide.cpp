#include "model/surface_velocity.h"
#include "solver/collider_depenetration.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Finds contacts of edges and triangles with primitive colliders.
void collide_with_shapes(Substep& s) {
  std::vector<Contact>& found = s.own->shape_contacts;
  found.clear();
  if (s.own->colliders.empty()) return;
  const auto particles_of = [&](int task) { return particles(s, task); };
  const auto bounds_of = [&](int task) -> const PointBounds& { return s.work.tiles[task].bounds; };
  s.work.shape_contacts.detect(
      s.context.executor,
      {s.model, s.own->colliders, particles_of, bounds_of, s.part == nullptr ? nullptr : &s.part->tiles}, found);
  drop_elements_inside(s, found);
  s.own->shape_contact_solver.begin(s.kernels.contacts, found, 0, s.state.positions.data(), s.state.positions.size());
}

/// Adds what the surfaces of mesh colliders move along themselves to the motion of contacts with them.
void add_slides_of_meshes(Substep& s) {
  if (!some_meshes_slide(s.model, s.work.control)) return;
  std::vector<Vec3f> slides(s.model.objects.size());
  for (int o = 0; o < static_cast<int>(slides.size()); ++o)
    slides[at(o)] = surface_velocity_of_mesh(s.model, s.work.control, o, s.time_after) * s.h;
  for (Contact& c : s.pairs->contacts())
    for (std::size_t i = 0; i < c.point.size(); ++i) {
      if (c.weight[i] == 0) continue;
      const Vec3f& slide = slides[at(s.model.object_of(c.point[i]))];
      if (slide == Vec3f{}) continue;
      const Vec3f along = slide - c.normal * dot(c.normal, slide);
      c.surface_motion = c.weight[i] < 0 ? along : -along;  // of the second side, which has negative weights
      break;
    }
}

}  // namespace

void collide(Substep& s) {
  collide_with_shapes(s);
  note_speeds(s);
  for_systems(s, [&](System& system) { system.collide(s); });
  if (!s.has_pairs()) return;
  s.pairs->detect(s.context.executor, all_particles(s));
  add_slides_of_meshes(s);
  s.own->contact_solver.begin(s.kernels.contacts, s.pairs->contacts(), s.pairs->static_contacts(),
                              s.state.positions.data(), s.state.positions.size());
}

}  // namespace pliant
