/** Brushes: what a drag over the surface does, as lines of a script of edits. */
import { addScaled, distance, mix } from '../math.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../viewer_types.js').Hit} Hit
 * @typedef {{verb: 'remove' | 'add' | 'paint', shape: 'ball' | 'box' | 'capsule', radius: number, color: string | null, material: number | null}} Brush
 *   radius: world units, half a side for a box; color: "#rrggbb".
 */

/** Way between two edits of a stroke, in radii. */
const SPACING = { ball: 0.5, box: 0.75, capsule: 0.35 };
/** Picks per event of the pointer, at most, and pixels between them, at least. */
const MOST_PICKS = 64, LEAST_PIXELS = 2;

/** Returns the line of a script for a brush at a point, coming from another one. @param {Brush} brush @param {Vec3} from @param {Vec3} to */
export function lineOf({ verb, shape, radius, color, material }, from, to) {
  const ones = /** @type {Vec3} */ ([1, 1, 1]);
  const numbers = shape === 'box' ? [...addScaled(to, ones, -radius), ...addScaled(to, ones, radius)]
    : shape === 'capsule' ? [...from, ...to, radius] : [...to, radius];
  const paint = verb === 'remove' ? [] : [...(color === null ? [] : [color]), ...(material === null ? [] : [`material=${material}`])];
  return [verb, shape, ...numbers, ...paint].join(',');
}

/** A drag with a brush over the scene as it was when the drag began: what the drag adds does not lift the brush. */
export class Stroke {
  /**
   * @param {Brush} brush
   * @param {(x: number, y: number) => Promise<Hit | null>} pick  From the scene before the stroke.
   * @param {(point: Vec3) => number} pixel  Returns the world units per pixel at a point.
   * @param {(line: string, isFirst: boolean) => void} draw @param {number} voxel  Its side.
   */
  constructor(brush, pick, pixel, draw, voxel) {
    this.brush = brush;
    this.pick = pick;
    this.pixel = pixel;
    this.draw = draw;
    this.spacing = Math.max(SPACING[brush.shape] * brush.radius, voxel);
    this.hasDrawn = false;
    /** Where the pointer was, and where the brush was on the surface. @type {{x: number, y: number} | null} */
    this.spot = null;
    /** @type {Vec3 | null} */
    this.last = null;
    this.work = Promise.resolve();
  }

  /** The pointer has come to a pixel. @param {number} x @param {number} y */
  move(x, y) {
    this.work = this.work.then(() => this.#walk(x, y));
  }

  /** @param {number} x @param {number} y */
  async #walk(x, y) {
    const from = this.spot ?? { x, y }, way = Math.hypot(x - from.x, y - from.y);
    this.spot = { x, y };
    const step = this.last ? Math.max(LEAST_PIXELS, this.spacing / this.pixel(this.last)) : LEAST_PIXELS;
    const picks = Math.min(MOST_PICKS, Math.max(1, Math.ceil(way / step)));
    for (let i = 1; i <= picks; ++i) {
      const hit = await this.pick(mix(from.x, x, i / picks), mix(from.y, y, i / picks));
      if (hit) this.#touch(hit.position);
      else this.last = null;
    }
  }

  /** @param {Vec3} point */
  #touch(point) {
    const { brush, last } = this, way = last ? distance(last, point) : Infinity;
    if (way < this.spacing) return;
    // A jump over an edge to a surface behind it is no way of the brush.
    const isJump = way > 2 * brush.radius + 3 * this.spacing;
    this.draw(lineOf(brush, last && !isJump ? last : point, point), !this.hasDrawn);
    this.hasDrawn = true;
    this.last = point;
  }
}
