/** Frames of a stimulus on a canvas: discs, sticks, blobs, or a mannequin. */

import type { Stimulus } from "../core/stimulus";
import { framesOf, type Shown } from "./figureFrames";
import { hasLimbs, type MannequinPainter } from "./mannequinLoader";

/** Width of a stick beside the diameter of a dot. */
const STICK = 0.6;
/** Standard deviations beyond which a blob gives less light than a screen shows. */
const LOST_SD = 3.6;

export interface Painter {
  /** Draw the stimulus as it is at a time in seconds. */
  paint(time: number): void;
  /** Draw the ground alone. */
  clear(): void;
}

/**
 * What draws a stimulus on a canvas, which gets the stimulus' size.
 *
 * A pixel of the stimulus is a pixel of CSS, times `scale`; what is drawn is as fine as the screen.
 * A stimulus of the style "mannequin" needs its painter, whose module is loaded before.
 */
export function painterOn(
  canvas: HTMLCanvasElement,
  stimulus: Stimulus,
  scale = 1,
  mannequin?: MannequinPainter,
): Painter {
  const { width_px, height_px } = stimulus.display;
  const fine = scale * (window.devicePixelRatio || 1);
  fit(canvas, width_px, height_px, fine);
  canvas.style.width = `${width_px * scale}px`;
  canvas.style.height = `${height_px * scale}px`;
  const context = contextOf(canvas, { alpha: false });
  const draw = drawingOf(stimulus, mannequin);
  const clear = (): void => ground(context, stimulus, fine);
  return { paint: (time) => draw(context, time, fine), clear };
}

/** Draws the stimulus as it is at a time; `fine` pixels of the canvas are one of the picture. */
export type Drawing = (context: CanvasRenderingContext2D, time: number, fine: number) => void;

/** What draws a stimulus on any canvas, over all of its picture. */
export function drawingOf(stimulus: Stimulus, mannequin?: MannequinPainter): Drawing {
  const layer = document.createElement("canvas");
  const frameAt = framesOf(stimulus);
  const carved = stimulus.display.style === "mannequin";
  if (carved && !mannequin) throw new Error("The mannequin's module was not loaded.");
  return (context, time, fine) => {
    ground(context, stimulus, fine);
    const all = frameAt(time);
    if (carved) mannequin?.paint(context, all, stimulus, fine);
    for (const shown of all) {
      context.fillStyle = context.strokeStyle = stimulus.display.colour;
      if (shown.moving.blurMm > 0) drawBlobs(context, layer, shown, stimulus);
      else if (!carved || !hasLimbs(shown.moving)) drawDots(context, shown, stimulus);
    }
  };
}

function ground(context: CanvasRenderingContext2D, { display }: Stimulus, fine: number): void {
  context.setTransform(fine, 0, 0, fine, 0, 0);
  context.fillStyle = display.background;
  context.fillRect(0, 0, display.width_px, display.height_px);
}

function fit(canvas: HTMLCanvasElement, width: number, height: number, fine: number): void {
  canvas.width = Math.round(width * fine);
  canvas.height = Math.round(height * fine);
}

function contextOf(
  canvas: HTMLCanvasElement,
  settings?: CanvasRenderingContext2DSettings,
): CanvasRenderingContext2D {
  const context = canvas.getContext("2d", settings);
  if (!context) throw new Error("This browser gives no canvas to draw on.");
  return context;
}

function drawDots(context: CanvasRenderingContext2D, shown: Shown, { display }: Stimulus): void {
  const { places, visible } = shown;
  if (display.style === "sticks") drawSticks(context, shown, Math.max(STICK * display.dot_px, 1));
  context.beginPath();
  visible.forEach((isVisible, dot) => {
    if (!isVisible) return;
    const [x, y] = [places[2 * dot]!, places[2 * dot + 1]!];
    context.moveTo(x + display.dot_px / 2, y);
    context.arc(x, y, display.dot_px / 2, 0, 2 * Math.PI);
  });
  context.fill();
}

function drawSticks(context: CanvasRenderingContext2D, shown: Shown, width: number): void {
  const { moving, places, visible } = shown;
  context.lineWidth = width;
  context.lineCap = "round";
  context.beginPath();
  for (const segment of moving.body.segments) {
    const [one, other] = [moving.index(segment[0]), moving.index(segment[1])];
    if (!visible[one] || !visible[other]) continue;
    context.moveTo(places[2 * one]!, places[2 * one + 1]!);
    context.lineTo(places[2 * other]!, places[2 * other + 1]!);
  }
  context.stroke();
}

/** Gaussian blobs whose light adds up, on a layer of their own: first the light, then its colour. */
function drawBlobs(
  context: CanvasRenderingContext2D,
  layer: HTMLCanvasElement,
  { moving, places, visible }: Shown,
  { display }: Stimulus,
): void {
  const { width, height } = context.canvas;
  if (layer.width !== width || layer.height !== height) Object.assign(layer, { width, height });
  const light = contextOf(layer);
  light.setTransform(1, 0, 0, 1, 0, 0);
  light.clearRect(0, 0, width, height);
  light.globalCompositeOperation = "lighter";
  const reach = LOST_SD * moving.blurMm * display.px_per_mm;
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

/** A gradient of light about the origin that falls as a Gaussian does. */
function gaussian(context: CanvasRenderingContext2D, reach: number): CanvasGradient {
  const gradient = context.createRadialGradient(0, 0, 0, 0, 0, reach);
  const nStops = 36;
  for (let i = 0; i <= nStops; i++) {
    const share = i / nStops;
    const light = i === nStops ? 0 : Math.exp(-((LOST_SD * share) ** 2) / 2);
    gradient.addColorStop(share, `rgb(255 255 255 / ${light})`);
  }
  return gradient;
}
