/** Films made in the browser: H.264 in MP4, or another codec that the browser has. */

import { BufferTarget, CanvasSource, Mp4OutputFormat, Output, WebMOutputFormat } from "mediabunny";
import { contextOf } from "../canvas/painter";

/** This browser cannot make the film; the message names an alternative. */
export class FilmError extends Error {}

export interface FilmSpec {
  /** Size of the picture in pixels; even numbers. */
  readonly width: number;
  readonly height: number;
  readonly frames: number;
  readonly rateHz: number;
  /** Draw a frame of the film, by its number. */
  readonly draw: (context: CanvasRenderingContext2D, frame: number) => void;
  /** Called after each frame with the share that is done. */
  readonly progress?: ((share: number) => void) | undefined;
  readonly signal?: AbortSignal | undefined;
}

export interface Film {
  readonly blob: Blob;
  readonly suffix: "mp4" | "webm";
}

/** Codec, its name in WebCodecs, and container, in order of preference: H.264 high and baseline, VP9, VP8. */
const ENCODINGS = [
  ["avc", "avc1.640033", "mp4"],
  ["avc", "avc1.42003e", "mp4"],
  ["vp9", "vp09.00.51.08", "webm"],
  ["vp8", "vp8", "webm"],
] as const;
/** Enough for dots with sharp edges. */
const BITS_PER_PIXEL = 0.2;
const KEY_FRAME_S = 1;

/** Make a film, frame by frame. */
export async function encodeFilm(spec: FilmSpec): Promise<Film> {
  const { width, height, frames, rateHz, draw, progress, signal } = spec;
  const { suffix, config } = await chooseEncoding(spec);
  const output = new Output({
    format: suffix === "mp4" ? new Mp4OutputFormat({ fastStart: "in-memory" }) : new WebMOutputFormat(),
    target: new BufferTarget(),
  });
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = contextOf(canvas, { alpha: false, willReadFrequently: true });
  const source = new CanvasSource(canvas, config);
  output.addVideoTrack(source, { frameRate: rateHz });
  try {
    await output.start();
    for (let number = 0; number < frames; number++) {
      signal?.throwIfAborted();
      draw(context, number);
      await source.add(number / rateHz, 1 / rateHz);
      await new Promise((done) => setTimeout(done)); // the page can react meanwhile
      progress?.((number + 1) / frames);
    }
    await output.finalize();
  } catch (error) {
    await output.cancel();
    if (signal?.aborted) throw error;
    throw new FilmError(`The encoder of this browser failed: ${error instanceof Error ? error.message : String(error)}`);
  }
  return { blob: new Blob([output.target.buffer!], { type: `video/${suffix}` }), suffix };
}

/** The first encoding that this browser supports. */
async function chooseEncoding({ width, height, rateHz }: Pick<FilmSpec, "width" | "height" | "rateHz">) {
  if (typeof VideoEncoder === "undefined") {
    throw new FilmError("This browser encodes no films; eigenwalker serve makes them, and so does eigenwalker stimulus of a saved stimulus file.");
  }
  const bitrate = Math.round(width * height * rateHz * BITS_PER_PIXEL);
  for (const [codec, name, suffix] of ENCODINGS) {
    const asked = { codec: name, width, height, framerate: rateHz, bitrate, latencyMode: "quality" as const };
    const { supported } = await VideoEncoder.isConfigSupported(asked).catch(() => ({ supported: false }));
    const config = { codec, fullCodecString: name, bitrate, keyFrameInterval: KEY_FRAME_S, latencyMode: "quality" as const };
    if (supported) return { suffix, config };
  }
  throw new FilmError(`This browser encodes no film of ${width} x ${height} pixels, neither H.264 nor VP9 nor VP8; eigenwalker serve makes them.`);
}
