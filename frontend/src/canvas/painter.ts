/** Frames of a stimulus on a canvas: discs, sticks, blobs, or a mannequin. */

import type { Display, Link, Stimulus } from "../core/stimulus";
import { framesOf, type FigureFrame } from "./figureFrames";
import { hasLimbs, type MannequinPainter } from "./mannequinLoader";

/** Width of a stick relative to the diameter of a dot. */
const STICK_WIDTH = 0.6;
/** Standard deviations beyond which the light of a blob is too weak for a screen. */
const BLOB_REACH_SD = 3.6;

export interface Painter {
  paint(time: number): void;
  clear(): void;
}

/**
 * A painter of a stimulus on a canvas, which gets the stimulus' size.
 *
 * A pixel of the stimulus is a CSS pixel, times `scale`; the resolution is that of the screen.
 * The style "mannequin" needs a mannequin painter, whose module is loaded before.
 */
export function painterOn(
  canvas: HTMLCanvasElement,
  stimulus: Stimulus,
  scale = 1,
  mannequin?: MannequinPainter,
): Painter {
  const { width_px, height_px } = stimulus.display;
  const pixelRatio = scale * (window.devicePixelRatio || 1);
  setResolution(canvas, width_px, height_px, pixelRatio);
  canvas.style.width = `${width_px * scale}px`;
  canvas.style.height = `${height_px * scale}px`;
  const context = contextOf(canvas, { alpha: false });
  const draw = drawingOf(stimulus, mannequin);
  const clear = (): void => drawBackground(context, stimulus.display, pixelRatio);
  return { paint: (time) => draw(context, time, pixelRatio), clear };
}

/** Draws a stimulus at a time; `pixelRatio` canvas pixels are one pixel of the picture. */
export type Drawing = (context: CanvasRenderingContext2D, time: number, pixelRatio: number) => void;

/** A function that draws a stimulus on any canvas, over all of its picture. */
export function drawingOf(stimulus: Stimulus, mannequin?: MannequinPainter): Drawing {
  const layer = document.createElement("canvas");
  const frameAt = framesOf(stimulus);
  const solid = stimulus.display.style === "mannequin";
  if (solid && !mannequin) throw new Error("The mannequin's module was not loaded.");
  return (context, time, pixelRatio) => {
    drawBackground(context, stimulus.display, pixelRatio);
    const frames = frameAt(time);
    if (solid) mannequin?.paint(context, frames, stimulus, pixelRatio);
    for (const frame of frames) {
      context.fillStyle = context.strokeStyle = stimulus.display.colour;
      if (frame.moving.blurMm > 0 || frame.moving.blurPx > 0) drawBlobs(context, layer, frame, stimulus);
      else if (!solid || !hasLimbs(frame.moving)) drawFrame(context, frame, stimulus.display);
    }
  };
}

/** Begin a frame: one unit is a pixel of the picture, `pixelRatio` canvas pixels. */
export function drawBackground(
  context: CanvasRenderingContext2D,
  { background, width_px, height_px }: Pick<Display, "background" | "width_px" | "height_px">,
  pixelRatio: number,
): void {
  context.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
  context.fillStyle = background;
  context.fillRect(0, 0, width_px, height_px);
}

export function setResolution(canvas: HTMLCanvasElement, width: number, height: number, pixelRatio: number): void {
  canvas.width = Math.round(width * pixelRatio);
  canvas.height = Math.round(height * pixelRatio);
}

export function contextOf(
  canvas: HTMLCanvasElement,
  settings?: CanvasRenderingContext2DSettings,
): CanvasRenderingContext2D {
  const context = canvas.getContext("2d", settings);
  if (!context) throw new Error("This browser gives no canvas to draw on.");
  return context;
}

function drawFrame(context: CanvasRenderingContext2D, frame: FigureFrame, { style, dot_px }: Display): void {
  const { moving: { body: { dots, segments } }, places, visible } = frame;
  if (style === "sticks") drawSticks(context, places, dots.length, linksOf(dots, segments), dot_px, visible);
  drawDots(context, places, dots.length, dot_px, visible);
}

