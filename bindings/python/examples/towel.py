"""Two fingers grip a towel that hangs on a rod, the rod is taken away, and they lift it: forces at the fingers' joints."""

import numpy as np

import pliant

FINGER_MASS = 0.05  # kg
FINGER = {"solids": [{"box": {"half_extents": [0.015, 0.015, 0.005]}}], "mass": FINGER_MASS}
FRICTION = {"static_friction": 0.8, "kinetic_friction": 0.7, "collides": True}


def make_scene(grip: float = 3.0) -> pliant.Scene:
    """The scene. `grip`: greatest force of the fingers [N]."""
    scene = pliant.Scene(frame_time=1 / 60)
    mesh = {"grid": {"columns": 17, "rows": 33, "width": 0.2, "depth": 0.4}, "translate": [0, 0.52, 0]}
    scene.add(name="towel", cloth={"mesh": mesh, "material": "cotton"}, self_collision=True, **FRICTION)
    along_x = {"axis": [0, 0, 1], "degrees": 90}
    scene.add_collider(name="rod", capsule={"radius": 0.01, "half_length": 0.2}, rotation=along_x, position=[0, 0.5, 0])
    hand = {"name": "hand", "kinematic": True, "solids": [{"sphere": {"radius": 0.005}}], "position": [0.2, 0.44, 0]}
    fingers = {"left": -0.05, "right": 0.05}
    scene.add(
        name="gripper",
        bodies=[hand, *({"name": name, "position": [0, 0.44, z], **FINGER} for name, z in fingers.items())],
        joints=[
            {
                "name": name,
                "between": ["hand", name],
                "slider": {"anchor": [0, 0.44, z], "axis": [0, 0, 1], "motor": {"speed": 0, "most": grip}},
            }
            for name, z in fingers.items()
        ],
        **FRICTION,
    )
    return scene


def main() -> None:
    world = pliant.World(make_scene())
    gripper, towel = world["gripper"], world["towel"]
    world.record_joint_loads()
    world.run(90)  # the towel comes to rest on the rod
    gripper.set_motor("left", target=0.05)  # m/s
    gripper.set_motor("right", target=-0.05)
    world.run(60)
    world.remove(world.collider("rod"))
    loads = []
    for frame in range(220):
        gripper.set_pose("hand", (0.2, 0.44 + 0.3 * min(frame / 120, 1), 0))
        report = world.step()
        if not report.ok:
            raise SystemExit(report.explain())
        loads.append([gripper.mean_joint_load(name).force for name in ("left", "right")])
    forces = np.array(loads)  # (frames, fingers, 3) [N]; plot them: plt.plot(forces[:, 0])
    print(f"the towel is between {towel.positions()[:, 1].min():.2f} and {towel.positions()[:, 1].max():.2f} m")
    print(f"the left finger grips with {forces[-60:, 0, 2].mean():.2f} N")
    load = forces[-60:, :, 1].sum(axis=1).mean() - 2 * FINGER_MASS * 9.81
    weight = 0.2 * 0.4 * pliant.fabrics()["cotton"]["area_density"] * 9.81
    print(f"the fingers bear {load:.3f} N; the towel weighs {weight:.3f} N")


if __name__ == "__main__":
    main()
