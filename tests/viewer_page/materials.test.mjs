import assert from 'node:assert/strict';
import { test } from 'node:test';

import { countMaterials, idBits, materialOf } from '../../apps/viewer/page/materials.js';
import { DEFAULTS, mergeSettings } from '../../apps/viewer/page/settings.js';
import { settingsFromHash, settingsToHash } from '../../apps/viewer/page/settings_link.js';
import { listedIds, materialName, withShown } from '../../apps/viewer/page/ui/materials_panel.js';
import { randomNumbers } from './random.mjs';

/** Packs ids as docs/format.md says of MTID, in pages of 256 cells. */
function packed(ids, materials) {
  const width = idBits(materials), begins = [], bits = [];
  const put = (value, count) => { for (let i = 0; i < count; ++i) bits.push((value >> i) & 1); };
  for (let first = 0; first < ids.length; first += 256) {
    while (bits.length % 8) bits.push(0);
    begins.push(bits.length / 8);
    const page = ids.slice(first, first + 256);
    for (let at = 0; at < page.length;) {
      let end = at;
      while (end < page.length && page[end] === page[at]) ++end;
      put(page[at], width);
      put(end === page.length ? 1 : 0, 1);
      if (end < page.length) {
        const below = 31 - Math.clz32(end - at);
        put(below, 3);
        put((end - at) - (1 << below), below);
      }
      at = end;
    }
  }
  const words = new Uint32Array(Math.ceil(bits.length / 32) + 1);
  bits.forEach((bit, i) => { if (bit) words[i >> 5] |= 1 << (i & 31); });
  return { materials, begins: Uint32Array.from(begins), words };
}

test('the example of docs/format.md: three cells of material 4, then material 2', () => {
  const pages = { materials: 5, begins: Uint32Array.from([0]), words: Uint32Array.from([0x0a94]) };
  assert.deepEqual([0, 1, 2, 3, 4, 200].map((number) => materialOf(pages, number)), [4, 4, 4, 2, 2, 2]);
});

test('every cell has the material that was packed', () => {
  for (const materials of [1, 2, 3, 25, 65535]) {
    const random = randomNumbers(materials), ids = [];
    while (ids.length < 1500) {
      const id = Math.floor(random() * materials), length = 1 + Math.floor(random() ** 4 * 300);
      for (let i = 0; i < length; ++i) ids.push(id);
    }
    const pages = packed(ids, materials);
    ids.forEach((id, number) => assert.equal(materialOf(pages, number), id, `cell ${number} of ${materials}`));
  }
});

test('counts are those of the cells of the finest level', () => {
  // Two levels: the root, its children 0 and 7, with the voxels 0, 1 and 3. Numbers: 0; 1, 2, 3; 4, 5.
  const dag = { levels: 2, shown: 2, origin: [0, 0, 0], voxelSize: 1, nodes: new Uint32Array(), leaves: Uint32Array.from([0x3, 0x08000000]) };
  const pages = packed([1, 2, 2, 0, 1, 1], 3);
  assert.deepEqual(countMaterials(dag, { finest: 2, cells: 6 }, pages), [1, 1, 1]);
  assert.deepEqual(countMaterials(dag, { finest: 1, cells: 3 }, packed([0, 2, 2], 3)), [0, 0, 2]);
  assert.equal(countMaterials(dag, { finest: 2, cells: 1e9 }, pages), null);
});

test('the list begins with the largest material and leaves out those without cells', () => {
  assert.deepEqual(listedIds(5, [3, 0, 9, 3, 1]), [2, 0, 3, 4]);
  assert.deepEqual(listedIds(3, null), [0, 1, 2]);
  assert.equal(listedIds(65535, null).length, 500);
  assert.deepEqual([materialName(['wood', ''], 0), materialName(['wood', ''], 1), materialName([], 7)], ['wood', 'Material 1', 'Material 7']);
});

test('hidden materials are a setting, and part of a link', () => {
  assert.deepEqual(withShown(withShown([4], 2, false), 4, true), [2]);
  assert.deepEqual(withShown([2, 4], 4, false), [2, 4]);
  const settings = mergeSettings(DEFAULTS, { hidden: [2, 17] });
  assert.equal(settingsToHash(settings), 'hidden=2,17');
  assert.deepEqual(settingsFromHash('#hidden=2,17'), { settings, problems: [] });
  assert.equal(settingsFromHash('#hidden=2,x').problems.length, 1);
  assert.throws(() => mergeSettings(DEFAULTS, { hidden: [-1] }), /"hidden\[0\]" is -1/);
});
