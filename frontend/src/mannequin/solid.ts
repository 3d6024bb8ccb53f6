/** Hulls in three dimensions, with three.js. */

import {
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  LinearSRGBColorSpace,
  Mesh,
  OrthographicCamera,
  PerspectiveCamera,
  Scene,
  ShaderMaterial,
  Vector3,
  WebGLRenderer,
} from "three";

import fragmentShader from "./hull.frag?raw";
import vertexShader from "./hull.vert?raw";
import { HULL, LIGHT, litColour, type DrawHulls, type Hulls, type RenderSettings } from "./hulls";

/** Corners round a hull, and rings on each of its two caps, up to a number of pixels a mm. */
const LEVELS = [
  { upTo: 0.35, round: 24, rings: 5 },
  { upTo: 0.7, round: 32, rings: 7 },
  { upTo: Infinity, round: 40, rings: 9 },
] as const;
/** Nothing farther from the eye than this is drawn. */
const FAR_MM = 1e6;

type Four = [number, number, number, number];
type Box = Readonly<Record<"left" | "top" | "width" | "height", number>>;

/** A function that draws hulls; throws if the browser has no WebGL. */
export function solidDrawing(): DrawHulls {
  const renderer = new WebGLRenderer({ alpha: true, antialias: true });
  renderer.outputColorSpace = LinearSRGBColorSpace; // shades are in screen values
  renderer.setClearColor(0, 0);
  const uniforms = {
    colour: { value: new Vector3() },
    light: { value: new Vector3(...LIGHT).normalize() },
    eye: { value: 0 },
    rounder: { value: 1 },
  };
  const material = new ShaderMaterial({ vertexShader, fragmentShader, uniforms });
  const levels = LEVELS.map((level) => ({ ...level, geometry: hullGeometry(level) }));
  const mesh = new Mesh<InstancedBufferGeometry, ShaderMaterial>(levels[0]!.geometry, material);
  mesh.frustumCulled = false;
  const scene = new Scene();
  scene.add(mesh);
  const level = new OrthographicCamera();
  const near = new PerspectiveCamera();
  let buffer: InstancedInterleavedBuffer | undefined;

  const upload = (hulls: Hulls, settings: RenderSettings): void => {
    if (buffer?.array !== hulls.numbers) {
      buffer = new InstancedInterleavedBuffer(hulls.numbers, HULL);
      buffer.setUsage(DynamicDrawUsage);
      for (const { geometry } of levels) {
        geometry.dispose();
        geometry.setAttribute("one", new InterleavedBufferAttribute(buffer, 4, 0));
        geometry.setAttribute("other", new InterleavedBufferAttribute(buffer, 4, 4));
        geometry.setAttribute("tone", new InterleavedBufferAttribute(buffer, 1, 8));
      }
    }
    buffer.needsUpdate = true;
    const size = greatestScale(hulls, settings);
    const level = levels.find(({ upTo }) => size <= upTo)!;
    mesh.geometry = level.geometry;
    mesh.geometry.instanceCount = hulls.count;
    const [a, b] = [(2 * Math.PI) / level.round, Math.PI / 2 / level.rings];
    uniforms.rounder.value = 1 + (a * a + b * b) / 48; // faces lie outside as far as inside
  };

  const draw: DrawHulls = (context, hulls, settings) => {
    const { pixelRatio, width_px, height_px } = settings;
    const box = boxOf(hulls, settings);
    if (!box) return;
    const { left, top, width, height } = box;
    const { domElement } = renderer;
    if (domElement.width < width || domElement.height < height) {
      // The canvas only grows: pictures of all sizes use its lower left corner.
      renderer.setSize(Math.max(domElement.width, width), Math.max(domElement.height, height), false);
    }
    renderer.setViewport(0, 0, width, height);
    upload(hulls, settings);
    uniforms.colour.value.set(...litColour(settings.colour));
    const camera = cameraFor(settings);
    camera.setViewOffset(width_px * pixelRatio, height_px * pixelRatio, left, top, width, height);
    renderer.render(scene, camera);
    const placed = [left, top, width, height].map((size) => size / pixelRatio) as Four;
    context.drawImage(domElement, 0, domElement.height - height, width, height, ...placed);
  };

  const cameraFor = (settings: RenderSettings): OrthographicCamera | PerspectiveCamera => {
    const { px_per_mm, eye_distance_mm: eye } = settings;
    const [right, top] = [settings.width_px / 2 / px_per_mm, settings.height_px / 2 / px_per_mm];
    uniforms.eye.value = eye ?? 0;
    if (eye === null) {
      return Object.assign(level, { left: -right, right, top, bottom: -top, near: -FAR_MM, far: FAR_MM });
    }
    near.position.z = eye;
    const fov = (360 / Math.PI) * Math.atan(top / eye);
    return Object.assign(near, { aspect: right / top, fov, near: eye / 1000, far: FAR_MM });
  };
  return draw;
}

