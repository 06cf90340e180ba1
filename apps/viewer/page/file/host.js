/**
 * Where the page's texts and workers come from: the page itself, or a program that has these modules in a bundle of its own, such as
 * the npm package (apps/npm).
 */

/**
 * A worker of a page, or one of Node with the same face.
 * @typedef {object} HostWorker
 * @property {(message: any) => void} postMessage
 * @property {() => void} terminate
 * @property {((event: {data: any}) => void) | null} onmessage
 * @property {((event: {message?: string}) => void) | null} onerror  The script has failed, or the worker has ended by itself.
 *
 * @typedef {object} Host
 * @property {(path: string) => Promise<string | null>} text  Returns the text of a file of the page, base64 for those that end in .gz; null: it must be fetched.
 * @property {(script: string) => HostWorker} makeWorker  Starts a worker that runs a classic script.
 * @property {() => number} threads  Returns how many threads may work in one memory: browsers let only pages share memory that are isolated from other sites.
 */

/** A page in a single file holds its files in <script type="text/plain" data-path="...">. @type {Host} */
export const host = {
  text: async (path) => document.querySelector(`script[type="text/plain"][data-path="${path}"]`)?.textContent ?? null,
  makeWorker(script) {
    const url = URL.createObjectURL(new Blob([script], { type: 'text/javascript' })), worker = new Worker(url);
    URL.revokeObjectURL(url);
    return /** @type {any} */ (worker);
  },
  threads: () => (globalThis.crossOriginIsolated ? navigator.hardwareConcurrency : 1),
};

/** Replaces parts of the host, before any other module asks it. @param {Partial<Host>} parts */
export function provide(parts) {
  Object.assign(host, parts);
}
