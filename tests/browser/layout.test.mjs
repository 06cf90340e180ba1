/** Room for the picture, sizes of type and targets, names of icons, and numbers that are typed. */
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { build, folder, view, voxdag } from './program.mjs';

const QUICK = '#ao=0&shadows=off';

/** Builds two triangles of two materials, one of which has a name. Returns the file. @param {string} name */
function buildMaterials(name) {
  const mesh = path.join(folder, 'names.obj'), file = path.join(folder, 'names.vdag');
  writeFileSync(path.join(folder, 'names.mtl'), `newmtl ${name}\nnewmtl Iron\n`);
  writeFileSync(mesh, `mtllib names.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nusemtl ${name}\nf 1 2 3\nusemtl Iron\nf 2 3 4\n`);
  voxdag('build', mesh, '-r', '32', '--material-ids', '-o', file, '-q');
  return file;
}

describeInBrowsers('layout', (name, browser) => {
  /** @type {{url: string, close: () => Promise<void>}} */
  let server;
  before(async () => {
    server = await view(build('courtyard', 64));
  });
  after(() => server?.close());
  const ready = 'window.voxdag?.viewer?.info && window.voxdag.hands.isLoaded';
  const load = (/** @type {number} */ width, /** @type {number} */ height, hash = QUICK) => open(browser(), server.url + hash, { width, height, ready });
  /** Waits until the picture has a new width. @param {any} page @param {(width: number) => boolean} isRight */
  const resized = (page, isRight) => page.waitForFunction(`(${isRight})(document.querySelector('canvas').clientWidth)`);

  it('leaves the picture its room when a panel opens, and frames the scene again', async () => {
    for (const [width, height, least] of [[1280, 800, 800], [844, 390, 480], [2560, 1440, 1800]]) {
      const page = await load(width, height);
      await page.click('button[aria-label="Light"]');
      await resized(page, new Function('w', `return w < ${width}`));
      const { right, panel, corners } = await page.evaluate(async () => {
        const { viewer, ui } = /** @type {any} */ (window).voxdag, { low, high } = viewer.info.bounds;
        const all = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => ui.overlay.projection.at(low.map((/** @type {number} */ x, /** @type {number} */ a) => ((i >> a) & 1 ? high[a] : x))));
        return { right: viewer.canvas.getBoundingClientRect().right, panel: document.getElementById('panel')?.getBoundingClientRect().left, corners: all };
      });
      assert.ok(right >= least && right <= panel + 1, `${width}: the picture ends at ${right}, the panel begins at ${panel}`);
      for (const { x, y } of corners) assert.ok(x >= 0 && x <= right && y >= 0 && y <= height, `${width}: a corner is at ${x}, ${y}`);
      await page.click('.panel header button');
      await resized(page, new Function('w', `return w === ${width}`));
      assertNoComplaints(page);
      await page.close();
    }
  });

  it('opens every panel without an error, and the picture goes on', async () => {
    const page = await load(1280, 800);
    const names = await page.$$eval('.toolbar button:not([hidden])', (buttons) => buttons.map((button) => button.getAttribute('aria-label')));
    assert.ok(names.length >= 10);
    for (const name of names) {
      await page.click(`.toolbar button[aria-label="${name}"]`);
      assert.equal(await page.$eval('#panel-title', (title) => title.textContent), name);
      const frames = await page.evaluate(() => new Promise((resolve) => {
        const { viewer } = /** @type {any} */ (window).voxdag;
        viewer.on('frame', () => resolve(true));
        viewer.set({ camera: { ...viewer.camera(), fov: viewer.camera().fov + 0.1 } });
      }));
      assert.ok(frames);
    }
    assertNoComplaints(page);
    await page.close();
  });

  it('shows every icon of the toolbar, large enough for a finger, on phones', async () => {
    for (const [width, height] of [[844, 390], [390, 844], [360, 640]]) {
      const page = await load(width, height);
      await page.setViewport({ width, height, hasTouch: true, isMobile: name === 'chromium' });  // loads the page again
      await page.waitForFunction(ready);
      const sizes = await page.$$eval('.toolbar button:not([hidden])', (buttons) => buttons.map((button) => {
        const { left, top, right, bottom } = button.getBoundingClientRect();
        return [left, top, innerWidth - right, innerHeight - bottom, right - left - 27, bottom - top - 27];
      }));
      assert.ok(sizes.length >= 10 && sizes.flat().every((x) => x >= 0), `${width}: ${JSON.stringify(sizes)}`);
      await page.close();
    }
  });

  it('keeps long names of materials in the panel, with their switches', async () => {
    const own = await view(buildMaterials('Brick, weathered and partly painted over by an unknown hand')), page = await open(browser(), own.url + QUICK, { width: 844, height: 390, ready });
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('materials'));
    await page.waitForSelector('.materials input');
    const [ends, room] = await page.evaluate(() => [
      [...document.querySelectorAll('.materials input')].map((input) => input.getBoundingClientRect().right), document.querySelector('.materials')?.getBoundingClientRect().right ?? 0]);
    assert.ok(ends.length > 0 && ends.every((x) => x <= room + 1), `${ends} in ${room}`);
    await page.close();
    await own.close();
  });

  it('has larger type and targets on larger screens', async () => {
    const sizes = [];
    for (const width of [1280, 2560, 3840]) {
      const page = await load(width, width * 0.5625);
      sizes.push(await page.evaluate(() => [parseFloat(getComputedStyle(document.body).fontSize), document.querySelector('.toolbar button:not([hidden])')?.getBoundingClientRect().height ?? 0]));
      await page.close();
    }
    assert.ok(sizes[0][0] >= 14 && sizes[1][0] >= 18 && sizes[2][0] >= 22, String(sizes));
    assert.ok(sizes[0][1] >= 34 && sizes[1][1] >= 44 && sizes[2][1] >= 54, String(sizes));
  });

  it('takes typed numbers exactly', async () => {
    const page = await load(1280, 800, `${QUICK}&plane=0,2,0;0,1,0`);
    await page.click('button[aria-label="Section"]');
    const type = async (/** @type {string} */ text) => {
      await page.click('input[aria-label="Position, number"]');
      await page.keyboard.type(text);
    };
    const height = () => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get().section.plane.point[1]);
    await type('3,25\n');
    assert.equal(await height(), 3.25);
    await type('7');
    await page.keyboard.press('Escape');
    assert.equal(await height(), 3.25, 'Escape keeps the number before');
    await type('no number\n');
    assert.equal(await height(), 3.25);
    assert.match(await page.$eval('input[aria-label="Position, number"]', (field) => /** @type {HTMLInputElement} */ (field).value), /^3\.25/);
    assertNoComplaints(page);
    await page.close();
  });

  if (name === 'chromium')
    it('tells the name of an icon on a long press, without using it', async () => {
      const page = await load(844, 390);
      await page.setViewport({ width: 844, height: 390, hasTouch: true });
      await page.waitForFunction(ready);
      const { x, y } = await page.$eval('button[aria-label="Light"]', (button) => {
        const { left: x, top: y } = button.getBoundingClientRect();
        return { x, y };
      });
      await page.touchscreen.touchStart(x + 10, y + 10);
      await page.waitForFunction(() => document.querySelector('.toast:not(.tool-hint):not([hidden])')?.textContent === 'Light');
      await page.touchscreen.touchEnd();
      assert.ok(await page.$eval('#panel', (panel) => /** @type {HTMLElement} */ (panel).hidden));
      assertNoComplaints(page);
      await page.close();
    });
});
