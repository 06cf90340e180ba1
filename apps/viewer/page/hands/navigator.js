/**
 * Moves the camera; knows no page and no pointers. hands.js calls it for every gesture and every
 * frame. Gestures set a goal; the camera approaches it exponentially, so that motion does not
 * depend on the frame rate.
 */
import { RADIANS, add, addScaled, clamp, cross, distance as distanceOf, dot, length, mix, normalized, scale, sub, wrapped }
  from '../math.js';
import { middleOf } from '../box.js';
import { directionThrough, lensOf } from '../lens.js';
import { Flight } from './flight.js';
import {
  STEEPEST, VIEWS, apart, between, cameraOf, eyeOf, forwardOf, framed, isFinitePose, poseOf, roundCamera, turnedTo, withEye,
} from './pose.js';
import { Walker } from './walker.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('../settings.js').Mode} Mode
 * @typedef {import('../viewer_types.js').Hit} Hit
 * @typedef {import('./pose.js').Pose} Pose
 *
 * @typedef {object} Surroundings  The parts of the viewer that the camera's motion depends on.
 * @property {{low: Vec3, high: Vec3}} bounds
 * @property {number} voxelSize
 * @property {Camera} home
 * @property {(origin: Vec3, direction: Vec3, distance: number) => Hit | null} cast
 *
 * @typedef {object} Input  The motion that keys and sticks ask for, each number from -1 to 1.
 * @property {Vec3} move  Right, up, forward.
 * @property {[number, number]} turn  Right, up.
 * @property {number} zoom  Positive: closer.
 * @property {boolean} fast
 * @property {boolean} [jump]
 */

/** @type {Input} */
export const NO_INPUT = { move: [0, 0, 0], turn: [0, 0], zoom: 0, fast: false };

/** Time constants, in seconds: after this time, 37% of the way to the goal is left. */
const ORBIT_LAG = 0.07, LOOK_LAG = 0.035, SPEED_LAG = 0.12;
/** Radians per second that keys and sticks turn. */
const TURN_SPEED = 1.6;
/** Heights of the picture below which a goal is reached. */
const REACHED = 1e-4;
const FLIGHT_SECONDS = 0.7;

/** Returns the part of the way that is covered in a time. @param {number} time @param {number} lag */
export const covered = (time, lag) => (lag > 0 ? 1 - Math.exp(-time / lag) : 1);

/**
 * Returns the speed after a time, and the way in it, if the speed approaches `wish` exponentially:
 * exact for any length of the step.
 * @param {Vec3} speed @param {Vec3} wish @param {number} time @param {number} lag
 * @returns {{speed: Vec3, way: Vec3}}
 */
export function accelerated(speed, wish, time, lag) {
  const rest = sub(speed, wish), left = lag > 0 ? Math.exp(-time / lag) : 0;
  return { speed: addScaled(wish, rest, left), way: addScaled(scale(wish, time), rest, lag * (1 - left)) };
}

export class Navigator {
  /** @param {Surroundings} scene */
  constructor(scene) {
    this.scene = scene;
    this.width = 1;
    this.height = 1;
    /** @type {Mode} */
    this.mode = 'orbit';
    this.reducedMotion = false;
    /** Factor on the speed of flying. */
    this.speedFactor = 1;
    /** @type {Vec3} */
    this.speed = [0, 0, 0];
    /** Distance of the surface ahead, smoothed; sets the speed of flying. */
    this.ahead = 0;
    this.zoomSpeed = 0;
    /** @type {Flight | null} */
    this.flight = null;
    /** @type {Walker | null} */
    this.walker = null;
    this.goal = this.shown = poseOf(scene.home);
  }

  /** Takes the size of the picture. @param {HTMLElement} canvas */
  measure(canvas) {
    this.width = Math.max(1, canvas.clientWidth);
    this.height = Math.max(1, canvas.clientHeight);
  }

