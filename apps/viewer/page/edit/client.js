/** Sends edits, one request after the other: to the server, or to the program in this page. */
import { parseUpdate } from './update.js';

/** @typedef {import('./update.js').Update} Update */
/** @typedef {{path: string, lines: string[], more: boolean}} Job  Lines of a script, if it is a stroke. */
/**
 * Who makes the edits. `ask` answers a request of apps/viewer/server/edit_answers.hpp with a status of HTTP; it throws Error if no answer comes.
 * @typedef {{ask: (path: string, body: string, writer: number) => Promise<Response>}} Editor
 */

/** Lines of a request, at most: the server takes 64 KB. */
const MOST_LINES = 300;

/** An answer that is no success: `status` is that of HTTP; 0: none came. */
export class Refused extends Error {
  /** @param {string} text @param {number} status */
  constructor(text, status) {
    super(text);
    this.status = status;
  }
}

export class EditClient {
  /**
   * @param {Editor} editor @param {(update: Update, goesOn: boolean) => void} take  Takes what an edit has changed; `goesOn`: its stroke does.
   * @param {(error: Error) => void} fail  Edits that wait are dropped.
   */
  constructor(editor, take, fail) {
    this.editor = editor;
    this.take = take;
    this.fail = fail;
    this.writer = 0;
    /** @type {Job[]} */
    this.jobs = [];
    this.isBusy = false;
    /** Whether the pointer is down. */
    this.isDrawing = false;
  }

  /** @param {string} path @param {string} [body] @returns {Promise<Response>} */
  async ask(path, body = '') {
    const response = await this.editor.ask(path, body, this.writer).catch((error) => {
      throw new Refused(error.message, 0);
    });
    if (!response.ok) throw new Refused((await response.text()).trim() || `The server answers ${response.status}`, response.status);
    return response;
  }

  /** Becomes the page that edits, and takes all edits so far. */
  open() {
    this.#add({ path: 'open', lines: [], more: false });
  }

  /** Adds an edit to a stroke; the first one begins it. @param {string} line @param {boolean} isFirst */
  draw(line, isFirst) {
    const last = this.jobs.at(-1);
    if (!isFirst && last?.path === 'stroke' && last.lines.length < MOST_LINES) last.lines.push(line);
    else this.#add({ path: 'stroke', lines: [line], more: !isFirst });
  }

  undo() {
    this.#add({ path: 'undo', lines: [], more: false });
  }
  redo() {
    this.#add({ path: 'redo', lines: [], more: false });
  }

  /** Returns the name that the editor suggests. */
  async fileName() {
    return (await (await this.ask('file')).text()).trim();
  }
  /** Saves, and returns the name of the file. Throws Refused with status 412 if it exists. @param {string} name @param {boolean} replaces */
  async save(name, replaces) {
    return (await (await this.ask(replaces ? 'save?replace' : 'save', name)).text()).trim();
  }

  /** @param {Job} job */
  #add(job) {
    this.jobs.push(job);
    if (!this.isBusy) this.#work();
  }

  async #work() {
    this.isBusy = true;
    try {
      for (let job = this.jobs.shift(); job; job = this.jobs.shift()) {
        const response = await this.ask(job.more ? `${job.path}?more` : job.path, job.lines.join('\n'));
        const update = parseUpdate(await response.arrayBuffer());
        this.writer = update.writer;
        this.take(update, this.isDrawing || this.jobs.length > 0);
      }
    } catch (error) {
      this.jobs.length = 0;
      this.fail(/** @type {Error} */ (error));
    }
    this.isBusy = false;
  }
}
