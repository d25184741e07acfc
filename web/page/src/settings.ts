// What the sliders change in a scene's text.

export interface Knobs {
  /** 0: as the scene says. */
  substeps: number;
  /** Speed [m/s]; 0: as the scene says. */
  wind: number;
  /** Factor of the stiffness of soft bodies and of the bending of cloth. */
  stiffness: number;
  fabric: string;
}

export const untouched: Knobs = { substeps: 0, wind: 0, stiffness: 1, fabric: "" };

/** Bending stiffness of built-in fabrics [N m] (docs/guide/materials.md). */
const bending: Record<string, number> = {
  cotton: 1.75e-5,
  silk: 2.5e-6,
  denim: 6e-5,
  wool: 1.2e-5,
  leather: 7.2e-4,
  "rubber sheet": 1.7e-4,
};

const airDensity = 1.2; // [kg/m^3]

function fabricOf(cloth: any, knobs: Knobs): any {
  const given = cloth.material;
  const base = knobs.fabric || (typeof given === "string" ? given : given?.base);
  const material = typeof given === "object" && !knobs.fabric ? { ...given } : base ? { base } : {};
  if (knobs.stiffness === 1) return knobs.fabric || given;
  material.bending_stiffness = (material.bending_stiffness ?? bending[base] ?? 1e-5) * knobs.stiffness;
  return material;
}

function turn(object: any, knobs: Knobs): void {
  if (object.cloth) {
    const material = fabricOf(object.cloth, knobs);
    if (material !== undefined) object.cloth.material = material;
  }
  const soft = object.soft_body?.material;
  if (soft && typeof soft.youngs_modulus === "number") soft.youngs_modulus *= knobs.stiffness;
  for (const part of object.parts ?? []) turn(part, knobs);
}

/** The scene with what the sliders say. Text that is no JSON stays as it is: the engine then says what is wrong with it. */
export function applied(text: string, knobs: Knobs): string {
  if (JSON.stringify(knobs) === JSON.stringify(untouched)) return text;
  let scene: any;
  try {
    scene = JSON.parse(text);
  } catch {
    return text;
  }
  if (knobs.substeps > 0) {
    scene.settings = { ...scene.settings, substeps: knobs.substeps };
    for (const object of scene.objects ?? []) delete object.substeps;
  }
  if (knobs.wind > 0) scene.wind = { air_density: airDensity, ...scene.wind, velocity: blown(scene.wind?.velocity, knobs.wind) };
  for (const object of scene.objects ?? []) turn(object, knobs);
  return JSON.stringify(scene);
}

/** A wind of that speed in the direction of another one; along x without one. */
function blown(velocity: number[] | undefined, speed: number): number[] {
  const [x, y, z] = velocity ?? [1, 0, 0.3];
  const length = Math.hypot(x, y, z) || 1;
  return [x, y, z].map((v) => (v * speed) / length);
}
