// What each object, collider and contact looks like in three.js.
import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import type { ColliderShape, Contact, FrameObject, Id, Mesh, ObjectPart, Parts } from "pliant";

/** What a pick refers to. */
export interface Grip {
  id: Id;
  /** Of a rigid body: its particle. */
  particle?: number;
  isCollider?: boolean;
}

const fewLines = 6000;
const manyBalls = 2000;
const manyBodies = 2000;
const manyPuffs = 1500; // what is transparent is slow
const creaseAngle = 0.65; // [rad]

export function colourOf([r, g, b]: readonly number[]): THREE.Color {
  return new THREE.Color().setRGB(r, g, b, THREE.LinearSRGBColorSpace);
}

let isPlain = false;

/** Draws what is made from now on without highlights. */
export function drawPlainly(): void {
  isPlain = true;
}

type Look = THREE.MeshStandardMaterial | THREE.MeshLambertMaterial;

function material(colour: readonly number[], { roughness = 0.75, ...more }: THREE.MeshStandardMaterialParameters = {}): Look {
  const all = { color: colourOf(colour), ...more };
  return isPlain ? new THREE.MeshLambertMaterial(all) : new THREE.MeshStandardMaterial({ ...all, roughness, metalness: 0 });
}

function geometryOf(mesh: Mesh): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(mesh.normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
  return geometry;
}

/** A drawn thing that a frame moves. */
export interface Drawn {
  thing: THREE.Object3D;
  /** Grip of a pick at that instance. */
  grip?: (instance: number | undefined) => Grip | undefined;
  update?: (frame: FrameObject) => void;
  edges?: (shown: boolean) => void;
}

/** Puts an array into an attribute, which is made anew if its length changed. */
function put(geometry: THREE.BufferGeometry, name: string, values: Float32Array): void {
  const old = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
  if (old && old.array.length === values.length) {
    (old.array as Float32Array).set(values);
    old.needsUpdate = true;
    return;
  }
  geometry.dispose(); // frees the old buffers on the graphics card
  geometry.setAttribute(name, new THREE.BufferAttribute(values, 3).setUsage(THREE.DynamicDrawUsage));
}

function drawSurface(part: ObjectPart): Drawn {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(part.triangles!, 1));
  const mesh = new THREE.Mesh(geometry, material(part.colour, { side: THREE.DoubleSide, shadowSide: THREE.BackSide }));
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  return {
    thing: mesh,
    grip: () => ({ id: part.id }),
    update: (frame) => {
      put(geometry, "position", frame.positions!);
      put(geometry, "normal", frame.normals!);
      if (frame.triangles) geometry.setIndex(new THREE.BufferAttribute(frame.triangles, 1));
      geometry.boundingSphere = null;
    },
    edges: (shown) => {
      mesh.material.wireframe = shown;
    },
  };
}

/** Instances of one ball, which are moved only. */
function drawBalls(part: ObjectPart, more: THREE.MeshStandardMaterialParameters = {}): Drawn {
  const group = new THREE.Group();
  let balls: THREE.InstancedMesh | undefined;
  let room = 0;
  const grow = (count: number) => {
    if (balls) {
      group.remove(balls);
      balls.dispose();
    }
    room = Math.max(count, 2 * room);
    const ball = room > manyBalls ? new THREE.SphereGeometry(part.radius, 6, 4) : new THREE.IcosahedronGeometry(part.radius, 2);
    balls = new THREE.InstancedMesh(ball, material(part.colour, more), room);
    balls.castShadow = balls.receiveShadow = room <= manyBalls; // software rendering takes seconds otherwise
    balls.frustumCulled = false;
    const one = new THREE.Matrix4();
    for (let i = 0; i < room; ++i) balls.setMatrixAt(i, one);
    group.add(balls);
  };
  return {
    thing: group,
    grip: () => ({ id: part.id }),
    update: ({ positions }) => {
      const count = positions!.length / 3;
      if (!balls || count > room) grow(count);
      const matrices = balls!.instanceMatrix.array;
      for (let i = 0; i < count; ++i) matrices.set(positions!.subarray(3 * i, 3 * i + 3), 16 * i + 12);
      balls!.count = count;
      balls!.instanceMatrix.needsUpdate = true;
      balls!.boundingSphere = null;
    },
  };
}

