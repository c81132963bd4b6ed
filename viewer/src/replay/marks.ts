import { pageColour, sharp } from "../inspect/plot.js";

/** Draws where the rewards of some episodes are, an episode a row. */
export function drawMarks(canvas: HTMLCanvasElement, episodes: readonly (readonly { frame: number; reward: number }[])[], frames: number): void {
  const context = sharp(canvas);
  if (!context) {
    return;
  }
  const { width, height } = canvas;
  const row = height / Math.max(1, episodes.length);
  context.clearRect(0, 0, width, height);
  episodes.forEach((rewards, number) => {
    const highest = rewards.reduce((most, { reward }) => Math.max(most, Math.abs(reward)), 1);
    for (const { frame, reward } of rewards) {
      const size = (0.3 + (0.7 * Math.abs(reward)) / highest) * (row - 2 * devicePixelRatio);
      context.fillStyle = pageColour(reward > 0 ? "--accent" : "--bad");
      context.fillRect((frame / frames) * (width - 2 * devicePixelRatio), (number + 1) * row - size, 2 * devicePixelRatio, size);
    }
  });
}
