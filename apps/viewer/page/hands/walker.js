/**
 * A body that walks on voxels: it falls, climbs steps and slides along walls. It feels the scene
 * with rays, in steps of a fixed length, so that a walk does not depend on the frame rate.
 */
import { add, addScaled, clamp, cross, dot, length, mix3, normalized, scale, sub } from '../math.js';
import { rangeAlong } from '../box.js';
import { eyeOf, forwardOf } from './pose.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('./navigator.js').Surroundings} Surroundings
 * @typedef {import('./navigator.js').Input} Input
 * @typedef {import('./pose.js').Pose} Pose
 */

const STEP_SECONDS = 1 / 120;
/** Parts of the height of the eye. */
const STEP_HEIGHT = 0.3, RADIUS = 0.18, HEAD = 0.08;
/** Eye heights per second and per second squared: 1.4 m/s and 9.8 m/s² for eyes at 1.65 m. */
const WALK_SPEED = 1.1, GRAVITY = 5.9, JUMP_SPEED = 2.6, FASTEST_FALL = 12;

export class Walker {
  /** @param {Surroundings} scene @param {Pose} pose */
  constructor(scene, pose) {
    this.scene = scene;
    this.compass = pose.compass;
    const [lowest, highest] = rangeAlong(scene.bounds, pose.compass.up);
    /** Height of the lowest point of the scene: the body falls no deeper. */
    this.floor = lowest;
    const eye = eyeOf(pose);
    const size = Math.max(highest - lowest, scene.voxelSize * 8);
    const below = scene.cast(eye, scale(this.compass.up, -1), size);
    /** Height of the eye above the feet: that of the eye now, if it could be a person's. */
    this.eyeHeight = Math.max(clamp(below ? below.distance : 0, size * 0.03, size * 0.1), scene.voxelSize * 4);
    /** @type {Vec3} */
    this.feet = addScaled(this.#inScene(eye), this.compass.up, -this.eyeHeight);
    /** The way that the eye still has to go to the body, for a smooth start. */
    this.offset = sub(eye, addScaled(this.feet, this.compass.up, this.eyeHeight));
    this.fall = 0;
    this.stands = false;
    /** The height that the eye still has to climb after a step, for a smooth view. */
    this.behind = 0;
    this.unspent = 0;
    /** @type {Vec3} */
    this.speed = [0, 0, 0];
    this.#leaveVoxels();
    /** The eye one step ago. */
    this.before = this.#eyeNow();
  }

  /** The eye at the time of the frame, between two steps. @returns {Vec3} */
  get eye() {
    return mix3(this.before, this.#eyeNow(), this.unspent / STEP_SECONDS);
  }

  #eyeNow() {
    return add(addScaled(this.feet, this.compass.up, this.eyeHeight - this.behind), this.offset);
  }

  /** Returns the nearest point of the scene's bounds, and of a body's height above it. @param {Vec3} point @returns {Vec3} */
  #inScene(point) {
    const { low, high } = this.scene.bounds, room = this.eyeHeight * 1.5;
    /** @param {number} i */
    const limited = (i) => clamp(point[i], low[i] - room, high[i] + room);
    return [limited(0), limited(1), limited(2)];
  }

