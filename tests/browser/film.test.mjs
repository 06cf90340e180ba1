/** Films of a camera path, and other files that the page makes. */
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { build, view } from './program.mjs';

/** Presses the button of a panel with this text. @param {import('puppeteer-core').Page} page @param {string} text */
const press = (page, text) => page.$$eval('button', (all, text) => all.find((one) => one.textContent === text)?.click(), text);

/** The page keeps what it would have saved: name and bytes. @param {import('puppeteer-core').Page} page */
const keepSaved = (page) => page.evaluate(() => {
  const saved = /** @type {any} */ (window).saved = /** @type {any[]} */ ([]), make = URL.createObjectURL;
  /** @type {Blob | null} */
  let last = null;
  URL.createObjectURL = (blob) => make(last = /** @type {Blob} */ (blob));
  HTMLAnchorElement.prototype.click = function () {
    last?.arrayBuffer().then((bytes) => saved.push([this.download, Array.from(new Uint8Array(bytes))]));
  };
});

/** Waits for the next file. @param {import('puppeteer-core').Page} page @returns {Promise<[string, number[]]>} */
async function nextSaved(page) {
  await page.waitForFunction('window.saved.length > 0');
  return page.evaluate(() => /** @type {any} */ (window).saved.shift());
}

describeInBrowsers('a film', (browserName, browser) => {
  it('turns around the scene, plays, and is saved as video and as frames', async () => {
    const server = await view(build('courtyard', 256));
    const page = await open(browser(), `${server.url}#ao=0&shadows=off`, { width: 400, height: 400 });
    await page.waitForFunction('window.voxdag.viewer.statistics().levelsLoaded === 8');
    await keepSaved(page);
    // Small pictures: the tests' graphics card is software.
    await page.evaluate(() => {
      const { viewer } = /** @type {any} */ (window).voxdag, capture = viewer.capture.bind(viewer);
      viewer.capture = (/** @type {any} */ options) => {
        /** @type {any} */ (window).asked = [options.width, options.height];
        return capture({ ...options, width: 64, height: 40 });
      };
    });
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('film'));
    await press(page, 'Turntable');
    const path = () => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().path);
    assert.equal((await path()).length, 21);

    // The last key but one is dragged to the left, as far as its neighbour allows.
    const keys = await page.$$('.time-line .handle');
    await keys[19].scrollIntoView();
    const spot = await keys[19].boundingBox();
    assert.ok(spot);
    await page.mouse.move(spot.x + spot.width / 2, spot.y + spot.height / 2);
    await page.mouse.down();
    await page.mouse.move(spot.x - 200, spot.y + spot.height / 2, { steps: 3 });
    await page.mouse.up();
    assert.deepEqual((await path()).map((/** @type {any} */ key) => key.time).slice(18), [9, 9.001, 10]);

    const symbol = () => page.evaluate(() => [...document.querySelectorAll('button')].find((one) => /^(Play|Stop)$/.test(one.textContent ?? ''))?.querySelector('path')?.getAttribute('d'));
    const triangle = await symbol();
    await press(page, 'Play');
    assert.notEqual(await symbol(), triangle, 'Stop has its own symbol');
    await press(page, 'Stop');
    assert.equal(await symbol(), triangle);

    await page.evaluate(() => {
      const { viewer } = /** @type {any} */ (window).voxdag, [first, second] = viewer.get().path;
      viewer.set({ path: [first, { ...second, time: 0.1 }] }, 'ui');
    });
    if (browserName === 'chromium') {
      await press(page, 'Record video');
      const [name, bytes] = await nextSaved(page);
      assert.match(name, /\.webm$/);
      assert.deepEqual(bytes.slice(0, 4), [0x1a, 0x45, 0xdf, 0xa3], 'the head of EBML');
    }
    await page.$$eval('.panel select', (all) => {
      for (const [i, value] of ['854x480', '24'].entries()) {
        /** @type {HTMLSelectElement} */ (all[i]).value = value;
        all[i].dispatchEvent(new Event('change'));
      }
    });
    await press(page, 'Save frames');
    const [name, bytes] = await nextSaved(page);
    assert.match(name, /\.frames\.zip$/);
    assert.deepEqual(await page.evaluate(() => /** @type {any} */ (window).asked), [854, 480]);
    const text = Buffer.from(bytes).toString('latin1');
    assert.deepEqual([...text.matchAll(/PK\x01\x02[^]{42}(frame_\d{4}\.png)/g)].map((match) => match[1]), ['frame_0000.png', 'frame_0001.png', 'frame_0002.png']);

    // A picture that takes long is cancelled.
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('share'));
    const job = await page.evaluate(() => {
      const named = (/** @type {string} */ name) => [...document.querySelectorAll('button')].find((one) => one.textContent === name);
      named('Save picture')?.click();
      const shown = document.querySelector('.job:not([hidden]) span')?.textContent;
      named('Cancel')?.click();
      return shown;
    });
    assert.equal(job, 'Picture 0%');
    await page.waitForFunction('document.querySelector(".job").hidden');
    assert.equal(await page.$eval('.toast:not(.tool-hint)', (one) => one.textContent), 'Cancelled');
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).saved.length), 0);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });
});