/** A liquid: its particles as balls, or the surface around them. */
function drawLiquid(part: ObjectPart): Drawn {
  const group = new THREE.Group();
  const balls = drawBalls(part, { roughness: 0.25 });
  const geometry = new THREE.BufferGeometry();
  const surface = new THREE.Mesh(geometry, material(part.colour, { roughness: 0.12, transparent: true, opacity: 0.85 }));
  surface.castShadow = surface.receiveShadow = true;
  surface.frustumCulled = false;
  group.add(balls.thing, surface);
  return {
    thing: group,
    grip: () => ({ id: part.id }),
    update: (frame) => {
      balls.update!(frame);
      surface.visible = frame.surfaceTriangles !== undefined;
      balls.thing.visible = !surface.visible;
      if (!surface.visible) return;
      put(geometry, "position", frame.surfacePositions!);
      put(geometry, "normal", frame.surfaceNormals!);
      geometry.setIndex(new THREE.BufferAttribute(frame.surfaceTriangles!, 1));
      geometry.boundingSphere = null;
    },
  };
}

/** Thin lines: hair. */
function drawThinLines(part: ObjectPart): Drawn {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(part.lines!, 1));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colourOf(part.colour) }));
  lines.frustumCulled = false;
  return {
    thing: lines,
    grip: () => ({ id: part.id }),
    update: (frame) => {
      put(geometry, "position", frame.positions!);
      if (frame.lines) geometry.setIndex(new THREE.BufferAttribute(frame.lines, 1));
      geometry.boundingSphere = null;
    },
  };
}

/** A cylinder for each link of a rope, and a ball at each particle. */
function drawRope(part: ObjectPart): Drawn {
  const group = new THREE.Group();
  const look = material(part.colour);
  const radius = Math.max(part.radius, 1e-4);
  const links = new THREE.InstancedMesh(new THREE.CylinderGeometry(1, 1, 1, 10, 1, true), look, part.lines!.length / 2);
  links.castShadow = links.receiveShadow = true;
  links.frustumCulled = false;
  const ends = drawBalls(part);
  group.add(links, ends.thing);
  let lines = part.lines!;
  const [a, b, turn, matrix] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Quaternion(), new THREE.Matrix4()];
  const [up, size] = [new THREE.Vector3(0, 1, 0), new THREE.Vector3()];
  return {
    thing: group,
    grip: () => ({ id: part.id }),
    update: (frame) => {
      ends.update!(frame);
      if (frame.lines) lines = frame.lines;
      links.count = lines.length / 2;
      for (let i = 0; i < links.count; ++i) {
        a.fromArray(frame.positions!, 3 * lines[2 * i]);
        b.fromArray(frame.positions!, 3 * lines[2 * i + 1]);
        const length = a.distanceTo(b);
        size.set(radius, length, radius);
        turn.setFromUnitVectors(up, b.clone().sub(a).normalize());
        links.setMatrixAt(i, matrix.compose(a.add(b).multiplyScalar(0.5), turn, size));
      }
      links.instanceMatrix.needsUpdate = true;
      links.boundingSphere = null;
    },
  };
}

function drawSmoke(part: ObjectPart): Drawn {
  const geometry = new THREE.BufferGeometry();
  const points = new THREE.Points(
    geometry,
    new THREE.PointsMaterial({
      color: colourOf(part.colour),
      size: 3 * part.radius,
      transparent: true,
      opacity: 0.16,
      depthWrite: false,
      map: softDot(),
    }),
  );
  points.frustumCulled = false;
  return {
    thing: points,
    update: ({ positions }) => {
      const stride = Math.ceil(positions!.length / 3 / manyPuffs);
      if (stride <= 1) return put(geometry, "position", positions!);
      put(geometry, "position", new Float32Array(positions!.filter((_, i) => Math.floor(i / 3) % stride === 0)));
      points.material.opacity = Math.min(0.5, 0.16 * Math.sqrt(stride));
    },
  };
}