/** The part of the picture that hulls can cover, in canvas pixels; undefined if there is none. */
function boxOf({ numbers, count }: Hulls, settings: RenderSettings): Box | undefined {
  const [across, upwards] = [0, 1].map((axis) => {
    const ends = [Infinity, -Infinity] as [number, number];
    for (let ball = 0; ball < 2 * count; ball++) {
      const at = HULL * (ball >> 1) + 4 * (ball & 1);
      const [beside, towards, radius] = [numbers[at + axis]!, numbers[at + 2]!, numbers[at + 3]!];
      ends[0] = Math.min(ends[0], reach(beside, towards, -radius, settings.eye_distance_mm));
      ends[1] = Math.max(ends[1], reach(beside, towards, radius, settings.eye_distance_mm));
    }
    return ends.map((end) => end * settings.px_per_mm) as [number, number];
  }) as [[number, number], [number, number]];
  const pixels = (end: number, size: number): number =>
    Math.min(Math.max((size / 2 + end) * settings.pixelRatio, 0), Math.round(size * settings.pixelRatio));
  const left = Math.floor(pixels(across[0] - 1, settings.width_px));
  const top = Math.floor(pixels(-upwards[1] - 1, settings.height_px));
  const width = Math.ceil(pixels(across[1] + 1, settings.width_px)) - left;
  const height = Math.ceil(pixels(-upwards[0] + 1, settings.height_px)) - top;
  return width > 0 && height > 0 ? { left, top, width, height } : undefined;
}

/** Canvas pixels for a millimetre of the nearest hull. */
function greatestScale({ numbers, count }: Hulls, settings: RenderSettings): number {
  const { px_per_mm, pixelRatio, eye_distance_mm: eye } = settings;
  if (eye === null) return px_per_mm * pixelRatio;
  let away = eye;
  for (let hull = 0; hull < count; hull++) {
    away = Math.min(away, eye - numbers[HULL * hull + 2]!, eye - numbers[HULL * hull + 6]!);
  }
  return (px_per_mm * pixelRatio * eye) / away;
}

/** The edge of a ball in the picture, in mm; `radius` is negative for the other edge. */
function reach(beside: number, towards: number, radius: number, eye: number | null): number {
  if (eye === null) return beside + radius;
  const away = eye - towards;
  const apart = Math.max(Math.hypot(beside, away), Math.abs(radius) * 1.000001);
  const angle = Math.atan2(beside, away) + Math.asin(radius / apart);
  return eye * Math.tan(Math.min(Math.max(angle, -1.57), 1.57));
}

/** Two caps of a ball on a common axis, which the shader makes into a hull. */
function hullGeometry({ round, rings }: (typeof LEVELS)[number]): InstancedBufferGeometry {
  const corners: number[] = [];
  const shares: number[] = [];
  const faces: number[] = [];
  const nRows = 2 * rings + 2;
  for (let row = 0; row < nRows; row++) {
    const end = row <= rings ? 0 : 1;
    const fromPole = end === 0 ? row : nRows - 1 - row;
    for (let i = 0; i <= round; i++) {
      const turn = (2 * Math.PI * i) / round;
      corners.push(Math.cos(turn), Math.sin(turn), end);
      shares.push(1 - Math.cos((Math.PI / 2) * (fromPole / rings)));
      if (row + 1 === nRows || i === round) continue;
      const here = row * (round + 1) + i;
      const above = here + round + 1;
      faces.push(here, here + 1, above, above, here + 1, above + 1);
    }
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(corners, 3));
  geometry.setAttribute("share", new Float32BufferAttribute(shares, 1));
  geometry.setIndex(faces);
  return geometry;
}
