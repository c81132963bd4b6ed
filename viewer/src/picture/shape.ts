const WIDTH = 160;

/** How much wider than high a pixel is on a television of each format. */
const PIXEL_ASPECT: Readonly<Record<string, number>> = { ntsc: 12 / 7, pal60: 12 / 7, pal: 25 / 12, secam: 25 / 12 };

/** Frames a second. */
export function frameRate(format: string): number {
  return format === "pal" || format === "secam" ? 50 : 60;
}

/** Samples of sound a second: 512 in each frame. */
export function soundRate(format: string): number {
  return 512 * frameRate(format);
}

/** The width of the picture divided by its height, as a television shows it. */
export function pictureAspect(format: string, height: number): number {
  return (WIDTH * (PIXEL_ASPECT[format] ?? 12 / 7)) / height;
}
