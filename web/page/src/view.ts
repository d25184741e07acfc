// The picture: camera, light, and what is in the World. It draws when something changed.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Parts } from "pliant";
import type { WorkerFrame } from "pliant/client";
import { ContactMarks, drawCollider, drawMeshCollider, drawObject, drawPlainly, type Drawn, type Grip } from "./matter";

const sky = 0xdfe4e8;

/** The "camera" of a scene's text. */
export interface SceneCamera {
  look_at?: number[];
  distance?: number;
  azimuth?: number;
  elevation?: number;
  position?: number[];
  fov?: number;
}

const usual = { azimuth: 28, elevation: 18, fov: 30 }; // [degrees]
const filled = 0.86; // share of the picture that the scene fills
const measured = 1000; // how often drawing is timed to its end, which makes the page wait [ms]

/** True where the processor draws, for want of a graphics card: there shading is what takes the time. */
function drawsInSoftware(context: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const name = context.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER;
  return /SwiftShader|llvmpipe|softpipe|Basic Render/i.test(context.getParameter(name));
}

export interface Pick {
  grip: Grip;
  point: THREE.Vector3;
}

export class View {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly isSlow: boolean;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(38, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  private readonly sun = new THREE.DirectionalLight(0xffffff, 2.6);
  private content = new THREE.Group();
  private objects: Drawn[][] = [];
  private colliders: ReturnType<typeof drawCollider>[] = [];
  private meshColliders: Drawn[] = [];
  private marks = new ContactMarks(1);
  private dirty = true;
  /** Half of the size of what is there [m]. */
  extent = 1;
  pictures = 0;
  /** Of the last picture whose drawing was timed. */
  milliseconds = 0;
  private timedAt = -measured;
  private readonly chosen = new THREE.Mesh(
    new THREE.SphereGeometry(1, 16, 12),
    new THREE.MeshBasicMaterial({ color: 0xe0218a, transparent: true, opacity: 0.85, depthTest: false }),
  );

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.isSlow = drawsInSoftware(this.renderer.getContext());
    if (this.isSlow) drawPlainly();
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = this.isSlow ? THREE.BasicShadowMap : THREE.PCFShadowMap;
    this.scene.background = new THREE.Color(sky);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0006;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8d8a84, 1.5), this.sun, this.sun.target);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.chosen.visible = false;
    this.chosen.renderOrder = 2;
    this.scene.add(this.chosen);
    new ResizeObserver(() => this.resize()).observe(canvas);
    const loop = () => {
      requestAnimationFrame(loop);
      if (this.dirty) this.render();
    };
    loop();
  }

  /** Asks for a picture. */
  draw(): void {
    this.dirty = true;
  }

  private render(): void {
    this.dirty = false;
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    ++this.pictures;
    if (start - this.timedAt < measured) return;
    const context = this.renderer.getContext();
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the picture
    this.timedAt = performance.now();
    this.milliseconds = this.timedAt - start;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(this.isSlow ? 1 : Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Replaces what is drawn, seen from a camera; none: from where it was seen. */
  show(parts: Parts, frame: WorkerFrame, camera?: SceneCamera): void {
    this.scene.remove(this.content);
    this.content.traverse((thing) => {
      if (thing instanceof THREE.Mesh || thing instanceof THREE.Points || thing instanceof THREE.LineSegments) {
        thing.geometry.dispose();
        (thing.material as THREE.Material).dispose();
      }
    });
    const box = boxOf(parts, frame);
    const middle = box.getCenter(new THREE.Vector3());
    this.extent = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-3);
    this.content = new THREE.Group();
    this.objects = parts.objects.map(drawObject);
    this.colliders = parts.colliders.map((collider) => drawCollider(collider, this.extent));
    this.meshColliders = parts.mesh_colliders.map(drawMeshCollider);
    this.marks = new ContactMarks(this.extent);
    for (const { thing } of [...this.objects.flat(), ...this.colliders, ...this.meshColliders]) this.content.add(thing);
    this.content.add(this.marks.thing);
    this.scene.add(this.content);
    this.scene.fog = new THREE.Fog(sky, 12 * this.extent, 40 * this.extent);
    this.light(middle);
    if (camera) this.frame(box, camera);
    this.update(frame);
  }

  private light(middle: THREE.Vector3): void {
    const far = 3 * this.extent;
    this.sun.target.position.copy(middle);
    this.sun.position.copy(middle).add(new THREE.Vector3(0.55, 1, 0.4).normalize().multiplyScalar(far));
    const camera = this.sun.shadow.camera;
    const wide = 1.7 * this.extent;
    [camera.left, camera.right, camera.bottom, camera.top] = [-wide, wide, -wide, wide];
    [camera.near, camera.far] = [0.01 * far, 3 * far];
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.004 * this.extent;
  }

  /** Puts the camera where the scene wants it, or else where it shows all of a box. */
  private frame(box: THREE.Box3, wanted: SceneCamera): void {
    const target = wanted.look_at ? new THREE.Vector3().fromArray(wanted.look_at) : box.getCenter(new THREE.Vector3());
    const away = new THREE.Vector3();
    if (wanted.position) away.fromArray(wanted.position).sub(target);
    const isPlaced = away.length() > 1e-6 * this.extent; // else no direction follows from the position
    if (!isPlaced) {
      const [azimuth, elevation] = [wanted.azimuth ?? usual.azimuth, wanted.elevation ?? usual.elevation];
      const polar = THREE.MathUtils.degToRad(90 - elevation);
      away.setFromSphericalCoords(1, polar, THREE.MathUtils.degToRad(azimuth));
    }
    this.camera.fov = wanted.fov ?? usual.fov;
    const distance = isPlaced ? away.length() : (wanted.distance ?? this.fit(box, target, away));
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(away.normalize(), distance);
    const far = Math.max(distance, this.extent);
    [this.camera.near, this.camera.far] = [Math.min(0.01 * far, distance / 2), 60 * far];
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** How far from the target, in a direction, the camera shows all of a box. */
  private fit(box: THREE.Box3, target: THREE.Vector3, back: THREE.Vector3): number {
    const upright = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) * filled;
    const across = upright * this.camera.aspect;
    const right = new THREE.Vector3(0, 1, 0).cross(back).normalize();
    const up = back.clone().cross(right);
    let distance = 1e-3;
    for (let corner = 0; corner < 8; ++corner) {
      const side = (k: number, axis: "x" | "y" | "z") => (corner & k ? box.max : box.min)[axis];
      const point = new THREE.Vector3(side(1, "x"), side(2, "y"), side(4, "z")).sub(target);
      const [x, y] = [Math.abs(point.dot(right)) / across, Math.abs(point.dot(up)) / upright];
      distance = Math.max(distance, point.dot(back) + Math.max(x, y));
    }
    return distance;
  }

  /** Marks a point; none: no mark. */
  mark(point?: ArrayLike<number>): void {
    if (!point && !this.chosen.visible) return;
    this.chosen.visible = point !== undefined;
    if (point) this.chosen.position.fromArray(point);
    this.chosen.scale.setScalar(0.025 * this.extent);
    this.draw();
  }

  /** A vector by its parts to the right, up and towards the viewer. */
  alongView(right: number, up: number, near: number): THREE.Vector3 {
    return new THREE.Vector3(right, up, near).applyQuaternion(this.camera.quaternion);
  }

  update(frame: WorkerFrame): void {
    frame.objects.forEach((object, i) => this.objects[i]?.forEach((drawn) => drawn.update?.(object)));
    frame.colliders.forEach((pose, i) => this.colliders[i]?.pose(pose));
    frame.meshColliders.forEach((mesh, i) => this.meshColliders[i]?.update?.(mesh));
    this.marks.show(frame.contacts ?? []);
    this.draw();
  }

  showEdges(shown: boolean): void {
    for (const drawn of this.objects.flat()) drawn.edges?.(shown);
    this.draw();
  }

  private ray(x: number, y: number): THREE.Raycaster {
    const bounds = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(((x - bounds.left) / bounds.width) * 2 - 1, 1 - ((y - bounds.top) / bounds.height) * 2);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(place, this.camera);
    caster.params.Line = { threshold: 0.01 * this.extent };
    return caster;
  }

  /** What is under a place of the window, if it can be dragged. */
  pick(x: number, y: number): Pick | undefined {
    const drawn = [...this.objects.flat(), ...this.colliders, ...this.meshColliders];
    const owners = new Map<THREE.Object3D, Drawn>();
    for (const one of drawn) one.thing.traverse((thing) => owners.set(thing, one));
    const hit = this.ray(x, y).intersectObjects(drawn.filter((one) => one.grip).map((one) => one.thing))[0];
    const grip = hit && owners.get(hit.object)?.grip?.(hit.instanceId);
    return grip && { grip, point: hit.point };
  }

  /** The point under a place of the window at the depth of another point. */
  pointAt(x: number, y: number, like: THREE.Vector3): THREE.Vector3 | undefined {
    const facing = new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), like);
    return this.ray(x, y).ray.intersectPlane(facing, new THREE.Vector3()) ?? undefined;
  }

  /** Turns the camera by angles about the target [rad], and zooms by a factor. */
  orbit(around: number, up: number, zoom = 1): void {
    const from = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    from.theta += around;
    from.phi = Math.min(Math.max(from.phi + up, 0.05), Math.PI - 0.05);
    from.radius *= zoom;
    this.camera.position.setFromSpherical(from).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** Where a point is in the window. */
  placeOf(point: ArrayLike<number>): { x: number; y: number } {
    const bounds = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector3(point[0], point[1], point[2]).project(this.camera);
    return { x: bounds.left + ((at.x + 1) / 2) * bounds.width, y: bounds.top + ((1 - at.y) / 2) * bounds.height };
  }
}

