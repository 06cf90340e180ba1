/** Files of this computer that a page opens, without a server. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { build, buildColored, folder, voxdag } from './program.mjs';

const QUICK = '#ao=0&shadows=off';

/** Drops a file on the page; waits for a message that has a text. @param {any} page @param {string} name @param {string | Buffer} contents @param {string} message */
async function drop(page, name, contents, message) {
  await page.evaluate((/** @type {string} */ name, /** @type {string} */ base64) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    document.getElementById('container')?.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
  }, name, Buffer.from(contents).toString('base64'));
  await page.waitForFunction((/** @type {string} */ text) => document.querySelector('.toast:not(.tool-hint)')?.textContent?.includes(text), {}, message);
}

describeInBrowsers('files', (browserName, browser) => {
  it('opens scenes, pages and settings in an exported page from disk', async () => {
    const first = build('courtyard', 64), second = buildColored(128);
    const [one, two] = [first, second].map((file, i) => {
      const page = path.join(folder, `files-${browserName}-${i}.html`);
      voxdag('export', file, '-o', page, '-q');
      return page;
    });
    const page = await open(browser(), pathToFileURL(one).href + QUICK, { width: 400, height: 300, ready: 'window.voxdag?.viewer?.info' });
    const resolution = () => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info?.resolution);
    const shownLevels = async () => {
      await still(page);
      return page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.statistics().levelsLoaded);
    };
    assert.equal(await shownLevels(), 6);
    await drop(page, 'second.vdag', fs.readFileSync(second), 'Opened second.vdag');
    assert.deepEqual([await shownLevels(), await resolution()], [7, 128]);
    await drop(page, 'view.json', '{"sky": 2, "camera": {"eye": [3, 2, 1], "target": [0, 0, 0]}}', 'Settings loaded');
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().sky), 2);
    for (const [name, contents, message] of /** @type {[string, string | Buffer, string][]} */ ([
      ['a.png', '\x89PNG', 'a.png: This file is of another kind.'], ['cut.vdag', fs.readFileSync(first).subarray(0, 5000), 'cut.vdag: This file is damaged.'],
      ['cut.html', fs.readFileSync(two).subarray(0, fs.statSync(two).size - 20_000), 'cut.html: This page is damaged.'],
      ['news.html', '<!doctype html><p>news', 'news.html: This page holds no scene.']])) {
      await drop(page, name, contents, message);
      assert.deepEqual([await shownLevels(), await resolution()], [7, 128], 'the scene before stays');
    }
    await drop(page, 'one.html', fs.readFileSync(one), 'Opened one.html');
    assert.deepEqual([await shownLevels(), await resolution()], [6, 64]);
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().camera), null);
    await page.click('button[aria-label="Save and share"]');
    const chooser = await page.$('input[type=file]');
    await chooser?.uploadFile(second);
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.info?.resolution === 128);
    assertNoComplaints(page);
    await page.close();
  });

  it('begins with the settings that were baked into the page', async () => {
    const camera = { eye: [30, 20, 40], target: [0, 3, 0], up: [0, 1, 0], fov: 50 };
    const settings = path.join(folder, `baked-${browserName}.json`), baked = path.join(folder, `baked-${browserName}.html`);
    fs.writeFileSync(settings, JSON.stringify({ camera, sky: 2, licence: 'CC BY 4.0', occlusion: { samples: 0 }, annotations: [{ text: '</script>', point: [0, 3, 0], camera }] }));
    voxdag('export', build('courtyard', 64), '-o', baked, '-q', '--view', settings, '--title', 'A <castle>', '--poster');
    const page = await open(browser(), pathToFileURL(baked).href, { width: 400, height: 300, ready: 'window.voxdag?.viewer?.info' });
    await still(page);
    const { hash, shown, title, header, posters } = await page.evaluate(() => {
      const { viewer } = /** @type {any} */ (window).voxdag;
      return { hash: location.hash, shown: viewer.get(), title: document.title, header: document.querySelector('.title')?.textContent, posters: document.querySelectorAll('.poster').length };
    });
    assert.deepEqual([hash, title, shown.sky, shown.annotations[0].text, posters], ['', 'A <castle>', 2, '</script>', 0]);
    assert.deepEqual(shown.camera, camera);
    assert.match(header ?? '', /^A <castle>.*CC BY 4\.0/);
    // A link holds what differs from the page, also what it takes away.
    await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ sky: 1, annotations: [], camera: null }, 'ui'));
    await page.waitForFunction(() => location.hash === '#eye=home&sky=1&note=none');
    await page.reload();
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag?.viewer?.info);
    assert.deepEqual(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().annotations), []);
    assertNoComplaints(page);
    await page.close();
  });
});