/** Draw figures of `nDots` dots each: one path a figure, as a single path of all dots is slower to fill. */
export function drawDots(
  context: CanvasRenderingContext2D,
  places: Float64Array,
  nDots: number,
  diameter: number,
  visible?: Uint8Array,
): void {
  for (let first = 0; first < places.length / 2; first += nDots) {
    context.beginPath();
    for (let dot = first; dot < first + nDots; dot++) {
      if (visible && !visible[dot]) continue;
      const x = places[2 * dot]!;
      const y = places[2 * dot + 1]!;
      context.moveTo(x + diameter / 2, y);
      context.arc(x, y, diameter / 2, 0, 2 * Math.PI);
    }
    context.fill();
  }
}

/** Draw the segments of figures of `nDots` dots each; `links` has pairs of numbers of dots. */
export function drawSticks(
  context: CanvasRenderingContext2D,
  places: Float64Array,
  nDots: number,
  links: Uint16Array,
  dotPx: number,
  visible?: Uint8Array,
): void {
  context.lineWidth = Math.max(STICK_WIDTH * dotPx, 1);
  context.lineCap = "round";
  for (let first = 0; first < places.length / 2; first += nDots) {
    context.beginPath();
    for (let i = 0; i < links.length; i += 2) {
      const one = first + links[i]!;
      const other = first + links[i + 1]!;
      if (visible && !(visible[one] && visible[other])) continue;
      context.moveTo(places[2 * one]!, places[2 * one + 1]!);
      context.lineTo(places[2 * other]!, places[2 * other + 1]!);
    }
    context.stroke();
  }
}

/** The numbers of the dots at the ends of segments. */
export const linksOf = (dots: readonly string[], segments: readonly Link[]): Uint16Array =>
  Uint16Array.from(segments.flat().map((name) => dots.indexOf(name)));

/** Gaussian blobs whose light adds up, on a separate layer: first the light, then its colour. */
function drawBlobs(
  context: CanvasRenderingContext2D,
  layer: HTMLCanvasElement,
  { moving, places, visible }: FigureFrame,
  { display }: Stimulus,
): void {
  const { width, height } = context.canvas;
  if (layer.width !== width || layer.height !== height) Object.assign(layer, { width, height });
  const light = contextOf(layer);
  light.setTransform(1, 0, 0, 1, 0, 0);
  light.clearRect(0, 0, width, height);
  light.globalCompositeOperation = "lighter";
  const reach = BLOB_REACH_SD * (moving.blurPx + moving.blurMm * display.px_per_mm);
  light.fillStyle = gaussian(light, reach);
  visible.forEach((isVisible, dot) => {
    if (!isVisible) return;
    light.setTransform(context.getTransform());
    light.translate(places[2 * dot]!, places[2 * dot + 1]!);
    light.fillRect(-reach, -reach, 2 * reach, 2 * reach);
  });
  light.setTransform(1, 0, 0, 1, 0, 0);
  light.globalCompositeOperation = "source-in";
  light.fillStyle = display.colour;
  light.fillRect(0, 0, width, height);
  light.globalCompositeOperation = "source-over";
  context.drawImage(layer, 0, 0, display.width_px, display.height_px);
}

/** A gradient of light about the origin with the shape of a Gaussian. */
function gaussian(context: CanvasRenderingContext2D, reach: number): CanvasGradient {
  const gradient = context.createRadialGradient(0, 0, 0, 0, 0, reach);
  const nStops = 36;
  for (let i = 0; i <= nStops; i++) {
    const share = i / nStops;
    const light = i === nStops ? 0 : Math.exp(-((BLOB_REACH_SD * share) ** 2) / 2);
    gradient.addColorStop(share, `rgb(255 255 255 / ${light})`);
  }
  return gradient;
}
