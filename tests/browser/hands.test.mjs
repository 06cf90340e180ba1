/** The hands and the interface: each control, used as a person uses it. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { build, folder, view } from './program.mjs';

/** Light that costs little. */
const QUICK = '#ao=0&shadows=off';
const SIZE = { width: 900, height: 600 };

/** @typedef {import('puppeteer-core').Page & {complaints: string[]}} Page */

/** @param {number} ms */
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
/** @param {number[]} a @param {number[]} b */
const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** The camera that is in force. @param {Page} page @returns {Promise<{eye: number[], target: number[], up: number[], fov: number}>} */
const camera = (page) => page.evaluate(() => {
  const { viewer } = /** @type {any} */ (window).voxdag;
  return viewer.get().camera ?? viewer.info.view;
});
/** @param {Page} page */
const settings = (page) => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.get());
/** The point of the scene under a pixel. @param {Page} page @param {number} x @param {number} y */
const pick = (page, x, y) => page.evaluate((x, y) => /** @type {any} */ (window).voxdag.viewer.pick(x, y), x, y);
/** Where a point is in the picture. @param {Page} page @param {number[]} point */
const project = (page, point) => page.evaluate(async (point) => {
  const { viewer } = /** @type {any} */ (window).voxdag, { project } = await import(new URL('lens.js', document.baseURI).href);
  return project(viewer.get().camera ?? viewer.info.view, point, viewer.canvas.clientWidth, viewer.canvas.clientHeight);
}, point);

/** Waits until the camera rests. @param {Page} page */
async function rest(page) {
  await pause(50);
  await page.waitForFunction(() => {
    const { hands } = /** @type {any} */ (window).voxdag;
    return !hands.moved && !hands.navigator.flight && hands.frameRequest === 0;
  });
}

/** Drags from one pixel to another. @param {Page} page @param {number[]} from @param {number[]} to @param {import('puppeteer-core').MouseOptions} [options] */
async function drag(page, from, to, options = {}) {
  await page.mouse.move(from[0], from[1]);
  await page.mouse.down(options);
  for (let i = 1; i <= 5; ++i) await page.mouse.move(from[0] + ((to[0] - from[0]) * i) / 5, from[1] + ((to[1] - from[1]) * i) / 5);
  await page.mouse.up(options);
}

/** Waits until the drawing over the picture shows the settings. @param {Page} page */
const drawn = (page) => page.waitForFunction(() => /** @type {any} */ (window).voxdag.ui.overlay.request === 0);

/** The middle of an element, in pixels. @param {Page} page @param {string} selector */
async function middle(page, selector) {
  await drawn(page);
  const box = await page.$eval(selector, (element) => {
    const { x, y, width, height } = element.getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  });
  return box;
}

