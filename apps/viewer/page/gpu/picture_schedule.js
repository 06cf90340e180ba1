/**
 * Decides what each frame renders, so that the page stays smooth: a quick picture while the view
 * changes; at rest finer ones, and at last all samples of the full one. Pictures of one sample are
 * smoothed; the full one is not, and takes their place when its own noise is low.
 */
import { Picture } from './picture.js';
import { Smoother, hasNoise } from './smoother.js';

/**
 * @typedef {import('./pacer.js').Pacer} Pacer
 * @typedef {import('./renderer.js').Renderer} Renderer
 * @typedef {import('./renderer.js').Shot} Shot
 */

/** View samples per pixel of a finished picture, and of one that shows the structure: it has no rays that light needs. */
export const STILL_SAMPLES = 16, STRUCTURE_SAMPLES = 4;
/** Samples from which on the full picture has less noise than a smoothed one. */
const CLEAR_SAMPLES = 6;
/** Milliseconds without a change after which a view counts as still. */
const REST_MS = 120;
/** Milliseconds in which a moving picture's exposure covers 63% of the way to a new one. */
const EXPOSURE_LAG_MS = 250;

/** Returns the scale of the next finer picture. @param {number} scale */
const finerScale = (scale) => (scale < 0.4 ? 2 * scale : 1);

/** @param {Shot} shot */
const wantedSamples = ({ settings }) => (['light', 'occlusion'].includes(settings.show) ? STILL_SAMPLES : STRUCTURE_SAMPLES);

export class PictureSchedule {
  /** @param {Renderer} renderer @param {HTMLCanvasElement} canvas  The renderer's. @param {Pacer} pacer */
  constructor(renderer, canvas, pacer) {
    this.renderer = renderer;
    this.canvas = canvas;
    this.pacer = pacer;
    this.smoother = new Smoother(renderer);
    /** Pictures that were smoothed: each takes other samples of the light. */
    this.smoothed = 0;
    /** @type {Picture | null} */
    this.quick = null;
    /** @type {Picture | null} */
    this.full = null;
    /** The picture on the canvas. @type {Picture | null} */
    this.shown = null;
    /** Whether the quick picture, and the full one, are of the present view. */
    this.hasQuick = false;
    this.hasFull = false;
    /** Side of the full picture's pixels^-1, relative to the canvas; doubles until it is 1. */
    this.fullScale = 1;
    /** Whether the full picture is still one of one sample that is smoothed, until it has the canvas's scale. */
    this.isPreview = false;
    this.isFinished = false;
    /** Time of the last change that may go on, in milliseconds of the page. */
    this.changedAt = -Infinity;
    /** Factor before tone mapping; 0 before the first picture. */
    this.exposure = 0;
    this.exposedAt = 0;
    /** The part of a picture that the graphics card is still drawing. @type {{sync: WebGLSync, begin: number, isQuick: boolean, pixels: number} | null} */
    this.pending = null;
    this.numbers = { frameMs: 0, raysPerFrame: 0, stepsPerRay: 0, samples: 0, samplesWanted: STILL_SAMPLES, scale: 1 };
  }

  /** Begins new pictures: the view or the scene has changed. @param {boolean} isMoving  Whether it may go on changing. */
  touch(isMoving) {
    this.hasQuick = this.hasFull = this.isFinished = false;
    this.changedAt = isMoving ? performance.now() : -Infinity;
  }

  /**
   * Renders the next part of a picture. Returns whether it did: not while the graphics card is busy
   * or the view may still change, and not once the picture is finished.
   * @param {(quick: boolean) => Shot} shotOf
   */
  render(shotOf) {
    if (this.isFinished || this.#isBusy()) return false;
    const now = performance.now();
    if (!this.hasQuick) this.#renderQuick(shotOf(true), now);
    else if (now - this.changedAt < REST_MS) return false;
    else this.#refine(shotOf(false), now);
    return true;
  }

  /** Shows the picture again, after the canvas was cleared or resized. */
  redraw() {
    if (this.shown === null || this.shown.samples === 0) return;
    this.renderer.display(this.shown, this.exposure, null, this.canvas.width, this.canvas.height);
  }

  /** Returns the bytes of the pictures' textures. */
  bytes() {
    return (this.quick?.bytes() ?? 0) + (this.full?.bytes() ?? 0) + this.smoother.bytes();
  }

  /** @param {Shot} shot @param {number} now */
  #renderQuick(shot, now) {
    const scale = this.pacer.scale(this.canvas.width * this.canvas.height);
    const quick = (this.quick = this.#sized(this.quick, scale));
    quick.reset();
    this.#renderSmoothed(quick, shot, quick.height);
    this.hasQuick = true;
    this.#adapt(quick, shot, now, false);
    this.#show(quick);
    this.#count(quick, shot);
    this.#send(true, quick.width * quick.height, now);
  }

  /** Renders rows of a picture of one sample, and smooths it when it is complete. @param {Picture} picture @param {Shot} shot @param {number} rows */
  #renderSmoothed(picture, shot, rows) {
    if (!hasNoise(shot)) return this.renderer.render(picture, shot, rows);
    const smoothed = { ...shot, smoothed: this.smoothed % shot.samples };
    this.renderer.render(picture, smoothed, rows);
    if (picture.rows > 0) return;
    this.smoother.apply(picture, smoothed);
    ++this.smoothed;
  }