function softDot(): THREE.Texture {
  const size = 32;
  const pixels = new Uint8Array(4 * size * size);
  for (let i = 0; i < size * size; ++i) {
    const away = Math.hypot((i % size) - 15.5, Math.floor(i / size) - 15.5) / 16;
    pixels.set([255, 255, 255, 255 * Math.max(0, 1 - away) ** 1.5], 4 * i);
  }
  const texture = new THREE.DataTexture(pixels, size, size);
  texture.needsUpdate = true;
  return texture;
}

/** Neighbouring bodies differ in brightness, so that a pile can be read. */
const shades = [1, 0.82, 1.12, 0.9, 1.06, 0.76, 0.96];

/** The ends of a long solid, in its own axes: where it reaches farthest along its longest side. */
function endsOf({ positions }: Mesh): [THREE.Vector3, THREE.Vector3] {
  const box = new THREE.Box3().setFromArray(positions as unknown as number[]);
  const [size, middle] = [box.getSize(new THREE.Vector3()), box.getCenter(new THREE.Vector3())];
  const axis = size.toArray().indexOf(Math.max(...size.toArray()));
  const half = new THREE.Vector3().setComponent(axis, size.getComponent(axis) / 2);
  return [middle.clone().sub(half), middle.clone().add(half)];
}

/** Very many bodies, such as the segments of hair: a line for each. */
function drawThinBodies(part: ObjectPart): Drawn[] {
  const ends = part.solids.map(endsOf);
  const positions = new Float32Array(6 * part.bodies.length);
  const geometry = new THREE.BufferGeometry();
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colourOf(part.colour) }));
  lines.frustumCulled = false;
  const [centre, turn, end] = [new THREE.Vector3(), new THREE.Quaternion(), new THREE.Vector3()];
  return [
    {
      thing: lines,
      grip: () => ({ id: part.id }),
      update: ({ poses }) => {
        part.bodies.forEach((body, i) => {
          centre.fromArray(poses!, 7 * i);
          turn.fromArray(poses!, 7 * i + 3);
          ends[body.solid].forEach((from, k) => end.copy(from).applyQuaternion(turn).add(centre).toArray(positions, 6 * i + 3 * k));
        });
        put(geometry, "position", positions);
        geometry.boundingSphere = null;
      },
    },
  ];
}

/** The rigid bodies of an object: instances of each of its solids. */
function drawBodies(part: ObjectPart): Drawn[] {
  if (part.bodies.length > manyBodies) return drawThinBodies(part);
  return part.solids.map((solid, s) => {
    const bodies = part.bodies.map((body, index) => ({ ...body, index })).filter((body) => body.solid === s);
    const geometry = toCreasedNormals(geometryOf(solid), creaseAngle);
    const mesh = new THREE.InstancedMesh(geometry, material([1, 1, 1]), bodies.length);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    bodies.forEach((body, i) =>
      mesh.setColorAt(i, colourOf(part.colour.map((c) => Math.min(1, c * shades[body.index % shades.length])))),
    );
    const [matrix, position, turn, one] = [new THREE.Matrix4(), new THREE.Vector3(), new THREE.Quaternion(), new THREE.Vector3(1, 1, 1)];
    return {
      thing: mesh,
      grip: (instance) =>
        instance === undefined || bodies[instance].fixed ? undefined : { id: part.id, particle: bodies[instance].particle },
      update: ({ poses }) => {
        bodies.forEach((body, i) => {
          position.fromArray(poses!, 7 * body.index);
          turn.fromArray(poses!, 7 * body.index + 3);
          mesh.setMatrixAt(i, matrix.compose(position, turn, one));
        });
        mesh.instanceMatrix.needsUpdate = true;
        mesh.boundingSphere = null;
      },
    };
  });
}

