/**
 * Pointers on the picture: turns events of mouse, pen and fingers into motion of the camera.
 *   orbit: drag or one finger turns; right, middle or Shift and drag pans; two fingers pan and
 *          zoom; three fingers fly.
 *   fly, walk: drag or one finger looks; two fingers move in the picture; three fingers fly or walk.
 */
import { clamp } from '../math.js';

/**
 * @typedef {import('./navigator.js').Navigator} Navigator
 * @typedef {import('../math.js').Vec3} Vec3
 *
 * @typedef {object} PointerOwner
 * @property {() => void} wake  The camera has a new goal.
 * @property {(x: number, y: number) => Drag | null} drag  Takes a drag of one finger, pen or left button for something else, if it is wanted.
 * @property {(x: number, y: number) => void} click
 * @property {(x: number, y: number) => void} doubleClick
 * @property {(x: number, y: number, down: boolean) => void} hover  Where the pointer is, over the picture.
 * @property {() => void} leave
 * @property {() => void} speed  The speed of flying and walking has changed.
 */

/** A drag that does not move the camera. @typedef {{move: (x: number, y: number) => void, end: () => void}} Drag */

/** Pixels that a click may move, by kind of pointer. */
const CLICK_REACH = { mouse: 4, touch: 10, pen: 8 };
const CLICK_MS = 500, DOUBLE_MS = 400, DOUBLE_REACH = 16;
/** Pixels of three fingers at full speed. */
const STICK_REACH = 90;

export class Pointers {
  /** @param {HTMLElement} element @param {Navigator} navigator @param {PointerOwner} owner
   *  @param {ReturnType<typeof import('../events.js').listeners>['listen']} listen */
  constructor(element, navigator, owner, listen) {
    this.element = element;
    this.navigator = navigator;
    this.owner = owner;
    /** @type {Map<number, {x: number, y: number}>} */
    this.down = new Map();
    /** @type {{x: number, y: number, time: number, moved: number} | null} */
    this.press = null;
    this.lastClick = { x: 0, y: 0, time: -Infinity };
    /** @type {Vec3 | null} */
    this.grabbed = null;
    this.pans = false;
    /** A drag that something else has taken. @type {Drag | null} */
    this.taken = null;
    /** @type {{x: number, y: number} | null} */
    this.stickAt = null;
    /** The motion that three fingers ask for: right, forward. @type {[number, number]} */
    this.stick = [0, 0];
    this.locked = false;
    element.style.touchAction = 'none';
    listen(element, 'pointerdown', (event) => this.#pressed(event));
    listen(element, 'pointermove', (event) => this.#moved(event));
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture'])
      listen(element, type, (event) => this.#released(event));
    listen(element, 'pointerleave', () => this.owner.leave());
    listen(element, 'contextmenu', (event) => event.preventDefault());
    listen(element, 'wheel', (event) => this.#wheel(event), { passive: false });
    listen(document, 'pointerlockchange', () => { this.locked = document.pointerLockElement === element; });
    listen(document, 'mousemove', (event) => {
      if (!this.locked) return;
      this.navigator.measure(this.element);
      this.navigator.look(clamp(event.movementX, -300, 300), clamp(event.movementY, -300, 300));
      this.owner.wake();
    });
  }

  /** Hides the pointer and lets it look around, until Escape. */
  lock() {
    const lock = /** @type {any} */ (this.element.requestPointerLock?.());
    lock?.catch?.(() => {});  // the browser may refuse
  }

  /** @param {MouseEvent} event */
  #at(event) {
    const box = this.element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /** The centre of the pointers that are down, and their mean distance from it. */
  #hand() {
    let x = 0, y = 0, spread = 0;
    for (const p of this.down.values()) { x += p.x / this.down.size; y += p.y / this.down.size; }
    for (const p of this.down.values()) spread += Math.hypot(p.x - x, p.y - y) / this.down.size;
    return { x, y, spread };
  }

  /** @param {PointerEvent} event */
  #pressed(event) {
    if (this.locked) return;
    this.navigator.measure(this.element);
    this.element.focus({ preventScroll: true });
    const at = this.#at(event);
    this.element.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, at);
    const first = this.down.size === 1;
    this.press = first && event.button === 0 ? { ...at, time: event.timeStamp, moved: 0 } : null;
    this.pans = event.pointerType === 'mouse' && (event.button !== 0 || event.shiftKey || event.ctrlKey);
    if (event.button === 1) event.preventDefault();  // no automatic scrolling
    const hand = this.#hand();
    this.#endDrag();
    // A finger may be the first of two: it begins a drag when it moves.
    if (this.press && !this.pans && event.pointerType !== 'touch') this.taken = this.owner.drag(at.x, at.y);
    this.grabbed = this.navigator.pointUnder(hand.x, hand.y);
    this.stickAt = this.down.size >= 3 ? hand : null;
    this.stick = [0, 0];
    if (this.navigator.flight) this.navigator.stop();
  }

  #endDrag() {
    this.taken?.end();
    this.taken = null;
  }

