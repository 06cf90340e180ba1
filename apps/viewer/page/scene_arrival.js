/**
 * A scene on its way: puts what the loader sends into memory and textures, and reports it by the
 * viewer's events.
 */
import { inlineScene } from './file/byte_source.js';
import { SceneLoader } from './file/scene_loader.js';
import { mostTexels } from './gpu/long_texture.js';
import { SceneTextures, finestLevelThatFits } from './gpu/scene_textures.js';
import { boundsOf, firstView, sceneInfo } from './scene_info.js';
import { SceneMemory } from './scene_memory.js';
import { guessUp } from './trace.js';

/**
 * @typedef {import('./file/scene_loader.js').FileInfo} FileInfo
 * @typedef {import('./file/scene_loader.js').LoaderMessage} LoaderMessage
 * @typedef {import('./viewer_types.js').SceneInfo} SceneInfo
 * @typedef {import('./math.js').Vec3} Vec3
 */

export class SceneArrival {
  /**
   * @param {WebGL2RenderingContext} gl @param {() => number} aspect  Width / height of the picture.
   * @param {(event: string, ...values: any[]) => void} report
   */
  constructor(gl, aspect, report) {
    this.gl = gl;
    this.aspect = aspect;
    this.report = report;
    /** @type {SceneInfo | null} */
    this.info = null;
    /** @type {SceneMemory | null} */
    this.memory = null;
    /** @type {SceneTextures | null} */
    this.textures = null;
    this.bytesLoaded = 0;
    /** The scene's file, if it is not on a server. @type {Blob | null} */
    this.file = null;
    this.url = '';
    /** @type {Vec3} The up vector that the shape of the scene suggests. */
    this.guessed = [0, 1, 0];
    /** Whether the loader has sent all that it can: it has finished or failed. */
    this.hasEnded = false;
    /** How many requests the loader has not done. */
    this.asked = 0;
    /** The channel that was asked for last. */
    this.channel = '';
    this.ended = this.#newEnd();
    this.loader = new SceneLoader((message) => this.#take(message));
  }
  /** @type {() => void} */
  #resolve = () => {};
  /** @returns {Promise<void>} */
  #newEnd() {
    return new Promise((resolve) => { this.#resolve = resolve; });
  }

  /**
   * Begins to load: from bytes, from an address, from a file of this computer, or else from the page itself or the file beside it.
   * @param {{url?: string, bytes?: BlobPart, file?: Blob}} from
   */
  async open({ url, bytes, file }) {
    if (bytes !== undefined) file = new Blob([bytes]);
    if (file === undefined && url === undefined) file = (await inlineScene()) ?? undefined;
    if (file === undefined) this.url = url ?? 'scene.vdag';
    else this.file = file;
    await this.loader.open(file !== undefined ? { file } : { url: this.url });
  }

  /** Returns the scene's file. Throws Error if its server does not send it. @returns {Promise<Blob>} */
  async source() {
    if (this.file !== null) return this.file;
    const response = await fetch(new URL(this.url, document.baseURI));
    if (!response.ok) throw new Error(`${this.url}: the server answers ${response.status}`);
    return response.blob();
  }

  /** Levels of cells that have arrived. */
  get shown() {
    return this.memory?.shown ?? 0;
  }

  /** @param {LoaderMessage} message */
  #take(message) {
    switch (message.type) {
      case 'info':
        if (message.scene) this.file = message.scene;
        this.report('begin', message.settings);
        return this.#begin(message.info, message.bytes);
      case 'progress':
        if (message.channel) return this.report('progress', { bytes: message.bytes, total: message.channel.length, channel: message.channel.name });
        this.bytesLoaded = message.bytes;
        return this.report('progress', { bytes: message.bytes, total: this.info?.fileBytes ?? 0 });
      case 'note':
        return this.report('note', message.text);
      case 'done':
        if (--this.asked <= 0) this.end();
        return message.isScene ? this.report('loaded', { requests: message.requests }) : undefined;
      case 'error':
        if (--this.asked <= 0) this.end();
        return this.report('error', { title: message.title, text: message.text, kind: message.title === 'No connection' ? 'network' : 'file' });
      default:
        return this.#add(message);
    }
  }

  /** Makes room for the scene, and asks for its levels. @param {FileInfo} info @param {number} bytes  Loaded so far. */
  #begin(info, bytes) {
    this.memory = new SceneMemory(info, finestLevelThatFits(this.gl, info));
    this.textures = this.#newTextures(this.memory);
    const { finest, isWhole } = this.memory;
    this.info = sceneInfo(info, this.guessed, this.aspect(), isWhole);
    this.bytesLoaded = bytes;
    this.report('info', this.info);
    if (info.isEmpty) this.report('note', 'This scene has no voxels.');
    if (!isWhole) this.report('note', `This scene is too large for the graphics card: it is shown down to level ${finest} of ${info.levels}.`);
    ++this.asked;
    this.loader.load({ shown: finest, colors: info.hasColors && isWhole, normals: info.hasNormals && isWhole, materials: info.materials !== null && isWhole, channels: info.channels.length > 0 && isWhole });
  }