  /** Rises until the head is free, if the walk starts inside voxels. */
  #leaveVoxels() {
    const up = this.compass.up;
    for (let i = 0; i < 64; ++i) {
      const hit = this.scene.cast(addScaled(this.feet, up, this.eyeHeight), up, this.eyeHeight * HEAD);
      if (!hit || hit.distance > 0) return;
      this.feet = addScaled(this.feet, up, this.eyeHeight * 0.25);
    }
  }

  /**
   * Returns the distance from a point to the first voxel, at most `most`.
   * @param {Vec3} from @param {Vec3} direction @param {number} most
   */
  #free(from, direction, most) {
    const hit = this.scene.cast(from, direction, most);
    return hit ? Math.max(0, hit.distance) : most;
  }

  /**
   * Advances by `time` seconds and returns whether the body moves.
   * @param {number} time @param {Input} input @param {Pose} pose @param {number} speedFactor
   */
  step(time, input, pose, speedFactor) {
    this.unspent = Math.min(this.unspent + time, 0.25);
    let moves = false, rests = false;
    while (this.unspent >= STEP_SECONDS) {
      this.unspent -= STEP_SECONDS;
      this.before = this.#eyeNow();
      rests = !this.#advance(input, pose, speedFactor);
      moves ||= !rests;
    }
    if (rests) this.before = this.#eyeNow();
    return moves || !this.stands;
  }

  /** @param {Input} input @param {Pose} pose @param {number} speedFactor */
  #advance(input, pose, speedFactor) {
    const { up } = this.compass, height = this.eyeHeight, time = STEP_SECONDS;
    const right = normalized(cross(forwardOf(pose), up), this.compass.east);
    const ahead = cross(up, right);
    const pace = WALK_SPEED * height * speedFactor * (input.fast ? 2.5 : 1);
    const wish = add(scale(right, input.move[0] * pace), scale(ahead, input.move[2] * pace));
    const blend = 1 - Math.exp(-time / (this.stands ? 0.06 : 0.4));
    this.speed = add(this.speed, scale(add(wish, scale(this.speed, -1)), blend));
    // East and north apart: a wall along one of them stops that part only.
    let moved = false;
    for (const axis of [this.compass.east, this.compass.north]) {
      const way = dot(this.speed, axis) * time;
      if (Math.abs(way) < height * 1e-5) continue;
      const direction = scale(axis, Math.sign(way));
      const free = this.#room(direction, Math.abs(way));
      if (free < Math.abs(way)) this.speed = addScaled(this.speed, axis, -dot(this.speed, axis));
      this.feet = addScaled(this.feet, direction, free);
      moved ||= free > 0;
    }
    if (this.stands && (input.jump || input.move[1] > 0)) {
      this.fall = -JUMP_SPEED * height;
      this.stands = false;
    }
    moved = this.#upAndDown(time) || moved;
    this.behind = Math.abs(this.behind) > height * 1e-4 ? this.behind * Math.exp(-time / 0.07) : 0;
    const far = length(this.offset) > height * 1e-3;
    this.offset = scale(this.offset, far ? Math.exp(-time / 0.12) : 0);
    return moved || far || this.behind !== 0;
  }

  /** Returns how far the body can go, at most `way`. @param {Vec3} direction @param {number} way */
  #room(direction, way) {
    const { up } = this.compass, height = this.eyeHeight, radius = RADIUS * height;
    const aside = cross(direction, up);
    let free = way;
    for (const level of [STEP_HEIGHT * 1.05, 0.65, 1])
      for (const side of [-0.9, 0, 0.9]) {
        const from = addScaled(addScaled(this.feet, up, level * height), aside, side * radius);
        free = Math.min(free, this.#free(from, direction, way + radius) - radius);
      }
    return Math.max(0, free);
  }

  /** Climbs, stands or falls. @param {number} time */
  #upAndDown(time) {
    const { up, east, north } = this.compass, height = this.eyeHeight, reach = STEP_HEIGHT * height;
    const down = scale(up, -1), radius = RADIUS * height * 0.6;
    const drop = Math.max(0, this.fall * time);
    // The highest ground under the body, below the height that a foot climbs.
    let ground = dot(this.feet, up) - this.floor + reach;
    for (const [x, y] of [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]]) {
      const from = add(addScaled(this.feet, up, reach), add(scale(east, x * radius), scale(north, y * radius)));
      const limit = reach * 2 + drop;
      const free = this.#free(from, down, limit);
      if (free < limit && free > 0) ground = Math.min(ground, free);
    }
    const below = ground - reach;  // how far the feet are above the ground; negative on a step
    if (this.fall < 0) {
      const rise = -this.fall * time;
      const free = this.#free(addScaled(this.feet, up, height), up, rise + HEAD * height) - HEAD * height;
      this.feet = addScaled(this.feet, up, clamp(free, 0, rise));
      this.fall = free < rise * 0.999 ? 0 : this.fall + GRAVITY * height * time;
      return true;
    }
    if (this.stands ? below <= reach : below <= drop) {
      // Rays are exact to a few hundredths of a voxel: a body at rest must not tremble.
      const stepped = Math.abs(below) > height * 1e-4 + this.scene.voxelSize * 0.05;
      if (stepped) {
        if (this.stands) this.behind -= below;
        this.feet = addScaled(this.feet, up, -below);
      }
      this.fall = 0;
      const landed = !this.stands;
      this.stands = true;
      return stepped || landed;
    }
    this.stands = false;
    this.feet = addScaled(this.feet, up, -drop);
    this.fall = Math.min(this.fall + GRAVITY * height * time, FASTEST_FALL * height);
    return true;
  }
}
