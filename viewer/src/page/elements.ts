// Elements of the page.

/** The element with an id. Throws if the page lacks it, or its class is another. */
export function byId<T extends HTMLElement>(id: string, kind: new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) {
    throw new Error(`the page has no ${kind.name} '${id}'`);
  }
  return element;
}

/** A new element with properties, a class in `className`, and children. */
export function make<K extends keyof HTMLElementTagNameMap>(tag: K, properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** A copy of a template's element. */
export function copyOf(id: string): HTMLElement {
  const copy = byId(id, HTMLTemplateElement).content.firstElementChild?.cloneNode(true);
  if (!(copy instanceof HTMLElement)) {
    throw new Error(`the template '${id}' is empty`);
  }
  return copy;
}

/** The part of an element that is named so by data-part. */
export function part<T extends HTMLElement>(element: HTMLElement, name: string, kind: new () => T): T {
  const found = element.querySelector(`[data-part="${name}"]`);
  if (!(found instanceof kind)) {
    throw new Error(`the element has no ${kind.name} '${name}'`);
  }
  return found;
}

/** Sets an element's text, if it is another. */
export function tell(element: HTMLElement, text: string): void {
  if (element.textContent !== text) {
    element.textContent = text;
  }
}

/** Marks the one of several elements that is shown. */
export function markCurrent(element: HTMLElement, current: boolean, what = "true"): void {
  current ? element.setAttribute("aria-current", what) : element.removeAttribute("aria-current");
}

/** Fills a list of choices: values and their texts. */
export function offer(select: HTMLSelectElement, choices: readonly (readonly [string, string])[], chosen?: string): void {
  select.replaceChildren(...choices.map(([value, text]) => make("option", { value, textContent: text, selected: value === chosen })));
}
