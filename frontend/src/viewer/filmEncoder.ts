/** Films made in the browser: H.264 in MP4, or another codec that the browser has. */

import {
  BufferTarget, EncodedPacket, EncodedVideoPacketSource, Mp4OutputFormat, Output, WebMOutputFormat,
} from "mediabunny";
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
/** Limit of the frames that wait for the encoder. */
const MAX_QUEUE = 8;

export async function encodeFilm(spec: FilmSpec): Promise<Film> {
  const { codec, suffix, config } = await chooseEncoding(spec);
  const packets = await encodeFrames(spec, config);
  const output = new Output({
    format: suffix === "mp4" ? new Mp4OutputFormat({ fastStart: "in-memory" }) : new WebMOutputFormat(),
    target: new BufferTarget(),
  });
  const source = new EncodedVideoPacketSource(codec);
  output.addVideoTrack(source, { frameRate: spec.rateHz });
  await output.start();
  for (const packet of packets) await source.add(...packet);
  await output.finalize();
  return { blob: new Blob([output.target.buffer!], { type: `video/${suffix}` }), suffix };
}

/** The first encoding that this browser has for a film of this size. */
export async function chooseEncoding({ width, height, rateHz }: Pick<FilmSpec, "width" | "height" | "rateHz">) {
  if (typeof VideoEncoder === "undefined") {
    throw new FilmError("This browser encodes no films; eigenwalker serve makes them, and so does eigenwalker stimulus of a saved stimulus file.");
  }
  const bitrate = Math.round(width * height * rateHz * BITS_PER_PIXEL);
  for (const [codec, name, suffix] of ENCODINGS) {
    const config: VideoEncoderConfig = {
      codec: name, width, height, framerate: rateHz, bitrate, latencyMode: "quality",
    };
    const support = await VideoEncoder.isConfigSupported(config).catch(() => null);
    if (support?.supported) return { codec, suffix, config };
  }
  throw new FilmError(`This browser encodes no film of ${width} x ${height} pixels, neither H.264 nor VP9 nor VP8; eigenwalker serve makes them.`);
}

type Packet = readonly [EncodedPacket, EncodedVideoChunkMetadata | undefined];

async function encodeFrames(spec: FilmSpec, config: VideoEncoderConfig): Promise<Packet[]> {
  const { width, height, frames, rateHz, progress, signal } = spec;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = contextOf(canvas, { alpha: false, willReadFrequently: true });
  const packets: Packet[] = [];
  let failure = null as Error | null;
  const encoder = new VideoEncoder({
    output: (chunk, meta) => packets.push([EncodedPacket.fromEncodedChunk(chunk), meta]),
    error: (error) => (failure = error),
  });
  try {
    encoder.configure(config);
    for (let number = 0; number < frames; number++) {
      signal?.throwIfAborted();
      spec.draw(context, number);
      const frame = new VideoFrame(canvas, {
        timestamp: Math.round((1e6 * number) / rateHz),
        duration: Math.round(1e6 / rateHz),
      });
      encoder.encode(frame, { keyFrame: number % Math.round(KEY_FRAME_S * rateHz) === 0 });
      frame.close();
      progress?.((number + 1) / frames);
      do await new Promise((done) => setTimeout(done)); // the page can react meanwhile
      while (encoder.encodeQueueSize > MAX_QUEUE);
    }
    await encoder.flush();
  } catch (error) {
    throw failure ? new FilmError(`The encoder of this browser failed: ${failure.message}`) : error;
  } finally {
    if (encoder.state !== "closed") encoder.close();
  }
  return packets;
}
