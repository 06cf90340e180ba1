/** Writes ZIP files whose entries are stored as they are (APPNOTE 6.3, PKWARE): for PNGs, which are compressed already. */

const CRC = Uint32Array.from({ length: 256 }, (_, i) => {
  for (let bit = 0; bit < 8; ++bit) i = i & 1 ? (i >>> 1) ^ 0xedb88320 : i >>> 1;
  return i;
});

/** @param {Uint8Array} bytes */
export function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = (crc >>> 8) ^ CRC[(crc ^ byte) & 255];
  return ~crc >>> 0;
}

/** Numbers of 2 and 4 bytes, one after the other, lowest byte first. @param {...[number, 2 | 4]} fields */
function record(...fields) {
  const bytes = new Uint8Array(fields.reduce((sum, [, size]) => sum + size, 0)), view = new DataView(bytes.buffer);
  let at = 0;
  for (const [value, size] of fields) {
    if (size === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += size;
  }
  return bytes;
}

/** A ZIP file that grows. */
export class Zip {
  constructor() {
    /** @type {BlobPart[]} */
    this.parts = [];
    /** @type {BlobPart[]} */
    this.directory = [];
    this.bytes = 0;
    this.count = 0;
  }

  /** Adds a file. Throws Error if the ZIP would pass 4 GB or 65,535 files. @param {string} name @param {Blob} blob */
  async add(name, blob) {
    const label = new TextEncoder().encode(name), bytes = new Uint8Array(await blob.arrayBuffer());
    if (this.bytes + bytes.length + 1e6 > 2 ** 32 || this.count === 65535) throw new Error('a ZIP file has at most 4 GB and 65,535 files');
    // Version 2.0, names in UTF-8, stored, 1 January 1980.
    /** @type {[number, 2 | 4][]} */
    const common = [[20, 2], [0x0800, 2], [0, 2], [0, 2], [0x21, 2], [crc32(bytes), 4], [bytes.length, 4], [bytes.length, 4], [label.length, 2], [0, 2]];
    this.directory.push(record([0x02014b50, 4], [20, 2], ...common, [0, 2], [0, 2], [0, 2], [0, 4], [this.bytes, 4]), label);
    const head = record([0x04034b50, 4], ...common);
    this.parts.push(head, label, blob);
    this.bytes += head.length + label.length + bytes.length;
    ++this.count;
  }

  /** Returns the file. */
  finish() {
    const directory = new Blob(this.directory);
    const end = record([0x06054b50, 4], [0, 2], [0, 2], [this.count, 2], [this.count, 2], [directory.size, 4], [this.bytes, 4], [0, 2]);
    return new Blob([...this.parts, directory, end], { type: 'application/zip' });
  }
}