  /** Takes a level or the attributes. @param {LoaderMessage} message */
  #add(message) {
    const { info, memory, textures } = this;
    if (info === null || memory === null || textures === null || (message.type === 'channel' && message.name !== this.channel)) return;
    memory.add(message, textures);
    if (message.type === 'attributes') return this.report('look', {});
    if (message.type === 'channel') return this.report('channel', message.name);
    this.measure();
    if (memory.info.up === null && memory.shown <= 7) this.guessed = guessUp(memory.dag());
    this.fit();
    this.report('level', { level: memory.shown, levels: info.levels, bytes: this.bytesLoaded });
  }

  /** Loads a channel of the file, once its attributes are here and unless it was asked for last; without one of this name, drops the one that is here. @param {string} name */
  show(name) {
    const { memory } = this, channel = memory?.info.channels.find((one) => one.name === name);
    if (name === this.channel || !memory?.attributes) return;
    this.channel = channel ? name : '';
    if (channel === undefined) return memory.setChannel(null, this.textures);
    if (channel.values > mostTexels(this.gl)) return this.report('note', `The channel ${name} is too large for the graphics card.`);
    if (this.hasEnded) this.ended = this.#newEnd();
    this.hasEnded = false;
    ++this.asked;
    this.loader.loadChannel(channel);
  }

  /** Takes the bounds of the cells that have arrived or were edited. */
  measure() {
    if (this.info !== null && this.memory !== null) this.info.bounds = boundsOf(this.memory.dag()) ?? this.info.bounds;
  }

  /** Frames the home view again, after the bounds or the shape of the picture have changed. */
  fit() {
    if (this.info !== null && this.memory !== null) this.info.view = firstView(this.info.bounds, this.memory.info, this.guessed, this.aspect());
  }

  /** Uploads how often nodes are used, unless the textures hold it: they follow each level from then on. */
  showInstances() {
    if (this.memory !== null && this.textures?.nodeInstances === null) this.memory.uploadInstances(this.textures);
  }

  /** Fills new textures, after the graphics card has lost the old ones. */
  restore() {
    if (this.memory === null) return;
    this.textures = this.#newTextures(this.memory);
    this.memory.restore(this.textures);
  }

  /** @param {SceneMemory} memory */
  #newTextures({ info, nodes, leaves, version }) {
    return new SceneTextures(this.gl, info, nodes.length, leaves.length / 2, version);
  }

  /** Ends the wait for the scene. */
  end() {
    this.hasEnded = true;
    this.#resolve();
  }

  close() {
    this.loader.close();
    this.textures?.delete();
    this.textures = null;
    this.end();
  }
}
