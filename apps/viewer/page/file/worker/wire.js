/**
 * Decodes colours and normals in the wire form (docs/format.md, WCOL and WNRM): the port of
 * layout/wire/. Part of the worker's script: see scene_loader.js.
 */

const { types, lengthBits, lengthContexts, endBits, endContexts, stepBits, weightBits, noWeight } = WIRE.model;

/** Where each kind of context begins: fields of n bits have 2^n contexts. */
const TYPES_AT = 0, LENGTHS_AT = TYPES_AT + (types * types << PAGES.typeBits), ENDS_AT = LENGTHS_AT + (types * lengthContexts << lengthBits);
const STEPS_AT = ENDS_AT + (2 * 3 * endContexts * 2 << endBits), WEIGHTS_AT = STEPS_AT + (types << stepBits);
const CONTEXTS = WEIGHTS_AT + (weightBits * (noWeight + 1) * (noWeight + 1) << weightBits);

/** The coded bits of one segment, and what its contexts have learned. */
class WireDecoder {
  /** @param {Uint8Array} bytes */
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
    this.code = 0;
    this.range = 0xffffffff;
    this.fast = new Uint16Array(CONTEXTS).fill(0x8000);
    this.slow = new Uint16Array(CONTEXTS).fill(0x8000);
    for (let i = 0; i < 5; ++i) this.code = ((this.code << 8) | this.next()) >>> 0;
  }
  next() {
    const at = this.at++;
    return at < this.bytes.length ? this.bytes[at] : 0;
  }
  /** Returns a field of `width` bits, whose contexts begin at `tree`. @param {number} tree @param {number} width */
  field(tree, width) {
    const { fast, slow } = this;
    let prefix = 1;
    for (let i = 0; i < width; ++i) {
      const context = tree + prefix, a = fast[context], b = slow[context];
      const bound = (this.range >>> WIRE.probabilityBits) * ((a + b) >>> 2);
      if (this.code < bound) {
        this.range = bound;
        fast[context] = a + ((0xffff - a) >> WIRE.fast);
        slow[context] = b + ((0xffff - b) >> WIRE.slow);
        prefix = (prefix << 1) | 1;
      } else {
        this.code -= bound;
        this.range -= bound;
        fast[context] = a - (a >> WIRE.fast);
        slow[context] = b - (b >> WIRE.slow);
        prefix <<= 1;
      }
      while (this.range < WIRE.minRange) {
        this.range = (this.range << 8) >>> 0;
        this.code = ((this.code << 8) | this.next()) >>> 0;
      }
    }
    return prefix - (1 << width);
  }
}

/** Writes bits into words, up to the end of a segment. */
class WordBits {
  /** @param {Uint32Array} words */
  constructor(words) {
    this.words = words;
    this.word = 0;
    this.bit = 0;
    this.end = 0;
  }
  /** Returns the number of bits before this one. */
  position() {
    return 32 * this.word + this.bit;
  }
  /** @param {number} width at most 24 @param {number} value */
  put(width, value) {
    this.words[this.word] |= value << this.bit;
    this.bit += width;
    if (this.bit >= 32) {
      this.bit -= 32;
      ++this.word;
      if (this.bit > 0) this.words[this.word] |= value >>> (width - this.bit);
    }
  }
  /** @param {number} width */
  hasRoom(width) {
    return this.position() + width <= this.end;
  }
  toWholeByte() {
    this.bit = (this.bit + 7) & ~7;
    if (this.bit === 32) {
      this.bit = 0;
      ++this.word;
    }
  }
}

/** Returns the whole part of the square root. @param {number} value below 2^20 */
function wholeRoot(value) {
  let root = 0;
  for (let bit = 512; bit > 0; bit >>= 1) if ((root + bit) * (root + bit) <= value) root += bit;
  return root;
}

