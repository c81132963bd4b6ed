/** KEY=VALUE of each setting that has a value. true is 1, and false is 0. */
function pairs(settings) {
  return Object.entries(settings).filter(([, value]) => value !== undefined).map(([key, value]) => `${key}=${word(value)}`).join(" ");
}

function word(value) {
  return typeof value === "boolean" ? String(Number(value)) : String(value);
}

/** A request of words, lists of words, and objects that stand for settings. */
export function words(...parts) {
  return parts.flat().map((part) => (typeof part === "object" ? pairs(part) : word(part))).filter(Boolean).join(" ");
}

/** The setting of a method that takes one: its value, or an object that has it. */
export function keyed(key, value) {
  return typeof value === "object" ? value : { [key]: value };
}

/** The elements of a value that are separated by commas. */
export function list(value) {
  return value === "" ? [] : String(value).split(",");
}
