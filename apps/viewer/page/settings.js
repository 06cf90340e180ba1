/**
 * The settings of a view: their defaults, their checks, and their form as JSON, which
 * `voxdag render --view` reads too. settings_link.js writes them as a link.
 */
import { BUILT_IN } from './environment_skies.js';
import { cross, length, normalized, sub } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {{eye: Vec3, target: Vec3, up: Vec3, fov: number}} Camera  World units; vertical degrees.
 * @typedef {{low: Vec3, high: Vec3}} Box
 * @typedef {{point: Vec3, normal: Vec3}} Plane
 * @typedef {'distance' | 'path' | 'area' | 'angle' | 'height'} MeasureKind
 * @typedef {{kind: MeasureKind, points: Vec3[]}} Measure  See measures.js.
 * @typedef {{text: string, point: Vec3, camera: Camera}} Annotation
 * @typedef {{time: number, eye: Vec3, target: Vec3, up?: Vec3, fov?: number}} PathKey  Seconds.
 * @typedef {'light' | 'level' | 'steps' | 'sharing' | 'normal' | 'depth' | 'occlusion'} Show
 * @typedef {'orbit' | 'fly' | 'walk'} Mode
 * @typedef {'m' | 'cm' | 'mm' | 'in' | 'ft'} Unit
 *
 * @typedef {object} Settings
 * @property {1} version
 * @property {Camera | null} camera  Null: the view that the scene suggests.
 * @property {{direction: Vec3 | null, angle: number, on: boolean}} sun  Null: see sunDirection().
 * @property {number} sky  Factor on the light of the sky.
 * @property {{map: import('./environment.js').EnvironmentMap | null, turn: number}} environment  Null: the clear sky; degrees to the left.
 * @property {number | null} bounces  How often light is reflected; null: not at all, but surfaces occlude each other.
 * @property {number} exposure  Factor before tone mapping; 0: automatic.
 * @property {'neutral' | 'agx' | 'filmic'} tone  Curve of the tone mapping.
 * @property {'sky' | 'grey' | 'white' | 'black'} background
 * @property {boolean} ground  Whether a ground under the scene shows its shadow.
 * @property {boolean} shadows
 * @property {{samples: number, distance: number, cone: number}} occlusion
 * @property {number} lod  Pixels.
 * @property {number} cubes  Pixels.
 * @property {number | null} level  Finest level shown; null: all.
 * @property {boolean} colors
 * @property {boolean} normals
 * @property {number[]} hidden  Ids of the materials that rays pass through.
 * @property {Show} show
 * @property {{name: string, range: [number, number] | null}} channel  The channel that gives the colours, or empty; the values of the first and the last colour, null: its own.
 * @property {{box: Box | null, plane: Plane | null, hatch: boolean}} section
 * @property {Mode} mode
 * @property {string} title  Of the page; empty: the name of the scene.
 * @property {string} licence  Of the scene.
 * @property {Unit | null} unit  In which lengths are shown; null: that of the scene.
 * @property {Measure[]} measures
 * @property {Annotation[]} annotations
 * @property {PathKey[]} path
 *
 * @typedef {{[K in keyof Settings]?: Settings[K] extends any[] | null ? Settings[K]
 *   : Settings[K] extends object | null ? Partial<NonNullable<Settings[K]>> | Extract<Settings[K], null>
 *   : Settings[K]}} PartialSettings
 */

/** @type {readonly Show[]} */
export const SHOWS = ['light', 'level', 'steps', 'sharing', 'normal', 'depth', 'occlusion'];
/** The curves of render/tone_map.hpp. @type {readonly Settings['tone'][]} */
export const TONES = ['neutral', 'agx', 'filmic'];
/** @type {readonly Settings['background'][]} */
export const BACKGROUNDS = ['sky', 'grey', 'white', 'black'];
/** @type {readonly Mode[]} */
export const MODES = ['orbit', 'fly', 'walk'];
/** @type {readonly Unit[]} */
export const UNITS = ['m', 'cm', 'mm', 'in', 'ft'];
/** How many points a measure of each kind has, at least and at most. @type {{[kind in MeasureKind]: [number, number]}} */
export const MEASURE_POINTS = { distance: [2, 2], path: [2, 1000], area: [3, 1000], angle: [3, 3], height: [2, 2] };

