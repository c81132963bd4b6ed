/** The number of bytes that follow a reply's line: N of `raw=N` at its end, or 0; NaN if N is not such a number. */
export function rawSize(line) {
  const last = line.lastIndexOf(" ") + 1;
  if (!line.startsWith("raw=", last)) {
    return 0;
  }
  const digits = line.slice(last + 4);
  return /^[0-9]+$/.test(digits) ? Number(digits) : NaN;
}
