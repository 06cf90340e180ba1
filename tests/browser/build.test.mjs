/** Models that the page builds scenes of, and scenes that it saves. VOXDAG_PAGE must have the program for browsers. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { pathToFileURL } from 'node:url';
import zlib from 'node:zlib';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { build, buildColored, folder, serveFolder, voxdag } from './program.mjs';

const QUICK = '#ao=0&shadows=off', SIZE = { width: 240, height: 160 };

/** Makes a site without a scene. @returns {Promise<{url: string, close: () => void}>} */
async function startSite() {
  const site = path.join(folder, 'site/');
  if (!fs.existsSync(site)) voxdag('export', '-o', site, '-q');
  return serveFolder(site);
}

/** Drops files on the page. @param {any} page @param {{[name: string]: string | Buffer}} files */
const drop = (page, files) => page.evaluate((/** @type {[string, string][]} */ files) => {
  const data = new DataTransfer();
  for (const [name, base64] of files) data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
  document.getElementById('container')?.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
}, Object.entries(files).map(([name, contents]) => [name, Buffer.from(contents).toString('base64')]));

/** Waits for a message that has a text. @param {any} page @param {string} text */
const message = (page, text) => page.waitForFunction((/** @type {string} */ text) => document.querySelector('.toast:not(.tool-hint)')?.textContent?.includes(text), {}, text);

/** Waits for a scene with this name; returns its numbers. @param {any} page @param {string} name */
async function shown(page, name) {
  await page.waitForFunction((/** @type {string} */ name) => {
    const failed = document.querySelector('.toast.error:not([hidden])')?.textContent;
    if (failed) throw new Error(failed);
    return /** @type {any} */ (window).voxdag.viewer.file === name && document.querySelector('.job')?.hasAttribute('hidden');
  }, { polling: 100 }, name);  // Pages in the background have no frames.
  return page.evaluate(() => {
    const { info } = /** @type {any} */ (window).voxdag.viewer;
    return { resolution: info.resolution, voxels: info.voxels, hasColors: info.hasColors };
  });
}

/** The scene's file in the page. @param {any} page @returns {Promise<Buffer>} */
const sceneOf = async (page) => Buffer.from(await page.evaluate(async () => {
  const bytes = new Uint8Array(await (await /** @type {any} */ (window).voxdag.viewer.scene()).arrayBuffer());
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}), 'base64');

/** Presses a button of the page. @param {any} page @param {string} label */
const press = (page, label) => page.evaluate((/** @type {string} */ label) => {
  const found = [...document.querySelectorAll('.panel button, .job button')].find((button) => button.textContent === label);
  if (!found) throw new Error(`no button ${label}`);
  found.click();
}, label);

/** Notes what the page saves instead of saving it: window.saved lists names and bytes. @param {any} page */
const catchDownloads = (page) => page.evaluate(() => {
  const saved = /** @type {any} */ (window).saved = /** @type {[string, string][]} */ ([]);
  const click = HTMLAnchorElement.prototype.click;
  HTMLAnchorElement.prototype.click = function () {
    if (!this.download) return click.call(this);
    const name = this.download;
    const request = new XMLHttpRequest();
    request.open('GET', this.href);
    request.responseType = 'arraybuffer';
    request.onload = () => {
      let text = '';
      for (const byte of new Uint8Array(request.response)) text += String.fromCharCode(byte);
      saved.push([name, btoa(text)]);
    };
    request.send();
  };
});
/** @param {any} page @param {string} kind @returns {Promise<{name: string, bytes: Buffer}>} */
async function saved(page, kind) {
  await page.evaluate(() => { /** @type {any} */ (window).saved.length = 0; });
  await press(page, `.${kind}`);
  await page.waitForFunction('window.saved.length > 0');
  const [name, base64] = await page.evaluate('window.saved[0]');
  return { name, bytes: Buffer.from(base64, 'base64') };
}

