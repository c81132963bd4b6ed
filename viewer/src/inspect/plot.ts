/** The colours of the page, as its stylesheet has them at this moment. */
export function pageColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name);
}

/** The canvas's context, with as many pixels as the display has for it. */
export function sharp(canvas: HTMLCanvasElement): CanvasRenderingContext2D | undefined {
  const width = Math.round(canvas.clientWidth * devicePixelRatio);
  const height = Math.round(canvas.clientHeight * devicePixelRatio);
  if (!width || !height) {
    return undefined;
  }
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  return canvas.getContext("2d") ?? undefined;
}

/** Draws a line through values, from the left to the right edge. The range has at least these two numbers in it. */
export function plot(canvas: HTMLCanvasElement, values: readonly number[], atLeast: readonly [number, number]): void {
  const context = sharp(canvas);
  if (!context) {
    return;
  }
  const { width, height } = canvas;
  const lowest = values.reduce((a, b) => Math.min(a, b), atLeast[0]);
  const highest = values.reduce((a, b) => Math.max(a, b), atLeast[1]);
  const border = 4 * devicePixelRatio;
  context.clearRect(0, 0, width, height);
  context.strokeStyle = pageColour("--accent");
  context.lineWidth = 1.5 * devicePixelRatio;
  context.lineJoin = "round";
  context.beginPath();
  values.forEach((value, at) => {
    const x = (at / Math.max(1, values.length - 1)) * width;
    const y = height - border - ((value - lowest) / (highest - lowest)) * (height - 2 * border);
    context.lineTo(x, y);
  });
  context.stroke();
}
