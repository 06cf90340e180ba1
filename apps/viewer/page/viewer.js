/** The viewer: a canvas that shows a scene. See docs/viewer.md for how to embed it. */
import { LIGHT } from './constants.js';
import { inlineScene } from './file/byte_source.js';
import { SceneLoader } from './file/scene_loader.js';
import { Pacer } from './gpu/pacer.js';
import { Picture } from './gpu/picture.js';
import { Renderer, loadShaders } from './gpu/renderer.js';
import { SceneTextures } from './gpu/scene_textures.js';
import { directionThrough } from './hands/pose.js';
import { DEFAULTS, mergeSettings } from './settings.js';
import { SceneMemory } from './scene_memory.js';
import { castInSection } from './section_ray.js';
import { bounds, cast, contains } from './trace.js';
import { defaultView } from './default_view.js';

/** @typedef {import('./viewer_types.js').Viewer} Viewer */
/** @typedef {import('./viewer_types.js').SceneInfo} SceneInfo */
/** @typedef {import('./viewer_types.js').Statistics} Statistics */
/** @typedef {import('./settings.js').Settings} Settings */
/** @typedef {import('./gpu/renderer.js').Shot} Shot */
/** @typedef {import('./math.js').Vec3} Vec3 */

/** View samples per pixel of a still picture. */
export const STILL_SAMPLES = 16;
/** A view is still if it has not changed for this time, in milliseconds. */
const REST_MS = 120;
const MOST_PIXEL_RATIO = 2;
/** Levels of which the scene's bounds are taken. */
const BOUNDS_LEVEL = 9;

/**
 * Makes a viewer in a container, and begins to load a scene: from `url`, from `bytes`, or the one
 * that the page holds itself. Failures are 'error' events {title, text}.
 * @param {{container: HTMLElement, url?: string, bytes?: ArrayBuffer, settings?: import('./settings.js').PartialSettings}} options
 * @returns {Viewer}
 */
export function createViewer(options) {
  return new CanvasViewer(options);
}

/** Returns the scale of the next finer picture. @param {number} scale */
function finerScale(scale) {
  return scale < 0.4 ? 2 * scale : 1;
}

/** @implements {Viewer} */
class CanvasViewer {
  /** @param {Parameters<typeof createViewer>[0]} options */
  constructor({ container, url, bytes, settings }) {
    this.canvas = document.createElement('canvas');
    this.canvas.className = 'voxdag-canvas';
    this.canvas.style.cssText = 'display:block;width:100%;height:100%;touch-action:none';
    this.canvas.tabIndex = 0;
    container.append(this.canvas);
    this.container = container;
    /** @type {Map<string, Set<(...values: any[]) => void>>} */
    this.handlers = new Map();
    /** @type {Settings} */
    this.settings = mergeSettings(DEFAULTS, settings ?? {});
    /** @type {SceneInfo | null} */
    this.info = null;
    /** @type {SceneMemory | null} */
    this.memory = null;
    /** @type {SceneTextures | null} */
    this.textures = null;
    /** @type {Renderer | null} */
    this.renderer = null;
    /** @type {Map<string, string>} */
    this.shaders = new Map();
    /** @type {WebGL2RenderingContext | null} */
    this.gl = null;
    this.pacer = new Pacer();
    /** @type {Picture | null} */
    this.quick = null;
    /** @type {Picture | null} */
    this.full = null;
    /** @type {Picture | null} */
    this.shownPicture = null;
    /** @type {{sync: WebGLSync, begin: number, isMoving: boolean, pixels: number} | null} */
    this.pending = null;
    this.exposure = 0;
    this.lastExposure = 0;
    this.isFinal = false;  // the exposure is that of the finished picture
    this.changedAt = 0;
    this.version = 0;      // counts changes of the picture
    this.quickVersion = -1;
    this.fullVersion = -1;
    this.fullScale = 1;    // of the picture that is being refined; doubles until it is 1
    this.isStill = false;
    this.isLoaded = false;
    this.isLost = false;
    this.isDestroyed = false;
    /** @type {(() => void)[]} */
    this.stillWaiters = [];
    /** @type {Statistics} */
    this.stats = { levelsLoaded: 0, levelsShown: 0, bytesLoaded: 0, fileBytes: 0, frameMs: 0, raysPerFrame: 0, stepsPerRay: 0, samples: 0, samplesWanted: STILL_SAMPLES, scale: 1, gpuBytes: 0 };
    this.requestedFrame = 0;
    this.loader = new SceneLoader((message) => this.onMessage(message));
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(container);
    this.canvas.addEventListener('webglcontextlost', (event) => this.onLost(event));
    this.canvas.addEventListener('webglcontextrestored', () => this.onRestored());
    // Handlers that the caller sets now hear of all that happens from here on.
    queueMicrotask(() => this.start(url, bytes).catch((error) => this.fail('The viewer cannot start', String(error?.message ?? error))));
  }

