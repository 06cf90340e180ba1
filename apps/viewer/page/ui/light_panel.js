/** The panel "Light": the sun, the sky, shadows and exposure. */
import { RADIANS, dot } from '../math.js';
import { LIGHT } from '../constants.js';
import { BUILT_IN } from '../environment_skies.js';
import { anglesOf, compassOf } from '../hands/pose.js';
import { lensOf } from '../lens.js';
import { interiorSun } from '../sun.js';
import { sunOf } from '../sunlight.js';
import { choice, group, logarithmic, refreshAll, slider, toggle } from './controls.js';
import { h } from './dom.js';
import { capitalized } from './link.js';
import { degrees } from './numbers.js';
import { skyAngles, skyDirection } from './sky_angles.js';
import { sunDome } from './sun_dome.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').PartialSettings} PartialSettings
 */

/** The value of the list for an environment that is no built-in one. */
const OWN = 'own';
/** The bounds of a scene before it is known. @type {import('../settings.js').Box} */
const NOWHERE = { low: [0, 0, 0], high: [0, 0, 0] };
/** The name of the map with which the page began, or that its settings hold. @param {Settings} s */
const ownMap = ({ environment: { map } }) => (typeof map === 'object' ? map : null);

/** @param {Ui} ui */
export function lightPanel(ui) {
  const { viewer } = ui;
  const set = (/** @type {PartialSettings} */ settings) => viewer.set(settings, 'ui');
  const inside = () => (viewer.info ? interiorSun(viewer.info, viewer.camera()) : null);
  const sunNow = () => sunOf({ bounds: viewer.info?.bounds ?? NOWHERE, home: viewer.info?.home ?? null }, { ...viewer.get(), camera: viewer.camera() });
  const angles = () => skyAngles(sunNow().direction, viewer.camera().up);
  const aim = (/** @type {number} */ azimuth, /** @type {number} */ elevation) =>
    set({ sun: { direction: skyDirection(azimuth, elevation, viewer.camera().up) } });
  /** The azimuth in which the viewer looks: up in the picture, if that is straight down. */
  const heading = () => {
    const { forward, up } = lensOf(viewer.camera(), 1), compass = compassOf(viewer.camera().up);
    const isSteep = Math.abs(anglesOf(compass, forward).pitch) > 89 * RADIANS;
    return anglesOf(compass, isSteep ? up : forward).yaw / RADIANS;
  };
  /** The grid's side. */
  const side = () => (viewer.info ? viewer.info.voxelSize * viewer.info.resolution : 1);

  const dome = sunDome({ angles, heading, aim });
  const on = toggle({ label: 'Sun', get: (s) => s.sun.on, set: (value) => set({ sun: { on: value } }) });
  const follow = toggle({
    label: 'Sun follows the camera', hint: 'The light comes from behind you, from the left; inside a building, through an opening',
    get: (s) => s.sun.direction === null,
    set: (value) => (value ? set({ sun: { direction: null } }) : aim(angles().azimuth, angles().elevation)),
  });
  const azimuth = slider({
    label: 'Direction of the sun', min: 0, max: 360, step: 1, text: degrees,
    get: () => angles().azimuth, set: (value) => aim(value, angles().elevation),
  });
  const elevation = slider({
    label: 'Height of the sun', min: -10, max: 90, step: 1, text: degrees,
    // Straight up, the azimuth would be lost.
    get: () => angles().elevation, set: (value) => aim(angles().azimuth, Math.min(value, 89.9)),
  });
  const angle = slider({
    label: 'Diameter of the sun', hint: 'The larger, the softer the shadows; 0: hard shadows', min: 0, max: 10,
    to: (x) => Math.sqrt(x * 10), from: (x) => +(x * x / 10).toFixed(2), text: (x) => `${+x.toFixed(2)}°`,
    get: (s) => s.sun.angle, set: (value) => set({ sun: { angle: value } }),
  });
  const shadows = toggle({ label: 'Shadows', get: (s) => s.shadows, set: (value) => set({ shadows: value }) });
  const sky = slider({
    label: 'Brightness of the sky', min: 0, max: 3, step: 0.05, text: (x) => `× ${+x.toFixed(2)}`,
    get: (s) => s.sky, set: (value) => set({ sky: value }),
  });
  /** The last environment that is no built-in one: the list keeps it. */
  let own = ownMap(viewer.get());
  const environment = choice({
    label: 'Light from', options: [['sky', 'Clear sky'], ...Object.keys(BUILT_IN).map((name) => /** @type {[string, string]} */ ([name, capitalized(name)])), [OWN, '']],
    get: ({ environment: { map } }) => (map === null ? 'sky' : typeof map === 'string' ? map : OWN),
    set: (value) => set({ environment: { map: value === 'sky' ? null : value === OWN ? own : value } }),
  });
  const ownOption = /** @type {HTMLOptionElement} */ (environment.element.querySelector(`option[value=${OWN}]`));
  const turn = slider({
    label: 'Turn of the environment', min: -180, max: 180, step: 1, text: degrees,
    get: (s) => s.environment.turn, set: (value) => set({ environment: { turn: value } }),
  });
  const bounced = toggle({
    label: 'Bounced light', hint: 'Surfaces light each other; shown when the picture stands still',
    get: (s) => s.bounces !== null && s.occlusion.samples > 0,
    set: (value) => set({ bounces: value ? 1 : null, ...(value && viewer.get().occlusion.samples === 0 ? { occlusion: { samples: LIGHT.occlusionSamples } } : {}) }),
  });
  const samples = slider({
    label: 'Ambient occlusion: quality', min: 0, max: 256, step: 8, whole: true, text: (x) => (x ? `${x} rays` : 'off'),
    get: (s) => s.occlusion.samples, set: (value) => set({ occlusion: { samples: value } }),
  });
  const reach = slider({
    label: 'Ambient occlusion: distance', hint: 'How far surfaces darken each other, in parts of the grid', min: 0.005, max: 1, per: 100,
    text: (x) => `${+(x * 100).toPrecision(3)}%`,
    get: (s) => s.occlusion.distance / side() || (inside() ? LIGHT.interiorOcclusion : LIGHT.occlusionDistance),
    set: (value) => set({ occlusion: { distance: +(value * side()).toPrecision(3) } }),
  });
  const exposure = slider({
    label: 'Exposure', min: -4.25, max: 4, step: 0.05, ...logarithmic(2 ** -4.25),
    text: (x) => (x ? `× ${+x.toPrecision(3)}` : 'automatic'),
    get: (s) => s.exposure, set: (value) => set({ exposure: value }),
  });
  const tone = choice({
    label: 'Tone curve', options: [['neutral', 'Neutral'], ['agx', 'AgX'], ['filmic', 'Filmic']],
    get: (s) => s.tone, set: (value) => set({ tone: value }),
  });
  const background = choice({
    label: 'Background', options: [['sky', 'Sky'], ['grey', 'Grey'], ['white', 'White'], ['black', 'Black']],
    get: (s) => s.background, set: (value) => set({ background: value }),
  });
  const ground = toggle({
    label: 'Ground', hint: 'Shows the shadow of the scene on a ground under it',
    get: (s) => s.ground, set: (value) => set({ ground: value }),
  });
  const followName = /** @type {HTMLElement} */ (follow.element.firstElementChild);
  const noSun = h('p', { class: 'hint' }, 'This light has no sun. To add one, turn “Sun of the environment” off.');
  const refresh = refreshAll([on, follow, azimuth, elevation, angle, shadows, environment, turn, sky, bounced, samples, reach, exposure, tone, background, ground]);
  const place = h('div', {}, h('div', { class: 'center' }, dome.element), azimuth.element, elevation.element);
  const quality = h('div', {}, angle.element, shadows.element), sun = h('div', {}, place, follow.element, noSun, quality);
  return {
    element: h('div', {}, group('', environment.element, turn.element), group('', on.element, sun), group('Sky', sky.element, bounced.element, samples.element, reach.element),
      group('', exposure.element, tone.element, background.element, ground.element)),
    refresh(/** @type {Settings} */ s) {
      refresh(s);
      dome.refresh();
      sun.hidden = !s.sun.on;
      const { map } = s.environment, hasSun = dot(sunNow().light, [1, 1, 1]) > 0;
      noSun.hidden = hasSun;
      place.hidden = quality.hidden = !hasSun;
      own = ownMap(s) ?? own;
      ownOption.hidden = ownOption.disabled = own === null;
      ownOption.textContent = own?.name || 'File';
      turn.element.hidden = map === null;
      followName.textContent = map === null ? 'Sun follows the camera' : 'Sun of the environment';
      reach.element.hidden = s.occlusion.samples === 0 || s.bounces !== null;
    },
    followsCamera: true,
  };
}
