/** A session as the server gives it. */

export type StimulusFile = unknown;
export type Texts = Readonly<Record<string, string>>;

export interface Trial {
  readonly trial: number;
  readonly block: number;
  readonly task: "choice" | "rating" | "similar_pair" | "detection" | "same_different" | "odd_one_out" | "adjustment";
  readonly stimuli: readonly string[];
  readonly walkers: readonly number[];
  readonly practice: boolean;
  readonly spare?: boolean;
  /** Of a staircase and of a slider: the numbers of the levels, one a stimulus. */
  readonly levels?: readonly number[];
  /** The right answer, or all of them, where the page needs to know. */
  readonly correct?: string | number | readonly (string | number)[];
  /** The place at which a slider begins. */
  readonly begins?: number;
  /** Shares of a stride after which walkers begin. */
  readonly starts?: readonly number[];
  /** Whether a break is due after it, within its block. */
  readonly break_after?: boolean;
}

export interface Block {
  readonly task: Trial["task"];
  readonly break_after: boolean;
  /** Whether a text says after each answer whether it was right. */
  readonly feedback?: boolean;
  readonly choices?: readonly string[];
  readonly steps?: number;
  readonly scale?: string | null;
  readonly repeats?: number;
  readonly limit_s?: number;
  readonly pause_after?: number;
  readonly start?: number;
  readonly down?: number;
}

export interface Question {
  readonly name: string;
  readonly kind: "text" | "number" | "choice";
  readonly options: readonly string[];
  readonly when: "before" | "after";
}

export interface State {
  readonly name: "new" | "under_way" | "finished" | "not_due" | "closed";
  readonly session: number;
  readonly due_utc?: string;
  readonly outcome?: "finished" | "stopped";
}

/** What the last page shows. */
export interface End {
  readonly withdrawal_code?: string;
  readonly completion_code?: string;
  readonly return_url?: string;
}

export interface Welcome {
  readonly name: string;
  /** The version whose page shows the session. */
  readonly page?: string;
  readonly state: State;
  readonly languages: Readonly<Record<string, Texts>>;
  readonly consent: Readonly<Record<string, string>>;
  readonly test: boolean;
  readonly personal: boolean;
  readonly phones: boolean;
  readonly site_parameters: readonly string[];
  /** What the last page showed, where all sessions are over. */
  readonly end?: End;
}

/** What is known of an item that was reported before. */
export interface Reported {
  readonly kind: string;
  readonly trial: number | null;
  readonly attempt: number | null;
  readonly outcome: string | null;
  readonly response?: unknown;
  readonly when?: unknown;
}

export interface SessionContent {
  readonly session: number;
  /** Shows in a file of answers whose they are. */
  readonly proof: string;
  readonly number: number;
  readonly language: string;
  readonly trials: readonly Trial[];
  readonly blocks: readonly Block[];
  readonly group: { readonly name: string; readonly scale: string | null };
  readonly questions: readonly Question[];
  readonly picture: { readonly duration_s: number };
  readonly pace: {
    readonly blank_s: number;
    readonly feedback_s?: number;
    readonly count_remaining: boolean;
    readonly refresh_after_min: number;
  };
  readonly screen: {
    readonly measure: boolean;
    readonly full_screen: boolean;
    readonly viewing_distance_mm: number;
    readonly px_per_cm: number;
  };
  readonly answered: readonly (Reported & { readonly answer: string; readonly at: string })[];
}
