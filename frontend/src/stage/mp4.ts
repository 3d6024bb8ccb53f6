/** H.264 in an MP4 file (ISO/IEC 14496-12 and -15): one track, its index before its frames. */

import { joined, text, u16, u32, zeros, type Bytes } from "./bytes";
import type { Track } from "./container";

/** Units of time in a frame: enough for half frames of any player. */
const UNITS = 2;
/** No rotation. */
const MATRIX = u32(0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000);

/** The file; `description` is the AVCDecoderConfigurationRecord that the encoder told. */
export function mp4File(track: Track, description: Uint8Array): Bytes {
  const kind = box("ftyp", text("isom"), u32(0x200), text("isomiso2avc1mp41"));
  const start = (offset: number): Bytes => joined(kind, movie(track, description, offset));
  const frames = box("mdat", ...track.packets.map(({ bytes }) => bytes));
  const header = 8;
  return joined(start(start(0).length + header), frames);
}

function box(name: string, ...parts: readonly Uint8Array[]): Bytes {
  const size = parts.reduce((sum, part) => sum + part.length, 8);
  return joined(u32(size), text(name), ...parts);
}

/** A box that begins with its version and flags. */
const fullBox = (name: string, version: number, flags: number, ...parts: readonly Uint8Array[]): Bytes =>
  box(name, u32((version << 24) | flags), ...parts);

function movie(track: Track, description: Uint8Array, offset: number): Bytes {
  const timescale = UNITS * track.rateHz;
  const duration = UNITS * track.packets.length;
  const dates = u32(0, 0);
  const header = fullBox(
    "mvhd", 0, 0, dates, u32(timescale, duration, 0x10000), u16(0x100), zeros(10), MATRIX, zeros(24), u32(2),
  );
  const shown = 3;
  const trackHeader = fullBox(
    "tkhd", 0, shown, dates, u32(1, 0, duration), zeros(8), u16(0, 0, 0, 0), MATRIX,
    u32(track.width << 16, track.height << 16),
  );
  const undetermined = 0x55c4;
  const media = box(
    "mdia",
    fullBox("mdhd", 0, 0, dates, u32(timescale, duration), u16(undetermined, 0)),
    fullBox("hdlr", 0, 0, u32(0), text("vide"), zeros(12), text("walkers\0")),
    box(
      "minf",
      fullBox("vmhd", 0, 1, zeros(8)),
      box("dinf", fullBox("dref", 0, 0, u32(1), fullBox("url ", 0, 1))),
      box("stbl", ...samples(track, description, offset)),
    ),
  );
  return box("moov", header, box("trak", trackHeader, media));
}

/** Tables of all frames: what they are, when, where, and how large. */
function samples({ width, height, packets }: Track, description: Uint8Array, offset: number): Bytes[] {
  const dotsPerInch = 0x480000;
  const entry = box(
    "avc1", zeros(6), u16(1), zeros(16), u16(width, height), u32(dotsPerInch, dotsPerInch, 0), u16(1),
    zeros(32), u16(24, 0xffff), box("avcC", description),
  );
  const keys = packets.flatMap(({ isKey }, i) => (isKey ? [i + 1] : []));
  const late = packets.map(({ frame }, i) => UNITS * (frame - i));
  const reordered = late.some((units) => units !== 0);
  return [
    fullBox("stsd", 0, 0, u32(1), entry),
    fullBox("stts", 0, 0, u32(1, packets.length, UNITS)),
    ...(reordered ? [fullBox("ctts", 1, 0, u32(late.length, ...late.flatMap((units) => [1, units])))] : []),
    fullBox("stss", 0, 0, u32(keys.length, ...keys)),
    fullBox("stsc", 0, 0, u32(1, 1, packets.length, 1)),
    fullBox("stsz", 0, 0, u32(0, packets.length, ...packets.map(({ bytes }) => bytes.length))),
    fullBox("stco", 0, 0, u32(1, offset)),
  ];
}
