/**
 * Renders pictures of a scene with WebGL2: samples are found (sample.glsl), lit and added up
 * (light.glsl), and shown (display.glsl).
 */
import { CHANNELS, DAG, GLSL, LIGHT, NORMAL, SAMPLES } from '../constants.js';
import { INSTANCE_STEPS } from '../file/scene_loader.js';
import { environmentOf } from '../environment.js';
import { loadText } from '../file/text_assets.js';
import { distance } from '../math.js';
import { BACKGROUNDS, SHOWS, TONES } from '../settings.js';
import { shownRange } from './color_scale.js';
import { automaticExposure } from './exposure.js';
import { cameraUniforms, groundUniforms, hatchPeriod, lightUniforms, sectionUniforms, skyUniforms } from './frame_uniforms.js';
import { Program, drawAll, makeTarget, makeTexture } from './gl_tools.js';
import { texelBits } from './long_texture.js';
import { SMOOTH_RADIUS } from './smoother.js';
import { samplePlace, sampleTable } from './sample_tables.js';

/** @typedef {import('./picture.js').Picture} Picture */
/** @typedef {import('./scene_textures.js').SceneTextures} SceneTextures */
/** @typedef {import('../settings.js').Settings & {camera: import('../settings.js').Camera}} Settings */
/** @typedef {import('./frame_uniforms.js').Place} Place */

/** Parts of every shader that casts rays. */
const CAST = ['dag', 'grid_ray', 'walk', 'camera'];
const SHADERS = ['quad.vert', ...CAST, 'look', 'materials', 'surface', 'view_sample', 'unit', 'sample', 'sky', 'shade', 'light', 'reproject', 'smooth', 'display', 'hits', 'reduce'];
/** Pixels from which exposure and steps are taken. */
const EXPOSURE_SIZE = [256, 144];
/** Steps after which a cast ends without a hit, so that the graphics card never hangs. */
const MOST_STEPS = 16384;
/** How far places of one surface may be from its plane, in cells or pixels, for the filter of moving pictures. */
const SMOOTH_NEAR = '2.0';

/** Loads the texts of all shaders. @returns {Promise<Map<string, string>>} */
export async function loadShaders() {
  const texts = await Promise.all(SHADERS.map((name) => loadText(`gpu/shaders/${name}.glsl`)));
  return new Map(SHADERS.map((name, i) => [name, texts[i]]));
}

/**
 * The contents of a picture: all but its size.
 * @typedef {{settings: Settings, place: Place, scene: SceneTextures, shown: number, mostInstances: number,
 *   samples: number, quick: boolean, smoothed?: number}} Shot  smoothed: the picture is one for Smoother, by this light sample.
 */

/** Returns whether rays pass through materials of a shot. @param {Shot} shot */
const hasHidden = ({ scene, settings }) => settings.hidden.length > 0 && (scene.look?.materials ?? null) !== null;
/** Returns whether a picture shows light that surfaces reflect: one at rest. @param {Shot} shot */
const hasPaths = ({ settings: { bounces, occlusion, show }, quick, smoothed }) =>
  bounces !== null && occlusion.samples > 0 && show === 'light' && !quick && smoothed === undefined;
const NO_LOOK = { colors: false, normals: false };

export class Renderer {
  /** @param {WebGL2RenderingContext} gl @param {Map<string, string>} shaders */
  constructor(gl, shaders) {
    this.gl = gl;
    this.shaders = shaders;
    if (gl.getExtension('EXT_color_buffer_float') === null) throw new Error('the graphics card cannot draw into textures of floats');
    /** @type {Map<string, Program>} */
    this.programs = new Map();
    this.table = { light: 0, hemisphere: 0, texture: /** @type {WebGLTexture | null} */ (null) };
    /** The map of the environment. @type {{of: import('../environment.js').Environment | null, texture: WebGLTexture}} */
    this.map = { of: null, texture: makeTexture(gl, gl.RGB32F, 1, 1) };
    this.vertices = gl.createVertexArray();
    this.small = makeTexture(gl, gl.RGBA32F, EXPOSURE_SIZE[0], EXPOSURE_SIZE[1]);
    this.smallTarget = makeTarget(gl, [this.small]);
  }