/** Returns the chunks of a scene as base64, but META, which says how the voxels were made. @param {Buffer} file */
const chunks = (file) => Object.fromEntries(Array.from({ length: file.readUInt32LE(12) }, (_, i) => {
  const at = 64 + 32 * i, begin = Number(file.readBigUInt64LE(at + 8));
  return [file.toString('latin1', at, at + 4), file.toString('base64', begin, begin + Number(file.readBigUInt64LE(at + 16)))];
}).filter(([id]) => id !== 'META'));

const square = (/** @type {string} */ more) => `${more}v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n${more && 'usemtl paint\n'}f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n`;
/** A PNG of 2 x 2 pixels. */
function png() {
  const chunk = (/** @type {string} */ type, /** @type {Buffer} */ data) => {
    const body = Buffer.concat([Buffer.from(type), data]), out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(data.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(/** @type {any} */ (zlib).crc32 ? /** @type {any} */ (zlib).crc32(body) : crc(body), body.length + 4);
    return out;
  };
  const crc = (/** @type {Buffer} */ bytes) => {
    let c = ~0;
    for (const byte of bytes) {
      c ^= byte;
      for (let i = 0; i < 8; ++i) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
    }
    return ~c >>> 0;
  };
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', Buffer.from([0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 0])),
    chunk('IDAT', zlib.deflateSync(Buffer.from([0, 255, 0, 0, 0, 255, 0, 0, 0, 0, 255, 255, 255, 0]))), chunk('IEND', Buffer.alloc(0))]);
}
/** An .npy of 8-bit values. @param {number[]} shape @param {(i: number) => number} value */
function npy(shape, value) {
  const head = `{'descr': '|u1', 'fortran_order': False, 'shape': (${shape.join(', ')}), }`.padEnd(117) + '\n';
  return Buffer.concat([Buffer.from('\x93NUMPY\x01\x00v\x00', 'latin1'), Buffer.from(head), Buffer.from(Array.from({ length: shape.reduce((a, b) => a * b) }, (_, i) => value(i)))]);
}

