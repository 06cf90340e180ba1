/** Channels in the page: their colours are those of `voxdag render --color-by`, with a scale, and values at the pointer. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { readPng, ssim } from './pictures.mjs';
import { folder, view, voxdag } from './program.mjs';

const SIZE = { width: 96, height: 54, samples: 4 };
const SETTINGS = { camera: { eye: [-20, 45, -25], target: [24, 4, 24], up: [0, 1, 0], fov: 40 }, occlusion: { samples: 16 }, lod: 0 };

/** Imports hills of voxels with channels of several kinds. Returns the file. */
function hills() {
  const points = path.join(folder, 'hills.ply'), file = path.join(folder, 'hills.vdag'), rows = [];
  for (let x = 0; x < 48; ++x)
    for (let z = 0; z < 48; ++z) {
      const y = Math.round(6 + 5 * Math.sin(x / 7) * Math.cos(z / 5));
      for (let d = 0; d < 3; ++d) rows.push(`${x} ${y - d} ${z} ${(Math.cos(x / 9) * z).toFixed(4)} ${1600000000 + 5 * x + z} ${(x * z) % 256}`);
    }
  fs.writeFileSync(points, 'ply\nformat ascii 1.0\n' + `element vertex ${rows.length}\n` +
    ['float x', 'float y', 'float z', 'float heat', 'int time', 'uchar count'].map((field) => `property ${field}\n`).join('') + `end_header\n${rows.join('\n')}\n`);
  voxdag('import', points, '--voxel-size', '1', '--channel', 'heat', '--channel', 'heat:as near,bound=0.25', '--channel', 'time', '--channel', 'count', '-o', file, '-q');
  return file;
}

