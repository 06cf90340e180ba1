/**
 * Loads a scene through a worker. The worker reads the file root first, checks every level, and
 * sends it.
 */
import { CELL_INDEX, CHANNELS, DAG, FILE, PAGES, WIRE } from '../constants.js';
import { host } from './host.js';
import { loadText } from './text_assets.js';

/** Codes of instances are this many times the binary logarithm of the number. */
export const INSTANCE_STEPS = 4;

const PARTS = ['source', 'blob_source', 'container', 'levels', 'attributes', 'wire', 'worker'];

/** A channel: `offset` and `length` are its bytes in the file. @typedef {{name: string, kind: string, bound: number, values: number, offset: number, length: number}} ChannelInfo */
/** @typedef {{name: string, values: Float32Array | Int32Array, range: [number, number]}} Channel */
/**
 * Contents of a file. `levelBegin` are the first words of the levels in NODE.
 * @typedef {{
 *   levels: number, resolution: number, origin: [number, number, number], voxelSize: number, voxels: number,
 *   dagNodesPerLevel: number[], fileBytes: number, isEmpty: boolean,
 *   words: number, leafBlocks: number, levelBegin: number[], hasColors: boolean, hasNormals: boolean, materials: string[] | null, channels: ChannelInfo[],
 *   up: 'x' | 'y' | 'z' | null, unit: import('../settings.js').Unit | null, home: (import('../settings.js').Camera & {sun?: [number, number, number]}) | null, cubes: boolean,
 *   source: {name: string, vertices: number, triangles: number}}} FileInfo
 */
/** @typedef {{precision: number, begins: Uint32Array, words: Uint32Array}} ValuePages */
/** @typedef {{index: {finest: number, cells: number, width: number[], words: Uint32Array}, colors: ValuePages | null, normals: ValuePages | null,
 *   materials: {materials: number, begins: Uint32Array, words: Uint32Array} | null}} Attributes */
/**
 * The messages of the worker; `scene` is the file that was in a page.
 * @typedef {{type: 'info', info: FileInfo, settings: string | null, scene: Blob | null, bytes: number}
 *   | {type: 'progress', bytes: number, channel?: ChannelInfo}
 *   | {type: 'level', level: number, shown: number, words: Uint32Array, codes: Uint8Array | null, mostInstances: number}
 *   | {type: 'leaves', shown: number, halves: Uint32Array, codes: Uint8Array | null, mostInstances: number}
 *   | ({type: 'attributes'} & Attributes)
 *   | ({type: 'channel'} & Channel)
 *   | {type: 'note', text: string} | {type: 'done', requests: number, isScene: boolean}
 *   | {type: 'error', title: string, text: string}} LoaderMessage
 */

/** A scene that is being loaded. */
export class SceneLoader {
  /** @param {(message: LoaderMessage) => void} onMessage */
  constructor(onMessage) {
    this.onMessage = onMessage;
    /** @type {import('./host.js').HostWorker | null} */
    this.worker = null;
    this.closed = false;
  }

  /** Opens a file: at an address, or on this computer. @param {{url?: string, file?: Blob}} from */
  async open(from) {
    const texts = await Promise.all(PARTS.map((name) => loadText(`file/worker/${name}.js`)));
    if (this.closed) return;
    const constants = Object.entries({ FILE, DAG, PAGES, WIRE, CELL_INDEX, CHANNELS, INSTANCE_STEPS }).map(([name, value]) => `const ${name} = ${JSON.stringify(value)};\n`);
    this.worker = host.makeWorker(["'use strict';\n", ...constants, ...texts].join(''));
    this.worker.onmessage = (event) => this.onMessage(event.data);
    this.worker.onerror = (event) => this.onMessage({ type: 'error', title: 'The scene cannot be loaded', text: event.message || 'Its loader failed.' });
    if (from.file !== undefined) this.worker.postMessage({ type: 'open', file: from.file });
    else this.worker.postMessage({ type: 'open', url: new URL(from.url ?? '', document.baseURI).href });
  }

  /** Loads cells down to level `shown`, and then attributes. @param {{shown: number, colors: boolean, normals: boolean, materials: boolean, channels: boolean}} wanted */
  load(wanted) {
    this.worker?.postMessage({ type: 'load', ...wanted });
  }

  /** Loads a channel, after what was asked for before. @param {ChannelInfo} channel */
  loadChannel(channel) {
    this.worker?.postMessage({ type: 'channel', channel });
  }

  close() {
    this.closed = true;
    this.worker?.terminate();
    this.worker = null;
  }
}
