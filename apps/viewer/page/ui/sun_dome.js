/** The sky seen from above, on which the sun is dragged: the zenith is in the middle, the viewer at the bottom. */
import { RADIANS, clamp } from '../math.js';
import { svg, update } from './dom.js';

/** Radius of the horizon; the dome is drawn from -64 to 64. */
const RADIUS = 56;
/** Degrees that an arrow key turns. */
const STEP = 5;
/** @type {{[key: string]: [number, number]}} */
const ARROWS = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };

/**
 * Makes the dome. Angles are in degrees; `heading` is the azimuth in which the viewer looks.
 * @param {{angles: () => {azimuth: number, elevation: number}, heading: () => number,
 *   aim: (azimuth: number, elevation: number) => void}} sky
 */
export function sunDome({ angles, heading, aim }) {
  const dot = svg('circle', { class: 'sun', r: 8 });
  const ray = svg('line', { class: 'ray', x1: 0, y1: 0 });
  const element = svg('svg', {
    class: 'dome', viewBox: '-64 -64 128 128', tabindex: 0, role: 'slider', 'aria-label': 'Direction of the sun',
    'aria-valuemin': 0, 'aria-valuemax': 360,
  },
  svg('circle', { class: 'sky', r: RADIUS }), svg('circle', { class: 'ring', r: RADIUS / 3 }),
  svg('circle', { class: 'ring', r: 2 * RADIUS / 3 }), svg('path', { class: 'viewer-mark', d: 'M-5 62 0 55 5 62' }), ray, dot);

  const drag = (/** @type {PointerEvent} */ event) => {
    const box = element.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * 128 - 64, y = (event.clientY - box.top) / box.height * 128 - 64;
    aim(Math.atan2(x, -y) / RADIANS + heading(), 90 * (1 - Math.min(1, Math.hypot(x, y) / RADIUS)));
  };
  let down = false;
  element.addEventListener('pointerdown', (event) => {
    event.preventDefault();
    element.focus();
    element.setPointerCapture(event.pointerId);
    down = true;
    drag(event);
  });
  element.addEventListener('pointermove', (event) => {
    if (down) drag(event);
  });
  element.addEventListener('lostpointercapture', () => { down = false; });
  element.addEventListener('keydown', (event) => {
    const turn = ARROWS[event.key];
    if (!turn) return;
    event.preventDefault();
    const { azimuth, elevation } = angles();
    aim(azimuth + turn[0], clamp(elevation + turn[1], 0, 90));
  });
  return {
    element,
    refresh() {
      const { azimuth, elevation } = angles(), turn = (azimuth - heading()) * RADIANS;
      const r = RADIUS * clamp(1 - elevation / 90, 0, 1), x = Math.sin(turn) * r, y = -Math.cos(turn) * r;
      update(dot, { cx: x, cy: y });
      update(ray, { x2: x, y2: y });
      update(element, {
        'aria-valuenow': String(Math.round(azimuth)),
        'aria-valuetext': `azimuth ${Math.round(azimuth)}°, elevation ${Math.round(elevation)}°`,
      });
    },
  };
}
