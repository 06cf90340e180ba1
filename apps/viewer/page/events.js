/** Events with handlers: the viewer's own, and listeners of the page. */
export class Events {
  constructor() {
    /** @type {Map<string, Set<(...values: any[]) => void>>} */
    this.handlers = new Map();
  }
  /** @param {string} event @param {(...values: any[]) => void} handler */
  on(event, handler) {
    const handlers = this.handlers.get(event) ?? new Set();
    this.handlers.set(event, handlers.add(handler));
  }
  /** @param {string} event @param {(...values: any[]) => void} handler */
  off(event, handler) {
    this.handlers.get(event)?.delete(handler);
  }
  /** @param {string} event @param {...any} values */
  emit(event, ...values) {
    for (const handler of [...(this.handlers.get(event) ?? [])]) handler(...values);
  }
}

/**
 * Returns a function that adds listeners, and one that ends all of them.
 * @returns {{listen: (target: EventTarget, type: string, handler: (event: any) => void,
 *   options?: AddEventListenerOptions) => void, end: () => void}}
 */
export function listeners() {
  const control = new AbortController();
  return {
    listen: (target, type, handler, options) =>
      target.addEventListener(type, handler, { ...options, signal: control.signal }),
    end: () => control.abort(),
  };
}
