/**
 * Measures edits in headless Chromium, whose graphics card is software: milliseconds from an event of the pointer to the new
 * words in the page, and from there to the frame that shows them.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node lab/viewer/edits.mjs FILE.vdag... [-o result.json]
 *
 * Needs `npm ci` in tests/browser.
 */
import fs from 'node:fs';
import path from 'node:path';
import { launch, open } from '../../tests/browser/browser.mjs';
import { view } from '../../tests/browser/program.mjs';

const DABS = 24, WIDTH = 320, HEIGHT = 200;

const args = process.argv.slice(2), at = args.indexOf('-o');
const output = at < 0 ? null : args.splice(at, 2)[1];
if (args.length === 0) throw new Error('usage: node edits.mjs FILE.vdag... [-o RESULT.json]');

/** @param {number[]} values */
function spread(values) {
  const sorted = values.slice().sort((a, b) => a - b), part = (/** @type {number} */ p) => +sorted[Math.floor(p * (sorted.length - 1))].toFixed(1);
  return { median: part(0.5), p95: part(0.95), most: part(1) };
}

const browser = await launch('chromium'), results = [];
for (const file of args) {
  const server = await view(path.resolve(file), '--edit');
  const page = await open(browser, `${server.url}#ao=0&shadows=off`, { width: WIDTH, height: HEIGHT });
  await page.waitForFunction('window.voxdag.hands.isLoaded');
  await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('edit'));
  await page.waitForSelector('button[aria-keyshortcuts="T"]', { visible: true });
  await page.keyboard.press('t');
  const times = await page.evaluate(async (dabs) => {
    const { viewer } = /** @type {any} */ (window).voxdag, { canvas } = viewer, box = canvas.getBoundingClientRect();
    const send = (/** @type {string} */ type, /** @type {number} */ x, /** @type {number} */ y) => canvas.dispatchEvent(new PointerEvent(type, {
      pointerId: 1, pointerType: 'mouse', isPrimary: true, button: 0, buttons: type === 'pointerup' ? 0 : 1, clientX: box.left + x, clientY: box.top + y, bubbles: true }));
    canvas.setPointerCapture = () => {};  // there is no real pointer
    const next = (/** @type {string} */ event) => new Promise((resolve) => {
      const take = () => { viewer.off(event, take); resolve(performance.now()); };
      viewer.on(event, take);
    });
    const words = [], frames = [];
    for (let i = 0; i < dabs; ++i) {
      await new Promise((resolve) => setTimeout(resolve, 300));
      const x = box.width * (0.2 + 0.6 * ((i * 0.618) % 1)), y = box.height * (0.2 + 0.6 * ((i * 0.382) % 1));
      if (!(await viewer.pick(x, y))) continue;
      const begin = performance.now(), edited = next('edited');
      send('pointerdown', x, y);
      const took = /** @type {number} */ (await edited);
      const drawn = /** @type {number} */ (await next('frame'));
      words.push(took - begin);
      frames.push(drawn - took);
      send('pointerup', x, y);
    }
    return { words, frames, ms: viewer.statistics().frameMs };
  }, DABS);
  results.push({ file: path.basename(file), dabs: times.words.length, event_to_words_ms: spread(times.words), words_to_frame_ms: spread(times.frames), frame_ms: times.ms });
  await page.close();
  await server.close();
}
await browser.close();
const text = JSON.stringify({ picture: [WIDTH, HEIGHT], card: 'software', results }, null, 2);
if (output) fs.writeFileSync(output, text + '\n');
console.log(text);
process.exit(0);
