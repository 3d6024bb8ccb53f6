/** Several at once: women and men and both tripled (M5), four at one tempo (M1), a crowd. */

import { MOST_IN_CROWD, type SceneName } from "../model/state";
import { choice, pick, type Option } from "./choice";
import { make } from "../page/element";
import type { Part, Session } from "./store";
import { capital, ends } from "./labels";

export function scenes(session: Session): Part {
  const { model } = session;
  const trait = model.traits.find(({ means }) => means !== null);
  const several = model.walkers.length > 1;
  const crowd = Math.min(model.walkers.length, MOST_IN_CROWD);
  const options: Option<SceneName>[] = [
    { value: "one", label: "One" },
    ...(trait ? [{ value: "four" as const, label: "Means" }] : []),
    ...(several ? [{ value: "side" as const, label: "Side by side" }] : []),
    ...(several ? [{ value: "crowd" as const, label: "All" }] : []),
  ];
  const chosen = choice("On the stage", options, (scene) => session.change({ scene }), { named: false });
  const about = make("p", { class: "note" });
  const said: Record<SceneName, string> = {
    one: "One walker, changed by all the sliders.",
    four: trait ? `Mean ${ends(trait).join(" and mean ")}; then both with what sets them apart tripled. Sliders of traits change one walker: to move one leaves this.` : "",
    side: "Walkers of the population, brought to one tempo.",
    crowd: `${crowd} walkers of the population. Choose one to see it alone.`,
  };
  const names = model.walkers.map(({ name }, value) => ({ value, label: name }));
  const seats = session.state.walkers.map((_, seat) =>
    pick(`Place ${seat + 1}`, names, (walker) =>
      session.change({ walkers: session.state.walkers.map((old, i) => (i === seat ? walker : old)) }),
    ),
  );
  const bench = make("div", { class: "seats" }, ...seats.map(({ element }) => element));
  return {
    element: make("div", {}, chosen.element, about, bench),
    show({ state }) {
      chosen.show(state.scene);
      about.textContent = capital(said[state.scene]);
      bench.hidden = state.scene !== "side";
      seats.forEach((seat, i) => seat.show(state.walkers[i] ?? 0));
    },
  };
}