  /** @param {string | undefined} url @param {ArrayBuffer | undefined} bytes */
  async start(url, bytes) {
    this.gl = this.canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false, stencil: false, powerPreference: 'high-performance' });
    if (this.gl === null) return this.fail('This browser shows no WebGL 2', 'Turn on hardware acceleration, or use a current version of Chrome, Edge, Firefox or Safari.', 'webgl');
    this.shaders = await loadShaders();
    if (this.isDestroyed) return;
    this.renderer = new Renderer(this.gl, this.shaders);
    this.renderer.warmUp();
    this.resize();
    if (url === undefined && bytes === undefined) bytes = (await inlineScene()) ?? undefined;
    await this.loader.open(bytes !== undefined ? { bytes } : { url: url ?? 'scene.vdag' });
  }

  /** @param {string} title @param {string} text @param {string} [kind] */
  fail(title, text, kind = 'file') {
    this.isLoaded ||= this.memory === null;
    this.emit('error', { title, text, kind });
    for (const wake of this.stillWaiters.splice(0)) wake();
  }

  // ---- events

  /** @param {string} event @param {(...values: any[]) => void} handler */
  on(event, handler) {
    const set = this.handlers.get(event) ?? new Set();
    this.handlers.set(event, set.add(handler));
  }
  /** @param {string} event @param {(...values: any[]) => void} handler */
  off(event, handler) {
    this.handlers.get(event)?.delete(handler);
  }
  /** @param {string} event @param {...any} values */
  emit(event, ...values) {
    for (const handler of [...(this.handlers.get(event) ?? [])]) handler(...values);
  }

  // ---- the scene

  /** @param {import('./file/scene_loader.js').LoaderMessage} message */
  onMessage(message) {
    if (this.isDestroyed || this.gl === null) return;
    if (message.type === 'info') return this.onInfo(message.info, message.bytes);
    if (message.type === 'error') {
      this.isLoaded = true;
      return this.fail(message.title, message.text, message.title === 'No connection' ? 'network' : 'file');
    }
    if (message.type === 'progress') {
      this.stats.bytesLoaded = message.bytes;
      this.emit('progress', { bytes: message.bytes, total: this.info?.fileBytes ?? 0 });
    } else if (message.type === 'note') {
      this.emit('note', message.text);
    } else if (message.type === 'done') {
      this.isLoaded = true;
      this.emit('loaded', { requests: message.requests });
      this.wake();
    } else if (this.memory !== null && this.textures !== null && message.type !== 'loaded') {
      this.memory.add(message, this.textures);
      const { info, shown } = this.memory;
      this.stats.levelsLoaded = shown;
      if (message.type !== 'attributes' && this.info !== null) {
        this.info.bounds = bounds(this.memory.dag(), BOUNDS_LEVEL) ?? this.info.bounds;
        this.info.view = defaultView(this.info.bounds, this.aspect());
        this.emit('level', { level: shown, levels: info.levels, bytes: this.stats.bytesLoaded });
      } else {
        this.emit('look', {});
      }
      if (this.settings.show === 'sharing') this.textures.setInstances(this.memory.nodeInstances, this.memory.leafInstances);
      this.touch(false);
    }
  }

  /** @param {import('./file/scene_loader.js').FileInfo} info @param {number} bytes */
  onInfo(info, bytes) {
    const gl = /** @type {WebGL2RenderingContext} */ (this.gl);
    this.memory = new SceneMemory(gl, info);
    this.textures = new SceneTextures(gl, info, this.memory.finest);
    const side = info.voxelSize * info.resolution;
    const box = { low: info.origin, high: /** @type {Vec3} */ (info.origin.map((x) => x + side)) };
    this.info = {
      name: info.source.name, levels: info.levels, resolution: info.resolution, origin: info.origin, voxelSize: info.voxelSize, bounds: box,
      voxels: info.voxels, dagNodesPerLevel: info.dagNodesPerLevel, fileBytes: info.fileBytes, hasColors: info.hasColors, hasNormals: info.hasNormals,
      source: info.source, view: defaultView(box, this.aspect()),
    };
    this.stats.fileBytes = info.fileBytes;
    this.stats.bytesLoaded = bytes;
    this.emit('info', this.info);
    if (this.memory.finest < info.levels)
      this.emit('note', `This scene is too large for the graphics card: it is shown down to level ${this.memory.finest} of ${info.levels}.`);
    this.loader.load({ shown: this.memory.finest, colors: info.hasColors && this.memory.finest === info.levels, normals: info.hasNormals && this.memory.finest === info.levels });
    this.touch(false);
  }

  // ---- settings

  get() {
    return this.settings;
  }
  /** @param {import('./settings.js').PartialSettings} changes @param {string} [by] */
  set(changes, by = 'program') {
    this.settings = mergeSettings(this.settings, changes);
    if (this.settings.show === 'sharing' && this.memory !== null && this.textures !== null) this.textures.setInstances(this.memory.nodeInstances, this.memory.leafInstances);
    this.emit('settings', this.settings, by);
    this.touch(true);
  }

  aspect() {
    return this.canvas.width / Math.max(1, this.canvas.height);
  }

  /** The camera that is in force. */
  camera() {
    return this.settings.camera ?? this.info?.view ?? { eye: /** @type {Vec3} */ ([0, 0, 1]), target: /** @type {Vec3} */ ([0, 0, 0]), up: /** @type {Vec3} */ ([0, 1, 0]), fov: 40 };
  }

  /** Shows the whole scene. */
  frame() {
    if (this.info === null) return;
    this.set({ camera: defaultView(this.info.bounds, this.aspect(), this.camera().up) }, 'frame');
  }

  // ---- rays on the CPU

  /** @param {Vec3} origin @param {Vec3} direction @param {number} [most] */
  castNow(origin, direction, most = Infinity) {
    const { memory } = this;
    if (memory === null) return null;
    return castInSection(this.settings.section, origin, direction, most, (from, along, end) => cast(memory.dag(), from, along, end));
  }
  /** @param {Vec3} point */
  contains(point) {
    return this.memory !== null && contains(this.memory.dag(), point);
  }
  /** @param {number} x @param {number} y */
  async pick(x, y) {
    if (this.memory === null) return null;
    const camera = this.camera();
    const direction = directionThrough(camera, x, y, this.canvas.clientWidth, this.canvas.clientHeight);
    const dag = this.memory.dag();
    const shown = { ...dag, shown: Math.min(dag.shown, this.settings.level ?? dag.shown) };
    return castInSection(this.settings.section, camera.eye, direction, Infinity, (from, along, end) => cast(shown, from, along, end));
  }

  // ---- pictures

  /** The picture has changed. @param {boolean} isMoving whether it may go on changing */
  touch(isMoving) {
    ++this.version;
    this.isStill = false;
    this.isFinal = false;
    this.changedAt = isMoving ? performance.now() : 0;
    this.wake();
  }

  wake() {
    if (this.requestedFrame !== 0 || this.isDestroyed) return;
    this.requestedFrame = requestAnimationFrame((now) => {
      this.requestedFrame = 0;
      try {
        this.tick(now);
      } catch (error) {
        this.fail('The picture cannot be drawn', String(/** @type {any} */ (error)?.message ?? error));
      }
    });
  }

  resize() {
    const ratio = Math.min(globalThis.devicePixelRatio || 1, MOST_PIXEL_RATIO);
    const width = Math.max(1, Math.round(this.container.clientWidth * ratio)), height = Math.max(1, Math.round(this.container.clientHeight * ratio));
    if (width === this.canvas.width && height === this.canvas.height) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.redraw();
    this.touch(true);
    this.emit('resize', { width, height });
  }

  /** @param {boolean} quick @returns {Shot} */
  shot(quick) {
    const info = /** @type {import('./file/scene_loader.js').FileInfo} */ (this.memory?.info);
    return {
      settings: /** @type {any} */ ({ ...this.settings, camera: this.camera() }),
      place: { origin: info.origin, side: info.voxelSize * info.resolution },
      scene: this.textures, shown: this.memory?.shown ?? 0, mostInstances: this.memory?.mostInstances ?? 1, samples: STILL_SAMPLES, quick,
    };
  }

  /** Returns a picture of this size, with the old one's buffers if it has the size. @param {Picture | null} picture @param {number} width @param {number} height */
  sized(picture, width, height) {
    if (picture !== null && picture.width === width && picture.height === height) return picture;
    if (picture !== null && picture !== this.shownPicture) picture.delete();
    return new Picture(/** @type {WebGL2RenderingContext} */ (this.gl), width, height);
  }

  /** Whether the frame that was sent last is still being drawn; if it is done, learns from it. */
  isBusy() {
    const { gl, pending } = this;
    if (gl === null || pending === null) return false;
    const status = gl.clientWaitSync(pending.sync, 0, 0);
    if (status === gl.TIMEOUT_EXPIRED) return true;
    gl.deleteSync(pending.sync);
    this.pending = null;
    const ms = performance.now() - pending.begin;
    this.pacer.learn(pending.isMoving, pending.pixels, ms);
    this.stats.frameMs = this.stats.frameMs === 0 ? ms : 0.8 * this.stats.frameMs + 0.2 * ms;
    return false;
  }

  /** Sends what was drawn, to be timed. @param {boolean} isMoving @param {number} pixels @param {number} begin */
  send(isMoving, pixels, begin) {
    const gl = /** @type {WebGL2RenderingContext} */ (this.gl);
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (sync !== null) this.pending = { sync, begin, isMoving, pixels };
  }

  /** @param {number} now */
  tick(now) {
    const { gl, renderer } = this;
    if (gl === null || renderer === null || this.isLost || this.memory === null || this.memory.shown < 1) return;
    if (this.isBusy()) return this.wake();
    const { width, height } = this.canvas;
    const begin = performance.now();
    const isMoving = begin - this.changedAt < REST_MS;
    if (this.quickVersion !== this.version) {
      const scale = this.pacer.scale(width * height);
      const quick = (this.quick = this.sized(this.quick, Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))));
      quick.reset();
      const shot = this.shot(true);
      renderer.render(quick, shot, quick.height);
      this.quickVersion = this.version;
      this.adapt(quick, now);
      this.show(quick);
      this.count(quick, shot, scale);
      this.send(true, quick.width * quick.height, begin);
    } else if (!isMoving) {
      this.refine(begin);
    }
    this.stats.levelsShown = Math.min(this.memory.shown, this.settings.level ?? this.memory.info.levels);
    this.emit('frame', this.stats);
    if (!this.isStill || !this.isLoaded) this.wake();
    if (this.isStill && this.isLoaded) {
      this.emit('still');
      for (const wake of this.stillWaiters.splice(0)) wake();
    }
  }

  /**
   * Renders a part of the refined picture: first pictures of twice the quick one's pixels and so on,
   * then all samples of the full one.
   * @param {number} begin
   */
  refine(begin) {
    const renderer = /** @type {Renderer} */ (this.renderer);
    if (this.isStill) return;
    if (this.fullVersion !== this.version) {
      this.fullVersion = this.version;
      this.fullScale = finerScale((this.quick?.width ?? 1) / this.canvas.width);
      this.full?.reset();
    }
    const width = Math.max(1, Math.round(this.canvas.width * this.fullScale)), height = Math.max(1, Math.round(this.canvas.height * this.fullScale));
    const full = (this.full = this.sized(this.full, width, height));
    const shot = this.shot(false);
    const wanted = this.fullScale < 1 ? 1 : this.wantedSamples();
    const rows = Math.min(this.pacer.rows(width, height), height - full.rows);
    renderer.render(full, shot, rows);
    if (full.rows === 0) {
      if (full.samples === 1) this.adapt(full, begin, true);
      if (full.samples >= wanted && this.fullScale === 1) {
        this.exposure = this.settings.exposure > 0 ? this.settings.exposure : renderer.exposureOf(full);
        this.isStill = true;
      }
      this.show(full);
      this.count(full, shot, this.fullScale);
      if (this.fullScale < 1) this.fullScale = finerScale(this.fullScale);
    }
    this.stats.samples = this.fullScale === 1 && full.width === this.canvas.width ? full.samples : 0;
    this.stats.samplesWanted = this.wantedSamples();
    this.send(false, rows * width, begin);
  }

  wantedSamples() {
    return ['light', 'occlusion'].includes(this.settings.show) ? STILL_SAMPLES : 4;
  }

  /** Adapts the exposure to a new picture: at once after a pause, else smoothly. @param {Picture} picture @param {number} now @param {boolean} [atOnce] */
  adapt(picture, now, atOnce = false) {
    if (this.settings.exposure > 0) {
      this.exposure = this.settings.exposure;
      return;
    }
    if (this.settings.show !== 'light') return;
    const wanted = /** @type {Renderer} */ (this.renderer).exposureOf(picture);
    const since = now - this.lastExposure;
    this.lastExposure = now;
    const part = this.exposure === 0 || atOnce ? 1 : 1 - Math.exp(-Math.min(since, 100) / 250);
    this.exposure *= (wanted / (this.exposure || wanted)) ** part;
    if (this.exposure === 0) this.exposure = wanted;
  }

  /** @param {Picture} picture */
  show(picture) {
    if (this.shownPicture !== null && this.shownPicture !== picture && this.shownPicture !== this.quick && this.shownPicture !== this.full) this.shownPicture.delete();
    this.shownPicture = picture;
    this.redraw();
  }

  redraw() {
    if (this.renderer === null || this.shownPicture === null || this.shownPicture.samples === 0) return;
    this.renderer.display(this.shownPicture, this.exposure, null, this.canvas.width, this.canvas.height);
  }

  /** @param {Picture} picture @param {Shot} shot @param {number} scale */
  count(picture, shot, scale) {
    const renderer = /** @type {Renderer} */ (this.renderer);
    const rays = renderer.raysPerSample(shot);
    this.stats.raysPerFrame = picture.width * picture.height * (1 + (this.settings.show === 'light' ? rays.light + rays.occlusion : 0));
    if (['light', 'steps'].includes(this.settings.show)) this.stats.stepsPerRay = renderer.stepsOf(picture);
    this.stats.scale = scale;
    this.stats.samples = picture.samples;
    this.stats.gpuBytes = (this.textures?.bytes() ?? 0) + (this.quick?.bytes() ?? 0) + (this.full?.bytes() ?? 0);
  }

  statistics() {
    return { ...this.stats };
  }

  /** @returns {Promise<void>} */
  whenStill() {
    if (this.isStill && this.isLoaded) return Promise.resolve();
    this.wake();
    return new Promise((resolve) => this.stillWaiters.push(resolve));
  }

  /** Waits until the scene has arrived, or has failed to. */
  async whenLoaded() {
    while (!this.isLoaded && !this.isDestroyed) await new Promise((resolve) => setTimeout(resolve, 20));
  }

  /**
   * Renders a picture in full quality, as PNG, once the scene has arrived.
   * @param {{width?: number, height?: number, samples?: number}} [size]
   * @returns {Promise<Blob>}
   */
  async capture({ width = this.canvas.width, height = this.canvas.height, samples = STILL_SAMPLES } = {}) {
    await this.whenLoaded();
    const { gl, renderer } = this;
    if (gl === null || renderer === null || this.memory === null) throw new Error('there is no scene');
    const picture = new Picture(gl, width, height);
    const shot = { ...this.shot(false), samples };
    while (picture.samples < samples) {
      renderer.render(picture, shot, this.pacer.rows(width, height));
      gl.finish();
      await new Promise((resolve) => setTimeout(resolve, 0));
      if (this.isLost || this.isDestroyed) throw new Error('the graphics card was lost');
    }
    const exposure = this.settings.exposure > 0 ? this.settings.exposure : renderer.exposureOf(picture);
    const texture = /** @type {WebGLTexture} */ (gl.createTexture());
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    renderer.display(picture, exposure, target, width, height);
    const pixels = new Uint8ClampedArray(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.deleteFramebuffer(target);
    gl.deleteTexture(texture);
    picture.delete();
    const canvas = document.createElement('canvas');
    canvas.width = width;
    canvas.height = height;
    const image = new ImageData(width, height);
    for (let row = 0; row < height; ++row) image.data.set(pixels.subarray(4 * width * (height - 1 - row), 4 * width * (height - row)), 4 * width * row);
    /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d')).putImageData(image, 0, 0);
    return new Promise((resolve, reject) => canvas.toBlob((blob) => (blob === null ? reject(new Error('no picture')) : resolve(blob)), 'image/png'));
  }

  /** For tests: the cells that the pixels' rays hit, 4 numbers each, rows from the bottom; see hits.glsl. @param {number} width @param {number} height */
  hits(width, height) {
    return /** @type {Renderer} */ (this.renderer).hits(this.shot(false), width, height);
  }

  // ---- the graphics card

  /** @param {Event} event */
  onLost(event) {
    event.preventDefault();
    this.isLost = true;
    this.pending = null;
    this.emit('lost');
  }

  onRestored() {
    const gl = /** @type {WebGL2RenderingContext} */ (this.gl);
    try {
      this.renderer = new Renderer(gl, this.shaders);
      this.quick = this.full = this.shownPicture = null;
      if (this.memory !== null) {
        this.textures = new SceneTextures(gl, this.memory.info, this.memory.finest);
        this.memory.restore(this.textures);
        if (this.settings.show === 'sharing') this.textures.setInstances(this.memory.nodeInstances, this.memory.leafInstances);
      }
    } catch (error) {
      return this.fail('The graphics card was lost', String(/** @type {any} */ (error)?.message ?? error), 'webgl');
    }
    this.isLost = false;
    this.emit('restored');
    this.touch(false);
  }

  destroy() {
    this.isDestroyed = true;
    if (this.requestedFrame !== 0) cancelAnimationFrame(this.requestedFrame);
    this.loader.close();
    this.observer.disconnect();
    this.gl?.getExtension('WEBGL_lose_context')?.loseContext();
    this.canvas.remove();
    this.handlers.clear();
    for (const wake of this.stillWaiters.splice(0)) wake();
  }
}
