/** Reads ZIP files (APPNOTE 6.3, PKWARE) whose entries are stored or deflated. */
import { crc32 } from './zip.js';

/** The end of the directory has 22 bytes and a comment of at most 65,535. */
const END_BYTES = 22, MOST_END_BYTES = END_BYTES + 65535;
/** Files of a ZIP take at most this many bytes, unpacked. */
const MOST_BYTES = 4e9;

/** Whether a file begins as a ZIP does. @param {Blob} file */
export const isZip = async (file) => (await file.slice(0, 4).text()) === 'PK\x03\x04';

/**
 * Returns the files of a ZIP, without folders. Throws Error if it is damaged, encrypted, larger than 4 GB, or packed in another way.
 * @param {Blob} zip @param {(name: string) => boolean} [wanted] @returns {Promise<{name: string, data: Blob}[]>}
 */
export async function unzip(zip, wanted = () => true) {
  const bytesAt = async (/** @type {number} */ begin, /** @type {number} */ length) => {
    if (begin + length > zip.size) throw new Error('the ZIP is damaged: it was cut off');
    return new DataView(await zip.slice(begin, begin + length).arrayBuffer());
  };
  const tailBegin = Math.max(0, zip.size - MOST_END_BYTES), tail = await bytesAt(tailBegin, zip.size - tailBegin);
  let end = tail.byteLength - END_BYTES;
  while (end >= 0 && tail.getUint32(end, true) !== 0x06054b50) --end;
  if (end < 0) throw new Error('the ZIP is damaged: it has no directory');
  const count = tail.getUint16(end + 10, true), directory = await bytesAt(tail.getUint32(end + 16, true), tail.getUint32(end + 12, true));
  const files = [];
  let total = 0;
  for (let i = 0, at = 0; i < count; ++i) {
    if (at + 46 > directory.byteLength || directory.getUint32(at, true) !== 0x02014b50) throw new Error('the ZIP is damaged: its directory is wrong');
    const flags = directory.getUint16(at + 8, true), method = directory.getUint16(at + 10, true), crc = directory.getUint32(at + 16, true);
    const packed = directory.getUint32(at + 20, true), size = directory.getUint32(at + 24, true), place = directory.getUint32(at + 42, true);
    const [nameLength, extra, comment] = [28, 30, 32].map((field) => directory.getUint16(at + field, true));
    if (at + 46 + nameLength > directory.byteLength) throw new Error('the ZIP is damaged: its directory is wrong');
    const name = new TextDecoder().decode(new Uint8Array(directory.buffer, at + 46, nameLength)).replaceAll('\\', '/');
    at += 46 + nameLength + extra + comment;
    if (name.endsWith('/') || !wanted(name)) continue;
    if (name.split('/').includes('..') || name.startsWith('/')) throw new Error(`the ZIP has a file outside of its folder: ${name}`);
    if (flags & 1) throw new Error('the ZIP is encrypted');
    if (method !== 0 && method !== 8) throw new Error(`${name} is packed by method ${method} of ZIP; 0 and 8 are known`);
    if (packed === 0xffffffff || size === 0xffffffff || (total += size) > MOST_BYTES) throw new Error('the files of the ZIP have more than 4 GB');
    const head = await bytesAt(place, 30), begin = place + 30 + head.getUint16(26, true) + head.getUint16(28, true);
    if (begin + packed > zip.size) throw new Error('the ZIP is damaged: it was cut off');
    const data = zip.slice(begin, begin + packed);
    files.push({ name, data: await checked(name, method === 0 ? data.stream() : inflated(data, size, crc), size, crc) });
  }
  return files;
}

/** Returns what a file of the ZIP is packed of, as a gzip: Node 18 and older browsers know no bare deflate. @param {Blob} data @param {number} size @param {number} crc */
function inflated(data, size, crc) {
  const gzip = new Blob([Uint8Array.of(0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255), data, Uint32Array.of(crc, size)]);
  return gzip.stream().pipeThrough(new DecompressionStream('gzip'));
}

/** Reads a file of the ZIP, and compares its size and checksum. @param {string} name @param {ReadableStream} stream @param {number} size @param {number} crc */
async function checked(name, stream, size, crc) {
  const damaged = () => new Error(`the ZIP is damaged: ${name} is not what its directory says`);
  const bytes = new Uint8Array(size), reader = stream.getReader();
  let at = 0;
  try {
    for (let read = await reader.read(); !read.done; read = await reader.read()) {
      if (at + read.value.length > size) throw damaged();
      bytes.set(read.value, at);
      at += read.value.length;
    }
  } catch {
    reader.cancel().catch(() => undefined);
    throw damaged();
  }
  if (at !== size || crc32(bytes) !== crc) throw damaged();
  return new Blob([bytes]);
}
