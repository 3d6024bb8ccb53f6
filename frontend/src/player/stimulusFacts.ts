/** What a stimulus is, in words: pairs of a term and what is said of it. */

import type { Stimulus } from "../core/stimulus";

export function aboutStimulus(stimulus: Stimulus, scale: number): [string, string][] {
  const { display, timing, view, provenance, transforms } = stimulus;
  const eye = view.eye_distance_mm === null ? "orthographic" : `eye at ${view.eye_distance_mm} mm`;
  const size = `${display.width_px} x ${display.height_px} px`;
  return [
    ["shown", `${timing.duration_s} s, again and again`],
    ["view", `${view.view_deg} degrees, elevation ${view.elevation_deg}, ${eye}`],
    ["size", scale < 1 ? `${size}, here at ${Math.round(100 * scale)} %` : size],
    ...transforms.map((step, i): [string, string] => [`transform ${i + 1}`, inWords(step)]),
    ...Object.entries(provenance),
  ];
}

/** A transform with its parameters; another walker is not spelled out. */
function inWords({ name, ...parameters }: Stimulus["transforms"][number]): string {
  const said = Object.entries(parameters)
    .filter(([parameter, value]) => parameter !== "walker" && value !== null)
    .map(([parameter, value]) => `${parameter} ${Array.isArray(value) ? value.join(", ") : value}`);
  return said.length > 0 ? `${name}: ${said.join("; ")}` : name;
}