/** The blocks of a segment's pages. */
class WireBlocks {
  /** @param {Uint8Array} coded @param {WordBits} bits @param {number} precision @param {boolean} isNormal */
  constructor(coded, bits, precision, isNormal) {
    this.decoder = new WireDecoder(coded);
    this.bits = bits;
    this.widths = PAGES.channelBits[precision];
    this.unit = PAGES.units[precision];
    this.lengthBits = PAGES.lengthBits[precision];
    this.endWidth = this.widths[0] + this.widths[1] + this.widths[2];
    this.isNormal = isNormal;
    this.type = 0;
    this.typeBefore = 0;
    this.length = 0;
    this.lastEnd = [0, 0, 0];
  }

  /** Returns whether the next page is complete and has room. */
  page() {
    const { decoder, bits, endWidth, unit } = this, { raw, flat } = PAGES, headerBits = PAGES.typeBits + this.lengthBits;
    for (let values = 0; values < PAGES.pageValues;) {
      if (!bits.hasRoom(headerBits)) return false;
      const type = decoder.field(TYPES_AT + ((this.type * types + this.typeBefore) << PAGES.typeBits), PAGES.typeBits);
      const ofLength = values === 0 ? 0 : Math.min(lengthContexts - 1, 1 + (this.length >> 5));
      const length = decoder.field(LENGTHS_AT + ((type * lengthContexts + ofLength) << lengthBits), this.lengthBits);
      const count = unit * (length + 1);
      bits.put(headerBits, (length << PAGES.typeBits) | type);
      this.typeBefore = this.type;
      this.type = type;
      this.length = count - 1;
      values += count;
      const hasStep = type > flat && type < raw, width = hasStep ? type : type > raw ? type - 3 : 0;
      const ends = type === raw ? count * endWidth : type === flat ? endWidth : hasStep ? endWidth + stepBits : 2 * endWidth;
      if (values > PAGES.pageValues || !bits.hasRoom(ends + count * width)) return false;
      for (let i = type === raw ? count : 1; i > 0; --i) this.end(0, this.lastEnd);
      if (hasStep) bits.put(stepBits, decoder.field(STEPS_AT + (type << stepBits), stepBits));
      else if (type > raw) this.end(1, this.lastEnd.slice());
      if (width > 0) this.weights(count, width);
    }
    return true;
  }

  /** Decodes an end like another one, and sets that to it. @param {number} which @param {number[]} like */
  end(which, like) {
    const { widths, bits, decoder } = this, isWide = this.type >= PAGES.raw ? 1 : 0;
    let context = 0;
    for (const channel of [1, 0, 2]) {
      const width = widths[channel], size = 1 << width;
      let expected = like[channel];
      if (channel === 2 && this.isNormal) {
        const x = ((2 * like[0] + 1) << (9 - widths[0])) - 512, y = ((2 * like[1] + 1) << (9 - widths[1])) - 512;
        const left = 512 * 512 - x * x - y * y, z = left > 0 ? wholeRoot(left) : 0, half = size >> 1, height = (z * half) >> 9;
        context = left <= 0 ? 11 : z >= 384 ? 7 : z >= 256 ? 8 : z >= 128 ? 9 : 10;
        expected = like[2] >= half ? Math.min(half + height, size - 1) : Math.max(half - 1 - height, 0);
      }
      const coded = decoder.field(ENDS_AT + ((((which * 3 + channel) * endContexts + context) * 2 + isWide) << endBits), width);
      like[channel] = (expected + coded) & (size - 1);
      const distance = coded < size >> 1 ? coded : size - coded;
      context = Math.min(6, 32 - Math.clz32(distance));
    }
    bits.put(this.endWidth, like[0] | (like[1] << widths[0]) | (like[2] << (widths[0] + widths[1])));
  }

  /** @param {number} count @param {number} width */
  weights(count, width) {
    const { bits, decoder } = this;
    let last = noWeight, before = noWeight;
    for (let i = 0; i < count; ++i) {
      const weight = decoder.field(WEIGHTS_AT + ((((width - 1) * (noWeight + 1) + last) * (noWeight + 1) + before) << weightBits), width);
      before = last;
      last = weight;
      bits.put(width, weight);
    }
  }
}

