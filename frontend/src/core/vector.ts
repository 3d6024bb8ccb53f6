/** Directions and places in three dimensions: x forward, y to the walker's left, z up. */

export type Vector = readonly [number, number, number];

/** The observer's right, up, and the direction towards the observer. */
export type Axes = readonly [Vector, Vector, Vector];

export const radians = (degrees: number): number => degrees * (Math.PI / 180);

export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/** The observer's axes as unit vectors of the scene; 0 degrees is the front, 90 in profile. */
export function observerAxes(viewDeg: number, elevationDeg: number): Axes {
  const view = radians(viewDeg);
  const elevation = radians(elevationDeg);
  const ahead: Vector = [Math.cos(view), -Math.sin(view), 0];
  const [sine, cosine] = [Math.sin(elevation), Math.cos(elevation)];
  return [
    [Math.sin(view), Math.cos(view), 0],
    [-sine * ahead[0], -sine * ahead[1], cosine],
    [cosine * ahead[0], cosine * ahead[1], sine],
  ];
}
