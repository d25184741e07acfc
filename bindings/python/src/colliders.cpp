// pliant.Collider and pliant.MeshCollider.

#include "colliders.h"
#include "arrays.h"

namespace pliant::python {

nb::object pose_object(const RigidPose& pose) {
  static const nb::object* type = new nb::object(python_part("pliant._types", "Pose"));
  const Quatf& q = pose.rotation;
  return (*type)(tuple_of(pose.position), nb::make_tuple(q.x, q.y, q.z, q.w));
}

RigidPose pose_from(nb::handle position, nb::handle rotation) {
  return {vector_from(position, "position"), quaternion_from(rotation, "rotation")};
}

nb::tuple tuple_of(const Vec3f& v) { return nb::make_tuple(v.x, v.y, v.z); }

namespace {

/// What both kinds of colliders have in common.
template <class Ref>
void bind_moves(nb::class_<Ref>& c) {
  c.def_prop_ro(
       "name", [](const Ref& r) { return r.name; }, "Its name.")
      .def_prop_ro(
          "exists", [](const Ref& r) { return r.world->idle().has(r.id); }, "False after it was removed.")
      .def(
          "set_pose",
          [](const Ref& r, nb::handle position, nb::handle rotation) {
            r.handle().set_pose(pose_from(position, rotation));
          },
          nb::arg("position"), nb::arg("rotation") = nb::make_tuple(0, 0, 0, 1),
          nb::sig(
              "def set_pose(self, position: pliant._types.VectorLike, rotation: pliant._types.VectorLike = (0, 0, 0, "
              "1)) -> None"),
          "Moves it to a pose that it reaches at the end of the next step: position [m] at constant velocity, rotation "
          "(x, "
          "y, z, w) "
          "along the shorter arc. After that it stays.")
      .def(
          "teleport",
          [](const Ref& r, nb::handle position, nb::handle rotation) {
            r.handle().teleport(pose_from(position, rotation));
          },
          nb::arg("position") = nb::make_tuple(0, 0, 0), nb::arg("rotation") = nb::make_tuple(0, 0, 0, 1),
          nb::sig(
              "def teleport(self, position: pliant._types.VectorLike = (0, 0, 0), rotation: pliant._types.VectorLike = "
              "(0, 0, 0, 1)) -> None"),
          "Moves it at once, rotated about the origin and then moved [m]; what it touches gets no velocity.")
      .def(
          "set_surface_velocity",
          [](const Ref& r, nb::handle v) { r.handle().set_surface_velocity(vector_from(v, "velocity")); },
          nb::arg("velocity"), nb::sig("def set_surface_velocity(self, velocity: pliant._types.VectorLike) -> None"),
          "Gives its surface a velocity along itself in its own frame, as a conveyor belt has [m/s].");
}

}  // namespace

void bind_colliders(nb::module_& m) {
  nb::class_<ColliderRef> collider(
      m, "Collider", nb::type_slots(collected_slots<ColliderRef>()),
      "A primitive collider of a World, to read and move between steps: world.collider(\"name\").");
  bind_moves(collider);
  collider
      .def(
          "pose", [](const ColliderRef& r) { return pose_object(r.view().pose()); },
          nb::sig("def pose(self) -> pliant._types.Pose"), "Its pose: position [m] and rotation (x, y, z, w).")
      .def("__repr__", [](const ColliderRef& r) { return "<pliant.Collider '" + r.name + "'>"; });

  nb::class_<MeshColliderRef> mesh(
      m, "MeshCollider", nb::type_slots(collected_slots<MeshColliderRef>()),
      "A mesh collider of a World, to read and move between steps: world.mesh_collider(\"name\"). Poses "
      "move its vertices from where the scene places them: at the start its pose is the identity.");
  bind_moves(mesh);
  mesh.def(
          "positions",
          [](const MeshColliderRef& r, nb::handle out) {
            const MeshColliderView view = r.view();
            return filled_vectors(out, static_cast<std::size_t>(view.vertex_count()),
                                  [&](std::span<Vec3f> into) { view.read_positions(into); });
          },
          nb::arg("out") = nb::none(),
          nb::sig("def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
          "Positions of its vertices [m], shape (vertices, 3). `out` as in Object.positions().")
      .def(
          "set_positions",
          [](const MeshColliderRef& r, nb::handle positions) {
            r.handle().set_positions(Numbers(positions, 'f', 3, "positions").vectors());
          },
          nb::arg("positions"), nb::sig("def set_positions(self, positions: pliant._types.VectorsLike) -> None"),
          "Moves its vertices to positions that they reach at the end of the next step [m]; only where it collides as "
          "triangles.")
      .def("__repr__", [](const MeshColliderRef& r) { return "<pliant.MeshCollider '" + r.name + "'>"; });
}

}  // namespace pliant::python
