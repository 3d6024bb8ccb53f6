/** Controls of the view and of the transforms. */

import {
  fieldsOf, initialSettings, initialState, RANGES, TRANSFORM_NAMES, TRANSFORMS,
  type Field, type TransformName, type Transforms,
} from "../model/state";
import { make } from "../page/elements";
import { type Control, pick, slider, toggle } from "./controls";
import { bound, group } from "./parts";
import type { Part, Store } from "./store";

export function viewControls(store: Store): Part {
  const flag = (label: string, name: "trails" | "perspective", hint: string): Part =>
    bound(toggle(label, (on) => store.change({ [name]: on }), hint), (state) => state[name]);
  type Angle = "azimuth_deg" | "elevation_deg" | "turning_deg_s";
  const angle = (label: string, name: Angle, step: number, unit = ""): Part => {
    const [min, max] = RANGES[name];
    const one = slider({
      label, min, max, step, initial: initialState(store.model)[name],
      format: (value) => `${Math.round(value)}\u00b0`.replace("-", "\u2212") + unit,
      onInput: (value) => store.change({ [name]: value }),
    });
    return bound(one, (state) => state[name]);
  };
  const factor = slider({
    label: "Zoom", min: Math.log2(RANGES.zoom[0]), max: Math.log2(RANGES.zoom[1]), step: 0.05, initial: 0,
    format: (value) => `\u00d7 ${Number((2 ** value).toFixed(2))}`,
    onInput: (value) => store.change({ zoom: 2 ** value }),
  });
  const zoom = bound({ ...factor, show: (value: number) => factor.show(Math.log2(value)) }, (state) => state.zoom);
  return group({},
    group({ class: "row switches" },
      flag("Trails", "trails", "Where each point has been"),
      flag("Perspective", "perspective", "What is near is larger")),
    group({ class: "sliders" },
      angle("Seen from", "azimuth_deg", 1),
      angle("Height of the eye", "elevation_deg", 1),
      angle("Turns by itself", "turning_deg_s", 5, " a second"),
      zoom));
}

/** Seeds can be any whole number; the slider gives the first few. */
const MAX_SEED = 99;

/** A switch for each transform; its parameters are visible while it is on. */
export const transformControls = (store: Store): Part =>
  group({ class: "transforms" }, ...TRANSFORM_NAMES.map((name) => transformControl(store, name)));

function transformControl(store: Store, name: TransformName): Part {
  const { label, hint } = TRANSFORMS[name];
  const change = (settings: unknown): void => {
    const { [name]: _, ...others } = store.state.transforms;
    const next = settings === undefined ? others : { ...others, [name]: settings };
    store.change({ transforms: next as Transforms });
  };
  const on = toggle(label, (is) => change(is ? initialSettings(name) : undefined), hint);
  const fields = Object.entries(fieldsOf(name)).map(([field, of]) => ({
    field,
    ...fieldControl(label, of, (value) => change({ ...store.state.transforms[name], [field]: value })),
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

function fieldControl(transform: string, field: Field, onChange: (value: unknown) => void): Control<unknown> {
  const { label } = field;
  if ("choices" in field) {
    const options = field.choices.map((value) => ({ value, label: value.replaceAll("_", " ") }));
    const { element, show } = pick(label, options, onChange);
    element.querySelector("select")?.setAttribute("aria-label", `${transform}: ${label}`);
    return { element, show: (value) => show(String(value)) };
  }
  const { initial, low, step } = field;
  const { element, input, show } = slider({
    label, min: low, max: label === "Seed" ? MAX_SEED : field.high, step, initial,
    format: (value) => String(Number(value.toFixed(2))),
    onInput: onChange,
  });
  input.setAttribute("aria-label", `${transform}: ${label}`);
  return { element, show: (value) => show(Number(value)) };
}
