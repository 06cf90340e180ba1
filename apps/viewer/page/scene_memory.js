/**
 * The levels of a scene that have arrived, in memory: for rays on the CPU, and to fill textures
 * again after the graphics card has lost them.
 */
import { cellNumber, countMaterials, materialOf, overlayAt, withPlaces } from './materials.js';

/** @typedef {import('./file/scene_loader.js').FileInfo} FileInfo */
/** @typedef {import('./file/scene_loader.js').LoaderMessage} LoaderMessage */
/** @typedef {import('./gpu/scene_textures.js').SceneTextures} SceneTextures */
/** The roots of the DAG and of the values that edits gave to cells. @typedef {{root: number, colors: number, normals: number, materials: number}} Version */

export class SceneMemory {
  /** @param {FileInfo} info @param {number} [finest]  The finest level of cells that is wanted. */
  constructor(info, finest = info.levels) {
    this.info = info;
    this.finest = finest;
    /** Whether all levels are wanted. */
    this.isWhole = this.finest === info.levels;
    this.nodes = new Uint32Array(this.isWhole ? info.words : info.levelBegin[this.finest]);
    this.leaves = new Uint32Array(this.isWhole ? 2 * info.leafBlocks : 0);
    /** The words of values that edits gave to cells. */
    this.overlay = new Uint32Array();
    /** @type {Version} */
    this.version = { root: 0, colors: 0, normals: 0, materials: 0 };
    this.nodeInstances = new Uint8Array(this.nodes.length);
    this.leafInstances = new Uint8Array(this.leaves.length / 2);
    this.shown = 0;
    this.mostInstances = 1;
    /** @type {import('./file/scene_loader.js').Attributes | null} */
    this.attributes = null;
    /** The channel that arrived last. @type {import('./file/scene_loader.js').Channel | null} */
    this.channel = null;
    /** @type {import('./materials.js').CellIndex | null} */
    this.cells = null;
  }

  /** The DAG for rays on the CPU. @returns {import('./trace.js').Dag} */
  dag() {
    const { levels, origin, voxelSize } = this.info;
    return { levels, shown: this.shown, origin, voxelSize, nodes: this.nodes, leaves: this.leaves, root: this.version.root };
  }

  /** Returns the material of a cell; null without materials. @param {import('./math.js').Vec3} voxel  One in the cell. @param {number} level @returns {number | null} */
  material(voxel, level) {
    const { cells, attributes } = this;
    if (!cells || !attributes?.materials) return null;
    const number = cellNumber(this.dag(), cells, voxel, level);
    const given = overlayAt(this.overlay, this.version.materials, voxel, level, this.info.levels, number < 0);
    return given ?? (number < 0 ? null : materialOf(attributes.materials, number));
  }

  /** Returns the value of the channel of a cell; null of cells that edits added. @param {import('./math.js').Vec3} voxel  One in the cell. @param {number} level */
  channelValue(voxel, level) {
    return (this.cells && this.channel?.values[cellNumber(this.dag(), this.cells, voxel, level)]) ?? null;
  }

  /** Returns how many cells each material has; null before all have arrived, and if there are very many. */
  materialCounts() {
    const { attributes } = this;
    if (!attributes?.materials) return null;
    return (this.counts ??= countMaterials(this.dag(), attributes.index, attributes.materials));
  }
  /** @type {number[] | null} */
  counts = null;

  /** Takes a level or the attributes from the loader, and uploads them if there are textures. @param {LoaderMessage} message @param {SceneTextures | null} textures */
  add(message, textures) {
    if (message.type === 'level') {
      const begin = this.info.levelBegin[message.level];
      this.nodes.set(message.words, begin);
      if (message.codes !== null) this.nodeInstances.set(message.codes, begin);
      textures?.nodes.set(begin, message.words);
    } else if (message.type === 'leaves') {
      this.leaves.set(message.halves);
      if (message.codes !== null) this.leafInstances.set(message.codes);
      textures?.leaves.set(0, message.halves);
    } else if (message.type === 'attributes') {
      this.attributes = message;
      this.cells = withPlaces(message.index, this.info.levelBegin);
      textures?.setLook(message);
      return;
    } else if (message.type === 'channel') {
      return this.setChannel(message, textures);
    } else {
      return;
    }
    this.shown = message.shown;
    this.mostInstances = Math.max(this.mostInstances, message.mostInstances);
    if (textures && textures.nodeInstances !== null) this.uploadInstances(textures);
  }

  /** @param {import('./file/scene_loader.js').Channel | null} channel @param {SceneTextures | null} textures */
  setChannel(channel, textures) {
    this.channel = channel;
    textures?.setChannel(channel);
  }

  /** @param {SceneTextures} textures */
  uploadInstances(textures) {
    textures.setInstances(this.nodeInstances, this.leafInstances);
  }

  /** Fills new textures. @param {SceneTextures} textures */
  restore(textures) {
    textures.nodes.set(0, this.nodes);
    textures.leaves.set(0, this.leaves);
    if (this.attributes !== null) textures.setLook(this.attributes);
    if (this.channel !== null) textures.setChannel(this.channel);
    if (this.overlay.length > 0) textures.setOverlay(this.overlay);
  }
}
