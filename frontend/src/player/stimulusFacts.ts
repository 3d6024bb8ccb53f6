/** Facts about a stimulus: pairs of a term and a text. */

import type { Step, Stimulus } from "../core/stimulus";

export function stimulusFacts(stimulus: Stimulus, scale: number): [string, string][] {
  const { display, timing, view, provenance, transforms } = stimulus;
  const eye = view.eye_distance_mm === null ? "orthographic" : `eye at ${view.eye_distance_mm} mm`;
  const size = `${display.width_px} x ${display.height_px} px`;
  return [
    ["shown", `${timing.duration_s} s, again and again`],
    ["view", `${view.view_deg} degrees, elevation ${view.elevation_deg}, ${eye}`],
    ["size", scale < 1 ? `${size}, here at ${Math.round(100 * scale)} %` : size],
    ...transforms.map((step, i): [string, string] => [`transform ${i + 1}`, stepText(step)]),
    ...Object.entries(provenance),
  ];
}

/** A transform with its parameters, without the walker of a morph. */
function stepText({ name, ...parameters }: Step): string {
  const texts = Object.entries(parameters)
    .filter(([parameter, value]) => parameter !== "walker" && value !== null)
    .map(([parameter, value]) => `${parameter} ${Array.isArray(value) ? value.join(", ") : value}`);
  return texts.length > 0 ? `${name}: ${texts.join("; ")}` : name;
}
