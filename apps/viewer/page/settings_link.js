/**
 * Settings as the hash of a URL: key=value pairs; vectors are numbers with commas, parts of a value
 * have semicolons. Numbers are written as the shortest text that gives the same double, so a link is
 * exact. docs/viewer.md lists the keys.
 */
import { DEFAULTS, SettingsError, mergeSettings, sameCamera } from './settings.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {import('./settings.js').Camera} Camera
 */

/** @param {Vec3[]} vectors */
const words = (...vectors) => vectors.map((v) => v.join(',')).join(';');

/**
 * Returns the hash for settings, without '#': only what differs from the defaults. A camera that is
 * `home` is left out.
 * @param {Settings} settings @param {Camera | null} [home] @returns {string}
 */
export function settingsToHash(settings, home = null) {
  /** @type {string[]} */
  const parts = [];
  /** @param {string} key @param {string | number} value */
  const put = (key, value) => parts.push(`${key}=${value}`);
  /** @param {string} key @param {string | number | boolean | null} value @param {any} usual */
  const differ = (key, value, usual) => {
    if (value !== usual) put(key, value === true ? 'on' : value === false ? 'off' : String(value));
  };
  const { camera, sun, occlusion, section } = settings, usual = DEFAULTS;
  if (camera && !sameCamera(camera, home)) {
    put('eye', words(camera.eye));
    put('target', words(camera.target));
    put('up', words(camera.up));
    put('fov', camera.fov);
  }
  differ('mode', settings.mode, usual.mode);
  differ('show', settings.show, usual.show);
  differ('level', settings.level, usual.level);
  differ('colors', settings.colors, usual.colors);
  differ('normals', settings.normals, usual.normals);
  if (sun.direction) put('sun', words(sun.direction));
  differ('sunlight', sun.on, usual.sun.on);
  differ('angle', sun.angle, usual.sun.angle);
  differ('sky', settings.sky, usual.sky);
  differ('exposure', settings.exposure, usual.exposure);
  differ('shadows', settings.shadows, usual.shadows);
  differ('ao', occlusion.samples, usual.occlusion.samples);
  differ('aodistance', occlusion.distance, usual.occlusion.distance);
  differ('aocone', occlusion.cone, usual.occlusion.cone);
  differ('lod', settings.lod, usual.lod);
  differ('cubes', settings.cubes, usual.cubes);
  if (section.box) put('box', words(section.box.low, section.box.high));
  if (section.plane) put('plane', words(section.plane.point, section.plane.normal));
  for (const { from, to } of settings.measures) put('measure', words(from, to));
  for (const note of settings.annotations) {
    const { eye, target, up, fov } = note.camera;
    put('note', `${words(note.point, eye, target, up)};${fov};${encodeURIComponent(note.text)}`);
  }
  for (const { time, eye, target, up, fov } of settings.path)
    put('key', `${time};${words(eye, target)}${up ? ';' + words(up) : ''}${fov === undefined ? '' : ';' + fov}`);
  return parts.join('&');
}

/** @param {string} value */
const toNumber = (value) => (value.trim() === '' ? NaN : Number(value));
/** @param {string} value */
const toVector = (value) => /** @type {any} */ (value.split(',').map(toNumber));
/** @param {string} value */
const toSwitch = (value) => (value === 'on' ? true : value === 'off' ? false : value);

/** @type {{[key: string]: (value: string, all: any) => any}} */
const hashReaders = {
  eye: (v) => ({ camera: { eye: toVector(v) } }),
  target: (v) => ({ camera: { target: toVector(v) } }),
  up: (v) => ({ camera: { up: toVector(v) } }),
  fov: (v) => ({ camera: { fov: toNumber(v) } }),
  mode: (v) => ({ mode: v }),
  show: (v) => ({ show: v }),
  level: (v) => ({ level: toNumber(v) }),
  colors: (v) => ({ colors: toSwitch(v) }),
  normals: (v) => ({ normals: toSwitch(v) }),
  sun: (v) => ({ sun: { direction: toVector(v) } }),
  sunlight: (v) => ({ sun: { on: toSwitch(v) } }),
  angle: (v) => ({ sun: { angle: toNumber(v) } }),
  sky: (v) => ({ sky: toNumber(v) }),
  exposure: (v) => ({ exposure: toNumber(v) }),
  shadows: (v) => ({ shadows: toSwitch(v) }),
  ao: (v) => ({ occlusion: { samples: toNumber(v) } }),
  aodistance: (v) => ({ occlusion: { distance: toNumber(v) } }),
  aocone: (v) => ({ occlusion: { cone: toNumber(v) } }),
  lod: (v) => ({ lod: toNumber(v) }),
  cubes: (v) => ({ cubes: toNumber(v) }),
  box: (v) => {
    const [low, high] = v.split(';').map(toVector);
    return { section: { box: { low, high } } };
  },
  plane: (v) => {
    const [point, normal] = v.split(';').map(toVector);
    return { section: { plane: { point, normal } } };
  },
  measure: (v, all) => {
    const [from, to] = v.split(';').map(toVector);
    return { measures: [...all.measures, { from, to }] };
  },
  note: (v, all) => {
    const [point, eye, target, up, fov, text = ''] = v.split(';');
    const camera = { eye: toVector(eye), target: toVector(target ?? ''), up: toVector(up ?? ''), fov: toNumber(fov ?? '') };
    return { annotations: [...all.annotations, { text: decodeURIComponent(text), point: toVector(point), camera }] };
  },
  key: (v, all) => {
    const [time, eye, target, ...more] = v.split(';');
    const up = more.find((part) => part.includes(',')), fov = more.find((part) => !part.includes(','));
    /** @type {any} */
    const key = { time: toNumber(time), eye: toVector(eye ?? ''), target: toVector(target ?? '') };
    if (up !== undefined) key.up = toVector(up);
    if (fov !== undefined) key.fov = toNumber(fov);
    return { path: [...all.path, key] };
  },
};

/**
 * Reads a hash, with or without '#', on top of `base`. A pair that is wrong is left out and
 * described in `problems`; the camera counts as one pair.
 * @param {string} hash @param {Settings} [base]
 * @returns {{settings: Settings, problems: string[]}}
 */
export function settingsFromHash(hash, base = DEFAULTS) {
  let settings = base;
  /** @type {string[]} */
  const problems = [];
  /** @param {string} key @param {() => any} changes */
  const apply = (key, changes) => {
    try {
      settings = mergeSettings(settings, changes());
    } catch (error) {
      const reason = error instanceof SettingsError ? error.reason : 'is not encoded as a link';
      problems.push(`the link's "${key}" is left out: it ${reason}`);
    }
  };
  /** @type {any} */
  let camera = null;
  for (const pair of hash.replace(/^#/, '').split('&')) {
    if (pair === '') continue;
    const at = pair.indexOf('='), key = at < 0 ? pair : pair.slice(0, at), value = at < 0 ? '' : pair.slice(at + 1);
    if (!Object.hasOwn(hashReaders, key)) {
      problems.push(`the link's "${key.slice(0, 40)}" is unknown`);
      continue;
    }
    if (['eye', 'target', 'up', 'fov'].includes(key)) camera = { ...camera, ...hashReaders[key](value, settings).camera };
    else apply(key, () => hashReaders[key](value, settings));
  }
  if (camera) apply('eye', () => ({ camera }));
  return { settings, problems };
}