/** @type {Settings} */
export const DEFAULTS = {
  version: 1,
  camera: null,
  sun: { direction: null, angle: 0.53, on: true },
  sky: 1,
  environment: { map: null, turn: 0 },
  bounces: null,
  exposure: 0,
  tone: 'neutral',
  background: 'sky',
  ground: true,
  shadows: true,
  occlusion: { samples: 64, distance: 0, cone: 0 },
  lod: 1,
  cubes: 24,
  level: null,
  colors: true,
  normals: true,
  hidden: [],
  show: 'light',
  channel: { name: '', range: null },
  section: { box: null, plane: null, hatch: true },
  mode: 'orbit',
  title: '',
  licence: '',
  unit: null,
  measures: [],
  annotations: [],
  path: [],
};

/** Changes that remove what belongs to one scene: light and picture stay. @type {PartialSettings} */
export const NO_PLACES = {
  camera: null, sun: { direction: null }, occlusion: { distance: 0 }, level: null, channel: { name: '', range: null }, section: { box: null, plane: null }, mode: 'orbit',
  title: '', licence: '', unit: null, measures: [], annotations: [], path: [],
};

/** Returns from which size in pixels voxels look like cubes: of a file whose voxels are cubes always, unless the settings differ from the default. @param {Settings} settings @param {{cubes: boolean} | null} info */
export const shownCubes = (settings, info) => (info?.cubes && settings.cubes === DEFAULTS.cubes ? 0 : settings.cubes);

/** Settings that are wrong. The message names the key and what is allowed. */
export class SettingsError extends Error {
  /** @param {string} reason @param {string} [key]  Of the value that is wrong, if it is one value. */
  constructor(reason, key) {
    super(key === undefined ? reason : `"${key}" ${reason}`);
    this.reason = reason;
  }
}

/**
 * A check returns the value to store, or throws SettingsError with the key. `before` is the value
 * in force; `ignored` collects unknown keys.
 * @typedef {(value: any, key: string, before: any, ignored: string[]) => any} Check
 */

/** @param {string} key @param {string} what @returns {never} */
function refuse(key, what) {
  throw new SettingsError(what, key);
}

/** @param {number} least @param {number} most @returns {Check} */
const number = (least, most) => (value, key) => {
  if (typeof value !== 'number' || !Number.isFinite(value)) refuse(key, 'is not a number');
  if (value < least || value > most) refuse(key, `is ${value}; allowed are ${least} to ${most}`);
  return value;
};

/** @param {number} least @param {number} most @returns {Check} */
const integer = (least, most) => (value, key) => {
  if (!Number.isInteger(value)) refuse(key, 'is not a whole number');
  return number(least, most)(value, key, null, []);
};

/** @type {Check} */
const boolean = (value, key) =>
  typeof value === 'boolean' ? value : refuse(key, 'is not true or false');

/** @param {number} most  Characters. @returns {Check} */
const text = (most) => (value, key) => {
  if (typeof value !== 'string') refuse(key, 'is not a text');
  return value.length > most ? refuse(key, `has more than ${most} characters`) : value;
};

/** @type {Check} */
const vector = (value, key) => {
  const limit = 1e30;  // so that squares of lengths are finite
  if (!Array.isArray(value) || value.length !== 3 || !value.every(Number.isFinite))
    refuse(key, 'is not an array of three numbers');
  if (value.some((x) => Math.abs(x) > limit)) refuse(key, 'is too large');
  return [value[0], value[1], value[2]];
};

/** @type {Check} */
const direction = (value, key) => {
  const v = vector(value, key, null, []);
  return length(v) > 0 ? v : refuse(key, 'is zero; it must be a direction');
};

/** @param {readonly string[]} names @returns {Check} */
const oneOf = (names) => (value, key) =>
  names.includes(value) ? value : refuse(key, `is not one of ${names.join(', ')}`);

/** @param {Check} check @returns {Check} */
const orNull = (check) => (value, key, before, ignored) =>
  value === null ? null : check(value, key, before, ignored);