  /** Length of the scene's diagonal, in world units. */
  get size() {
    return Math.max(distanceOf(this.scene.bounds.low, this.scene.bounds.high), this.scene.voxelSize) || 1;
  }
  /** The least and the greatest distance of the target, in world units. */
  get least() {
    return Math.max(this.scene.voxelSize * 0.5, this.size * 1e-9);
  }
  get most() {
    return this.size * 100;
  }
  /** @returns {'target' | 'eye'} */
  get pivot() {
    return this.mode === 'orbit' ? 'target' : 'eye';
  }
  get lag() {
    return this.reducedMotion ? 0 : this.mode === 'orbit' ? ORBIT_LAG : LOOK_LAG;
  }
  /** @returns {Camera} */
  get camera() {
    return cameraOf(this.shown);
  }

  /** Takes a camera at once, without a flight. @param {Camera} camera */
  setCamera(camera) {
    this.stop();
    this.goal = this.shown = poseOf(camera);
    if (this.mode === 'walk') this.walker = new Walker(this.scene, this.goal);
  }

  /** Changes the mode; the picture stays. @param {Mode} mode */
  setMode(mode) {
    if (mode === this.mode) return;
    this.stop();
    this.mode = mode;
    this.goal = this.shown;
    this.walker = mode === 'walk' ? new Walker(this.scene, this.goal) : null;
    if (mode === 'orbit') this.#anchor();
  }

  /** Ends flights and drift. */
  stop() {
    if (this.flight) this.goal = this.shown;
    this.flight = null;
    this.speed = [0, 0, 0];
    this.zoomSpeed = 0;
  }

