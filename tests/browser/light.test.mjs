/** Environments and bounced light in the page are those of the command line. */
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { readPng, ssim } from './pictures.mjs';
import { build, buildColored, folder, view, voxdag } from './program.mjs';

const WIDTH = 96, HEIGHT = 54, SAMPLES = 4;
/** Few rays are enough: page and program cast the same ones. */
const QUICK = { occlusion: { samples: 16 } };
const SMALL = { width: 160, height: 100 };
const camera = (/** @type {number[]} */ eye, /** @type {number[]} */ target, up = [0, 1, 0]) => ({ eye, target, up, fov: 60 });
const OUTSIDE = camera([-20, 12, -20], [0, 3, 0]), INSIDE = camera([2, 1.5, 2], [2, 8, 2.5]), HILL = camera([-0.4, 0.3, 0.2], [0.6, 0, 0.6]);

/** Writes an equirectangular Radiance file: a blue sky over red ground, and a sun to the right. @returns {string} */
function writeSky() {
  const height = 32, width = 2 * height, file = path.join(folder, 'evening.hdr'), bytes = [];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const isSun = Math.abs(y - 11) < 1 && Math.abs(x - 48) < 1;
      // The last of 4 bytes is the exponent: 128 is 2^0, 136 is 2^8.
      bytes.push(...(isSun ? [255, 220, 150, 136] : y < height / 2 ? [60, 90, 200 - 8 * y, 129] : [120, 50, 30, 127]));
    }
  writeFileSync(file, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`), Buffer.from(bytes)]));
  return file;
}

/** Returns a picture of the page. @param {any} page @param {object} settings */
async function pictureOfPage(page, settings) {
  const png = await page.evaluate(async (/** @type {any} */ settings, /** @type {any} */ size) => {
    const { viewer } = /** @type {any} */ (window).voxdag;
    viewer.set(settings);
    const blob = await viewer.capture(size);
    return Array.from(new Uint8Array(await blob.arrayBuffer()));
  }, { ...QUICK, ...settings }, { width: WIDTH, height: HEIGHT, samples: SAMPLES });
  return readPng(Buffer.from(png));
}

/** Returns the picture of `voxdag render`. @param {string} file @param {object} settings @param {...string} options */
function rendered(file, settings, ...options) {
  const json = path.join(folder, 'light.json'), picture = path.join(folder, 'light.png');
  writeFileSync(json, JSON.stringify({ ...QUICK, ...settings }));
  voxdag('render', file, '-q', '--size', `${WIDTH}x${HEIGHT}`, '--spp', String(SAMPLES), '--view', json, '-o', picture, ...options);
  return readPng(picture);
}

describeInBrowsers('light', (browserName, browser) => {
  if (browserName !== 'chromium') return;
  const sky = writeSky();

  it('shows environments as `voxdag render --environment` does: SSIM of at least 0.98', async () => {
    const file = build('courtyard', 256), server = await view(file, '--environment', sky);
    const page = await open(browser(), server.url, SMALL);
    const own = await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().environment.map);
    assert.equal(own.name, 'evening.hdr');
    for (const [i, { settings, map, options }] of [
      { settings: { camera: OUTSIDE }, map: own, options: ['--environment', sky] },
      { settings: { camera: { ...OUTSIDE, up: [0.1, 0.2, 1] }, sky: 0.5 }, map: own, options: ['--environment', sky, '--environment-turn', '50'] },
      { settings: { camera: OUTSIDE }, map: 'studio', options: ['--environment', 'studio'] },
      { settings: { camera: OUTSIDE, sun: { direction: [1, 1, 0.5] } }, map: 'overcast', options: ['--environment', 'overcast'] },
      { settings: { camera: INSIDE }, map: 'sunset', options: ['--environment', 'sunset'] },
    ].entries()) {
      const turn = options.length > 2 ? 50 : 0;
      const likeness = ssim(await pictureOfPage(page, { sun: { direction: null }, sky: 1, ...settings, environment: { map, turn } }), rendered(file, settings, ...options));
      assert.ok(likeness >= 0.98, `picture ${i}: SSIM ${likeness}`);
    }
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  it('saves the environment in its settings, and `voxdag render --view` shows it', async () => {
    const file = build('courtyard', 256), server = await view(file, '--environment', sky);
    const page = await open(browser(), server.url, SMALL);
    const settings = { camera: OUTSIDE, environment: { turn: 90 } }, shown = await pictureOfPage(page, settings);
    const saved = await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get());
    const likeness = ssim(shown, rendered(file, saved));
    assert.ok(likeness >= 0.98, `SSIM ${likeness}`);
    await page.close();
    await server.close();
  });

  it('shows light that surfaces reflect as `voxdag render --bounces` does: SSIM of at least 0.98', async () => {
    for (const [file, shot, environment, bounces] of /** @type {[string, object, string | null, number][]} */ ([
      [build('courtyard', 256), INSIDE, null, 1], [build('courtyard', 256), OUTSIDE, 'sunset', 1],
      [buildColored(256), HILL, 'studio', 3],
    ])) {
      const server = await view(file), page = await open(browser(), server.url, SMALL);
      const settings = { camera: shot, environment: { map: environment }, bounces };
      const shown = await pictureOfPage(page, settings), likeness = ssim(shown, rendered(file, settings));
      assert.ok(likeness >= 0.98, `${path.basename(file)}, ${environment}: SSIM ${likeness}`);
      assert.ok(ssim(shown, await pictureOfPage(page, { bounces: null })) < 0.98, 'bounced light differs from ambient occlusion');
      assertNoComplaints(page);
      await page.close();
      await server.close();
    }
  });
});
