/** A flight of the camera from one pose to another. */
import { anglesOf, between, compassOf, eyeOf, forwardOf } from './pose.js';
import { distance as distanceOf } from '../math.js';

/** @typedef {import('./pose.js').Pose} Pose */

/** Returns the place on a curve from 0 to 1 whose speed and acceleration have no jumps. @param {number} t */
const eased = (t) => t * t * t * (t * (6 * t - 15) + 10);

export class Flight {
  /** @param {Pose} from @param {Pose} to @param {number} seconds */
  constructor(from, to, seconds) {
    // The start in the frame of the end; angles differ if their up vectors do.
    const compass = compassOf(to.compass.up);
    this.from = { ...from, compass, ...anglesOf(compass, forwardOf(from)) };
    this.to = to;
    this.seconds = seconds;
    this.time = 0;
    // A camera that only turns its head stays where it is.
    this.pivot = /** @type {'eye' | 'target'} */ (distanceOf(eyeOf(from), eyeOf(to)) < 1e-6 * to.distance ? 'eye' : 'target');
  }
  get isOver() {
    return this.time >= this.seconds;
  }
  /** Advances by `time` seconds and returns the pose there. @param {number} time */
  at(time) {
    this.time += time;
    return this.isOver ? this.to : between(this.from, this.to, eased(this.time / this.seconds), this.pivot);
  }
}
