/** Films made in the browser: H.264 in MP4, or what else this browser can encode. */

import { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Mp4OutputFormat, Output, WebMOutputFormat } from "mediabunny";

/** This browser makes no films; the message says what does. */
export class NoFilm extends Error {}

export interface FilmWish {
  /** Of the picture in pixels; both even. */
  readonly width: number;
  readonly height: number;
  readonly frames: number;
  readonly rateHz: number;
  /** Draw a frame of the film, by its number. */
  readonly draw: (context: CanvasRenderingContext2D, frame: number) => void;
  /** Told after each frame, the share that is done. */
  readonly progress?: ((share: number) => void) | undefined;
  readonly signal?: AbortSignal | undefined;
}

export interface Film {
  readonly blob: Blob;
  readonly suffix: "mp4" | "webm";
}

type Codec = "avc" | "vp9" | "vp8";
interface Choice {
  readonly codec: Codec;
  /** As WebCodecs calls it: H.264 high and baseline, VP9 and VP8. */
  readonly string: string;
  readonly suffix: Film["suffix"];
}

/** The best first. */
const CHOICES: readonly Choice[] = [
  { codec: "avc", string: "avc1.640033", suffix: "mp4" },
  { codec: "avc", string: "avc1.42003e", suffix: "mp4" },
  { codec: "vp9", string: "vp09.00.51.08", suffix: "webm" },
  { codec: "vp8", string: "vp8", suffix: "webm" },
];
/** Bits a pixel and frame: dots with sharp edges are to stay sharp. */
const BITS_A_PIXEL = 0.2;
const KEY_FRAME_S = 1;
/** Frames that may wait for the encoder. */
const MOST_WAITING = 8;

/** Make a film, frame by frame. */
export async function encodeFilm(wish: FilmWish): Promise<Film> {
  const { choice, config } = await choose(wish);
  const output = new Output({
    format: choice.suffix === "mp4" ? new Mp4OutputFormat({ fastStart: "in-memory" }) : new WebMOutputFormat(),
    target: new BufferTarget(),
  });
  const source = new EncodedVideoPacketSource(choice.codec);
  output.addVideoTrack(source, { frameRate: wish.rateHz });
  await output.start();
  await encodeFrames(wish, config, source);
  await output.finalize();
  const { buffer } = output.target;
  if (!buffer) throw new NoFilm("The film came out empty.");
  return { blob: new Blob([buffer], { type: `video/${choice.suffix}` }), suffix: choice.suffix };
}

/** What this browser encodes of what was wished for. */
async function choose({ width, height, rateHz }: FilmWish): Promise<{ choice: Choice; config: VideoEncoderConfig }> {
  if (typeof VideoEncoder === "undefined") {
    throw new NoFilm("This browser encodes no films; eigenwalker serve makes them, and so does eigenwalker stimulus of a saved stimulus file.");
  }
  for (const choice of CHOICES) {
    const config: VideoEncoderConfig = {
      codec: choice.string,
      width,
      height,
      framerate: rateHz,
      bitrate: Math.round(width * height * rateHz * BITS_A_PIXEL),
      latencyMode: "quality",
    };
    const support = await VideoEncoder.isConfigSupported(config).catch(() => null);
    if (support?.supported) return { choice, config };
  }
  throw new NoFilm(`This browser encodes no film of ${width} x ${height} pixels, neither H.264 nor VP9 nor VP8; eigenwalker serve makes them.`);
}

async function encodeFrames(wish: FilmWish, config: VideoEncoderConfig, source: EncodedVideoPacketSource): Promise<void> {
  const { width, height, frames, rateHz, progress, signal } = wish;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
  if (!context) throw new NoFilm("This browser gives no canvas to draw on.");
  let fail = (_: Error): void => {};
  const failed = new Promise<never>((_, refuse) => (fail = refuse));
  failed.catch(() => {}); // heard below, or too late to matter
  let written: Promise<unknown> = Promise.resolve();
  const encoder = new VideoEncoder({
    output: (chunk, meta) => {
      written = written.then(() => source.add(EncodedPacket.fromEncodedChunk(chunk), meta));
    },
    error: (error) => fail(new NoFilm(`The encoder of this browser failed: ${error.message}`)),
  });
  try {
    encoder.configure(config);
    for (let number = 0; number < frames; number++) {
      signal?.throwIfAborted();
      wish.draw(context, number);
      const frame = new VideoFrame(canvas, {
        timestamp: Math.round((1e6 * number) / rateHz),
        duration: Math.round(1e6 / rateHz),
      });
      encoder.encode(frame, { keyFrame: number % Math.round(KEY_FRAME_S * rateHz) === 0 });
      frame.close();
      progress?.((number + 1) / frames);
      await Promise.race([roomIn(encoder), failed]);
    }
    await Promise.race([encoder.flush(), failed]);
    await written;
  } finally {
    if (encoder.state !== "closed") encoder.close();
  }
}

/** Waits until the encoder takes frames again, and lets the page breathe meanwhile. */
async function roomIn(encoder: VideoEncoder): Promise<void> {
  await new Promise((go) => setTimeout(go));
  while (encoder.encodeQueueSize > MOST_WAITING) {
    await new Promise<void>((go) => encoder.addEventListener("dequeue", () => go(), { once: true }));
  }
}
