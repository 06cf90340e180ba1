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
/** @param {string} value */
const toNumber = (value) => (value.trim() === '' ? NaN : Number(value));
/** @param {string} value */
const toVector = (value) => /** @type {any} */ (value.split(',').map(toNumber));

/**
 * How values of one kind are written and read; null: a link cannot hold the value.
 * @typedef {{write: (value: any) => string | number | null, read: (text: string) => any}} Kind
 */
/** @type {{[name: string]: Kind}} */
const KINDS = {
  number: { write: (value) => value, read: toNumber },
  /** A number that may be missing. */
  optional: { write: (value) => value ?? 'none', read: (text) => (text === 'none' ? null : toNumber(text)) },
  text: { write: (value) => value, read: (text) => text },
  free: { write: encodeURIComponent, read: decodeURIComponent },
  name: { write: (value) => value ?? 'none', read: (text) => (text === 'none' ? null : text) },
  /** An environment: a link has no room for a map that the page does not begin with. */
  map: { write: (map) => (typeof map === 'string' || map === null ? map ?? 'none' : null), read: (text) => (text === 'none' ? null : text) },
  onOff: { write: (on) => (on ? 'on' : 'off'), read: (text) => (text === 'on' ? true : text === 'off' ? false : text) },
  vector: { write: (v) => (v ? words(v) : 'none'), read: (text) => (text === 'none' ? null : toVector(text)) },
};

/** Settings with one value: the key in a link, the key in the settings, the key in a part of them. @type {[string, Kind, keyof Settings, string?][]} */
const SIMPLE = [
  ['mode', KINDS.text, 'mode'],
  ['show', KINDS.text, 'show'],
  ['channel', KINDS.free, 'channel', 'name'],
  ['range', KINDS.vector, 'channel', 'range'],
  ['level', KINDS.optional, 'level'],
  ['colors', KINDS.onOff, 'colors'],
  ['normals', KINDS.onOff, 'normals'],
  ['sun', KINDS.vector, 'sun', 'direction'],
  ['sunlight', KINDS.onOff, 'sun', 'on'],
  ['angle', KINDS.number, 'sun', 'angle'],
  ['sky', KINDS.number, 'sky'],
  ['environment', KINDS.map, 'environment', 'map'],
  ['turn', KINDS.number, 'environment', 'turn'],
  ['bounces', KINDS.optional, 'bounces'],
  ['exposure', KINDS.number, 'exposure'],
  ['tone', KINDS.text, 'tone'],
  ['background', KINDS.text, 'background'],
  ['ground', KINDS.onOff, 'ground'],
  ['shadows', KINDS.onOff, 'shadows'],
  ['ao', KINDS.number, 'occlusion', 'samples'],
  ['aodistance', KINDS.number, 'occlusion', 'distance'],
  ['aocone', KINDS.number, 'occlusion', 'cone'],
  ['lod', KINDS.number, 'lod'],
  ['cubes', KINDS.number, 'cubes'],
  ['hatch', KINDS.onOff, 'section', 'hatch'],
  ['unit', KINDS.name, 'unit'],
  ['title', KINDS.free, 'title'],
  ['licence', KINDS.free, 'licence'],
];
/** The camera: its keys count together. @type {[keyof Camera, Kind][]} */
const CAMERA = [['eye', KINDS.vector], ['target', KINDS.vector], ['up', KINDS.vector], ['fov', KINDS.number]];

/** @param {any} settings @param {string} key @param {string} [part] */
const valueAt = (settings, key, part) => (part === undefined ? settings[key] : settings[key][part]);

/**
 * Returns the hash for settings, without '#': only what differs from `base`, the settings that the page
 * begins with. A camera that is `home` is left out.
 * @param {Settings} settings @param {Camera | null} [home] @param {Settings} [base] @returns {string}
 */
