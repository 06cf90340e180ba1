/**
 * Decides how much the graphics card does at once, so that the page stays smooth: how fine the
 * picture of a moving view is, and how many rows of a still picture are rendered per frame.
 */

const MOVING_MS = 28, STILL_MS = 45;
const LEAST_SCALE = 1 / 16;

export class Pacer {
  constructor() {
    this.movingNs = 60;  // estimated cost of a pixel of a quick picture
    this.stillNs = 120;  // and of a full one
  }

  /** Returns the side of a quick picture's pixels^-1, relative to the canvas: 1/16 to 1. @param {number} pixels of the canvas */
  scale(pixels) {
    const affordable = (MOVING_MS * 1e6) / this.movingNs;
    const scale = Math.sqrt(affordable / pixels);
    // Coarse steps, so that the sharpness does not waver.
    const step = 2 ** (Math.floor(Math.log2(scale) * 4) / 4);
    return Math.min(1, Math.max(LEAST_SCALE, step));
  }

  /** Returns the rows of a full picture to render in this frame. @param {number} width @param {number} height */
  rows(width, height) {
    const rows = Math.floor((STILL_MS * 1e6) / (this.stillNs * width));
    return Math.min(height, Math.max(4, rows));
  }

  /** Learns from a frame. @param {boolean} isMoving @param {number} pixels @param {number} ms */
  learn(isMoving, pixels, ms) {
    const ns = Math.max(0.2, (ms * 1e6) / pixels);
    const key = isMoving ? 'movingNs' : 'stillNs';
    // Slower at once, faster bit by bit.
    this[key] = ns > this[key] ? 0.3 * this[key] + 0.7 * ns : 0.85 * this[key] + 0.15 * ns;
  }
}
