// A search in memory: which bytes did what the user saw on the screen?

export type Comparison = "equal" | "changed" | "unchanged" | "increased" | "decreased";

const COMPARISONS: Readonly<Record<Comparison, (now: number, before: number, value: number) => boolean>> = {
  equal: (now, _, value) => now === value,
  changed: (now, before) => now !== before,
  unchanged: (now, before) => now === before,
  increased: (now, before) => now > before,
  decreased: (now, before) => now < before,
};

/** The bytes that fit all that the user has said so far. An index counts from 0, which is address $80. */
export class MemorySearch {
  #steps: { candidates: number[]; ram: Uint8Array }[] = [];

  /** Begins with all bytes. */
  begin(ram: Uint8Array): void {
    this.#steps = [{ candidates: Array.from(ram.keys()), ram: ram.slice() }];
  }

  get candidates(): readonly number[] {
    return this.#steps.at(-1)?.candidates ?? [];
  }

  /** How often the user has narrowed the search. */
  get depth(): number {
    return Math.max(0, this.#steps.length - 1);
  }

  /** Keeps the bytes that compare so with what they were when the search was narrowed last, or with a value. */
  narrow(comparison: Comparison, ram: Uint8Array, value = 0): void {
    const last = this.#steps.at(-1);
    if (!last) {
      this.begin(ram);
      return this.narrow(comparison, ram, value);
    }
    const fits = COMPARISONS[comparison];
    const candidates = last.candidates.filter((index) => fits(ram[index] ?? 0, last.ram[index] ?? 0, value));
    this.#steps.push({ candidates, ram: ram.slice() });
  }

  /** Takes the last narrowing back. */
  undo(): void {
    if (this.#steps.length > 1) {
      this.#steps.pop();
    }
  }
}

/** A byte in decimal, or in hexadecimal after $ or 0x; undefined for other texts. */
export function byteOf(text: string): number | undefined {
  const [, hex, decimal] = /^\s*(?:(?:\$|0x)([0-9a-f]{1,2})|(\d{1,3}))\s*$/i.exec(text) ?? [];
  const value = hex ? parseInt(hex, 16) : decimal ? Number(decimal) : NaN;
  return value <= 255 ? value : undefined;
}

/** The address of a byte of RAM, as games name it: $80 to $FF. */
export function addressOf(index: number): string {
  return `$${(index + 0x80).toString(16).toUpperCase()}`;
}
