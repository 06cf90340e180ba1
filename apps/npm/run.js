/** Runs the command line. */
import { plainLine, runForBytes } from './page/build/program.js';

/** Returns data as a Blob. @param {import('./index.js').Data} data @returns {Blob} */
export const asBlob = (data) => (data instanceof Blob ? data : new Blob([/** @type {BlobPart} */ (data)]));

/** Returns a file as the program takes it. @param {import('./index.js').NamedFile} file */
export function inputOf({ name, data }) {
  if (!name || name.startsWith('/') || name.split('/').includes('..')) throw new Error(`"${name}": the name of a file is a relative path without ".."`);
  return { name, data: asBlob(data) };
}

/** @type {typeof import('./index.js').run} */
export async function run(args, files = [], { signal, onProgress } = {}) {
  try {
    const { out, lines, files: made } = await runForBytes(args, files.map(inputOf), { signal, onProgress });
    return { out, warnings: lines.filter((line) => line.startsWith('voxdag: warning: ')).map(plainLine), files: made };
  } catch (error) {
    signal?.throwIfAborted();
    throw error;
  }
}
