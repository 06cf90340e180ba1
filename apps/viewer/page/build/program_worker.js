/**
 * The worker of a program: see program.js. It stands behind voxdag.js in the worker's script. The first message brings the compiled
 * module, files, and the number and the script of its threads; each of the others is a command line, or a request of the editor
 * (apps/wasm/edit.cpp).
 */

/** @typedef {{module: WebAssembly.Module, files: {name: string, data: Blob}[], threads: number, threadScript: string}} Start */
/** @typedef {{FS: any, PThread: any, callMain: (args: string[]) => number, ccall: (name: string, returns: string, types: string[], values: any[]) => number}} Voxdag */

/** @param {any} message @param {Transferable[]} [transfer] */
const send = (message, transfer = []) => /** @type {any} */ (self).postMessage(message, transfer);
const out = /** @type {string[]} */ ([]), lines = /** @type {string[]} */ ([]);
/** @type {WebAssembly.Memory | undefined} */
let memory;

/** Holds a lock for which the page waits, so that it learns when the browser ends the worker. */
function holdLock() {
  const name = `voxdag-${Math.random()}`;
  return new Promise((resolve) => {
    const hold = () => {
      send({ type: 'lock', name });
      resolve(undefined);
      return new Promise(() => undefined);
    };
    const locks = globalThis.navigator?.locks;
    // Some pages from disk, and Node before 24, have no locks.
    if (locks) locks.request(name, hold).catch(resolve);
    else resolve(undefined);
  });
}

/** Makes memory that threads share. Where the browser does not give it room for 4 GiB, it has room for less. */
function sharedMemory() {
  for (let maximum = 65536; ; maximum /= 2) {
    try {
      return new WebAssembly.Memory({ initial: 256, maximum, shared: true });
    } catch (error) {
      if (maximum <= 4096) throw error;
    }
  }
}

/** @param {string} script */
function makeThread(script) {
  if (!('FileReaderSync' in self)) return new (/** @type {any} */ (self).require('node:worker_threads').Worker)(script, { eval: true, execArgv: [] });
  const url = URL.createObjectURL(new Blob([script], { type: 'text/javascript' })), thread = new Worker(url);
  URL.revokeObjectURL(url);
  return thread;
}

/** @param {Start} message @returns {Promise<Voxdag>} */
async function start({ module, files, threads, threadScript }) {
  await holdLock();
  const shared = memory = sharedMemory();
  // Other pages have the class, too, but not its name.
  /** @type {any} */ (self).SharedArrayBuffer ??= shared.buffer.constructor;
  const program = await /** @type {any} */ (self).voxdagModule({
    print: (/** @type {string} */ line) => out.push(line), printErr: (/** @type {string} */ line) => lines.push(line),
    wasmMemory: shared, threads, makeThread: () => makeThread(threadScript), mainScriptUrlOrBlob: 'voxdag.js',
    onProgress: (/** @type {string} */ stage, /** @type {number} */ part) => send({ type: 'progress', part }),
    instantiateWasm(/** @type {WebAssembly.Imports} */ imports, /** @type {(instance: WebAssembly.Instance, module: WebAssembly.Module) => void} */ take) {
      WebAssembly.instantiate(module, imports).then((instance) => take(instance, module), (error) => send({ type: 'failed', text: `the program cannot start: ${error.message}` }));
      return {};
    },
  });
  program.FS.mkdir('/in');
  program.FS.mkdir('/out');
  await addInputs(program.FS, files);
  return program;
}

/** Shows the program its files in /in. @param {any} FS @param {{name: string, data: Blob}[]} files */
async function addInputs(FS, files) {
  if (files.length === 0) return;
  if ('FileReaderSync' in self) return FS.mount(FS.filesystems.WORKERFS, { blobs: files }, '/in');
  // Node reads no part of a Blob at once: the files are copied into memory.
  for (const { name, data } of files) {
    const path = `/in/${name}`;
    FS.mkdirTree(path.slice(0, path.lastIndexOf('/')));
    FS.writeFile(path, new Uint8Array(await data.arrayBuffer()), { canOwn: true });
  }
}

/** Takes the files that the program has written. @param {any} FS */
function takeFiles(FS) {
  const names = FS.readdir('/out').filter((/** @type {string} */ file) => FS.isFile(FS.stat(`/out/${file}`).mode));
  return names.map((/** @type {string} */ name) => {
    const bytes = FS.readFile(`/out/${name}`);
    FS.unlink(`/out/${name}`);
    return { name, bytes };
  });
}

/** @param {Voxdag} program @param {any} message */
function answer({ FS, PThread, callMain, ccall }, { args, verb, writer, body }) {
  if (args) {
    const status = callMain(args);
    return { status, out: out.join('\n'), lines, files: takeFiles(FS), bytes: memory?.buffer.byteLength ?? 0, threads: 1 + PThread.runningWorkers.length };
  }
  const status = ccall('voxdag_edit', 'number', ['string', 'number', 'string'], [verb, writer, body]);
  const at = ccall('voxdag_result', 'number', [], []) >>> 0, size = ccall('voxdag_result_bytes', 'number', [], []) >>> 0;
  return { status, answer: new Uint8Array(/** @type {WebAssembly.Memory} */ (memory).buffer, at, size).slice(), files: takeFiles(FS) };
}

/** @type {Promise<Voxdag> | undefined} */
let program;
self.onmessage = async ({ data }) => {
  try {
    if (data.module) {
      program = start(data);
      await program;
      return;
    }
    const result = answer(/** @type {Voxdag} */ (await program), data);
    send({ type: 'done', ...result }, result.files.map((/** @type {{bytes: Uint8Array}} */ file) => file.bytes.buffer));
  } catch (error) {
    const text = String(/** @type {any} */ (error)?.message ?? error);
    send({ type: 'failed', text: /memory|OOM|alloc/i.test(text) || error instanceof RangeError ? 'it needs more memory than it gets' : `the program has failed: ${text}` });
  }
};