describeInBrowsers('hands', (_, browser) => {
  /** @type {{url: string, close: () => Promise<void>}} */
  let server;
  before(async () => {
    server = await view(build('courtyard', 256));
  });
  after(() => server?.close());
  /** @param {string} [hash] @param {{width?: number, height?: number}} [size] @returns {Promise<Page>} */
  const load = async (hash = QUICK, size = SIZE) => {
    const page = await open(browser(), server.url + hash, { ...size, ready: 'window.voxdag?.viewer?.info && window.voxdag.hands.navigator' });
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.hands.isLoaded);
    return /** @type {any} */ (page);
  };

  it('orbits, pans, zooms to the pointer, and focuses', async () => {
    const page = await load(), start = await camera(page);
    await drag(page, [400, 300], [500, 330]);
    await rest(page);
    const turned = await camera(page);
    assert.ok(apart(turned.target, start.target) < 1e-3 * apart(start.eye, start.target), 'the target stays');
    assert.ok(apart(turned.eye, start.eye) > 0.1 * apart(start.eye, start.target), 'the eye moves');

    const point = (await pick(page, 420, 320)).position;
    await page.mouse.move(420, 320);
    for (let i = 0; i < 4; ++i) await page.mouse.wheel({ deltaY: -120 });
    await rest(page);
    const seen = await project(page, point);
    assert.ok(Math.hypot(seen.x - 420, seen.y - 320) < 1, 'the point stays under the pointer');
    assert.ok(apart((await camera(page)).eye, point) < 0.6 * apart(turned.eye, point), 'the eye comes closer');

    const before = await camera(page);
    await drag(page, [450, 300], [480, 280], { button: 'right' });
    await rest(page);
    const panned = await camera(page);
    const moved = panned.eye.map((x, i) => x - before.eye[i]), target = panned.target.map((x, i) => x - before.target[i]);
    assert.ok(apart(moved, target) < 1e-3 * Math.hypot(...moved) + 1e-9, 'eye and target move together');

    const focus = (await pick(page, 300, 250)).position;
    await page.mouse.click(300, 250, { count: 2 });
    await rest(page);
    assert.ok(apart((await camera(page)).target, focus) < 0.02 * apart(before.eye, focus), 'the double click sets the target');

    const away = await camera(page);
    await page.keyboard.down('+');
    await pause(300);
    await page.keyboard.up('+');
    await rest(page);
    assert.ok(apart((await camera(page)).eye, away.target) < apart(away.eye, away.target), 'plus comes closer');

    await page.keyboard.press('r');
    await rest(page);
    assert.equal((await settings(page)).camera, null, 'R goes home');
    assertNoComplaints(page);
    await page.close();
  });

  it('follows one, two and three fingers', async () => {
    const page = await load(), start = await camera(page), size = apart(start.eye, start.target);
    /** Moves fingers from one place to another. @param {number[][]} from @param {number[][]} to @param {number} [hold] milliseconds */
    const touch = async (from, to, hold = 0) => {
      const fingers = [];
      for (const [x, y] of from) fingers.push(await page.touchscreen.touchStart(x, y));
      for (let i = 1; i <= 4; ++i)
        for (const [k, finger] of fingers.entries()) await finger.move(...between(from[k], to[k], i / 4));
      await pause(hold);
      for (const finger of fingers) await finger.end();
      await rest(page);
    };
    /** @param {number[]} a @param {number[]} b @param {number} t @returns {[number, number]} */
    const between = (a, b, t) => [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];

    await touch([[300, 300]], [[380, 310]]);
    const turned = await camera(page);
    assert.ok(apart(turned.target, start.target) < 1e-3 * size && apart(turned.eye, start.eye) > 0.1 * size, 'one finger turns');

    const middle = (await pick(page, 400, 330)).position;
    await touch([[380, 330], [420, 330]], [[340, 330], [460, 330]]);
    const closer = await camera(page);
    assert.ok(apart(closer.eye, middle) < 0.6 * apart(turned.eye, middle), 'two fingers zoom');
    const seen = await project(page, middle);
    assert.ok(Math.hypot(seen.x - 400, seen.y - 330) < 15, 'about the point between them');

    await touch([[350, 300], [400, 300], [450, 300]], [[350, 240], [400, 240], [450, 240]], 300);
    const flown = await camera(page), way = flown.eye.map((x, i) => x - closer.eye[i]);
    const forward = closer.target.map((x, i) => x - closer.eye[i]);
    assert.ok(way.reduce((sum, x, i) => sum + x * forward[i], 0) > 0.5 * Math.hypot(...way) * Math.hypot(...forward), 'three fingers fly');
    assertNoComplaints(page);
    await page.close();
  });

  it('flies and walks by keys, and shows the sides', async () => {
    const page = await load(), start = await camera(page);
    await page.keyboard.press('v');
    assert.equal((await settings(page)).mode, 'fly');
    await page.keyboard.down('w');
    await pause(400);
    await page.keyboard.up('w');
    await rest(page);
    const flown = await camera(page);
    const forward = start.target.map((x, i) => x - start.eye[i]), way = flown.eye.map((x, i) => x - start.eye[i]);
    assert.ok(way.reduce((sum, x, i) => sum + x * forward[i], 0) > 0.98 * Math.hypot(...way) * Math.hypot(...forward), 'W flies forward');
    await drag(page, [400, 300], [450, 300]);
    await rest(page);
    assert.ok(apart((await camera(page)).eye, flown.eye) < 1e-3 * Math.hypot(...way), 'a drag only looks');

    await page.mouse.wheel({ deltaY: -200 });
    await page.waitForFunction(() => /^Speed × 1\.\d/.test(document.querySelector('.toast:not(.tool-hint)')?.textContent ?? ''));

    await page.keyboard.press('g');
    await rest(page);
    const stood = await camera(page), { low } = await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.bounds);
    await page.keyboard.down('a');
    await pause(400);
    await page.keyboard.up('a');
    await rest(page);
    assert.ok(apart((await camera(page)).eye, stood.eye) > 0, 'A walks');
    assert.ok((await camera(page)).eye[1] > low[1], 'above the ground');

    await page.keyboard.press('o');
    for (const [key, axis, sign] of /** @type {[import('puppeteer-core').KeyInput, number, number][]} */ ([['2', 2, 1], ['3', 0, 1], ['4', 2, -1], ['5', 0, -1], ['6', 1, 1], ['7', 1, -1]])) {
      await page.keyboard.press(key);
      await rest(page);
      const { eye, target } = await camera(page), line = eye.map((x, i) => x - target[i]);
      assert.ok(line[axis] * sign > 0.999 * Math.hypot(...line), `key ${key} looks along axis ${axis}`);
    }
    assertNoComplaints(page);
    await page.close();
  });

  it('keeps everything in the address, and a pasted link shows the same', async () => {
    const page = await load();
    await drag(page, [400, 300], [330, 350]);
    await rest(page);
    await page.evaluate(() => {
      const { viewer } = /** @type {any} */ (window).voxdag, { low, high } = viewer.info.bounds;
      viewer.set({
        sun: { direction: [0.3, 0.8, -0.5], angle: 1.5 }, level: 6, show: 'light', sky: 0.8,
        section: { box: { low, high: high.map((/** @type {number} */ x, /** @type {number} */ i) => low[i] + (x - low[i]) * 0.7) } },
        measures: [{ from: low, to: high }], annotations: [{ text: 'gate & wall', point: low, camera: viewer.get().camera }],
      });
    });
    await page.waitForFunction(() => location.hash.includes('note='));
    const hash = await page.evaluate(() => location.hash), wanted = await settings(page);
    const other = await load(hash, { width: 240, height: 160 });
    assert.deepEqual(await settings(other), wanted);
    await still(other);
    assert.deepEqual(await settings(other), wanted, 'nothing moves by itself');
    // A link pasted into the address of an open page.
    await other.evaluate(() => { location.hash = '#mode=fly&eye=1,2,3&target=0,0,0&up=0,1,0&fov=50'; });
    await other.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.get().mode === 'fly');
    assert.deepEqual(await camera(other), { eye: [1, 2, 3], target: [0, 0, 0], up: [0, 1, 0], fov: 50 });
    assertNoComplaints(other);
    await other.close();
    await page.close();
  });

  it('measures between picked points', async () => {
    const page = await load();
    await page.keyboard.press('m');
    // The panel takes room from the picture, which has its new size a frame later.
    await page.waitForFunction(() => {
      const { width, height, clientWidth, clientHeight } = /** @type {HTMLCanvasElement} */ (document.querySelector('canvas'));
      return clientWidth < innerWidth && Math.abs(width / height - clientWidth / clientHeight) < 0.01;
    });
    await drawn(page);
    const [a, b] = [await pick(page, 300, 320), await pick(page, 450, 330)];
    await page.mouse.click(300, 320);
    await page.waitForFunction(() => document.querySelector('.tool-hint')?.textContent?.startsWith('Click the second point'));
    await page.mouse.click(450, 330);
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.get().measures.length === 1);
    const [{ points: [from, to] }] = (await settings(page)).measures;
    const voxel = await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.voxelSize);
    assert.ok(apart(from, a.position) < 0.01 * voxel && apart(to, b.position) < 0.01 * voxel);
    await drawn(page);
    const text = await page.$eval('.measure .label', (label) => parseFloat(label.textContent));
    assert.ok(Math.abs(text - apart(from, to)) < 0.1 * voxel, 'the label says the distance');
    await page.keyboard.press('Escape');
    await page.click('[aria-label="Delete measure 1"]');
    assert.equal((await settings(page)).measures.length, 0);
    // An area: three corners, the last by a click with Shift, which keeps to an axis; Enter closes it.
    await page.select('.panel select', 'area');
    await page.mouse.click(300, 320);
    await page.waitForFunction(() => document.querySelector('.tool-hint')?.textContent?.startsWith('Click the next corner'));
    await page.mouse.click(450, 330);
    await pause(600);
    await page.keyboard.down('Shift');
    await page.mouse.click(400, 326);
    await page.keyboard.up('Shift');
    await page.focus('canvas');
    // Enter does nothing until there are three corners: a slow page takes the clicks later.
    for (let tries = 0; tries < 60 && (await settings(page)).measures.length === 0; ++tries) {
      await page.keyboard.press('Enter');
      await pause(500);
    }
    const [{ kind, points }] = (await settings(page)).measures;
    assert.deepEqual([kind, points.length], ['area', 3]);
    assert.equal(points[2].filter((/** @type {number} */ x, /** @type {number} */ i) => x === points[1][i]).length, 2, 'two coordinates stay');
    assertNoComplaints(page);
    await page.close();
  });

  it('drags the handles of the section', async () => {
    const page = await load();
    await page.keyboard.press('b');
    const { plane } = (await settings(page)).section;
    assert.ok(plane);
    const at = await middle(page, '[aria-label="Plane, position along its normal"]');
    const tip = await middle(page, '[aria-label="Plane, direction of its normal"]');
    const along = tip.map((x, i) => x - at[i]), size = Math.hypot(...along);
    await drag(page, at, at.map((x, i) => x + (along[i] / size) * 40));
    const pushed = (await settings(page)).section.plane;
    assert.deepEqual(pushed.normal, plane.normal);
    const way = pushed.point.map((/** @type {number} */ x, /** @type {number} */ i) => x - plane.point[i]);
    assert.ok(way.reduce((/** @type {number} */ sum, /** @type {number} */ x, /** @type {number} */ i) => sum + x * plane.normal[i], 0) > 0, 'the plane follows the pointer');
    const from = await middle(page, '[aria-label="Plane, direction of its normal"]');
    await drag(page, from, [from[0] + 15, from[1] - 25]);
    assert.notDeepEqual((await settings(page)).section.plane.normal, plane.normal);

    // The box, by its switch, a handle in the picture and a slider.
    await page.$$eval('[role=switch]', (all) => /** @type {HTMLElement[]} */ (all).find((one) => one.closest('label')?.textContent === 'Box')?.click());
    const { box } = (await settings(page)).section;
    const face = await middle(page, '[aria-label="Box, high y"]');
    await drag(page, face, [face[0], face[1] + 40]);
    const cut = (await settings(page)).section.box;
    assert.ok(cut.high[1] < box.high[1], 'the top face follows the pointer');
    assert.deepEqual([cut.low, cut.high[0], cut.high[2]], [box.low, box.high[0], box.high[2]]);
    await page.$eval('[aria-label="Box, low x"]', (handle) => /** @type {SVGElement} */ (handle).focus());
    await page.keyboard.press('ArrowRight');
    assert.ok((await settings(page)).section.box.low[0] > box.low[0], 'keys move a handle');
    // Rays do not meet what is cut away.
    const hit = await pick(page, 450, 330);
    if (hit) assert.ok(hit.position[1] <= cut.high[1] + 1e-6);
    assertNoComplaints(page);
    await page.close();
  });

  it('writes notes, records a path and plays it', async () => {
    const page = await load();
    await page.keyboard.press('n');
    await page.mouse.click(400, 330);
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.get().annotations.length === 1);
    await page.keyboard.type('The [gate](gate.html) <img src=x onerror=alert(1)>');
    await page.keyboard.down('Shift');
    await page.keyboard.press('Enter');
    await page.keyboard.up('Shift');
    await page.keyboard.type('[x](javascript:alert)');
    await page.keyboard.press('Enter');
    assert.equal((await settings(page)).annotations[0].text, 'The [gate](gate.html) <img src=x onerror=alert(1)>\n[x](javascript:alert)');
    assert.equal(await page.$eval('.note-text', (text) => text.innerHTML),
      'The <a href="gate.html" target="_blank" rel="noopener noreferrer">gate</a> &lt;img src=x onerror=alert(1)&gt;\n[x](javascript:alert)');
    await page.keyboard.press('k');
    await page.keyboard.press('2');
    await rest(page);
    await page.keyboard.press('k');
    const { path: keys, annotations } = await settings(page);
    assert.deepEqual(keys.map((/** @type {any} */ key) => key.time), [0, 2]);
    await drawn(page);
    await page.click('.marker .disc');
    await rest(page);
    assert.ok(apart((await camera(page)).eye, annotations[0].camera.eye) < 1e-3 * apart(annotations[0].camera.eye, annotations[0].camera.target), 'the marker flies to the view of the note');
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('film'));
    await page.$$eval('button', (all) => all.find((one) => one.textContent === 'Play')?.click());
    await pause(2600);
    await page.waitForFunction(() => ![...document.querySelectorAll('button')].some((one) => one.textContent === 'Stop'));
    assert.ok(apart((await camera(page)).eye, keys[1].eye) < 1e-9, 'the film ends at its last key');
    await page.$eval('[aria-label="Seconds of key 2"]', (input) => /** @type {HTMLInputElement} */ (input).select());
    await page.keyboard.type('3.5\n');
    assert.deepEqual((await settings(page)).path.map((/** @type {any} */ key) => key.time), [0, 3.5]);
    assertNoComplaints(page);
    await page.close();
  });

  it('names the ends of the colours of levels, steps and sharing', async () => {
    const page = await load(`${QUICK}&show=level`);
    const shown = () => page.$eval('.legend', (legend) => (/** @type {HTMLElement} */ (legend).hidden ? null : [...legend.querySelectorAll('span')].map((end) => end.textContent)));
    assert.deepEqual(await shown(), ['level 1', 'level 8']);
    for (const [show, ends] of /** @type {[string, RegExp][]} */ ([['steps', /^0 steps,160 or more$/], ['sharing', /^used 1×,\d+×$/], ['light', /^$/]])) {
      await page.evaluate((show) => /** @type {any} */ (window).voxdag.viewer.set({ show }), show);
      assert.match(String((await shown()) ?? ''), ends);
    }
    assertNoComplaints(page);
    await page.close();
  });

  it('loads settings from a file, and names the key that is wrong', async () => {
    const page = await load();
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('share'));
    const good = path.join(folder, 'good.json'), bad = path.join(folder, 'bad.json');
    fs.writeFileSync(good, '{"version": 1, "sky": 0.5, "camera": {"eye": [3, 2, 1], "target": [0, 0, 0]}}');
    fs.writeFileSync(bad, '{"version": 1, "sky": "blue"}');
    const input = /** @type {import('puppeteer-core').ElementHandle<HTMLInputElement>} */ (await page.$('input[type=file]'));
    await input.uploadFile(good);
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.get().sky === 0.5);
    assert.deepEqual((await camera(page)).eye, [3, 2, 1]);
    await input.uploadFile(bad);
    await page.waitForFunction(() => /"sky" is not a number/.test(document.querySelector('.toast.error')?.textContent ?? ''));
    assert.equal((await settings(page)).sky, 0.5);
    await page.close();
  });

  it('is usable by keyboard, names every control, and fits a phone', async () => {
    for (const size of [{ width: 390, height: 844 }, SIZE]) {
      const page = await load(QUICK, size);
      for (const label of ['View', 'Light', 'Section', 'Measure', 'Notes', 'Camera path', 'Compare', 'Save and share', 'Statistics', 'Help']) {
        await page.focus(`.toolbar [aria-label="${label}"]`);
        await page.keyboard.press('Enter');
        assert.equal(await page.$eval('.panel h2', (title) => title.textContent), label);
        const faults = await page.evaluate(() => {
          /** @type {string[]} */
          const found = [];
          for (const control of document.querySelectorAll('button, input, select, textarea, [role=slider], [role=button]')) {
            const element = /** @type {HTMLInputElement} */ (control);
            const name = element.getAttribute('aria-label') || [...(element.labels ?? [])].map((one) => one.textContent).join() || element.textContent;
            if (!name?.trim()) found.push(`no name: ${element.outerHTML.slice(0, 120)}`);
          }
          const panel = /** @type {HTMLElement} */ (document.querySelector('.panel')), box = panel.getBoundingClientRect();
          if (box.left < 0 || box.right > innerWidth || box.bottom > innerHeight || box.top < 0) found.push('the panel leaves the window');
          const body = /** @type {HTMLElement} */ (panel.querySelector('.panel-body'));
          if (body.scrollWidth > body.clientWidth) found.push('the panel is wider than its frame');
          return found;
        });
        assert.deepEqual(faults, [], `${label} at ${size.width}`);
        await page.keyboard.press('Escape');
        assert.equal(await page.$eval('.panel', (panel) => /** @type {HTMLElement} */ (panel).hidden), true);
      }
      assertNoComplaints(page);
      await page.close();
    }
  });

  it('says what to do without WebGL 2', async () => {
    const page = await browser().newPage();
    await page.evaluateOnNewDocument(() => { HTMLCanvasElement.prototype.getContext = () => null; });
    await page.goto(server.url);
    await page.waitForSelector('.failure');
    assert.match(await page.$eval('.failure', (card) => card.textContent ?? ''), /WebGL 2/);
    await page.close();
  });
});