  /** Begins to compile the programs of the usual picture. */
  warmUp() {
    for (const name of ['sample', 'light', 'reproject', 'smooth', 'display', 'reduce']) this.program(name);
  }

  /**
   * Returns a program, which begins to compile with the first call.
   * @param {string} name @param {boolean} [look]  With colours and normals. @param {boolean} [hidden]  Rays pass hidden materials.
   * @param {boolean} [paths]  Light is reflected.
   */
  program(name, look = false, hidden = false, paths = false) {
    const key = `${name}${look ? ' with colours' : ''}${hidden ? ' without hidden materials' : ''}${paths ? ' with paths' : ''}`;
    let program = this.programs.get(key);
    if (program === undefined) {
      const text = (/** @type {string} */ part) => this.shaders.get(part) ?? '';
      const cast = ['dag', 'grid_ray', ...(look || hidden ? ['look'] : []), ...(hidden ? ['materials'] : []), 'walk', 'camera'];
      const parts = {
        sample: [...cast, 'surface', 'view_sample', 'unit', 'sample'],
        light: [...cast, ...(paths ? ['surface', 'view_sample'] : []), 'unit', 'sky', 'shade', 'light'],
        reproject: ['camera', 'unit', 'reproject'], smooth: ['camera', 'unit', 'sky', 'shade', 'smooth'],
        hits: [...cast, 'hits'], display: ['sky', 'display'], reduce: ['reduce'],
      }[name] ?? [];
      const precision = ['float', 'int', 'sampler2D', 'usampler2D'].map((type) => `precision highp ${type};\n`).join('');
      const head = `#version 300 es\n${precision}${GLSL}\n#define SMOOTH_RADIUS ${SMOOTH_RADIUS}\n#define SMOOTH_NEAR ${SMOOTH_NEAR}\n#define TEXEL_BITS ${texelBits(this.gl)}\n#define MOST_STEPS ${MOST_STEPS}\n#define INSTANCE_STEPS ${INSTANCE_STEPS}\n` +
          `#define CUT_ALBEDO vec3(${LIGHT.cutAlbedo})\n#define CHANNEL_COLORS ${CHANNELS.colors.map((c) => `vec3(${c})`)}\n${SHOWS.map((show, i) => `#define SHOW_${show.toUpperCase()} ${i}\n`).join('')}` +
          `${TONES.map((tone, i) => `#define TONE_KIND_${tone.toUpperCase()} ${i}\n`).join('')}` +
          `${BACKGROUNDS.map((name, i) => `#define BACKGROUND_${name.toUpperCase()} ${i}\n`).join('')}` +
          (look ? '#define HAS_LOOK\n' : '') + (hidden ? '#define HAS_HIDDEN\n' : '') + (paths ? '#define HAS_PATHS\n' : '');
      const fragment = head + parts.map(text).join('\n');
      program = new Program(this.gl, `#version 300 es\n${text('quad.vert')}`, fragment, key);
      this.programs.set(key, program);
    }
    return program;
  }

