/**
 * Runs the voxdag command line in the page: build/voxdag.js, build/voxdag.worker.js and build/voxdag.wasm.gz, if the page has
 * them. Each run has a worker and an instance of its own, and more workers for its threads: its memory goes when it ends, and a
 * run that fails harms no other.
 */
import { packedFile } from '../file/byte_source.js';
import { host } from '../file/host.js';
import { loadText } from '../file/text_assets.js';

/** @typedef {{name: string, data: Blob}} InputFile  The program sees it as /in/NAME. */
/**
 * What a run has left: its exit status, its standard output, the lines of its standard error, the files in /out, the
 * bytes of memory that it took, and how many threads worked.
 * @typedef {{status: number, out: string, lines: string[], files: File[], bytes: number, threads: number}} Result
 */
/** @typedef {{onProgress?: (part: number) => void, signal?: AbortSignal}} Job */

/** Returns whether the page has the program. */
export const hasProgram = () => document.querySelector('[data-program]') !== null;

/** A thread more takes time to start and some megabytes, and loops wait for the slowest. */
const MOST_THREADS = 16;
/** @type {Promise<{script: string, threadScript: string, module: WebAssembly.Module}> | null} */
let loading = null;

/** Loads and compiles the program, the first time. */
function load() {
  loading ??= (async () => {
    const [program, worker, thread, packed] = await Promise.all([
      loadText('build/voxdag.js'), loadText('build/program_worker.js'), loadText('build/voxdag.worker.js'), packedFile('build/voxdag.wasm.gz')]);
    // Emscripten's worker imports the program, which is before it here.
    return { script: `${program}\n${worker}`, threadScript: `${program}\n${thread}\nself.importScripts = () => {};`, module: await WebAssembly.compile(packed) };
  })();
  loading.catch(() => { loading = null; });
  return loading;
}

/** An instance of the program in a worker of its own, with files that it sees in /in. */
export class Program {
  /** @param {import('../file/host.js').HostWorker} worker @param {Job} job */
  constructor(worker, { onProgress, signal }) {
    this.worker = worker;
    this.watch = new AbortController();
    /** Takes the answer to what was sent. @type {{resolve: (answer: any) => void, reject: (error: Error) => void} | null} */
    this.waiter = null;
    /** Ends when the last answer has come. @type {Promise<any>} */
    this.last = Promise.resolve();
    /** Why it has ended. @type {Error | null} */
    this.end = null;
    const died = () => this.close('the work has ended early, perhaps because memory was short');
    signal?.addEventListener('abort', () => this.close('cancelled'), { signal: this.watch.signal });
    worker.onerror = died;
    worker.onmessage = ({ data }) => {
      if (data.type === 'progress') onProgress?.(data.part);
      else if (data.type === 'lock') watchLock(data.name, this.watch.signal, died);
      else if (data.type === 'failed') this.close(data.text);
      else this.waiter?.resolve(data);
    };
  }

  /** Starts one. Throws Error, also if `signal` has ended the job. @param {InputFile[]} files @param {Job} [job] */
  static async start(files, job = {}) {
    const { script, threadScript, module } = await load();
    job.signal?.throwIfAborted();
    const program = new Program(host.makeWorker(script), job);
    program.worker.postMessage({ module, files, threadScript, threads: Math.min(host.threads(), MOST_THREADS) });
    return program;
  }

  /** Sends work, after the answers to what was sent before. Throws Error if the program ends first. @param {{args: string[]} | {verb: string, writer: number, body: string}} message @returns {Promise<any>} */
  send(message) {
    const answer = this.last.then(() => new Promise((resolve, reject) => {
      if (this.end) return reject(this.end);
      this.waiter = { resolve, reject };
      this.worker.postMessage(message);
    }));
    this.last = answer.catch(() => undefined);
    return answer;
  }

  /** Ends the worker, and gives its memory back. @param {string} [why] */
  close(why = 'the program was closed') {
    this.end ??= new Error(why);
    this.watch.abort();
    this.worker.terminate();
    this.waiter?.reject(this.end);
  }
}

/**
 * Runs the command line, and returns what it has left if its exit status is 0.
 * Throws Error with one line: what the program says, that its worker has ended, or that there is too little memory.
 * @param {string[]} args @param {InputFile[]} files @param {Job} [job]  `signal` ends the run. @returns {Promise<Result>}
 */
export async function run(args, files, job) {
  const result = await runForBytes(args, files, job);
  return { ...result, files: asFiles(result.files) };
}

/**
 * Runs the command line as run() does, and returns its files as bytes: Node 18 has no File.
 * @param {string[]} args @param {InputFile[]} files @param {Job} [job]
 * @returns {Promise<Omit<Result, 'files'> & {files: {name: string, bytes: Uint8Array<ArrayBuffer>}[]}>}
 */
export async function runForBytes(args, files, job) {
  const program = await Program.start(files, job);
  try {
    const result = await program.send({ args });
    if (result.status !== 0) throw new Error(errorLine(result.lines) ?? `the program ended with status ${result.status}`);
    return result;
  } finally {
    program.close();
  }
}

/** @param {{name: string, bytes: BlobPart}[]} files */
export const asFiles = (files) => files.map(({ name, bytes }) => new File([bytes], name));

/** Calls `died` when the worker that holds a lock ends: a browser that ends a worker tells nobody. @param {string} name @param {AbortSignal} signal @param {() => void} died */
function watchLock(name, signal, died) {
  navigator.locks.request(name, { signal }, died).catch(() => undefined);
}

/** Returns a line of the program without its name and the folder of its files. @param {string} line */
export const plainLine = (line) => line.replace(/^voxdag: (?:warning: )?/, '').replaceAll(/\/(?:in|out)\//g, '');

/** Returns the line that says why a run failed. @param {string[]} lines */
export function errorLine(lines) {
  const line = lines.filter((text) => text.startsWith('voxdag: ') && !text.startsWith('voxdag: warning: ')).at(-1) ?? lines.at(-1);
  return line === undefined ? null : plainLine(line);
}
