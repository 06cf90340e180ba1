/** The panel "View": how one moves, what is shown and how finely. */
import { addScaled, cross, length, sub } from '../math.js';
import { compassOf } from '../hands/pose.js';
import { button, choice, group, refreshAll, segments, slider, textField, toggle, typedNumber } from './controls.js';
import { shownCubes } from '../settings.js';
import { h } from './dom.js';
import { valueText } from './numbers.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Settings} Settings
 */

/** @type {[import('../settings.js').Show, string][]} */
const SHOWS = [
  ['light', 'Light'], ['level', 'Levels'], ['steps', 'Steps per ray'], ['sharing', 'Sharing of nodes'], ['normal', 'Normals'],
  ['depth', 'Depth'], ['occlusion', 'Ambient occlusion'],
];
/** @type {{[show: string]: string}} */
const MEANINGS = {
  level: 'The level of the octree that each pixel shows.',
  steps: 'How many cells the ray of each pixel visits: the brighter, the more.',
  sharing: 'How many places of the scene share the node of each pixel: the brighter, the more.',
  normal: 'The direction of the surface, as a colour.',
  depth: 'The distance along the view.',
  occlusion: 'How much light of the sky arrives: the brighter, the more.',
};
/** @type {[string, string][]} */
export const SIDES = [
  ['home', 'Home'], ['front', 'Front'], ['right', 'Right'], ['back', 'Back'], ['left', 'Left'], ['top', 'Top'], ['bottom', 'Bottom'],
];
/** @type {{[name: string]: Vec3}} */
const AXES = { '+x': [1, 0, 0], '+y': [0, 1, 0], '+z': [0, 0, 1], '-x': [-1, 0, 0], '-y': [0, -1, 0], '-z': [0, 0, -1] };

/** @type {[string, string][]} */
const AXIS_NAMES = Object.keys(AXES).map((name) => [name, name.replace('-', '\u2212')]);

/**
 * Returns the camera with another up axis. A view along it would have no horizon: then the eye moves
 * aside.
 * @param {import('../settings.js').Camera} camera @param {Vec3} up
 */
function withUp(camera, up) {
  const line = sub(camera.eye, camera.target), size = length(line), isAlong = length(cross(line, up)) < 0.01 * size;
  return { ...camera, up, eye: isAlong ? addScaled(camera.eye, compassOf(up).east, 0.5 * size) : camera.eye };
}

