/** The viewer: draws the figures at the rate of the screen, and is turned by dragging. */

import { everyFrame } from "../canvas/frameClock";
import { mannequinInPage, type MannequinPainter } from "../canvas/mannequinLoader";
import { contextOf, setResolution } from "../canvas/painter";
import { flatPainter } from "../mannequin/hullPainter";
import type { Scene, SceneFigure } from "../model/figures";
import { clamped, RANGES, wrappedDegrees, type State } from "../model/state";
import { animationOf, phaseOffset, type ViewerAnimation } from "./animation";
import { arrange, type Arrangement, type Box, type Extent, type Size } from "./arrangement";
import { watchGestures, watchSize, watchVisibility } from "./canvasEvents";
import { extentFor } from "./viewedStimulus";

export interface ViewerEvents {
  /** It was turned by dragging. */
  turned?(azimuth_deg: number, elevation_deg: number): void;
  /**
   * The phase of the first walker, from 0 to below 1, some times a second: a layout of the page for each
   * frame would cost more than drawing the walker.
   */
  ticked?(phase: number): void;
  /** One of several walkers was tapped: its number among the model's walkers. */
  picked?(known: number): void;
  /** The wheel was turned: by this factor nearer. */
  zoomed?(factor: number): void;
  /** The cells of the walkers have changed, in CSS pixels. */
  arranged?(boxes: readonly Box[]): void;
  /** The mannequin is drawn flat, as its module is missing; the message says why. */
  mannequinMissing?(message: string): void;
  /** Where the mannequin comes from, if not from the page. */
  loadMannequin?(): Promise<MannequinPainter>;
}

type View = Pick<State, "azimuth_deg" | "elevation_deg">;

/** The scene of the animation, and its time. */
interface Built extends Scene {
  readonly time: number;
  readonly turned_deg: number;
}

/** Parts of the state that need a new animation, beside the figures. */
const ANIMATED_PARTS = [
  "perspective", "zoom", "turning_deg_s", "style", "trails", "dark", "scene", "tempo", "transforms",
] as const;

const DEGREES_PER_PX = 0.5;
const TICK_S = 0.06;
/** After a pause of the screen, the walk goes on where it was. */
const MAX_FRAME_S = 0.1;
/** Time constant of the rotation after a throw, and the speed at which it ends. */
const SLOWING_S = 0.28;
const MIN_SPEED_DEG_S = 4;
const NO_THROW = { right: 0, down: 0 };

const sameAnimation = (one: Scene, other: Scene): boolean =>
  one.model === other.model &&
  one.figures === other.figures &&
  ANIMATED_PARTS.every((part) => one.state[part] === other.state[part]);

const sameView = (one: View, other: View): boolean =>
  one.azimuth_deg === other.azimuth_deg && one.elevation_deg === other.elevation_deg;

const viewFrom = (azimuth: number, elevation: number): View => ({
  azimuth_deg: wrappedDegrees(azimuth),
  elevation_deg: clamped(RANGES.elevation_deg, elevation),
});

export class Viewer {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #events: ViewerEvents;
  readonly #ending = new AbortController();
  #shown: Scene | null = null;
  #animation: ViewerAnimation | null = null;
  #built: Built | null = null;
  #boxes: readonly Box[] = [];
  #extent: { figures: readonly SceneFigure[]; extent: Extent } | null = null;
  #size: Size = { width_px: 0, height_px: 0 };
  #pixelRatio = 1;
  #mannequin: MannequinPainter | null = null;
  #loading = false;
  #stop: (() => void) | null = null;
  #time = 0;
  #lastTick = -Infinity;
  #visible = !document.hidden;
  #dirty = true;
  /** The view while it is turned by hand, until the state has followed. */
  #hand: View | null = null;
  #throw = NO_THROW;