  /** @param {PointerEvent} event */
  #moved(event) {
    if (this.locked) return;
    const at = this.#at(event);
    if (event.pointerType !== 'touch') this.owner.hover(at.x, at.y, this.down.size > 0);
    if (!this.down.has(event.pointerId)) return;
    this.navigator.measure(this.element);
    const before = this.#hand();
    this.down.set(event.pointerId, at);
    const now = this.#hand(), dx = now.x - before.x, dy = now.y - before.y;
    if (this.taken) return this.taken.move(at.x, at.y);
    if (this.press) {
      this.press.moved = Math.max(this.press.moved, Math.hypot(at.x - this.press.x, at.y - this.press.y));
      if (this.press.moved <= this.#reach(event)) return;
      if (this.press.time > 0 && event.pointerType === 'touch' && (this.taken = this.owner.drag(this.press.x, this.press.y)))
        return this.taken.move(at.x, at.y);
      if (this.press.time > 0) {  // the way so far, so that nothing is lost
        this.#drag(at.x - this.press.x, at.y - this.press.y, event);
        this.press.time = 0;
        return;
      }
    }
    this.#drag(dx, dy, event, before.spread > 8 && now.spread > 8 ? before.spread / now.spread : 1, now);
  }

  /** @param {PointerEvent} event */
  #reach(event) {
    return CLICK_REACH[/** @type {'mouse'} */ (event.pointerType)] ?? CLICK_REACH.mouse;
  }

  /** @param {number} dx @param {number} dy @param {PointerEvent} event
   *  @param {number} [factor] @param {{x: number, y: number}} [at] */
  #drag(dx, dy, event, factor = 1, at) {
    const { navigator } = this, fingers = this.down.size;
    if (fingers >= 3 || (fingers === 2 && navigator.mode === 'walk')) {
      const start = (this.stickAt ??= at ?? this.#hand()), hand = this.#hand();
      this.stick = [clamp((hand.x - start.x) / STICK_REACH, -1, 1), clamp((start.y - hand.y) / STICK_REACH, -1, 1)];
    } else if (fingers === 2) {
      navigator.pan(dx, dy, this.grabbed ?? undefined);
      if (factor !== 1 && this.grabbed) navigator.zoomAbout(this.grabbed, factor);
    } else if (this.pans) navigator.pan(dx, dy, this.grabbed ?? undefined);
    else if (navigator.mode === 'orbit') navigator.rotate(dx, dy);
    else navigator.look(dx, dy, event.pointerType === 'touch');
    this.owner.wake();
  }

  /** @param {PointerEvent} event */
  #released(event) {
    if (!this.down.delete(event.pointerId)) return;
    this.stick = [0, 0];
    this.stickAt = null;
    const { press } = this;
    this.press = null;
    if (this.taken) return this.#endDrag();
    if (event.type === 'pointerup' && press && press.time > 0 && event.pointerType === 'touch') {
      const tap = this.owner.drag(press.x, press.y);
      if (tap) return tap.end();
    }
    if (this.down.size > 0) {
      const hand = this.#hand();
      this.grabbed = this.navigator.pointUnder(hand.x, hand.y);
      return;
    }
    if (event.type !== 'pointerup' || !press || press.time === 0 || event.timeStamp - press.time > CLICK_MS) return;
    const { x, y } = press, last = this.lastClick;
    const again = event.timeStamp - last.time < DOUBLE_MS && Math.hypot(x - last.x, y - last.y) < DOUBLE_REACH;
    this.lastClick = { x, y, time: again ? -Infinity : event.timeStamp };
    if (again) this.owner.doubleClick(x, y);
    else this.owner.click(x, y);
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    event.preventDefault();
    this.navigator.measure(this.element);
    const unit = event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 400 : 1;
    const turned = clamp((event.deltaY || event.deltaX) * unit, -300, 300);
    const factor = Math.exp(turned * (event.ctrlKey ? 0.01 : 0.0017));  // a pinch on a touchpad sets ctrlKey
    const { x, y } = this.#at(event);
    if (this.navigator.mode === 'orbit') this.navigator.zoom(x, y, factor);
    else {
      this.navigator.changeSpeed(1 / factor);
      this.owner.speed();
    }
    this.owner.wake();
  }
}
