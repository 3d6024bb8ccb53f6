import { Scene } from "three";

/** A stub. */
export const scene = (): Scene => new Scene();
