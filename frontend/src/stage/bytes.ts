/** Numbers and texts as the bytes that film files are made of; the most significant byte first. */

export type Bytes = Uint8Array<ArrayBuffer>;

export function joined(...parts: readonly Uint8Array[]): Bytes {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  parts.reduce((at, part) => (whole.set(part, at), at + part.length), 0);
  return whole;
}

export const text = (letters: string): Bytes => Uint8Array.from(letters, (letter) => letter.charCodeAt(0));

export const zeros = (count: number): Bytes => new Uint8Array(count);

export const u8 = (...values: readonly number[]): Bytes => Uint8Array.from(values);

export function u16(...values: readonly number[]): Bytes {
  const view = new DataView(new ArrayBuffer(2 * values.length));
  values.forEach((value, i) => view.setUint16(2 * i, value));
  return new Uint8Array(view.buffer);
}

/** Negative values as two's complements. */
export function u32(...values: readonly number[]): Bytes {
  const view = new DataView(new ArrayBuffer(4 * values.length));
  values.forEach((value, i) => view.setUint32(4 * i, value >>> 0));
  return new Uint8Array(view.buffer);
}

export function f64(value: number): Bytes {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, value);
  return new Uint8Array(view.buffer);
}
