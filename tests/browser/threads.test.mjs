/** Threads of the program in the page: only where the page may share memory, and with equal bytes. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { build, folder, serveFolder, view, voxdag } from './program.mjs';

const QUICK = '#ao=0&shadows=off', SIZE = { width: 240, height: 160 };
const ISOLATED = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

/** Builds a scene of a mesh in the page. @param {any} page @param {Buffer} mesh */
async function buildIn(page, mesh) {
  const { base64, ...rest } = await page.evaluate(async (/** @type {string} */ base64) => {
    const { run } = await import(String(new URL('build/program.js', location.href)));
    const data = new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]);
    const { files, threads } = await run(['build', '/in/sponge.ply', '-r', '256', '-o', '/out/sponge.vdag', '-q'], [{ name: 'sponge.ply', data }]);
    let text = '';
    for (const byte of new Uint8Array(await files[0].arrayBuffer())) text += String.fromCharCode(byte);
    return { base64: btoa(text), threads, isolated: crossOriginIsolated, processors: navigator.hardwareConcurrency };
  }, mesh.toString('base64'));
  return { bytes: Buffer.from(base64, 'base64'), ...rest };
}

describeInBrowsers('threads', (browserName, browser) => {
  /** Checks that a page builds the bytes of the native program. @param {string} url @param {string} ready @param {boolean} isolated */
  async function check(url, ready, isolated) {
    const native = build('sponge', 256), page = await open(browser(), url + QUICK, { ...SIZE, ready });
    const made = await buildIn(page, fs.readFileSync(path.join(folder, 'sponge.ply')));
    assert.equal(made.isolated, isolated);
    assert.equal(made.threads, isolated ? Math.min(made.processors, 16) : 1);
    assert.ok(made.bytes.equals(fs.readFileSync(native)), `${made.bytes.length} bytes, not those of the native program`);
    assertNoComplaints(page);
    await page.close();
  }

  it('work in a page of `voxdag view`', async () => {
    const server = await view(build('sponge', 64));
    await check(server.url, 'window.voxdag?.viewer?.info', true);
    await server.close();
  });

  it('work in a site whose server isolates it; other servers get one thread', async () => {
    const site = path.join(folder, `site-${browserName}/`);
    voxdag('export', '-o', site, '-q');
    for (const headers of [ISOLATED, {}]) {
      const server = await serveFolder(site, headers);
      await check(server.url, 'document.querySelector(".welcome")', headers === ISOLATED);
      server.close();
    }
  });
});
