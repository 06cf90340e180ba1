/** The entry for Node: workers are threads, and there is no picture. */
import os from 'node:os';
import { Worker } from 'node:worker_threads';
import { provide } from './page/file/host.js';
import { text } from './texts.js';

/** Gives a thread what scripts of workers expect. */
const PRELUDE = `{
  const { parentPort } = require('node:worker_threads');
  globalThis.self = globalThis;
  globalThis.postMessage = (message, transfer) => parentPort.postMessage(message, transfer);
  parentPort.on('message', (data) => self.onmessage({ data }));
}
`;

/** @typedef {import('./page/file/host.js').HostWorker} HostWorker */

/** @implements {HostWorker} */
class Thread {
  /** @type {HostWorker['onmessage']} */
  onmessage = null;
  /** @type {HostWorker['onerror']} */
  onerror = null;

  /** @param {string} script */
  constructor(script) {
    this.worker = new Worker(PRELUDE + script, { eval: true, execArgv: [] });
    this.worker.on('message', (data) => this.onmessage?.({ data }));
    this.worker.on('error', ({ message }) => this.onerror?.({ message }));
    this.worker.on('exit', () => this.onerror?.({ message: 'The thread has ended.' }));
  }

  /** @param {any} message */
  postMessage(message) {
    this.worker.postMessage(message);
  }

  terminate() {
    this.onerror = null;
    this.worker.terminate();
  }
}

provide({ text, makeWorker: (script) => new Thread(script), threads: () => os.cpus().length });

/** Pages that a server renders import it, too. @returns {never} */
export function createViewer() {
  throw new Error('createViewer needs a browser');
}

export class Hands {
  constructor() {
    throw new Error('Hands need a browser');
  }
}

export { build } from './build.js';
export { run } from './run.js';
export { open } from './scene.js';
