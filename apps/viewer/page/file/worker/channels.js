/**
 * Reads the channels of cells (docs/format.md, CHAN): their list, and the words of one. Part of the worker's script: see
 * scene_loader.js.
 */

/** Reads the list of the channels. @param {BlobSource | ServerSource} source @param {Uint8Array} head @param {Chunk} chunk */
async function readChannelList(source, head, { offset, length }) {
  const { headerBytes, entryBytes, most, kinds } = CHANNELS;
  const bytes = await readPart(source, head, { offset, length: Math.min(length, headerBytes + most * entryBytes) });
  if (bytes.length < headerBytes) throw brokenFile('Chunk CHAN ends inside its header.');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length), count = view.getUint32(CHANNELS.channels, true);
  if (count < 1 || headerBytes + count * entryBytes > bytes.length) throw brokenFile(`Chunk CHAN has no room for the ${count} channels of its header.`);
  const values = readSize(view, CHANNELS.values, 'The number of values in CHAN'), list = [];
  let at = offset + headerBytes + count * entryBytes;
  for (let i = 0; i < count; ++i) {
    const entry = headerBytes + i * entryBytes, bound = view.getFloat64(entry + CHANNELS.bound, true), kind = kinds[view.getUint32(entry + CHANNELS.kind, true)];
    const name = /^([\w.-]{1,63})\0/.exec(String.fromCharCode(...bytes.subarray(entry, entry + CHANNELS.nameBytes)))?.[1];
    if (name === undefined || kind === undefined || !(bound >= 0 && bound < Infinity)) throw brokenFile(`Channel ${i} of CHAN has no valid name, kind and bound.`);
    const size = 8 * readSize(view, entry + CHANNELS.words, `The size of channel ${name}`);
    list.push({ name, kind, bound, values, offset: at, length: size });
    at += size;
  }
  if (at !== offset + length) throw brokenFile(`The channels of CHAN end at byte ${at} instead of ${offset + length}.`);
  return list;
}

/**
 * Checks the words of a channel, so that nothing that the graphics card reads leads outside of them.
 * @param {Uint32Array} words  Halves of the file's words. @param {{name: string, values: number}} channel @param {number} cells
 */
function checkChannel(words, { name, values }, cells) {
  if (values !== cells) throw brokenFile(`Channel ${name} has ${values} values for ${cells} cells.`);
  const blocks = Math.ceil(values / CHANNELS.blockValues);
  if (4 * blocks > words.length) throw brokenFile(`Channel ${name} ends inside its blocks.`);
  for (let i = 0; i < blocks; ++i) {
    const begin = words[4 * i] + 2 ** 32 * words[4 * i + 1], width = words[4 * i + 3] & 63, count = Math.min(CHANNELS.blockValues, values - CHANNELS.blockValues * i);
    if (width > CHANNELS.maxWidth || 4 * blocks + 2 * (begin + Math.ceil(count * width / 64)) > words.length) throw brokenFile(`Block ${i} of channel ${name} leads outside of its words.`);
  }
}
