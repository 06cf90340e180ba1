/**
 * Decides how much the graphics card does at once, so that the page stays smooth: how fine the
 * picture of a moving view is, and how many rows of a still picture are rendered per frame.
 */

/** Milliseconds that a frame of a moving view, and of a still one, may take. */
const MOVING_MS = 28, STILL_MS = 45;
const LEAST_SCALE = 1 / 16, LEAST_ROWS = 4;

export class Pacer {
  constructor() {
    /** Estimated cost of a pixel of a quick picture, in nanoseconds. */
    this.movingNs = 60;
    /** Estimated cost of a sample of a pixel of a full picture, in nanoseconds. */
    this.stillNs = 120;
  }

  /** Returns the side of a quick picture relative to the canvas, from 1/16 to 1. @param {number} pixels  Of the canvas. */
  scale(pixels) {
    const affordable = (MOVING_MS * 1e6) / this.movingNs;
    const scale = Math.sqrt(affordable / pixels);
    // Coarse steps, so that the sharpness does not waver.
    const step = 2 ** (Math.floor(Math.log2(scale) * 4) / 4);
    return Math.min(1, Math.max(LEAST_SCALE, step));
  }

  /** Returns the rows of a full picture to render in this frame. @param {number} width @param {number} height */
  rows(width, height) {
    const affordable = Math.max(LEAST_ROWS, Math.floor((STILL_MS * 1e6) / (this.stillNs * width)));
    // Equal parts: a small rest would look like slow pixels.
    return Math.ceil(height / Math.ceil(height / affordable));
  }

  /** Learns from a frame. @param {boolean} isQuick @param {number} pixels @param {number} ms  The time that they took. */
  learn(isQuick, pixels, ms) {
    const ns = Math.max(0.2, (ms * 1e6) / pixels);
    if (isQuick) this.movingNs = ns > this.movingNs ? slower(this.movingNs, ns) : 0.85 * this.movingNs + 0.15 * ns;
    // A frame of few rows takes as long as one of many: each may have twice as many as the one before.
    else this.stillNs = ns > this.stillNs ? slower(this.stillNs, ns) : Math.max(ns, this.stillNs / 2);
  }
}

/** Returns an estimate that trusts a frame that took longer. @param {number} estimate @param {number} ns */
const slower = (estimate, ns) => 0.3 * estimate + 0.7 * ns;
