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
});
