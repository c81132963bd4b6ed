// Links to a frame of an episode: the episode is in the part of the address after #, which no browser sends to a server.

import { joinRuns } from "../input/actions.js";
import { inflate, type Episode } from "./log.js";

const LONGEST = 4 * 1024 * 1024; // characters of a link
const MOST_TEXT = 32 * 1024 * 1024; // bytes, before they are deflated
const MOST_ACTS = 1_000_000;
// A number, which may have the strength of a paddle, then the number of the other player, and how often they are played.
const ACT = /^(\d{1,3}(?:@-?\d{1,21}(?:\.\d{1,20})?(?:e[+-]?\d{1,3})?)?(?:\/\d{1,2})?)(?:\*(\d{1,7}))?$/;

async function deflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function toText(bytes: Uint8Array): string {
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function fromText(text: string): Uint8Array {
  return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (character) => character.charCodeAt(0));
}

/** The part of a link after #. */
export async function linkTo({ title, game, settings, acts }: Episode, frame: number): Promise<string> {
  const text = JSON.stringify({ title, game, settings, acts: joinRuns(acts) });
  return `replay=${toText(await deflate(new TextEncoder().encode(text)))}&frame=${frame}`;
}

/** Words without counts, from those that `joinRuns` made. */
function expandRuns(words: unknown): string[] {
  const acts: string[] = [];
  for (const word of Array.isArray(words) ? words : [words]) {
    const [, act, times = "1"] = ACT.exec(String(word)) ?? [];
    if (!act || acts.length + Number(times) > MOST_ACTS) {
      throw new Error(`'${word}' is not an act, or one too many`);
    }
    for (let time = 0; time < Number(times); ++time) {
      acts.push(act);
    }
  }
  return acts;
}

/** The episode and the frame of a link; undefined if the text is not such a link. Throws if it is damaged. */
export async function readLink(hash: string): Promise<{ episode: Episode; frame: number } | undefined> {
  const found = /^#?replay=([\w-]+)(?:&frame=(\d{1,9}))?$/.exec(hash);
  if (!found?.[1] || hash.length > LONGEST) {
    return undefined;
  }
  try {
    const { title, game, settings, acts } = JSON.parse(new TextDecoder().decode(await inflate(fromText(found[1]), MOST_TEXT)));
    return { episode: { title: String(title), game: String(game), settings, acts: expandRuns(acts) }, frame: Number(found[2] ?? 0) };
  } catch (error) {
    throw new Error("the link is damaged: its episode cannot be read", { cause: error });
  }
}
