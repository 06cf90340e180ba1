/** Edits in the page of `voxdag view --edit`: strokes of brushes, undo, and files that are saved. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { readPng, ssim } from './pictures.mjs';
import { buildColored, folder, serveFolder, view, voxdag } from './program.mjs';

/** @typedef {import('puppeteer-core').Page} Page */

const CAMERA = { eye: [0.5, 1.3, 1.6], target: [0.5, 0, 0.5], up: [0, 1, 0], fov: 40 };
const SIZE = { width: 360, height: 240 };

describeInBrowsers('editing', (name, browser) => {
  /** Opens a page of a scene. @param {string} url */
  const load = async (url) => {
    const page = await open(browser(), `${url}#ao=0&shadows=off`, SIZE);
    await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
    await page.evaluate((camera) => /** @type {any} */ (window).voxdag.viewer.set({ lod: 0, ground: false, exposure: 1, camera }), CAMERA);
    return page;
  };
  const openPanel = (/** @type {Page} */ page) => page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('edit'));
  /** Closes the panel, which covers a small picture. The brush stays on. @param {Page} page */
  const closePanel = (page) => page.evaluate(() => /** @type {HTMLElement} */ (document.querySelector('.panel header button')).click());
  /** Opens a page that edits, with the brush on. @param {string} url */
  const loadEditor = async (url) => {
    const page = await load(url);
    await openPanel(page);
    await page.waitForSelector('button[aria-keyshortcuts="T"]', { visible: true });
    await page.keyboard.press('t');
    await page.waitForFunction('document.querySelector("canvas.picking") !== null');
    await closePanel(page);
    return page;
  };
  /** Waits until no answer of the server has come for a while. @param {Page} page */
  const rest = (page) => page.evaluate(() => new Promise((resolve) => {
    let timer = 0;
    const wait = () => {
      clearTimeout(timer);
      timer = setTimeout(resolve, 1500);
    };
    /** @type {any} */ (window).voxdag.viewer.on('edited', wait);
    wait();
  }));
  const root = (/** @type {Page} */ page) => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.root);
  /** Acts, and waits for another version. @param {Page} page @param {() => Promise<unknown>} act */
  const change = async (page, act) => {
    const before = await root(page);
    await act();
    await page.waitForFunction((old) => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.root !== old, {}, before);
    await rest(page);
  };
  /** Drags over the picture, in parts of its size. @param {Page} page @param {number[][]} way */
  const drag = async (page, way) => {
    const box = await page.evaluate(() => {
      const { left, top, width, height } = /** @type {HTMLCanvasElement} */ (document.querySelector('canvas')).getBoundingClientRect();
      return [left, top, width, height];
    });
    const spots = way.map(([x, y]) => [box[0] + x * box[2], box[1] + y * box[3]]);
    await page.mouse.move(spots[0][0], spots[0][1]);
    await page.mouse.down();
    for (const [x, y] of spots.slice(1)) await page.mouse.move(x, y, { steps: 4 });
    await page.mouse.up();
  };
  /** Takes a brush. @param {Page} page @param {string[]} values  Of its verb and shape. @param {string} color */
  const choose = async (page, values, color) => {
    await openPanel(page);
    await page.evaluate((wanted, paint) => {
      for (const value of wanted) /** @type {HTMLElement} */ (document.querySelector(`.panel input[value=${value}]`)).click();
      const input = /** @type {HTMLInputElement} */ (document.querySelector('.panel input[type=color]'));
      input.value = paint;
      input.dispatchEvent(new Event('input'));
    }, values, color);
    await closePanel(page);
  };
  const press = async (/** @type {Page} */ page, /** @type {import('puppeteer-core').KeyInput[]} */ ...keys) => {
    for (const key of keys) await page.keyboard.down(key);
    for (const key of keys.reverse()) await page.keyboard.up(key);
  };
  /** Returns the picture as PNG in base64. @param {Page} page */
  const picture = (page) => page.evaluate(async () => {
    const blob = await /** @type {any} */ (window).voxdag.viewer.capture({ width: 160, height: 100, samples: 2 });
    return btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer())));
  });
  const pixels = (/** @type {string} */ png) => readPng(Buffer.from(png, 'base64'));
  /**
   * Returns the part of the pixels in which a channel now stands out more from the two others.
   * @param {string} before @param {string} after @param {number} channel
   */
  const tinted = (before, after, channel) => {
    const [a, b] = [pixels(before), pixels(after)], others = [0, 1, 2].filter((c) => c !== channel);
    const standsOut = (/** @type {any} */ { rows, channels }, /** @type {number} */ i) =>
      rows[i * channels + channel] - Math.max(...others.map((c) => rows[i * channels + c]));
    let count = 0;
    for (let i = 0; i < a.width * a.height; ++i) if (standsOut(b, i) > standsOut(a, i) + 40) ++count;
    return count / (a.width * a.height);
  };
  const pick = (/** @type {Page} */ page) => page.evaluate(async () => {
    const { viewer } = /** @type {any} */ (window).voxdag, { clientWidth, clientHeight } = viewer.canvas;
    return viewer.pick(clientWidth / 2, clientHeight / 2);
  });
  const hits = (/** @type {Page} */ page) => page.evaluate(() =>
    Array.from(/** @type {Uint32Array} */ (/** @type {any} */ (window).voxdag.viewer.hits(48, 32))).map((x, i) => (i % 4 === 3 ? x & 0x1ffff : x)).join());
  const ACROSS = [[0.35, 0.5], [0.5, 0.5], [0.6, 0.5]];

  it('takes strokes back, shows colours, keeps sections and picks, and saves a file that shows the same', async () => {
    const file = buildColored(64), server = await view(file, '--edit', '-o', path.join(folder, `edited-${name}.vdag`)), page = await loadEditor(server.url);
    const before = await picture(page), there = await pick(page), rootBefore = await root(page);
    await change(page, () => drag(page, ACROSS));
    const carved = await picture(page), hole = await pick(page);
    assert.notEqual(carved, before);
    assert.ok(hole === null || hole.distance > there.distance, 'the ray goes through what the stroke removed');
    await change(page, () => press(page, 'Control', 'z'));
    assert.equal(await root(page), rootBefore);
    assert.equal(await picture(page), before, 'undone, the picture is the one before');
    await change(page, () => press(page, 'Control', 'Shift', 'Z'));
    assert.equal(await picture(page), carved);
    await change(page, () => press(page, 'Control', 'z'));

    await choose(page, ['add'], '#00ff00');
    await change(page, () => drag(page, ACROSS));
    const grown = await picture(page);
    assert.ok(tinted(before, grown, 1) > 0.01, `the new voxels are green: ${tinted(before, grown, 1)}`);
    assert.ok((await pick(page)).distance < there.distance);
    await choose(page, ['capsule', 'paint'], '#ff0000');
    const overlay = () => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.colors);
    const colors = await overlay();
    await drag(page, [[0.3, 0.55], [0.6, 0.55]]);
    await page.waitForFunction((old) => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.colors !== old, {}, colors);
    await rest(page);
    const painted = await picture(page);
    assert.ok(tinted(grown, painted, 0) > 0.01, `painted red: ${tinted(grown, painted, 0)}`);
    assert.ok(tinted(painted, grown, 0) < 0.001);

    // A measure takes the pointer from the brush, and ends on edited voxels.
    const edited = [await root(page), await overlay()], size = await page.evaluate(() => [innerWidth, innerHeight]);
    await page.keyboard.press('m');
    await page.waitForSelector('.panel header button', { visible: true });
    await closePanel(page);
    await page.mouse.click(0.4 * size[0], 0.55 * size[1]);
    await page.waitForFunction(() => document.querySelector('.tool-hint')?.textContent?.startsWith('Click the second point'));
    await page.mouse.click(0.55 * size[0], 0.55 * size[1]);
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.get().measures.length === 1);
    await page.keyboard.press('Escape');
    assert.deepEqual([await root(page), await overlay()], edited, 'a measure edits nothing');
    await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ measures: [] }));

    // The section cuts the edited scene, for the shader and for the pointer.
    await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ section: { plane: { point: [0.5, 0, 0.5], normal: [0, 0, 1] } } }));
    const cut = await pick(page);
    assert.ok(cut === null || cut.position[2] < 0.5 + 1e-6);
    assert.notEqual(await picture(page), painted);
    await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ section: { plane: null } }));
    await page.waitForFunction('!location.hash.includes("plane")');

    await openPanel(page);
    const saved = path.join(folder, `edited-${name}.vdag`), shown = await hits(page);
    await page.evaluate(() => /** @type {HTMLElement} */ ([...document.querySelectorAll('.panel button')].find((button) => button.textContent === 'Save as')).click());
    await page.waitForFunction('document.body.textContent.includes("Saved edited-")');
    assert.ok(fs.existsSync(saved));
    voxdag('verify', saved);
    // A page that is loaded again shows the edits.
    await page.reload();
    await page.waitForFunction('window.voxdag?.viewer?.arrival?.memory?.version?.colors > 0 && window.voxdag.viewer.arrival.hasEnded');
    await page.evaluate((camera) => /** @type {any} */ (window).voxdag.viewer.set({ lod: 0, ground: false, exposure: 1, camera }), CAMERA);
    assert.equal(await hits(page), shown);
    assertNoComplaints(page);
    await page.close();
    await server.close();
    // So does the file, in a page that only shows it.
    const plain = await view(saved), again = await load(plain.url);
    const hasProgram = fs.existsSync(path.join(process.env.VOXDAG_PAGE ?? '', 'build/voxdag.js'));  // edits without a server
    assert.equal(await again.evaluate(() => document.querySelector('[aria-label=Edit]') !== null), hasProgram);
    assert.equal(await hits(again), shown);
    const [a, b] = [painted, await picture(again)].map(pixels);
    assert.ok(ssim(a, b) > 0.98, `${ssim(a, b)}`);
    assertNoComplaints(again);
    await again.close();
    await plain.close();
  });

  it('begins on the floor of a grid without voxels, and undoes to nothing', async () => {
    const empty = path.join(folder, `empty-${name}.vdag`);
    voxdag('edit', buildColored(64), '--do', 'remove,halfspace,0,0,0,0,-1,0', '--do', 'remove,halfspace,0,0,0,0,1,0', '-o', empty, '-q');
    const server = await view(empty, '--edit'), page = await loadEditor(server.url);
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.voxels), 0);
    assert.equal(await root(page), 0xffffffff);
    const nothing = await picture(page);
    await choose(page, ['add'], '#00ff00');
    await change(page, () => drag(page, ACROSS));
    const drawn = await picture(page);
    assert.ok(tinted(nothing, drawn, 1) > 0.01, `green voxels on the floor: ${tinted(nothing, drawn, 1)}`);
    assert.ok((await pick(page)).position[1] > (await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.origin[1])));
    await change(page, () => press(page, 'Control', 'z'));
    assert.equal(await picture(page), nothing);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  it('refuses edits of a foreign page, even of one that knows the secret', async () => {
    const server = await view(buildColored(64), '--edit'), token = new URL(server.url).searchParams.get('edit');
    const site = path.join(folder, 'foreign');
    fs.mkdirSync(site, { recursive: true });
    fs.writeFileSync(path.join(site, 'index.html'), '<!doctype html><title>foreign</title>');
    const other = await serveFolder(site), page = await open(browser(), other.url, { ready: '' });
    const answers = await page.evaluate(async (target, secret) => {
      /** @type {string[]} */
      const answers = [];
      /** @type {RequestInit[]} */
      const kinds = [{ headers: { 'Voxdag-Token': secret } }, { mode: 'no-cors' }, {}];
      for (const kind of kinds)
        answers.push(await fetch(target, { method: 'POST', body: 'remove,ball,0,0,0,9', ...kind }).then((answer) => String(answer.status), () => 'refused'));
      return answers;
    }, new URL('edit/open', server.url).href, token ?? '');
    // An answer without CORS is opaque, status 0: the server's is 403.
    assert.deepEqual(answers, ['refused', '0', 'refused'].map((text) => (text === '0' ? answers[1] : text)));
    assert.ok(['0', 'refused'].includes(answers[1]));
    await page.close();
    other.close();
    const own = await loadEditor(server.url);
    assert.equal(await root(own), 0);
    await own.close();
    await server.close();
  });
});