function drawMatter(part: ObjectPart): Drawn[] {
  switch (part.kind) {
    case "surface":
      return [drawSurface(part)];
    case "lines":
      return [part.lines!.length / 2 > fewLines ? drawThinLines(part) : drawRope(part)];
    case "balls":
      return [drawBalls(part)];
    case "liquid":
      return [drawLiquid(part)];
    case "smoke":
      return [drawSmoke(part)];
    default:
      return [];
  }
}

export function drawObject(part: ObjectPart): Drawn[] {
  return [...drawBodies(part), ...drawMatter(part)];
}

function shapeGeometry(shape: ColliderShape, extent: number): THREE.BufferGeometry {
  switch (shape.kind) {
    case "sphere":
      return new THREE.SphereGeometry(shape.radius, 48, 32);
    case "box":
      return new THREE.BoxGeometry(...(shape.half_extents.map((h) => 2 * h) as [number, number, number]));
    case "capsule":
      return new THREE.CapsuleGeometry(shape.radius, 2 * shape.half_length, 16, 32);
    default:
      return new THREE.CircleGeometry(40 * extent, 64).rotateX(-Math.PI / 2);
  }
}

export function drawCollider(collider: Parts["colliders"][number], extent: number): Drawn & { pose: (pose: Float32Array) => void } {
  const isPlane = collider.shape.kind === "plane";
  const mesh = new THREE.Mesh(
    shapeGeometry(collider.shape, extent),
    material(isPlane ? [0.5, 0.51, 0.51] : collider.colour, { roughness: 0.9 }),
  );
  mesh.castShadow = !isPlane;
  mesh.receiveShadow = true;
  const fixed = isPlane || collider.is_keyframed;
  return {
    thing: mesh,
    grip: () => (fixed ? undefined : { id: collider.id, isCollider: true }),
    pose: (pose) => {
      mesh.position.fromArray(pose, 0);
      mesh.quaternion.fromArray(pose, 3);
    },
  };
}

export function drawMeshCollider(collider: Parts["mesh_colliders"][number]): Drawn {
  const geometry = geometryOf(collider.mesh);
  const mesh = new THREE.Mesh(geometry, material(collider.colour, { side: THREE.DoubleSide, shadowSide: THREE.BackSide }));
  mesh.castShadow = mesh.receiveShadow = true;
  return {
    thing: mesh,
    grip: () => undefined,
    update: (frame) => {
      put(geometry, "position", frame.positions!);
      put(geometry, "normal", frame.normals!);
      geometry.boundingSphere = null;
    },
  };
}

/** Contacts: a dot at the mean position of two things' contacts, and a stroke along the push. */
export class ContactMarks {
  readonly thing = new THREE.Group();
  private readonly dots: THREE.Points;
  private readonly strokes: THREE.LineSegments;
  constructor(private readonly extent: number) {
    const colour = 0xd4271c;
    this.dots = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: colour, size: 9, sizeAttenuation: false, depthTest: false }),
    );
    this.strokes = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: colour, depthTest: false }),
    );
    for (const mark of [this.dots, this.strokes]) {
      mark.frustumCulled = false;
      mark.renderOrder = 1;
      this.thing.add(mark);
    }
  }
  show(contacts: Contact[]): void {
    const now = contacts.filter((contact) => contact.change !== "ended");
    const long = 0.12 * this.extent;
    const dots = new Float32Array(now.flatMap((contact) => contact.position));
    const strokes = new Float32Array(
      now.flatMap(({ position, normal }) => [...position, ...position.map((x, k) => x + long * normal[k])]),
    );
    put(this.dots.geometry, "position", dots);
    put(this.strokes.geometry, "position", strokes);
  }
}
