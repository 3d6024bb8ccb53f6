/** The stage: draws who is on it at the rate of the screen, and lets itself be turned by dragging. */

import { everyFrame } from "../canvas/frameClock";
import { heldMannequin, type MannequinPainter } from "../canvas/mannequinLoader";
import { flatPainter } from "../mannequin/hullPainter";
import type { Cast } from "../model/figures";
import type { Model } from "../model/model";
import type { State } from "../model/state";
import { actOf, lead, type Act } from "./animation";
import { watchGestures } from "./dragging";
import { sameAct, seenAlike, seenFrom, type Built, type Seen, type Shown } from "./shown";
import { boxesOf, stagingOf, type Box, type Room, type Size, type Staging } from "./arrangement";
import { roomFor } from "./viewedStimulus";
import { watchSight, watchSize } from "./visibility";

export type { Box } from "./arrangement";

/** Told by the stage; all may be left out. */
export interface Hooks {
  /** It was turned by dragging. */
  turned?(azimuth_deg: number, elevation_deg: number): void;
  /**
   * Where in its stride the first walker is, from 0 to below 1, some times a second: to lay out a
   * page for each frame would cost more than to draw the walker.
   */
  ticked?(cycle: number): void;
  /** One of several was tapped: its number among the model's walkers. */
  picked?(known: number): void;
  /** Where each walker stands now, in pixels of CSS. */
  laid?(boxes: readonly Box[]): void;
  /** The mannequin is drawn flat, as what draws it in three dimensions is not there; the message says why. */
  lacking?(message: string): void;
  /** Where the mannequin comes from, if not from the page. */
  mannequin?(): Promise<MannequinPainter>;
}

const DEGREES_PER_PX = 0.5;
const TICK_S = 0.06;
/** A screen that stood still meanwhile does not make up for it. */
const LONGEST_FRAME_S = 0.1;
/** How soon a stage that was thrown comes to rest, and when it has. */
const SLOWING_S = 0.28;
const RESTS_DEG_S = 4;