  /** Sets the target to the surface in the middle of the picture; without one, as far as the scene's middle. */
  #anchor() {
    const hit = this.scene.cast(eyeOf(this.goal), forwardOf(this.goal), this.most);
    const along = dot(sub(middleOf(this.scene.bounds), eyeOf(this.goal)), forwardOf(this.goal));
    const distance = clamp(hit ? hit.distance : along > 0 ? along : this.goal.distance, this.least, this.most);
    this.goal = this.shown = withEye({ ...this.goal, distance }, eyeOf(this.goal));
  }

  /** Turns around the target. @param {number} dx @param {number} dy  Pixels. */
  rotate(dx, dy) {
    this.#gesture();
    const angle = Math.PI / Math.max(this.height, 320);
    this.#turn(dx * angle, -dy * angle, 'target');
  }

  /**
   * Turns around the eye. A mouse pushes the view; a finger pulls the scene.
   * @param {number} dx @param {number} dy  Pixels. @param {boolean} [pull]
   */
  look(dx, dy, pull = false) {
    this.#gesture();
    const angle = this.goal.fov * RADIANS / this.height * (pull ? -1 : 1.2);
    this.#turn(dx * angle, -dy * angle, 'eye');
  }

  /** @param {number} right @param {number} up  Radians. @param {'target' | 'eye'} pivot */
  #turn(right, up, pivot) {
    const eye = eyeOf(this.goal);
    const goal = { ...this.goal, yaw: this.goal.yaw + right, pitch: clamp(this.goal.pitch + up, -STEEPEST, STEEPEST) };
    this.#setGoal(pivot === 'target' ? goal : withEye(goal, eye));
  }

  /**
   * Returns the point of the scene under a pixel; in the distance of the target if there is none.
   * @param {number} x @param {number} y @returns {Vec3}
   */
  pointUnder(x, y) {
    const camera = this.camera;
    const direction = directionThrough(camera, x, y, this.width, this.height);
    const hit = this.scene.cast(camera.eye, direction, this.most);
    if (hit && hit.distance > 0) return addScaled(camera.eye, direction, hit.distance);
    return addScaled(camera.eye, direction, this.shown.distance / Math.max(dot(direction, forwardOf(this.shown)), 0.05));
  }

  /**
   * Moves the picture so that a point at the depth of `grabbed` follows the pointer.
   * @param {number} dx @param {number} dy  Pixels. @param {Vec3} [grabbed]
   */
  pan(dx, dy, grabbed) {
    this.#gesture();
    const lens = lensOf(cameraOf(this.goal), this.width / this.height);
    const reach = grabbed ? dot(sub(grabbed, lens.eye), lens.forward) : this.goal.distance;
    const depth = clamp(reach, this.goal.distance * 0.01, this.goal.distance * 100);
    const pixel = 2 * lens.tanY * depth / this.height;
    this.#shift(add(scale(lens.right, -dx * pixel), scale(lens.up, dy * pixel)));
  }

  /** Moves eye and target. @param {Vec3} way */
  #shift(way) {
    if (this.walker) return;
    this.#setGoal({ ...this.goal, target: add(this.goal.target, way) });
  }

  /**
   * Scales the distance to the point under a pixel; that point stays under the pixel. In the modes
   * that move the eye, moves forward instead.
   * @param {number} x @param {number} y @param {number} factor  Below 1: closer.
   */
  zoom(x, y, factor) {
    this.#gesture();
    this.zoomAbout(this.pointUnder(x, y), factor);
  }

  /** Scales the distance to a point. @param {Vec3} point @param {number} factor  Below 1: closer. */
  zoomAbout(point, factor) {
    if (this.walker || !(factor > 0)) return;
    const near = Math.min(distanceOf(eyeOf(this.goal), point), this.goal.distance);
    const allowed = factor < 1 ? Math.max(factor, Math.min(this.least / near, 1))
      : Math.min(factor, Math.max(this.most / this.goal.distance, 1));
    this.#setGoal({
      ...this.goal,
      target: addScaled(point, sub(this.goal.target, point), allowed),
      distance: this.goal.distance * allowed,
    });
  }

  /** Changes the speed of flying and walking. @param {number} factor */
  changeSpeed(factor) {
    this.speedFactor = clamp(this.speedFactor * factor, 0.01, 100);
  }

  /** Flies to a camera. @param {Camera} camera */
  flyTo(camera) {
    this.#flyTo(poseOf(camera));
  }

  /** @param {Pose} pose */
  #flyTo(pose) {
    this.stop();
    if (this.mode === 'walk') this.setMode('fly');
    if (this.reducedMotion || apart(this.shown, pose) < REACHED) this.goal = this.shown = pose;
    else this.flight = new Flight(this.shown, pose, FLIGHT_SECONDS);
  }

  /** Shows the whole scene from the present direction. */
  frame() {
    this.#flyTo(framed(this.goal, this.scene.bounds, this.width / this.height));
  }

  /** Shows the scene from a side. @param {string} name */
  view(name) {
    if (name === 'home') return this.flyTo(this.scene.home);
    this.#flyTo(framed(turnedTo(this.goal, VIEWS[name]), this.scene.bounds, this.width / this.height));
  }

  /** Turns to a point and comes closer to it. @param {Vec3} point */
  focus(point) {
    const away = distanceOf(eyeOf(this.shown), point);
    const distance = clamp(away * 0.5, Math.min(this.scene.voxelSize * 20, Math.max(away, this.least)), this.most);
    this.#flyTo({ ...this.shown, target: point, distance });
  }

  /** Ends a flight, because a gesture takes over. */
  #gesture() {
    if (this.flight) this.stop();
  }

  /** Sets a goal, unless it is too far away or not finite. @param {Pose} pose */
  #setGoal(pose) {
    const { bounds } = this.scene, away = distanceOf(pose.target, middleOf(bounds));
    if (isFinitePose(pose) && away < 2 * this.most + length(bounds.low) * 1e-9) this.goal = pose;
  }

  /**
   * Advances by `time` seconds. Returns whether the camera still moves.
   * @param {number} time @param {Input} input
   */
  step(time, input) {
    const asked = input.move.some((x) => x !== 0) || input.turn.some((x) => x !== 0) || input.zoom !== 0;
    if (this.flight && asked) this.stop();
    if (this.flight) {
      this.shown = this.goal = this.flight.at(time);
      if (this.flight.isOver) this.flight = null;
      return true;
    }
    if (input.turn[0] !== 0 || input.turn[1] !== 0) {
      const speed = TURN_SPEED * time * (this.mode === 'orbit' ? 1 : clamp(this.goal.fov / 65, 0.1, 1));
      const sign = this.mode === 'orbit' ? -1 : 1;
      this.#turn(input.turn[0] * speed * sign, input.turn[1] * speed * sign, this.pivot);
    }
    let moving = asked;
    if (this.walker) {
      moving = this.walker.step(time, input, this.goal, this.speedFactor) || moving;
      this.goal = withEye(this.goal, this.walker.eye);
      this.shown = withEye(this.shown, this.walker.eye);
    } else {
      moving = this.#travel(time, input) || moving;
    }
    const before = this.shown;
    this.shown = between(this.shown, this.goal, covered(time, this.lag), this.pivot);
    if (!isFinitePose(this.shown)) this.shown = this.goal = before;
    if (apart(this.shown, this.goal) > REACHED) return true;
    this.shown = this.goal;
    return moving;
  }

  /** Flies, or in orbit moves the target and the distance. @param {number} time @param {Input} input */
  #travel(time, input) {
    const lag = this.reducedMotion ? 0 : SPEED_LAG;
    const fast = input.fast ? 4 : 1;
    const zoom = accelerated([this.zoomSpeed, 0, 0], [input.zoom * 1.5 * fast, 0, 0], time, lag);
    this.zoomSpeed = Math.abs(zoom.speed[0]) > 1e-3 || input.zoom !== 0 ? zoom.speed[0] : 0;
    if (this.zoomSpeed !== 0) this.zoomAbout(this.goal.target, Math.exp(-zoom.way[0]));

    const wished = input.move.some((x) => x !== 0);
    if (!wished && this.speed.every((x) => x === 0)) return this.zoomSpeed !== 0;
    const pace = this.mode === 'orbit' ? this.goal.distance * 0.7 : this.#flyingSpeed(time) * this.speedFactor;
    const forward = forwardOf(this.goal), up = this.goal.compass.up;
    const right = normalized(cross(forward, up), this.goal.compass.east);
    // In orbit, forward is along the ground: the target keeps its height.
    const ahead = this.mode === 'orbit' ? cross(up, right) : forward;
    const direction = add(add(scale(right, input.move[0]), scale(up, input.move[1])), scale(ahead, input.move[2]));
    const wish = scale(direction, pace * fast / Math.max(1, length(direction)));
    const { speed, way } = accelerated(this.speed, wish, time, lag);
    const start = this.goal.target;
    this.#shift(way);
    this.speed = !wished && length(speed) < this.goal.distance * 1e-3 ? [0, 0, 0] : speed;
    // Keys need no second lag: the speed is smooth already.
    this.shown = { ...this.shown, target: add(this.shown.target, sub(this.goal.target, start)) };
    return true;
  }

  /**
   * Returns the speed of flying: the nearer the surface ahead, the slower.
   * @param {number} time
   */
  #flyingSpeed(time) {
    const eye = eyeOf(this.goal), size = this.size;
    const hit = this.scene.cast(eye, forwardOf(this.goal), size);
    const ahead = clamp(hit ? hit.distance : size * 0.5, this.scene.voxelSize * 4, size * 0.5);
    const rate = this.ahead > 0 ? covered(time, 0.3) : 1;
    this.ahead = Math.exp(mix(Math.log(this.ahead || ahead), Math.log(ahead), rate));
    return Math.max(this.ahead * 0.8, size * 0.01);
  }

  /** Rounds the camera at rest, so that links to it are short and exact. @returns {Camera} */
  settle() {
    const camera = roundCamera(this.camera);
    const pose = poseOf(camera);
    if (!isFinitePose(pose)) return this.camera;
    this.goal = this.shown = { ...pose, yaw: this.shown.yaw + wrapped(pose.yaw - this.shown.yaw) };
    return camera;
  }
}
