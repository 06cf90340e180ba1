/**
 * Draws a film of strokes: edits a scene in the page of `voxdag view --edit`, as a person would, and joins screenshots of each
 * step to one picture.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node lab/viewer/strokes.mjs FILE.vdag chromium|firefox OUT.png [#view]
 *
 * The last step takes all strokes back. Fails if its picture differs from the first. Needs `npm ci` in tests/browser.
 */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { launch, open } from '../../tests/browser/browser.mjs';
import { view } from '../../tests/browser/program.mjs';

const SIZE = { width: 480, height: 270 }, COLUMNS = 2;
/** Brush: values of its verb and shape, keys that change its radius, and its colour; then the way over the picture. */
const STEPS = [
  { label: 'before' },
  { label: 'remove, ball', brush: ['remove', 'ball'], keys: ']]', color: '', way: [[0.3, 0.45], [0.7, 0.45]] },
  { label: 'add, box', brush: ['add', 'box'], keys: '[[[[', color: '#3f8fd0', way: [[0.25, 0.75], [0.45, 0.65], [0.7, 0.75]] },
  { label: 'paint, stroke', brush: ['paint', 'capsule'], keys: ']', color: '#d04020', way: [[0.15, 0.3], [0.5, 0.2], [0.85, 0.3]] },
  { label: 'add, stroke', brush: ['add', 'capsule'], keys: '[[[', color: '#e0b020', way: [[0.3, 0.9], [0.5, 0.55], [0.7, 0.9]] },
  { label: 'all undone', undo: 4 },
];

const [file, name, output, hash = ''] = process.argv.slice(2);
if (output === undefined) throw new Error('usage: node strokes.mjs FILE.vdag chromium|firefox OUT.png [#view]');
const browser = await launch(name), server = await view(path.resolve(file), '--edit');
const page = await open(browser, server.url + hash, SIZE);
await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
const version = () => page.evaluate(() => { const { root, colors } = /** @type {any} */ (window).voxdag.viewer.arrival.memory.version; return `${root} ${colors}`; });
const panel = (/** @type {boolean} */ isOpen) => page.evaluate((opens) => {
  const { ui } = /** @type {any} */ (window).voxdag;
  if (opens) ui.open('edit');
  else /** @type {HTMLElement | null} */ (document.querySelector('.panel header button'))?.click();
}, isOpen);
/** Waits until the server has answered all edits and the picture is at rest. */
const rest = async () => {
  for (let last = ''; last !== await version();) {
    last = await version();
    await new Promise((resolve) => setTimeout(resolve, 2500));
  }
};
/** @type {string[]} */
const pictures = [];
for (const { brush, keys = '', color, way = [], undo = 0 } of STEPS) {
  const before = await version();
  if (brush) {
    await panel(true);
    await page.evaluate((values, paint) => {
      for (const value of values) /** @type {HTMLElement} */ (document.querySelector(`.panel input[value=${value}]`)).click();
      const input = /** @type {HTMLInputElement} */ (document.querySelector('.panel input[type=color]'));
      if (paint) input.value = paint;
      input.dispatchEvent(new Event('input'));
    }, brush, color);
    await page.keyboard.press('t');
    for (const key of keys) await page.keyboard.press(/** @type {import('puppeteer-core').KeyInput} */ (key));
    await page.waitForFunction('document.querySelector("canvas.picking") !== null');
    await panel(false);
    const spots = way.map(([x, y]) => [x * SIZE.width, y * SIZE.height]);
    await page.mouse.move(spots[0][0], spots[0][1]);
    await page.mouse.down();
    for (const [x, y] of spots.slice(1)) await page.mouse.move(x, y, { steps: 8 });
    await page.mouse.up();
    await page.waitForFunction((old) => { const { root, colors } = /** @type {any} */ (window).voxdag.viewer.arrival.memory.version; return `${root} ${colors}` !== old; }, {}, before);
    await page.keyboard.press('t');
  }
  for (let i = 0; i < undo; ++i) {
    await page.keyboard.down('Control');
    await page.keyboard.press('z');
    await page.keyboard.up('Control');
    await rest();
  }
  await rest();
  pictures.push(await page.evaluate(async () => {
    const blob = await /** @type {any} */ (window).voxdag.viewer.capture({ samples: 4 });
    return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (byte) => String.fromCharCode(byte)).join(''));
  }));
}
assert.equal(pictures.at(-1), pictures[0], 'all strokes undone, the picture is the one before');
const sheet = await page.evaluate(async (images, labels, columns, { width, height }) => {
  const canvas = document.createElement('canvas'), context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  canvas.width = columns * width;
  canvas.height = Math.ceil(images.length / columns) * height;
  context.font = '14px sans-serif';
  for (const [i, image] of images.entries()) {
    const bytes = Uint8Array.from(atob(image), (c) => c.charCodeAt(0)), x = (i % columns) * width, y = Math.floor(i / columns) * height;
    context.drawImage(await createImageBitmap(new Blob([bytes], { type: 'image/png' })), x, y);
    context.fillStyle = '#000a';
    context.fillRect(x, y + height - 24, context.measureText(labels[i]).width + 16, 24);
    context.fillStyle = '#fff';
    context.fillText(labels[i], x + 8, y + height - 8);
  }
  return canvas.toDataURL('image/png').split(',')[1];
}, pictures, STEPS.map((step) => step.label), COLUMNS, SIZE);
fs.writeFileSync(output, Buffer.from(sheet, 'base64'));
await browser.close();
await server.close();
process.exit(0);
