/** How it is looked at: trails, perspective, turning, and the transforms of psychophysics. */

import {
  RANGES, TRANSFORMS, TRANSFORM_NAMES, usualSettings,
  type Field, type TransformName, type Transforms,
} from "../model/state";
import { pick, toggle, type Switch } from "./choice";
import { make } from "../page/element";
import type { Part, Session } from "./store";
import { slider } from "./slider";

export function look(session: Session): Part {
  const trails = toggle("Trails", (on) => session.change({ trails: on }), "Where each point has been");
  const perspective = toggle("Perspective", (on) => session.change({ perspective: on }), "What is near is larger");
  const degrees = (value: number): string => `${Math.round(value)}\u00b0`.replace("-", "\u2212");
  const angle = (label: string, name: "azimuth_deg" | "elevation_deg" | "turning_deg_s", usual: number, unit = "") =>
    slider({
      label, min: RANGES[name][0], max: RANGES[name][1], step: name === "turning_deg_s" ? 5 : 1, usual,
      said: (value) => degrees(value) + unit,
      onInput: (value) => session.change({ [name]: value }),
    });
  const azimuth = angle("Seen from", "azimuth_deg", 30);
  const elevation = angle("Height of the eye", "elevation_deg", 0);
  const turning = angle("Turns by itself", "turning_deg_s", 0, " a second");
  return {
    element: make("div", {},
      make("div", { class: "row switches" }, trails.element, perspective.element),
      make("div", { class: "sliders" }, azimuth.element, elevation.element, turning.element),
    ),
    show({ state }) {
      trails.show(state.trails);
      perspective.show(state.perspective);
      azimuth.show(state.azimuth_deg);
      elevation.show(state.elevation_deg);
      turning.show(state.turning_deg_s);
    },
  };
}

const NAMES: Readonly<Record<TransformName, readonly [string, string]>> = {
  arm_swing: ["Arm swing", "Larger or smaller swing of the arms"],
  conflict: ["Widths and sway", "Shoulders and hips set against how they sway"],
  ellipses: ["Ellipses", "Shoulders and hips go round, as in synthetic walkers"],
  reverse: ["Backwards", "Time runs the other way"],
  delay: ["Lag", "Some joints follow later in the stride"],
  phase_scramble: ["Phases", "Each point at its own moment of the stride"],
  mirror: ["Mirror", "Left and right exchanged"],
  invert: ["Upside down", "Inverted about the middle"],
  occlude: ["Hide parts", "Some points are not drawn"],
  scramble: ["Scramble", "Points keep their motion and lose their place"],
  limb_dots: ["Limb dots", "Points anywhere on the limbs, for a short life"],
  blur: ["Blur", "Soft blobs in place of points"],
  mask: ["Mask", "Other points that move as well"],
};
const FIELDS: Readonly<Record<string, string>> = {
  factor: "Times", spread: "Spread", seed: "Seed", part: "Which", keep: "Keep", directions: "Directions",
  shoulder_width: "Shoulder width", hip_width: "Hip width", shoulder_sway: "Shoulder sway", hip_sway: "Hip sway",
  shoulder_forward_mm: "Shoulders forward, mm", shoulder_up_mm: "Shoulders up, mm",
  hip_forward_mm: "Hips forward, mm", hip_up_mm: "Hips up, mm", phase_deg: "By, degrees",
  number: "How many", lifetime_s: "Life, s", places: "On", sd_mm: "Width, mm", kind: "Kind", speed_mm_s: "Speed, mm/s",
};
/** A seed may be any whole number; the slider gives the first few. */
const SEEDS = 99;

/** A switch for each transform; its parameters are there while it is on. */
export function transforms(session: Session): Part {
  const all = TRANSFORM_NAMES.map((name) => transform(session, name));
  return {
    element: make("div", { class: "transforms" }, ...all.map(({ element }) => element)),
    show: (now) => all.forEach((one) => one.show(now)),
  };
}

function transform(session: Session, name: TransformName): Part {
  const [label, hint] = NAMES[name];
  const change = (settings: unknown): void => {
    const { [name]: _, ...others } = session.state.transforms;
    const next = settings === undefined ? others : { ...others, [name]: settings };
    session.change({ transforms: next as Transforms });
  };
  const on: Switch = toggle(label, (is) => change(is ? usualSettings(name) : undefined), hint);
  const fields = Object.entries(TRANSFORMS[name] as Readonly<Record<string, Field>>).map(([field, of]) => ({
    field,
    ...setting(`${label}: ${FIELDS[field] ?? field}`, FIELDS[field] ?? field, of, (value) =>
      change({ ...session.state.transforms[name], [field]: value }),
    ),
  }));
  const settings = make("div", { class: "settings" }, ...fields.map(({ element }) => element));
  return {
    element: make("div", { class: "transform" }, on.element, ...(fields.length > 0 ? [settings] : [])),
    show({ state }) {
      const now = state.transforms[name] as Readonly<Record<string, unknown>> | undefined;
      on.show(now !== undefined);
      settings.hidden = now === undefined;
      if (now) for (const { field, show } of fields) show(now[field]);
    },
  };
}

interface Setting {
  readonly element: HTMLElement;
  show(value: unknown): void;
}

function setting(full: string, label: string, field: Field, onChange: (value: unknown) => void): Setting {
  if ("choices" in field) {
    const options = field.choices.map((value) => ({ value, label: value.replaceAll("_", " ") }));
    const picked = pick(label, options, onChange);
    picked.element.querySelector("select")?.setAttribute("aria-label", full);
    return { element: picked.element, show: (value) => picked.show(String(value)) };
  }
  const { usual, low, step } = field;
  const max = label === "Seed" ? SEEDS : field.high;
  const one = slider({
    label, min: low, max, step, usual,
    said: (value) => String(Number(value.toFixed(2))),
    onInput: onChange,
  });
  one.input.setAttribute("aria-label", full);
  return { element: one.element, show: (value) => one.show(Number(value)) };
}