export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #hooks: Hooks;
  readonly #endings: (() => void)[];
  #shown: Shown | null = null;
  #act: Act | null = null;
  #built: Built | null = null;
  #boxes: readonly Box[] = [];
  #room: { cast: readonly Cast[]; room: Room } | null = null;
  #size: Size = { width_px: 0, height_px: 0 };
  #fine = 1;
  #mannequin: MannequinPainter | null = null;
  #asked = false;
  #stop: (() => void) | null = null;
  #time = 0;
  #ticked = -Infinity;
  #inSight = !document.hidden;
  #dirty = true;
  /** Turned by hand: the state follows, and is not heard until it has. */
  #hand: Seen | null = null;
  #throw = { right: 0, down: 0 };

  constructor(canvas: HTMLCanvasElement, hooks: Hooks = {}) {
    const context = canvas.getContext("2d", { alpha: false });
    if (!context) throw new Error("This browser gives no canvas to draw on.");
    this.#canvas = canvas;
    this.#context = context;
    this.#hooks = hooks;
    this.#endings = [
      watchSize(canvas, (size, fine) => this.#resize(size, fine)),
      watchSight(canvas, (inSight) => this.#beSeen(inSight)),
      this.#watchHand(),
    ];
  }

  /** Where in its stride the first walker is, from 0 to below 1. */
  get cycle(): number {
    const cycles = this.#act?.cycle(0, this.#time) ?? 0;
    return cycles - Math.floor(cycles);
  }

  /** What draws mannequins, once it was asked for and is there. */
  get mannequin(): MannequinPainter | null {
    return this.#mannequin;
  }

  /** Show these from the next frame on; strides go on where they are. */
  show(model: Model, cast: readonly Cast[], state: State): void {
    const before = this.#shown;
    this.#shown = { model, cast, state };
    if (this.#hand && !seenAlike(this.#hand, state)) this.#throw = { right: 0, down: 0 };
    this.#hand = null;
    if (state.style === "mannequin") this.#askForMannequin();
    if (state.turning_deg_s === 0) this.#fold();
    const scrubbed = before && !state.playing && before.state.cycle !== state.cycle;
    if (scrubbed) this.#rebuild(state.cycle - this.cycle);
    else if (!this.#built || !sameAct(this.#built, this.#shown)) this.#rebuild();
    else if (!seenAlike(this.#built.state, state)) this.#look();
    else this.#wake();
  }

  /** Stop for good. */
  remove(): void {
    this.#sleep();
    for (const end of this.#endings) end();
    this.#shown = null;
  }

  /** Make the act anew, each walker in the stride where it was, or so many cycles on. */
  #rebuild(on = 0): void {
    const shown = this.#shown;
    if (!shown || this.#size.width_px === 0 || this.#size.height_px === 0) return;
    const { model, cast } = shown;
    const state = { ...shown.state, ...this.#hand };
    if (this.#room?.cast !== cast) this.#room = { cast, room: roomFor(model, cast) };
    const staging = stagingOf(cast.length, this.#room.room, this.#size, state.elevation_deg);
    const [size, time, mannequin] = [this.#size, this.#time, this.#mannequin];
    const cycles = cast.map((_, i) => on + this.#cycleOf(i));
    const turned_deg = this.#turnedBy(time);
    this.#act = actOf({ model, cast, state, size, staging, cycles, time, turned_deg, mannequin });
    this.#built = { model, cast, state, time, turned_deg };
    this.#lay(staging);
    this.#wake();
  }

  /** See the same act from elsewhere. */
  #look(): void {
    const { state, cast } = this.#shown ?? {};
    if (!state || !cast || !this.#built || !this.#room) return;
    const view = { ...state, ...this.#hand };
    const staging = stagingOf(cast.length, this.#room.room, this.#size, view.elevation_deg);
    if (!this.#act?.turn(view.azimuth_deg, view.elevation_deg, staging)) return this.#rebuild();
    const { azimuth_deg, elevation_deg } = view;
    this.#built = { ...this.#built, state: { ...this.#built.state, azimuth_deg, elevation_deg } };
    this.#lay(staging);
    this.#wake();
  }

  /** How far it has turned by itself. */
  #turnedBy(time: number): number {
    const built = this.#built;
    return built ? built.turned_deg + built.state.turning_deg_s * (time - built.time) : 0;
  }

  /** From now on it is seen from where it came to by turning itself. */
  #fold(): void {
    const { state } = this.#shown ?? {};
    const turned = this.#turnedBy(this.#time);
    if (!state || !this.#built || turned === 0) return;
    this.#built = { ...this.#built, turned_deg: 0, time: this.#time };
    this.#hand = seenFrom(state.azimuth_deg + turned, state.elevation_deg);
    this.#rebuild();
    this.#tellHand();
  }

  #tellHand(): void {
    if (this.#hand) this.#hooks.turned?.(this.#hand.azimuth_deg, this.#hand.elevation_deg);
  }

  /** Where in its stride a walker goes on. */
  #cycleOf(number: number): number {
    const { state } = this.#shown!;
    const ahead = lead(state, number);
    if (!this.#act) return state.cycle + ahead;
    const known = this.#built?.state.scene === state.scene ? this.#act.cycle(number, this.#time) : NaN;
    return Number.isFinite(known) ? known : this.#act.cycle(0, this.#time) + ahead;
  }

  #lay(staging: Staging): void {
    this.#boxes = boxesOf(staging, this.#size);
    this.#hooks.laid?.(this.#boxes);
  }

  /** Draw a frame, and go on drawing while anything moves. */
  #wake(): void {
    this.#dirty = true;
    if (this.#stop || !this.#inSight) return;
    let before = 0;
    this.#stop = everyFrame((elapsedMs) => {
      const lasted = Math.min((elapsedMs - before) / 1000, LONGEST_FRAME_S);
      before = elapsedMs;
      const goesOn = this.#frame(lasted);
      if (!goesOn) this.#stop = null;
      return goesOn;
    });
  }

  #sleep(): void {
    this.#stop?.();
    this.#stop = null;
  }

  /** One frame; whether there will be another. */
  #frame(lasted: number): boolean {
    const state = this.#shown?.state;
    if (!state || !this.#act) return false;
    if (state.playing) this.#time += lasted;
    const slides = this.#slide(lasted);
    if (state.playing || this.#dirty) {
      this.#dirty = false;
      this.#act.draw(this.#context, this.#time, this.#fine);
      this.#tick(state.playing);
    }
    return state.playing || slides || this.#dirty;
  }

  #tick(playing: boolean): void {
    if (playing && Math.abs(this.#time - this.#ticked) < TICK_S) return;
    this.#ticked = this.#time;
    this.#hooks.ticked?.(this.cycle);
  }

  /** Turn on after a throw, slower and slower; whether it still turns. */
  #slide(lasted: number): boolean {
    const { right, down } = this.#throw;
    if (Math.hypot(right, down) * DEGREES_PER_PX < RESTS_DEG_S) return false;
    const slower = Math.exp(-lasted / SLOWING_S);
    this.#throw = { right: right * slower, down: down * slower };
    this.#turn(right * lasted, down * lasted);
    return true;
  }

  #turn(right: number, down: number): void {
    const from = this.#hand ?? this.#shown?.state;
    if (!from) return;
    this.#hand = seenFrom(from.azimuth_deg + DEGREES_PER_PX * right, from.elevation_deg + DEGREES_PER_PX * down);
    this.#look();
    this.#tellHand();
  }

  #watchHand(): () => void {
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    return watchGestures(this.#canvas, {
      begun: () => {
        this.#throw = { right: 0, down: 0 };
        this.#fold();
      },
      dragged: (right, down) => this.#turn(right, down),
      thrown: (right, down) => {
        if (calm.matches) return;
        this.#throw = { right, down };
        this.#wake();
      },
      tapped: (x, y) => this.#pick(x, y),
    });
  }

  /** Whose box a place is in. */
  #pick(x: number, y: number): void {
    const cast = this.#shown?.cast ?? [];
    const number = this.#boxes.findIndex(
      ({ left, top, width, height }) => x >= left && x < left + width && y >= top && y < top + height,
    );
    const known = cast[number]?.known ?? null;
    if (cast.length > 1 && known !== null) this.#hooks.picked?.(known);
  }

  #resize(size: Size, fine: number): void {
    this.#size = size;
    this.#fine = fine;
    this.#canvas.width = Math.round(size.width_px * fine);
    this.#canvas.height = Math.round(size.height_px * fine);
    this.#rebuild();
    // A canvas that has a new size is empty: it is drawn before the screen shows it.
    this.#act?.draw(this.#context, this.#time, this.#fine);
  }

  /** No work while nobody sees it. */
  #beSeen(inSight: boolean): void {
    this.#inSight = inSight;
    if (inSight) this.#wake();
    else this.#sleep();
  }

  /** In three dimensions where the page holds what draws it, else flat. */
  #askForMannequin(): void {
    if (this.#asked) return;
    this.#asked = true;
    const load = this.#hooks.mannequin ?? heldMannequin;
    const lacking = (error: unknown): MannequinPainter => {
      this.#hooks.lacking?.(error instanceof Error ? error.message : String(error));
      return flatPainter();
    };
    void load()
      .catch(lacking)
      .then((painter) => {
        this.#mannequin = painter;
        this.#rebuild();
      });
  }
}
