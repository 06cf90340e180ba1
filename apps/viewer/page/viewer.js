/** The viewer: a canvas that shows a scene. docs/viewer.md tells how to embed it. */
import { CHANNELS } from './constants.js';
import { Events } from './events.js';
import { capture } from './gpu/capture.js';
import { shownRange } from './gpu/color_scale.js';
import { Pacer } from './gpu/pacer.js';
import { PictureSchedule, STILL_SAMPLES } from './gpu/picture_schedule.js';
import { Renderer, loadShaders } from './gpu/renderer.js';
import { framedCamera } from './hands/pose.js';
import { directionThrough } from './lens.js';
import { SceneArrival } from './scene_arrival.js';
import { castInSection } from './section_ray.js';
import { DEFAULTS, NO_PLACES, mergeSettings, settingsFromJson, shownCubes } from './settings.js';
import { cast, contains } from './trace.js';

/**
 * @typedef {import('./viewer_types.js').Viewer} Viewer
 * @typedef {import('./viewer_types.js').Statistics} Statistics
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {import('./settings.js').PartialSettings} PartialSettings
 * @typedef {import('./settings.js').Camera} Camera
 * @typedef {import('./gpu/renderer.js').Shot} Shot
 * @typedef {import('./math.js').Vec3} Vec3
 */

/** Pixels of the picture per CSS pixel, at most: more would cost more than they show. */
const MOST_PIXEL_RATIO = 2;
/** The camera before the scene is known. @type {Camera} */
const ANY_CAMERA = { eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 40 };

/**
 * Makes a viewer in a container, and begins to load a scene: from `url`, from `bytes`, or the one
 * that the page holds itself. An `empty` viewer waits for open(). Failures are 'error' events { title, text, kind }.
 * @param {{container: HTMLElement, url?: string, bytes?: BlobPart, settings?: PartialSettings, empty?: boolean}} options
 * @returns {Viewer}
 */
export function createViewer(options) {
  return new CanvasViewer(options);
}

/** @param {unknown} error */
const messageOf = (error) => (error instanceof Error ? error.message : String(error));

/** @implements {Viewer} */
class CanvasViewer extends Events {
  /** @param {Parameters<typeof createViewer>[0]} options */
  constructor({ container, url, bytes, settings, empty = false }) {
    super();
    this.canvas = document.createElement('canvas');
    this.canvas.className = 'voxdag-canvas';
    this.canvas.style.cssText = 'display:block;width:100%;height:100%;touch-action:none';
    this.canvas.tabIndex = 0;
    container.append(this.canvas);
    this.container = container;
    /** @type {Settings} */
    this.settings = mergeSettings(DEFAULTS, settings ?? {});
    /** @type {WebGL2RenderingContext | null} */
    this.gl = null;
    /** @type {Map<string, string>} */
    this.shaders = new Map();
    /** @type {SceneArrival | null} */
    this.arrival = null;
    /** @type {Renderer | null} */
    this.renderer = null;
    /** @type {PictureSchedule | null} */
    this.pictures = null;
    this.pacer = new Pacer();
    /** The name of the file that was opened on this computer. @type {string | null} */
    this.file = null;
    this.hasFailed = false;
    this.isLost = false;
    this.isDestroyed = false;
    this.frameRequest = 0;
    /** @type {(() => void)[]} */
    this.stillWaiters = [];
    this.observer = new ResizeObserver(() => this.#resize());
    this.observer.observe(container);
    this.canvas.addEventListener('webglcontextlost', (event) => this.#onLost(event));
    this.canvas.addEventListener('webglcontextrestored', () => this.#onRestored());
    // Later, so that the caller can add handlers first.
    this.started = Promise.resolve().then(() => this.#start(url, bytes, empty)).catch((error) => this.#fail('The viewer cannot start', messageOf(error)));
  }

  /** @param {string | undefined} url @param {BlobPart | undefined} bytes @param {boolean} empty */
  async #start(url, bytes, empty) {
    const gl = this.canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false, stencil: false, powerPreference: 'high-performance' });
    if (gl === null)
      return this.#fail('This browser has no WebGL 2', 'Turn on hardware acceleration, or use a current version of Chrome, Edge, Firefox or Safari.', 'webgl');
    this.gl = gl;
    this.shaders = await loadShaders();
    if (this.isDestroyed) return;
    this.#prepare(gl);
    this.#resize();
    if (empty) return;
    this.arrival = new SceneArrival(gl, () => this.#aspect(), (event, ...values) => this.#report(event, ...values));
    await this.arrival.open({ url, bytes });
  }

  /**
   * Shows the scene of a file of this computer in place of the present one: a .vdag file, or a page that holds one.
   * Throws Error if the file is of another kind or broken; then the present scene stays.
   * @param {File} file @param {{keepsPlaces?: boolean}} [options]  `keepsPlaces`: camera, section, measures and notes stay.
   * @returns {Promise<void>}  Until the file's header is read.
   */
  async open(file, { keepsPlaces = false } = {}) {
    await this.started;
    const { gl } = this;
    if (gl === null || this.isDestroyed) throw new Error('there is no picture');
    return new Promise((resolve, reject) => {
      const arrival = new SceneArrival(gl, () => this.#aspect(), (event, ...values) => {
        if (this.arrival === arrival) return this.#report(event, ...values);
        if (event === 'error') {
          arrival.close();
          reject(new Error(`${values[0].title}. ${values[0].text}`));
        } else if (event === 'begin') {
          try {
            this.#replace(arrival, file.name, keepsPlaces ? {} : values[0] === null ? NO_PLACES : settingsFromJson(values[0]));
            resolve();
          } catch (error) {
            arrival.close();
            reject(error);
          }
        }
      });
      arrival.open({ file }).catch(reject);
    });
  }

  /**
   * Leaves a scene for another. Settings of its places go; those of light and picture stay, unless the new scene has settings.
   * @param {SceneArrival} arrival @param {string} name @param {PartialSettings} settings
   */
  #replace(arrival, name, settings) {
    this.arrival?.close();
    this.arrival = arrival;
    this.file = name;
    this.hasFailed = false;
    this.emit('opened', name);
    this.set(settings, 'file');
  }

