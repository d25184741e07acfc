// What there is to draw in a World: once what stays, then what each frame changes.

/** Positions of the particles that are there. */
function presentPositions(object, flows) {
  const positions = object.positions();
  if (!flows) return positions;
  const present = object.present();
  const left = new Float32Array(3 * present.length);
  present.forEach((i, at) => left.set(positions.subarray(3 * i, 3 * i + 3), 3 * at));
  return left;
}

/** Positions of tracers that have been emitted. */
function smokePositions(object) {
  const ages = object.channel("age");
  return object.positions().filter((_, i) => ages[Math.floor(i / 3)] >= 0);
}

function frameOf(world, part, { liquidSurfaces = false }) {
  const object = world.object(part.id);
  const frame = {};
  if (part.bodies.length > 0) frame.poses = object.poses();
  if (part.kind === "surface") {
    const { positions, normals, triangles } = object.surface();
    Object.assign(frame, { positions, normals });
    if (part.changes) frame.triangles = triangles;
  } else if (part.kind !== "none") {
    frame.positions = part.kind === "smoke" ? smokePositions(object) : presentPositions(object, part.flows);
    if (part.kind === "lines" && part.changes) frame.lines = object.lines();
    if (part.kind === "liquid" && liquidSurfaces) {
      const { positions, normals, triangles } = object.liquidSurface();
      Object.assign(frame, { surfacePositions: positions, surfaceNormals: normals, surfaceTriangles: triangles });
    }
  }
  return frame;
}

/** What stays: the parts, with triangles and lines of objects, solids of bodies, and meshes of colliders. */
export function readParts(world) {
  const parts = world.parts();
  for (const part of parts.objects) {
    const object = world.object(part.id);
    if (part.kind === "surface") part.triangles = object.surface().triangles;
    if (part.kind === "lines") part.lines = object.lines();
    part.solids = Array.from({ length: part.solids }, (_, i) => object.solid(i));
  }
  for (const part of parts.mesh_colliders) part.mesh = world.meshCollider(part.id);
  return parts;
}

/** What a frame changes: positions and normals [m], poses (position and quaternion x, y, z, w). */
export function readFrame(world, parts, options = {}) {
  return {
    ...world.info,
    objects: parts.objects.map((part) => frameOf(world, part, options)),
    colliders: parts.colliders.map((part) => world.collider(part.id).pose()),
    meshColliders: parts.mesh_colliders.map((part) => {
      const { positions, normals } = world.meshCollider(part.id);
      return { positions, normals };
    }),
  };
}

/** The buffers of a frame, to transfer instead of copying. */
export function buffersOf(frame) {
  const buffers = frame.colliders.map((pose) => pose.buffer);
  for (const thing of [...frame.objects, ...frame.meshColliders])
    for (const list of Object.values(thing)) buffers.push(list.buffer);
  return buffers;
}
