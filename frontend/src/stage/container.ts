/** What an encoder made of frames, to be put into a film file. */

export interface Packet {
  readonly bytes: Uint8Array;
  /** Whether the film can be entered here. */
  readonly isKey: boolean;
  /** Of its frame; encoders may hand frames over in another order than they are shown in. */
  readonly frame: number;
}

export interface Track {
  readonly width: number;
  readonly height: number;
  readonly rateHz: number;
  /** In the order in which they are decoded. */
  readonly packets: readonly Packet[];
}