export function settingsToHash(settings, home = null, base = DEFAULTS) {
  /** @type {string[]} */
  const parts = [];
  /** @param {string} key @param {string | number} value */
  const put = (key, value) => parts.push(`${key}=${value}`);
  const { camera, section } = settings;
  if (camera ? !sameCamera(camera, base.camera ?? home) : base.camera) {
    if (!camera || sameCamera(camera, home)) put('eye', 'home');
    else for (const [key, kind] of CAMERA) put(key, /** @type {string} */ (kind.write(camera[key])));
  }
  for (const [key, kind, ...place] of SIMPLE) {
    const value = valueAt(settings, ...place);
    const written = same(value, valueAt(base, ...place)) ? null : kind.write(value);
    if (written !== null) put(key, written);
  }
  if (!same(settings.hidden, base.hidden)) put('hidden', settings.hidden.length ? settings.hidden.join(',') : 'none');
  const { box, plane } = section;
  if (!same(box, base.section.box)) put('box', box ? words(box.low, box.high) : 'none');
  if (!same(plane, base.section.plane)) put('plane', plane ? words(plane.point, plane.normal) : 'none');
  for (const [key, name, write] of LISTS) {
    if (same(settings[name], base[name])) continue;
    if (settings[name].length === 0) put(key, 'none');
    for (const element of settings[name]) put(key, write(element));
  }
  return parts.join('&');
}

/** @param {any} a @param {any} b */
const same = (a, b) => a === b || JSON.stringify(a) === JSON.stringify(b);

/** Lists: the key in a link, the key in the settings, and how an element is written. @type {[string, 'measures' | 'annotations' | 'path', (element: any) => string][]} */
const LISTS = [
  ['measure', 'measures', ({ kind, points }) => (kind === 'distance' ? '' : kind + ';') + words(...points)],
  ['note', 'annotations', ({ text, point, camera: { eye, target, up, fov } }) => `${words(point, eye, target, up)};${fov};${encodeURIComponent(text)}`],
  ['key', 'path', ({ time, eye, target, up, fov }) => `${time};${words(eye, target)}${up ? ';' + words(up) : ''}${fov === undefined ? '' : ';' + fov}`],
];

/** Readers of the other keys: each returns changes of the settings `all`. @type {{[key: string]: (value: string, all: any) => any}} */
const READERS = {
  hidden: (v) => ({ hidden: v === 'none' ? [] : v.split(',').map(toNumber) }),
  box: (v) => {
    if (v === 'none') return { section: { box: null } };
    const [low, high] = v.split(';').map(toVector);
    return { section: { box: { low, high } } };
  },
  plane: (v) => {
    if (v === 'none') return { section: { plane: null } };
    const [point, normal] = v.split(';').map(toVector);
    return { section: { plane: { point, normal } } };
  },
  measure: (v, all) => {
    const parts = v.split(';'), kind = parts[0].includes(',') ? 'distance' : parts.shift();
    return { measures: [...all.measures, { kind, points: parts.map(toVector) }] };
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
 * Reads a hash, with or without '#'; keys that it lacks have their values of `base`. A pair that is wrong is
 * left out and described in `problems`; the camera counts as one pair.
 * @param {string} hash @param {Settings} [base]
 * @returns {{settings: Settings, problems: string[]}}
 */
export function settingsFromHash(hash, base = DEFAULTS) {
  let settings = base;
  /** Lists that the hash has begun. @type {Set<string>} */
  const begun = new Set();
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
  let camera = null, isHome = false;
  for (const pair of hash.replace(/^#/, '').split('&')) {
    if (pair === '') continue;
    const at = pair.indexOf('='), key = at < 0 ? pair : pair.slice(0, at), value = at < 0 ? '' : pair.slice(at + 1);
    const ofCamera = CAMERA.find(([name]) => name === key), simple = SIMPLE.find(([name]) => name === key);
    if (key === 'eye' && value === 'home') isHome = camera = true;
    else if (ofCamera) camera = { ...camera, [key]: ofCamera[1].read(value) };
    else if (simple) {
      const [, kind, name, part] = simple;
      apply(key, () => ({ [name]: part === undefined ? kind.read(value) : { [part]: kind.read(value) } }));
    } else if (Object.hasOwn(READERS, key)) {
      const name = LISTS.find(([other]) => other === key)?.[1];
      if (name && !begun.has(name)) apply(key, () => ({ [begun.add(name) && name]: [] }));
      if (!name || value !== 'none') apply(key, () => READERS[key](value, settings));
    }
    else problems.push(`the link's "${key.slice(0, 40)}" is unknown`);
  }
  if (camera) apply('eye', () => ({ camera: isHome ? null : camera }));
  return { settings, problems };
}
