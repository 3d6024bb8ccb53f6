/** Items on this machine's disk until the server has confirmed them. */

import type { Item } from "./answers";

const NAME = "eigenwalker-experiment";
const ITEMS = "items";
const NOTES = "keys";
/** Storage that does not answer for so long is taken for none. */
const LONGEST_WAIT_MS = 8000;

export interface Kept {
  readonly item: Item;
  /** Of the link. */
  readonly key: string;
  readonly session: number;
  /** In the order in which they were made. */
  readonly order: number;
  /** Why the server refused it for good. */
  readonly refused: string | null;
}

const done = <Result>(request: IDBRequest<Result>): Promise<Result> =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

const inTime = <Result>(promise: Promise<Result>): Promise<Result> =>
  new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new Error("Storage does not answer.")), LONGEST_WAIT_MS);
    promise.then(resolve, reject).finally(() => clearTimeout(late));
  });

/**
 * The outbox of all observers of this machine. The page holds what is in it, so that sending reads no disk;
 * every change is written through.
 */
export class Outbox {
  private readonly kept = new Map<string, Kept>();
  private order = 0;

  private constructor(private database: IDBDatabase | null) {}

  /** Whether what is put here outlasts the page. */
  get durable(): boolean {
    return this.database !== null;
  }

  static async open(): Promise<Outbox> {
    try {
      const request = indexedDB.open(NAME, 1);
      request.onupgradeneeded = () => {
        request.result.createObjectStore(ITEMS, { keyPath: "item.answer" });
        request.result.createObjectStore(NOTES);
      };
      const database = await inTime(done(request));
      const outbox = new Outbox(database);
      database.onclose = () => void (outbox.database = null);
      database.onversionchange = () => {
        outbox.database = null;
        database.close();
      };
      const left = await inTime(done(database.transaction(ITEMS).objectStore(ITEMS).getAll() as IDBRequest<Kept[]>));
      for (const kept of left) outbox.kept.set(kept.item.answer, kept);
      outbox.order = Math.max(0, ...left.map((kept) => kept.order)); // whatever the clock says
      return outbox;
    } catch {
      return new Outbox(null);
    }
  }

  /** Put an item; once the promise is kept the item is on disk, or `durable` is false. */
  async put(item: Item, key: string, session: number): Promise<void> {
    this.order += 1;
    const kept: Kept = { item, key, session, order: this.order, refused: null };
    this.kept.set(item.answer, kept);
    await this.write(ITEMS, (store) => store.put(kept));
  }

  /** All items of an observer's session, as they were made, those of earlier visits too. */
  items(key: string, session: number): readonly Kept[] {
    const own = [...this.kept.values()].filter((kept) => kept.key === key && kept.session === session);
    return own.sort((a, b) => a.order - b.order);
  }

  /** Items that wait here for other sessions, one list a session. */
  others(key: string, session: number): readonly (readonly Kept[])[] {
    const found = new Map<string, Kept[]>();
    for (const kept of this.kept.values()) {
      if (kept.refused !== null || (kept.key === key && kept.session === session)) continue;
      const name = `${kept.key} ${kept.session}`;
      found.set(name, [...(found.get(name) ?? []), kept]);
    }
    return [...found.values()];
  }

  async remove(names: readonly string[]): Promise<void> {
    for (const name of names) this.kept.delete(name);
    await this.write(ITEMS, (store) => names.forEach((name) => store.delete(name)));
  }

  /** Keep an item that the server refused, and send it no more. */
  async setAside(kept: Kept, reason: string): Promise<void> {
    const refused = { ...kept, refused: reason };
    this.kept.set(kept.item.answer, refused);
    await this.write(ITEMS, (store) => store.put(refused));
  }

  /** What was noted of a link under a name; null where nothing was. */
  async note(link: string, name: string): Promise<string | null> {
    try {
      const store = this.database?.transaction(NOTES).objectStore(NOTES);
      return store ? ((await inTime(done(store.get(`${link} ${name}`) as IDBRequest<string | undefined>))) ?? null) : null;
    } catch {
      this.database = null;
      return null;
    }
  }

  setNote(link: string, name: string, value: string): Promise<void> {
    return this.write(NOTES, (store) => store.put(value, `${link} ${name}`));
  }

  /** Leave nothing of an observer on this machine; what others left stays until it is sent. */
  async clear(link: string, key: string): Promise<void> {
    await this.remove([...this.kept.values()].filter((kept) => kept.key === key).map((kept) => kept.item.answer));
    await this.write(NOTES, (store) => store.delete(IDBKeyRange.bound(`${link} `, `${link} \uffff`)));
    const { database } = this;
    if (!database || this.kept.size > 0) return;
    const others = await inTime(done(database.transaction(NOTES).objectStore(NOTES).count())).catch(() => 1);
    if (others > 0) return;
    this.database = null;
    database.close();
    await inTime(done(indexedDB.deleteDatabase(NAME))).catch(() => undefined);
  }

  private async write(name: string, change: (store: IDBObjectStore) => unknown): Promise<void> {
    if (!this.database) return;
    try {
      const transaction = this.database.transaction(name, "readwrite", { durability: "strict" });
      const written = new Promise<void>((resolve, reject) => {
        transaction.oncomplete = () => resolve();
        transaction.onabort = transaction.onerror = () => reject(transaction.error);
      });
      change(transaction.objectStore(name));
      await inTime(written);
    } catch {
      this.database = null; // the disk is full, or storage was taken away: from now on in memory
    }
  }
}
