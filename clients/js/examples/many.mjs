// Plays Beamfall on eight machines at once: each ship flies to the nearest gap of the beam, and shoots. The server's address is in
// RACEBEAM_ADDRESS.

import { connect } from "racebeam";

const MACHINES = 8;
const STEPS = 600;

// Variables of Beamfall in RAM (games/homebrew/README.md).
const SHIP_X = 6;
const BEAM = 15; // three bytes for each half
const WIDE = 4; // cells of a gap that the ship fits into

/** Whether each cell of the beam burns, from left to right. PF0 has four cells, and PF1 its bits the other way round. */
function cells(ram) {
  return Array.from({ length: 40 }, (_, cell) => {
    const half = BEAM + 3 * Math.floor(cell / 20);
    const place = cell % 20;
    return place < 4 ? (ram[half] >> (4 + place)) & 1
      : place < 12 ? (ram[half + 1] >> (11 - place)) & 1
        : (ram[half + 2] >> (place - 12)) & 1;
  });
}

function action(ram) {
  const ship = (ram[SHIP_X] + 10) / 4;
  let nearest = 0;
  let gap = 0;
  [...cells(ram), 1].forEach((burns, cell) => {
    const distance = cell - gap / 2 - ship;
    if (burns && gap >= WIDE && (!nearest || Math.abs(distance) < Math.abs(nearest))) {
      nearest = distance;
    }
    gap = burns ? 0 : gap + 1;
  });
  return Math.abs(nearest) < 0.6 ? "FIRE" : nearest > 0 ? "RIGHTFIRE" : "LEFTFIRE";
}

const game = await connect();
await game.load("beamfall", { seed: 1, frame_skip: 4 });
await game.observe("reward", "terminated", "truncated", "ram");
let shown = await game.open(MACHINES, { autoreset: "same-step" });
const scores = new Array(MACHINES).fill(0);
for (let step = 0; step < STEPS; ++step) {
  shown = await game.step(...shown.map(({ ram }) => action(ram)));
  shown.forEach(({ reward }, machine) => (scores[machine] += reward));
}
console.log(`scores ${scores.join(" ")}`);
await game.disconnect();
