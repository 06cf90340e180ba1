/** Two scenes, compared at a line. */
import assert from 'node:assert/strict';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { readPng, ssim } from './pictures.mjs';
import { build, folder, view } from './program.mjs';

const WIDTH = 1000, HEIGHT = 100;

/** Takes a picture without the interface. @param {import('puppeteer-core').Page} page @param {string} name */
async function picture(page, name) {
  const shot = path.join(folder, name);
  await page.screenshot({ path: shot });
  return readPng(shot);
}

/** Returns the columns `from` to `to` of a picture. @param {import('./pictures.mjs').Picture} of @param {number} from @param {number} to */
function columns({ height, width, luma }, from, to) {
  const part = new Float64Array((to - from) * height);
  for (let y = 0; y < height; ++y) part.set(luma.subarray(y * width + from, y * width + to), y * (to - from));
  return { width: to - from, height, luma: part };
}

describeInBrowsers('two scenes', (_, browser) => {
  it('stand beside each other at a line, with one camera, and each can be hidden', async () => {
    const fine = build('courtyard', 256), coarse = build('courtyard', 16);
    const server = await view(fine), page = await open(browser(), `${server.url}#ao=0&shadows=off&exposure=1`, { width: WIDTH, height: HEIGHT });
    await page.$$eval('.toolbar, .modes, .panel, .title, .readout, .toast, .progress, .divider span', (all) => {
      for (const one of all) /** @type {HTMLElement} */ (one).style.visibility = 'hidden';
    });
    await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ camera: { eye: [10, 6, 14], target: [0, 2, 0], up: [0, 1, 0], fov: 50 } }));
    // The open panel takes room from the picture.
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('compare'));
    await page.$$eval('.panel', ([one]) => { /** @type {HTMLElement} */ (one).style.visibility = 'hidden'; });
    await still(page);
    const first = await picture(page, 'compare_first.png');
    const width = await page.$eval('canvas', (canvas) => canvas.clientWidth), half = Math.round(width / 2);
    const input = /** @type {import('puppeteer-core').ElementHandle<HTMLInputElement>} */ (await page.$('input[accept=".vdag"][aria-label^="File of the second"]'));
    await input.uploadFile(coarse);
    await page.waitForFunction(() => /16³/.test(document.querySelectorAll('.panel .hint')[2]?.textContent ?? ''));
    /** Shows one or both, and waits for the pictures. @param {string} name */
    const show = async (name) => {
      await page.$$eval('.panel .segments label', (all, name) => all.find((one) => one.textContent === name)?.querySelector('input')?.click(), name);
      await page.evaluate(async () => {
        const { viewer, ui } = /** @type {any} */ (window).voxdag;
        await Promise.all([viewer, ui.second()].map((each) => each.whenStill()));
        await new Promise((resolve) => requestAnimationFrame(resolve));
      });
    };
    await show('Second');
    const second = await picture(page, 'compare_second.png');
    await show('First');
    assert.ok(ssim(await picture(page, 'compare_hidden.png'), first) > 0.99, 'the second one is hidden');
    await show('Both');
    const both = await picture(page, 'compare_both.png');
    assert.ok(ssim(columns(first, 0, width), columns(second, 0, width)) < 0.97, 'the scenes differ');
    assert.ok(ssim(columns(both, 0, half - 100), columns(first, 0, half - 100)) > 0.99, 'left of the line');
    assert.ok(ssim(columns(both, half + 100, width), columns(second, half + 100, width)) > 0.99, 'right of the line');
    // The line is dragged to the left.
    await page.mouse.move(half, 80);
    await page.mouse.down();
    await page.mouse.move(width / 10, 80, { steps: 2 });
    await page.mouse.up();
    const clip = await page.$eval('.second', (one) => /** @type {HTMLElement} */ (one).style.clipPath);
    assert.ok(Math.abs(Number(/^inset\(0px 0px 0px (.*)%\)$/.exec(clip)?.[1]) - 10) < 0.1, clip);  // one pixel is 0.1% and more
    await page.$$eval('.panel button', (all) => all.find((one) => /Remove/.test(one.textContent ?? ''))?.click());
    assert.equal(await page.$eval('.second', (one) => one.childElementCount), 0);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });
});