/** Pages that arrive in the wire form, segment by segment. */
class WirePages {
  /** Reads the header. @param {Uint8Array} head @param {string} id @param {number} length of the chunk @param {number} cells */
  constructor(head, id, length, cells) {
    if (head.length < WIRE.headerBytes) throw brokenFile(`Chunk ${id} ends inside its header.`);
    const view = new DataView(head.buffer, head.byteOffset, head.length);
    this.id = id;
    this.precision = view.getUint32(WIRE.precision, true);
    const values = readSize(view, WIRE.values, `The number of values in ${id}`), wordCount = readSize(view, WIRE.words, `The number of words in ${id}`);
    this.codedBytes = readSize(view, WIRE.codedBytes, `The number of coded bytes in ${id}`);
    if (this.precision >= PAGES.channelBits.length) throw brokenFile(`Chunk ${id} has the unknown precision ${this.precision}.`);
    if (values !== cells) throw brokenFile(`Chunk ${id} has ${values} values for ${cells} cells.`);
    if (8 * wordCount > WIRE.maxExpansion * length) throw brokenFile(`Chunk ${id} expands to ${wordCount} words, more than allowed for its ${length} bytes.`);
    const pages = Math.ceil(values / PAGES.pageValues);
    if (pages > 2 * wordCount || 8 * wordCount >= 2 ** 32) throw brokenFile(`Chunk ${id} has ${wordCount} words for ${pages} pages.`);
    this.segmentCount = Math.ceil(pages / WIRE.segmentPages);
    this.codedAt = WIRE.headerBytes + 16 * this.segmentCount;
    if (this.codedAt + Math.ceil(this.codedBytes / 8) * 8 !== length) throw brokenFile(`Chunk ${id} has ${length} bytes, but its header needs others.`);
    this.begins = new Uint32Array(pages);
    this.words = new Uint32Array(2 * wordCount);
    this.bits = new WordBits(this.words);
    this.isNormal = id === 'WNRM';
    /** @type {{coded: number, pages: number}[]} the ends of segments in bytes */
    this.ends = [];
  }

  /** @param {Uint8Array} table the bytes between the header and the coded bytes */
  readTable(table) {
    const view = new DataView(table.buffer, table.byteOffset, table.length);
    let last = { coded: 0, pages: 0 };
    for (let s = 0; s < this.segmentCount; ++s) {
      const end = { coded: readSize(view, 16 * s, `A segment of ${this.id}`), pages: readSize(view, 16 * s + 8, `A segment of ${this.id}`) };
      if (end.coded < last.coded || end.coded > this.codedBytes) throw brokenFile(`Segment ${s} of ${this.id} ends outside of the coded bytes.`);
      if (end.pages < last.pages || end.pages > 4 * this.words.length) throw brokenFile(`Segment ${s} of ${this.id} has pages outside of the words.`);
      this.ends.push((last = end));
    }
    if (last.coded !== this.codedBytes) throw brokenFile(`Chunk ${this.id} has bytes after its last segment.`);
  }

  /** Decodes a segment. @param {number} segment @param {Uint8Array} coded its bytes */
  decode(segment, coded) {
    const { bits, begins } = this, first = segment * WIRE.segmentPages;
    bits.end = 8 * this.ends[segment].pages;
    const blocks = new WireBlocks(coded, bits, this.precision, this.isNormal);
    for (let page = first; page < Math.min(first + WIRE.segmentPages, begins.length); ++page) {
      begins[page] = bits.position() / 8;
      if (!blocks.page()) throw brokenFile(`Segment ${segment} of ${this.id} has more than its pages hold.`);
      bits.toWholeByte();
    }
    if (bits.position() !== bits.end || blocks.decoder.at !== coded.length) throw brokenFile(`Segment ${segment} of ${this.id} does not end where it should.`);
  }

  /** @returns {{precision: number, begins: Uint32Array, words: Uint32Array}} */
  pages() {
    return { precision: this.precision, begins: this.begins, words: this.words };
  }
}
