/** Colours of the stage, dark and light; the page's style sheet takes the same. */

export interface Palette {
  readonly background: string;
  readonly colour: string;
  /** Of the mannequin, whose shades are darker. */
  readonly body: string;
  /** Of what is only hinted at: the ground. */
  readonly faint: string;
}

export const DARK: Palette = { background: "#0c0d0f", colour: "#ffffff", body: "#ffffff", faint: "#16191e" };
export const LIGHT: Palette = { background: "#f8f7f3", colour: "#16181c", body: "#c9bfae", faint: "#efede6" };

export const paletteOf = (dark: boolean): Palette => (dark ? DARK : LIGHT);
