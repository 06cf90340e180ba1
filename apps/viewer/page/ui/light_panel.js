/** The panel "Light": the sun on a dome that one drags, the sky, shadows and exposure. */
import { RADIANS, clamp } from '../math.js';
import { anglesOf, compassOf, lensOf } from '../hands/pose.js';
import { group, logarithmic, refreshAll, slider, toggle } from './controls.js';
import { h, svg, update } from './dom.js';
import { sunAngles, sunDirection, sunFromAngles } from './sun.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 */

const RADIUS = 56;

/** @param {Ui} ui */
export function lightPanel(ui) {
  const { viewer } = ui;
  const camera = (/** @type {Settings} */ s) => s.camera ?? ui.home();
  const angles = (/** @type {Settings} */ s) => sunAngles(sunDirection(s.sun.direction, camera(s)), camera(s).up);
  const aim = (/** @type {number} */ azimuth, /** @type {number} */ elevation) =>
    viewer.set({ sun: { direction: sunFromAngles(azimuth, elevation, camera(viewer.get()).up) } }, 'ui');
  /** Degrees from north to where the viewer looks: up on the dome. */
  const heading = (/** @type {Settings} */ s) => {
    const { forward, up } = lensOf(camera(s), 1), compass = compassOf(camera(s).up);
    const flat = Math.abs(anglesOf(compass, forward).pitch) > 89 * RADIANS ? up : forward;
    return anglesOf(compass, flat).yaw / RADIANS;
  };

  // The sky from above: the zenith is in the middle, the viewer below.
  const dot = svg('circle', { class: 'sun', r: 8 });
  const ray = svg('line', { class: 'ray', x1: 0, y1: 0 });
  const dome = svg('svg', { class: 'dome', viewBox: '-64 -64 128 128', tabindex: 0, role: 'slider', 'aria-label': 'Direction of the sun', 'aria-valuemin': 0, 'aria-valuemax': 360 },
    svg('circle', { class: 'sky', r: RADIUS }), svg('circle', { class: 'ring', r: RADIUS / 3 }), svg('circle', { class: 'ring', r: 2 * RADIUS / 3 }),
    svg('path', { class: 'viewer-mark', d: 'M-5 62 0 55 5 62' }), ray, dot);
  const dragged = (/** @type {PointerEvent} */ event) => {
    const box = dome.getBoundingClientRect(), s = viewer.get();
    const x = (event.clientX - box.left) / box.width * 128 - 64, y = (event.clientY - box.top) / box.height * 128 - 64;
    const elevation = 90 * (1 - Math.min(1, Math.hypot(x, y) / RADIUS));
    aim(Math.atan2(x, -y) / RADIANS + heading(s), elevation);
  };
  let down = false;
  /** @type {[string, (event: any) => void][]} */
  const handlers = [
    ['pointerdown', (event) => { event.preventDefault(); dome.focus(); dome.setPointerCapture(event.pointerId); down = true; dragged(event); }],
    ['pointermove', (event) => down && dragged(event)],
    ['lostpointercapture', () => { down = false; }],
    ['keydown', (event) => {
      const turn = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[/** @type {'ArrowUp'} */ (event.key)];
      if (!turn) return;
      event.preventDefault();
      const { azimuth, elevation } = angles(viewer.get());
      aim(azimuth + turn[0], clamp(elevation + turn[1], 0, 90));
    }],
  ];
  for (const [type, handler] of handlers) dome.addEventListener(type, handler);

  const on = toggle({ label: 'Sun', get: (s) => s.sun.on, set: (value) => viewer.set({ sun: { on: value } }, 'ui') });
  const follow = toggle({
    label: 'Over my left shoulder', get: (s) => s.sun.direction === null, hint: 'The sun turns with the camera',
    set: (value) => viewer.set({ sun: { direction: value ? null : sunFromAngles(angles(viewer.get()).azimuth, angles(viewer.get()).elevation, camera(viewer.get()).up) } }, 'ui'),
  });
  const azimuth = slider({
    label: 'Azimuth', min: 0, max: 360, step: 1, get: (s) => angles(s).azimuth, text: (x) => `${Math.round(x)}°`,
    set: (value) => aim(value, angles(viewer.get()).elevation),
  });
  const elevation = slider({
    label: 'Elevation', min: -10, max: 90, step: 1, get: (s) => angles(s).elevation, text: (x) => `${Math.round(x)}°`.replace('-', '\u2212'),
    // Straight up, the azimuth would be lost.
    set: (value) => aim(angles(viewer.get()).azimuth, Math.min(value, 89.9)),
  });
  const angle = slider({
    label: 'Size of the sun', min: 0, max: 10, step: 0.01, get: (s) => s.sun.angle, set: (value) => viewer.set({ sun: { angle: value } }, 'ui'),
    text: (x) => `${+x.toFixed(2)}°`, hint: 'Its diameter; 0: hard shadows', to: (x) => Math.sqrt(x * 10), from: (x) => +(x * x / 10).toFixed(2),
  });
  const shadows = toggle({ label: 'Shadows', get: (s) => s.shadows, set: (value) => viewer.set({ shadows: value }, 'ui') });
  const sky = slider({ label: 'Sky', min: 0, max: 3, step: 0.05, get: (s) => s.sky, set: (value) => viewer.set({ sky: value }, 'ui'), text: (x) => `× ${+x.toFixed(2)}` });
  const samples = slider({
    label: 'Ambient occlusion', min: 0, max: 256, step: 8, get: (s) => s.occlusion.samples, set: (value) => viewer.set({ occlusion: { samples: value } }, 'ui'),
    text: (x) => (x ? `${x} rays` : 'off'),
  });
  const side = () => (viewer.info ? viewer.info.voxelSize * viewer.info.resolution : 1);
  const reach = slider({
    label: 'Its distance', min: 0.005, max: 0.5, get: (s) => (s.occlusion.distance || 0.15 * side()) / side(),
    set: (value) => viewer.set({ occlusion: { distance: +(value * side()).toPrecision(3) } }, 'ui'),
    text: (x) => `${(x * 100).toPrecision(2)}%`, hint: 'How far surfaces darken each other, in parts of the grid',
  });
  const exposure = slider({
    label: 'Exposure', min: -4.25, max: 4, step: 0.05, ...logarithmic(2 ** -4.25), get: (s) => s.exposure,
    set: (value) => viewer.set({ exposure: value }, 'ui'), text: (x) => (x ? `× ${x.toPrecision(2)}` : 'automatic'),
  });
  const refresh = refreshAll([on, follow, azimuth, elevation, angle, shadows, sky, samples, reach, exposure]);
  const sun = h('div', { class: 'sun-controls' }, h('div', { class: 'center' }, dome), azimuth.element, elevation.element, follow.element, angle.element, shadows.element);
  return {
    element: h('div', {}, group('', on.element, sun), group('Sky', sky.element, samples.element, reach.element), group('', exposure.element)),
    refresh(/** @type {Settings} */ s) {
      refresh(s);
      sun.hidden = !s.sun.on;
      reach.element.hidden = s.occlusion.samples === 0;
      const at = angles(s), turn = (at.azimuth - heading(s)) * RADIANS, r = RADIUS * clamp(1 - at.elevation / 90, 0, 1);
      const x = Math.sin(turn) * r, y = -Math.cos(turn) * r;
      update(dot, { cx: x, cy: y });
      update(ray, { x2: x, y2: y });
      update(dome, { 'aria-valuenow': String(Math.round(at.azimuth)), 'aria-valuetext': `azimuth ${Math.round(at.azimuth)}°, elevation ${Math.round(at.elevation)}°` });
    },
    followsCamera: true,
  };
}
