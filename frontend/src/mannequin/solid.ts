/** Hulls in three dimensions, with three.js. */

import {
  type Camera,
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
import { HULL, type Hulls } from "./hulls";
import { LIGHT, litColour, type DrawHulls, type Look } from "./look";

/** Corners round a hull, and rings over each of its two caps. */
const ROUND = 40;
const RINGS = 9;
/** Farther from the eye than this, in mm, nothing is drawn. */
const FAR_MM = 1e6;

/** What draws hulls; throws where the browser gives no WebGL. */
export function solidDrawing(): DrawHulls {
  const renderer = new WebGLRenderer({ alpha: true, antialias: true });
  renderer.outputColorSpace = LinearSRGBColorSpace; // shades are given as the screen shows them
  renderer.setClearColor(0, 0);
  const uniforms = {
    colour: { value: new Vector3() },
    light: { value: new Vector3(...LIGHT).normalize() },
    eye: { value: 0 },
  };
  const material = new ShaderMaterial({ vertexShader, fragmentShader, uniforms });
  const geometry = hullGeometry();
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  const scene = new Scene();
  scene.add(mesh);
  const level = new OrthographicCamera();
  const near = new PerspectiveCamera();
  let buffer: InstancedInterleavedBuffer | undefined;

  const give = (hulls: Hulls): void => {
    if (buffer?.array !== hulls.numbers) {
      geometry.dispose();
      buffer = new InstancedInterleavedBuffer(hulls.numbers, HULL);
      buffer.setUsage(DynamicDrawUsage);
      geometry.setAttribute("one", new InterleavedBufferAttribute(buffer, 4, 0));
      geometry.setAttribute("other", new InterleavedBufferAttribute(buffer, 4, 4));
      geometry.setAttribute("tone", new InterleavedBufferAttribute(buffer, 1, 8));
    }
    buffer.needsUpdate = true;
    geometry.instanceCount = hulls.count;
  };

  const draw: DrawHulls = (context, hulls, look) => {
    if (hulls.count === 0) return;
    const { domElement } = renderer;
    const width = Math.round(look.width_px * look.fine);
    const height = Math.round(look.height_px * look.fine);
    if (domElement.width < width || domElement.height < height) {
      // It only grows, so that pictures of several sizes take turns in its lower left corner.
      renderer.setSize(Math.max(domElement.width, width), Math.max(domElement.height, height), false);
    }
    renderer.setViewport(0, 0, width, height);
    give(hulls);
    uniforms.colour.value.set(...litColour(look.colour));
    renderer.render(scene, aimed(look));
    const top = domElement.height - height;
    context.drawImage(domElement, 0, top, width, height, 0, 0, look.width_px, look.height_px);
  };

  const aimed = ({ width_px, height_px, px_per_mm, eye_distance_mm: eye }: Look): Camera => {
    const [right, top] = [width_px / 2 / px_per_mm, height_px / 2 / px_per_mm];
    uniforms.eye.value = eye ?? 0;
    if (eye === null) {
      Object.assign(level, { left: -right, right, top, bottom: -top, near: -FAR_MM, far: FAR_MM });
      level.updateProjectionMatrix();
      return level;
    }
    const fov = (360 / Math.PI) * Math.atan(top / eye);
    near.position.z = eye;
    Object.assign(near, { aspect: right / top, fov, near: eye / 1000, far: FAR_MM });
    near.updateProjectionMatrix();
    return near;
  };
  return draw;
}

/** Two caps of a ball on a common axis, of which the shader makes a hull. */
function hullGeometry(): InstancedBufferGeometry {
  const corners: number[] = [];
  const faces: number[] = [];
  const nRows = 2 * RINGS + 2;
  for (let row = 0; row < nRows; row++) {
    const end = row <= RINGS ? 0 : 1;
    for (let i = 0; i <= ROUND; i++) {
      const turn = (2 * Math.PI * i) / ROUND;
      corners.push(end, (row - end * (RINGS + 1)) / RINGS, turn);
      if (row + 1 === nRows || i === ROUND) continue;
      const here = row * (ROUND + 1) + i;
      const above = here + ROUND + 1;
      faces.push(here, here + 1, above, above, here + 1, above + 1);
    }
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(corners, 3));
  geometry.setIndex(faces);
  return geometry;
}
