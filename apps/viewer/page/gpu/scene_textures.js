/** The scene in textures of the graphics card. */
import { DAG } from '../constants.js';
import { idBits } from '../materials.js';
import { channelUniforms } from './color_scale.js';
import { LongTexture, mostTexels } from './long_texture.js';

/** @typedef {import('../file/scene_loader.js').FileInfo} FileInfo */
/** @typedef {import('../file/scene_loader.js').Attributes} Attributes */

/** Returns the finest level of cells that the card can hold. @param {WebGL2RenderingContext} gl @param {FileInfo} info */
export function finestLevelThatFits(gl, info) {
  const most = mostTexels(gl);
  if (info.words <= most && info.leafBlocks <= most) return info.levels;
  let level = info.levels - 2;
  while (level > 1 && info.levelBegin[level] > most) --level;
  return level;
}

export class SceneTextures {
  /**
   * @param {WebGL2RenderingContext} gl @param {FileInfo} info @param {number} words of the levels that will be loaded @param {number} leafBlocks
   * @param {import('../scene_memory.js').Version} version  What to show; it may change.
   */
  constructor(gl, info, words, leafBlocks, version) {
    this.gl = gl;
    this.info = info;
    this.version = version;
    /** The words of values that edits gave to cells. @type {LongTexture | null} */
    this.overlay = null;
    this.nodes = new LongTexture(gl, 'R32UI', words);
    this.leaves = new LongTexture(gl, 'RG32UI', leafBlocks);
    /** @type {LongTexture | null} */
    this.nodeInstances = null;
    /** @type {LongTexture | null} */
    this.leafInstances = null;
    /** @type {{index: Attributes['index'], colorBits: number, normalBits: number, slots: LongTexture, values: (LongTexture | null)[],
     *   materials: {count: number, words: LongTexture, pages: LongTexture} | null} | null} */
    this.look = null;
    /** @type {{of: import('../file/scene_loader.js').Channel, values: LongTexture} | null} */
    this.channel = null;
  }

  /** @param {Attributes} attributes */
  setLook({ index, colors, normals, materials }) {
    const { gl } = this;
    const upload = (/** @type {Uint32Array} */ values) => {
      const texture = new LongTexture(gl, 'R32UI', values.length + 1);
      texture.set(0, values);
      return texture;
    };
    this.look = {
      index, colorBits: colors?.precision ?? -1, normalBits: normals?.precision ?? -1, slots: upload(index.words),
      values: [colors, normals].flatMap((v) => (v === null ? [null, null] : [upload(v.words), upload(v.begins)])),
      materials: materials && { count: materials.materials, words: upload(materials.words), pages: upload(materials.begins) },
    };
  }

  /** Uploads a channel, or none, in place of another. @param {import('../file/scene_loader.js').Channel | null} of */
  setChannel(of) {
    if (this.channel !== null) this.gl.deleteTexture(this.channel.values.texture);
    this.channel = null;
    if (of === null) return;
    this.channel = { of, values: new LongTexture(this.gl, 'R32UI', of.values.length) };
    this.channel.values.set(0, new Uint32Array(of.values.buffer));
  }

  /** Returns the channel that settings show, once it is here. @param {Partial<import('../settings.js').Settings>} settings */
  shownChannel({ channel }) {
    return this.channel?.of.name === channel?.name ? this.channel : null;
  }

  /** Uploads the words of values that edits gave to cells. @param {Uint32Array} words */
  setOverlay(words) {
    if (this.overlay !== null) this.gl.deleteTexture(this.overlay.texture);
    this.overlay = new LongTexture(this.gl, 'R32UI', words.length);
    this.overlay.set(0, words);
  }

  /** Uploads nodes and leaf blocks to larger textures. @param {Uint32Array} nodes @param {Uint32Array} leaves */
  setNodes(nodes, leaves) {
    for (const { texture } of [this.nodes, this.leaves]) this.gl.deleteTexture(texture);
    this.nodes = new LongTexture(this.gl, 'R32UI', nodes.length);
    this.leaves = new LongTexture(this.gl, 'RG32UI', leaves.length / 2);
    this.nodes.set(0, nodes);
    this.leaves.set(0, leaves);
  }

