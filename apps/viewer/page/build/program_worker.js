/** The worker of one run: see program.js. It stands behind voxdag.js in the worker's script. */

self.onmessage = async ({ data: { module, args, files } }) => {
  const send = (/** @type {any} */ message, /** @type {Transferable[]} */ transfer = []) => /** @type {any} */ (self).postMessage(message, transfer);
  // The page waits for this lock, so it learns when the browser ends the worker.
  const name = `voxdag-${Math.random()}`;
  await new Promise((resolve) => {
    const hold = () => {
      send({ type: 'lock', name });
      resolve(undefined);
      return new Promise(() => undefined);
    };
    // Some pages from disk may have no locks.
    if (navigator.locks) navigator.locks.request(name, hold).catch(resolve);
    else resolve(undefined);
  });
  const out = /** @type {string[]} */ ([]), lines = /** @type {string[]} */ ([]);
  /** @type {WebAssembly.Memory | undefined} */
  let memory;
  try {
    const { FS, callMain } = await /** @type {any} */ (self).voxdagModule({
      print: (/** @type {string} */ line) => out.push(line), printErr: (/** @type {string} */ line) => lines.push(line),
      onProgress: (/** @type {string} */ stage, /** @type {number} */ part) => send({ type: 'progress', part }),
      instantiateWasm(/** @type {WebAssembly.Imports} */ imports, /** @type {(instance: WebAssembly.Instance, module: WebAssembly.Module) => void} */ take) {
        WebAssembly.instantiate(/** @type {WebAssembly.Module} */ (module), imports).then((instance) => {
          memory = Object.values(instance.exports).find((value) => value instanceof WebAssembly.Memory);
          take(instance, module);
        }, (error) => send({ type: 'failed', text: `the program cannot start: ${error.message}` }));
        return {};
      },
    });
    FS.mkdir('/in');
    FS.mkdir('/out');
    if (files.length > 0) FS.mount(FS.filesystems.WORKERFS, { blobs: files }, '/in');
    const status = callMain(args), bytes = memory?.buffer.byteLength ?? 0;
    const written = FS.readdir('/out').filter((/** @type {string} */ file) => FS.isFile(FS.stat(`/out/${file}`).mode))
      .map((/** @type {string} */ file) => ({ name: file, bytes: FS.readFile(`/out/${file}`) }));
    send({ type: 'done', status, out: out.join('\n'), lines, files: written, bytes }, written.map((/** @type {{bytes: Uint8Array}} */ file) => file.bytes.buffer));
  } catch (error) {
    const text = String(/** @type {any} */ (error)?.message ?? error);
    send({ type: 'failed', text: /memory|OOM|alloc/i.test(text) || error instanceof RangeError ? 'it needs more memory than the browser gives' : `the program has failed: ${text}` });
  }
};
