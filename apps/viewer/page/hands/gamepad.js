/**
 * A gamepad with the standard layout. Left stick: move; right stick: turn or look; triggers: closer
 * and farther, in fly down and up; A: jump; B: home; X: next mode; Y: frame.
 */
const DEAD = 0.15;

/** Returns 0 around the middle and a smooth value up to ±1 outside. @param {number} x */
export function stick(x) {
  const size = (Math.abs(x) - DEAD) / (1 - DEAD);
  return size > 0 && size < 2 ? Math.sign(x) * Math.min(1, size) ** 1.6 : 0;
}

export class Pad {
  constructor() {
    /** @type {boolean[]} */
    this.before = [];
  }

  /** @returns {Gamepad | null} */
  get connected() {
    const pads = navigator.getGamepads?.() ?? [];
    return pads.find((pad) => pad?.connected && pad.mapping === 'standard') ?? null;
  }

  /**
   * Returns the input of the pad, and the buttons that were pressed since the last call.
   * @param {Gamepad} pad @param {boolean} orbits
   */
  read(pad, orbits) {
    const [x, y, turn, tilt] = pad.axes.map(stick);
    const value = (/** @type {number} */ button) => pad.buttons[button]?.value ?? 0;
    const now = pad.buttons.map((button) => button.pressed);
    const pressed = now.map((down, i) => down && !this.before[i]);
    this.before = now;
    const lift = stick(value(7)) - stick(value(6)), shoulders = value(5) - value(4);
    /** @type {import('./navigator.js').Input} */
    const input = {
      move: [x, orbits ? shoulders : lift, -y || 0],
      turn: [turn, -tilt || 0],
      zoom: orbits ? lift : 0,
      fast: now[10] === true,
      jump: now[0],
    };
    return { input, pressed };
  }
}