  /** Returns the file of the scene. @returns {Promise<Blob>} */
  async scene() {
    if (this.arrival === null) throw new Error('there is no scene');
    return this.arrival.source();
  }

  /** Makes what a graphics card needs, for the first time or after it was lost. @param {WebGL2RenderingContext} gl */
  #prepare(gl) {
    this.renderer = new Renderer(gl, this.shaders);
    this.renderer.warmUp();
    this.pictures = new PictureSchedule(this.renderer, this.canvas, this.pacer);
  }

  /** @param {string} title @param {string} text @param {string} [kind]  'webgl', 'network' or 'file'. */
  #fail(title, text, kind = 'file') {
    this.hasFailed = true;
    this.arrival?.end();
    this.emit('error', { title, text, kind });
    this.#endWaits();
  }

  /** Passes an event of the arriving scene on. @param {string} event @param {...any} values */
  #report(event, ...values) {
    if (this.isDestroyed) return;
    this.emit(event, ...values);
    if (event === 'info' || event === 'level' || event === 'look' || event === 'channel') this.#touch(false);
    if (event === 'info' || event === 'look') this.#showChannel(event === 'info');
    if (event === 'level' && this.settings.show === 'sharing') this.arrival?.showInstances();
    if (event === 'loaded') this.#wake();
    if (event === 'error') this.#endWaits();
  }

  get info() {
    return this.arrival?.info ?? null;
  }

  // ---- settings

  get() {
    return this.settings;
  }
  /** @param {PartialSettings} changes @param {string} [by] */
  set(changes, by = 'program') {
    const before = this.settings.channel.name;
    this.settings = mergeSettings(this.settings, changes);
    this.#showChannel(this.settings.channel.name !== before);
    if (this.settings.show === 'sharing') this.arrival?.showInstances();
    this.emit('settings', this.settings, by);
    this.#touch(true);
  }

  /** Loads the channel that the settings name. @param {boolean} isNew  Whether to say that there is none. */
  #showChannel(isNew) {
    const { name } = this.settings.channel, { info } = this;
    if (isNew && name && info && !(info.isWhole && info.channels.some((channel) => channel.name === name)))
      this.emit('note', info.isWhole ? `This scene has no channel ${name}.` : 'Channels are not shown: this scene is too large for the graphics card.');
    this.arrival?.show(name);
  }

  #aspect() {
    return this.canvas.width / Math.max(1, this.canvas.height);
  }

  /** Returns the camera that is in force. @returns {Camera} */
  camera() {
    return this.settings.camera ?? this.info?.view ?? ANY_CAMERA;
  }

  /** Shows the whole scene from the present direction. */
  frame() {
    if (this.info !== null) this.set({ camera: framedCamera(this.camera(), this.info.bounds, this.#aspect()) }, 'frame');
  }

  // ---- rays on the CPU

  /** @param {Vec3} origin @param {Vec3} direction @param {number} [most] */
  castNow(origin, direction, most = Infinity) {
    return this.#cast(origin, direction, most, Infinity);
  }
  /** @param {import('./viewer_types.js').Hit} hit */
  material(hit) {
    return this.arrival?.memory?.material(hit.voxel, hit.level) ?? null;
  }
  channel() {
    const shown = this.arrival?.textures?.shownChannel(this.settings)?.of;
    return shown ? { name: shown.name, values: shown.range, range: this.settings.channel.range ?? shown.range, colors: CHANNELS.colors } : null;
  }
  /** @param {import('./viewer_types.js').Hit} hit */
  channelValue(hit) {
    return this.channel() && (this.arrival?.memory?.channelValue(hit.voxel, hit.level) ?? null);
  }
  materialCounts() {
    return this.arrival?.memory?.materialCounts() ?? null;
  }
  /** @param {Vec3} point */
  contains(point) {
    const dag = this.arrival?.memory?.dag();
    if (dag === undefined || !contains(dag, point)) return false;
    const { hidden } = this.settings, voxel = /** @type {Vec3} */ (point.map((x, a) => Math.floor((x - dag.origin[a]) / dag.voxelSize)));
    return hidden.length === 0 || !hidden.includes(this.arrival?.memory?.material(voxel, dag.shown) ?? -1);
  }
  /** @param {number} x @param {number} y @param {number} [root] */
  async pick(x, y, root) {
    const camera = this.camera();
    const direction = directionThrough(camera, x, y, this.canvas.clientWidth, this.canvas.clientHeight);
    return this.#cast(camera.eye, direction, Infinity, this.settings.level ?? Infinity, root);
  }
  /** @param {Vec3} origin @param {Vec3} direction @param {number} most @param {number} level  The finest that counts. @param {number} [root] */
  #cast(origin, direction, most, level, root) {
    const dag = this.arrival?.memory?.dag();
    if (dag === undefined) return null;
    const shown = { ...dag, root: root ?? dag.root, shown: Math.min(dag.shown, level) }, { hidden } = this.settings, { memory } = this.arrival ?? {};
    const isLeftOut = hidden.length && memory
      ? (/** @type {Vec3} */ voxel, /** @type {number} */ at) => hidden.includes(memory.material(voxel, at) ?? -1) : null;
    return castInSection(this.settings.section, origin, direction, most, (from, along, end) => cast(shown, from, along, end, isLeftOut));
  }

  // ---- edits

  /**
   * Lets `act` change the scene in memory and textures, and draws it.
   * @param {(memory: import('./scene_memory.js').SceneMemory, textures: import('./gpu/scene_textures.js').SceneTextures) => void} act
   * @param {boolean} goesOn  Whether more changes follow soon.
   */
  change(act, goesOn) {
    const { memory, textures } = this.arrival ?? {};
    if (!memory || !textures) return;
    act(memory, textures);
    if (!goesOn) this.arrival?.measure();
    this.#touch(goesOn);
    this.emit('edited');
  }

  // ---- pictures

  /** Begins a new picture. @param {boolean} isMoving  Whether the view may go on changing. */
  #touch(isMoving) {
    this.pictures?.touch(isMoving);
    this.#wake();
  }

  #wake() {
    if (this.frameRequest !== 0 || this.isDestroyed) return;
    this.frameRequest = requestAnimationFrame(() => {
      this.frameRequest = 0;
      try {
        this.#tick();
      } catch (error) {
        this.#fail('The picture cannot be drawn', messageOf(error));
      }
    });
  }

  #tick() {
    const { pictures, arrival } = this;
    if (pictures === null || arrival === null || this.isLost) return;
    if (arrival.shown < 1) {
      if (arrival.hasEnded) this.#endWaits();
      return;
    }
    if (pictures.render((quick) => this.shot(quick))) this.emit('frame', this.statistics());
    if (!pictures.isFinished || !arrival.hasEnded) return this.#wake();
    this.emit('still');
    this.#endWaits();
  }

  #resize() {
    const ratio = Math.min(globalThis.devicePixelRatio || 1, MOST_PIXEL_RATIO);
    const width = Math.max(1, Math.round(this.container.clientWidth * ratio)), height = Math.max(1, Math.round(this.container.clientHeight * ratio));
    if (width === this.canvas.width && height === this.canvas.height) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.arrival?.fit();
    this.pictures?.redraw();
    this.#touch(true);
    this.emit('resize', { width, height });
  }

  /** Returns what a picture shows now. @param {boolean} quick @param {number} [samples] @returns {Shot} */
  shot(quick, samples = STILL_SAMPLES) {
    const { memory, textures } = this.arrival ?? {};
    if (!memory || !textures || memory.shown < 1) throw new Error('there is no scene');
    const { origin, voxelSize, resolution, home } = memory.info;
    const bounds = this.info?.bounds ?? { low: origin, high: origin };
    return {
      settings: { ...this.settings, camera: this.camera(), cubes: shownCubes(this.settings, memory.info) },
      place: { origin, side: voxelSize * resolution, bounds, home },
      scene: textures, shown: memory.shown, mostInstances: memory.mostInstances, samples, quick,
    };
  }

  shownRange() {
    const { memory } = this.arrival ?? {};
    return memory ? shownRange(this.settings.show, memory.info.levels, memory.mostInstances) : null;
  }

  /** @returns {Statistics} */
  statistics() {
    const { arrival, pictures, info } = this;
    const levelsLoaded = arrival?.shown ?? 0;
    return {
      levelsLoaded, levelsShown: Math.min(levelsLoaded, this.settings.level ?? Infinity),
      bytesLoaded: arrival?.bytesLoaded ?? 0, fileBytes: info?.fileBytes ?? 0,
      frameMs: 0, raysPerFrame: 0, stepsPerRay: 0, samples: 0, samplesWanted: STILL_SAMPLES, scale: 1, ...pictures?.numbers,
      gpuBytes: (arrival?.textures?.bytes() ?? 0) + (pictures?.bytes() ?? 0),
    };
  }

  /** Waits for the finished picture; until a failure if there will be none. @returns {Promise<void>} */
  whenStill() {
    if (this.isDestroyed || this.hasFailed || (this.pictures?.isFinished && this.arrival?.hasEnded)) return Promise.resolve();
    this.#wake();
    return new Promise((resolve) => this.stillWaiters.push(resolve));
  }
  #endWaits() {
    for (const resolve of this.stillWaiters.splice(0)) resolve();
  }

  /**
   * Renders a picture in full quality, as PNG, once the scene has arrived.
   * @param {Parameters<Viewer['capture']>[0]} [options]
   */
  async capture({ width = this.canvas.width, height = this.canvas.height, samples = STILL_SAMPLES, camera, ...job } = {}) {
    await this.started;
    await this.arrival?.ended;
    if (this.renderer === null || this.isLost || this.isDestroyed) throw new Error('there is no scene');
    const shot = this.shot(false, samples);
    if (camera) shot.settings.camera = camera;
    return capture(this.renderer, this.pacer, shot, width, height, job);
  }

  /** For tests: the cells that the pixels' rays hit, 4 numbers each, rows from the bottom; see hits.glsl. @param {number} width @param {number} height */
  hits(width, height) {
    return /** @type {Renderer} */ (this.renderer).hits(this.shot(false), width, height);
  }

  // ---- the graphics card

  /** @param {Event} event */
  #onLost(event) {
    if (this.isDestroyed) return;
    event.preventDefault();  // else the browser never restores it
    this.isLost = true;
    this.emit('lost');
  }

  #onRestored() {
    if (this.gl === null || this.isDestroyed) return;
    try {
      this.#prepare(this.gl);
      this.arrival?.restore();
      if (this.settings.show === 'sharing') this.arrival?.showInstances();
    } catch (error) {
      return this.#fail('The graphics card was lost', messageOf(error), 'webgl');
    }
    this.isLost = false;
    this.emit('restored');
    this.#touch(false);
  }

  destroy() {
    this.isDestroyed = true;
    if (this.frameRequest !== 0) cancelAnimationFrame(this.frameRequest);
    this.arrival?.close();
    this.observer.disconnect();
    this.gl?.getExtension('WEBGL_lose_context')?.loseContext();
    this.canvas.remove();
    this.handlers.clear();
    this.#endWaits();
  }
}
