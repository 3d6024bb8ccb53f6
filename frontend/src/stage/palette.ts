/** Colours of the stage, dark and light; the page's style sheet takes the same. */

export interface Palette {
  readonly background: string;
  readonly colour: string;
  /** Of what is only hinted at: the ground. */
  readonly faint: string;
}

export const DARK: Palette = { background: "#0c0d0f", colour: "#ffffff", faint: "#16191e" };
export const LIGHT: Palette = { background: "#f8f7f3", colour: "#16181c", faint: "#efede6" };

export const paletteOf = (dark: boolean): Palette => (dark ? DARK : LIGHT);
