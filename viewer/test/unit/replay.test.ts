import assert from "node:assert/strict";
import test from "node:test";
import { deflateSync } from "node:zlib";
import { linkTo, readLink } from "../../src/replay/link.js";
import { crc32, readLog, type Episode } from "../../src/replay/log.js";

const TEXT = `load beamfall seed=7 frame_skip=5 sticky=0
image 8b96297bc95db74738674ce177f501c1
from unit=beamfall-random-0 agent=random trial=0 episode=2 agent_seed=1 version=0.1.0
ended score=40 frames=15 decisions=3 end=terminated lives=0

`;

function contents(text = TEXT, hashes = 1, actions = [1, 0, 17]): Uint8Array {
  return Uint8Array.from([...new TextEncoder().encode(text), ...Array.from({ length: 8 * hashes }, (_, at) => 10 + at % 8), ...actions]);
}

/** A log as docs/episodes.md describes it. `change` alters the header before the checksum is made. */
function sealed(inside: Uint8Array, change: (header: DataView) => void = () => {}): Uint8Array {
  const packed = deflateSync(inside);
  const file = new Uint8Array(24 + packed.length);
  file.set(new TextEncoder().encode("RBEPISOD"));
  file.set(packed, 24);
  const header = new DataView(file.buffer, 0, 24);
  header.setUint32(8, 1, true);
  header.setBigUint64(12, BigInt(inside.length), true);
  change(header);
  header.setUint32(20, crc32(file.subarray(0, 20), packed), true);
  return file;
}

test("the checksum is CRC-32", () => {
  assert.equal(crc32(new TextEncoder().encode("1234"), new TextEncoder().encode("56789")), 0xcbf43926);
});

test("a log is read", async () => {
  assert.deepEqual(await readLog(sealed(contents()), "2.episode"), {
    title: "beamfall-random-0, episode 2",
    game: "beamfall",
    settings: { seed: "7", frame_skip: "5", sticky: "0" },
    acts: ["1", "0", "17"],
    ended: { score: 40, frames: 15, decisions: 3, end: "terminated", lives: 0 },
    hashes: ["11100f0e0d0c0b0a"],
    md5: "8b96297bc95db74738674ce177f501c1",
  });
});

test("a server is not asked for what is usual in old words", async () => {
  const { settings } = await readLog(sealed(contents(TEXT.replace("sticky=0", "life_loss_ends=0 autoreset=0"))), "");
  assert.deepEqual(settings, { seed: "7", frame_skip: "5" });
  const { settings: unusual } = await readLog(sealed(contents(TEXT.replace("sticky=0", "life_loss_ends=1"))), "");
  assert.equal(unusual.life_loss_ends, "1");
});

test("the number of hashes follows from that of decisions", async () => {
  const actions = new Array<number>(600).fill(3);
  const { acts } = await readLog(sealed(contents(TEXT.replace("decisions=3", "decisions=600"), 3, actions)), "");
  assert.deepEqual(acts, actions.map(String));
});

test("a log has actions of switches and other controllers only with action_set=console", async () => {
  const text = TEXT.replace("sticky=0", "sticky=0 action_set=console");
  assert.deepEqual((await readLog(sealed(contents(text, 1, [18, 37, 177])), "")).acts, ["18", "37", "177"]);
  await assert.rejects(readLog(sealed(contents(text, 1, [18, 19, 178])), ""), /from 0 to 177$/);
  await assert.rejects(readLog(sealed(contents(TEXT, 1, [1, 0, 18])), ""), /from 0 to 17$/);
});

test("a log with strengths has them in its acts", async () => {
  const strengths = new Uint8Array(Float32Array.of(1, 0.25, -2).buffer);
  const { acts, hashes } = await readLog(sealed(contents(TEXT, 1, [1, 0, 17, ...strengths])), "");
  assert.deepEqual(acts, ["1", "0@0.25", "17@-2"]);
  assert.equal(hashes?.length, 1);
  await assert.rejects(readLog(sealed(contents(TEXT, 1, [1, 0, 17, 9])), ""), /1 bytes of strengths; accepted: 0, or 4/);
});

test("every log that was cut or altered is refused", async () => {
  const whole = sealed(contents());
  for (let size = 0; size < whole.length; ++size) {
    await assert.rejects(readLog(whole.slice(0, size), ""), Error);
  }
  for (let at = 0; at < whole.length; ++at) {
    const altered = whole.slice();
    altered[at]! ^= 0x40;
    await assert.rejects(readLog(altered, ""), Error, `byte ${at}`);
  }
});

const wrong: Record<string, Uint8Array> = {
  "another version": sealed(contents(), (header) => header.setUint32(8, 2, true)),
  "another size": sealed(contents(), (header) => header.setBigUint64(12, 5n, true)),
  "too few actions": sealed(contents(TEXT, 1, [1])),
  "no such action": sealed(contents(TEXT, 1, [1, 2, 18])),
  "no text": sealed(new Uint8Array(40)),
  "another text": sealed(contents("load\n\n")),
  "a bomb": sealed(new Uint8Array(3 * 1024 * 1024)),
};
for (const [name, file] of Object.entries(wrong)) {
  test(`a log with ${name} is refused in a sentence`, async () => {
    await assert.rejects(readLog(file, ""), /^Error: the /);
  });
}

const EPISODE: Episode = { title: "beamfall, played here", game: "beamfall", settings: { seed: "7" }, acts: ["1", "1", "0/3", "0", "0"] };

test("a link leads to a frame of an episode", async () => {
  const link = await linkTo(EPISODE, 321);
  assert.match(link, /^replay=[\w-]+&frame=321$/);
  assert.deepEqual(await readLink(`#${link}`), { episode: EPISODE, frame: 321 });
  assert.equal(await readLink("#replay"), undefined);
  assert.equal(await readLink("#play"), undefined);
});

test("a link has the strengths of paddles", async () => {
  const acts = ["1@0.25", "1@0.25", "0@-2", "17", "3@1e-7", "3@340282346638528860000", "3@3.4028234663852886e+38", "129"];
  const { episode } = (await readLink(`#${await linkTo({ ...EPISODE, acts }, 0)}`))!;
  assert.deepEqual(episode.acts, acts);
});

test("a link of a few kilobytes does not fill the memory", async () => {
  const bomb = deflateSync(new Uint8Array(33 * 1024 * 1024), { level: 9 }).toString("base64url");
  await assert.rejects(readLink(`#replay=${bomb}`), ({ cause }: Error) => /more than 33554432 bytes/.test(String(cause)));
});

test("a damaged link is refused", async () => {
  const link = await linkTo(EPISODE, 0);
  await assert.rejects(readLink(`#${link.slice(0, 30)}&frame=0`), /damaged/);
  for (const acts of [["1*9999999"], ["quit"], ["1\nquit"], "1 2", [null], ["1*0999999", "1*0999999"], ["1@"], ["1@nan"], ["1@2@3"]]) {
    await assert.rejects(readLink(`#${await linkTo({ ...EPISODE, acts: acts as string[] }, 0)}`), /damaged/, String(acts));
  }
});
