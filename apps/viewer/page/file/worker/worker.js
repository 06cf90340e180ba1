/**
 * The worker that loads a scene: root first, each level checked before it is sent. Part of the
 * worker's script: see scene_loader.js, which also lists the messages.
 */

/** The first request holds the head of the file and, of all but the largest files, the first levels. */
const HEAD_BYTES = 1 << 14, SLICE_BYTES = 1 << 22;

/** @type {BlobSource | ServerSource} */
let source;
/** @type {ChunkTable} */
let chunks;
/** @type {Awaited<ReturnType<typeof readSceneInfo>>} */
let info;
/** @type {Uint8Array} */
let head;
let bytesLoaded = 0;
/** The number of cells with attributes. */
let cells = 0;
/** Requests are handled one after the other. @type {Promise<void>} */
let queue = Promise.resolve();

/** @param {any} message @param {ArrayBufferLike[]} [transfer] */
function send(message, transfer) {
  /** @type {any} */ (self).postMessage(message, transfer ?? []);
}

/** Reads bytes in slices and reports each; those of a channel by themselves. @param {number} offset @param {number} length @param {any} [channel] @returns {Promise<Uint8Array>} */
async function readSlices(offset, length, channel) {
  const bytes = new Uint8Array(length);
  let done = 0;
  if (offset < head.length) {
    done = Math.min(length, head.length - offset);
    bytes.set(head.subarray(offset, offset + done));
  }
  while (done < length) {
    const size = Math.min(SLICE_BYTES, length - done);
    await source.read(bytes.subarray(done, done + size), offset + done);
    done += size;
    if (!channel) bytesLoaded += size;
    send({ type: 'progress', bytes: channel ? done : bytesLoaded, channel });
  }
  return bytes;
}

/** @param {string} id @returns {Chunk} */
function chunk(id) {
  return /** @type {Chunk} */ (chunks.get(id));
}

/** Loads the levels of cells up to `shown`. @param {number} shown */
async function loadLevels(shown) {
  const { levels, levelBegin } = info;
  if (info.isEmpty) return;
  /** @type {UpperLevel | null} */
  let above = null;
  let most = 1;
  // The levels that came with the head are shown before anything else is asked for. Then one request
  // brings several small levels: their bytes follow each other.
  let ready = head.subarray(Math.min(chunk('NODE').offset, head.length));
  let readyBegin = 0;
  for (let level = 0; level < Math.min(shown, levels - 2); ++level) {
    const begin = 4 * levelBegin[level], end = 4 * levelBegin[level + 1];
    if (end > readyBegin + ready.length) {
      let last = level + 1;
      while (last < Math.min(shown, levels - 2) && 4 * levelBegin[last + 1] - begin <= SLICE_BYTES / 8) ++last;
      readyBegin = begin;
      ready = await readSlices(chunk('NODE').offset + begin, 4 * levelBegin[last] - begin);
    }
    const words = asWords(ready.slice(begin - readyBegin, end - readyBegin));
    above = checkLevel(level, levelBegin[level], words, above);
    if (above.instances !== null) most = above.instances.reduce((a, b) => Math.max(a, b), most);
    const copy = words.slice(), codes = above.instances === null ? null : codeInstances(above.instances);
    send({ type: 'level', level, shown: level + 1, words: copy, codes, mostInstances: most }, codes === null ? [copy.buffer] : [copy.buffer, codes.buffer]);
  }
  if (shown < levels - 1) return;
  const { offset, length } = chunk('LEAF');
  const halves = asWords(await readSlices(offset, length));
  const instances = checkLeaves(levels - 2, halves, above);
  if (instances !== null) most = instances.reduce((a, b) => Math.max(a, b), most);
  const codes = instances === null ? null : codeInstances(instances);
  send({ type: 'leaves', shown: Math.min(shown, levels), halves, codes, mostInstances: most }, codes === null ? [halves.buffer] : [halves.buffer, codes.buffer]);
}

/**
 * Loads values of cells, in either form. Those in the wire form are decoded while the next arrive.
 * @param {'COLR' | 'NRML'} id @param {'WCOL' | 'WNRM'} wireId @param {number} cells
 */
