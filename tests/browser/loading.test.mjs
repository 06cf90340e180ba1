/** How scenes arrive: root first, from servers of several kinds, and what broken files do. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { readPng, spread } from './pictures.mjs';
import { build, buildColored, folder, proxy, serveFolder, view, voxdag } from './program.mjs';

/** Light and a size that cost little. */
const QUICK = '#ao=0&shadows=off';
const SMALL = { width: 160, height: 96 };

describeInBrowsers('loading', (browserName, browser) => {
  it('asks for the root first, and shows a picture before the last level has arrived', async () => {
    const file = build('courtyard', 1024), server = await view(file);
    const held = await proxy(server.url, { hold: true });
    const page = await open(browser(), held.url + QUICK, SMALL);
    const [before, levels] = /** @type {[number, number]} */ (await page.evaluate(() => new Promise((resolve) => {
      const { viewer } = /** @type {any} */ (window).voxdag;
      const drawn = () => {
        const { samples, levelsLoaded } = viewer.statistics();
        // A slow browser draws levels that come together one by one.
        if (samples > 0 && levelsLoaded >= 4) resolve([levelsLoaded, viewer.info.levels]);
      };
      viewer.on('frame', drawn);
      drawn();
    })));
    assert.ok(before >= 4 && before < levels, `a picture of ${before} of ${levels} levels`);
    held.release();
    await still(page);
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.statistics().levelsLoaded), levels);
    const ranges = held.requests.filter(({ path }) => path === '/scene.vdag').map(({ range }) => /bytes=(\d+)-(\d+)/.exec(range)?.slice(1).map(Number) ?? []);
    assert.equal(ranges[0][0], 0);
    assert.ok(ranges[0][1] < 20_000, 'the first request is small');
    for (let i = 1; i < ranges.length; ++i) assert.ok(ranges[i][0] > ranges[i - 1][0], `request ${i} follows the one before it`);
    assert.ok(ranges.length >= 2 && ranges.length <= 30, `${ranges.length} requests`);
    assertNoComplaints(page);
    await page.close();
    held.close();
    await server.close();
  });

  it('shows the levels that came with the first request before it asks for more', async () => {
    const server = await view(build('courtyard', 1024));
    const page = await open(browser(), server.url + QUICK, SMALL);
    const messages = await page.evaluate(async () => {
      const { SceneLoader } = await import(new URL('file/scene_loader.js', document.baseURI).href);
      return new Promise((resolve) => {
        /** @type {string[]} */
        const messages = [];
        const loader = new SceneLoader((/** @type {any} */ message) => {
          messages.push(message.type);
          if (message.type === 'info') loader.load({ shown: message.info.levels, colors: false, normals: false });
          if (message.type === 'done' || message.type === 'error') resolve(messages);
        });
        loader.open({ url: 'scene.vdag' });
      });
    });
    const first = messages.slice(0, messages.indexOf('progress'));
    assert.ok(first.filter((type) => type === 'level').length >= 4, `first ${first.join(', ')}`);
    assert.equal(messages.at(-1), 'done');
    await page.close();
    await server.close();
  });

  it('shows the levels that fit into the textures of the graphics card, and says so', async () => {
    const server = await view(build('courtyard', 1024));
    const page = await open(browser(), server.url + QUICK, SMALL);
    const { note, levels, shown, picture, coarse, fine, cell } = await page.evaluate(async () => {
      const { createViewer } = await import(new URL('viewer.js', document.baseURI).href);
      const { viewer: whole } = /** @type {any} */ (window).voxdag;
      await whole.whenStill();
      const original = WebGL2RenderingContext.prototype.getParameter;
      /** @param {number} name */
      WebGL2RenderingContext.prototype.getParameter = function (name) {
        return name === WebGL2RenderingContext.MAX_TEXTURE_SIZE ? 128 : original.call(this, name);
      };
      const container = document.body.appendChild(document.createElement('div'));
      container.style.cssText = 'position: fixed; inset: 0; width: 64px; height: 48px';
      const viewer = createViewer({ container, url: 'scene.vdag', settings: { occlusion: { samples: 0 } } });
      let note = '';
      viewer.on('note', (/** @type {string} */ text) => (note = text));
      await viewer.whenStill();
      const bytes = new Uint8Array(await (await viewer.capture({ width: 64, height: 48, samples: 1 })).arrayBuffer());
      const { eye, target } = viewer.info.view, way = target.map((/** @type {number} */ x, /** @type {number} */ i) => x - eye[i]);
      const direction = way.map((/** @type {number} */ x) => x / Math.hypot(...way));
      const [coarse, fine] = [viewer, whole].map((v) => v.castNow(eye, direction)?.distance ?? -1);
      const shown = viewer.statistics().levelsLoaded, side = viewer.info.voxelSize * viewer.info.resolution;
      const result = {
        note, levels: viewer.info.levels, shown, picture: Array.from(bytes),
        coarse, fine, cell: side / 2 ** shown,
      };
      viewer.destroy();
      WebGL2RenderingContext.prototype.getParameter = original;
      return result;
    });
    assert.ok(shown >= 4 && shown < levels, `${shown} of ${levels} levels`);
    assert.equal(note, `This scene is too large for the graphics card: it is shown down to level ${shown} of ${levels}.`);
    assert.ok(spread(readPng(Buffer.from(picture))) > 5, 'the picture is not blank');
    assert.ok(coarse > 0 && coarse <= fine && fine - coarse < 4 * cell, `a cell at ${coarse} contains the voxel at ${fine}`);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  it('loads from a server that knows no ranges', async () => {
    const server = await view(buildColored(128)), whole = await proxy(server.url, { ranges: false });
    const page = await open(browser(), whole.url + QUICK, SMALL);
    await still(page);
    assert.equal(whole.requests.filter(({ path }) => path === '/scene.vdag').length, 1);
    assertNoComplaints(page);
    await page.close();
    whole.close();
    await server.close();
  });

  it('shows a static folder of a plain server, and a single file from disk', async () => {
    const file = buildColored(128), site = path.join(folder, `site-${browserName}`), single = path.join(folder, `single-${browserName}.html`);
    voxdag('export', file, '-o', `${site}/`, '-q');
    voxdag('export', file, '-o', single, '-q');
    const plain = await serveFolder(site);
    for (const url of [plain.url, pathToFileURL(single).href]) {
      const page = await open(browser(), url + QUICK, SMALL);
      await still(page);
      const shot = path.join(folder, `site-${browserName}.png`);
      await page.screenshot({ path: shot });
      assert.ok(spread(readPng(shot)) > 5, `${url} is not blank`);
      assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.statistics().levelsLoaded), 7);
      assertNoComplaints(page);
      await page.close();
    }
    plain.close();
  });

  it('is embedded in a page of its own', async () => {
    const site = path.join(folder, `embed-${browserName}`);
    voxdag('export', buildColored(128), '-o', `${site}/`, '-q');
    fs.copyFileSync(fileURLToPath(new URL('../../examples/viewer/embed.html', import.meta.url)), path.join(site, 'embed.html'));
    const { url, close } = await serveFolder(site);
    const page = await open(browser(), `${url}embed.html`, { width: 320, height: 240, ready: '' });
    const status = () => page.$eval('#status', (element) => element.textContent ?? '');
    await page.waitForFunction(() => /\d voxels$/.test(document.querySelector('#status')?.textContent ?? ''));
    assert.match(await status(), /^[\d.,\s]+ voxels$/);
    const canvas = await page.$('#scene canvas');
    assert.ok(canvas);
    const picture = async () => {
      const shot = path.join(folder, `embed-${browserName}.png`);
      await canvas.screenshot({ path: shot });
      return readPng(shot);
    };
    // A button that does nothing shows the same picture until the test's time is over.
    for (const button of ['#turn', '#cut']) {
      const { luma: before } = await picture();
      await page.$eval(button, (element) => /** @type {HTMLElement} */ (element).click());
      for (let apart = 0; apart <= 1;) {
        const { luma } = await picture();
        apart = luma.reduce((sum, v, at) => sum + Math.abs(v - before[at]), 0) / luma.length;
      }
    }
    const frame = page.frames().find((frame) => frame.url().includes('index.html'));
    assert.ok(frame, 'the whole viewer stands in a frame');
    await frame.waitForFunction('window.voxdag?.viewer.statistics().levelsLoaded === 7');
    assertNoComplaints(page);
    await page.close();
    close();
  });

  it('reads colours and normals in the wire form', async () => {
    const file = buildColored(512), wire = path.join(folder, 'wire.vdag');
    voxdag('convert', file, '--wire', '-o', wire, '-q');
    assert.ok(fs.statSync(wire).size < fs.statSync(file).size * 0.9);
    const server = await view(wire);
    const page = await open(browser(), server.url + QUICK, SMALL);
    await still(page);
    const [ofWire, ofPages] = await page.evaluate(async (base64) => {
      const { SceneLoader } = await import(new URL('file/scene_loader.js', document.baseURI).href);
      /** @param {{url?: string, file?: Blob}} from */
      const load = (from) => new Promise((resolve) => {
        const loader = new SceneLoader((/** @type {any} */ message) => {
          if (message.type === 'info') loader.load({ shown: 2, colors: true, normals: true });
          if (message.type === 'error') resolve(message.text);
          if (message.type !== 'attributes') return;
          const list = (/** @type {any} */ { precision, begins, words }) => [precision, ...begins, ...words];
          resolve({ colors: list(message.colors), normals: list(message.normals) });
        });
        loader.open(from);
      });
      const same = (/** @type {any} */ a, /** @type {any} */ b) => [a.colors.length, a.normals.length, JSON.stringify(a) === JSON.stringify(b)];
      const wire = await load({ url: 'scene.vdag' });
      const pages = await load({ file: new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]) });
      return [same(wire, pages), same(pages, pages)];
    }, fs.readFileSync(file).toString('base64'));
    assert.ok(ofWire[0] > 10_000 && ofWire[1] > 40_000);
    assert.deepEqual(ofWire, ofPages);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  for (const form of ['pages', 'wire']) it(`says what is wrong with broken files, and never hangs (${form})`, async () => {
    let file = buildColored(128);
    if (form === 'wire') {
      file = path.join(folder, 'small-wire.vdag');
      voxdag('convert', buildColored(128), '--wire', '-o', file, '-q');
    }
    const server = await view(file);
    const page = await open(browser(), server.url + QUICK, SMALL);
    await still(page);
    const bytes = fs.readFileSync(file);
    const outcomes = await page.evaluate(async (base64, cuts, flips) => {
      const { SceneLoader } = await import(new URL('file/scene_loader.js', document.baseURI).href);
      const whole = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      /** @param {Uint8Array} broken */
      const load = (broken) => new Promise((resolve) => {
        const timer = setTimeout(() => finish('hangs'), 20_000);
        const loader = new SceneLoader((/** @type {any} */ message) => {
          if (message.type === 'info') loader.load({ shown: message.info.levels, colors: true, normals: true });
          if (message.type === 'error') finish(`${message.title}: ${message.text}`);
          if (message.type === 'done') finish('shown');
        });
        /** @param {string} outcome */
        const finish = (outcome) => {
          clearTimeout(timer);
          loader.close();
          resolve(outcome);
        };
        loader.open({ file: new Blob([broken]) });
      });
      const results = { whole: await load(whole), cuts: /** @type {any[]} */ ([]), flips: /** @type {any[]} */ ([]) };
      for (const cut of cuts) results.cuts.push(await load(whole.subarray(0, cut)));
      for (const bit of flips) {
        const broken = whole.slice();
        broken[bit >> 3] ^= 1 << (bit & 7);
        results.flips.push(await load(broken));
      }
      return results;
    }, bytes.toString('base64'), Array.from({ length: 24 }, (_, i) => Math.floor((bytes.length * i) / 24)),
       Array.from({ length: 60 }, (_, i) => (i < 30 ? Math.floor(i * 67.3) * 8 + (i % 8) : Math.floor((bytes.length * 8 * (i - 30)) / 30) + 3)));
    assert.equal(outcomes.whole, 'shown');
    for (const outcome of outcomes.cuts) assert.match(outcome, /^This .*: ./, 'a file that was cut off is refused');
    for (const outcome of outcomes.flips) assert.match(outcome, /^shown$|^This .*: ./);
    assert.ok(outcomes.flips.filter((outcome) => outcome !== 'shown').length > 10, 'flipped bits of headers and nodes are found');
    await page.close();
    await server.close();
  });

  it('draws again after the graphics card was lost', async () => {
    const server = await view(build('courtyard', 256));
    const page = await open(browser(), server.url + QUICK, SMALL);
    await still(page);
    const canvas = await page.$('canvas');
    assert.ok(canvas);
    const difference = (/** @type {Float64Array} */ a, /** @type {Float64Array} */ b) =>
      a.reduce((/** @type {number} */ sum, v, i) => sum + Math.abs(v - b[i]), 0) / a.length;
    // Panels appear and go slowly, and would be in the picture.
    await canvas.evaluate((element) => {
      document.body.style.visibility = 'hidden';
      element.style.visibility = 'visible';
    });
    const shown = async () => {
      const shot = path.join(folder, `shown-${browserName}.png`);
      await canvas.screenshot({ path: shot });
      const picture = readPng(shot);
      assert.ok(spread(picture) > 5, 'the canvas is not blank');
      return picture.luma;
    };
    // The browser shows a frame later than the viewer has drawn it.
    const settled = async () => {
      for (let last = await shown(); ;) {
        await new Promise((resolve) => setTimeout(resolve, 300));
        const next = await shown();
        if (difference(last, next) === 0) return next;
        last = next;
      }
    };
    const before = await settled();
    await page.evaluate(() => new Promise((resolve) => {
      const { viewer } = /** @type {any} */ (window).voxdag;
      const extension = viewer.canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
      viewer.on('restored', resolve);
      viewer.on('lost', () => setTimeout(() => extension.restoreContext(), 50));
      extension.loseContext();
    }));
    await still(page);
    let apart = Infinity;
    for (let tries = 0; tries < 100 && apart >= 1; ++tries) apart = difference(before, await shown());
    assert.ok(apart < 1, `the pictures differ by ${apart}`);
    await page.close();
    await server.close();
  });

  it('ends every wait after a load that failed, and refuses pictures of impossible sizes', async () => {
    const server = await view(buildColored(128));
    const page = await open(browser(), server.url + QUICK, SMALL);
    await still(page);
    const [title, none, size, samples] = await page.evaluate(async () => {
      const { createViewer } = await import(new URL('viewer.js', document.baseURI).href);
      const viewer = createViewer({ container: document.body.appendChild(document.createElement('div')), url: 'missing.vdag' });
      const error = await new Promise((resolve) => viewer.on('error', resolve));
      await viewer.whenStill();
      /** @param {any} from @param {any} [options] */
      const failure = (from, options) => from.capture(options).then(() => 'a picture', (/** @type {Error} */ reason) => reason.message);
      const none = await failure(viewer);
      viewer.destroy();
      const { viewer: shown } = /** @type {any} */ (window).voxdag;
      return [error.title, none, await failure(shown, { width: 1e7, height: 1 }), await failure(shown, { samples: 0 })];
    });
    assert.equal(title, 'The scene was not found');
    assert.equal(none, 'there is no scene');
    assert.match(size, /sides are whole numbers from 1 to/);
    assert.match(samples, /whole number of samples/);
    await page.close();
    await server.close();
  });

  it('follows the size of its container', async () => {
    const server = await view(build('courtyard', 256));
    const page = await open(browser(), server.url + QUICK, { width: 200, height: 300 });
    await still(page);
    await page.setViewport({ width: 330, height: 140 });
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.canvas.width === 330);
    await still(page);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });
});
