/** Items on this machine's disk until the server has confirmed them. */

import type { Item } from "./answers";

const NAME = "eigenwalker-experiment";
const ITEMS = "items";
const KEYS = "keys";

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

export class Outbox {
  private readonly memory = new Map<string, Kept>();
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
        request.result.createObjectStore(KEYS);
      };
      const database = await done(request);
      const outbox = new Outbox(database);
      database.onclose = () => void (outbox.database = null);
      database.onversionchange = () => database.close();
      await outbox.setKey("?", "?"); // a full disk or forbidden storage shows at the first write
      const left = (await done(database.transaction(ITEMS).objectStore(ITEMS).getAll())) as Kept[];
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
    this.memory.set(item.answer, kept);
    await this.write(ITEMS, (store) => store.put(kept));
  }

  /** All items of a session, as they were made, those of earlier visits too. */
  async items(session: number): Promise<readonly Kept[]> {
    const all = new Map(this.memory);
    try {
      if (this.database) {
        const store = this.database.transaction(ITEMS).objectStore(ITEMS);
        for (const kept of (await done(store.getAll())) as Kept[]) all.set(kept.item.answer, kept);
      }
    } catch {
      this.database = null;
    }
    return [...all.values()].filter((kept) => kept.session === session).sort((a, b) => a.order - b.order);
  }

  async remove(names: readonly string[]): Promise<void> {
    for (const name of names) this.memory.delete(name);
    await this.write(ITEMS, (store) => names.forEach((name) => store.delete(name)));
  }

  /** Keep an item that the server refused, and send it no more. */
  async setAside(kept: Kept, reason: string): Promise<void> {
    const refused = { ...kept, refused: reason };
    this.memory.set(kept.item.answer, refused);
    await this.write(ITEMS, (store) => store.put(refused));
  }

  async key(link: string): Promise<string | null> {
    try {
      return this.database ? ((await done(this.database.transaction(KEYS).objectStore(KEYS).get(link))) ?? null) : null;
    } catch {
      return null;
    }
  }

  setKey(link: string, key: string): Promise<void> {
    return this.write(KEYS, (store) => store.put(key, link));
  }

  /** Leave nothing on this machine. */
  async clear(): Promise<void> {
    this.memory.clear();
    this.database?.close();
    this.database = null;
    await done(indexedDB.deleteDatabase(NAME)).catch(() => undefined);
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
      await written;
    } catch {
      this.database = null; // the disk is full, or storage was taken away: from now on in memory
    }
  }
}
