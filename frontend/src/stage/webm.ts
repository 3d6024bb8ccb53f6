/** VP8 or VP9 in a WebM file (RFC 9559): one track, a cluster for each frame it can be entered at. */

import { f64, joined, text, u16, u32, u8, type Bytes } from "./bytes";
import type { Packet, Track } from "./container";

const NS_IN_MS = 1_000_000;

/** Identifiers of elements. */
const EBML = 0x1a45dfa3;
const SEGMENT = 0x18538067;
const INFO = 0x1549a966;
const TRACKS = 0x1654ae6b;
const CLUSTER = 0x1f43b675;

export function webmFile(track: Track, codec: "V_VP8" | "V_VP9"): Bytes {
  const { width, height, rateHz, packets } = track;
  const header = element(EBML,
    number(0x4286, 1), number(0x42f7, 1), number(0x42f2, 4), number(0x42f3, 8), // versions, lengths
    element(0x4282, text("webm")), number(0x4287, 4), number(0x4285, 2),
  );
  const info = element(INFO,
    number(0x2ad7b1, NS_IN_MS), // a unit of time is a millisecond
    element(0x4489, f64((1000 * packets.length) / rateHz)), // duration
    element(0x4d80, text("eigenwalker")), element(0x5741, text("eigenwalker")),
  );
  const video = element(0xe0, number(0xb0, width), number(0xba, height));
  const entry = element(0xae,
    number(0xd7, 1), number(0x73c5, 1), number(0x83, 1), number(0x9c, 0), // number, uid, video, no lacing
    element(0x86, text(codec)), number(0x23e383, Math.round((1000 * NS_IN_MS) / rateHz)), video,
  );
  const clusters = entered(packets).map((frames) => cluster(frames, rateHz));
  return joined(header, element(SEGMENT, info, element(TRACKS, entry), ...clusters));
}

/** Packets from each key frame to before the next. */
function entered(packets: readonly Packet[]): Packet[][] {
  const starts = packets.flatMap(({ isKey }, i) => (isKey ? [i] : []));
  return starts.map((start, i) => packets.slice(start, starts[i + 1]));
}

function cluster(packets: readonly Packet[], rateHz: number): Bytes {
  const time = (frame: number): number => Math.round((1000 * frame) / rateHz);
  const start = time(packets[0]!.frame);
  const blocks = packets.map(({ bytes, isKey, frame }) =>
    element(0xa3, u8(0x81), u16(time(frame) - start), u8(isKey ? 0x80 : 0), bytes),
  );
  return element(CLUSTER, number(0xe7, start), ...blocks);
}

/** An element: its identifier, its size in eight bytes, what it holds. */
function element(id: number, ...parts: readonly Uint8Array[]): Bytes {
  const size = parts.reduce((sum, part) => sum + part.length, 0);
  return joined(trimmed(u32(id)), u8(1, 0, 0, 0), u32(size), ...parts);
}

const number = (id: number, value: number): Bytes => element(id, u32(value));

/** Without the zeros at its beginning. */
function trimmed(bytes: Bytes): Bytes {
  return bytes.subarray(bytes.findIndex((byte) => byte !== 0)) as Bytes;
}
