/** A scene in memory: rays, points, and its file in other formats. */
import { SceneLoader } from './page/file/scene_loader.js';
import { boundsOf, firstView, sceneInfo } from './page/scene_info.js';
import { SceneMemory } from './page/scene_memory.js';
import { cast, contains, guessUp } from './page/trace.js';
import { asBlob, run } from './run.js';

/** @typedef {import('./index.js').Vec3} Vec3 */
/** @typedef {import('./index.js').Hit} Hit */
/** @typedef {import('./index.js').Scene} SceneFace */

/** @implements {SceneFace} */
class Scene {
  #memory;
  #dag;

  /** @param {SceneMemory} memory  With all levels. @param {import('./index.js').Bytes} bytes  The file. */
  constructor(memory, bytes) {
    this.#memory = memory;
    const dag = this.#dag = memory.dag(), up = guessUp(dag);
    this.info = sceneInfo(memory.info, up, 1, true);
    this.info.bounds = boundsOf(dag) ?? this.info.bounds;
    this.info.view = firstView(this.info.bounds, memory.info, up, 1);
    this.bytes = bytes;
    /** @type {string[]} */
    this.warnings = [];
  }

  /** @param {Vec3} point */
  contains(point) {
    return contains(this.#dag, point);
  }

  /** @param {Vec3} origin @param {Vec3} direction @param {number} [most] @returns {Hit | null} */
  cast(origin, direction, most) {
    return cast(this.#dag, origin, direction, most);
  }

  /** @param {Hit} hit */
  material({ voxel, level }) {
    return this.#memory.material(voxel, level);
  }

  /** @param {string} format @param {import('./index.js').SaveOptions} [options] */
  async save(format, { args = [], ...job } = {}) {
    const name = `scene.${format}`, { files } = await run(['export', '/in/scene.vdag', '-o', `/out/${name}`, '-q', ...args], [{ name: 'scene.vdag', data: this.bytes }], job);
    const file = files.find((made) => made.name === name);
    if (!file) throw new Error(`.${format} takes several files: ${files.map((made) => made.name).join(', ')}; run() returns them`);
    return file.bytes;
  }
}

/** @type {typeof import('./index.js').open} */
export async function open(data, { signal } = {}) {
  const file = asBlob(data);
  return load(file, signal).catch(async (error) => {
    if (!/has the compact form/.test(error.message)) throw error;
    const { files } = await run(['convert', '/in/scene.vdag', '--plain', '-o', '/out/scene.vdag', '-q'], [{ name: 'scene.vdag', data: file }], { signal });
    return load(asBlob(files[0].bytes), signal);
  });
}

/** Loads a scene with all its levels. @param {Blob} file @param {AbortSignal} [signal] */
async function load(file, signal) {
  signal?.throwIfAborted();
  let scene = file;
  /** @type {SceneMemory | undefined} */
  let memory;
  /** @type {() => void} */
  let cancel = () => {}, close = cancel;
  try {
    await new Promise((resolve, reject) => {
      const loader = new SceneLoader((message) => {
        if (message.type === 'info') {
          scene = message.scene ?? file;
          memory = new SceneMemory(message.info);
          loader.load({ shown: message.info.levels, colors: false, normals: false, materials: message.info.materials !== null, channels: false });
        } else if (message.type === 'error') reject(new Error(`${message.title}. ${message.text}`));
        else if (message.type === 'done') resolve(undefined);
        else memory?.add(message, null);
      });
      close = () => loader.close();
      signal?.addEventListener('abort', cancel = () => reject(signal.reason));
      loader.open({ file }).catch(reject);
    });
  } finally {
    close();
    signal?.removeEventListener('abort', cancel);
  }
  return new Scene(/** @type {SceneMemory} */ (memory), new Uint8Array(await scene.arrayBuffer()));
}