async function loadValues(id, wireId, cells) {
  if (chunks.has(id)) return parseValues(await readSlices(chunk(id).offset, chunk(id).length), id, cells);
  const { offset, length } = chunk(wireId);
  const wire = new WirePages(await readSlices(offset, Math.min(WIRE.headerBytes, length)), wireId, length, cells);
  wire.readTable(await readSlices(offset + WIRE.headerBytes, wire.codedAt - WIRE.headerBytes));
  /** Begins to read segments from `first` on. @param {number} first */
  const read = (first) => {
    const begin = first === 0 ? 0 : wire.ends[first - 1].coded;
    let last = first + 1;
    while (last < wire.segmentCount && wire.ends[last].coded - begin <= SLICE_BYTES) ++last;
    const bytes = readSlices(offset + wire.codedAt + begin, wire.ends[last - 1].coded - begin);
    bytes.catch(() => undefined);  // `await` below reports it.
    return { first, last, begin, bytes };
  };
  for (let part = wire.segmentCount > 0 ? read(0) : null; part !== null;) {
    const { first, last, begin } = part, bytes = await part.bytes;
    part = last < wire.segmentCount ? read(last) : null;
    for (let s = first; s < last; ++s) wire.decode(s, bytes.subarray((s === 0 ? 0 : wire.ends[s - 1].coded) - begin, wire.ends[s].coded - begin));
  }
  return wire.pages();
}

/** @param {{colors: boolean, normals: boolean, materials: boolean, channels: boolean}} wanted */
async function loadAttributes(wanted) {
  if (info.isEmpty || (!wanted.colors && !wanted.normals && !wanted.materials && !wanted.channels)) return;
  const index = parseCellIndex(await readSlices(chunk('CIDX').offset, chunk('CIDX').length), info.levels);
  if (index.cells >= 2 ** 32) {
    send({ type: 'note', text: 'The viewer cannot show colours and channels of more than 4 G cells.' });
    return;
  }
  cells = index.cells;
  const colors = wanted.colors ? await loadValues('COLR', 'WCOL', index.cells) : null;
  const normals = wanted.normals ? await loadValues('NRML', 'WNRM', index.cells) : null;
  const materials = wanted.materials ? parseMaterials(await readSlices(chunk('MTID').offset, chunk('MTID').length), index.cells) : null;
  send({ type: 'attributes', index, colors, normals, materials },
       [index.words.buffer, ...[colors, normals, materials].flatMap((v) => (v === null ? [] : [v.begins.buffer, v.words.buffer]))]);
}

/** @param {any} request */
async function handle(request) {
  if (request.type === 'open') {
    let settings = null, scene = null;
    if (request.url === undefined) {
      const opened = await openBlob(request.file);
      ({ source, settings } = opened);
      if (opened.source.blob !== request.file) scene = opened.source.blob;
      head = new Uint8Array(Math.min(HEAD_BYTES, source.size));
      await source.read(head, 0);
    } else {
      source = new ServerSource(request.url);
      head = await source.open(HEAD_BYTES);
    }
    bytesLoaded = head.length;
    chunks = await readChunkTable(source, head);
    info = await readSceneInfo(source, head, chunks);
    send({ type: 'info', info, settings, scene, bytes: bytesLoaded });
  } else {
    if (request.type === 'load') {
      await loadLevels(request.shown);
      await loadAttributes(request);
    } else if (cells > 0) {
      const { channel } = request, decoded = decodeChannel(asWords(await readSlices(channel.offset, channel.length, channel)), channel, cells);
      send({ type: 'channel', name: channel.name, ...decoded }, [decoded.values.buffer]);
    }
    send({ type: 'done', requests: source instanceof ServerSource ? source.requests : 0, isScene: request.type === 'load' });
  }
}

self.onmessage = (event) => {
  queue = queue.then(() => handle(event.data)).catch((error) => {
    const known = error instanceof SceneError;
    const text = error instanceof RangeError ? 'There is not enough memory for it.' : String(error?.message ?? error);
    send({ type: 'error', title: known ? error.title : 'The scene cannot be shown', text });
  });
};
