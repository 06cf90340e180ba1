/** Keys that move the camera while they are held. Places on the keyboard, so that any layout works. */

/** @type {{[code: string]: ['move' | 'turn' | 'zoom', number, number]}} */
const KEYS = {
  KeyD: ['move', 0, 1], KeyA: ['move', 0, -1],
  KeyE: ['move', 1, 1], KeyQ: ['move', 1, -1], PageUp: ['move', 1, 1], PageDown: ['move', 1, -1],
  KeyW: ['move', 2, 1], KeyS: ['move', 2, -1],
  ArrowRight: ['turn', 0, 1], ArrowLeft: ['turn', 0, -1], ArrowUp: ['turn', 1, 1], ArrowDown: ['turn', 1, -1],
  Equal: ['zoom', 0, 1], NumpadAdd: ['zoom', 0, 1], Minus: ['zoom', 0, -1], NumpadSubtract: ['zoom', 0, -1],
};

/**
 * Returns whether a key belongs to a control of the page and not to the camera.
 * @param {KeyboardEvent} event
 */
export function isTyping(event) {
  const target = /** @type {HTMLElement} */ (event.composedPath()[0] ?? event.target);
  if (!(target instanceof Element)) return false;
  if (target.closest('textarea, select, [contenteditable], dialog')) return true;
  const input = target.closest('input');
  if (input) return !['range', 'checkbox', 'radio', 'button', 'color'].includes(input.type) || event.key.length > 1;
  // Buttons, tabs and handles use arrows, Space and Enter.
  return event.key.length > 1 || event.key === ' ' ? target.closest('button, [role=slider], [role=tab], summary') !== null : false;
}

/**
 * Returns the key that moves the camera, by its place on the keyboard, plus and minus also by what is
 * printed on them; an empty text for other keys.
 * @param {KeyboardEvent} event
 */
export function movingKey(event) {
  if (event.code in KEYS || event.code === 'Space') return event.code;
  return event.key === '+' ? 'Equal' : event.key === '-' ? 'Minus' : '';
}

export class Keys {
  /** @param {EventTarget} target @param {() => void} wake
   *  @param {ReturnType<typeof import('../events.js').listeners>['listen']} listen */
  constructor(target, wake, listen) {
    /** Keys that are down: what they mean, by their place. @type {Map<string, string>} */
    this.held = new Map();
    this.shift = false;
    listen(target, 'keydown', (/** @type {KeyboardEvent} */ event) => {
      this.shift = event.shiftKey;
      if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event)) return;
      const key = movingKey(event);
      if (!key) return;
      event.preventDefault();  // arrows and Space do not scroll an embedding page
      this.held.set(event.code, key);
      wake();
    });
    listen(target, 'keyup', (/** @type {KeyboardEvent} */ event) => {
      this.shift = event.shiftKey;
      this.held.delete(event.code);
    });
    listen(window, 'blur', () => this.held.clear());
  }

  /** @returns {import('./navigator.js').Input} */
  get input() {
    /** @type {{move: import('../math.js').Vec3, turn: [number, number], zoom: [number]}} */
    const sums = { move: [0, 0, 0], turn: [0, 0], zoom: [0] };
    for (const held of this.held.values()) {
      const key = KEYS[held];
      if (key) sums[key[0]][key[1]] += key[2];
    }
    return { move: sums.move, turn: sums.turn, zoom: sums.zoom[0], fast: this.shift, jump: this.held.has('Space') };
  }
}