describeInBrowsers('channels', (_, browser) => {
  const file = hills();
  /** Opens a page and waits for its scene. @param {string} url */
  const load = async (url, width = 800, height = 240) => {
    const page = await open(browser(), url, { width, height });
    await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
    return page;
  };

  it('have the colours of `voxdag render --color-by`: SSIM of at least 0.98', async () => {
    const server = await view(file), page = await load(server.url);
    for (const [name, range] of /** @type {[string, [number, number] | null][]} */ ([
      ['heat', null], ['near', [-20.5, 30]], ['time', null], ['time', [1600000050.5, 1600000100]], ['count', [10, 200]],
    ])) {
      const png = await page.evaluate(async (/** @type {any} */ settings, /** @type {any} */ size) => {
        const { viewer } = /** @type {any} */ (window).voxdag;
        viewer.set(settings);
        return Array.from(new Uint8Array(await (await viewer.capture(size)).arrayBuffer()));
      }, { ...SETTINGS, channel: { name, range } }, SIZE);
      const saved = path.join(folder, 'channel.json'), picture = path.join(folder, 'channel.png');
      // --color-by and --range say what the settings of the page say.
      fs.writeFileSync(saved, JSON.stringify(range ? SETTINGS : { ...SETTINGS, channel: { name, range } }));
      voxdag('render', file, '-q', '--size', '96x54', '--spp', '4', '--view', saved, '-o', picture, ...(range ? ['--color-by', name, '--range', range.join()] : []));
      const likeness = ssim(readPng(Buffer.from(png)), readPng(picture));
      assert.ok(likeness >= 0.98, `${name} ${range}: SSIM ${likeness}`);
    }
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  it('are chosen in a panel, have a scale that can be typed, values at the pointer, and a place in links; also in a single file', async () => {
    const single = path.join(folder, 'hills.html');
    voxdag('export', file, '-o', single, '-q');
    const page = await load(`${pathToFileURL(single).href}#ao=0&shadows=off`);
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('view'));
    const legend = () => page.$eval('.legend', (e) => (/** @type {HTMLElement} */ (e).hidden ? null : Array.from(e.children, (part) => part.textContent)));
    assert.equal(await legend(), null);
    const choose = async (/** @type {string} */ name) => {
      await page.evaluate((name) => {
        const select = /** @type {HTMLSelectElement} */ (Array.from(document.querySelectorAll('.choice')).find((e) => e.textContent?.startsWith('Colour by'))?.lastChild);
        select.value = name;
        select.dispatchEvent(new Event('change'));
      }, name);
      await page.waitForFunction((name) => /** @type {any} */ (window).voxdag.viewer.channel()?.name === (name || undefined), {}, name);
    };
    await choose('time');
    assert.deepEqual(await legend(), ['time', '1600000000', '', '1600000282']);
    await choose('count');
    const channels = JSON.parse(voxdag('info', file, '--json')).attributes.channels, count = channels[3];
    assert.deepEqual(await legend(), ['count', String(count.least), '', String(count.greatest)]);
    const type = async (/** @type {string} */ text) => {
      await page.evaluate((text) => {
        const input = /** @type {HTMLInputElement} */ (Array.from(document.querySelectorAll('.row.text')).find((e) => e.textContent === 'Range')?.lastChild);
        input.value = text;
        input.dispatchEvent(new Event('change'));
      }, text);
    };
    await type('9 to 3');
    assert.deepEqual(await legend(), ['count', String(count.least), '', String(count.greatest)]);
    await type('0 to 10 to 20');
    await type('0 to 1e39');
    assert.deepEqual(await legend(), ['count', String(count.least), '', String(count.greatest)]);
    // A range that is being typed stays when the page shows its settings.
    const field = await page.evaluateHandle(() => Array.from(document.querySelectorAll('.row.text')).find((e) => e.textContent === 'Range')?.lastChild);
    const input = /** @type {import('puppeteer-core').ElementHandle<HTMLInputElement>} */ (field);
    await input.click({ count: 3 });
    await input.type('0 to 9');
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.refresh());
    await input.type('9.5');
    await page.keyboard.press('Enter');
    assert.deepEqual(await legend(), ['count', '0', '', '99.5']);
    await type('0 to 99.5');
    assert.deepEqual(await legend(), ['count', '0', '', '99.5']);
    await page.waitForFunction('location.hash.includes("channel=count&range=0,99.5")');
    assert.equal(await input.evaluate((e) => e.value), '0 to 99.5');

    // The value at the pointer is the one of the voxel.
    const seen = await page.evaluate(async () => {
      const { viewer } = /** @type {any} */ (window).voxdag, { canvas } = viewer;
      viewer.set({ lod: 0, level: null });
      const found = [];
      for (let i = 1; i < 20; ++i) {
        const x = canvas.clientWidth * i / 20, hit = await viewer.pick(x, canvas.clientHeight * 0.55);
        if (hit) found.push([...hit.voxel, viewer.channelValue(hit), x]);
      }
      return found;
    });
    assert.ok(seen.length > 5);
    for (const [x, , z, value] of seen) assert.equal(value, (x * z) % 256);
    await page.evaluate((x) => {
      const { hands, viewer } = /** @type {any} */ (window).voxdag;
      hands.emit('hover', x, viewer.canvas.clientHeight * 0.55, false);
    }, seen[0][4]);
    await page.waitForFunction((end) => document.querySelector('.readout .voxel')?.textContent?.endsWith(end), {}, ` · count ${seen[0][3]}`);

    await choose('');
    assert.equal(await legend(), null);
    assertNoComplaints(page);
    await page.waitForFunction('!location.hash.includes("channel")');
    await page.goto(`${pathToFileURL(single).href}#ao=0&shadows=off&channel=heat&range=-10,20`);
    await page.reload();
    await page.waitForFunction('window.voxdag?.viewer?.channel()');
    assert.deepEqual(await legend(), ['heat', '\u221210', '', '20']);
    await page.goto(`${pathToFileURL(single).href}#ao=0&shadows=off&channel=cold`);
    await page.reload();
    await page.waitForFunction('document.querySelector(".toast:not([hidden])")?.textContent.includes("no channel cold")');
    await page.close();
  });

  it('load without another "loaded", give their memory back, and may fail', async () => {
    const server = await view(file), page = await load(server.url, 96, 54);
    const found = await page.evaluate(async () => {
      const { viewer } = /** @type {any} */ (window).voxdag, bytes = new Uint8Array(await (await viewer.scene()).arrayBuffer());
      // The first block of the channel has numbers of 63 bits.
      bytes[viewer.info.channels.find((/** @type {any} */ one) => one.name === 'count').offset + 12] = 63;
      let loaded = 0, errors = 0, tells = () => {};
      viewer.on('loaded', () => { ++loaded; tells(); });
      viewer.on('error', () => { ++errors; tells(); });
      const event = (/** @type {() => any} */ act) => new Promise((resolve) => { tells = () => resolve(null); act(); });
      await event(() => viewer.open(new File([bytes], 'broken.vdag')));
      const ends = [], memory = () => [viewer.statistics().bytesLoaded, viewer.statistics().gpuBytes];
      const choose = (/** @type {string} */ name) => viewer.set({ channel: { name }, occlusion: { samples: 0 }, shadows: false });
      choose('');
      await viewer.whenStill();
      const before = memory();
      for (const name of ['count', 'heat', 'count', '', 'count', 'time']) {
        if (name === 'count') await event(() => choose(name));
        else choose(name);
        await viewer.capture({ width: 8, height: 8, samples: 1 });
        ends.push(viewer.channel()?.name ?? null);
      }
      choose('');
      await viewer.whenStill();
      return { loaded, errors, ends, before, after: memory() };
    });
    assert.deepEqual(found, { loaded: 1, errors: 3, ends: [null, 'heat', null, null, null, 'time'], before: found.before, after: found.before });
    await page.close();
    await server.close();
  });

  it('have one scale in two scenes that are compared', async () => {
    const coarse = path.join(folder, 'coarse.vdag');
    voxdag('coarsen', file, '--by', '1', '-o', coarse, '-q');
    const server = await view(file), page = await load(server.url);
    const input = /** @type {import('puppeteer-core').ElementHandle<HTMLInputElement>} */ (await page.evaluateHandle(() => {
      const { viewer, ui } = /** @type {any} */ (window).voxdag;
      viewer.set({ channel: { name: 'near' }, occlusion: { samples: 0 }, shadows: false });
      ui.open('compare');
      return document.querySelector('input[accept=".vdag"][aria-label^="File of the second"]');
    }));
    await input.uploadFile(coarse);
    await page.waitForFunction('window.voxdag.ui.second()?.channel() && window.voxdag.viewer.channel()');
    // As text: Firefox sends an object that is there twice once.
    const [first, second] = JSON.parse(await page.evaluate(() => {
      const { viewer, ui } = /** @type {any} */ (window).voxdag;
      return JSON.stringify([viewer, ui.second()].map((each) => each.channel()));
    }));
    assert.deepEqual(second.range, first.range);
    assert.notDeepEqual(second.values, first.values);
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });
});
