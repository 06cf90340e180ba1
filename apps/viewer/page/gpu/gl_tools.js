/** Small tools around WebGL2: programs, textures and framebuffers. */

/** A program and the places of its uniforms. */
export class Program {
  /**
   * Begins to compile; call `finish` before use.
   * @param {WebGL2RenderingContext} gl @param {string} vertex @param {string} fragment @param {string} name
   */
  constructor(gl, vertex, fragment, name) {
    this.gl = gl;
    this.name = name;
    this.shaders = [compile(gl, gl.VERTEX_SHADER, vertex), compile(gl, gl.FRAGMENT_SHADER, fragment)];
    this.program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const shader of this.shaders) gl.attachShader(this.program, shader);
    gl.linkProgram(this.program);
    /** @type {Map<string, WebGLUniformLocation | null>} */
    this.places = new Map();
    this.isFinished = false;
  }

  /** Checks that it has compiled. Throws Error with the compiler's messages. */
  finish() {
    if (this.isFinished) return;
    const { gl } = this;
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = this.shaders.map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`shader ${this.name}: ${[gl.getProgramInfoLog(this.program), ...logs].filter(Boolean).join('\n')}`);
    }
    for (const shader of this.shaders) gl.deleteShader(shader);
    this.isFinished = true;
  }

  use() {
    this.finish();
    this.gl.useProgram(this.program);
  }

  /** @param {string} name */
  place(name) {
    let place = this.places.get(name);
    if (place === undefined) {
      place = this.gl.getUniformLocation(this.program, name);
      this.places.set(name, place);
    }
    return place;
  }

  /** Sets float uniforms: numbers, vectors of 2 to 4, or arrays of vectors of 3, number by number. @param {{[name: string]: number | readonly number[]}} values */
  floats(values) {
    const { gl } = this;
    for (const [name, value] of Object.entries(values)) {
      const place = this.place(name);
      if (place === null) continue;
      if (typeof value === 'number') gl.uniform1f(place, value);
      else if (value.length === 2) gl.uniform2f(place, value[0], value[1]);
      else if (value.length === 3) gl.uniform3f(place, value[0], value[1], value[2]);
      else if (value.length === 4) gl.uniform4f(place, value[0], value[1], value[2], value[3]);
      else gl.uniform3fv(place, value);
    }
  }

  /** Sets integer and boolean uniforms. @param {{[name: string]: number | boolean}} values */
  ints(values) {
    for (const [name, value] of Object.entries(values)) {
      const place = this.place(name);
      if (place !== null) this.gl.uniform1i(place, Number(value));
    }
  }

  /** Sets unsigned integer uniforms. @param {{[name: string]: number}} values */
  uints(values) {
    for (const [name, value] of Object.entries(values)) this.gl.uniform1ui(this.place(name), value);
  }

  /** Binds textures to units and uniforms. @param {{[name: string]: WebGLTexture | null}} textures */
  textures(textures) {
    const { gl } = this;
    let unit = 0;
    for (const [name, texture] of Object.entries(textures)) {
      const place = this.place(name);
      if (place === null) continue;
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(place, unit++);
    }
  }
}

/** @param {WebGL2RenderingContext} gl @param {number} kind @param {string} text */
function compile(gl, kind, text) {
  const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

/** Returns an empty texture without filtering. @param {WebGL2RenderingContext} gl @param {number} format sized @param {number} width @param {number} height */
export function makeTexture(gl, format, width, height) {
  const texture = /** @type {WebGLTexture} */ (gl.createTexture());
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  return texture;
}

/** Returns a framebuffer that draws into the textures. @param {WebGL2RenderingContext} gl @param {WebGLTexture[]} textures */
export function makeTarget(gl, textures) {
  const target = /** @type {WebGLFramebuffer} */ (gl.createFramebuffer());
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  textures.forEach((texture, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0));
  gl.drawBuffers(textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
  return target;
}

/** Draws one triangle over the viewport. @param {WebGL2RenderingContext} gl */
export function drawAll(gl) {
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

/** Waits until the graphics card has drawn all that was sent, or is lost. @param {WebGL2RenderingContext} gl */
export async function finished(gl) {
  const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  if (sync === null) return;
  do await new Promise((resolve) => setTimeout(resolve, 0));
  while (gl.clientWaitSync(sync, 0, 0) === gl.TIMEOUT_EXPIRED);
  gl.deleteSync(sync);
}
