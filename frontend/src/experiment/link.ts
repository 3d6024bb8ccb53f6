/** The link by which the observer came: taken out of the address bar, where a reload of this tab still finds it. */

import type { Site } from "./server";

export interface Link {
  readonly key: string;
  /** Parameters that a recruiting site added. */
  readonly site: Site;
  /** The observer's own key, where the link is for many. */
  readonly own?: string;
}

const isLink = (value: unknown): value is Link =>
  typeof value === "object" && value !== null && "key" in value && typeof value.key === "string";

/** The version of the experiment whose page this is, and whether the tab was loaded anew. */
export const pageVersion = document.querySelector<HTMLMetaElement>('meta[name="version"]')?.content ?? null;
export const isReloaded = !location.pathname.startsWith("/s/");

export function linkOf(): Link | null {
  const key = /^\/s\/([A-Za-z0-9_-]+)$/.exec(location.pathname)?.[1];
  if (!key) return isLink(history.state) ? history.state : null;
  const link: Link = { key, site: Object.fromEntries([...new URLSearchParams(location.search)].slice(0, 10)) };
  history.replaceState(link, "", pageVersion ? `/v/${pageVersion}` : "/");
  return link;
}

/** The own key that this tab remembers, where the browser stores nothing. */
export const ownKeyOf = ({ key }: Link): string | null =>
  isLink(history.state) && history.state.key === key ? (history.state.own ?? null) : null;

export const rememberOwnKey = (link: Link, own: string): void => history.replaceState({ ...link, own }, "");