  constructor(canvas: HTMLCanvasElement, events: ViewerEvents = {}) {
    this.#canvas = canvas;
    this.#context = contextOf(canvas, { alpha: false });
    this.#events = events;
    const { signal } = this.#ending;
    watchSize(canvas, signal, (size, pixelRatio) => this.#resize(size, pixelRatio));
    watchVisibility(canvas, signal, (visible) => this.#setVisible(visible));
    this.#watchHand(signal);
  }

  /** The phase of the first walker, from 0 to below 1. */
  get phase(): number {
    const strides = this.#animation?.phase(0, this.#time) ?? 0;
    return strides - Math.floor(strides);
  }

  get mannequin(): MannequinPainter | null {
    return this.#mannequin;
  }

  /** Show figures from the next frame on; strides continue. */
  show(scene: Scene): void {
    const before = this.#shown;
    const { state } = scene;
    this.#shown = scene;
    if (this.#hand && !sameView(this.#hand, state)) this.#throw = NO_THROW;
    this.#hand = null;
    if (state.style === "mannequin") this.#loadMannequin();
    if (state.turning_deg_s === 0) this.#keepTurned();
    const scrubbed = before && !state.playing && before.state.cycle !== state.cycle;
    if (scrubbed) this.#rebuild(state.cycle - this.phase);
    else this.#update();
  }

  remove(): void {
    this.#sleep();
    this.#ending.abort();
    this.#shown = null;
  }

  /** Follow the state: with the present animation if possible, else with a new one. */
  #update(): void {
    const [shown, built] = [this.#shown, this.#built];
    if (!shown || !built || !sameAnimation(built, shown)) return this.#rebuild();
    const { azimuth_deg, elevation_deg } = { ...shown.state, ...this.#hand };
    if (built.state.azimuth_deg === azimuth_deg && built.state.elevation_deg === elevation_deg) return this.#wake();
    const arrangement = this.#arrange(shown, elevation_deg);
    if (!this.#animation?.turn(azimuth_deg, elevation_deg, arrangement)) return this.#rebuild();
    this.#built = { ...built, state: { ...built.state, azimuth_deg, elevation_deg } };
    this.#wake();
  }

  /** Make a new animation; each walker keeps its phase, or moves on by a number of strides. */
  #rebuild(strides = 0): void {
    const shown = this.#shown;
    if (!shown || this.#size.width_px === 0 || this.#size.height_px === 0) return;
    const state = { ...shown.state, ...this.#hand };
    const arrangement = this.#arrange(shown, state.elevation_deg);
    const phases = shown.figures.map((_, i) => strides + this.#phaseOf(i, shown.state));
    const [time, turned_deg] = [this.#time, this.#turnedBy(this.#time)];
    const [{ model, figures }, size, mannequin] = [shown, this.#size, this.#mannequin];
    this.#built = { model, figures, state, time, turned_deg };
    this.#animation = animationOf({ ...this.#built, size, arrangement, phases, mannequin });
    this.#wake();
  }

  /** Arrange the figures, and report their cells. */
  #arrange(scene: Scene, elevationDeg: number): Arrangement {
    const { figures } = scene;
    if (this.#extent?.figures !== figures) this.#extent = { figures, extent: extentFor(scene) };
    const arrangement = arrange(figures.length, this.#extent.extent, this.#size, elevationDeg, scene.state.zoom);
    this.#boxes = arrangement.boxes;
    this.#events.arranged?.(this.#boxes);
    return arrangement;
  }

  /** The angle by which it has turned by itself. */
  #turnedBy(time: number): number {
    const built = this.#built;
    return built ? built.turned_deg + built.state.turning_deg_s * (time - built.time) : 0;
  }

  /** Make the angle by which it has turned by itself a part of the view. */
  #keepTurned(): void {
    const { state } = this.#shown ?? {};
    const turned = this.#turnedBy(this.#time);
    if (!state || !this.#built || turned === 0) return;
    this.#built = { ...this.#built, turned_deg: 0, time: this.#time };
    this.#hand = viewFrom(state.azimuth_deg + turned, state.elevation_deg);
    this.#rebuild();
    this.#reportHand();
  }

  #reportHand(): void {
    if (this.#hand) this.#events.turned?.(this.#hand.azimuth_deg, this.#hand.elevation_deg);
  }

  /** The phase with which a walker continues. */
  #phaseOf(number: number, state: State): number {
    const offset = phaseOffset(state, number);
    if (!this.#animation) return state.cycle + offset;
    const known = this.#built?.state.scene === state.scene ? this.#animation.phase(number, this.#time) : NaN;
    return Number.isFinite(known) ? known : this.#animation.phase(0, this.#time) + offset;
  }

  /** Draw a frame, and go on while anything moves. */
  #wake(): void {
    this.#dirty = true;
    if (this.#stop || !this.#visible) return;
    let before = 0;
    this.#stop = everyFrame((elapsedMs) => {
      const seconds = Math.min((elapsedMs - before) / 1000, MAX_FRAME_S);
      before = elapsedMs;
      const goesOn = this.#frame(seconds);
      if (!goesOn) this.#stop = null;
      return goesOn;
    });
  }

  #sleep(): void {
    this.#stop?.();
    this.#stop = null;
  }

  /** One frame; whether another one follows. */
  #frame(seconds: number): boolean {
    const state = this.#shown?.state;
    if (!state || !this.#animation) return false;
    if (state.playing) this.#time += seconds;
    const slides = this.#slide(seconds);
    if (state.playing || this.#dirty) {
      this.#dirty = false;
      this.#animation.draw(this.#context, this.#time, this.#pixelRatio);
      this.#tick(state.playing);
    }
    return state.playing || slides || this.#dirty;
  }

  #tick(playing: boolean): void {
    if (playing && Math.abs(this.#time - this.#lastTick) < TICK_S) return;
    this.#lastTick = this.#time;
    this.#events.ticked?.(this.phase);
  }

  /** Turn on after a throw, more and more slowly; whether it still turns. */
  #slide(seconds: number): boolean {
    const { right, down } = this.#throw;
    if (Math.hypot(right, down) * DEGREES_PER_PX < MIN_SPEED_DEG_S) return false;
    const slower = Math.exp(-seconds / SLOWING_S);
    this.#throw = { right: right * slower, down: down * slower };
    this.#turn(right * seconds, down * seconds);
    return true;
  }

  #turn(right: number, down: number): void {
    const from = this.#hand ?? this.#shown?.state;
    if (!from) return;
    this.#hand = viewFrom(from.azimuth_deg + DEGREES_PER_PX * right, from.elevation_deg + DEGREES_PER_PX * down);
    this.#update();
    this.#reportHand();
  }

  #watchHand(signal: AbortSignal): void {
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    watchGestures(this.#canvas, signal, {
      begun: () => {
        this.#throw = NO_THROW;
        this.#keepTurned();
      },
      dragged: (right, down) => this.#turn(right, down),
      thrown: (right, down) => {
        if (calm.matches) return;
        this.#throw = { right, down };
        this.#wake();
      },
      tapped: (x, y) => this.#pick(x, y),
      zoomed: (factor) => this.#events.zoomed?.(factor),
    });
  }

  #pick(x: number, y: number): void {
    const figures = this.#shown?.figures ?? [];
    const number = this.#boxes.findIndex(
      ({ left, top, width, height }) => x >= left && x < left + width && y >= top && y < top + height,
    );
    const known = figures[number]?.known ?? null;
    if (figures.length > 1 && known !== null) this.#events.picked?.(known);
  }

  #resize(size: Size, pixelRatio: number): void {
    this.#size = size;
    this.#pixelRatio = pixelRatio;
    setResolution(this.#canvas, size.width_px, size.height_px, pixelRatio);
    this.#rebuild();
    // A canvas with a new size is empty: draw before the screen shows it.
    this.#animation?.draw(this.#context, this.#time, this.#pixelRatio);
  }

  #setVisible(visible: boolean): void {
    this.#visible = visible;
    if (visible) this.#wake();
    else this.#sleep();
  }

  /** In three dimensions if the page has the module, else flat. */
  #loadMannequin(): void {
    if (this.#loading) return;
    this.#loading = true;
    const load = this.#events.loadMannequin ?? mannequinInPage;
    void load()
      .catch((error: unknown) => {
        this.#events.mannequinMissing?.(error instanceof Error ? error.message : String(error));
        return flatPainter();
      })
      .then((painter) => {
        this.#mannequin = painter;
        this.#rebuild();
      });
  }
}
