/**
 * The buffers of a picture that is being rendered: the view samples of one sample per pixel, and the
 * sum over samples, twice: one is read while the other is written.
 */
import { makeTarget, makeTexture } from './gl_tools.js';

export class Picture {
  /** @param {WebGL2RenderingContext} gl @param {number} width @param {number} height */
  constructor(gl, width, height) {
    this.gl = gl;
    this.width = width;
    this.height = height;
    this.views = [0, 1, 2].map(() => makeTexture(gl, gl.RGBA32F, width, height));
    this.sums = [0, 1].map(() => makeTexture(gl, gl.RGBA32F, width, height));
    this.viewTarget = makeTarget(gl, this.views);
    this.sumTargets = this.sums.map((sum) => makeTarget(gl, [sum]));
    this.current = 0;
    this.samples = 0;  // in the current sum
    this.rows = 0;     // of the next sample that are done
    /** @type {import('./renderer.js').Shot | null} */
    this.shot = null;  // the contents of the sums
    this.isDisplay = false;  // the sums hold display colours
  }

  /** Begins again without samples. */
  reset() {
    this.samples = 0;
    this.rows = 0;
  }

  bytes() {
    return this.width * this.height * 16 * 5;
  }

  delete() {
    const { gl } = this;
    for (const texture of [...this.views, ...this.sums]) gl.deleteTexture(texture);
    for (const target of [this.viewTarget, ...this.sumTargets]) gl.deleteFramebuffer(target);
  }
}
