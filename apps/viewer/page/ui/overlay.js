/**
 * The drawing over the picture: handles, lengths and markers, projected with the camera. Layers
 * keep their elements and only move them, so that focus and drags survive.
 */
import { distance, dot, length, mix3, normalized, sub } from '../math.js';
import { directionThrough, lensOf, project } from '../lens.js';
import { svg, update } from './dom.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {{x: number, y: number}} Spot  CSS pixels.
 */

/** The projection of a camera on a picture of a size. */
export class Projection {
  /** @param {Camera} camera @param {number} width @param {number} height */
  constructor(camera, width, height) {
    this.camera = camera;
    this.width = width;
    this.height = height;
    this.lens = lensOf(camera, width / height);
    this.near = 1e-4 * distance(camera.target, camera.eye);
  }
  /** Returns the pixel of a point, or null behind the camera. @param {Vec3} point */
  at(point) {
    const spot = project(this.camera, point, this.width, this.height);
    return spot.depth > this.near && Math.abs(spot.x) < 1e6 && Math.abs(spot.y) < 1e6 ? spot : null;
  }
  /** Returns the depth of a point along the view. @param {Vec3} point */
  depth(point) {
    return dot(sub(point, this.lens.eye), this.lens.forward);
  }
  /** Returns the world units per pixel at a point. @param {Vec3} point */
  pixel(point) {
    return 2 * this.lens.tanY * Math.max(this.depth(point), this.near) / this.height;
  }
  /** Returns the part of a polygon in front of the camera, as pixels. @param {Vec3[]} points @param {boolean} closed */
  clipped(points, closed) {
    /** @type {Spot[]} */
    const spots = [];
    const near = this.near * 2;
    points.forEach((point, i) => {
      const depth = this.depth(point);
      const last = i + 1 === points.length;
      if (depth >= near) spots.push(this.#far(point));
      if (last && !closed) return;
      const next = points[(i + 1) % points.length], after = this.depth(next);
      if ((depth < near) === (after < near)) return;
      const t = (near - depth) / (after - depth);
      spots.push(this.#far(mix3(point, next, t)));
    });
    return spots;
  }
  /** Returns the pixel of a point, within what SVG can draw. @param {Vec3} point @returns {Spot} */
  #far(point) {
    const { x, y } = project(this.camera, point, this.width, this.height);
    return { x: Math.max(-1e5, Math.min(1e5, x)), y: Math.max(-1e5, Math.min(1e5, y)) };
  }
  /** Returns the ray through a pixel. @param {number} x @param {number} y */
  ray(x, y) {
    return { origin: this.camera.eye, direction: directionThrough(this.camera, x, y, this.width, this.height) };
  }
  /**
   * Returns the place on a line, as a factor of `axis`, that is nearest to the ray through a pixel.
   * Null if the line points at the camera.
   * @param {Vec3} point @param {Vec3} axis @param {number} x @param {number} y
   */
  along(point, axis, x, y) {
    const { origin, direction } = this.ray(x, y), unit = normalized(axis), size = length(axis);
    const b = dot(unit, direction), away = sub(point, origin);
    if (1 - b * b < 0.004) return null;
    return (b * dot(direction, away) - dot(unit, away)) / (1 - b * b) / size;
  }
}

/** Returns the path of SVG through pixels. @param {Spot[]} spots @param {boolean} [closed] */
export const pathOf = (spots, closed) =>
  spots.length < 2 ? '' : 'M' + spots.map(({ x, y }) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L') + (closed ? 'Z' : '');

/** Shows an element or hides it. @param {Element} element @param {boolean} shown */
export const show = (element, shown) => {
  if (shown !== !element.hasAttribute('hidden')) element.toggleAttribute('hidden', !shown);
};

/** Moves an element to a pixel; hides it if there is none. @param {Element} element @param {Spot | null} spot */
export function place(element, spot) {
  show(element, spot !== null);
  if (spot) update(element, { transform: `translate(${spot.x.toFixed(1)} ${spot.y.toFixed(1)})` });
}

export class Overlay {
  /** @param {import('../viewer_types.js').Viewer} viewer @param {HTMLElement} container */
  constructor(viewer, container) {
    this.viewer = viewer;
    this.element = svg('svg', { class: 'overlay', 'aria-label': 'Drawing over the picture', hidden: true });
    container.append(this.element);
    /** @type {((projection: Projection, settings: Settings) => void)[]} */
    this.layers = [];
    this.request = 0;
    new ResizeObserver(() => this.redraw()).observe(this.element);
  }

  /** Adds a layer: its elements, and the function that moves them. @param {(projection: Projection, settings: Settings) => void} draw @param {...Element} elements */
  add(draw, ...elements) {
    this.layers.push(draw);
    this.element.append(...elements);
  }

  /** @returns {Projection | null} */
  get projection() {
    const { clientWidth: width, clientHeight: height } = this.viewer.canvas;
    return this.viewer.info && width > 0 && height > 0 ? new Projection(this.viewer.camera(), width, height) : null;
  }

  /** Draws before the next picture, so that the drawing never lags behind it. */
  redraw() {
    this.request ||= requestAnimationFrame(() => {
      this.request = 0;
      this.draw();
    });
  }
  draw() {
    const { projection } = this;
    show(this.element, projection !== null);
    if (!projection) return;
    update(this.element, { viewBox: `0 0 ${projection.width} ${projection.height}` });
    for (const draw of this.layers) draw(projection, this.viewer.get());
  }
}

/**
 * Makes an element a handle: dragged by pointers, moved by arrow keys.
 * @param {Element} element
 * @param {{label: string, start: (spot: Spot) => void, drag: (spot: Spot) => void, key?: (steps: number, aside: number) => void}} acts
 */
export function makeHandle(element, { label, start, drag, key }) {
  for (const [name, value] of Object.entries({ tabindex: '0', role: 'slider', 'aria-label': label })) element.setAttribute(name, value);
  const spotOf = (/** @type {PointerEvent} */ event) => {
    const box = /** @type {SVGElement} */ (element).ownerSVGElement?.getBoundingClientRect();
    return { x: event.clientX - (box?.left ?? 0), y: event.clientY - (box?.top ?? 0) };
  };
  let down = false;
  const handlers = {
    pointerdown: (/** @type {PointerEvent} */ event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      event.stopPropagation();
      /** @type {SVGElement} */ (element).focus({ preventScroll: true });
      element.setPointerCapture(event.pointerId);
      down = true;
      element.classList.add('active');
      start(spotOf(event));
    },
    pointermove: (/** @type {PointerEvent} */ event) => down && drag(spotOf(event)),
    pointerup: () => end(),
    lostpointercapture: () => end(),
    keydown: (/** @type {KeyboardEvent} */ event) => {
      const steps = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!steps || !key) return;
      event.preventDefault();
      event.stopPropagation();
      const by = event.shiftKey ? 10 : 1;
      key(steps[0] * by, steps[1] * by);
    },
  };
  const end = () => {
    down = false;
    element.classList.remove('active');
  };
  for (const [type, handler] of Object.entries(handlers)) element.addEventListener(type, /** @type {any} */ (handler));
}
