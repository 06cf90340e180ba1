/**
 * Runs the voxdag command line in the page: build/voxdag.js and build/voxdag.wasm.gz, if the page has them. Each run has a
 * worker and an instance of its own: its memory goes when it ends, and a run that fails harms no other.
 */
import { packedFile } from '../file/byte_source.js';
import { loadText } from '../file/text_assets.js';

/** @typedef {{name: string, data: Blob}} InputFile  The program sees it as /in/NAME. */
/**
 * What a run has left: its exit status, its standard output, the lines of its standard error, the files in /out, and the
 * bytes of memory that it took.
 * @typedef {{status: number, out: string, lines: string[], files: File[], bytes: number}} Result
 */
/** @typedef {{onProgress?: (part: number) => void, signal?: AbortSignal}} Job */

/** Returns whether the page has the program. */
export const hasProgram = () => document.querySelector('[data-program]') !== null;

/** @type {Promise<{script: string, module: WebAssembly.Module}> | null} */
let loading = null;

/** Loads and compiles the program, the first time. */
function load() {
  loading ??= (async () => {
    const [program, worker, packed] = await Promise.all([
      loadText('build/voxdag.js'), loadText('build/program_worker.js'), packedFile('build/voxdag.wasm.gz')]);
    return { script: URL.createObjectURL(new Blob([program, '\n', worker], { type: 'text/javascript' })), module: await WebAssembly.compile(packed) };
  })();
  loading.catch(() => { loading = null; });
  return loading;
}

/**
 * Runs the program, and returns what it has left if its exit status is 0.
 * Throws Error with one line: what the program says, that its worker has ended, or that there is too little memory.
 * @param {string[]} args @param {InputFile[]} files @param {Job} [job]  `signal` ends the run. @returns {Promise<Result>}
 */
export async function run(args, files, { onProgress, signal } = {}) {
  const { script, module } = await load();
  signal?.throwIfAborted();
  const worker = new Worker(script), watch = new AbortController();
  try {
    const result = await new Promise((resolve, reject) => {
      const died = () => reject(new Error('the browser has ended the work, perhaps because memory was short'));
      signal?.addEventListener('abort', () => reject(new Error('cancelled')), { signal: watch.signal });
      worker.onerror = died;
      worker.onmessage = ({ data }) => {
        if (data.type === 'progress') onProgress?.(data.part);
        else if (data.type === 'lock') watchLock(data.name, watch.signal, died);
        else if (data.type === 'failed') reject(new Error(data.text));
        else resolve(data);
      };
      worker.postMessage({ module, args, files });
    });
    if (result.status !== 0) throw new Error(errorLine(result.lines) ?? `the program ended with status ${result.status}`);
    return { ...result, files: result.files.map((/** @type {{name: string, bytes: BlobPart}} */ { name, bytes }) => new File([bytes], name)) };
  } finally {
    watch.abort();
    worker.terminate();
  }
}

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