describeInBrowsers('build', (browserName, browser) => {
  it('builds the same scene as the native program of each kind of file', async () => {
    const server = await startSite(), page = await open(browser(), server.url + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    const mesh = build('sponge', 64), stl = path.join(folder, 'box.stl'), glb = path.join(folder, 'sponge.glb'), vox = path.join(folder, 'sponge.vox');
    voxdag('export', mesh, '-o', glb, '-q');
    voxdag('export', mesh, '-o', stl, '-q');
    voxdag('export', mesh, '-o', vox, '-q');
    buildColored(64);
    /** @type {[string, string[], {[name: string]: string | Buffer}][]} */
    const models = [
      ['square.obj', ['build', '-r', '128', '--color-if-any'], { 'square.obj': square('mtllib square.mtl\n'), 'square.mtl': 'newmtl paint\nmap_Kd paint.png\n', 'paint.png': png() }],
      ['colored.ply', ['build', '-r', '128', '--color-if-any'], { 'colored.ply': fs.readFileSync(path.join(folder, 'colored.ply')) }],
      ['box.stl', ['build', '-r', '128', '--color-if-any'], { 'box.stl': fs.readFileSync(stl) }],
      ['sponge.glb', ['build', '-r', '128', '--color-if-any'], { 'sponge.glb': fs.readFileSync(glb) }],
      ['sponge.vox', ['import'], { 'sponge.vox': fs.readFileSync(vox) }],
      ['ball.npy', ['import'], { 'ball.npy': npy([24, 24, 24], (i) => Number(Math.hypot(i % 24 - 12, (Math.floor(i / 24) % 24) - 12, Math.floor(i / 576) - 12) < 10)) }],
      ['cloud.xyz', ['import', '-r', '128'], { 'cloud.xyz': Array.from({ length: 500 }, (_, i) => `${Math.sin(i)} ${Math.cos(i * 1.7)} ${i / 250}`).join('\n') }]];
    for (const [name, [command, ...options], files] of models) {
      const place = path.join(folder, `native-${browserName}-${name}`), native = path.join(place, name.replace(/\.\w+$/, '.vdag'));
      fs.mkdirSync(place, { recursive: true });
      for (const [file, contents] of Object.entries(files)) fs.writeFileSync(path.join(place, file), contents);
      voxdag(command, path.join(place, name), ...options, '-o', native, '-q');
      await drop(page, files);
      const numbers = await shown(page, path.basename(native));
      const made = path.join(place, 'page.vdag');
      fs.writeFileSync(made, await sceneOf(page));
      const difference = JSON.parse(voxdag('diff', native, made, '--json'));
      assert.equal(JSON.parse(voxdag('info', native, '--json')).voxels, numbers.voxels, name);
      assert.equal(fs.statSync(native).size, fs.statSync(made).size, `${name}: ${JSON.stringify(difference)}`);
    }
    for (const [name, contents, text] of /** @type {[string, string, string][]} */ ([
      ['bad.obj', 'garbage\nf 1 2 3\n', 'Build: bad.obj'], ['cut.stl', 'solid a\nfacet normal 0 0', 'Build: cut.stl'], ['a.zip', 'PK\x03\x04 no', 'a.zip: the ZIP is damaged']])) {
      await drop(page, { [name]: contents });
      await message(page, text);
      assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.file), 'cloud.vdag', 'the scene before stays');
    }
    assertNoComplaints(page);
    await page.close();
    server.close();
  });

  it('says what a build takes, builds it, and can cancel it', async () => {
    const server = await startSite(), page = await open(browser(), server.url + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    buildColored(64);
    await drop(page, { 'colored.ply': fs.readFileSync(path.join(folder, 'colored.ply')) });
    const coarse = await shown(page, 'colored.vdag');
    assert.ok(coarse.hasColors);
    assert.match(await page.evaluate(() => document.querySelector('.panel-body')?.textContent), /colored\.ply.*Colours.*About .* voxels, .* MB of memory, .*s/);
    const choose = (/** @type {number} */ level) => page.evaluate((level) => {
      const slider = /** @type {HTMLInputElement} */ (document.querySelector('.panel input[type=range]'));
      slider.value = String(level);
      slider.dispatchEvent(new Event('input'));
    }, level);
    await choose(13);
    await press(page, 'Build');
    await page.waitForFunction('!document.querySelector(".job").hidden');
    await press(page, 'Cancel');
    await message(page, 'Cancelled');
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.resolution), coarse.resolution, 'the scene before stays');
    await choose(8);
    await press(page, 'Build');
    await page.waitForFunction(() => /** @type {any} */ (window).voxdag.viewer.info.resolution === 256);
    assertNoComplaints(page);
    await page.close();
    server.close();
  });

  it('edits the scene of a compact file, and saves the DAG of `voxdag edit`', async () => {
    const server = await startSite(), page = await open(browser(), server.url + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    const plain = build('sponge', 64), compact = path.join(folder, 'packed.vdag'), script = path.join(folder, `edits-${browserName}.csv`), edited = path.join(folder, `edited-${browserName}.vdag`);
    voxdag('convert', plain, '--compact', '-o', compact, '-q');
    await drop(page, { 'packed.vdag': fs.readFileSync(compact) });
    await shown(page, 'packed.vdag');
    await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
    await page.evaluate(() => {
      // The lines of the script that the page sends to its worker.
      const lines = /** @type {any} */ (window).lines = /** @type {string[]} */ ([]), { postMessage } = Worker.prototype;
      Worker.prototype.postMessage = function (/** @type {any} */ message, /** @type {any[]} */ ...rest) {
        if (message?.verb) lines.push(...(message.verb.startsWith('stroke') ? message.body.split('\n') : ['undo', 'redo'].includes(message.verb) ? [message.verb] : []));
        return postMessage.call(this, message, ...rest);
      };
      /** @type {any} */ (window).voxdag.ui.open('edit');
    });
    await page.waitForFunction('[...document.querySelectorAll(".panel button")].some((b) => b.textContent === "Edit this scene" && !b.hidden)');
    await press(page, 'Edit this scene');
    await page.waitForFunction('document.querySelector("canvas.picking") !== null');
    await page.evaluate(() => /** @type {HTMLElement} */ (document.querySelector('.panel header button')).click());
    const root = () => page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.root), first = await root();
    const other = (/** @type {number} */ than) => page.waitForFunction((/** @type {number} */ than) => /** @type {any} */ (window).voxdag.viewer.arrival.memory.version.root !== than, {}, than);
    const spots = await page.evaluate(async () => {
      const { viewer } = /** @type {any} */ (window).voxdag, { clientWidth, clientHeight } = viewer.canvas, hits = /** @type {[number, number][]} */ ([]);
      const { left, top } = viewer.canvas.getBoundingClientRect();
      for (let y = 0.2; y < 0.8; y += 0.05) for (let x = 0.2; x < 0.8; x += 0.05) {
        const spot = /** @type {[number, number]} */ ([left + x * clientWidth, top + y * clientHeight]);
        if (document.elementFromPoint(...spot) === viewer.canvas && (await viewer.pick(x * clientWidth, y * clientHeight))) hits.push(spot);
      }
      return [hits[0], hits[hits.length - 1]];
    });
    const click = async (/** @type {[number, number]} */ [x, y]) => {
      const before = await root();
      await page.mouse.click(x, y);
      await other(before);
    };
    const command = async (/** @type {string} */ key, /** @type {number} */ before) => {
      await page.keyboard.down('Control');
      await page.keyboard.press(key);
      await page.keyboard.up('Control');
      await other(before);
    };
    await click(spots[0]);
    await click(spots[1]);
    const second = await root();
    await command('z', second);
    await command('y', await root());
    assert.equal(await root(), second);
    await catchDownloads(page);
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('share'));
    const { bytes } = await saved(page, 'vdag');
    fs.writeFileSync(script, (await page.evaluate(() => /** @type {any} */ (window).lines.join('\n'))) + '\n');
    voxdag('edit', plain, '--script', script, '-o', edited, '-q');
    assert.deepEqual(chunks(bytes), chunks(fs.readFileSync(edited)));
    assert.notEqual(first, second);
    assert.ok((await saved(page, 'glb')).bytes.length > 100);
    assertNoComplaints(page);
    await page.close();
    server.close();
  });

  it('survives a worker that ends, and ten scenes in a row', async () => {
    const server = await startSite(), page = await open(browser(), server.url + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    // The first worker ends as it begins, as if the browser had ended it.
    await page.evaluate(() => {
      const { Worker } = window;
      window.Worker = class extends Worker {
        /** @param {string | URL} url */
        constructor(url) {
          super(url);
          this.addEventListener('message', ({ data }) => {
            if (data.type !== 'lock') return;
            window.Worker = Worker;
            this.terminate();
          });
        }
      };
    });
    await drop(page, { 'square.obj': square('') });
    await message(page, 'Build: the work has ended early');
    await page.evaluate(() => document.querySelector('.toast.error')?.toggleAttribute('hidden', true));
    for (let i = 0; i < 10; ++i) {
      await drop(page, { [`square${i}.obj`]: square('') });
      await shown(page, `square${i}.vdag`);
    }
    assert.equal(page.workers().length <= 2, true, 'workers end');
    assertNoComplaints(page);
    await page.close();
    server.close();
  });

  it('takes an address, a pasted model, a dropped folder, and no file of 2 GB', async () => {
    const server = await startSite(), site = path.join(folder, 'site/');
    fs.writeFileSync(path.join(site, 'square.obj'), square(''));
    const page = await open(browser(), `${server.url}?url=square.obj${QUICK}`, SIZE);
    await shown(page, 'square.vdag');
    await page.evaluate((/** @type {string} */ text) => {
      const data = new DataTransfer();
      data.items.add(new File([text], 'pasted.obj'));
      const event = new ClipboardEvent('paste', { bubbles: true });
      Object.defineProperty(event, 'clipboardData', { value: data });  // Firefox does not take it from a script
      window.dispatchEvent(event);
    }, square(''));
    await shown(page, 'pasted.vdag');

    // A folder can only be dropped by a hand: Chromium's protocol has one.
    if (browserName === 'chromium') {
      const model = path.join(folder, 'model');
      fs.mkdirSync(path.join(model, 'textures'), { recursive: true });
      fs.writeFileSync(path.join(model, 'painted.obj'), square('mtllib square.mtl\n'));
      fs.writeFileSync(path.join(model, 'square.mtl'), 'newmtl paint\nmap_Kd textures/paint.png\n');
      fs.writeFileSync(path.join(model, 'textures/paint.png'), png());
      const protocol = await page.createCDPSession(), data = { items: [], files: [model], dragOperationsMask: 1 };
      // The page shows where to drop, so that a hand passes two elements.
      for (const type of /** @type {const} */ (['dragEnter', 'dragOver', 'dragOver', 'drop'])) await protocol.send('Input.dispatchDragEvent', { type, x: 120, y: 100, data });
      assert.ok((await shown(page, 'painted.vdag')).hasColors);
    }

    const before = await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.file);
    const large = path.join(folder, 'large.stl'), triangles = 44_000_000, head = Buffer.alloc(84);
    head.writeUInt32LE(triangles, 80);
    fs.writeFileSync(large, head);
    fs.truncateSync(large, 84 + 50 * triangles);  // without blocks on the disk
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('share'));
    const chooser = /** @type {any} */ (await page.waitForSelector('.panel input[type=file]:not([webkitdirectory])'));
    await chooser.uploadFile(large);
    await message(page, 'large.stl');
    assert.match(await page.evaluate(() => document.querySelector('.toast.error')?.textContent), /more than the memory of a page of the browser has left/);
    assert.equal(await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.file), before, 'the scene before stays');
    assertNoComplaints(page);

    for (const [address, text] of [['none.obj', 'none.obj: the server answers 404'], ['http://127.0.0.1:9/a.obj', 'a page loads files of its own host only']]) {
      const page = await open(browser(), `${server.url}?url=${address}${QUICK}`, SIZE);
      await message(page, text);
      await page.close();
    }
    await page.close();
    server.close();
  });

  it('builds while another page is in front', async () => {
    const server = await startSite(), page = await open(browser(), server.url + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    const other = await browser().newPage();
    await other.bringToFront();
    await drop(page, { 'square.obj': square('') });
    await shown(page, 'square.vdag');
    await other.close();
    assertNoComplaints(page);
    await page.close();
    server.close();
  });

  it('builds and saves from disk, offline', async () => {
    const single = path.join(folder, 'voxdag.html');
    voxdag('export', '-o', single, '-q');
    const page = await open(browser(), pathToFileURL(single).href + QUICK, { ...SIZE, ready: 'document.querySelector(".welcome")' });
    await drop(page, { 'square.obj': square('') });
    const numbers = await shown(page, 'square.vdag');
    await catchDownloads(page);
    await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('share'));
    for (const kind of ['vdag', 'vox', 'glb', 'stl']) assert.ok((await saved(page, kind)).bytes.length > 100, kind);
    const { name, bytes } = await saved(page, 'html'), copy = path.join(folder, `copy-${browserName}.html`);
    assert.equal(name, 'square.html');
    fs.writeFileSync(copy, bytes);
    assertNoComplaints(page);
    await page.close();
    const second = await open(browser(), pathToFileURL(copy).href + QUICK, { ...SIZE, ready: 'window.voxdag?.viewer?.info' });
    assert.equal(await second.evaluate(() => /** @type {any} */ (window).voxdag.viewer.info.voxels), numbers.voxels);
    // A copy builds, and makes copies, too.
    await drop(second, { 'other.obj': square('') });
    await shown(second, 'other.vdag');
    assertNoComplaints(second);
    await second.close();
  });
});
