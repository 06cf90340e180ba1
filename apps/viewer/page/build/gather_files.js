/** Gathers the files that a person drops, pastes or chooses: single ones, folders, and those of a ZIP. */
import { isZip, unzip } from '../file/unzip.js';

/** @typedef {import('./input_kinds.js').NamedFile} NamedFile */

/** A folder with more files is not a model: someone has dropped a whole disk. */
const MOST_FILES = 20000;

/**
 * Returns the files of a drop or of the clipboard, with their paths. Reads `transfer` before it waits: it is empty later.
 * @param {DataTransfer} transfer @returns {Promise<NamedFile[]>}
 */
export async function filesOf(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()), files = [...transfer.files].map((data) => ({ name: data.name, data }));
  if (!entries.some((entry) => entry?.isDirectory)) return files;
  /** @type {NamedFile[]} */
  const found = [];
  for (const entry of entries) if (entry) await walk(entry, found);
  return found;
}

/** @param {FileSystemEntry} entry @param {NamedFile[]} found */
async function walk(entry, found) {
  if (found.length > MOST_FILES) throw new Error(`a folder of more than ${MOST_FILES} files: choose that of the model`);
  if (entry.isFile) {
    const data = await new Promise((resolve, reject) => /** @type {FileSystemFileEntry} */ (entry).file(resolve, reject));
    found.push({ name: entry.fullPath.replace(/^\/+/, ''), data });
    return;
  }
  const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
  for (;;) {
    // A reader gives a part of the folder at a time.
    /** @type {FileSystemEntry[]} */
    const part = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (part.length === 0) return;
    for (const child of part) await walk(child, found);
  }
}

/** Returns the files of a chooser, with their paths if it chose a folder. @param {FileList} list @returns {NamedFile[]} */
export const chosenFiles = (list) => [...list].map((data) => ({ name: data.webkitRelativePath || data.name, data }));

/** Returns the files; those in it, if there is one file and it is a ZIP. @param {NamedFile[]} files */
export async function unpacked(files) {
  return files.length === 1 && (await isZip(files[0].data)) && !/\.(3mf|npz)$/i.test(files[0].name) ? unzip(files[0].data) : files;
}