/** @param {Check} check @param {number} most @returns {Check} */
const list = (check, most) => (value, key, _, ignored) => {
  if (!Array.isArray(value)) refuse(key, 'is not an array');
  if (value.length > most) refuse(key, `has more than ${most} elements`);
  return value.map((element, i) => check(element, `${key}[${i}]`, null, ignored));
};

/**
 * Checks an object. Fields that the value lacks keep the value before, or the default.
 * @param {{[key: string]: Check}} fields
 * @param {{[key: string]: any}} [defaults]  Of fields that may be missing if there is none before.
 * @param {(value: any, key: string) => any} [finish]  Checks the whole object.
 * @returns {Check}
 */
const record = (fields, defaults = {}, finish = (value) => value) => (value, key, before, ignored) => {
  if (typeof value !== 'object' || value === null || Array.isArray(value))
    refuse(key || 'settings', 'is not an object');
  const prefix = key ? key + '.' : '';
  /** @type {{[key: string]: any}} */
  const result = { ...defaults, ...before };
  for (const [name, part] of Object.entries(value)) {
    if (part === undefined) continue;
    if (Object.hasOwn(fields, name))
      result[name] = fields[name](part, prefix + name, result[name], ignored);
    else ignored.push(prefix + name);
  }
  for (const name of Object.keys(fields))
    if (!(name in result) && !(name in defaults)) refuse(prefix + name, 'is missing');
  return finish(result, key);
};

/** Checks an object whose fields are all replaced. @type {typeof record} */
const whole = (fields, defaults, finish) => (value, key, _, ignored) =>
  record(fields, defaults, finish)(value, key, null, ignored);

const MOST_FLOAT = 2 ** 128 - 2 ** 104;

/** The field of view: below the least, pixels no longer have distinct directions. */
const LEAST_FOV = 1e-6, MOST_FOV = 179;

/** @param {Camera} camera @param {string} key */
function checkView(camera, key) {
  const forward = sub(camera.target, camera.eye);
  if (!(length(forward) > 0)) refuse(key, 'has eye and target at one point');
  if (!(length(cross(normalized(forward), normalized(camera.up))) > 1e-6))
    refuse(key + '.up', 'points along the view');
  return camera;
}

const cameraFields = { eye: vector, target: vector, up: direction, fov: number(LEAST_FOV, MOST_FOV) };
const cameraDefaults = { up: [0, 1, 0], fov: 40 };

/** @param {Box} box @param {string} key */
const checkBox = (box, key) =>
  box.low.every((x, i) => x <= box.high[i]) ? box : refuse(key, 'has a low corner above its high corner');

const pathKey = whole(
  { time: number(-1e9, 1e9), eye: vector, target: vector, up: direction, fov: number(LEAST_FOV, MOST_FOV) },
  { up: undefined, fov: undefined },
  (key, name) => {
    for (const optional of ['up', 'fov']) if (key[optional] === undefined) delete key[optional];
    return length(sub(key.target, key.eye)) > 0 ? key : refuse(name, 'has eye and target at one point');
  });

/** Checks a measure; { from, to } of older files is a distance. @type {Check} */
const measure = (value, key, _, ignored) => {
  if (value && 'from' in Object(value)) {
    const { from, to } = whole({ from: vector, to: vector })(value, key, null, ignored);
    return { kind: 'distance', points: [from, to] };
  }
  const found = whole({ kind: oneOf(Object.keys(MEASURE_POINTS)), points: list(vector, 1000) }, { kind: 'distance' })(value, key, null, ignored);
  const [least, most] = MEASURE_POINTS[/** @type {MeasureKind} */ (found.kind)], { length: count } = found.points;
  return count >= least && count <= most ? found : refuse(`${key}.points`, `has ${count} points; a measure of kind ${found.kind} has ${least}${most > least ? ' or more' : ''}`);
};

/** Checks the ends of a scale, which are in the range of floats. @type {Check} */
const range = (value, key) =>
  Array.isArray(value) && value.length === 2 && value.every((x) => typeof x === 'number' && Math.abs(x) <= MOST_FLOAT) && value[0] < value[1] ? [...value] : refuse(key, 'is not an array of two numbers in the range of floats, the smaller one first');

/** @type {Check} */
const path = (value, key, _, ignored) => {
  const keys = list(pathKey, 10000)(value, key, null, ignored);
  for (let i = 1; i < keys.length; ++i)
    if (!(keys[i].time > keys[i - 1].time))
      refuse(`${key}[${i}].time`, 'is not greater than the time of the key before');
  return keys;
};