  /** Makes the table of at least these numbers of samples per set. @param {number} light @param {number} hemisphere */
  prepareTable(light, hemisphere) {
    const { gl, table } = this;
    if (light <= table.light && hemisphere <= table.hemisphere) return;
    light = Math.max(light, table.light);
    hemisphere = Math.max(hemisphere, table.hemisphere);
    gl.deleteTexture(table.texture);
    const { values, width } = sampleTable(hemisphere, light), texture = makeTexture(gl, gl.RGBA32F, width, SAMPLES.sets);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, SAMPLES.sets, gl.RGBA, gl.FLOAT, values);
    this.table = { light, hemisphere, texture };
  }

  /** Sets the uniforms of sky.glsl and returns its texture. @param {Program} program @param {Shot} shot @returns {{u_map: WebGLTexture}} */
  setSky(program, { place, settings }) {
    const { gl } = this, environment = environmentOf(settings.environment.map);
    if (environment !== null && environment !== this.map.of) {
      const { side, texels } = environment;
      gl.deleteTexture(this.map.texture);
      this.map = { of: environment, texture: makeTexture(gl, gl.RGB32F, side, side) };
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, side, side, gl.RGB, gl.FLOAT, texels);
    }
    program.floats(skyUniforms(place, settings));
    program.ints({ u_map_side: environment?.side ?? 0 });
    return { u_map: this.map.texture };
  }

  /** Returns the rays per view sample of the sun and of occlusion. @param {Shot} shot */
  raysPerSample({ settings, samples }) {
    return {
      light: settings.sun.angle > 0 ? Math.ceil(LIGHT.shadowSamples / samples) : 1,
      occlusion: Math.ceil(settings.occlusion.samples / samples),
    };
  }

  /** Sets what all casts need. @param {Program} program @param {Shot} shot @param {Picture} picture */
  setCast(program, shot, picture) {
    const { settings, place } = shot;
    program.floats(cameraUniforms(place, settings.camera, picture.width, picture.height));
    program.floats(sectionUniforms(place, settings.section));
    program.floats({ u_sample: samplePlace(picture.samples), u_lod: settings.lod });
    program.uints({ u_root: shot.scene.version.root });
    program.ints({ u_levels: shot.scene.info.levels, u_shown: Math.min(shot.shown, settings.level ?? DAG.maxLevels), u_show: SHOWS.indexOf(settings.show) });
  }

  /** Sets what sky.glsl and shade.glsl need. Returns the texture. @param {Program} program @param {Shot} shot */
  setShade(program, shot) {
    const { settings, place, scene } = shot;
    program.floats(lightUniforms(place, settings));
    const [least, most] = shownRange(settings.show, scene.info.levels, shot.mostInstances) ?? [0, 1];
    program.floats({ u_least: least, u_most: most, u_view_distance: distance(settings.camera.eye, settings.camera.target) / place.side });
    program.ints({ u_sky_occluded: settings.occlusion.samples > 0 });
    return this.setSky(program, shot);
  }

  /** Sets what view_sample.glsl needs, but for the look. @param {Program} program @param {Shot} shot */
  setViewSample(program, { settings, place, quick }) {
    program.floats({ u_cube_pixels: settings.cubes, u_hatch_period: hatchPeriod(place, settings) });
    program.ints({ u_coarser_fits: quick ? 0 : NORMAL.coarser });
  }

  /**
   * Renders rows of the next sample of a picture, from the top; completes the sample with the last row.
   * @param {Picture} picture @param {Shot} shot @param {number} rows
   */
  render(picture, shot, rows) {
    const { gl } = this;
    const { scene, settings } = shot;
    const end = Math.min(picture.rows + rows, picture.height);
    const y = picture.height - end;
    gl.bindVertexArray(this.vertices);
    gl.viewport(0, 0, picture.width, picture.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, y, picture.width, end - picture.rows);

    const look = scene.look !== null && (settings.colors || settings.normals || scene.shownChannel(settings) !== null);
    const hidden = hasHidden(shot);
    const sample = this.program('sample', look, hidden);
    sample.use();
    this.setCast(sample, shot, picture);
    this.setViewSample(sample, shot);
    sample.floats(groundUniforms(shot.place, settings));
    const sharing = scene.nodeInstances === null ? {} : { u_node_instances: scene.nodeInstances.texture, u_leaf_instances: /** @type {any} */ (scene.leafInstances).texture };
    sample.textures({ u_node_instances: scene.nodes.texture, u_leaf_instances: scene.nodes.texture, ...scene.walk(), ...sharing,
                     ...(look || hidden ? scene.lookTextures(sample, settings) : {}), ...(hidden ? scene.hiddenTextures(sample, settings.hidden) : {}) });
    gl.bindFramebuffer(gl.FRAMEBUFFER, picture.viewTarget);
    drawAll(gl);

    const rays = this.raysPerSample(shot), index = shot.smoothed ?? picture.samples;
    this.prepareTable(rays.light * shot.samples, Math.max(1, rays.occlusion * shot.samples));
    const paths = hasPaths(shot), light = this.program('light', look && paths, hidden, paths);
    light.use();
    this.setCast(light, shot, picture);
    if (paths) this.setViewSample(light, shot);
    const map = this.setShade(light, shot);
    light.ints({
      u_first: picture.samples === 0, u_only_visible: shot.smoothed !== undefined,
      u_index: index, u_light_samples: rays.light, u_occlusion_samples: rays.occlusion,
      u_light_first: settings.sun.angle > 0 ? index * rays.light : 0, u_shadows: settings.shadows,
      u_light_count: this.table.light, u_hemisphere_count: this.table.hemisphere, u_bounces: settings.bounces ?? 0,
    });
    light.textures({ ...scene.walk(), ...map, u_table: this.table.texture, u_start: picture.views[0], u_normal: picture.views[1], u_face: picture.views[2], u_sum: picture.sums[picture.current],
                    ...((look && paths) || hidden ? scene.lookTextures(light, paths ? settings : NO_LOOK) : {}),
                    ...(hidden ? scene.hiddenTextures(light, settings.hidden) : {}) });
    gl.bindFramebuffer(gl.FRAMEBUFFER, picture.sumTargets[1 - picture.current]);
    drawAll(gl);
    gl.disable(gl.SCISSOR_TEST);

    picture.rows = end;
    picture.shot = shot;
    picture.isDisplay = settings.show !== 'light';
    if (end < picture.height) return;
    picture.current = 1 - picture.current;
    picture.rows = 0;
    ++picture.samples;
  }

  /** Returns evenly spread pixels of a texture, 4 numbers each: at most EXPOSURE_SIZE. @param {WebGLTexture} texture @param {Picture} picture @returns {Float32Array} */
  smallCopy(texture, picture) {
    const { gl } = this;
    const width = Math.min(EXPOSURE_SIZE[0], picture.width), height = Math.min(EXPOSURE_SIZE[1], picture.height);
    const reduce = this.program('reduce');
    reduce.use();
    reduce.floats({ u_from: [picture.width, picture.height], u_to: [width, height] });
    reduce.textures({ u_picture: texture });
    gl.bindVertexArray(this.vertices);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.smallTarget);
    gl.viewport(0, 0, width, height);
    drawAll(gl);
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    return pixels;
  }

  /** Returns the exposure that suits a picture with at least one sample. @param {Picture} picture */
  exposureOf(picture) {
    return automaticExposure(this.smallCopy(picture.sums[picture.current], picture), picture.samples);
  }

  /** Returns the mean steps of the last sample's view rays. @param {Picture} picture */
  stepsOf(picture) {
    const pixels = this.smallCopy(picture.views[2], picture);
    let sum = 0;
    for (let i = 3; i < pixels.length; i += 4) sum += pixels[i];
    return sum / (pixels.length / 4);
  }

  /**
   * Shows a picture with at least one sample in a framebuffer: null is the canvas.
   * @param {Picture} picture @param {number} exposure @param {WebGLFramebuffer | null} target @param {number} width @param {number} height
   */
  display(picture, exposure, target, width, height) {
    const { gl } = this;
    const display = this.program('display');
    display.use();
    display.floats({ u_samples: picture.samples, u_canvas: [width, height], u_picture: [picture.width, picture.height],
                    u_exposure: picture.isDisplay ? 0 : exposure });
    const map = picture.shot ? this.setSky(display, picture.shot) : { u_map: this.map.texture };
    if (picture.shot !== null) {
      const { place, settings } = picture.shot;
      display.floats(cameraUniforms(place, settings.camera, picture.width, picture.height));
      display.ints({ u_tone: TONES.indexOf(settings.tone), u_background: BACKGROUNDS.indexOf(settings.background) });
    }
    display.textures({ ...map, u_sum: picture.sums[picture.current] });
    gl.bindVertexArray(this.vertices);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, width, height);
    drawAll(gl);
  }

  /**
   * Returns the cells that the pixels' first rays hit, as hits.glsl writes them, rows from the bottom.
   * @param {Shot} shot @param {number} width @param {number} height @returns {Uint32Array}
   */
  hits(shot, width, height) {
    const { gl } = this;
    const texture = makeTexture(gl, gl.RGBA32UI, width, height), target = makeTarget(gl, [texture]);
    const hidden = hasHidden(shot), program = this.program('hits', false, hidden);
    program.use();
    this.setCast(program, shot, /** @type {any} */ ({ width, height, samples: 0 }));
    program.textures({ ...shot.scene.walk(),
                      ...(hidden ? { ...shot.scene.lookTextures(program, NO_LOOK), ...shot.scene.hiddenTextures(program, shot.settings.hidden) } : {}) });
    gl.bindVertexArray(this.vertices);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, width, height);
    drawAll(gl);
    const cells = new Uint32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, cells);
    gl.deleteFramebuffer(target);
    gl.deleteTexture(texture);
    return cells;
  }
}
