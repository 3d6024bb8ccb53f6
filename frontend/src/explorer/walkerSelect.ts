/** The walker that the changes start from: the average, one of the population, or the visitor's own. */

import { endLabels, walkerLabel } from "../model/labels";
import { MAX_IN_CROWD, type SceneName, type State } from "../model/state";
import { button, freshId, make } from "../page/elements";
import { choice, pick, type Option } from "./controls";
import { bound, group, note } from "./parts";
import { captureFields, hasServer, markerNames, nameMarkers } from "./server";
import type { Part, Store } from "./store";

/** `open` lets the visitor choose files. */
export function walkerSelect(store: Store, open: () => void): Part {
  const { walkers } = store.model;
  const options: Option<State["from"]>[] = [
    { value: "average", label: "The average walker" },
    ...walkers.map((walker, value) => ({ value, label: walkerLabel(walker, store.model) })),
  ];
  const select = (from: State["from"]): void => store.change({ from, scene: "one" });
  const holder = make("div");
  let shown: string | null | undefined;
  let list = pick("Walker", options, select);
  const update = (own: string | null): void => {
    if (own === shown) return;
    shown = own;
    list = pick("Walker", own === null ? options : [...options, { value: "own", label: `${own} (yours)` }], select);
    holder.replaceChildren(list.element);
  };
  const next = (by: number): void => {
    const { from } = store.state;
    const number = typeof from === "number" ? from + by : by > 0 ? 0 : walkers.length - 1;
    select((number + walkers.length) % walkers.length);
  };
  const steps = make("div", { class: "row" },
    button("Previous", () => next(-1)),
    button("Next", () => next(1)),
    button("Random walker", () => select(Math.floor(Math.random() * walkers.length))),
  );
  const bring = make("p", { class: "note" },
    "Your own: drop a capture anywhere on this page, or ",
    button("choose a file", open, { class: "link" }),
    ".",
  );
  return {
    element: make("div", {}, holder, ...(walkers.length > 0 ? [steps] : []), bring, ...(hasServer() ? [aboutCaptures()] : [])),
    show({ state, own }) {
      update(own?.name ?? null);
      list.show(state.from);
    },
  };
}

const UNITS = ["mm", "cm", "m", "in", "ft"].map((unit) => ({ value: unit, label: unit }));

/** Fields for captures whose files name no frame rate or no unit, or wrong ones. */
function aboutCaptures(): HTMLElement {
  const id = freshId();
  const rate = make("input", { id, type: "number", min: 0.1, max: 100000, step: "any", placeholder: "as the file says", value: captureFields.rate });
  rate.addEventListener("input", () => setField("rate", rate.value));
  const unit = pick("Unit of length", [{ value: "", label: "as the file says" }, ...UNITS], (value) => setField("unit", value));
  unit.show(captureFields.unit ?? "");
  const fields = make("div", { class: "pair" },
    make("div", { class: "pick" }, make("label", { for: id }, "Frames a second"), rate), unit.element);
  return make("div", {}, fields, ownMarkerNames());
}

/** The file that names the markers of captures, where theirs are no known ones. */
function ownMarkerNames(): HTMLElement {
  const input = make("input", { type: "file", accept: ".toml", hidden: true, "aria-label": "File of marker names" });
  input.addEventListener("change", () => {
    nameMarkers(input.files?.[0] ?? markerNames.file);
    input.value = "";
  });
  const named = make("span", {});
  const choose = button("choose a file", () => input.click(), { class: "link" });
  const remove = button("remove", () => nameMarkers(null), { class: "link" });
  markerNames.changed = () => {
    named.textContent = markerNames.file ? `Marker names: ${markerNames.file.name}, ` : "Marker names of your own (.toml): ";
    choose.hidden = markerNames.file !== null;
    remove.hidden = markerNames.file === null;
  };
  markerNames.changed();
  return make("p", { class: "note" }, named, choose, remove, ".", input);
}

function setField(field: keyof typeof captureFields, value: string): void {
  if (value === "") delete captureFields[field];
  else captureFields[field] = value;
}

/** Several walkers at once: means of two classes and both tripled, four at one tempo, a crowd. */
export function sceneSelect(store: Store): Part {
  const { model } = store;
  const trait = model.traits.find(({ means }) => means !== null);
  const several = model.walkers.length > 1;
  const crowd = Math.min(model.walkers.length, MAX_IN_CROWD);
  const options: Option<SceneName>[] = [
    { value: "one", label: "One" },
    ...(trait ? [{ value: "four" as const, label: "Means" }] : []),
    ...(several ? [{ value: "side" as const, label: "Side by side" }, { value: "crowd" as const, label: "All" }] : []),
  ];
  const scene = choice("Scene", options, (value) => store.change({ scene: value }), { named: false });
  const texts: Record<SceneName, string> = {
    one: "One walker, changed by all the sliders.",
    four: trait ? `Mean ${endLabels(trait).join(" and mean ")}; then both with what sets them apart tripled. Sliders of traits change one walker: to move one leaves this.` : "",
    side: "Walkers of the population, brought to one tempo.",
    crowd: `${crowd} walkers of the population. Choose one to see it alone.`,
  };
  const about = note("");
  const names = model.walkers.map(({ name }, value) => ({ value, label: name }));
  const places = store.state.walkers.map((_, place) => {
    const one = pick(`Place ${place + 1}`, names, (walker) => store.change({ walkers: store.state.walkers.with(place, walker) }));
    return bound(one, ({ walkers }) => walkers[place] ?? 0);
  });
  const row = group({ class: "places" }, ...places);
  return {
    ...group({}, scene.element, about, row),
    show(now) {
      scene.show(now.state.scene);
      about.textContent = texts[now.state.scene];
      row.element.hidden = now.state.scene !== "side";
      row.show(now);
    },
  };
}