/** @param {Ui} ui */
export function viewPanel(ui) {
  const { viewer, hands } = ui;
  const mode = segments({
    label: 'Move', options: [['orbit', 'Orbit', 'orbit'], ['fly', 'Fly', 'fly'], ['walk', 'Walk', 'walk']],
    get: (s) => s.mode, set: (value) => viewer.set({ mode: value }, 'ui'),
  });
  const meaning = h('p', { class: 'hint' });
  const show = choice({ label: 'Show', options: SHOWS, get: (s) => s.show, set: (value) => viewer.set({ show: value }, 'ui') });
  const levels = () => viewer.info?.levels ?? 1;
  const level = slider({
    label: 'Finest level', hint: 'Each level halves the cells of the level before', min: 0, max: 1, step: 1, whole: true, get: (s) => Math.min(s.level ?? levels(), levels()),
    set: (value) => viewer.set({ level: value >= levels() ? null : value }, 'ui'),
    text: (value) => (value >= levels() ? 'all' : `${value} (${(2 ** value).toLocaleString('en')}³)`),
  });
  const colors = toggle({ label: 'Colours', get: (s) => s.colors, set: (on) => viewer.set({ colors: on }, 'ui') });
  const channel = choice({
    label: 'Colour by', get: (s) => s.channel.name,
    options: () => ['', ...(viewer.info?.channels ?? []).map(({ name }) => name)].map((name) => [name, name || 'Colours of the file']),
    set: (name) => viewer.set({ channel: { name, range: null }, ...(name && { show: 'light' }) }, 'ui'),
  });
  const range = textField({
    label: 'Range', most: 60, event: 'change', get: () => viewer.channel()?.range.map(valueText).join(' to ') ?? '',
    set: (typed) => {
      const ends = typed.split('to').map((part) => typedNumber(part, new Map()) ?? NaN), [least, most] = ends;
      if (typed && !(ends.length === 2 && least < most && Math.max(-least, most) < 3.4e38)) ui.toast('Type two values, such as 0 to 100', true);
      else viewer.set({ channel: { range: typed ? [least, most] : null } }, 'ui');
      ui.refresh();
    },
  });
  const ends = h('div', {}, range.element, h('p', { class: 'hint' }, 'The values of the first and the last colour; empty: those of the channel.'));
  const normals = toggle({ label: 'Normals of the file', hint: 'Off: the page computes them from the voxels', get: (s) => s.normals, set: (on) => viewer.set({ normals: on }, 'ui') });
  const lod = slider({
    label: 'Level of detail', min: 0, max: 8, step: 0.25, get: (s) => s.lod, set: (value) => viewer.set({ lod: value }, 'ui'),
    text: (x) => (x ? `${x} px` : 'off'), hint: 'Details smaller than this many pixels are left out',
  });
  const cubes = slider({
    label: 'Show voxels as cubes from', min: 0, max: 100, step: 1, get: (s) => shownCubes(s, viewer.info), set: (value) => viewer.set({ cubes: value }, 'ui'),
    text: (x) => (x ? `${+x.toFixed(2)} px` : 'always'), hint: 'Voxels of at least this many pixels look like cubes, smaller ones like a smooth surface',
  });
  const change = (/** @type {Partial<import('../settings.js').Camera>} */ part) => {
    if (viewer.info) viewer.set({ camera: { ...viewer.camera(), ...part } }, 'ui');
  };
  const fov = slider({
    label: 'Field of view', min: 10, max: 110, step: 1, get: () => viewer.camera().fov, set: (value) => change({ fov: value }),
    text: (x) => `${+x.toFixed(1)}°`,
  });
  const axisOf = () => Object.keys(AXES).find((name) => AXES[name].every((x, i) => Math.abs(x - viewer.camera().up[i]) < 1e-6)) ?? 'own';
  const up = choice({
    label: 'Up', options: [...AXIS_NAMES, ['own', 'other']], get: axisOf,
    set: (name) => { if (AXES[name]) change(withUp(viewer.camera(), AXES[name])); },
  });
  const lock = button('Look around with the mouse', () => hands.lockPointer(), { title: 'Hides the pointer until Escape (key L)' });
  const refresh = refreshAll([mode, show, channel, range, level, colors, normals, lod, cubes, fov, up]);
  return {
    element: h('div', {},
      group('', mode.element, lock),
      group('Views', h('div', { class: 'grid' }, ...SIDES.map(([name, label], i) =>
        button(label, () => hands.view(name), { title: `${label} (key ${i + 1})` })),
      button('Frame', () => hands.frame(), { title: 'Show the whole scene (key F)' })), fov.element, up.element),
      group('Picture', show.element, meaning, channel.element, ends, level.element, colors.element, normals.element, lod.element, cubes.element),
      group('', button('Reset all settings', () => ui.reset()))),
    refresh(/** @type {Settings} */ settings) {
      const { info } = viewer;
      level.limits(0, levels(), 1);
      channel.element.hidden = !info?.channels.length || !info.isWhole;
      ends.hidden = viewer.channel() === null;
      colors.element.hidden = !info?.hasColors || viewer.channel() !== null;
      normals.element.hidden = !info?.hasNormals;
      meaning.textContent = MEANINGS[settings.show] ?? '';
      meaning.hidden = settings.show === 'light';
      lock.hidden = settings.mode === 'orbit' || matchMedia('(pointer: coarse)').matches;
      refresh(settings);
    },
  };
}
