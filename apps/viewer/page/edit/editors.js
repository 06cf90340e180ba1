/** Who makes the edits of the scene: the server of `voxdag view --edit`, or the program in this page. */
import { Program, asFiles } from '../build/program.js';

/** @typedef {import('./client.js').Editor} Editor */

/** Returns the server as an editor. @param {string} secret  Of the page's address. @returns {Editor} */
export const serverEditor = (secret) => ({
  ask: (path, body, writer) => fetch(new URL(`edit/${path}`, document.baseURI), {
    method: 'POST', headers: { 'Voxdag-Token': secret, 'Voxdag-Writer': String(writer) }, body,
  }).catch(() => { throw new Error('The server cannot be reached'); }),
});

/** Edits a scene in this page, in a worker that holds it. @implements {Editor} */
export class PageEditor {
  constructor() {
    /** @type {Program | null} */
    this.program = null;
    /** The file that was saved last. @type {File | null} */
    this.saved = null;
  }

  /** Takes a scene in place of the present one. Throws Error. @param {Blob} scene @param {string} name  Of its file. @param {AbortSignal} signal */
  async begin(scene, name, signal) {
    this.close();
    this.program = await Program.start([{ name, data: scene }], { signal });
    const response = await this.ask('begin', `/in/${name}`, 0);
    if (!response.ok) throw new Error(await response.text());
  }

  /** @param {string} verb @param {string} body @param {number} writer */
  async ask(verb, body, writer) {
    if (this.program === null) throw new Error('no scene is open for edits');
    const { status, answer, files } = await this.program.send({ verb, writer, body });
    [this.saved] = [...asFiles(files), this.saved];
    return new Response(answer, { status });
  }

  /** Gives the memory back. */
  close() {
    this.program?.close();
    this.program = null;
  }
}