/** Where most of the particles of an object are: a stray drop must not make the rest small. */
function include(box: THREE.Box3, positions: Float32Array): void {
  const count = positions.length / 3;
  const few = count > 200 ? Math.floor(0.01 * count) : 0;
  const [low, high] = [new THREE.Vector3(), new THREE.Vector3()];
  for (let k = 0; k < 3; ++k) {
    const along = Float32Array.from({ length: count }, (_, i) => positions[3 * i + k]).sort();
    low.setComponent(k, along[few]);
    high.setComponent(k, along[count - 1 - few]);
  }
  if (count > 0) box.union(new THREE.Box3(low, high));
}

/** The box around objects, and around colliders that are not large against them. */
function boxOf(parts: Parts, frame: WorkerFrame): THREE.Box3 {
  const box = new THREE.Box3();
  frame.objects.forEach(({ positions, poses }, i) => {
    if (positions) include(box, positions);
    parts.objects[i].bodies.forEach((body, b) => {
      const centre = new THREE.Vector3().fromArray(poses!, 7 * b);
      const solid = parts.objects[i].solids[body.solid].positions;
      const turn = new THREE.Quaternion().fromArray(poses!, 7 * b + 3);
      for (let v = 0; v < solid.length; v += 3) box.expandByPoint(new THREE.Vector3().fromArray(solid, v).applyQuaternion(turn).add(centre));
    });
  });
  if (box.isEmpty()) box.set(new THREE.Vector3(-0.5, 0, -0.5), new THREE.Vector3(0.5, 1, 0.5));
  const most = 3 * box.getSize(new THREE.Vector3()).length();
  frame.colliders.forEach((pose, i) => {
    const { shape } = parts.colliders[i];
    if (shape.kind === "plane") return;
    const half = shape.kind === "box" ? Math.hypot(...shape.half_extents) : shape.radius + (shape.kind === "capsule" ? shape.half_length : 0);
    if (2 * half < most) box.union(new THREE.Box3().setFromCenterAndSize(new THREE.Vector3().fromArray(pose), new THREE.Vector3(1, 1, 1).multiplyScalar(1.2 * half)));
  });
  for (const { positions } of frame.meshColliders) {
    const around = new THREE.Box3().setFromArray(positions as unknown as number[]);
    if (around.getSize(new THREE.Vector3()).length() < most) box.union(around);
  }
  return box;
}
