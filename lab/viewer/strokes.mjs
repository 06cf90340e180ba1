/**
 * Draws a film of strokes: edits a scene in the page of `voxdag view --edit` with a pointer and keys, and joins a picture of each
 * step to a strip. The last step takes all strokes back.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node lab/viewer/strokes.mjs FILE.vdag chromium|firefox OUT.png [#view]
 *
 * Fails if the picture of the last step differs from that of the first. Needs `npm ci` in tests/browser.
 */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { launch, open } from '../../tests/browser/browser.mjs';
import { view } from '../../tests/browser/program.mjs';

const SIZE = { width: 240, height: 240 };
/** A brush: the values of its verb and shape, keys that change its radius, its colour; then the way over the picture, in its sides. */
const STEPS = [
  { label: 'before' },
  { label: 'remove', brush: ['remove', 'ball'], keys: ']]]]]]', color: '', way: [[0.46, 0.42], [0.54, 0.46]] },
  { label: 'paint', brush: ['paint', 'capsule'], keys: '[[[', color: '#2f6fb0', way: [[0.44, 0.58], [0.44, 0.7]] },
  { label: 'add', brush: ['add', 'capsule'], keys: '[', color: '#e0b020', way: [[0.6, 0.14], [0.68, 0.2], [0.74, 0.28]] },
  { label: 'three strokes undone', undo: 3 },
];

const [file, name, output, hash = '#shadows=off'] = process.argv.slice(2);
if (output === undefined) throw new Error('usage: node strokes.mjs FILE.vdag chromium|firefox OUT.png [#view]');
const browser = await launch(name), server = await view(path.resolve(file), '--edit');
const page = await open(browser, server.url + hash, SIZE);
await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
const version = () => page.evaluate(() => Object.values(/** @type {any} */ (window).voxdag.viewer.arrival.memory.version).join());
/** Acts, and waits until the server has answered. @param {() => Promise<unknown>} act */
const change = async (act) => {
  let last = await version();
  await act();
  await page.waitForFunction((old) => Object.values(/** @type {any} */ (window).voxdag.viewer.arrival.memory.version).join() !== old, {}, last);
  do {
    last = await version();
    await new Promise((resolve) => setTimeout(resolve, 2000));
  } while (last !== (await version()));
};
/** Takes a brush and draws with it. @param {string[]} brush @param {string} keys @param {string} color @param {number[][]} way */
const stroke = async (brush, keys, color, way) => {
  await page.evaluate((values, paint) => {
    /** @type {any} */ (window).voxdag.ui.open('edit');
    for (const value of values) /** @type {HTMLElement} */ (document.querySelector(`.panel input[value=${value}]`)).click();
    const input = /** @type {HTMLInputElement} */ (document.querySelector('.panel input[type=color]'));
    if (paint) input.value = paint;
    input.dispatchEvent(new Event('input'));
  }, brush, color);
  await page.keyboard.press('t');
  for (const key of keys) await page.keyboard.press(/** @type {import('puppeteer-core').KeyInput} */ (key));
  // The panel covers a small picture; the brush stays on.
  await page.evaluate(() => /** @type {HTMLElement} */ (document.querySelector('.panel header button')).click());
  const spots = way.map(([x, y]) => [x * SIZE.width, y * SIZE.height]);
  await page.mouse.move(spots[0][0], spots[0][1]);
  await page.mouse.down();
  for (const [x, y] of spots.slice(1)) await page.mouse.move(x, y, { steps: 8 });
  await page.mouse.up();
};

await page.evaluate(() => {
  const { ui, viewer } = /** @type {any} */ (window).voxdag;
  // The home view follows the shape of the picture, and the exposure what it shows.
  viewer.set({ lod: 0, exposure: 0.5, camera: viewer.camera() });
  ui.open('edit');
});
await page.waitForSelector('button[aria-keyshortcuts="T"]', { visible: true });
/** @type {string[]} */
const pictures = [];
for (const { brush, keys = '', color = '', way = [], undo = 0 } of STEPS) {
  if (brush) {
    await change(() => stroke(brush, keys, color, way));
    await page.keyboard.press('Escape');
  }
  for (let i = 0; i < undo; ++i)
    await change(async () => {
      await page.keyboard.down('Control');
      await page.keyboard.press('z');
      await page.keyboard.up('Control');
    });
  pictures.push(await page.evaluate(async (size) => {
    const blob = await /** @type {any} */ (window).voxdag.viewer.capture({ ...size, samples: 8 });
    return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (byte) => String.fromCharCode(byte)).join(''));
  }, SIZE));
}
const strip = await page.evaluate(async (images, labels, { width, height }) => {
  const canvas = document.createElement('canvas'), context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  canvas.width = images.length * width;
  canvas.height = height;
  context.font = '14px sans-serif';
  for (const [i, image] of images.entries()) {
    const bytes = Uint8Array.from(atob(image), (c) => c.charCodeAt(0));
    context.drawImage(await createImageBitmap(new Blob([bytes], { type: 'image/png' })), i * width, 0);
    context.fillStyle = '#0009';
    context.fillRect(i * width, height - 24, context.measureText(labels[i]).width + 16, 24);
    context.fillStyle = '#fff';
    context.fillText(labels[i], i * width + 8, height - 8);
  }
  return canvas.toDataURL('image/png').split(',')[1];
}, pictures, STEPS.map(({ label }) => label), SIZE);
fs.writeFileSync(output, Buffer.from(strip, 'base64'));
assert.ok(pictures.at(-1) === pictures[0], 'all strokes undone, the picture is the one before');
assert.equal(new Set(pictures).size, pictures.length - 1, 'each stroke changes the picture');
await browser.close();
await server.close();
process.exit(0);