/** The side of an environment's map, at most. */
const MOST_MAP_SIDE = 512;

/** Checks an environment: the name of a built-in one, or a map. @type {Check} */
const environmentMap = (value, key, _, ignored) => {
  if (typeof value === 'string') return oneOf(Object.keys(BUILT_IN))(value, key, null, ignored);
  const map = whole({ name: text(200), side: integer(2, MOST_MAP_SIDE), texels: text(MOST_MAP_SIDE ** 2 * 6), sun: vector, towards: vector })(value, key, null, ignored);
  const bytes = 4 * map.side ** 2;
  if (!/^[A-Za-z0-9+/]*={0,2}$/.test(map.texels) || map.texels.length !== 4 * Math.ceil(bytes / 3)) refuse(`${key}.texels`, `is not the base64 of ${bytes} bytes`);
  return map.sun.some((/** @type {number} */ x) => x < 0) ? refuse(`${key}.sun`, 'is negative') : map;
};

/** @type {Check} */
const settingsCheck = record({
  version: (value) => (value === 1 ? 1 : refuse('version', `is ${value}; this viewer reads version 1`)),
  camera: orNull(record(cameraFields, cameraDefaults, checkView)),
  sun: record({ direction: orNull(direction), angle: number(0, 89), on: boolean }),
  sky: number(0, 1000),
  environment: record({ map: orNull(environmentMap), turn: number(-360, 360) }),
  bounces: orNull(integer(0, 64)),
  exposure: number(0, 1e6),
  tone: oneOf(TONES),
  background: oneOf(BACKGROUNDS),
  ground: boolean,
  shadows: boolean,
  occlusion: record({ samples: integer(0, 4096), distance: number(0, 1e30), cone: number(0, 12.6) }),
  lod: number(0, 1000),
  cubes: number(0, 1e6),
  level: orNull(integer(0, 32)),
  colors: boolean,
  normals: boolean,
  hidden: list(integer(0, 65534), 65535),
  show: oneOf(SHOWS),
  channel: record({ name: text(63), range: orNull(range) }),
  section: record({
    box: orNull(whole({ low: vector, high: vector }, {}, checkBox)),
    plane: orNull(whole({ point: vector, normal: direction })),
    hatch: boolean,
  }),
  mode: oneOf(MODES),
  title: text(200),
  licence: text(500),
  unit: orNull(oneOf(UNITS)),
  measures: list(measure, 10000),
  annotations: list(
    whole({ text: text(2000), point: vector, camera: whole(cameraFields, cameraDefaults, checkView) }), 10000),
  path,
});

/**
 * Returns `settings` with the values of `changes`. Objects are merged key by key; lists, boxes and
 * planes are replaced. Throws SettingsError for values that are wrong. Appends keys that are
 * unknown to `ignored`.
 * @param {Settings} settings @param {PartialSettings} changes @param {string[]} [ignored]
 * @returns {Settings}
 */
export function mergeSettings(settings, changes, ignored = []) {
  return settingsCheck(changes, '', settings, ignored);
}

/**
 * Returns the settings of a JSON text; keys that are missing have their defaults.
 * @param {string} json @param {string[]} [ignored] @returns {Settings}
 */
export function settingsFromJson(json, ignored = []) {
  let value;
  try {
    value = JSON.parse(json);
  } catch (error) {
    throw new SettingsError(`not JSON: ${/** @type {Error} */ (error).message}`);
  }
  return mergeSettings(DEFAULTS, value, ignored);
}

/** Returns the settings as JSON, with arrays of numbers on one line each. @param {Settings} settings */
export function settingsToJson(settings) {
  return JSON.stringify(settings, null, 2).replace(/\[\s+(-?[\d.e+-]+(?:,\s+-?[\d.e+-]+)*)\s+\]/g,
    (_, numbers) => '[' + numbers.replace(/\s+/g, ' ') + ']') + '\n';
}

/** Returns whether two cameras have the same numbers. @param {Camera | null} a @param {Camera | null} b */
export const sameCamera = (a, b) => a === b || JSON.stringify(a) === JSON.stringify(b);
