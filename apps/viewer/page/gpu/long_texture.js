/** An array of integers in a 2D texture: element i is in column i mod 2^TEXEL_BITS. */
import { makeTexture } from './gl_tools.js';

/** @typedef {'R8UI' | 'R32UI' | 'RG32UI'} LongFormat */

/** Returns TEXEL_BITS for this context. @param {WebGL2RenderingContext} gl */
export function texelBits(gl) {
  return Math.min(14, Math.floor(Math.log2(gl.getParameter(gl.MAX_TEXTURE_SIZE))));
}

/** Returns how many elements fit into a texture. @param {WebGL2RenderingContext} gl */
export function mostTexels(gl) {
  return 2 ** texelBits(gl) * Math.min(16384, gl.getParameter(gl.MAX_TEXTURE_SIZE));
}

export class LongTexture {
  /**
   * Makes room for `length` elements; at least one.
   * @param {WebGL2RenderingContext} gl @param {LongFormat} format @param {number} length
   */
  constructor(gl, format, length) {
    this.gl = gl;
    this.format = format;
    this.width = 2 ** texelBits(gl);
    this.height = Math.max(1, Math.ceil(length / this.width));
    this.perTexel = format === 'RG32UI' ? 2 : 1;
    this.texture = makeTexture(gl, gl[format], this.width, this.height);
    this.bytes = this.width * this.height * (format === 'R8UI' ? 1 : 4 * this.perTexel);
  }

  /**
   * Sets elements from `begin`. @param {number} begin @param {Uint32Array | Uint8Array} values
   */
  set(begin, values) {
    const { gl, width, perTexel } = this;
    const kind = this.format === 'R8UI' ? gl.UNSIGNED_BYTE : gl.UNSIGNED_INT;
    const format = perTexel === 2 ? gl.RG_INTEGER : gl.RED_INTEGER;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const count = values.length / perTexel;
    for (let done = 0; done < count; ) {
      const column = (begin + done) % width, row = Math.floor((begin + done) / width);
      // Whole rows at once, else the rest of a row.
      const rows = column === 0 ? Math.floor((count - done) / width) : 0;
      const size = rows > 0 ? rows * width : Math.min(width - column, count - done);
      const part = values.subarray(done * perTexel, (done + size) * perTexel);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, column, row, rows > 0 ? width : size, rows > 0 ? rows : 1, format, kind, part);
      done += size;
    }
  }
}
