/**
 * Takes the noise out of pictures of a view that moves: each shows few rays of sun and sky per pixel, and these add up over
 * frames (reproject.glsl) and over neighbours (smooth.glsl). The picture of a view at rest does not come here.
 */
import { cameraUniforms, skyUniforms } from './frame_uniforms.js';
import { drawAll, makeTarget, makeTexture } from './gl_tools.js';

/** @typedef {import('./picture.js').Picture} Picture */
/** @typedef {import('./renderer.js').Shot} Shot */

/** Frames that add up, at most: more would follow changes too late. */
const MOST_FRAMES = 16;
/** Degrees of a sun whose shadows have edges. */
const SMALL_SUN = 2;
/** The filter's radius in pixels. */
export const SMOOTH_RADIUS = 2;

/** Returns whether the pictures of a shot have noise. @param {Shot} shot */
export const hasNoise = ({ settings: { show, occlusion, shadows } }) =>
  show === 'occlusion' ? occlusion.samples > 0 : show === 'light' && (occlusion.samples > 0 || shadows);

/** Returns a text that differs if what sky and surfaces do to each other may. @param {Shot} shot */
const stateOf = ({ settings: { occlusion, shadows, section, level, show, lod, cubes, ground, normals, hidden }, shown, scene }) =>
  JSON.stringify([occlusion, shadows, section, level, show, lod, cubes, ground, normals, hidden, shown, scene.look !== null]);

/** What pixels of one frame see, and where they are. */
class SeenBuffers {
  /** @param {WebGL2RenderingContext} gl @param {number} width @param {number} height */
  constructor(gl, width, height) {
    this.gl = gl;
    this.width = width;
    this.height = height;
    this.seen = makeTexture(gl, gl.RGBA16F, width, height);
    this.guide = makeTexture(gl, gl.RGBA32F, width, height);
    this.target = makeTarget(gl, [this.seen, this.guide]);
  }
  delete() {
    for (const texture of [this.seen, this.guide]) this.gl.deleteTexture(texture);
    this.gl.deleteFramebuffer(this.target);
  }
}

export class Smoother {
  /** @param {import('./renderer.js').Renderer} renderer */
  constructor(renderer) {
    this.renderer = renderer;
    /** The frame before, and the one before it. @type {(SeenBuffers | null)[]} */
    this.buffers = [null, null];
    /** @type {{camera: {[name: string]: any}, sun: readonly number[], state: string} | null} */
    this.before = null;
  }

  /** Lights a picture with one sample whose shot is `smoothed`. @param {Picture} picture @param {Shot} shot */
  apply(picture, shot) {
    const { renderer, renderer: { gl } } = this, { width, height } = picture, { place, settings } = shot;
    let [old, now] = this.buffers;
    if (now?.width !== width || now.height !== height) {
      now?.delete();
      now = new SeenBuffers(gl, width, height);
    }
    const camera = /** @type {{[name: string]: any}} */ (cameraUniforms(place, settings.camera, width, height));
    const sun = /** @type {number[]} */ (skyUniforms(place, settings).u_sun), state = stateOf(shot), { before } = this;
    gl.bindVertexArray(renderer.vertices);
    gl.viewport(0, 0, width, height);

    const reproject = renderer.program('reproject');
    reproject.use();
    renderer.setCast(reproject, shot, picture);
    reproject.floats({ u_sample: [0.5, 0.5] });
    if (before !== null)
      for (const name of ['eye', 'forward', 'right', 'up', 'size']) reproject.floats({ [`u_old_${name}`]: before.camera[`u_${name}`] });
    reproject.ints({
      u_most_frames: old !== null && before?.state === state ? MOST_FRAMES : 1,
      u_same_sun: before !== null && sun.every((x, i) => Math.abs(x - before.sun[i]) < 1e-6),
    });
    reproject.textures({ u_seen: picture.sums[picture.current], u_start: picture.views[0], u_normal: picture.views[1],
                         u_old_seen: old?.seen ?? picture.views[0], u_old_guide: old?.guide ?? picture.views[0] });
    gl.bindFramebuffer(gl.FRAMEBUFFER, now.target);
    drawAll(gl);

    const smooth = renderer.program('smooth');
    smooth.use();
    renderer.setCast(smooth, shot, picture);
    const map = renderer.setShade(smooth, shot);
    smooth.floats({ u_sample: [0.5, 0.5] });
    smooth.ints({ u_sun_radius: settings.sun.angle > SMALL_SUN ? SMOOTH_RADIUS : 0 });
    smooth.textures({ ...map, u_seen: now.seen, u_guide: now.guide, u_start: picture.views[0], u_normal: picture.views[1], u_face: picture.views[2] });
    gl.bindFramebuffer(gl.FRAMEBUFFER, picture.sumTargets[1 - picture.current]);
    drawAll(gl);
    picture.current = 1 - picture.current;
    this.buffers = [now, old];
    this.before = { camera, sun, state };
  }

  bytes() {
    return this.buffers.reduce((sum, each) => sum + (each === null ? 0 : each.width * each.height * 24), 0);
  }
}
