/** Moves the camera of a viewer by pointer, keys and gamepad. */
import { clamp } from '../math.js';
import { MODES, sameCamera } from '../settings.js';
import { Events, listeners } from '../events.js';
import { Pad } from './gamepad.js';
import { Keys } from './keys.js';
import { Navigator, NO_INPUT } from './navigator.js';
import { Pointers } from './pointers.js';
import { cameraOf, poseOf } from './pose.js';

/**
 * @typedef {import('../viewer_types.js').Viewer} Viewer
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('./navigator.js').Input} Input
 */

/**
 * Moves the camera. Events: 'click' (x, y), 'hover' (x, y, down), 'leave', 'gesture' (a person moves
 * the camera), 'rest' (the camera stands still again), 'speed' (the factor on the speed). x and y are
 * CSS pixels of the picture.
 */
export class Hands extends Events {
  /** @param {Viewer} viewer @param {{keyboard?: EventTarget}} [options]  `keyboard`: whose keys count. */
  constructor(viewer, { keyboard = window } = {}) {
    super();
    this.viewer = viewer;
    /** @type {Navigator | null} */
    this.navigator = null;
    this.#listeners = listeners();
    const { listen } = this.#listeners;
    this.pad = new Pad();
    this.keys = new Keys(keyboard, () => this.wake(), listen);
    /** @type {Pointers | null} */
    this.pointers = null;
    this.moved = false;
    this.frameRequest = 0;
    this.lastTime = 0;
    const still = matchMedia('(prefers-reduced-motion: reduce)');
    this.reducedMotion = still.matches;
    listen(still, 'change', () => {
      this.reducedMotion = still.matches;
      if (this.navigator) this.navigator.reducedMotion = still.matches;
    });
    listen(window, 'gamepadconnected', () => this.wake());
    // Until someone moves the camera, it is the home view, which becomes better with every level.
    this.onInfo = () => this.#meet();
    this.onSettings = (/** @type {Settings} */ settings, /** @type {string} */ by) => by === 'hands' || this.#follow(settings);
    viewer.on('settings', this.onSettings);
    viewer.on('loaded', this.onLoaded);
    viewer.on('opened', this.onOpened);
    for (const event of ['info', 'level', 'loaded', 'resize']) viewer.on(event, this.onInfo);
    this.#meet();
  }
  isLoaded = false;
  onLoaded = () => { this.isLoaded = true; };
  onOpened = () => { this.isLoaded = false; };
  /** Takes a double click for something else; returns whether it did. @type {(x: number, y: number) => boolean} */
  takesDoubleClick = () => false;
  /** Takes a drag for something else than the camera, if it is wanted. @type {(x: number, y: number) => import('./pointers.js').Drag | null} */
  takesDrag = () => null;
  /** @type {ReturnType<typeof listeners>} */
  #listeners;

  /** Begins when the scene's header is known; later follows the home view. */
  #meet() {
    const { viewer } = this, { info, canvas } = viewer;
    if (!info) return;
    if (this.navigator) return this.#follow(viewer.get());
    this.navigator = new Navigator({
      get bounds() { return (viewer.info ?? info).bounds; },
      get home() { return (viewer.info ?? info).view; },
      get voxelSize() { return (viewer.info ?? info).voxelSize; },
      cast: (origin, direction, distance) => viewer.castNow(origin, direction, distance),
    });
    this.navigator.reducedMotion = this.reducedMotion;
    this.navigator.measure(canvas);
    this.pointers = new Pointers(canvas, this.navigator, {
      drag: (x, y) => this.takesDrag(x, y),
      wake: () => { this.emit('gesture'); this.wake(); },
      click: (x, y) => this.emit('click', x, y),
      doubleClick: (x, y) => this.#double(x, y),
      hover: (x, y, down) => this.emit('hover', x, y, down),
      leave: () => this.emit('leave'),
      speed: () => this.emit('speed', this.navigator?.speedFactor),
    }, this.#listeners.listen);
    this.#follow(this.viewer.get());
  }