  /** Uploads how many cells each node stands for. @param {Uint8Array} nodes @param {Uint8Array} leaves */
  setInstances(nodes, leaves) {
    this.nodeInstances ??= new LongTexture(this.gl, 'R8UI', nodes.length);
    this.leafInstances ??= new LongTexture(this.gl, 'R8UI', leaves.length);
    this.nodeInstances.set(0, nodes);
    this.leafInstances.set(0, leaves);
  }

  /** The textures that every cast reads. */
  walk() {
    return { u_nodes: this.nodes.texture, u_leaves: this.leaves.texture };
  }

  /**
   * Sets the uniforms of look.glsl and returns its textures.
   * @param {import('./gl_tools.js').Program} program @param {Partial<import('../settings.js').Settings>} wanted
   * @returns {{[name: string]: WebGLTexture}}
   */
  lookTextures(program, wanted) {
    const { gl, look, info, version } = this;
    if (look === null) return {};
    program.uints({ u_color_overlay: version.colors, u_normal_overlay: version.normals });
    const begin = [];
    let at = 0;
    for (let l = 0; l < DAG.maxLevels; ++l) {
      begin.push(at);
      const slots = l < info.levels - 2 ? info.levelBegin[l + 1] - info.levelBegin[l] : 0;
      at += 2 * Math.ceil((slots * look.index.width[l]) / 64);
    }
    const levelBegin = Array.from({ length: DAG.maxLevels }, (_, l) => info.levelBegin[l] ?? 0);
    gl.uniform1iv(program.place('u_slot_width'), look.index.width);
    gl.uniform1uiv(program.place('u_slot_begin'), begin);
    gl.uniform1uiv(program.place('u_level_begin'), levelBegin);
    program.ints({ u_finest: look.index.finest, u_color_bits: wanted.colors ? look.colorBits : -1, u_normal_bits: wanted.normals ? look.normalBits : -1 });
    const channel = this.shownChannel(wanted), shown = channel && channelUniforms(channel.of, wanted.channel?.range ?? null);
    program.ints(shown?.ints ?? { u_channel: -1 });
    program.floats(shown?.floats ?? {});
    const [colorWords, colorPages, normalWords, normalPages] = look.values.map((v) => (v ?? look.slots).texture);
    const u_overlay = (this.overlay ?? look.slots).texture;
    return { u_overlay, u_slots: look.slots.texture, u_color_words: channel?.values.texture ?? colorWords, u_color_pages: colorPages, u_normal_words: normalWords, u_normal_pages: normalPages };
  }

  /**
   * Sets the uniforms of materials.glsl and returns its textures.
   * @param {import('./gl_tools.js').Program} program @param {readonly number[]} hidden  Ids.
   * @returns {{[name: string]: WebGLTexture}}
   */
  hiddenTextures(program, hidden) {
    const materials = this.look?.materials;
    if (!materials) return {};
    if (this.hiddenOf !== hidden) {
      const flags = new Uint8Array(materials.count);
      for (const id of hidden) if (id < flags.length) flags[id] = 1;
      this.hidden ??= new LongTexture(this.gl, 'R8UI', flags.length);
      this.hidden.set(0, flags);
      this.hiddenOf = hidden;
    }
    program.ints({ u_material_bits: idBits(materials.count) });
    program.uints({ u_material_overlay: this.version.materials });
    return { u_material_words: materials.words.texture, u_material_pages: materials.pages.texture, u_hidden_materials: /** @type {LongTexture} */ (this.hidden).texture };
  }
  /** The ids that `hidden` holds. @type {readonly number[] | null} */
  hiddenOf = null;
  /** @type {LongTexture | null} */
  hidden = null;

  #all() {
    return [this.hidden, this.channel?.values ?? null, this.overlay, this.look?.materials?.words ?? null, this.look?.materials?.pages ?? null, this.nodes, this.leaves, this.nodeInstances, this.leafInstances, this.look?.slots ?? null, ...(this.look?.values ?? [])];
  }
  bytes() {
    return this.#all().reduce((sum, texture) => sum + (texture?.bytes ?? 0), 0);
  }
  delete() {
    for (const texture of this.#all()) if (texture) this.gl.deleteTexture(texture.texture);
  }
}