  /** Renders rows of the full picture. @param {Shot} shot @param {number} now */
  #refine(shot, now) {
    if (!this.hasFull) {
      const scale = (this.quick?.width ?? 1) / this.canvas.width;
      this.hasFull = true;
      this.fullScale = finerScale(scale);
      this.isPreview = scale < 1;
      this.full?.reset();
    }
    const full = (this.full = this.#sized(this.full, this.fullScale));
    const rows = Math.min(this.pacer.rows(full.width, full.height), full.height - full.rows);
    if (this.isPreview) this.#renderSmoothed(full, shot, rows);
    else this.renderer.render(full, shot, rows);
    if (full.rows === 0) this.#takeSample(full, shot, now);
    this.#send(false, rows * full.width, now);
  }

  /** Shows a sample of the full picture that is complete. @param {Picture} full @param {Shot} shot @param {number} now */
  #takeSample(full, shot, now) {
    this.#count(full, shot);
    if (this.isPreview) {
      this.#adapt(full, shot, now, true);
      this.#show(full);
      if (this.fullScale === 1) {
        // The canvas shows it on while the samples add up in the other one.
        [this.quick, this.full] = [full, this.quick];
        this.full?.reset();
        this.isPreview = false;
      } else {
        this.fullScale = finerScale(this.fullScale);
      }
      return;
    }
    const wanted = wantedSamples(shot), clear = hasNoise(shot) ? CLEAR_SAMPLES : 1;
    if (full.samples === clear) this.#adapt(full, shot, now, true);
    if (full.samples >= wanted) {
      this.exposure = shot.settings.exposure > 0 ? shot.settings.exposure : this.renderer.exposureOf(full);
      this.isFinished = true;
    }
    if (full.samples >= clear) this.#show(full);
  }

  /** Returns a picture of a scale; with the old one's buffers if it has the size. @param {Picture | null} picture @param {number} scale */
  #sized(picture, scale) {
    const [width, height] = [this.canvas.width, this.canvas.height].map((side) => Math.max(1, Math.round(side * scale)));
    if (picture !== null && picture.width === width && picture.height === height) return picture;
    if (picture !== this.shown) picture?.delete();
    return new Picture(this.renderer.gl, width, height);
  }

  /** @param {Picture} picture */
  #show(picture) {
    if (this.shown !== picture && this.shown !== this.quick && this.shown !== this.full) this.shown?.delete();
    this.shown = picture;
    this.redraw();
  }

  /** Adapts the exposure to a new picture, at once or as eyes do. @param {Picture} picture @param {Shot} shot @param {number} now @param {boolean} atOnce */
  #adapt(picture, { settings }, now, atOnce) {
    if (settings.exposure > 0) this.exposure = settings.exposure;
    else if (settings.show === 'light') {
      const wanted = this.renderer.exposureOf(picture);
      const part = this.exposure === 0 || atOnce ? 1 : 1 - Math.exp(-Math.min(now - this.exposedAt, 100) / EXPOSURE_LAG_MS);
      this.exposedAt = now;
      this.exposure = part === 1 ? wanted : this.exposure * (wanted / this.exposure) ** part;
    }
  }

  /** Counts the work of a picture that is shown. @param {Picture} picture @param {Shot} shot */
  #count(picture, shot) {
    const { show } = shot.settings, rays = this.renderer.raysPerSample(shot), { numbers } = this;
    const lightRays = show === 'light' ? rays.light + rays.occlusion : show === 'occlusion' ? rays.occlusion : 0;
    numbers.raysPerFrame = picture.width * picture.height * (1 + lightRays);
    if (show === 'light' || show === 'steps') numbers.stepsPerRay = this.renderer.stepsOf(picture);
    numbers.scale = picture.width / this.canvas.width;
    numbers.samples = numbers.scale === 1 ? picture.samples : 0;
    numbers.samplesWanted = wantedSamples(shot);
  }

  /** Returns whether the part that was sent last is still being drawn; if it is done, learns from it. */
  #isBusy() {
    const { gl } = this.renderer, { pending } = this;
    if (pending === null) return false;
    if (gl.clientWaitSync(pending.sync, 0, 0) === gl.TIMEOUT_EXPIRED) return true;
    gl.deleteSync(pending.sync);
    this.pending = null;
    const ms = performance.now() - pending.begin, { numbers } = this;
    this.pacer.learn(pending.isQuick, pending.pixels, ms);
    numbers.frameMs = numbers.frameMs === 0 ? ms : 0.8 * numbers.frameMs + 0.2 * ms;
    return false;
  }

  /** Sends what was drawn to the graphics card, to be timed. @param {boolean} isQuick @param {number} pixels @param {number} begin */
  #send(isQuick, pixels, begin) {
    const { gl } = this.renderer, sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (sync !== null) this.pending = { sync, begin, isQuick, pixels };
  }
}