  /** Turns to the point of a double click, unless it is taken. @param {number} x @param {number} y */
  async #double(x, y) {
    if (this.takesDoubleClick(x, y)) return;
    const hit = await this.viewer.pick(x, y);
    if (hit) this.focus(hit.position);
  }

  /** Takes the mode and the camera that a program, a panel or a link has set. @param {Settings} settings */
  #follow(settings) {
    const { navigator } = this;
    if (!navigator) return;
    // A walker would fall through levels that have not arrived.
    const isComplete = this.isLoaded || this.viewer.statistics().levelsLoaded >= (this.viewer.info?.levels ?? 0);
    const mode = settings.mode === 'walk' && !isComplete ? 'fly' : settings.mode;
    const camera = settings.camera ?? navigator.scene.home;
    if (!sameCamera(camera, this.lastCamera)) {
      navigator.setCamera(camera);
      this.lastCamera = camera;
      this.moved = false;
      this.emit('rest');
      if (navigator.walker) this.wake();
    }
    if (mode !== navigator.mode) {
      navigator.setMode(mode);
      this.wake();
    }
  }
  /** @type {Camera | null} */
  lastCamera = null;

  /** Starts frames until the camera rests. */
  wake() {
    if (this.frameRequest) return;
    this.lastTime = 0;
    this.frameRequest = requestAnimationFrame((now) => this.#tick(now));
  }

  /** @param {number} now */
  #tick(now) {
    this.frameRequest = 0;
    const { navigator } = this;
    if (!navigator) return;
    const time = this.lastTime ? clamp((now - this.lastTime) / 1000, 0, 0.25) : 1 / 60;
    const pad = this.pad.connected;
    navigator.measure(this.viewer.canvas);
    const input = this.#input(pad);
    if (input.move.some(Boolean) || input.turn.some(Boolean) || input.zoom) this.emit('gesture');
    const moving = navigator.step(time, input);
    if (moving) {
      this.moved = true;
      this.#show(navigator.camera);
    } else if (this.moved) {
      this.moved = false;
      const { home } = navigator.scene;
      if (sameCamera(navigator.camera, cameraOf(poseOf(home)))) {
        this.lastCamera = home;
        this.viewer.set({ camera: null }, 'hands');  // the home view is in no link
      } else this.#show(navigator.settle());
      this.emit('rest');
    }
    if (!moving && !pad) return;
    this.lastTime = now;
    this.frameRequest ||= requestAnimationFrame((next) => this.#tick(next));
  }

  /** Sets the viewer's camera. @param {Camera} camera */
  #show(camera) {
    this.lastCamera = camera;
    this.viewer.set({ camera }, 'hands');
  }

  /** Adds up what keys, fingers and gamepad ask for. @param {Gamepad | null} pad @returns {Input} */
  #input(pad) {
    const keys = this.keys.input, [aside, ahead] = this.pointers?.stick ?? [0, 0];
    let other = NO_INPUT;
    if (pad) {
      const { input, pressed } = this.pad.read(pad, this.navigator?.mode === 'orbit');
      other = input;
      if (pressed[1]) this.view('home');
      if (pressed[2]) this.viewer.set({ mode: MODES[(MODES.indexOf(this.viewer.get().mode) + 1) % 3] }, 'gamepad');
      if (pressed[3]) this.frame();
    }
    return {
      move: [
        clamp(keys.move[0] + other.move[0] + aside, -1, 1), clamp(keys.move[1] + other.move[1], -1, 1),
        clamp(keys.move[2] + other.move[2] + ahead, -1, 1)],
      turn: [clamp(keys.turn[0] + other.turn[0], -1, 1), clamp(keys.turn[1] + other.turn[1], -1, 1)],
      zoom: clamp(keys.zoom + other.zoom, -1, 1),
      fast: keys.fast || other.fast,
      jump: keys.jump || other.jump,
    };
  }

  /** Runs a motion of the navigator. @param {(navigator: Navigator) => void} act */
  #act(act) {
    if (!this.navigator) return;
    this.navigator.measure(this.viewer.canvas);
    const { mode } = this.navigator;
    act(this.navigator);
    this.moved = true;
    if (this.navigator.mode !== mode) this.viewer.set({ mode: this.navigator.mode }, 'hands');
    this.emit('gesture');
    this.wake();
  }
  /** Shows the whole scene. */
  frame() {
    this.#act((navigator) => navigator.frame());
  }
  /** Flies to a side of the scene, or 'home'. @param {string} name */
  view(name) {
    this.#act((navigator) => navigator.view(name));
  }
  /** Flies to a camera. @param {Camera} camera */
  flyTo(camera) {
    this.#act((navigator) => navigator.flyTo(camera));
  }
  /** Turns to a point. @param {import('../math.js').Vec3} point */
  focus(point) {
    this.#act((navigator) => navigator.focus(point));
  }
  /** Hides the pointer and lets it look around, until Escape. */
  lockPointer() {
    this.pointers?.lock();
  }
  destroy() {
    this.#listeners.end();
    cancelAnimationFrame(this.frameRequest);
    for (const event of ['info', 'level', 'loaded', 'resize']) this.viewer.off(event, this.onInfo);
    this.viewer.off('settings', this.onSettings);
    this.viewer.off('loaded', this.onLoaded);
    this.viewer.off('opened', this.onOpened);
  }
}
