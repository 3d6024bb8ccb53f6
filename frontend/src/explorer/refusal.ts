/** Why a file was not taken; the message is a sentence to show. */
export class CannotOpen extends Error {}
